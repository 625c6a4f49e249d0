"""Asks the process that holds the last result what another length of a line would do."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

from seatlook.errors import InputError, SolverError


class WarmAnswers:
    """A process that answers warm, begun at the first question and kept for the next."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._of: tuple[str, ...] = ()

    def ask(self, scene: Path, result: Path, edge: str, amount_mm: float) -> dict[str, Any]:
        """Map W2 of a result with a longer or shorter edge.

        Raises
        ------
        InputError
            No such edge, or a result that is not at rest.
        SolverError
            The process ended.
        """
        with self._lock:
            process = self._begun(scene, result)
            line = ""
            if process.stdin is not None and process.stdout is not None:
                with suppress(OSError):
                    process.stdin.write(json.dumps({"edge": edge, "amount_mm": amount_mm}) + "\n")
                    process.stdin.flush()
                    line = process.stdout.readline()
            if not line:
                self._end()
                raise SolverError("the process that answers ended by itself; solve it cold")
        said: dict[str, Any] = json.loads(line)
        if "errors" in said:
            raise InputError.single(
                "warm", got="; ".join(said["errors"]), expected="a change that can be answered",
                hint="solve it cold",
            )  # fmt: skip
        return said

    def close(self) -> None:
        """End the process."""
        with self._lock:
            self._end()

    def _begun(self, scene: Path, result: Path) -> subprocess.Popen[str]:
        status = result.stat()
        of = str(scene), str(result), str(status.st_mtime_ns)
        if self._process is None or self._process.poll() is not None or of != self._of:
            self._end()
            self._of = of
            self._process = subprocess.Popen(
                [sys.executable, "-m", "seatlook.studio.runs.warm"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                text=True, encoding="utf-8", start_new_session=True,
            )  # fmt: skip
            if self._process.stdin is not None:
                self._process.stdin.write(json.dumps({"scene": of[0], "result": of[1]}) + "\n")
        return self._process

    def _end(self) -> None:
        if self._process is None:
            return
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        self._process = None
