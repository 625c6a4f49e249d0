"""Every format with its reader, whole files of it to begin with, and how they are damaged."""

from __future__ import annotations

import json
import random
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.files import read_text
from seatlook.io.curves import read_curves
from seatlook.io.export.film import read_shapes, write_shapes
from seatlook.io.export.result import read_result, write_result
from seatlook.io.laboratory.read import read_laboratory
from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from seatlook.io.lsdyna.fabric_card import card_of
from seatlook.io.lsdyna.fabric_deck import material_of, read_fabric_card, write_fabric_card
from seatlook.io.lsdyna.shells import read_shells
from seatlook.io.material import materials_dir, read_foam_material, read_material
from seatlook.io.panorama import read_panorama
from seatlook.io.pattern.dxf import Reading, read_dxf, report_dxf
from seatlook.io.pattern.seams import read_seams
from seatlook.io.scene.read import load_scene
from seatlook.io.surface.design import read_surface
from seatlook.io.surface.foam import read_foam
from seatlook.io.sweep import read_sweep
from seatlook.jury.votes import merge_votes
from support.fuzz import mutate, pictures, structure
from support.io_samples import box, solution
from support.lab_files import STRIP, TESTS, write_tests
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
    reader : which of ``READERS`` reads it
    ways : the same with the options that users have, chosen by the bytes of the file
    """

    file: str
    read: Callable[[Path], object]
    seeds: Callable[[Path], list[bytes]]
    damage: Damage
    reader: str
    ways: Callable[[Path], object] | None = None


FOAM = read_foam_material("foam-seat")


_AXES: tuple[dict[str, Any], ...] = (
    {"unit": "m", "up": "z"}, {"unit": "m", "up": "y"}, {}, {"unit": "inch"}
)  # fmt: skip


def _foam(path: Path) -> object:
    return read_foam(path, material=FOAM, **_AXES[0])


def _foam_ways(path: Path) -> object:
    return read_foam(path, material=FOAM, **_AXES[_number(path) % 6 % len(_AXES)])


def _number(path: Path) -> int:
    return zlib.crc32(path.read_bytes())


def _design(path: Path) -> object:
    return read_surface(path, **_AXES[0])


def _design_ways(path: Path) -> object:
    number = _number(path)
    ungrouped = (None, None, "rest")[number // 8 % 3]
    return read_surface(path, ungrouped=ungrouped, **_AXES[number % 6 % len(_AXES)])


def _mesh(kind: str) -> Callable[[Path], list[bytes]]:
    def seeds(folder: Path) -> list[bytes]:
        import trimesh

        vertices, faces = box()
        content = trimesh.Trimesh(vertices, faces, process=False).export(file_type=kind)
        whole = content.encode() if isinstance(content, str) else content
        if kind == "obj":
            return [b"g A\n" + whole, *_files("corpus/design_obj/*")(folder)]
        return [whole]

    return seeds


def _files(*names: str) -> Callable[[Path], list[bytes]]:
    def seeds(folder: Path) -> list[bytes]:
        return [file.read_bytes() for name in names for file in sorted(DATA.glob(name))]

    return seeds


def _texts(*texts: str) -> Callable[[Path], list[bytes]]:
    return lambda folder: [text.encode() for text in texts]


def _scene(folder: Path) -> list[bytes]:
    scene = write_two_panels(folder)
    look = (DATA / "corpus/material/lab.toml").read_bytes()
    (folder / "look.toml").write_bytes(look)
    (folder / "design.obj").write_text("g LEFT\n" + (folder / "foam.obj").read_text())
    return [scene.read_bytes(), *_files("corpus/scene/*")(folder)]


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
    return [(folder / "seams.toml").read_bytes(), *_files("corpus/seams/*")(folder)]


def _read_seams(path: Path) -> object:
    return read_seams(path, _panels(path.parent / "pattern.dxf"))


def _seams_ways(path: Path) -> object:
    allowance = (0.0, 0.004)[_number(path) % 2]
    return read_seams(path, _panels(path.parent / "pattern.dxf"), allowance)


def _panels(path: Path, known: dict[Path, object] = {}) -> object:  # noqa: B006 -- read once
    return known.setdefault(path, known.get(path) or read_dxf(path))


def _curves(folder: Path) -> list[bytes]:
    plain = b"[curve.a]\npoints_mm = [\n[1, 2, 3],\n[4, 5, 6.5],\n]\n"
    return [plain, *_files("corpus/curves/*")(folder)]


def _materials(folder: Path) -> list[bytes]:
    (folder / "maps").mkdir()
    (folder / "maps/a_Color.png").write_bytes(pictures.seeds("PNG")(folder)[0])
    own = [p.read_bytes() for p in sorted(materials_dir().glob("[bs]*.toml"))]
    return own + _files("corpus/material/*")(folder)


def _tests(folder: Path) -> list[bytes]:
    write_tests(folder)
    return [TESTS.encode()]


def _strip(folder: Path) -> list[bytes]:
    write_tests(folder)
    return [STRIP.encode()]


def _read_strip(path: Path) -> object:
    return read_laboratory(path.parent / "tests.toml")


def _sweep(folder: Path) -> list[bytes]:
    write_two_panels(folder)
    return [
        b'schema = 1\nscene = "scene.toml"\n[axis]\n"mesh.seed" = [0, 1]\n[draw]\nrigs = ["sun"]\n'
        b'[irregularity]\ndraws = 4\n[[irregularity.input]]\nname = "a"\nkind = "foam_mm"\n'
        b'spread = 1.0\n[[variant]]\nname = "b"\nset = ["hem=true"]\n',
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
    return [
        (folder / "pattern.dxf").read_bytes(), *_files("patterns/*.dxf", "corpus/dxf/*")(folder)
    ]  # fmt: skip


_READINGS: tuple[Reading, ...] = (
    {}, {"units": "metric", "encoding": "gb18030"}, {"allowance": 0.005, "grain_deg": 30.0},
    {"layers": {"8": "SEW", "2": "NOTCH"}, "size": "m"},
)  # fmt: skip


def _dxf_ways(path: Path) -> object:
    options = _READINGS[_number(path) % 8 % 5 % 4]
    read_dxf(path, **options)
    return report_dxf(path, **options).lines()


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
    return made + _files("lsdyna/d3plot/*", "corpus/d3plot/*")(folder)


_PARTS = (None, None, [1], ["cover"], ["cover", 12], ["tool"])
_UNITS = ("mm", "mm", "m", "cm", "inch", "foot")


def _states(read: Callable[..., Any], path: Path, **options: Any) -> object:
    result = read(path, **({"thickness": 0.001} | options))
    return [result.read(k) for k in range(len(result))]


def _state_options(path: Path) -> dict[str, Any]:
    number = _number(path)
    return {
        "thickness": (0.001, None)[number % 2],
        "parts": _PARTS[number % len(_PARTS)],
        "length_unit": _UNITS[number // 8 % len(_UNITS)],
    }


def _deck_ways(path: Path) -> object:
    (path.parent / "body.inc").write_bytes((DATA / "corpus/deck/body.inc").read_bytes())
    reference = path.parent / "body.inc" if _number(path) % 7 == 0 else None
    return _states(read_shells, path, reference=reference, **_state_options(path))


def _cards(folder: Path) -> list[bytes]:
    """Write cards with coats and without, and one with a card of venting between."""
    made = []
    for name, coat in (("black-leather", True), ("leather-laminate", False)):
        fabric = read_material(name).fabric
        write_fabric_card(folder / "seed.k", card_of(fabric, title=name, coat=coat))
        made.append((folder / "seed.k").read_bytes())
    lines = made[0].split(b"\n")
    form = next(k for k, line in enumerate(lines) if line[50:60].strip() == b"-14")
    vented = lines[form][:60] + b"%10d" % -1 + lines[form][70:]
    made.append(b"\n".join([*lines[:form], vented, b"%10d" % 0 * 8, *lines[form + 1 :]]))
    return made


def _read_card(path: Path, thickness: float | None = None) -> object:
    return material_of(read_fabric_card(path, thickness=thickness), read_material("woven"), path)


def _card_ways(path: Path) -> object:
    return _read_card(path, (None, 1.2)[_number(path) % 2])


FORMATS: dict[str, Format] = {
    "scene": Format("scene.toml", load_scene, _scene, structure.toml, "scene"),
    "set": Format("word.txt", _set, _sets, mutate.text, "scene"),
    "seams": Format("s.toml", _read_seams, _seams, structure.toml, "seams", _seams_ways),
    "curves": Format(
        "c.toml", read_curves, _curves, structure.toml, "curves"
    ),
    "material": Format("m.toml", read_material, _materials, structure.toml, "material"),
    "foam material": Format(
        "f.toml", read_foam_material,
        lambda f: [(materials_dir() / "foam-seat.toml").read_bytes()],
        structure.toml, "material",
    ),
    "tests": Format("t.toml", read_laboratory, _tests, structure.toml, "tests"),
    "curve": Format("strip.csv", _read_strip, _strip, mutate.text, "tests"),
    "sweep": Format("w.toml", read_sweep, _sweep, structure.toml, "sweep"),
    "votes": Format("v.json", _read_votes, _votes, mutate.tree, "votes"),
    "result": Format("r.npz", read_result, _result, mutate.npz, "result"),
    "shapes": Format("p.npz", read_shapes, _shapes, mutate.npz, "result"),
    "foam OBJ": Format("a.obj", _foam, _mesh("obj"), mutate.text, "surface", _foam_ways),
    "foam STL": Format("a.stl", _foam, _mesh("stl"), mutate.binary, "surface", _foam_ways),
    "foam PLY": Format("a.ply", _foam, _mesh("ply"), mutate.binary, "surface", _foam_ways),
    "foam GLB": Format("a.glb", _foam, _mesh("glb"), mutate.glb, "surface", _foam_ways),
    "design OBJ": Format("d.obj", _design, _mesh("obj"), mutate.text, "surface", _design_ways),
    "design GLB": Format("d.glb", _design, _mesh("glb"), mutate.glb, "surface", _design_ways),
    "DXF": Format("a.dxf", read_dxf, _dxf, structure.dxf, "DXF", _dxf_ways),
    "d3plot": Format(
        "d3plot", partial(_states, read_d3plot), _d3plot, structure.d3plot, "d3plot",
        lambda path: _states(read_d3plot, path, **_state_options(path)),
    ),
    "deck": Format(
        "a.k", partial(_states, read_shells), _files("lsdyna/k/*.k", "corpus/deck/*"),
        structure.deck, "deck", _deck_ways,
    ),
    "fabric card": Format(
        "m.k", _read_card, _cards, structure.deck, "fabric card", _card_ways
    ),
    "JPEG": Format(
        "a_Color.jpg", pictures.read_maps, pictures.seeds("JPEG"), structure.jpeg, "texture maps"
    ),
    "TIFF": Format(
        "a_Color.tif", pictures.read_maps, pictures.seeds("TIFF", compression="tiff_lzw"),
        structure.tiff, "texture maps",
    ),
    "PNG": Format(
        "a_Color.png", pictures.read_maps, pictures.seeds("PNG"), mutate.png, "texture maps"
    ),
    "texture folder": Format(
        "n.txt", pictures.read_folder, _texts(*pictures.NAMES), mutate.text, "texture maps"
    ),
    "HDR": Format("a.hdr", read_panorama, pictures.hdr, mutate.binary, "panorama"),
    "EXR": Format("a.exr", read_panorama, pictures.exr, structure.exr, "panorama"),
}  # fmt: skip
