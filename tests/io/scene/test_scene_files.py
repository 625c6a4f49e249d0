"""Every file that a scene names is opened at one door; one byte changed is another digest."""

import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from seatlook.io.material import materials_dir
from seatlook.io.scene.read import load_scene
from support.scene_files import TEXT, write_two_panels

LEATHER = (materials_dir() / "black-leather.toml").read_text()
HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n" + bytes((32, 64, 128, 131)) * 16 * 8
SCENE = (
    TEXT.replace('material = "pvc"', 'material = "cloth/own.toml"')
    .replace('material = "foam-seat"', 'material = "soft.toml"')
    .replace('name = "sun"\n', 'name = "sun"\npanorama = "sky.hdr"\n')
    .replace('name = "bulb"\n', 'name = "bulb"\npanorama = "sky.exr"\n')
    .replace('["pvc", "suede"]', '["look.toml", "as built"]')
    + '\n[design]\nfile = "design.obj"\n\n[panel.RIGHT]\nmaterial = "right.toml"\n'
)

# File -> what to look for in it, and the same with one byte changed; None: the last byte but 3,
# the lowest of a number of 4 bytes.
CHANGES = {
    "scene.toml": (b"element_size_mm = 20.0", b"element_size_mm = 21.0"),
    "pattern.dxf": (b"\n80.0\n", b"\n80.1\n"),
    "seams.toml": (b"pitch_mm = 5", b"pitch_mm = 6"),
    "foam.obj": (b"v -50.0", b"v -50.1"),
    "curves.toml": (b"0.6]", b"0.7]"),
    "soft.toml": (b"friction = 0.", b"friction = 1."),
    "design.obj": (b"v 180.0", b"v 181.0"),
    "right.toml": (b"\nroughness = 0.40", b"\nroughness = 0.41"),
    "look.toml": (b"\nroughness = 0.40", b"\nroughness = 0.41"),
    "look maps/look_arm.tif": (bytes((10, 20, 30)), bytes((10, 20, 31))),
    "cloth/own.toml": (b"\nroughness = 0.40", b"\nroughness = 0.41"),
    "cloth/maps/own_Color.tif": (bytes((200, 100, 50)), bytes((200, 100, 51))),
    "cloth/maps/own_NormalGL.exr": None,
    "sky.hdr": (bytes((32, 64, 128, 131)), bytes((33, 64, 128, 131))),
    "sky.exr": None,
}
# Named by files, but of no use here, so never opened.
UNUSED = ("foam.mtl", "foam.png", "cloth/maps/own_Displacement.tif", "cloth/maps/own.usdc")


@pytest.fixture
def folder(tmp_path):
    """A scene that names files of every kind, beside it and in folders of their own."""
    write_two_panels(tmp_path, text=SCENE)
    foam = tmp_path / "foam.obj"
    foam.write_text("mtllib foam.mtl\nusemtl foam\n" + foam.read_text())
    (tmp_path / "foam.mtl").write_text("newmtl foam\nmap_Kd foam.png\n")
    surface = "v 0.0 0.0 1.0\nv 180.0 0.0 1.0\nv 0.0 100.0 1.0\ng LEFT\nf 1 2 3\n"
    (tmp_path / "design.obj").write_text(surface)
    shutil.copy(materials_dir() / "foam-seat.toml", tmp_path / "soft.toml")
    (tmp_path / "right.toml").write_text(LEATHER)
    _with_maps(tmp_path / "look.toml", "look maps")
    _with_maps(tmp_path / "cloth" / "own.toml", "maps")
    _save(tmp_path / "look maps/look_arm.tif", (10, 20, 30))
    _save(tmp_path / "cloth/maps/own_Color.tif", (200, 100, 50))
    _save(tmp_path / "cloth/maps/own_Displacement.tif", (1, 2, 3))
    _save(tmp_path / "foam.png", (1, 2, 3))
    (tmp_path / "cloth/maps/own.usdc").write_bytes(b"none")
    _write_exr(tmp_path / "cloth/maps/own_NormalGL.exr", np.full((8, 8, 3), (0.5, 0.5, 1.0)))
    (tmp_path / "sky.hdr").write_bytes(HDR)
    _write_exr(tmp_path / "sky.exr", np.random.default_rng(0).uniform(1.0, 9.0, (8, 16, 3)))
    return tmp_path


def _with_maps(path, maps):
    head, look = LEATHER.split("[appearance]\n")
    path.parent.mkdir(exist_ok=True)
    named = f'[appearance]\nmaps = "{maps}"\nmaps_width_mm = 100.0\n'
    # Metal, which the look's map may hold, has no coat.
    path.write_text(head + named + re.sub("(?m)^coat.*\n", "", look))


def _save(path, colour):
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.full((8, 8, 3), colour, dtype=np.uint8)).save(path)


def _write_exr(path, pixels):
    """Uncompressed, so that one byte can be changed."""
    import OpenEXR

    header = {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": pixels.astype(np.float32)}) as file:
        file.write(str(path))


def _change_one_byte(path, change):
    before = path.read_bytes()
    after = bytearray(before)
    if change is None:
        after[-4] ^= 1
    else:
        old, new = change
        assert sum(a != b for a, b in zip(old, new, strict=True)) == 1
        assert old in before, path.name
        after = before.replace(old, new, 1)
    path.write_bytes(after)


def test_one_byte_of_any_file_changes_the_digest(folder):
    scene = folder / "scene.toml"
    digests = {"": load_scene(scene).digest}
    for name, change in CHANGES.items():
        content = (folder / name).read_bytes()
        _change_one_byte(folder / name, change)
        digests[name] = load_scene(scene).digest
        (folder / name).write_bytes(content)
    assert load_scene(scene).digest == digests[""]
    assert len(set(digests.values())) == len(CHANGES) + 1, digests


def test_whatever_is_opened_is_in_the_digest(folder):
    """The files opened are those of which the test above changes a byte: no more and no fewer."""
    opened: list[Path] = []
    active = True

    def listen(event, arguments):
        if active and event == "open" and isinstance(arguments[0], str | bytes | Path):
            opened.append(Path(str(arguments[0])))

    sys.addaudithook(listen)  # for good: hooks cannot be taken out
    try:
        load_scene(folder / "scene.toml")
    finally:
        active = False
    own = {p.relative_to(folder).as_posix() for p in opened if p.is_relative_to(folder)}
    assert own == set(CHANGES)
    assert all((folder / name).exists() for name in UNUSED)
    assert not [p for p in opened if p.is_relative_to(materials_dir())]


def test_supplied_materials_are_in_the_digest(folder, monkeypatch):
    """Also a material that is named without a path is a file, in the folder of the package."""
    text = SCENE.replace('"right.toml"', '"pvc"').replace('"soft.toml"', '"foam-seat"')
    (folder / "scene.toml").write_text(text)
    supplied = folder / "supplied"
    shutil.copytree(materials_dir(), supplied)
    before = load_scene(folder / "scene.toml").digest
    monkeypatch.setattr("seatlook.io.material.materials_dir", lambda: supplied)
    digests = {load_scene(folder / "scene.toml").digest}
    assert digests == {before}
    for name in ("pvc", "foam-seat"):
        with (supplied / f"{name}.toml").open("a") as file:
            file.write("\n")
        digests.add(load_scene(folder / "scene.toml").digest)
    assert len(digests) == 3


def test_what_a_map_is_counts(folder):
    """The same picture under the name of another map is another appearance."""
    scene, maps = folder / "scene.toml", folder / "cloth" / "maps"
    _save(maps / "own_Color.tif", (200, 200, 200))
    before = load_scene(scene)
    (maps / "own_Color.tif").rename(maps / "own_Roughness.tif")
    after = load_scene(scene)
    assert before.materials["LEFT"].appearance.maps.roughness is None
    assert after.materials["LEFT"].appearance.maps.albedo is None
    assert after.digest != before.digest


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("sky.hdr", "sly.hdr", r"scene.toml:\d+: rig\[0\].panorama: got 'sly.hdr', expected a file "
         r"\(there is none at .*sly.hdr\)"),
        ("design.obj", "maps", r"scene.toml:\d+: design.file: got 'maps', expected a file "
         r"\(a folder at .*maps\)"),
        ("curves.toml", "c" * 300, r"scene.toml:\d+: foam.curves: got 'c+\.\.\., expected a file "
         r"\(File name too long at .*c\)"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_read_is_named_where_the_scene_names_it(
    folder, problems, old, new, message
):
    (folder / "maps").mkdir()
    (folder / "scene.toml").write_text(SCENE.replace(old, new))
    (got,) = [g for g in problems(load_scene, folder / "scene.toml") if "expected a file" in g]
    assert re.fullmatch(message, got)
