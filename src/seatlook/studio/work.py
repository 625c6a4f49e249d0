"""Everything that goes on beside edits: the assembly, runs, and who is told of what happens."""

from __future__ import annotations

import asyncio
import queue
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import asdict
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from seatlook.errors import InputError
from seatlook.studio.assembly_view import AssemblyView
from seatlook.studio.folder import OWN
from seatlook.studio.guard import Door
from seatlook.studio.runs.listeners import Listeners
from seatlook.studio.runs.runs import RUNS, Run, Runs
from seatlook.studio.runs.warm_answers import WarmAnswers
from seatlook.studio.session import Session
from seatlook.studio.starting import start

_LOOK = 1.0  # s between two looks at the files
_WORD = 15.0  # s after which a silent stream says that it is there
_WAIT = 0.15  # s
_MOST_LISTENERS = 64
_MOST = 50.0  # mm that an edge is made longer or shorter


class Work:
    """What a server does for a session.

    Parameters
    ----------
    door : says where results are served
    """

    def __init__(self, session: Session, door: Door) -> None:
        self.session, self._door = session, door
        self._assembly = AssemblyView(session.folder)
        self._listeners = Listeners()
        own = session.folder.root / OWN
        self._warm = WarmAnswers()
        self.runs = Runs(session.folder.root, own / "runs.json", self._tell)

    def state(self) -> Mapping[str, Any]:
        """The state of the folder, and its runs."""
        return {**self.session.state(), "runs": self.run_values()}

    def assembly_values(self) -> Mapping[str, Any]:
        """The cover as it starts."""
        return self._assembly.values(*self.session.now())

    def start(self, asked: Mapping[str, Any]) -> Mapping[str, Any]:
        """Begin a seat."""
        put = start(self.session.folder, asked)
        return {**self.session.replace(f"start.{asked['kind']}", put), "runs": self.run_values()}

    def run(self, asked: Mapping[str, Any]) -> str:
        """Begin a run of the scene."""
        folder = self.session.folder
        if folder.scene is None:
            raise InputError.single("run", got="no scene", expected="a folder with one")
        others = asked.get("others", [])
        for other in others if isinstance(others, list) else [others]:
            if not isinstance(other, str) or not folder.inside(other).is_file():
                raise InputError.single("others", got=repr(other), expected="a scene of the folder")
        return self.runs.start(folder.root / folder.scene, asked)

    def warm(self, asked: Mapping[str, Any]) -> Mapping[str, Any]:
        """Answer another length of an edge from the balance of a run, without solving anew.

        Raises
        ------
        InputError
            No run of this name with a result, no such edge, or no number.
        """
        folder, amount = self.session.folder, asked.get("amount_mm")
        names = [values["name"] for values in self.runs.values()]
        name = asked.get("run", names[0] if names else None)
        result = folder.root / RUNS / str(name) / "result.npz"
        if name not in names or folder.scene is None or not result.is_file():
            raise InputError.single("run", got=repr(name), expected="a run that left a result")
        if not isinstance(amount, int | float) or isinstance(amount, bool) or abs(amount) > _MOST:
            raise InputError.single(
                "amount_mm", got=repr(amount), expected=f"-{_MOST:g} to {_MOST:g}"
            )
        return self._warm.ask(
            folder.root / folder.scene, result, str(asked.get("edge")), float(amount)
        )

    def run_values(self) -> list[dict[str, Any]]:
        """All runs, with the addresses of what they left."""
        return [self._with_pages(values) for values in self.runs.values()]

    def _with_pages(self, values: dict[str, Any]) -> dict[str, Any]:
        where = self.session.folder.root / RUNS / values["name"]
        base = f"{self._door.results_path}/{RUNS}/{values['name']}"
        there = (where / "index.html").is_file()
        left = sorted(path.name for path in where.glob("*") if path.is_file())
        images = sorted(path.name for path in (where / "images").glob("*.png"))
        return {
            **values,
            "page_url": f"{base}/index.html" if there else None,
            "files": [f"{base}/{name}" for name in left],
            "images": [f"{base}/images/{name}" for name in images],
            "snapshots": sorted(path.stem for path in (where / "stages").glob("*.npz")),
        }

    def _tell(self, run: Run) -> None:
        self._listeners.tell("run", self._with_pages(asdict(run)))

    async def events(self, request: Request) -> AsyncIterator[str]:
        """What happens, as it happens."""
        listener, silent = self._listeners.join(_MOST_LISTENERS), 0.0
        try:
            yield ": here\n\n"
            while not await request.is_disconnected():
                try:
                    yield listener.get_nowait()
                    silent = 0.0
                except queue.Empty:
                    await asyncio.sleep(_WAIT)
                    silent += _WAIT
                    if silent >= _WORD:
                        silent = 0.0
                        yield ": still here\n\n"
        finally:
            self._listeners.leave(listener)

    @asynccontextmanager
    async def lifespan(self, app: Starlette) -> AsyncIterator[None]:
        """Look at the files while the server runs; end the run with it."""
        watch = asyncio.create_task(self._watch())
        try:
            yield
        finally:
            watch.cancel()
            await run_in_threadpool(self.runs.cancel)
            await run_in_threadpool(self._warm.close)

    async def _watch(self) -> None:
        last = ""
        while True:
            if self._listeners:
                tag = await run_in_threadpool(self.session.tag)
                if last and tag != last:
                    self._listeners.tell("files", {"etag": tag})
                last = tag
            await asyncio.sleep(_LOOK)
