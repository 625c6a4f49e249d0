"""The scene file: everything one run needs, read and checked together.

See docs/reference/scene.md.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from seatlook.errors import InputError
from seatlook.files import reader
from seatlook.io.material import material_path, read_foam_material, read_material
from seatlook.io.pattern.dxf import SMALLEST_NOTCH, Reading, report_dxf
from seatlook.io.pattern.report import PatternReport
from seatlook.io.pattern.seams import read_pattern
from seatlook.io.scene.changes import change
from seatlook.io.scene.checks import (
    check_distance,
    check_hem,
    check_overlap,
    check_scale,
    check_wires,
)
from seatlook.io.scene.files import SceneFiles
from seatlook.io.scene.keys import AS_BUILT, scene_keys
from seatlook.io.scene.sewing import make_seam_kinds, make_thread
from seatlook.io.scene.ties import (
    make_boxes,
    make_frames,
    make_freedom,
    make_hooks,
    make_limits,
    make_stages,
)
from seatlook.io.scene.views import make_cameras, make_rigs
from seatlook.io.schema import known, read_table, shown
from seatlook.io.surface.design import read_surface
from seatlook.io.surface.foam import read_foam
from seatlook.io.surface.formats import named_files
from seatlook.io.texture_maps import map_files
from seatlook.io.toml import Document, Key, read_document
from seatlook.mesh.mending.mend import Mending
from seatlook.model import (
    Appearance,
    Design,
    FloatArray,
    Foam,
    Material,
    Pattern,
    Pose,
    Scene,
)
from seatlook.model.criteria import DEFAULT_THRESHOLD
from seatlook.model.scene import FIRST_SIZE

_AXES = {
    sign + letter: (1.0 if sign == "+" else -1.0) * np.eye(3)[number]
    for number, letter in enumerate("xyz")
    for sign in "+-"
}


@reader("a scene")
def load_scene(path: Path | str, *, changes: Iterable[str] = ()) -> Scene:
    """Read a scene and every file it names; paths in it are seen from its own folder.

    Parameters
    ----------
    changes : values set over those of the file, such as ``"mesh.seed=3"`` or
        ``"rig.sun.light.0.elevation_deg=20"``

    Raises
    ------
    InputError
        With all problems of the scene and of its files: unknown, missing or wrong keys, files that
        are absent or unreadable, names that do not exist. Each carries its file and line.
    """
    return _begun(path, changes).scene()


@reader("a scene")
def scene_files(path: Path | str) -> tuple[Path, ...]:
    """Return a scene's file and all that it names, by whatever way; raises as ``load_scene``."""
    begun = _begun(path)
    begun.scene()
    return begun.document.file, *begun.files.paths


@reader("a scene")
def report_pattern(path: Path | str, *, changes: Iterable[str] = ()) -> PatternReport | None:
    """Return what is read of the pattern of a scene, None where that is no DXF file."""
    begun = _begun(path, changes)
    row, document = begun.row, begun.document
    document.finish()
    file = document.file.parent / row["pattern"]["file"]
    return report_dxf(file, **_reading(row)) if file.suffix.lower() == ".dxf" else None


@reader("a scene")
def load_pattern(path: Path | str) -> Pattern:
    """Read the pattern of a scene as the scene wants it read, whatever else may be wrong with it.

    Raises
    ------
    InputError
        As ``load_scene``, of the pattern, its seams and the scene's keys alone.
    """
    begun = _begun(path)
    pattern, document = begun.pattern(), begun.document
    document.finish()
    if pattern is None:
        raise InputError.single("pattern", got="none", expected="a pattern", file=document.file)
    return pattern


def _begun(path: Path | str, changes: Iterable[str] = ()) -> _Reader:
    document = read_document(Path(path))
    change(document, changes)
    return _Reader(document, read_table(document, scene_keys()), SceneFiles(document))


def _reading(row: dict[str, Any]) -> Reading:
    """How the scene wants its pattern file to be read."""
    pattern, notch = row["pattern"], row["mesh"]["smallest_notch_mm"]
    return Reading(
        size=pattern["size"],
        units=pattern["units"],
        encoding=pattern["encoding"],
        grain_deg=pattern["grain_deg"],
        allowance=pattern["allowance_mm"],
        layers={name: what for name, what in pattern["layers"].items() if what},
        smallest_notch=SMALLEST_NOTCH if notch is None else notch,
    )


@dataclass(slots=True)
class _Reader:
    """Builds the parts of a scene; what cannot be built is reported and left out."""

    document: Document
    row: dict[str, Any]
    files: SceneFiles
    read: dict[Path, Material | None] = field(default_factory=dict)

    def scene(self) -> Scene:
        """Read all parts, raise all that is wrong with them, put them together."""
        row, document = self.row, self.document
        parts = self.parts()
        document.finish()
        curvature = row["wrinkle"]["curvature"]
        return Scene(
            name=row["name"] or document.file.stem,
            path=document.file,
            digest=self.files.digest(),
            hem=row["hem"],
            surroundings=row["gallery"]["surroundings"],
            allowed=row["check"]["allow"],
            element_size=row["mesh"]["element_size_mm"] or FIRST_SIZE,
            tolerance=row["mesh"]["tolerance_percent"],
            element_sizes=MappingProxyType(
                {n: size for n, p in row["panel"].items() if (size := p["element_size_mm"])}
            ),
            smallest_notch=row["mesh"]["smallest_notch_mm"],
            seed=row["mesh"]["seed"],
            curvature=curvature,
            c_threshold=row["wrinkle"]["c_threshold_per_mm"] or DEFAULT_THRESHOLD[curvature],
            **parts,
        )

    def parts(self) -> dict[str, Any]:
        """Parts of the scene that are more than one value, by field."""
        row, document = self.row, self.document
        pattern, foam, design = self.pattern(), self.foam(), self.design()
        boxes = make_boxes(document, row["zones"]["box"], pattern)
        parts: dict[str, Any] = {
            "pattern": pattern,
            "foam": foam,
            "design": design,
            "boxes": boxes,
            "materials": self.materials(pattern),
            "textures": self.textures(),
            "placement": self.placement(pattern),
            "stages": make_stages(document, row["stage"], pattern),
            "hooks": make_hooks(document, row, pattern, foam),
            "frames": make_frames(document, row, pattern, foam),
            "limits": make_limits(document, row["accept"], pattern, boxes),
            "improve": make_freedom(document, row, pattern, foam),
            "rigs": make_rigs(document, row["rig"], self.files),
            "cameras": make_cameras(document, row["camera"], foam),
        }
        _check_mesh(document, row)
        check_wires(document, row, pattern, foam)
        check_overlap(document, pattern, parts["placement"])
        check_distance(document, parts["placement"], foam)
        check_scale(document, pattern, foam)
        check_hem(document, pattern, row["hem"])
        parts["thread"] = make_thread(document, row["thread"])
        parts["seam_kinds"] = make_seam_kinds(document, row["seam"], pattern)
        return parts

    def pattern(self) -> Pattern | None:
        row = self.row["pattern"]
        path = self.files.find(("pattern", "file"), row["file"])
        seams = self.files.find(("pattern", "seams"), row["seams"])
        if path is None or seams is None:
            return None
        try:
            pattern = read_pattern(path, seams, **_reading(self.row))
        except InputError as error:
            self.document.note(("pattern",), error)
            return None
        panels = []
        for panel in pattern.panels:
            angle = self.row["panel"].get(panel.name, {}).get("grain_deg")
            if angle is not None:
                radians = np.radians(angle)
                grain = np.array([np.cos(radians), np.sin(radians)])
                panel = replace(panel, grain=grain)
            panels.append(panel)
        return replace(pattern, panels=tuple(panels))

    def surface_file(self, table: str, name: str | None) -> Path | None:
        """Count a surface file and those that it names."""
        path = self.files.find((table, "file"), name)
        for named in () if path is None else named_files(path):
            with self.document.blame((table, "file")):
                self.files.count(named)
        return path

    def foam(self) -> Foam | None:
        row = self.row["foam"]
        path = self.surface_file("foam", row["file"])
        curves = self.files.find(("foam", "curves"), row["curves"])
        if path is None or row["unit"] is None or row["material"] is None:
            return None
        if row["curves"] is not None and curves is None:
            return None
        material_file = self.material_file(("foam", "material"), row["material"])
        if material_file is None:
            return None
        try:
            return read_foam(
                path,
                material=read_foam_material(material_file),
                unit=row["unit"],
                up=row["up"],
                curves=curves,
                mending=Mending(
                    close=row["close"] or False,
                    thicken=row["thicken_mm"] or 0.0,
                    unite=row["unite"] or False,
                    body=row["body"],
                    smooth=row["smooth_mm"] or 0.0,
                ),
            )
        except InputError as error:
            self._surface_problems("foam", path, error)
            return None

    def design(self) -> Design | None:
        row = self.row["design"]
        path = self.surface_file("design", row["file"])
        if path is None or row["unit"] is None:
            return None
        try:
            drawn = read_surface(path, unit=row["unit"], up=row["up"])
        except InputError as error:
            self._surface_problems("design", path, error)
            return None
        return Design(**drawn._asdict(), visible=row["side"] == "visible")

    def _surface_problems(self, table: str, path: Path, error: InputError) -> None:
        """Report what is wrong with a surface; a wrong size is that of the unit in the scene."""
        wrong = [p for p in error.problems if p.key == "size"]
        for p in wrong:
            got = f'"{self.row[table]["unit"]}", by which {path.name} is {p.got} wide'
            self.document.report((table, "unit"), got, p.expected, p.hint)
        if not wrong:
            self.document.note((table,), error)

    def material_file(self, key: Key, name: str) -> Path | None:
        try:
            path = material_path(name, beside=self.document.file.parent)
        except InputError as error:
            for p in error.problems:
                self.document.report(key, p.got, p.expected, p.hint)
            return None
        return self.files.find(key, name, path)

    def material(self, key: Key, name: str) -> Material | None:
        """Read a material once, however many panels have it."""
        path = self.material_file(key, name)
        if path is None:
            return None
        if path not in self.read:
            self.read[path] = None
            with self.document.blame(key):
                material = self.read[path] = read_material(path)
                maps = material.appearance.maps
                if maps is not None:
                    for file in map_files(path.parent / maps.folder).values():
                        self.files.count(file)
        return self.read[path]

    def materials(self, pattern: Pattern | None) -> MappingProxyType[str, Material]:
        default = self.row["pattern"]["material"]
        own = {n: r["material"] for n, r in self.row["panel"].items() if r["material"] is not None}
        names = tuple(own) if pattern is None else tuple(p.name for p in pattern.panels)
        if pattern is not None:
            for name in self.row["panel"]:
                known(self.document, ("panel", name), name, names, "a panel of the pattern")
        materials = {}
        for name in names:
            key = ("panel", name, "material") if name in own else ("pattern", "material")
            chosen = own.get(name, default)
            if chosen is None:
                self.document.report(
                    ("panel", name, "material"), "nothing", "a material, here or in [pattern]"
                )
            elif (material := self.material(key, chosen)) is not None:
                materials[name] = material
        return MappingProxyType(materials)

    def textures(self) -> MappingProxyType[str, Appearance | None]:
        looks: dict[str, Appearance | None] = {}
        for name in self.row["gallery"]["textures"] or ():
            if name == AS_BUILT:
                own, look = name, None
            elif (material := self.material(("gallery", "textures"), name)) is not None:
                own, look = material.name, material.appearance
            else:
                continue
            if own in looks:
                expected = f"textures of different names, {own!r} is one already"
                self.document.report(("gallery", "textures"), shown(name), expected)
            looks[own] = look
        return MappingProxyType(looks)

    def placement(self, pattern: Pattern | None) -> MappingProxyType[str, Pose]:
        poses = {}
        for name, row in self.row["placement"].items():
            key = ("placement", name)
            if pattern is not None:
                panels = (p.name for p in pattern.panels)
                known(self.document, key, name, panels, "a panel of the pattern")
            rotation = self.rotation(key, row)
            if rotation is not None and row["translation_mm"] is not None:
                with self.document.blame(key):
                    poses[name] = Pose(rotation=rotation, translation=row["translation_mm"])
        return MappingProxyType(poses)

    def rotation(self, key: Key, row: dict[str, Any]) -> FloatArray | None:
        """Return the rotation given as a matrix or by the directions of the panel's two axes."""
        if (row["axes"] is None) == (row["rotation"] is None):
            got = "neither" if row["axes"] is None else "both"
            self.document.report(key, got, "one of axes and rotation")
            return None
        if row["axes"] is None:
            return cast("FloatArray", row["rotation"])
        letters = [axis[1:] for axis in row["axes"]]
        if len(letters) != 2 or letters[0] == letters[1] or not set(row["axes"]) <= set(_AXES):
            expected = f"two different axes out of {', '.join(_AXES)}"
            self.document.report((*key, "axes"), list(row["axes"]), expected)
            return None
        u, v = (_AXES[axis] for axis in row["axes"])
        return np.column_stack([u, v, np.cross(u, v)])


def _check_mesh(document: Document, row: dict[str, Any]) -> None:
    """Report a mesh that is asked for in two ways, or in none."""
    if not isinstance(mesh := document.data.get("mesh"), dict):
        return  # it is missing, or no table, which is reported
    size, tolerance = (name in mesh for name in ("element_size_mm", "tolerance_percent"))
    if not size and not tolerance:
        document.report(
            ("mesh", "element_size_mm"), "nothing", "a number",
            "or tolerance_percent, and the mesh follows from the error it may have",
        )  # fmt: skip
    elif size and tolerance:
        document.report(
            ("mesh", "tolerance_percent"), "element_size_mm as well", "one of them",
            "delete one: with a tolerance the mesh follows from the error it may have",
        )  # fmt: skip
    sized = [name for name, panel in row["panel"].items() if panel["element_size_mm"] is not None]
    for name in sized if tolerance else ():
        document.report(
            ("panel", name, "element_size_mm"), "a size", "none beside mesh.tolerance_percent",
            "delete it: the mesh follows from the tolerance",
        )  # fmt: skip
