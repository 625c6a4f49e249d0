"""One exit code per kind of failure, one way to say what went wrong.

Exit codes: 0 good, 1 a limit of [accept] is missed, 2 wrong input, 3 not converged, not resolved by
the mesh, or not drawn, 70 a fault of seatlook itself, 130 interrupted.
"""

from __future__ import annotations

import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Any

from cyclopts import App, CycloptsError

from seatlook._interrupt import EXIT_CODE, asked
from seatlook._version import __version__
from seatlook.cli._output import drop_output, manner, say
from seatlook.errors import InputWarning, SeatlookError, SolverError

_HELP = """Where a car-seat cover wrinkles, why, and whether anyone will see it.

Start with: seatlook demo --out out/demo, or with files of your own: seatlook init

Any command takes --quiet: no progress and no notes, only data and what went wrong. NO_COLOR is
heeded. Exit codes: 0 good, 1 a limit is missed, 2 wrong input, 3 not converged, not resolved by the
mesh, or not drawn.
"""

_OUT_OF_MEMORY = (
    "out of memory: a coarser mesh takes less, twice its --element-size-mm about a quarter; "
    "a smaller picture as well"
)
_KEPT = "the same command with --resume takes the result, if it was solved already"
_AGAIN = "the same command again goes on where it was: what is done is kept"
# verb -> how an interrupted run goes on
_GO_ON = {
    "demo": _KEPT,
    "evaluate": _KEPT,
    "solve": "with --stages a run keeps its stages, and --resume goes on after the last one",
    "compare": _AGAIN,
    "sweep": _AGAIN,
}

_PYTHONS_OWN = warnings.formatwarning

app = App(
    name="seatlook",
    help=_HELP,
    version=__version__,
    help_format="plaintext",
    sort_key=None,
    suppress_keyboard_interrupt=False,
)


def run(tokens: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; ``tokens`` default to the process's arguments."""
    words = list(sys.argv[1:] if tokens is None else tokens)
    manner.quiet = "--quiet" in words
    words = [word for word in words if word != "--quiet"]
    warnings.formatwarning = _format_warning
    try:
        code = app(words, exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        see = " ".join(("seatlook", *(error.command_chain or ()), "--help"))
        say(f"seatlook: {error}", f"see: {see}")
        return 2
    except SeatlookError as error:
        say(str(error))
        return error.exit_code
    # The library that prints help exits where its reader has gone.
    except (BrokenPipeError, SystemExit):
        drop_output()
        return 0
    except (Exception, KeyboardInterrupt) as error:
        return _failed(error, words)
    finally:
        warnings.formatwarning = _PYTHONS_OWN
    return code if isinstance(code, int) else 0


def _failed(error: BaseException, words: Sequence[str]) -> int:
    """Say why a command ended where nobody foresaw it, and return the exit code."""
    # Compiled code makes another error of an interrupt.
    if isinstance(error, KeyboardInterrupt) or asked():
        go_on = _GO_ON.get(words[0] if words else "")
        say("; ".join(filter(None, ("interrupted", "no file was left half written", go_on))))
        return EXIT_CODE
    if isinstance(error, MemoryError):
        say(f"{_OUT_OF_MEMORY} ({error})" if str(error) else _OUT_OF_MEMORY)
        return SolverError.exit_code
    if isinstance(error, OSError):
        say(f"{error.filename or 'file system'}: {error.strerror or error}")
        return 2
    say(
        "".join(traceback.format_exception(error)),
        "this is a fault of seatlook, not of the input",
    )
    return 70


def _format_warning(
    message: Warning | str, category: type[Warning], *place: Any, **line: Any
) -> str:
    """What is said of an input is for the reader; where in seatlook it is said is not."""
    if issubclass(category, InputWarning):
        return f"note: {message}\n"
    return _PYTHONS_OWN(message, category, *place, **line)
