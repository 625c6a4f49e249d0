"""The line of time in Chromium: ends and bars dragged by mouse, moved by keys, set by numbers."""

from __future__ import annotations

import pytest

from support.studio import studio
from support.studio_page import opened, settled, write_seat

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


def test_a_stage_is_dragged_moved_by_keys_and_set_by_numbers(browser, tmp_path):
    home = write_seat("saddle", tmp_path / "seat")
    with studio(home) as (door, client), opened(browser, door.address) as page:
        settled(page)
        page.locator("#tab-process").click()
        before = client.state["stages"]
        last = len(before) - 1
        grip = page.locator(f'[data-grip="end {last}"]')
        box = grip.bounding_box()
        page.mouse.move(box["x"] + 5, box["y"] + 10)
        page.mouse.down()
        page.mouse.move(box["x"] + 65, box["y"] + 10, steps=4)
        page.mouse.up()
        settled(page)
        dragged = client.state["stages"][last]
        assert dragged["end_s"] > before[last]["end_s"]
        assert dragged["start_s"] == before[last]["start_s"]

        page.locator(f'[data-grip="end {last}"]').focus()
        for _ in range(3):
            page.keyboard.press("ArrowLeft")
        page.wait_for_timeout(600)
        settled(page)
        moved = client.state["stages"][last]
        assert moved["end_s"] == pytest.approx(dragged["end_s"] - 0.06, abs=0.011)
        assert page.evaluate("document.activeElement.dataset.grip") == f"end {last}"

        page.locator('[data-key="stage ramp"]').select_option("smooth")
        settled(page)
        assert client.state["stages"][last]["ramp"] == "smooth"
        page.keyboard.press("Control+z")
        settled(page)
        assert client.state["stages"][last].get("ramp", "linear") == "linear"

        page.locator('[data-key="stage start"]').fill("0.5")
        page.keyboard.press("Enter")
        settled(page)
        assert client.state["stages"][last]["start_s"] == 0.5
