"""Every format with its reader, whole files of it to begin with, and how they are damaged."""

from __future__ import annotations

import io
import json
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seatlook.errors import InputError
from seatlook.exr import write_exr
from seatlook.files import read_text
from seatlook.io.curves import read_curves
from seatlook.io.export.film import read_shapes, write_shapes
from seatlook.io.export.result import read_result, write_result
from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from seatlook.io.lsdyna.shells import read_shells
from seatlook.io.material import materials_dir, read_foam_material, read_material
from seatlook.io.panorama import read_panorama
from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.seams import read_seams
from seatlook.io.scene.read import load_scene
from seatlook.io.surface.design import read_surface
from seatlook.io.surface.foam import read_foam
from seatlook.io.sweep import read_sweep
from seatlook.io.texture_maps import read_texture_maps
from seatlook.jury.votes import merge_votes
from support.fuzz import mutate
from support.io_samples import box, solution
from support.scene_files import write_two_panels

DATA = Path(__file__).parents[2] / "data"
Damage = Callable[[bytes, random.Random], bytes]


@dataclass(frozen=True)
class Format:
    """One format.

    Parameters
    ----------
    file : name of the file, in a folder that ``prepare`` fills with what it names
    read : path -> anything; only InputError may come out
    seeds : whole files and past holes
    modules : of seatlook that read it, whose lines are counted
    """

    file: str
    read: Callable[[Path], object]
    seeds: Callable[[Path], list[bytes]]
    damage: Damage
    modules: tuple[str, ...]


FOAM = read_foam_material("foam-seat")


def _foam(path: Path) -> object:
    return read_foam(path, material=FOAM, unit="m", up="z")


def _mesh(kind: str) -> Callable[[Path], list[bytes]]:
    def seeds(folder: Path) -> list[bytes]:
        import trimesh

        vertices, faces = box()
        content = trimesh.Trimesh(vertices, faces, process=False).export(file_type=kind)
        whole = content.encode() if isinstance(content, str) else content
        return [b"g A\n" + whole] if kind == "obj" else [whole]

    return seeds


def _files(*names: str) -> Callable[[Path], list[bytes]]:
    def seeds(folder: Path) -> list[bytes]:
        return [file.read_bytes() for name in names for file in sorted(DATA.glob(name))]

    return seeds


def _texts(*texts: str) -> Callable[[Path], list[bytes]]:
    return lambda folder: [text.encode() for text in texts]


def _scene(folder: Path) -> list[bytes]:
    return [write_two_panels(folder).read_bytes()]


def _set(path: Path) -> object:
    """The bytes are what stands behind ``--set``, as the command line decodes it."""
    word = path.read_bytes().decode("utf-8", "surrogateescape")
    return load_scene(path.parent / "scene.toml", changes=[word])


def _sets(folder: Path) -> list[bytes]:
    write_two_panels(folder)
    words = (
        "mesh.seed=3", "rig.sun.light.0.elevation_deg=20", 'rig."²".ev100=3', "rig=[]",
        "gallery.textures.0.x.y=1", "placement.LEFT.rotation.0.0.0=1", "stage.0.end_s=1e308",
        'gallery.textures=["suede","suede"]', "camera.custom=[{name='a', position_mm=[0,0,0]}]",
    )  # fmt: skip
    return [word.encode() for word in words]


def _seams(folder: Path) -> list[bytes]:
    write_two_panels(folder)
    return [(folder / "seams.toml").read_bytes()]


def _read_seams(path: Path) -> object:
    return read_seams(path, _panels(path.parent / "pattern.dxf"))


def _panels(path: Path, known: dict[Path, object] = {}) -> object:  # noqa: B006 -- read once
    return known.setdefault(path, known.get(path) or read_dxf(path))


def _sweep(folder: Path) -> list[bytes]:
    write_two_panels(folder)
    return [
        b'schema = 1\nscene = "scene.toml"\n[axis]\n"mesh.seed" = [0, 1]\n[draw]\nrigs = ["sun"]\n'
        b'[irregularity]\ndraws = 4\n[[irregularity.input]]\nname = "a"\nkind = "foam_mm"\n'
        b'spread = 1.0\n[[variant]]\nname = "b"\nset = ["hem=true"]\n'
    ]


def _jury():
    from support.seen.juries import ballots, documents, make_questionnaire

    questionnaire = make_questionnaire(4, 1)
    return questionnaire, documents(ballots(questionnaire, [[0, 1, 2, 3], None]))


def _votes(folder: Path) -> list[bytes]:
    return [json.dumps(document).encode() for document in _jury()[1].values()]


def _read_votes(path: Path) -> object:
    merged = merge_votes({path: read_text(path)}, _jury()[0])
    if merged.problems:
        raise InputError(merged.problems)
    return merged


def _result(folder: Path) -> list[bytes]:
    write_result(solution(), folder / "seed.npz")
    return [(folder / "seed.npz").read_bytes()]


def _shapes(folder: Path) -> list[bytes]:
    write_shapes(folder / "seed.npz", [0.0, 1.0], np.zeros((2, 5, 3), np.float32))
    return [(folder / "seed.npz").read_bytes()]


def _dxf(folder: Path) -> list[bytes]:
    write_two_panels(folder)
    small = [f for f in sorted((DATA / "patterns").glob("*.dxf")) if f.stat().st_size < 60_000]
    return [(folder / "pattern.dxf").read_bytes(), *(f.read_bytes() for f in small)]


def _d3plot(folder: Path) -> list[bytes]:
    from support.d3plot_samples import d3plot, quad_strip

    nodes, shells = quad_strip()
    count = len(shells)
    states = [
        (t, nodes + t, np.full(count, 1.2), np.full((count, 6), 0.01), np.full((count, 6), -0.01))
        for t in (0.0, 1.0)
    ]
    variants = ({}, {"word": "<i8"}, {"solids": 2, "beams": 1}, {"names": {11: "cover"}})
    made = [d3plot(nodes, shells, states, **options) for options in variants]
    made.append(d3plot(nodes, shells, states, deletion=np.ones(count)))
    return made + _files("lsdyna/d3plot/*")(folder)


def _read_states(path: Path) -> object:
    result = read_d3plot(path, thickness=0.001)
    return [result.read(k) for k in range(len(result))]


def _deck(path: Path) -> object:
    result = read_shells(path, thickness=0.001)
    return [result.read(k) for k in range(len(result))]


def _picture(kind: str, **options: object) -> Callable[[Path], list[bytes]]:
    def seeds(folder: Path) -> list[bytes]:
        from PIL import Image

        ramp = (np.arange(24 * 20 * 3) % 251).astype(np.uint8).reshape(20, 24, 3)
        whole = Image.fromarray(ramp)
        pictures = [whole, whole.convert("L"), whole.convert("P"), whole.convert("RGBA")]
        pictures.append(Image.fromarray(ramp[..., 0].astype(np.uint16) * 257))
        made = []
        for picture in pictures:
            out = io.BytesIO()
            try:
                picture.save(out, kind, **options)
            except OSError:
                continue  # a mode that the format does not have
            made.append(out.getvalue())
        return made

    return seeds


def _maps(path: Path) -> object:
    return read_texture_maps(path.parent, width=0.1)


def _folder(path: Path) -> object:
    """The bytes are the names of the pictures in a folder."""
    names = path.read_text("utf-8", "replace").replace("\0", "").split("\n")
    folder = path.with_suffix("")
    for old in folder.glob("*"):
        old.unlink()
    folder.mkdir(exist_ok=True)
    picture = _picture("PNG")(folder)
    for number, name in enumerate(names):
        if name.strip("/. ") and "/" not in name and len(name.encode()) < 200:
            (folder / name).write_bytes(picture[number % len(picture)])
    return read_texture_maps(folder, width=0.1)


_NAMES = "a_Color.png\na_Roughness.jpg\na_Metalness.tif\na_NormalGL.png\na_NormalDX.png\na_arm.png"
_HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n"


def _hdr(folder: Path) -> list[bytes]:
    pixel = (32, 64, 128, 131)
    run = bytes([2, 2, 0, 16]) + b"".join(bytes([144, value]) for value in pixel)
    literal = bytes([2, 2, 0, 16]) + b"".join(bytes([16]) + bytes([v] * 16) for v in pixel)
    return [_HDR + 8 * run, _HDR + 8 * literal, _HDR + bytes(pixel) * 128]


def _exr(folder: Path) -> list[bytes]:
    write_exr(np.ones((8, 16, 3), np.float32), folder / "seed.exr")
    return [(folder / "seed.exr").read_bytes()]


IO, PATTERN, LSDYNA = "io/", "io/pattern/", "io/lsdyna/"
TOML = ("io/toml", "io/schema")
FORMATS: dict[str, Format] = {
    "scene": Format("scene.toml", load_scene, _scene, mutate.text, ("io/scene/", *TOML)),
    "set": Format("word.txt", _set, _sets, mutate.text, ("io/scene/changes",)),
    "seams": Format("s.toml", _read_seams, _seams, mutate.text, ("io/pattern/seams",)),
    "curves": Format(
        "c.toml", read_curves, _texts("[curve.a]\npoints_mm = [\n[1, 2, 3],\n[4, 5, 6.5],\n]\n"),
        mutate.text, ("io/curves",),
    ),
    "material": Format(
        "m.toml", read_material,
        lambda f: [p.read_bytes() for p in sorted(materials_dir().glob("[blps]*.toml"))],
        mutate.text, ("io/material", "io/colour"),
    ),
    "foam material": Format(
        "f.toml", read_foam_material,
        lambda f: [(materials_dir() / "foam-seat.toml").read_bytes()],
        mutate.text, ("io/material",),
    ),
    "sweep": Format("w.toml", read_sweep, _sweep, mutate.text, ("io/sweep",)),
    "votes": Format("v.json", _read_votes, _votes, mutate.tree, ("jury/votes",)),
    "result": Format("r.npz", read_result, _result, mutate.npz, ("io/export/result", "io/npz")),
    "shapes": Format("p.npz", read_shapes, _shapes, mutate.npz, ("io/export/film", "io/npz")),
    "foam OBJ": Format("a.obj", _foam, _mesh("obj"), mutate.text, ("io/surface/",)),
    "foam STL": Format("a.stl", _foam, _mesh("stl"), mutate.binary, ("io/surface/",)),
    "foam PLY": Format("a.ply", _foam, _mesh("ply"), mutate.binary, ("io/surface/",)),
    "foam GLB": Format("a.glb", _foam, _mesh("glb"), mutate.glb, ("io/surface/",)),
    "design OBJ": Format(
        "d.obj", lambda p: read_surface(p, unit="m", up="z"), _mesh("obj"), mutate.text,
        ("io/surface/design",),
    ),
    "design GLB": Format(
        "d.glb", lambda p: read_surface(p, unit="m", up="z"), _mesh("glb"), mutate.glb,
        ("io/surface/",),
    ),
    "DXF": Format("a.dxf", read_dxf, _dxf, mutate.text, (PATTERN,)),
    "d3plot": Format("d3plot", _read_states, _d3plot, mutate.binary, (f"{LSDYNA}d3plot/",)),
    "deck": Format("a.k", _deck, _files("lsdyna/k/*.k"), mutate.text, (f"{LSDYNA}deck/",)),
    "JPEG": Format("a_Color.jpg", _maps, _picture("JPEG"), mutate.binary, ("io/texture_maps",)),
    "TIFF": Format(
        "a_Color.tif", _maps, _picture("TIFF", compression="tiff_lzw"), mutate.binary,
        ("io/texture_maps",),
    ),
    "PNG": Format("a_Color.png", _maps, _picture("PNG"), mutate.png, ("io/texture_maps",)),
    "texture folder": Format("n.txt", _folder, _texts(_NAMES), mutate.text, ("io/texture_maps",)),
    "HDR": Format("a.hdr", read_panorama, _hdr, mutate.binary, ("io/panorama",)),
    "EXR": Format("a.exr", read_panorama, _exr, mutate.binary, ("exr", "io/panorama")),
}  # fmt: skip
