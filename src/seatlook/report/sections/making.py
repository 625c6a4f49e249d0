"""The making of the cover on the page: where the work went, what the hooks pull, its pictures."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

from seatlook.model import Solution
from seatlook.model.table import Table
from seatlook.report.page.types import MakingSection
from seatlook.results.energy_balance import energy_balance
from seatlook.results.ring_pulls import overpulled, ring_pulls

# Left by "seatlook timeline" in the folder of the page: a strip and an animation.
STRIP, ANIMATION = "timeline.png", "timeline.gif"


def making_section(solution: Solution, folder: Path) -> MakingSection:
    """Gather the section; pictures are those that are in ``folder`` already."""
    strip, animation = (n if (folder / n).is_file() else None for n in (STRIP, ANIMATION))
    return MakingSection(
        work=_work(solution),
        hooks=_hooks(solution),
        over=overpulled(solution),
        strip=strip,
        animation=animation,
    )


def _work(solution: Solution) -> Table | None:
    balance = energy_balance(solution)
    if balance is None:
        return None
    rows = (
        ("work of seams, hooks and frame", balance.ties),
        ("work of the weight", balance.weight),
        ("stored in the uneven panels at the start", balance.placed),
        ("stored in cover and foam at the end", -balance.at_rest),
        ("friction on the foam", -balance.friction),
        ("damping by the time steps", -balance.damping),
        ("left over", balance.unexplained),
    )
    # Of the work alone, what uneven panels bring along would be shares above 100 %.
    share = 100.0 / balance.supplied if balance.supplied else 0.0
    return Table(
        heads=("energy", "[mJ]", "[% of all there was]"),
        rows=tuple((name, 1e3 * value, share * value) for name, value in rows),
    )


def _hooks(solution: Solution) -> Table:
    rows = []
    for name, group in groupby(ring_pulls(solution), key=lambda ring: ring.hook):
        rings = list(group)
        pulls = [ring.pull for ring in rings]
        hardest = max(rings, key=lambda ring: ring.pull)
        rows.append(
            (
                name,
                len(rings),
                sum(pulls),
                sum(pulls) / len(pulls),
                hardest.pull,
                1e-3 * hardest.per_length,
                1e3 * hardest.at,
                "none" if hardest.limit is None else hardest.limit,
                1e3 * max(ring.gap for ring in rings),
            )
        )
    return Table(
        heads=(
            "hook",
            "rings",
            "pull in all [N]",
            "mean of a ring [N]",
            "hardest [N]",
            "per mm of line [N/mm]",
            "at [mm]",
            "limit [N]",
            "largest gap [mm]",
        ),
        rows=tuple(rows),
    )
