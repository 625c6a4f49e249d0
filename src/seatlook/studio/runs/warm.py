"""The answer to another length of a sewing line, from the last balance of a run; labelled warm.

It stays for the next question, since what takes long is to load the result. Questions come by
stdin, answers go to stdout, each a line of JSON.
"""

from __future__ import annotations

import json
import os
import sys
import time
from typing import Any

import numpy as np

from seatlook import _interrupt
from seatlook.errors import InputError, SeatlookError

_DIGITS = 2  # of a mm, on a screen


class Answers:
    """Answers for one result.

    Parameters
    ----------
    scene, result : files
    """

    def __init__(self, scene: str, result: str) -> None:
        import seatlook
        from seatlook.improvement.changes import Changes

        self._seat = seatlook.open(scene, result=result)
        self._changes = Changes(self._seat.solution, self._seat.scene.pattern)

    def to(self, edge: str, amount: float) -> dict[str, Any]:
        """Map W2 where an edge is longer by an amount [m], shorter below 0.

        Raises
        ------
        InputError
            No edge of this name.
        SeatlookError
            The mesh cannot follow, or no balance is found.
        """
        from seatlook.chain.assess import wrinkle_map
        from seatlook.improvement.candidate import candidates_of
        from seatlook.improvement.warm import solve_warm

        begun, cpu = time.perf_counter(), time.process_time()
        cover, changes = self._seat.solution.cover, self._changes
        lengths = {
            one.name: one for one in candidates_of(cover, changes.outlines) if one.kind == "length"
        }
        if edge not in lengths:
            raise InputError.single("edge", got=repr(edge), expected=f"one of {', '.join(lengths)}")
        changed = changes.cover({lengths[edge]: amount})
        solution = solve_warm(self._seat.solution, changed)
        before = wrinkle_map(self._seat.criteria, self._seat.solution).w2
        after = wrinkle_map(self._seat.criteria, solution).w2
        area = cover.rest_area
        return {
            "label": "warm",
            "status": solution.status,
            "positions_mm": (np.round(1e3 * solution.positions.ravel(), _DIGITS) + 0.0).tolist(),
            "triangles": cover.faces.ravel().tolist(),
            "panel": cover.panel.tolist(),
            "panels": list(cover.panel_names),
            "w2": np.round(after, 4).tolist(),
            "w2_mean": [float(area @ values / area.sum()) for values in (before, after)],
            "vertices": len(cover.rest),
            "seconds": round(time.perf_counter() - begun, 3),
            "cpu_seconds": round(time.process_time() - cpu, 3),
        }


def main() -> int:
    """Answer until stdin ends."""
    _interrupt.heed()
    first = json.loads(sys.stdin.readline())
    out = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)
    answers: Answers | None = None
    for line in sys.stdin:
        asked = json.loads(line)
        try:
            answers = answers or Answers(first["scene"], first["result"])
            said = answers.to(str(asked["edge"]), float(asked["amount_mm"]) / 1e3)
        except SeatlookError as error:
            problems = [str(one) for one in getattr(error, "problems", ())]
            said = {"errors": problems or [str(error)]}
        out.write(json.dumps(said) + "\n")
        out.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
