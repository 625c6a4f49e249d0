"""Write the gallery page: one HTML file with its style and script inside, images beside it."""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path
from urllib.parse import quote

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from seatlook import files
from seatlook.errors import InputError
from seatlook.model.table import number
from seatlook.report.page.chart import HEIGHT, WIDTH, history_charts
from seatlook.report.page.data import PageData

_TEMPLATES = Path(__file__).parents[1] / "templates"


def write_page(data: PageData, folder: Path, *, single_file: bool = False) -> Path:
    """Write ``folder/index.html`` and return its path.

    Parameters
    ----------
    data : what to show
    folder : where the images of ``data`` already are
    single_file : put the images into the page, which then stands alone

    Raises
    ------
    InputError
        An image or file that the page would show is not in ``folder``.

    Notes
    -----
    The page asks nothing of the network: its content policy admits its own style and script, by
    their digests, and images beside it.
    """
    missing = [name for name in (*data.images, *data.files) if not (folder / name).is_file()]
    if missing:
        raise InputError.single(
            "gallery page",
            got=f"no file {', '.join(missing)}",
            expected="every picture and file written before the page",
            file=folder,
        )
    path = folder / "index.html"
    files.write_text(path, page_html(data, inside=folder if single_file else None))
    return path


def page_html(data: PageData, *, inside: Path | None = None) -> str:
    """Return the page as text, with the images of the folder ``inside`` in it if there is one."""
    style = page_style()
    script = (_TEMPLATES / "page.js").read_text(encoding="utf-8")
    templates = environment()
    templates.filters["url"] = quote if inside is None else lambda name: _data_uri(inside / name)
    # The script finds a picture by the name of its element, whatever its address is.
    templates.globals["ids"] = {name: f"i{k}" for k, name in enumerate(dict.fromkeys(data.images))}
    templates.globals["alone"] = inside is not None
    scripts = (script, data.viewer.script) if data.viewer else (script,)
    return templates.get_template("page.html.j2").render(
        page=data,
        policy=content_policy(style, *scripts, images=_images(data, inside)),
        style=Markup(style),
        scripts=[Markup(text) for text in scripts],
        viewer_content=Markup(inert(data.viewer.content if data.viewer else "")),
        charts=history_charts(data.history),
        chart_size=(WIDTH, HEIGHT),
    )


def page_style() -> str:
    """Style of the gallery page and of what looks like it."""
    return (_TEMPLATES / "page.css").read_text(encoding="utf-8")


def _images(data: PageData, inside: Path | None) -> str:
    """Where images may come from; a page that the viewer sends holds a picture in itself."""
    if inside is not None:
        return "data:"
    return "'self' data:" if data.viewer else "'self'"


def inert(json: str) -> str:
    """JSON that ends no script element, whatever names are in it."""
    return json.replace("<", "\\u003c")


def _data_uri(path: Path) -> str:
    kind = "image/gif" if path.suffix == ".gif" else "image/png"
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def environment() -> Environment:
    """Templates of pages and charts; every text is escaped."""
    templates = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters["number"] = number
    templates.filters["squared"] = lambda text: re.sub(r"m2\b", "m²", text)
    return templates


def content_policy(style: str, *scripts: str, images: str = "'self'") -> str:
    """Content policy: nothing but the page's own style, scripts and images."""
    admitted = " ".join(f"'{_digest(script)}'" for script in scripts)
    return (
        f"default-src 'none'; img-src {images}; base-uri 'none'; form-action 'none'; "
        f"style-src '{_digest(style)}'; script-src {admitted}"
    )


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
