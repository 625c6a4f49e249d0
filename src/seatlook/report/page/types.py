"""What the sections of the gallery page show, as plain values; report/sections builds them."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType

from seatlook.errors import InputError
from seatlook.model.table import Table
from seatlook.report.page.chart import Tick


@dataclass(frozen=True, slots=True, kw_only=True)
class Spot:
    """A place to jump to: its label and pixel in the pictures."""

    label: str
    x: float
    y: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MapView:
    """A wrinkle index drawn on the cover, with its colour bar, from the gallery's camera.

    Parameters
    ----------
    image : path relative to the page
    low, high : float [unit]    values at the two ends of the colour bar
    meaning : one sentence for a reader who does not know the equation
    alone : path of the same map in a range of its own, which ends at ``alone_high``; or None
    """

    name: str
    image: str
    low: float
    high: float
    unit: str = "1"
    meaning: str = ""
    alone: str | None = None
    alone_high: float = 1.0

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise InputError.single(
                f"map {self.name}", got=f"{self.low:g} to {self.high:g}", expected="low < high"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One condition of "converged" or one limit of [accept]: a value, its limit, met or not."""

    name: str
    value: str
    limit: str
    kept: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """One section as a chart: polylines "x,y x,y ..." of the cover and of the shape that was meant.

    ``exaggeration`` is how many times larger heights are drawn than lengths.
    """

    name: str
    cover: str
    intended: str
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]
    exaggeration: float


@dataclass(frozen=True, slots=True, kw_only=True)
class WrinkleSection:
    """What the page shows of the wrinkles.

    Parameters
    ----------
    worst : one row per wrinkle, the worst first; no row where nothing is above the threshold
    profiles : the section across each
    distortion : one row per zone; None on a page of several variants
    maps : W2 net, distortion of the texture, a checker
    files : tables beside the page
    spots : where the worst wrinkles are in the pictures
    """

    worst: Table
    profiles: tuple[Profile, ...]
    distortion: Table | None
    maps: tuple[MapView, ...]
    files: tuple[str, ...]
    spots: tuple[Spot, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MakingSection:
    """What the section shows.

    Parameters
    ----------
    work : one row per part of the energy balance; None where the solver recorded none
    hooks : one row per hook: its rings and what they pull
    over : sentences on hooks that pull harder than their limit
    strip, animation : paths of these pictures; None where they are not in the folder
    """

    work: Table | None
    hooks: Table
    over: tuple[str, ...]
    strip: str | None
    animation: str | None

    @property
    def pictures(self) -> tuple[str, ...]:
        """Paths of what there is of both."""
        return tuple(name for name in (self.strip, self.animation) if name)

    @property
    def shown(self) -> bool:
        """Whether there is anything to show."""
        return bool(self.work or self.hooks.rows or self.pictures)


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSection:
    """One row per zone, and one per seam; ``visible`` if the design is the visible side."""

    zones: Table
    seams: Table
    visible: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewerSection:
    """The viewer as two texts: its script, and the content that this reads, in JSON."""

    script: str
    content: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SeenPlace:
    """A place where wrinkles show, or where there is one that does not.

    Parameters
    ----------
    rank : of the wrinkle there, from 1; None for a zone without one
    zone : name
    shows : whether it is seen in any texture under any rig
    texture, rig, vwi : where it is seen most, and how much
    hidden_by : textures in which no rig shows it
    x, y : its pixel in the pictures
    """

    rank: int | None
    zone: str
    shows: bool
    texture: str
    rig: str
    vwi: float
    hidden_by: tuple[str, ...]
    x: float
    y: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CloseUp:
    """A part of a picture beside the first sentence, round a pixel; or all of it.

    Parameters
    ----------
    image : path of a picture of the page
    caption : what it shows
    at : (x, y) of the pixel that is marked; None for the whole picture
    """

    image: str
    caption: str
    at: tuple[float, float] | None = None

    def window(self, size: tuple[int, int]) -> tuple[float, float, float, float]:
        """Return (left, top, width, height) of the part that is shown, in pixels."""
        if self.at is None:
            return 0.0, 0.0, *size
        share = 3.0
        width, height = size[0] / share, size[1] / share
        left, top = (
            min(max(v - part / 2, 0.0), whole - part)
            for v, part, whole in zip(self.at, (width, height), size, strict=True)
        )
        return left, top, width, height


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreSection:
    """What the page shows of visibility; only ``refused`` is set where no score can be given.

    Parameters
    ----------
    grid : a row per texture, a column per rig: VWI and equivalent height
    causes : a row per cell: VWI over all, where W_stretch and where W_compression is, cross-checks
    zones : a row per zone: worst VWI of each texture, and its equivalent height
    sentences : what follows from them
    cells : (texture, rig) -> VWI, marked in the grid of pictures
    places : wrinkles in view, and zones that show without one, the most visible first; None where
        nobody looked
    """

    grid: Table | None = None
    causes: Table | None = None
    zones: Table | None = None
    sentences: tuple[str, ...] = ()
    maps: tuple[MapView, ...] = ()
    checks: tuple[Check, ...] = ()
    refused: str = ""
    cells: MappingProxyType[tuple[str, str], float] = field(
        default_factory=lambda: MappingProxyType({})
    )
    places: tuple[SeenPlace, ...] | None = None
