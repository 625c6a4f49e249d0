"""Folders of measured maps: the names they come under, and pictures good and bad."""

import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from seatlook.errors import InputError
from seatlook.io.material import materials_dir, read_material
from seatlook.io.scene.read import load_scene
from seatlook.io.texture_maps import LARGEST, map_files, read_texture_maps
from seatlook.model.colour import srgb_decode, srgb_encode
from support.scene_files import TEXT, write_two_panels

LEATHER = (materials_dir() / "black-leather.toml").read_text()
LOOK = "albedo = [0.025, 0.025, 0.026]\nroughness = 0.40\n"


def save(path, pixels, **options):
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.asarray(pixels, dtype=np.uint8)).save(path, **options)


def png16(path, pixels):
    """Pillow writes no colour PNG of 16 bits: (h, w, 3) uint16, rows unfiltered."""
    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)

    def chunk(kind, data):
        checked = kind + data
        return struct.pack(">I", len(data)) + checked + struct.pack(">I", zlib.crc32(checked))

    head = struct.pack(">IIBBBBB", width, height, 16, 2, 0, 0, 0)
    content = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + content)


def colour(h=8, w=8, value=(200, 100, 50)):
    return np.full((h, w, 3), value)


FLAT = (128, 128, 255)


@pytest.mark.parametrize(
    ("names", "roles"),
    [
        (
            [
                "Leather026_2K-JPG_Color.jpg", "Leather026_2K-JPG_Roughness.jpg",
                "Leather026_2K-JPG_NormalGL.jpg", "Leather026_2K-JPG_NormalDX.jpg",
                "Leather026_2K-JPG_Displacement.jpg", "Leather026_2K-JPG_AmbientOcclusion.jpg",
                "Leather026.png", "Leather026_2K-JPG.usdc",
            ],
            {"albedo": 0, "roughness": 1, "normal": 2},
        ),
        (["Metal046B_1K_Color.png", "Metal046B_1K_Metalness.png"], {"albedo": 0, "metalness": 1}),
        (
            [
                "brown_leather_diff_1k.jpg", "brown_leather_arm_1k.jpg",
                "brown_leather_nor_gl_1k.png", "brown_leather_disp_1k.png",
            ],
            {"albedo": 0, "arm": 1, "normal": 2},
        ),
        (
            [
                "scuba_suede_nor_dx_2k.png", "scuba_suede_rough_2k.png", "scuba_suede_metal_2k.png",
                "scuba_suede_arm_2k.png", "scuba_suede_col_1_2k.png", "scuba_suede_spec_2k.png",
            ],
            {"normal_dx": 0, "roughness": 1, "metalness": 2, "albedo": 4},
        ),
        (["linen_BaseColor.PNG", "linen_Normal.tif"], {"albedo": 0, "normal": 1}),
        (["Color.png"], {"albedo": 0}),
    ],
)  # fmt: skip
def test_files_are_known_by_their_names(tmp_path, names, roles):
    for name in names:
        (tmp_path / name).touch()
    assert map_files(tmp_path) == {role: tmp_path / names[k] for role, k in roles.items()}


def test_a_material_names_a_folder_and_its_width(tmp_path):
    save(tmp_path / "linen/linen_Color.png", colour(8, 16))
    save(tmp_path / "linen/linen_NormalGL.png", colour(4, 8, FLAT))
    path = tmp_path / "linen.toml"
    path.write_text(LEATHER.replace(LOOK, 'roughness = 0.6\nmaps = "linen"\nmaps_width_mm = 120\n'))
    look = read_material(path).appearance
    assert look.maps.given == ("albedo", "normal")
    assert look.maps.folder == "linen"
    assert (look.maps.width, look.maps.height) == pytest.approx((0.12, 0.06))
    # What a map gives is not needed as a number; what it does not, is.
    assert look.albedo.tolist() == [1, 1, 1]
    assert (look.roughness, look.metalness) == (0.6, 0.0)
    assert look.maps.albedo.flags.writeable is False


def test_a_number_that_neither_file_nor_map_gives(tmp_path, problems):
    save(tmp_path / "linen/linen_Color.png", colour())
    path = tmp_path / "linen.toml"
    text = LEATHER.replace(LOOK, 'maps = "linen"\nmaps_width_mm = 120\n')
    path.write_text(text)
    line = 1 + text.splitlines().index("[appearance]")
    assert problems(read_material, path) == [
        f"linen.toml:{line}: appearance.roughness: got nothing, expected a number"
    ]


def test_a_folder_without_a_width(tmp_path, problems):
    path = tmp_path / "linen.toml"
    path.write_text(LEATHER.replace(LOOK, LOOK + 'maps = "linen"\n'))
    (message,) = problems(read_material, path)
    assert message.endswith(
        "appearance.maps_width_mm: got nothing, expected maps and maps_width_mm, or neither"
    )


def test_no_such_folder_is_told_at_the_material(tmp_path, problems):
    path = tmp_path / "linen.toml"
    path.write_text(LEATHER.replace(LOOK, LOOK + 'maps = "linen"\nmaps_width_mm = 120\n'))
    assert problems(read_material, path) == ["linen: maps: got no such folder, expected a folder"]


def test_a_folder_without_maps(tmp_path, problems):
    (tmp_path / "linen.blend").touch()
    (message,) = problems(read_texture_maps, tmp_path, width=0.1)
    assert "maps: got no map, expected pictures NAME_Color, NAME_Roughness" in message


def test_two_files_for_one_thing(tmp_path, problems):
    for name in ("linen_1K_Color.png", "linen_2K_Color.png"):
        save(tmp_path / name, colour())
    (message,) = problems(read_texture_maps, tmp_path, width=0.1)
    assert message.endswith(
        "maps: got linen_2K_Color.png, expected one file for the albedo; "
        "linen_1K_Color.png is another"
    )


def test_sixteen_bits(tmp_path):
    ramp = np.arange(64, dtype=np.uint16).reshape(8, 8) * 1024
    png16(tmp_path / "a_Color.png", np.repeat(ramp[..., None], 3, axis=2))
    Image.fromarray(ramp).save(tmp_path / "a_Roughness.png")
    maps = read_texture_maps(tmp_path, width=0.1)
    for pixels in (maps.albedo[..., 1], maps.roughness):
        assert np.abs(pixels.astype(float) - ramp / 257).max() <= 1.0


def test_grey_instead_of_colour(tmp_path):
    ramp = np.arange(64).reshape(8, 8) * 4
    save(tmp_path / "a_Color.png", ramp)
    maps = read_texture_maps(tmp_path, width=0.1)
    assert (maps.albedo == ramp[..., None]).all()


def test_grey_normals_are_refused_with_the_reason(tmp_path, problems):
    save(tmp_path / "a_NormalGL.png", np.full((8, 8), 128))
    assert problems(read_texture_maps, tmp_path, width=0.1) == [
        "a_NormalGL.png: picture: got a grey picture, "
        "expected normals in red, green and blue, no height"
    ]


def test_normals_of_an_object_instead_of_a_flat_piece(tmp_path, problems):
    save(tmp_path / "a_NormalGL.png", np.random.default_rng(0).integers(0, 255, (16, 16, 3)))
    (message,) = problems(read_texture_maps, tmp_path, width=0.1)
    assert "on average, expected normals of a flat piece" in message


def test_colour_instead_of_grey(tmp_path, problems):
    grey = np.repeat(np.arange(64).reshape(8, 8, 1) * 4, 3, axis=2)
    save(tmp_path / "a_Roughness.jpg", grey)
    assert read_texture_maps(tmp_path, width=0.1).roughness.shape == (8, 8)
    (tmp_path / "a_Roughness.jpg").unlink()
    save(tmp_path / "a_Roughness.png", colour())
    assert problems(read_texture_maps, tmp_path, width=0.1) == [
        "a_Roughness.png: picture: got a coloured picture, expected a grey one"
    ]


@pytest.mark.parametrize("mode", ["RGBA", "P", "LA", "CMYK", "1"])
def test_other_kinds_of_pixels(tmp_path, mode):
    suffix = "jpg" if mode == "CMYK" else "png"
    picture = Image.fromarray(np.full((8, 8, 3), 255, dtype=np.uint8)).convert(mode)
    picture.save(tmp_path / f"a_Color.{suffix}")
    assert read_texture_maps(tmp_path, width=0.1).albedo.min() >= 254


def test_not_square_of_any_and_of_different_size(tmp_path):
    save(tmp_path / "a_Color.png", colour(10, 30))
    save(tmp_path / "a_Roughness.png", np.full((5, 15), 90))
    maps = read_texture_maps(tmp_path, width=0.3)
    assert maps.height == pytest.approx(0.1)
    assert maps.roughness.shape == (5, 15)


def test_other_proportions_name_the_file(tmp_path, problems):
    save(tmp_path / "a_Color.png", colour(10, 30))
    save(tmp_path / "a_Roughness.png", np.full((20, 30), 90))
    assert problems(read_texture_maps, tmp_path, width=0.3) == [
        "a_Roughness.png: picture: got 30 x 20 pixels, "
        "expected the proportions of a_Color.png, 30 x 10"
    ]


def test_every_bad_file_is_named_at_once(tmp_path, problems):
    save(tmp_path / "a_Color.png", colour(64, 64))
    content = (tmp_path / "a_Color.png").read_bytes()
    (tmp_path / "a_Color.png").write_bytes(content[: len(content) // 2])
    (tmp_path / "a_Roughness.jpg").write_text("no picture")
    got = problems(read_texture_maps, tmp_path, width=0.1)
    assert len(got) == 2
    assert got[0].startswith("a_Color.png: picture: got ")
    assert got[0].endswith(", expected a whole picture")
    assert got[1] == (
        "a_Roughness.jpg: picture: got no picture, expected a PNG, JPEG, TIFF or OpenEXR picture"
    )


def test_directx_normals_are_turned_over(tmp_path):
    save(tmp_path / "a_NormalDX.png", colour(8, 8, (100, 90, 240)))
    assert read_texture_maps(tmp_path, width=0.1).normal[0, 0].tolist() == [100, 165, 240]


def test_own_maps_come_before_packed_ones(tmp_path):
    save(tmp_path / "a_arm_1k.png", colour(8, 8, (10, 150, 0)))
    assert read_texture_maps(tmp_path, width=0.1).given == ("roughness",)
    save(tmp_path / "a_metal_1k.png", np.full((8, 8), 200))
    maps = read_texture_maps(tmp_path, width=0.1)
    assert (maps.roughness[0, 0], maps.metalness[0, 0]) == (150, 200)


def test_large_pictures_are_averaged_in_light(tmp_path):
    board = np.indices((2 * LARGEST, 64)).sum(axis=0) % 2 * 255
    save(tmp_path / "a_Color.png", board)
    pixels = read_texture_maps(tmp_path, width=0.1).albedo
    assert pixels.shape == (LARGEST, 32, 3)
    assert srgb_decode(pixels[5, 5, 0] / 255) == pytest.approx(0.5, abs=4e-3)


def test_openexr_albedo_is_linear(tmp_path):
    from seatlook.exr import write_exr

    write_exr(np.full((4, 4, 3), 0.18, dtype=np.float32), tmp_path / "a_diff_1k.exr")
    write_exr(np.full((4, 4, 3), 0.5, dtype=np.float32), tmp_path / "a_rough_1k.exr")
    maps = read_texture_maps(tmp_path, width=0.1)
    assert maps.albedo[0, 0, 0] == round(255 * float(srgb_encode(np.array(0.18))))
    assert maps.roughness[0, 0] == 128


def test_metal_has_neither_nap_nor_coat(tmp_path, problems):
    save(tmp_path / "foil/foil_Color.png", colour())
    save(tmp_path / "foil/foil_Metalness.png", np.full((8, 8), 200))
    path = tmp_path / "foil.toml"
    path.write_text(LEATHER.replace(LOOK, LOOK + 'maps = "foil"\nmaps_width_mm = 50\n'))
    (message,) = problems(read_material, path)
    assert "got a metalness map below a coat or a sheen, expected one of them" in message


def test_a_scene_shares_the_maps_of_a_material_and_counts_them_in_its_digest(tmp_path):
    save(tmp_path / "linen/linen_Color.png", colour())
    look = 'roughness = 0.6\nmaps = "linen"\nmaps_width_mm = 120\n'
    (tmp_path / "linen.toml").write_text(LEATHER.replace(LOOK, look))
    text = TEXT.replace('material = "pvc"', 'material = "linen.toml"')
    path = write_two_panels(tmp_path, text=text)
    scene = load_scene(path)
    left, right = (m.appearance.maps for m in scene.materials.values())
    assert left is right
    save(tmp_path / "linen/linen_Color.png", colour(value=(10, 20, 30)))
    assert load_scene(path).digest != scene.digest


def test_thread_of_a_scene(tmp_path):
    path = write_two_panels(tmp_path, text=TEXT + '\n[thread]\ncolour = "#ff0000"\npitch_mm = 6\n')
    thread = load_scene(path).thread
    assert (thread.colour.tolist(), thread.pitch, thread.length) == ([1.0, 0.0, 0.0], 0.006, 0.004)
    path = write_two_panels(tmp_path, text=TEXT + "\n[thread]\nlength_mm = 6\n")
    with pytest.raises(InputError, match=r"thread.Thread.length: got 6 mm, expected at most"):
        load_scene(path)
