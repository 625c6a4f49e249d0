"""A seat on a turntable: moving pictures of it from all sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from seatlook import io, pbr
from seatlook.chain.showing.parts import Pixels, digest_of, drawn, of_width, parts_folder
from seatlook.errors import InputError
from seatlook.model import Appearance, Camera, Rig, Solution
from seatlook.model.light.turning import round_the_seat, turned_rig
from seatlook.model.progress import Progress, silent
from seatlook.pbr.light.exposure import ev100

FORMATS = ("gif", "apng", "webp", "mp4")
_FEWEST, _MOST = 2, 720
_NARROWEST, _WIDEST = 16, 3840
_LONGEST = 600.0  # [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Turn:
    """How a seat is shown on a turntable.

    Parameters
    ----------
    pictures : int      of one whole turn
    seconds : float     that it lasts
    width : int [pixels] of a picture; its height follows from the camera
    quality : as for ``seatlook.render``
    surroundings : as for ``seatlook.render``
    lights_turn : whether the lights go round with the seat, so that the camera alone goes round
        it; if not, the seat turns below them and glosses run over it
    keep : leave the single pictures
    """

    pictures: int = 36
    seconds: float = 6.0
    width: int = 640
    quality: str = "standard"
    surroundings: str = "plain"
    lights_turn: bool = False
    keep: bool = False

    def __post_init__(self) -> None:
        for name, least, most in (
            ("pictures", _FEWEST, _MOST),
            ("width", _NARROWEST, _WIDEST),
            ("seconds", 0.1, _LONGEST),
        ):
            value = getattr(self, name)
            if not least <= value <= most:
                raise InputError.single(name, got=value, expected=f"{least:g} to {most:g}")


def draw_turntable(
    solution: Solution,
    appearance: Appearance | None,
    out: Sequence[Path],
    *,
    rig: Rig,
    camera: Camera,
    turn: Turn | None = None,
    progress: Progress = silent,
) -> tuple[Path, ...]:
    """Draw a solved cover from all sides and write it as moving pictures; return their paths.

    The single pictures are left beside the first of them, in ``NAME.pictures``, until all is
    written: a run that was stopped goes on with those that are there.

    Parameters
    ----------
    appearance : one for all panels, None for their own
    out : ``.gif``, ``.apng``, ``.webp`` or ``.mp4``, all of the same pictures
    camera : the first; it steps back as far as the widest side needs

    Raises
    ------
    InputError
        Another file ending, or ``.mp4`` without ffmpeg: before anything is drawn.
    NoOffscreenContext, RenderError
    """
    chosen = turn or Turn()
    for path in out:
        io.check_animation(path)
    with parts_folder(out[0].with_suffix(".pictures"), keep=chosen.keep) as folder:
        frames = list(_frames(solution, appearance, folder, rig, camera, chosen, progress))
        for path in out:
            progress("write", file=path.name)
            io.write_animation(frames, path, seconds=chosen.seconds)
    return tuple(out)


def _frames(
    solution: Solution,
    appearance: Appearance | None,
    folder: Path,
    rig: Rig,
    camera: Camera,
    turn: Turn,
    progress: Progress,
) -> Iterator[Pixels]:
    """Draw, or read, one picture after the other."""
    # A lamp beside the seat is nearer to the grey card at times: that must not flicker.
    steady = replace(rig, ev100=ev100(rig))
    used = solution.positions[solution.cover.faces.ravel()]
    ring = round_the_seat(of_width(camera, turn.width), used, turn.pictures)
    for k, one in enumerate(ring):
        progress("turn", step=k, steps=turn.pictures)
        angle = 0.0 if turn.lights_turn else 360.0 * k / turn.pictures
        lit = turned_rig(steady, angle, one.target)
        what = (appearance, lit, one, turn.quality, turn.surroundings)

        def draw(lit: Rig = lit, one: Camera = one) -> pbr.Image:
            return pbr.render(
                solution,
                appearance,
                rig=lit,
                camera=one,
                quality=turn.quality,
                surroundings=turn.surroundings,
            )

        yield drawn(folder / f"{k:03d}.png", digest_of(solution, *what), draw)
