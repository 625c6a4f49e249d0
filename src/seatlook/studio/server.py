"""Serve one folder on this machine, until Ctrl-C."""

from __future__ import annotations

import socket
from collections.abc import Callable
from pathlib import Path

import uvicorn

from seatlook.errors import InputError
from seatlook.studio.app import make_app
from seatlook.studio.folder import Folder
from seatlook.studio.guard import Door
from seatlook.studio.session import Session

_LOOPBACK = "127.0.0.1"


def serve(folder: Path, *, port: int = 0, started: Callable[[str], None] = print) -> None:
    """Serve a folder to the browsers of this machine.

    Parameters
    ----------
    folder : with a scene in it, or to make one in
    port : 0 takes any that is free
    started : told the address, with its token, once it is there to be opened

    Raises
    ------
    InputError
        The port is taken, or the folder is a file.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError.single("FOLDER", got=str(folder), expected="a folder")
    with listen(port) as listening:
        door = Door(listening.getsockname()[1])
        config = uvicorn.Config(
            make_app(Session(Folder(folder)), door),
            log_level="warning",
            access_log=False,
            server_header=False,
            ws="none",
            timeout_graceful_shutdown=2,
        )
        started(door.address)
        uvicorn.Server(config).run(sockets=[listening])


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
