"""The command that makes the demo seat."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._evaluate import run_evaluation
from seatlook.cli._options import Force, Out, Preview, Resume, Scored, Seed, exit_code_of, seat_of
from seatlook.cli._output import Json, note, progress
from seatlook.cli._shares import Shares, shares


def demo(
    *,
    out: Out = Path("out/demo"),
    shape: str = "cushion",
    scale: float = 1.0,
    bolster_mm: float | None = None,
    ease: Shares = (),
    short: Shares = (),
    tension_percent: float = 1.0,
    material: str = "leather-laminate",
    insert: str | None = None,
    element_size_mm: float = 7.0,
    tolerance_percent: float | None = None,
    seed: Seed = 0,
    resume: Resume = False,
    score: Scored = True,
    files_only: Annotated[bool, Parameter(negative=())] = False,
    force: Force = False,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Write the files of a seat with a pattern that fits it, and evaluate them.

    Leaves the design surface, foam, wires, pattern, seams and a commented scene.toml to start
    from, and everything that "seatlook evaluate" leaves.

    Example: seatlook demo --out out/demo

    Example: seatlook demo --out out/eased --ease INSERT-BOLSTER_L=4%

    Example: seatlook demo --shape horseshoe --scale 0.8 --bolster-mm 60 --out out/horseshoe

    Parameters
    ----------
    shape
        cushion, horseshoe, backrest, headrest, box or saddle.
    scale
        Size, 0.6 to 1.6: of all lengths but the height of the bolsters.
    bolster_mm
        Height of the bolsters over the middle of the seat, 0 to 100; that of the shape, if not
        given. Headrest, box and saddle have none.
    ease
        SEAM=2%: make one sewing line of this seam longer than its partner, a sewing fault.
    short
        PANEL=3%: make this panel narrower across its grain.
    tension_percent
        All panels are cut smaller by this share, so that the cover is taut.
    material
        Cover material, from "seatlook materials list".
    insert
        Material of the middle panel, if it is another one.
    element_size_mm
        Mean edge length of the mesh.
    tolerance_percent
        Error of the zone means of W2 that the mesh is to keep, instead of an element size.
    files_only
        Write the files, and evaluate nothing.
    """
    from seatlook.chain.run_folder import run_folder
    from seatlook.seats.family import SHAPES
    from seatlook.seats.files import LEFT, write_demo

    eased, shortened = shares("--ease", ease), shares("--short", short)
    if bolster_mm is not None and shape in SHAPES and SHAPES[shape].bolster is None:
        note(f"the {shape} has no bolsters: --bolster-mm changes nothing")
    with run_folder(out, writes=LEFT, force=force), progress() as show:
        scene = write_demo(
            out,
            shape=shape,
            scale=scale,
            bolster=None if bolster_mm is None else bolster_mm / 1e3,
            ease=eased,
            short=shortened,
            tension=tension_percent / 100,
            material=material,
            insert=insert,
            element_size_mm=element_size_mm,
            tolerance_percent=tolerance_percent,
            seed=seed or 0,
            progress=show,
        )
    note(f"scene: {scene}")
    if files_only:
        return 0
    seat = seat_of(scene)
    missed = run_evaluation(seat, out, resume=resume, score=score, force=force, json=json)
    return exit_code_of(seat.resolution, preview=preview) or missed
