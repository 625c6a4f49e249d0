"""``python -m seatlook`` and the command ``seatlook``: signals are heeded before all else."""

from __future__ import annotations

import os
import sys

from seatlook import _interrupt


def main() -> None:
    """Run the command line and leave with its exit code."""
    _interrupt.heed()
    _open_streams()
    try:
        from seatlook.cli import run

        code = run()
    except BaseException:
        if not _interrupt.asked():
            raise
        sys.stderr.write("interrupted\n")
        code = _interrupt.EXIT_CODE
    _interrupt.ignore()
    sys.exit(code)


def _open_streams() -> None:
    """Put nowhere in the place of closed streams, and write what a terminal cannot as escapes.

    A file of ours that came to be number 1 would get what libraries print.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115, PTH123
        else:
            stream.reconfigure(errors="backslashreplace")


if __name__ == "__main__":
    main()
