"""What the server answers: one function for each address."""

from __future__ import annotations

import json
import math
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, Response, StreamingResponse
from starlette.routing import Route

from seatlook.errors import InputError, SeatlookError
from seatlook.studio.guard import Door, Guard
from seatlook.studio.picking import partner
from seatlook.studio.session import Clash, Session
from seatlook.studio.shelf import Shelf
from seatlook.studio.shell import page
from seatlook.studio.starting import UPLOADS, preview
from seatlook.studio.state import material_values, problem_values
from seatlook.studio.uploads import receive
from seatlook.studio.work import Work

LARGEST_REQUEST = 2**20  # bytes of what is posted, uploads apart
# A page of results runs apart from the studio: it may not ask the server for anything else.
APART = {
    "content-security-policy": "sandbox allow-scripts allow-downloads allow-popups",
    "cross-origin-resource-policy": "cross-origin",
}
Handler = Callable[[Request], Awaitable[Response]]


class TooLarge(Exception):  # noqa: N818 -- it says what is wrong
    """More was posted than is read."""


def make_app(session: Session, door: Door, library: Path | None = None) -> Starlette:
    """Put a session behind its guard."""
    work = Work(session, door)
    routes = [
        Route("/", _page),
        Route("/api/state", _answering(_state)),
        Route("/api/edit", _answering(_edit), methods=["POST"]),
        Route("/api/partner", _answering(_partner), methods=["POST"]),
        Route("/api/undo", _answering(_undo), methods=["POST"]),
        Route("/api/redo", _answering(_redo), methods=["POST"]),
        Route("/api/assembly", _answering(_assembly)),
        Route("/api/materials", _answering(_materials)),
        Route("/api/start", _answering(_start), methods=["POST"]),
        Route("/api/upload", _answering(_upload), methods=["POST"]),
        Route("/api/library", _answering(_library)),
        Route("/api/library/thumbnail", _answering(_thumbnail)),
        Route("/api/library/use", _answering(_use), methods=["POST"]),
        Route("/api/runs", _answering(_runs)),
        Route("/api/run", _answering(_run), methods=["POST"]),
        Route("/api/run/cancel", _answering(_cancel), methods=["POST"]),
        Route("/api/warm", _answering(_warm), methods=["POST"]),
        Route("/api/events", _answering(_events)),
        Route(f"{door.results_path}/{{path:path}}", _answering(_result)),
    ]
    app = Starlette(
        routes=routes, middleware=[Middleware(Guard, door=door)], lifespan=work.lifespan
    )
    app.state.work, app.state.shelf = work, Shelf(session, library)
    return app


async def _page(request: Request) -> Response:
    text, policy = await run_in_threadpool(page)
    return HTMLResponse(text, headers={"content-security-policy": policy})


async def _state(request: Request) -> Response:
    return answer(await run_in_threadpool(work_of(request).state))


async def _edit(request: Request) -> Response:
    asked = await posted(request)
    edits = asked.get("edits")
    if not isinstance(edits, list) or not edits:
        raise InputError.single("edits", got=repr(edits)[:60], expected="a list of edits")
    return await _stated(request, session_of(request).edit, asked.get("base"), edits)


async def _stated(
    request: Request, change: Callable[..., Mapping[str, Any]], *given: Any
) -> Response:
    """The state that a change leaves, with the runs."""
    values = await run_in_threadpool(change, *given)
    return answer({**values, "runs": await run_in_threadpool(work_of(request).run_values)})


async def _partner(request: Request) -> Response:
    asked = await posted(request)
    first, second = asked.get("first"), asked.get("second")
    if not isinstance(first, dict) or not isinstance(second, dict):
        raise InputError.single("partner", got=repr(asked)[:60], expected="first and second")
    reading = await run_in_threadpool(session_of(request).reading)
    if reading.pattern is None:
        raise InputError(reading.problems)
    return answer(partner(reading.pattern, first, second))


async def _undo(request: Request) -> Response:
    asked = await posted(request)
    return await _stated(request, session_of(request).undo, asked.get("base"))


async def _redo(request: Request) -> Response:
    asked = await posted(request)
    return await _stated(request, session_of(request).redo, asked.get("base"))


async def _assembly(request: Request) -> Response:
    return answer(await run_in_threadpool(work_of(request).assembly_values))


async def _materials(request: Request) -> Response:
    folder = session_of(request).folder
    return answer({"materials": await run_in_threadpool(material_values, folder)})


async def _start(request: Request) -> Response:
    asked, work = await posted(request), work_of(request)
    if asked.get("dry"):
        return answer(await run_in_threadpool(preview, work.session.folder, asked))
    return answer(await run_in_threadpool(work.start, asked))


async def _upload(request: Request) -> Response:
    folder, name = session_of(request).folder, request.query_params.get("name", "")
    path, count = await receive(folder.inside(UPLOADS), name, request.stream())
    return answer({"path": path.relative_to(folder.root).as_posix(), "bytes": count})


async def _library(request: Request) -> Response:
    return answer(await run_in_threadpool(request.app.state.shelf.values))


async def _thumbnail(request: Request) -> Response:
    place = request.query_params.get("place", "")
    path = await run_in_threadpool(request.app.state.shelf.picture, place)
    return _said("it has no picture", 404) if path is None else FileResponse(path, headers=APART)


async def _use(request: Request) -> Response:
    return await _stated(request, request.app.state.shelf.use, await posted(request))


async def _runs(request: Request) -> Response:
    return answer({"runs": await run_in_threadpool(work_of(request).run_values)})


async def _run(request: Request) -> Response:
    asked, work = await posted(request), work_of(request)
    return answer({"run": await run_in_threadpool(work.run, asked)})


async def _warm(request: Request) -> Response:
    asked = await posted(request)
    return answer(await run_in_threadpool(work_of(request).warm, asked))


async def _cancel(request: Request) -> Response:
    await posted(request)
    await run_in_threadpool(work_of(request).runs.cancel)
    return answer({"runs": await run_in_threadpool(work_of(request).run_values)})


async def _events(request: Request) -> Response:
    return StreamingResponse(work_of(request).events(request), media_type="text/event-stream")


async def _result(request: Request) -> Response:
    path = session_of(request).folder.inside(request.path_params["path"])
    shown = path.relative_to(session_of(request).folder.root).parts
    if not path.is_file() or any(part.startswith(".") for part in shown):
        return _said("no such result", 404)
    return FileResponse(path, headers=APART)


def work_of(request: Request) -> Work:
    """What the server was started with."""
    work: Work = request.app.state.work
    return work


def session_of(request: Request) -> Session:
    """The session that the server was started with."""
    return work_of(request).session


async def posted(request: Request) -> dict[str, Any]:
    """Read the JSON of a request.

    Raises
    ------
    InputError
        It is none, or no object.
    TooLarge
        It is longer than ``LARGEST_REQUEST``.
    """
    content = bytearray()
    async for part in request.stream():
        content += part
        if len(content) > LARGEST_REQUEST:
            raise TooLarge
    try:
        value = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise InputError.single("request", got=f"no JSON: {error}", expected="JSON") from error
    if not isinstance(value, dict):
        raise InputError.single("request", got=type(value).__name__, expected="a JSON object")
    return value


def answer(values: Mapping[str, Any], status: int = 200) -> Response:
    """Plain values as JSON; what JSON has nothing for is sent as text."""
    try:
        text = _json(values)
    except (TypeError, ValueError):
        text = _json(_sendable(values))
    return Response(text, status_code=status, media_type="application/json")


def _json(values: Any) -> str:
    return json.dumps(values, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def _sendable(value: Any) -> Any:
    """Put texts in the place of what TOML has and JSON not: dates, inf and nan."""
    if isinstance(value, Mapping):
        return {str(key): _sendable(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_sendable(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value if isinstance(value, str | int | float | None) else str(value)


def _answering(handler: Handler) -> Handler:
    """Say what went wrong in the way that the page shows it."""

    async def answered(request: Request) -> Response:
        try:
            return await handler(request)
        except Clash as clash:
            said = {"reason": clash.reason, "mine": clash.mine, "theirs": clash.theirs}
            return answer(said, 409)
        except InputError as error:
            folder = session_of(request).folder
            return answer({"errors": [problem_values(folder, p) for p in error.problems]}, 422)
        except SeatlookError as error:
            return _said(str(error), 422)
        except TooLarge:
            return _said(f"more than {LARGEST_REQUEST} bytes were sent", 413)
        except OSError as error:
            return _said(f"{error.filename or 'file system'}: {error.strerror or error}", 507)

    return answered


def _said(text: str, status: int) -> Response:
    return answer({"errors": [{"file": None, "line": None, "key": "", "text": text}]}, status)
