"""The studio in a browser: opened, clicked as a person would, and how long that takes."""

from __future__ import annotations

import importlib
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from seatlook.io.pattern.dxf_write import write_dxf
from seatlook.io.pattern.seams import read_pattern
from seatlook.model import Pattern
from support.commands import seatlook as command

CLICK_S, KEY_S = 1.2, 0.3  # what an action takes


def write_seat(shape: str, folder: Path) -> Path:
    """Write a seat of the family, complete; return its folder."""
    words = ("demo", "--shape", shape, "--files-only", "--out", str(folder))
    done = command(*words, cwd=folder.parent)
    assert done.returncode == 0, done.stderr
    return folder


def bare_files(shape: str, folder: Path) -> Path:
    """Write pattern without notches, foam and wires of a seat, and nothing that says its seams."""
    whole = write_seat(shape, folder / "whole")
    pattern = true_pattern(whole)
    bare = folder / "files"
    bare.mkdir()
    panels = tuple(replace(panel, notches=()) for panel in pattern.panels)
    write_dxf(replace(pattern, panels=panels), bare / "pattern.dxf")
    for name in ("foam.obj", "wires.toml"):
        if (whole / name).is_file():
            (bare / name).write_bytes((whole / name).read_bytes())
    return bare


def true_pattern(whole: Path) -> Pattern:
    """The pattern of a complete seat, with its seams."""
    return read_pattern(whole / "pattern.dxf", whole / "seams.toml")


@contextmanager
def opened(browser: Any, address: str, **window: Any) -> Iterator[Any]:
    """Open the studio; what the console says, and a request to elsewhere, fail the test."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 800}, **window})
    page = context.new_page()
    messages: list[str] = []
    home = "/".join(address.split("/")[:3])
    # Chromium says that waiting for a picture is slow; it is meant to wait.
    page.on("console", lambda m: None if "GPU stall" in m.text else messages.append(m.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda r: _outside(r.url, home, messages))
    page.goto(address)
    page.locator("[role=tab][aria-selected=true]").wait_for()
    try:
        yield page
    finally:
        context.close()
    assert messages == []


def _outside(url: str, home: str, messages: list[str]) -> None:
    if not url.startswith((home, "data:", "blob:")):
        messages.append(f"asked for {url}")


def accessible(page: Any) -> None:
    """Find no violation in what is shown; the page was opened with ``bypass_csp``."""
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    result = axe.run(page)
    assert result.violations_count == 0, result.generate_report()


@dataclass
class Hands:
    """A person at the page: every click and key is counted.

    Parameters
    ----------
    page : of the browser
    """

    page: Any
    clicks: int = 0
    keys: int = 0

    @property
    def seconds(self) -> float:
        return CLICK_S * self.clicks + KEY_S * self.keys

    def click(self, selector: str, **which: Any) -> None:
        self.page.locator(selector, **which).first.click()
        self.clicks += 1

    def key(self, *names: str) -> None:
        for name in names:
            self.page.keyboard.press(name)
            self.keys += 1

    def choose(self, selector: str, file: Path) -> None:
        """Choose a file: one click, and its name with Enter in the system's own window."""
        self.page.locator(selector).set_input_files(file)
        self.clicks += 1
        self.keys += len(file.name) + 1

    def pick(self, place: tuple[float, float]) -> None:
        self.page.mouse.click(*place)
        self.clicks += 1


def on_screen(page: Any, panel: str, place: Any) -> tuple[float, float]:
    """Where a place [mm] of a panel is on the screen now: read from the drawing's own outline."""
    found = page.evaluate(
        """([panel, index]) => {
            const svg = document.getElementById("sheet");
            const own = svg.querySelector(`[data-panel="${CSS.escape(panel)}"] .panel`);
            const at = own.points.getItem(index).matrixTransform(own.getScreenCTM());
            return [at.x, at.y];
        }""",
        [panel, place],
    )
    return found[0], found[1]


def settled(page: Any) -> None:
    """Wait until all that was asked for is answered."""
    page.wait_for_function("() => document.body.dataset.busy === 'no'", timeout=240_000)


def corner_on_screen(page: Any, panel: str, place_mm: Any) -> tuple[float, float]:
    """Where a corner of a panel is on the screen now, read from the drawing's own dots."""
    x, y = page.evaluate(
        """async ([panel, place]) => {
            const answer = await fetch("/api/state");
            const {pattern} = await answer.json();
            const own = pattern.panels.find(({name}) => name === panel);
            const away = (p) => Math.hypot(p[0] - place[0], p[1] - place[1]);
            const group = document.querySelector(`#sheet [data-panel="${panel}"]`);
            const outline = group.querySelector(".panel"), points = own.outline_mm;
            let best = 0;
            points.forEach((p, k) => { if (away(p) < away(points[best])) best = k; });
            const at = outline.points.getItem(best).matrixTransform(outline.getScreenCTM());
            return [at.x, at.y];
        }""",
        [panel, list(place_mm)],
    )
    return x, y


def bare_folder(whole: Path, folder: Path) -> Path:
    """Copy a seat without its seams and what hangs on them; every edge keeps its name."""
    shutil.copytree(whole, folder)
    seams, scene = folder / "seams.toml", folder / "scene.toml"
    seams.write_text(seams.read_text().partition("[[seam]]")[0])
    text = scene.read_text()
    for head in ("hook", "frame"):
        text = re.sub(rf"^\[\[{head}\]\]\n(?:(?!\[).*\n|  .*\n)*", "", text, flags=re.MULTILINE)
    scene.write_text(text)
    return folder
