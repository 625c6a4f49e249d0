"""Options that commands share, and how they find a scene and its result.

SCENE comes first, RESULT second; without it the ``result.npz`` beside the scene is taken.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._output import note, say
from seatlook.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from seatlook.results.resolution import Resolution
    from seatlook.seat import Seat

SceneFile = Annotated[Path, Parameter(help="Scene file (TOML).")]
ResultFile = Annotated[
    Path | None,
    Parameter(help='Result file (.npz); "result.npz" beside the scene if not given.'),
]
Out = Annotated[Path, Parameter(help="Folder to write to.")]
Seed = Annotated[
    int | None, Parameter(help="Seed of mesh jitter and imperfection, instead of the scene's.")
]
ElementSize = Annotated[
    float | None,
    Parameter(help="Mean edge length of the mesh, instead of the scene's; panels' own scale."),
]
TolerancePercent = Annotated[
    float | None,
    Parameter(
        help="Error of the zone means of W2 that the mesh is to keep, instead of an element size."
    ),
]
Resume = Annotated[
    bool,
    Parameter(
        negative=(),
        help="Take the result in the folder if it is converged and of all that goes in.",
    ),
]
SingleFile = Annotated[
    bool, Parameter(negative=(), help="Put the images into index.html, to send it as one file.")
]
Force = Annotated[
    bool,
    Parameter(negative=(), help="Overwrite files that seatlook did not write, or were edited."),
]
DryRun = Annotated[bool, Parameter(negative=(), help="List what would be made, and make nothing.")]
Changes = Annotated[
    tuple[str, ...],
    Parameter(
        name="--set",
        negative=(),
        help="KEY=VALUE over the scene's, such as mesh.seed=3; may be given more than once.",
    ),
]
Scored = Annotated[
    bool, Parameter(help="Score how visible the wrinkles are, always where [accept] limits it.")
]
Names = Annotated[tuple[str, ...], Parameter(negative=())]
Preview = Annotated[
    bool,
    Parameter(
        negative=(),
        help="Be content with a result that is converged but not resolved: do not end with 3.",
    ),
]
ResultOut = Annotated[Path, Parameter(help="Result file to write (.npz).")]


def seat_of(
    scene: Path,
    seed: int | None = None,
    element_size_mm: float | None = None,
    changes: tuple[str, ...] = (),
    tolerance_percent: float | None = None,
) -> Seat:
    """Open a scene with what the command line overrides."""
    import seatlook

    size = None if element_size_mm is None else element_size_mm / 1e3
    tolerance = None if tolerance_percent is None else tolerance_percent / 100
    return seatlook.open(scene, changes=changes, seed=seed, element_size=size, tolerance=tolerance)


def solved_seat(scene: Path, result: Path | None = None) -> Seat:
    """Open a scene with its result; say so if the result is not of the scene as it now is."""
    import seatlook

    path = result_file(scene, result)
    seat = seatlook.open(scene, result=path)
    if not seat.current:
        say(f"{path}: solved for another state of {scene}; its shape is shown as it was")
    return seat


def result_file(scene: Path, result: Path | None = None) -> Path:
    """Return the path of a result; say how to make one where there is none."""
    path = result or scene.with_name("result.npz")
    if not path.is_file():
        raise InputError.single(
            str(path),
            got="no such file",
            expected=f"a result; make it with: seatlook solve {scene} --out {path}",
        )
    return path


def result_of(file: Path) -> Path:
    """Return a result file, which may be named by the scene that it lies beside."""
    return result_file(file) if file.suffix.lower() == ".toml" else file


def checked_result_name(out: Path) -> None:
    """Refuse another ending than that of result files."""
    if out.suffix != ".npz":
        raise InputError.single("--out", got=out.name, expected="a name that ends in .npz")


def note_coarse(seat: Seat) -> None:
    """Say, before a solve, which material its mesh will not resolve, or what a tolerance takes."""
    from seatlook.chain.local import forecast
    from seatlook.results.resolution import expected_waves

    if seat.scene.tolerance is not None:
        note(forecast(seat.scene).sentence)
        return
    waves = expected_waves(seat.cover)
    note(*(f"will not be resolved: {wave.sentence}" for wave in waves if not wave.resolved))


def exit_code_of(*results: Resolution, names: Sequence[str] = (), preview: bool = False) -> int:
    """3 if a result is not resolved, which is said; a preview need only be converged.

    Parameters
    ----------
    names : of the results, said before what is wrong with them
    """
    heads = [f"{name}: " for name in names] or [""] * len(results)
    for head, result in zip(heads, results, strict=True):
        if not result.resolved:
            say(f"{head}{result.sentence}")
    if preview:
        return 3 if any(result.balance for result in results) else 0
    return 0 if all(result.resolved for result in results) else 3
