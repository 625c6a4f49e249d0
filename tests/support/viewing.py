"""The viewer of a page, in a browser: opened, waited for, read."""

from __future__ import annotations

import base64
import importlib
import io
from collections.abc import Callable
from typing import Any

import numpy as np
from PIL import Image as Pillow

STILL = "#viewer-room[data-still]"


def listen(page: Any, messages: list[str]) -> None:
    # Chromium says that waiting for a picture is slow; it is meant to wait.
    page.on("console", lambda m: None if "GPU stall" in m.text else messages.append(m.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on(
        "request",
        lambda r: None if r.url.startswith(("file:", "data:", "blob:")) else messages.append(r.url),
    )


def open_viewer(page: Any) -> None:
    page.locator("#viewer-open").click()
    settle(page)


def settle(page: Any) -> None:
    page.wait_for_timeout(200)
    page.locator(STILL).wait_for(timeout=90_000)


def pixels(page: Any) -> np.ndarray:
    """What the viewer shows, (h, w, 3)."""
    data = page.evaluate("() => document.getElementById('viewer-canvas').toDataURL('image/png')")
    content = base64.b64decode(data.split(",")[1])
    return np.asarray(Pillow.open(io.BytesIO(content)).convert("RGB")).astype(float)


def differs(before: np.ndarray, after: np.ndarray) -> bool:
    return float(np.abs(before - after).mean()) > 0.5


def said(page: Any, name: str) -> str:
    return page.locator(f"#viewer-{name}").text_content()


def put(page: Any, name: str, value: str) -> None:
    page.locator(f"#viewer-{name}").fill(value)


def assert_accessible_and_narrow(
    browser: Any, address: str, width: int, then: Callable[[Any], object]
) -> None:
    """Open the viewer in a window so wide, do something, find no violation and no overflow."""
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    # The checker is injected as a script, which the page's own policy rightly refuses.
    context = browser.new_context(
        offline=True, bypass_csp=True, viewport={"width": width, "height": 900}
    )
    page = context.new_page()
    page.goto(address)
    if width == 360:
        page.locator("#viewer-head .fold").click()
    open_viewer(page)
    then(page)
    assert page.evaluate("() => document.documentElement.scrollWidth") == width
    result = axe.run(page)
    assert result.violations_count == 0, result.generate_report()
    context.close()
