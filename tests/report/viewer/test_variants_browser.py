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


def away(a: np.ndarray, b: np.ndarray) -> float:
    """Mean difference inside the map; at its border it goes with the number of samples."""
    inside = ndimage.binary_erosion(a.sum(axis=2) < 200, iterations=6)
    assert inside.sum() > 10_000
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


@pytest.mark.parametrize("width", [360, 1280])
def test_no_accessibility_violation_and_nothing_overflows(browser, address, width):
    assert_accessible_and_narrow(browser, address, width, lambda page: choose(page, 1))
