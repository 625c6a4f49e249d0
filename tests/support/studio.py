"""A studio that listens, and a browser's side of it, over real sockets."""

from __future__ import annotations

import http.client
import json
import resource
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import uvicorn

from seatlook.studio.app import make_app
from seatlook.studio.folder import Folder
from seatlook.studio.guard import Door
from seatlook.studio.server import listen
from seatlook.studio.session import Session


@dataclass
class Answer:
    status: int
    headers: Mapping[str, str]
    content: bytes

    @property
    def value(self) -> Any:
        return json.loads(self.content)


@dataclass
class Client:
    """What a browser sends; ``headers`` go with every request."""

    port: int
    headers: dict[str, str] = field(default_factory=dict)

    def ask(
        self, method: str, path: str, body: Any = None, headers: Mapping[str, str] | None = None
    ) -> Answer:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            plain = isinstance(body, bytes) or body is None or hasattr(body, "read")
            sent = body if plain else json.dumps(body)
            connection.request(method, path, sent, {**self.headers, **(headers or {})})
            answer = connection.getresponse()
            found = {name.lower(): value for name, value in answer.getheaders()}
            return Answer(answer.status, found, answer.read())
        finally:
            connection.close()

    def get(self, path: str, **headers: str) -> Answer:
        return self.ask("GET", path, headers=headers)

    def post(self, path: str, body: Any) -> Answer:
        return self.ask("POST", path, body)

    @property
    def state(self) -> Any:
        answer = self.get("/api/state")
        assert answer.status == 200, answer.content
        return answer.value

    def edit(self, *edits: Mapping[str, Any], base: str | None = None) -> Answer:
        base = self.state["etag"] if base is None else base
        return self.post("/api/edit", {"base": base, "edits": list(edits)})


def let_in(port: int, token: str) -> Client:
    """Swap the token for the cookie, as the browser that is sent to the address."""
    client = Client(port)
    answer = client.get(f"/?token={token}")
    assert answer.status == 303
    cookie = answer.headers["set-cookie"].partition(";")[0]
    own = {"Origin": f"http://127.0.0.1:{port}", "X-Seatlook": "1", "Cookie": cookie}
    return Client(port, own)


@contextmanager
def studio(folder: Path, library: Path | None = None) -> Iterator[tuple[Door, Client]]:
    """Serve a folder in a thread."""
    with listen(0) as listening:
        door = Door(listening.getsockname()[1])
        config = uvicorn.Config(make_app(Session(Folder(folder)), door, library), log_level="error")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            while not server.started:
                time.sleep(0.01)
            yield door, let_in(door.port, door.token)
        finally:
            server.should_exit = True
            thread.join(10)


@contextmanager
def studio_process(
    folder: Path, *, largest_file: int | None = None
) -> Iterator[tuple[Any, Client]]:
    """Serve a folder by the command, in a process of its own that can be killed."""

    def limited() -> None:
        if largest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))

    words = [sys.executable, "-m", "seatlook", "studio", str(folder), "--no-browser"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, preexec_fn=limited)
    try:
        assert process.stdout is not None
        address = next(word for line in process.stdout for word in line.split() if "token=" in word)
        where = urlsplit(address)
        assert where.port is not None
        yield process, let_in(where.port, parse_qs(where.query)["token"][0])
    finally:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
