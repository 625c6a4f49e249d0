"""One run in a process of its own: what is asked comes by stdin, what happens goes to stdout.

Each is a line of JSON. The run ends when the server does: then stdin ends.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any, TextIO

from seatlook import _interrupt
from seatlook.errors import SeatlookError

STAGES = "stages"  # folder of the snapshots, in that of the run
_EVERY = 0.2  # s between two words on how far the work is


def main() -> int:
    """Run what is asked, and return the exit code of the command."""
    _interrupt.heed()
    asked = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_the_server, daemon=True).start()
    # What libraries print must not come between the lines.
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)
    try:
        code = (_run if asked["command"] == "evaluate" else _command)(asked, answers)
    except SeatlookError as error:
        problems = [str(one) for one in getattr(error, "problems", ())] or [str(error)]
        _say(answers, "failed", errors=problems)
        return error.exit_code
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt) or _interrupt.asked():
            _say(answers, "cancelled")
            return _interrupt.EXIT_CODE
        _say(answers, "failed", errors=[f"{type(error).__name__}: {error}"])
        raise
    return code


def _run(asked: dict[str, Any], answers: TextIO) -> int:
    import seatlook

    out, last = Path(asked["out"]), [0.0]

    def progress(name: str, /, **figures: float | str) -> None:
        now = time.monotonic()
        if now - last[0] > _EVERY or figures.get("step") == figures.get("steps"):
            last[0] = now
            _say(answers, "progress", at=name, figures=figures)

    seat = seatlook.open(asked["scene"], changes=asked.get("changes", ()))
    seat.check()
    result = out / "result.npz"
    if not (asked["resume"] and seat.reuse(result)):
        seat.solve_in_stages(out / STAGES, resume=asked["resume"], progress=progress)
        seat.solve(result)
    outcome = seat.evaluate(
        out, resume=True, force=asked["resume"], score=asked.get("score", True), progress=progress
    )
    found = seat.resolution
    _say(answers, "done", status=found.status, reason=found.reason, missed=list(outcome.missed))
    return 0


def _command(asked: dict[str, Any], answers: TextIO) -> int:
    """Run another command as it is; its last line on stderr says where it is."""
    out = Path(asked["out"])
    out.parent.mkdir(parents=True, exist_ok=True)
    words = [sys.executable, "-m", "seatlook", asked["command"], asked["scene"], *asked["others"]]
    begun = time.monotonic()
    _say(answers, "progress", at=asked["command"], figures={})
    with (
        out.with_suffix(".log").open("w", encoding="utf-8") as log,
        subprocess.Popen(
            [*words, "--out", str(out)],
            stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.PIPE, text=True,
        ) as process,
    ):  # fmt: skip
        said: list[str] = []
        try:
            for line in process.stderr or ():
                said.append(line.strip())
                seconds = round(time.monotonic() - begun)
                _say(answers, "progress", at=said[-1], figures={"seconds": seconds})
            code = process.wait()
        except BaseException:
            process.send_signal(signal.SIGTERM)
            process.wait()
            raise
    if code in (0, 1, 3):
        _say(answers, "done", status="", reason="; ".join(said[-2:]), missed=[])
    else:
        _say(answers, "failed", errors=said[-5:] or [f"ended with {code}"])
    return code


def _say(answers: TextIO, what: str, **values: Any) -> None:
    answers.write(json.dumps({"what": what, **values}) + "\n")
    answers.flush()


def _end_with_the_server() -> None:
    sys.stdin.read()
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    sys.exit(main())
