"""The pictures of docs/how-to/studio.md; written there where SEATLOOK_PICTURES names the folder."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from support.studio import studio
from support.studio_page import (
    bare_folder,
    corner_on_screen,
    opened,
    settled,
    true_pattern,
    write_seat,
)

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


def test_every_room_is_drawn(browser, tmp_path):
    folder = Path(os.environ.get("SEATLOOK_PICTURES", tmp_path))
    whole = write_seat("horseshoe", tmp_path / "horseshoe")
    bare = bare_folder(whole, tmp_path / "my-seat")
    window = {"viewport": {"width": 1280, "height": 760}, "color_scheme": "light"}

    def take(page, name):
        path = folder / f"studio-{name}.png"
        page.screenshot(path=path)
        assert np.asarray(Image.open(path).convert("L")).std() > 10

    with studio(bare) as (door, _), opened(browser, door.address, **window) as page:
        settled(page)
        pattern = true_pattern(whole)
        seam = pattern.seams[1]
        near, far = pattern.edge_points(seam.a), pattern.edge_points(seam.b[0])[::-1]
        panels = pattern.edges[seam.a].panel, pattern.edges[seam.b[0]].panel
        for panel, place in ((panels[0], near[0]), (panels[0], near[-1]), (panels[1], far[0])):
            page.mouse.click(*corner_on_screen(page, panel, 1e3 * place))
        page.mouse.move(*corner_on_screen(page, panels[1], 1e3 * far[-1]))
        take(page, "sewing")
    with studio(whole) as (door, _), opened(browser, door.address, **window) as page:
        settled(page)
        for room in ("start", "assembly", "process", "looks"):
            page.locator(f"#tab-{room}").click()
            settled(page)
            page.wait_for_timeout(800)
            take(page, room)
