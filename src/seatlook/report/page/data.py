"""What the gallery page shows, as plain values: no arrays, no scene, no solver."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from types import MappingProxyType

from seatlook.errors import InputError
from seatlook.model.table import Table
from seatlook.report.page.types import (
    Check,
    CloseUp,
    DesignSection,
    MakingSection,
    MapView,
    ScoreSection,
    Spot,
    ViewerSection,
    WrinkleSection,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class RigHead:
    """Head of one column of the grid.

    Parameters
    ----------
    ev100 : float               exposure of every picture in the column
    illuminance : float [lux]   on a grey card at the seat
    lights : one short description per light, such as "sun, 97 klx, elevation 70 deg"
    places : (name, azimuth, elevation [deg], near) of each, seen from the target of the camera
    """

    name: str
    ev100: float
    illuminance: float
    lights: tuple[str, ...]
    places: tuple[tuple[str, float, float, bool], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Dot:
    """A light on the dial: its rig, direction [deg] and place; the middle is straight above."""

    rig: str
    name: str
    azimuth: float
    elevation: float
    near: bool

    @property
    def x(self) -> float:
        """To the right, the occupant's left, in SVG units."""
        return self._radius * math.sin(math.radians(self.azimuth))

    @property
    def y(self) -> float:
        """Downward, to the front."""
        return self._radius * math.cos(math.radians(self.azimuth))

    @property
    def _radius(self) -> float:
        return 90.0 - max(self.elevation, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class PageData:
    """Everything on the page; ``write_page`` turns it into ``index.html``.

    Parameters
    ----------
    title : name of the scene
    camera : name of the view all pictures and maps are taken from
    size : (width, height) of every picture in pixels
    pixels_per_degree : float       of that camera, so a reader can check the viewing distance
    textures : rows of the grid, in order
    rigs : columns of the grid, in order
    pictures : (texture, rig name) -> path relative to the page; one for every cell
    maps : W1, W2, W_stretch, W_compression, ...
    zones : one row per zone
    differences : what a table compares -> the table; stands first on a page of several variants
    seams : one row per seam: its two lengths and the ease between them
    shape : one row per zone: its gap to the foam
    wrinkles : the worst wrinkles and the distortion of the texture
    making : energy balance, hooks, and pictures of the stages
    design : the shape against its design surface; None where there is none
    spots : places of the worst wrinkles in the pictures
    toml : what parameters belong to -> the same as TOML, with every digit
    score : how visible wrinkles are; None where nothing was scored
    viewer : the seat to be turned; None where there is none
    parameters : what they belong to -> table of keys, values and sources
    provenance : label -> value: versions, scene digest, seed, element size, lambda / h, ...
    checks : solver conditions and accept limits
    status : of the solver, such as "converged"
    warnings : sentences to read before the pictures are trusted
    baseline : the variant that changes in ``differences`` and ``zones`` are from
    summary : sentences that answer the page's questions, above everything else; the first is read
        first
    close_up : the picture beside them
    verdict : the status in one word
    again : command that makes the page anew as one file; "" where there is none
    facing : the two cells that are compared first; the first two of the grid if not given
    history : column -> values, one per solver step; "time" is the horizontal axis if present
    files : paths of what else lies in the folder, such as "zones.csv"
    """

    title: str
    camera: str
    size: tuple[int, int]
    pixels_per_degree: float
    textures: tuple[str, ...]
    rigs: tuple[RigHead, ...]
    pictures: MappingProxyType[tuple[str, str], str]
    maps: tuple[MapView, ...]
    zones: Table
    parameters: MappingProxyType[str, Table]
    provenance: MappingProxyType[str, str]
    status: str
    differences: MappingProxyType[str, Table] = field(default_factory=lambda: MappingProxyType({}))
    seams: Table | None = None
    shape: Table | None = None
    wrinkles: WrinkleSection | None = None
    making: MakingSection | None = None
    design: DesignSection | None = None
    score: ScoreSection | None = None
    viewer: ViewerSection | None = None
    spots: tuple[Spot, ...] = ()
    toml: MappingProxyType[str, str] = field(default_factory=lambda: MappingProxyType({}))
    checks: tuple[Check, ...] = ()
    warnings: tuple[str, ...] = ()
    history: MappingProxyType[str, tuple[float, ...]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    files: tuple[str, ...] = ()
    baseline: str = ""
    summary: tuple[str, ...] = ()
    close_up: CloseUp | None = None
    verdict: str = ""
    again: str = ""
    facing: tuple[tuple[str, str], tuple[str, str]] | None = None

    def __post_init__(self) -> None:
        cells = {(texture, rig.name) for texture in self.textures for rig in self.rigs}
        if not cells or cells != set(self.pictures):
            odd = sorted(map(str, cells ^ set(self.pictures)))
            raise InputError.single(
                "PageData.pictures",
                got=f"missing or extra: {', '.join(odd) or 'no cell at all'}",
                expected="one for every texture and rig",
            )
        for name in (*self.images, *self.files):
            path = PurePosixPath(name)
            if path.is_absolute() or ".." in path.parts or ":" in name or "\\" in name:
                raise InputError.single(
                    "path on the page", got=name, expected="relative to the page and below it"
                )

    @property
    def images(self) -> tuple[str, ...]:
        """Every image the page shows."""
        alone = (view.alone for view in self.views if view.alone)
        making = self.making.pictures if self.making else ()
        return (*self.pictures.values(), *(view.image for view in self.views), *alone, *making)

    @property
    def compared(self) -> tuple[tuple[str, str], tuple[str, str]]:
        """Cells (texture, rig) that stand as A and B when the page opens."""
        cells = [(texture, rig.name) for texture in self.textures for rig in self.rigs]
        return self.facing or (cells[0], cells[min(1, len(cells) - 1)])

    @property
    def lights(self) -> tuple[Dot, ...]:
        """All lights of all rigs, for the dial."""
        return tuple(
            Dot(rig=rig.name, name=name, azimuth=azimuth, elevation=elevation, near=near)
            for rig in self.rigs
            for name, azimuth, elevation, near in rig.places
        )

    @property
    def visibility(self) -> dict[tuple[str, str], float]:
        """VWI of each cell; empty where nothing was scored."""
        return dict(self.score.cells) if self.score else {}

    @property
    def views(self) -> tuple[MapView, ...]:
        """Every map on the page."""
        sections = (section for section in (self.wrinkles, self.score) if section)
        further = [view for section in sections for view in section.maps]
        return (*self.maps, *further)
