"""Pages that run the viewer's own modules and hand back numbers."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from seatlook.report.viewer import script

PROBES = Path(__file__).with_name("probes")


def probe_page(browser: Any, name: str, content: dict[str, Any], folder: Path) -> Any:
    """Open a page of a probe beside the viewer's modules; its ``content`` lies in the page."""
    modules = folder / "script"
    shutil.copytree(Path(script.__file__).with_name("script"), modules)
    shutil.copy(PROBES / f"{name}.js", modules)
    path = folder / f"{name}.html"
    path.write_text(
        '<!doctype html><meta charset="utf-8">'
        f'<script type="application/json" id="content">{json.dumps(content)}</script>'
        f"<script>{script.joined(name, modules)}</script>",
        encoding="utf-8",
    )
    page = browser.new_page()
    page.on("pageerror", lambda error: print(f"{name}: {error}"))
    page.goto(path.as_uri())
    return page
