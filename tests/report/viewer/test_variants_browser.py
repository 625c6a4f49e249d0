"""Variants in the viewer of a comparison: one camera and one light, from file:// and offline."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from seatlook import compare, io
from seatlook.report.comparison_page import write_comparison
from support.scene_files import TEXT, write_two_panels
from support.viewing import assert_accessible_and_narrow, listen, open_viewer, pixels, put, settle

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_two_panels(tmp_path_factory.mktemp("variants")).parent


@pytest.fixture(scope="module")
def address(folder: Path) -> str:
    """A comparison of a cover and the same without the hook that pulls its middle down."""
    scene = io.load_scene(folder / "scene.toml")
    before, hook, after = re.split(r"(?m)^(\[\[hook\]\]\n(?:\w.*\n)+)", TEXT)
    assert "wire" in hook
    (folder / "loose.toml").write_text(before + after)
    other = io.load_scene(folder / "loose.toml")
    comparison = compare({"hook": scene, "no hook": other}, keep=folder / "out")
    return write_comparison(comparison, folder / "out").as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    context = browser.new_context(
        offline=True, viewport={"width": 760, "height": 700}, accept_downloads=True
    )
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto(address)
    open_viewer(page)
    yield page
    context.close()
    assert messages == []


def choose(page: Any, number: int) -> np.ndarray:
    page.locator("#viewer-seat").select_option(index=number)
    settle(page)
    return pixels(page)


def away(a: np.ndarray, b: np.ndarray, least: int = 10_000) -> float:
    """Mean difference inside the map; at its border it goes with the number of samples."""
    inside = ndimage.binary_erosion(a.sum(axis=2) < 200, iterations=6)
    assert inside.sum() > least
    return float(np.abs(a - b)[inside].mean())


def test_variants_are_switched_and_camera_light_and_map_stay(page):
    names = page.locator("#viewer-seat option").all_text_contents()
    assert names == ["hook", "no hook"]
    page.locator("#viewer-canvas").focus()
    page.keyboard.press("ArrowLeft")
    put(page, "elevation", "30")
    page.locator("#viewer-layer").select_option(label="W2")
    settle(page)
    first, ends = pixels(page), page.locator("#viewer-high").text_content()
    assert away(first, choose(page, 1)) > 0.4
    assert page.locator("#viewer-layer option:checked").text_content() == "W2"
    assert page.locator("#viewer-high").text_content() == ends
    assert page.locator("#viewer-elevation").input_value() == "30"
    assert away(first, choose(page, 0)) < 0.1


def test_a_place_and_the_command_are_those_of_the_variant(page, folder):
    page.locator("#viewer-canvas").focus()
    page.keyboard.press("Enter")
    first = page.locator("#viewer-here").text_content()
    for number, name in enumerate(("hook", "no hook")):
        choose(page, number)
        page.locator("#viewer-command").click()
        words = shlex.split(page.locator("#viewer-text").input_value())
        assert words[2] == "scene.toml"
        result = io.read_result(folder / words[3])
        assert result.cover.scene_digest
        assert Path(words[3]).parts[0] == "out", name
    page.locator("#viewer-canvas").focus()
    page.keyboard.press("Enter")
    assert page.locator("#viewer-here").text_content() != first


def test_the_variant_that_is_sent_is_shown_elsewhere(page, browser, tmp_path):
    page.locator("#viewer-layer").select_option(label="W2")
    shown = choose(page, 1)
    with page.expect_download() as sent:
        page.locator("#viewer-send").click()
    sent.value.save_as(tmp_path / "seat.html")
    context = browser.new_context(offline=True, viewport={"width": 760, "height": 700})
    other, messages = context.new_page(), []
    listen(other, messages)
    other.goto((tmp_path / "seat.html").as_uri())
    settle(other)
    assert np.abs(pixels(other) - shown).mean() < 0.5
    assert other.locator("#viewer-seat option:checked").text_content() == "no hook"
    assert messages == []
    context.close()


# Pixels of the map in a part of the picture, at least.
HALF = 3000


def beside(page: Any, number: int) -> np.ndarray:
    """Show a variant beside the first, none for -1."""
    page.locator("#viewer-beside").select_option(value=str(number))
    settle(page)
    return pixels(page)


def halves(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The part on the left and that on the right."""
    width = (picture.shape[1] - 2) // 2
    return picture[:, :width], picture[:, -width:]


def test_two_variants_lie_side_by_side_with_one_camera_and_one_light(page):
    page.locator("#viewer-layer").select_option(label="W2")
    same = halves(beside(page, 0))
    # One seat twice: parts that differ would have another camera, light or range.
    assert np.abs(same[0] - same[1]).mean() < 0.1
    left, right = halves(beside(page, 1))
    assert away(same[0], left, HALF) < 0.1
    assert away(left, right, HALF) > 0.4
    assert page.locator("#viewer-first-name").text_content() == "hook"
    assert page.locator("#viewer-second-name").text_content() == "no hook"
    # What the right part shows is what the variant shows alone in as large a picture.
    page.locator("#viewer-seat").select_option(index=1)
    swapped = halves(beside(page, 0))
    assert away(swapped[0], right, HALF) < 0.1
    assert away(swapped[1], left, HALF) < 0.1


def test_mouse_and_keys_turn_both_and_light_and_look_change_in_both(page):
    shown = halves(beside(page, 1))
    canvas = page.locator("#viewer-canvas")
    canvas.scroll_into_view_if_needed()
    area = canvas.bounding_box()

    def drag(share: float) -> None:
        x, y = area["x"] + share * area["width"], area["y"] + area["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 40, y, steps=2)
        page.mouse.up()

    changes = [
        lambda: drag(0.25),
        lambda: drag(0.75),
        lambda: (canvas.focus(), page.keyboard.press("ArrowLeft")),
        lambda: put(page, "elevation", "15"),
        lambda: (put(page, "hex", "#d02040"), page.locator("#viewer-hex").press("Enter")),
    ]
    for number, change in enumerate(changes):
        change()
        settle(page)
        now = halves(pixels(page))
        for before, after in zip(shown, now, strict=True):
            assert np.abs(before - after).mean() > 0.3, f"change {number}"
        shown = now


def test_a_place_is_named_in_both(page):
    beside(page, 1)
    canvas = page.locator("#viewer-canvas")
    canvas.focus()
    page.keyboard.press("Shift+ArrowRight")  # away from the seam
    page.keyboard.press("Enter")
    lines = page.locator("#viewer-here").text_content().split("\n")
    assert [line.split(": ")[0] for line in lines] == ["hook", "no hook"]
    assert all("W2" in line for line in lines)
    assert lines[0].removeprefix("hook: ") != lines[1].removeprefix("no hook: ")
    canvas.scroll_into_view_if_needed()
    area = canvas.bounding_box()
    for share in (0.25, 0.75):
        page.mouse.click(
            area["x"] + share * area["width"] + 0.5, area["y"] + area["height"] / 2 + 0.5
        )
        clicked = page.locator("#viewer-here").text_content().split("\n")
        assert [c.split(",")[0] for c in clicked] == [line.split(",")[0] for line in lines]


def test_both_are_sent_and_one_is_left_alone(page, browser, tmp_path):
    alone = choose(page, 0)
    shown = beside(page, 1)
    with page.expect_download() as sent:
        page.locator("#viewer-send").click()
    sent.value.save_as(tmp_path / "seat.html")
    context = browser.new_context(offline=True, viewport={"width": 760, "height": 700})
    other, messages = context.new_page(), []
    listen(other, messages)
    other.goto((tmp_path / "seat.html").as_uri())
    settle(other)
    there = pixels(other)
    assert there.shape[:2] == pytest.approx(shown.shape[:2], abs=8)
    assert other.locator("#viewer-beside option:checked").text_content() == "no hook"
    assert messages == []
    context.close()
    again = beside(page, -1)
    assert again.shape == alone.shape
    assert np.abs(again - alone).mean() < 0.5
    assert not page.locator("#viewer-second-name").is_visible()


def test_on_a_phone_they_lie_one_below_the_other(browser, address):
    context = browser.new_context(offline=True, viewport={"width": 360, "height": 800})
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto(address)
    page.locator("#viewer-head .fold").click()
    open_viewer(page)
    page.locator("#viewer-layer").select_option(label="W2")
    picture = beside(page, 1)
    height = (picture.shape[0] - 2) // 2
    above, below = picture[:height], picture[-height:]
    assert picture.shape[0] > picture.shape[1]
    assert away(above, below, HALF) > 0.4
    names = [page.locator(f"#viewer-{k}-name").bounding_box() for k in ("first", "second")]
    assert names[1]["y"] - names[0]["y"] > 0.4 * picture.shape[0]
    page.locator("#viewer-canvas").focus()
    page.keyboard.press("Enter")
    assert len(page.locator("#viewer-here").text_content().split("\n")) == 2
    assert messages == []
    context.close()


@pytest.mark.parametrize("width", [360, 1280])
def test_two_beside_each_other_are_accessible_and_nothing_overflows(browser, address, width):
    assert_accessible_and_narrow(browser, address, width, lambda page: beside(page, 1))


@pytest.mark.parametrize("width", [360, 1280])
def test_no_accessibility_violation_and_nothing_overflows(browser, address, width):
    assert_accessible_and_narrow(browser, address, width, lambda page: choose(page, 1))
