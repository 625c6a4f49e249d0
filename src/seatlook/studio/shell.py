"""The page itself: one document with its style and its script inside, admitted by their digests."""

from __future__ import annotations

import base64
import functools
import hashlib
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from seatlook._version import __version__
from seatlook.report.viewer.script import joined

_PAGE = Path(__file__).with_name("page")


@functools.cache
def page() -> tuple[str, str]:
    """Return the page and its content policy; it asks nothing but this server."""
    style = (_PAGE / "studio.css").read_text(encoding="utf-8")
    script = joined("main", _PAGE / "script")
    templates = Environment(
        loader=FileSystemLoader(_PAGE), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    text = templates.get_template("index.html").render(
        style=Markup(style), script=Markup(script), version=__version__
    )
    policy = (
        "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
        "connect-src 'self'; img-src 'self' data: blob:; frame-src 'self'; "
        f"style-src '{_digest(style)}'; script-src '{_digest(script)}'"
    )
    return text, policy


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
