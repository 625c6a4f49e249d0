"""Serve one folder on this machine, until Ctrl-C."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import uvicorn
from filelock import FileLock, Timeout

from seatlook.errors import InputError
from seatlook.studio.app import make_app
from seatlook.studio.folder import OWN, Folder
from seatlook.studio.guard import Door
from seatlook.studio.session import Session

_LOOPBACK = "127.0.0.1"


def serve(
    folder: Path,
    *,
    port: int = 0,
    library: Path | None = None,
    started: Callable[[str], None] = print,
) -> None:
    """Serve a folder to the browsers of this machine.

    Parameters
    ----------
    folder : with a scene in it, or to make one in
    port : 0 takes any that is free
    library : folder of a library to take from
    started : told the address, with its token, once it is there to be opened

    Raises
    ------
    InputError
        The port is taken, the folder is a file, or another studio has it open.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError.single("FOLDER", got=str(folder), expected="a folder")
    own = Folder(folder)
    with _alone(own), listen(port) as listening:
        door = Door(listening.getsockname()[1])
        config = uvicorn.Config(
            make_app(Session(own), door, library),
            log_level="warning",
            access_log=False,
            server_header=False,
            ws="none",
            timeout_graceful_shutdown=2,
        )
        started(door.address)
        uvicorn.Server(config).run(sockets=[listening])


@contextmanager
def _alone(folder: Folder) -> Iterator[None]:
    """Keep other studios off a folder: each would not know what the other one changes."""
    own = folder.inside(OWN)
    own.mkdir(parents=True, exist_ok=True)
    lock = FileLock(own / "lock")
    try:
        lock.acquire(timeout=0)
    except Timeout as error:
        raise InputError.single(
            "FOLDER", got="one that another studio has open", expected="a folder of its own",
            hint="go on in that studio, or end it",
        ) from error  # fmt: skip
    try:
        yield
    finally:
        lock.release()


def listen(port: int) -> socket.socket:
    """Listen on this machine only."""
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((_LOOPBACK, port))
        listening.listen(2048)
    except (OSError, OverflowError) as error:
        listening.close()
        raise InputError.single(
            "--port", got=port, expected="a free port, or 0", hint=str(error)
        ) from error
    return listening
