"""The runs of a folder: one at a time, with how far it is; kept in a file, gone on with."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.files import write_text

COMMANDS = ("evaluate", "improve", "compare")
RUNS = "runs"  # folder of the runs, in that of the seat
_PATIENCE = 10.0  # s that a cancelled run has to tidy up
_LAST = ("done", "failed", "cancelled", "interrupted")


@dataclass(slots=True)
class Run:
    """One run.

    Parameters
    ----------
    name : of its folder in ``runs``
    command : out of ``COMMANDS``
    status : "running", or how it ended; "interrupted": the server ended first
    fraction : float [1] of what it is at, None where nobody knows
    seconds_left : float [s] of that
    found : "resolved", "converged, not resolved" or "not converged"
    """

    name: str
    command: str = "evaluate"
    status: str = "running"
    stage: str = ""
    fraction: float | None = None
    seconds_left: float | None = None
    figures: dict[str, float | str] = field(default_factory=dict)
    errors: list[str] = field(default_factory=list)
    found: str = ""
    reason: str = ""
    missed: list[str] = field(default_factory=list)


class Runs:
    """Runs of a folder.

    Parameters
    ----------
    root : of the seat
    file : that keeps what became of them
    changed : called with a run whenever there is news of it
    """

    def __init__(self, root: Path, file: Path, changed: Callable[[Run], None]) -> None:
        self._root, self._file, self._changed = root, file, changed
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._ended: subprocess.Popen[str] | None = None  # the one that was asked to end
        self._runs = self._read()

    def values(self) -> list[dict[str, Any]]:
        """All runs, the last one first."""
        with self._lock:
            return [asdict(run) for run in reversed(self._runs.values())]

    def start(self, scene: Path, asked: Mapping[str, Any]) -> str:
        """Begin a run, or go on with one, and return its name.

        Parameters
        ----------
        asked : ``command``; ``others``: more scenes, to compare with; ``resume`` names a run
            to go on with; ``score`` whether visibility is scored;
            ``changes`` are values over those of the scene

        Raises
        ------
        InputError
            Another one is running, or there is none to go on with.
        """
        with self._lock:
            if self._process is not None and self._process.poll() is None:
                raise InputError.single(
                    "run", got="a run that is going on", expected="one at a time"
                )
            resumed = asked.get("resume")
            if resumed is not None and resumed not in self._runs:
                raise InputError.single(
                    "resume", got=repr(resumed), expected="a run of this folder"
                )
            name = str(resumed) if resumed is not None else self._new_name()
            run = self._runs[name] = Run(name, self._command(asked, self._runs.get(name)))
            self._process = self._begin(scene, name, asked, resume=resumed is not None)
            threading.Thread(target=self._follow, args=(self._process, run), daemon=True).start()
            self._write()
        self._changed(run)
        return name

    def cancel(self) -> None:
        """End the run that is going on; what it has done so far is kept."""
        with self._lock:
            process = self._process
        if process is not None and process.poll() is None:
            self._ended = process
            process.send_signal(signal.SIGTERM)
            with suppress(subprocess.TimeoutExpired):
                process.wait(_PATIENCE)
                return
            process.kill()

    @staticmethod
    def _command(asked: Mapping[str, Any], before: Run | None) -> str:
        command = asked.get("command", "evaluate" if before is None else before.command)
        if command not in COMMANDS:
            raise InputError.single(
                "command", got=repr(command), expected=f"one of {', '.join(COMMANDS)}"
            )
        if before is not None and before.command != "evaluate":
            raise InputError.single(
                "resume", got=f"a run of {before.command}", expected="one of evaluate",
                hint="begin it again",
            )  # fmt: skip
        return str(command)

    def _new_name(self) -> str:
        stamp = time.strftime("%Y-%m-%d %H-%M-%S")
        names = [stamp, *(f"{stamp} {letter}" for letter in "bcdefghijk")]
        return next(name for name in names if name not in self._runs)

    def _begin(
        self, scene: Path, name: str, asked: Mapping[str, Any], *, resume: bool
    ) -> subprocess.Popen[str]:
        self._file.parent.mkdir(parents=True, exist_ok=True)
        with self._file.with_name("last-run.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "seatlook.studio.runs.child"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log,
                text=True, encoding="utf-8", start_new_session=True,
            )  # fmt: skip
        words = {
            "scene": str(scene),
            "out": str(self._root / RUNS / name),
            "command": self._runs[name].command,
            "others": [str(self._root / other) for other in asked.get("others", [])],
            "resume": resume,
            "score": bool(asked.get("score", True)),
            "changes": [str(one) for one in asked.get("changes", [])],
        }
        if process.stdin is not None:
            process.stdin.write(json.dumps(words) + "\n")
            process.stdin.flush()
        return process

    def _follow(self, process: subprocess.Popen[str], run: Run) -> None:
        """Hear what a run says until it ends."""
        begun = dict[str, float]()
        for line in process.stdout or ():
            said = json.loads(line)
            what = said.pop("what")
            if what == "progress":
                self._note(run, said, begun)
            else:
                run.status = what
                run.errors, run.missed = said.get("errors", []), said.get("missed", [])
                run.found, run.reason = said.get("status", ""), said.get("reason", "")
            self._changed(run)
        code = process.wait()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        if run.status not in _LAST and process is self._ended:
            run.status = "cancelled"  # before it could say so
        elif run.status not in _LAST:
            run.status = "failed"
            run.errors = [f"the run ended by itself, with {code}; go on with it, or see the memory"]
        run.fraction = run.seconds_left = None
        with self._lock, suppress(OSError):
            self._write()
        self._changed(run)

    def _note(self, run: Run, said: dict[str, Any], begun: dict[str, float]) -> None:
        """What a run is at, and how long that will take as it went so far."""
        name, figures, now = str(said["at"]), dict(said["figures"]), time.monotonic()
        stage = figures.pop("stage", name)
        step, steps = figures.pop("step", None), figures.pop("steps", None)
        begun.setdefault(name, now)
        run.stage, run.figures = str(stage), figures
        run.fraction = run.seconds_left = None
        if step is not None and steps:
            run.fraction = min(1.0, step / steps)
            if step > 0:
                run.seconds_left = round((now - begun[name]) * (steps - step) / step, 1)

    def _read(self) -> dict[str, Run]:
        try:
            rows = json.loads(self._file.read_text(encoding="utf-8"))
            runs = [Run(**row) for row in rows]
        except (OSError, ValueError, TypeError):
            return {}
        for run in runs:
            # Its process ended when the server did.
            run.status = "interrupted" if run.status == "running" else run.status
        return {run.name: run for run in runs if (self._root / RUNS / run.name).is_dir()}

    def _write(self) -> None:
        write_text(self._file, json.dumps([asdict(run) for run in self._runs.values()]))
