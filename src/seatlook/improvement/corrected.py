"""What is written of corrections: the corrected pattern, its seams, and the tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from seatlook import io
from seatlook.assembly.ease import seam_ease
from seatlook.improvement.candidate import Candidate, words_of
from seatlook.improvement.changes import Amounts, Changes, added
from seatlook.improvement.loop import Iteration
from seatlook.improvement.moves import Move
from seatlook.improvement.proof import Proof
from seatlook.improvement.propose import Proposals, in_words
from seatlook.model import Pattern, Scene, Solution

PATTERN, SEAMS, CORRECTIONS = "pattern.dxf", "seams.toml", "corrections.csv"
COURSE, PROOF, LENGTHS = "course.csv", "proof.csv", "lengths.csv"
WRITTEN = (PATTERN, SEAMS, CORRECTIONS, LENGTHS)
WRITTEN_BY_LOOP = (*WRITTEN, COURSE, PROOF)
_CUT = ("offset", "length")
_SAME = 5e-5  # m, by which neighbouring stretches may differ that are named as one
_Row = dict[str, object]


def rows_of(proposals: Proposals) -> list[_Row]:
    """One row per proposal, amounts in mm."""
    return [
        _row(p.move, p.amount) | {"gain_percent": 100.0 * p.share, "sentence": p.sentence}
        for p in proposals.proposals
    ]


def rows_made(changes: Changes, made: Amounts, chosen: Sequence[Move] = ()) -> list[_Row]:
    """One row per stretch of an edge, length, hook or panel that is changed, amounts in mm.

    Parameters
    ----------
    chosen : corrections; what is in none of them was changed so that seams can be sewn
    """
    meant = {candidate for move in chosen for candidate in move.share}

    def why(move: Move) -> str:
        return "correction" if not chosen or meant & move.share.keys() else "keeps its seam"

    rows = [
        _row(move, amount) | {"why": why(move), "sentence": in_words(move, amount)}
        for move, amount in _parts(changes, made)
    ]
    return sorted(rows, key=lambda row: str(row["why"]))


def length_rows(before: Pattern, after: Pattern) -> list[_Row]:
    """One row per seam: lengths of both sides in mm, and by how much the near one is longer."""
    rows = list[_Row]()
    for seam in after.seams:
        old, new = seam_ease(before, seam), seam_ease(after, seam)
        rows.append(
            {
                "seam": seam.name,
                "near": seam.a,
                "far": " ".join(seam.b),
                "near_mm": 1e3 * new.length_a,
                "far_mm": 1e3 * new.length_b,
                "ease_before_mm": 1e3 * old.ease,
                "ease_mm": 1e3 * new.ease,
            }
        )
    return rows


def course_rows(iterations: Sequence[Iteration]) -> list[_Row]:
    """One row per iteration: the objective, its parts, and what was done."""
    return [
        {
            "iteration": one.number,
            "objective": one.value.total,
            "w2": one.value.w2,
            "strain": one.value.strain,
            "gap": one.value.gap,
            "beyond_goals": one.beyond,
            "expected_gain": one.expected,
            "warm_solves": one.solves,
            "what": one.ended or one.sentence,
        }
        for one in iterations
    ]


def proof_rows(proof: Proof) -> list[_Row]:
    """One row per seed: the objective and its parts before and after, solved cold."""
    return [
        {
            "seed": seed,
            **{
                f"{part}_{when}": getattr(one, name)
                for when, one in (("before", before), ("after", after))
                for part, name in (
                    ("objective", "total"), ("w2", "w2"), ("strain", "strain"), ("gap", "gap")
                )
            },
        }
        for seed, before, after in zip(proof.seeds, proof.before, proof.after, strict=True)
    ]  # fmt: skip


def write_corrected(
    scene: Scene, solution: Solution, proposals: Proposals, out: Path
) -> tuple[str, ...]:
    """Write the pattern with all proposals of edges made, its seams file, and the table.

    Panels, edges, notches and layers keep their names; hooks and foam stand in the table only.
    Return the files' names.

    Raises
    ------
    InputError
        A folder that cannot be written.
    """
    made = added(*(proposal.amounts for proposal in proposals.proposals))
    _write_pattern(scene.pattern, Changes(solution, scene.pattern).pattern(_cut(made)), out)
    _write_rows(rows_of(proposals), out / CORRECTIONS)
    return WRITTEN


def write_improved(
    changes: Changes, iterations: Sequence[Iteration], proof: Proof, out: Path
) -> tuple[str, ...]:
    """Write the pattern where the loop ended, its seams, corrections, course and proof.

    Return the files' names.

    Raises
    ------
    InputError
        A folder that cannot be written.
    """
    made, chosen = iterations[-1].made, iterations[-1].chosen
    _write_pattern(changes.drawn, changes.pattern(_cut(made)), out)
    _write_rows(rows_made(changes, made, chosen), out / CORRECTIONS)
    _write_rows(course_rows(iterations), out / COURSE)
    _write_rows(proof_rows(proof), out / PROOF)
    return WRITTEN_BY_LOOP


def _row(move: Move, amount: float) -> _Row:
    return {
        "kind": move.kind,
        "names": " ".join(move.names),
        "places": "; ".join(f"{a} to {b}" for a, b in move.places if a),
        "amount_mm": 1e3 * amount,
    }


def _write_pattern(before: Pattern, pattern: Pattern, out: Path) -> None:
    io.write_dxf(pattern, out / PATTERN)
    io.write_seams(pattern, out / SEAMS)
    _write_rows(length_rows(before, pattern), out / LENGTHS)


def _write_rows(rows: Sequence[_Row], path: Path) -> None:
    heads = tuple(rows[0]) if rows else ("kind",)
    io.write_table(path, heads, [tuple(row.values()) for row in rows])


def _cut(made: Amounts) -> dict[Candidate, float]:
    return {c: v for c, v in made.items() if c.kind in _CUT}


def _parts(changes: Changes, made: Amounts) -> Iterator[tuple[Move, float]]:
    """What is changed, neighbouring stretches of one edge by the same amount as one."""
    runs: list[list[Candidate]] = []
    order = sorted(
        (c for c in made if abs(made[c]) >= _SAME),
        key=lambda c: (c.kind, c.panel, c.side, c.stretch, c.name),
    )
    for candidate in order:
        last = runs[-1][-1] if runs else None
        goes_on = last is not None and candidate.kind == "offset" == last.kind
        beside = last is not None and (last.panel, last.side, last.stretch + 1) == (
            candidate.panel, candidate.side, candidate.stretch
        )  # fmt: skip
        if last is not None and goes_on and beside and abs(made[last] - made[candidate]) < _SAME:
            runs[-1].append(candidate)
        else:
            runs.append([candidate])
    for run in runs:
        first, place = run[0], ("", "")
        if first.kind == "offset":
            side = changes.outlines[first.panel].sides[first.side]
            place = words_of(side, first.stretch, run[-1].stretch)
        share = dict.fromkeys(run, 1.0)
        yield Move(kind=first.kind, names=(first.name,), places=(place,), share=share), made[first]
