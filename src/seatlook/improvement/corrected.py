"""What is written of corrections: the corrected pattern, its seams, and the table."""

from __future__ import annotations

from pathlib import Path

from seatlook import io
from seatlook.improvement.candidate import Candidate
from seatlook.improvement.changes import Changes
from seatlook.improvement.propose import Proposal, Proposals
from seatlook.model import Scene, Solution

PATTERN, SEAMS, CORRECTIONS = "pattern.dxf", "seams.toml", "corrections.csv"
WRITTEN = (PATTERN, SEAMS, CORRECTIONS)
_CUT = ("offset", "length")


def rows_of(proposals: Proposals) -> list[dict[str, object]]:
    """One row per proposal, amounts in mm."""
    return [
        {
            "kind": p.move.kind,
            "names": " ".join(p.move.names),
            "places": "; ".join(f"{a} to {b}" for a, b in p.move.places if a),
            "amount_mm": 1e3 * p.amount,
            "gain_percent": 100.0 * p.share,
            "sentence": p.sentence,
        }
        for p in proposals.proposals
    ]


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
    amounts: dict[Candidate, float] = {}
    for proposal in proposals.proposals:
        for candidate, amount in _cut(proposal).items():
            amounts[candidate] = amounts.get(candidate, 0.0) + amount
    pattern = Changes(solution, scene.pattern).pattern(amounts)
    io.write_dxf(pattern, out / PATTERN)
    io.write_seams(pattern, out / SEAMS)
    rows = rows_of(proposals)
    heads = tuple(rows[0]) if rows else ("kind",)
    io.write_table(out / CORRECTIONS, heads, [tuple(row.values()) for row in rows])
    return WRITTEN


def _cut(proposal: Proposal) -> dict[Candidate, float]:
    return {c: v for c, v in proposal.amounts.items() if c.kind in _CUT}
