"""The page in headless Chromium, from file:// and offline, by mouse and by keyboard."""

from __future__ import annotations

import importlib
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from report.pages import page_data
from seatlook.report import write_page

pytestmark = pytest.mark.browser

FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    sync_api = importlib.import_module("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder: Path = tmp_path_factory.mktemp("page")
    return write_page(page_data(folder), folder).as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    """Open the page; whatever the console says or the network is asked fails the test."""
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda r: None if r.url.startswith("file:") else said.append(r.url))
    page.on("requestfailed", lambda request: said.append(f"failed: {request.url}"))
    page.goto(address)
    yield page
    context.close()
    assert said == []


def all_images_decode(page: Any) -> bool:
    page.evaluate("for (const i of document.images) i.loading = 'eager'")
    page.wait_for_function("[...document.images].every(i => i.complete)")
    return page.evaluate("[...document.images].every(i => i.naturalWidth > 0)")


def pictures(page: Any) -> tuple[str, str]:
    return tuple(page.locator(f"#picture-{side}").get_attribute("alt") for side in "ab")


def test_all_images_decode(page):
    assert all_images_decode(page)
    assert page.locator("img").count() == 10


def test_the_slider_wipes_by_keyboard_and_by_mouse(page):
    page.locator("#cut").focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    assert page.evaluate("getComputedStyle(document.querySelector('#picture-b')).clipPath") == (
        "inset(0px 0px 0px 55%)"
    )
    page.locator("#stage").scroll_into_view_if_needed()
    box = page.locator(".sheet").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 4, box["y"] + 20)
    page.mouse.down()
    page.mouse.up()
    assert page.locator("#cut").input_value() == "25"


def test_pictures_are_picked_swapped_and_flipped(page):
    assert pictures(page) == ("A: black leather, sun", "B: black leather, bulb_left")
    page.get_by_role("button", name="Show suede <insert> under sun as A").click()
    page.locator("#choice-b").select_option(label="W_compression")
    assert pictures(page) == ("A: suede <insert>, sun", "B: W_compression")
    assert page.locator("#said").text_content() == "A: suede <insert>, sun. B: W_compression."
    page.locator("#stage").focus()
    page.keyboard.press("s")
    assert pictures(page) == ("A: W_compression", "B: suede <insert>, sun")
    page.keyboard.press("f")
    assert page.locator("#flip").get_attribute("aria-pressed") == "true"
    assert (
        page.evaluate("getComputedStyle(document.querySelector('#picture-b')).clipPath") == "none"
    )
    page.keyboard.press("f")
    assert page.locator("#flip").get_attribute("aria-pressed") == "false"
    assert all_images_decode(page)


def test_blend_difference_and_size(page):
    style = "getComputedStyle(document.querySelector('#picture-b'))"
    page.get_by_label("Mode").select_option("blend")
    assert page.evaluate(f"{style}.opacity") == "0.5"
    page.get_by_label("Mode").select_option("difference")
    assert page.evaluate(f"{style}.mixBlendMode") == "difference"
    assert page.locator("#cut").is_disabled()
    page.get_by_label("Size").select_option("2")
    assert page.evaluate("document.querySelector('#picture-a').clientWidth") == 2 * 64


def test_every_control_is_reached_by_tab(page):
    wanted = page.locator("a[href], button:visible, select, input, [tabindex='0']").count()
    seen = set()
    for _ in range(wanted + 5):
        page.keyboard.press("Tab")
        seen.add(page.evaluate("[...document.all].indexOf(document.activeElement)"))
    assert len(seen) >= wanted


def test_nothing_overflows_in_a_narrow_window(page):
    page.set_viewport_size({"width": 360, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    assert page.locator(".narrow").first.is_visible()


def test_no_accessibility_violation(browser, address):
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    # The checker is injected as a script, which the page's own policy rightly refuses.
    context = browser.new_context(offline=True, bypass_csp=True)
    page = context.new_page()
    page.goto(address)
    result = axe.run(page)
    context.close()
    assert result.violations_count == 0, result.generate_report()


def test_without_scripts_pictures_and_maps_remain(browser, address):
    context = browser.new_context(offline=True, java_script_enabled=False)
    page = context.new_page()
    page.goto(address)
    assert "Comparing two pictures needs scripts" in page.locator("#compare").inner_text()
    assert page.locator("img:visible").count() == 8
    assert not page.locator(".pick").first.is_visible()
    context.close()
