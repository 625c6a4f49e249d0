"""The command that opens a folder in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._library import Root, library_root
from seatlook.cli._output import note, table


def studio(
    folder: Annotated[Path, Parameter(help="Folder of a scene, or to make one in.")] = Path(),
    /,
    *,
    port: Annotated[int, Parameter(help="Port to listen on; 0 takes a free one.")] = 0,
    root: Root = None,
    browser: Annotated[bool, Parameter(help="Open the address in the browser.")] = True,
) -> None:
    """Set a seat up by clicking: start, sew, hook, light and run it in the browser.

    Only this machine can reach it, and only by the address that is printed. Every click is a line
    in the files of the folder. Ends with Ctrl-C.

    Example: seatlook studio out/demo
    """
    from seatlook.studio.server import serve

    def started(address: str) -> None:
        table(("what", "value"), [("address", address)], json=False)
        note("open the address in a browser; Ctrl-C ends it")
        if browser:
            import webbrowser

            webbrowser.open(address)

    serve(folder, port=port, library=library_root(root), started=started)
