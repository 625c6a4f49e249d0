"""Ctrl-C and SIGTERM: one way out, wherever they arrive, also in compiled code or an import."""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
from importlib.machinery import ExtensionFileLoader
from types import FrameType

EXIT_CODE = 130
_AGAIN = 5.0  # [s] after which code that swallowed an interrupt is interrupted again
_SOON = 0.02  # [s] after which code that must not be interrupted is looked at again
# Compiled modules that are left half made end the process when they are used or thrown away.
_LOADING = {ExtensionFileLoader.create_module.__code__, ExtensionFileLoader.exec_module.__code__}
_CALLED_BACK = "llvmlite.binding.executionengine"  # kept from answering, it gives empty code

_process = os.getpid()
_asked = threading.Event()
_last: list[threading.Timer] = []  # of several signals only the last is repeated


def heed() -> None:
    """Make both signals of this process end it by KeyboardInterrupt."""
    for number in (signal.SIGINT, signal.SIGTERM):
        # A shell has what it starts in the background ignore Ctrl-C.
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)
    sys.unraisablehook = _unraisable


def ignore() -> None:
    """Ignore both signals: the exit code is known, and only the end is left to come."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)


def asked() -> bool:
    """Whether an interrupt came: what compiled code makes of it is another error."""
    return _asked.is_set()


def _interrupt(number: int, frame: FrameType | None) -> None:
    if os.getpid() != _process:
        # A forked worker has nothing to tidy up.
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
        return
    _asked.set()
    fragile = _is_fragile(frame)
    timer = threading.Timer(_SOON if fragile else _AGAIN, _again, [number])
    timer.daemon = True
    _last[:] = [timer]
    timer.start()
    if not fragile:
        raise KeyboardInterrupt


def _is_fragile(frame: FrameType | None) -> bool:
    """Whether compiled code waits for this frame that does not bear an exception."""
    while frame is not None:
        if frame.f_code in _LOADING or frame.f_globals.get("__name__") == _CALLED_BACK:
            return True
        frame = frame.f_back
    return False


def _unraisable(unraisable: sys.UnraisableHookArgs) -> None:
    """Say nothing of an interrupt that code swallows, as a callback of C: it comes again."""
    if not (asked() and unraisable.exc_type is KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)


def _again(number: int) -> None:
    """Interrupt the main thread, also where it waits: of that a flag alone would not wake it."""
    if threading.current_thread() not in _last:
        return  # two would meet whoever handles the first
    main = threading.main_thread().ident
    if sys.platform == "win32" or main is None:
        _thread.interrupt_main(signal.Signals(number))
    else:
        signal.pthread_kill(main, number)
