"""Who may ask: this machine, this address, a browser that was given the token, this page.

Other pages in the same browser can send requests here, and a name server can give another name to
this address. So every request says by Host that it means this server, by a cookie that it was let
in, and what changes anything says by Origin and a header of its own that it comes from this page.
"""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HEADER = "x-seatlook"
_READS = ("GET", "HEAD")


@dataclass(frozen=True)
class Door:
    """Address and secrets of one server.

    Parameters
    ----------
    port : it listens on
    token : in the address that is given to the user's browser
    """

    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)
    session: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)
    results: str = field(default_factory=lambda: secrets.token_urlsafe(16), repr=False)

    @property
    def address(self) -> str:
        """What a browser is sent to first."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    @property
    def hosts(self) -> tuple[str, ...]:
        """Names of this server."""
        return f"127.0.0.1:{self.port}", f"localhost:{self.port}"

    @property
    def cookie(self) -> str:
        """Name of the cookie; cookies are shared by all ports of a machine."""
        return f"seatlook-{self.port}"

    @property
    def results_path(self) -> str:
        """Where results are served: their pages run apart, without the cookie."""
        return f"/results/{self.results}"


class Guard:
    """Refuses what does not come from the page of this server.

    Parameters
    ----------
    app : what is guarded
    door : address and secrets
    """

    def __init__(self, app: ASGIApp, door: Door) -> None:
        self._app, self._door = app, door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer or refuse one request."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008})
            return
        refusal = self._refusal(scope, Headers(scope=scope))
        if refusal is not None:
            await refusal(scope, receive, send)
            return
        await self._app(scope, receive, _with_headers(send))

    def _refusal(self, scope: Scope, headers: Headers) -> Response | None:
        door, path = self._door, str(scope["path"])
        if headers.get("host") not in door.hosts:
            return _refused(421, "this server has another name")
        origin = headers.get("origin")
        if origin is not None and origin not in {f"http://{host}" for host in door.hosts}:
            return _refused(403, "another page asks")
        if path.startswith(f"{door.results_path}/") and scope["method"] in _READS:
            return None
        if path == "/" and scope["query_string"]:
            return self._let_in(scope)
        if not self._known(headers):
            return _refused(401, "open the address that seatlook studio printed")
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
            return _refused(403, "another page asks")
        changes = scope["method"] not in _READS
        if changes and (origin is None or headers.get(HEADER) != "1"):
            return _refused(403, "another page asks")
        return None

    def _let_in(self, scope: Scope) -> Response | None:
        """Swap the token in the address for a cookie."""
        given = parse_qs(scope["query_string"].decode("ascii", "replace")).get("token", [""])[0]
        if scope["method"] != "GET" or not _equal(given, self._door.token):
            return _refused(401, "open the address that seatlook studio printed")
        response = RedirectResponse("/", status_code=303)
        response.set_cookie(
            self._door.cookie, self._door.session, httponly=True, samesite="strict", path="/"
        )
        return _plain(response)

    def _known(self, headers: Headers) -> bool:
        cookies: SimpleCookie = SimpleCookie()
        try:
            for line in headers.getlist("cookie"):
                cookies.load(line)
        except CookieError:
            return False
        own = cookies.get(self._door.cookie)
        return own is not None and _equal(own.value, self._door.session)


def _equal(given: str, secret: str) -> bool:
    return hmac.compare_digest(given.encode("utf-8", "replace"), secret.encode())


def _refused(status: int, text: str) -> Response:
    return _plain(JSONResponse({"errors": [{"text": text}]}, status_code=status))


def _plain(response: Response) -> Response:
    response.headers.update(_HEADERS)
    return response


_HEADERS = {
    "cache-control": "no-store",
    "content-security-policy": "default-src 'none'; frame-ancestors 'none'",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}


def _with_headers(send: Send) -> Send:
    """Add what every answer carries, where it says nothing else itself."""

    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return sent
