"""The page in headless Chromium, from file:// and offline, by mouse and by keyboard."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

from seatlook.report import write_page
from seatlook.report.page.types import Spot
from support.browsers import all_images_decode
from support.pages import RIGS, page_data, write_png

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder: Path = tmp_path_factory.mktemp("page")
    return write_page(page_data(folder), folder).as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    """Open the page; any console message or network request fails the test."""
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda r: None if r.url.startswith("file:") else messages.append(r.url))
    page.on("requestfailed", lambda request: messages.append(f"failed: {request.url}"))
    page.goto(address)
    yield page
    context.close()
    assert messages == []


def pictures(page: Any) -> tuple[str, str]:
    return tuple(page.locator(f"#picture-{side}").get_attribute("alt") for side in "ab")


def test_all_images_decode(page):
    assert all_images_decode(page)
    assert page.locator("img").count() == 16


def test_the_slider_wipes_by_keyboard_and_by_mouse(page):
    page.locator("#cut").focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    assert page.evaluate("getComputedStyle(document.querySelector('#picture-b')).clipPath") == (
        "inset(0px 0px 0px 55%)"
    )
    page.locator("#stage").scroll_into_view_if_needed()
    box = page.locator("#sheet").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 4, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.up()
    assert page.locator("#cut").input_value() == "25"


def test_pictures_are_picked_swapped_and_flipped(page):
    assert pictures(page) == ("A: black leather, sun", "B: black leather, bulb_left")
    page.get_by_role("button", name="Show suede <insert> under sun as A").click()
    page.locator("#choice-b").select_option(label="W_compression")
    assert pictures(page) == ("A: suede <insert>, sun", "B: W_compression")
    assert page.locator("#status").text_content() == "A: suede <insert>, sun. B: W_compression."
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


def test_holding_shows_b_only_as_long_as_it_is_held(page):
    pressed = page.locator("#flip")
    page.locator("#stage").focus()
    page.keyboard.down(" ")
    assert pressed.get_attribute("aria-pressed") == "true"
    page.keyboard.up(" ")
    assert pressed.get_attribute("aria-pressed") == "false"
    page.locator("#hold").hover()
    page.mouse.down()
    assert pressed.get_attribute("aria-pressed") == "true"
    page.mouse.up()
    assert pressed.get_attribute("aria-pressed") == "false"


def test_an_overlay_lies_over_both_with_its_opacity(page):
    over = page.locator("#sheet .over")
    assert not over.is_visible()
    assert page.locator("#opacity").is_disabled()
    page.get_by_label("Overlay").select_option(label="W2")
    page.locator("#opacity").focus()
    page.keyboard.press("ArrowRight")
    assert over.is_visible()
    assert over.evaluate("image => image.style.opacity") == "0.51"
    assert over.get_attribute("src").endswith("maps/W2.png")
    assert "Over both: W2." in page.locator("#status").text_content()


def test_the_dial_shows_a_under_another_light(page):
    dial = page.locator(".dial")
    assert dial.locator("[data-rig='sun']").get_attribute("aria-pressed") == "true"
    page.locator("#choice-a").select_option(label="suede <insert>, sun")
    dial.get_by_role("button", name="bulb_left: bulb, azimuth 115, elevation 40 degrees").click()
    assert pictures(page)[0] == "A: suede <insert>, bulb_left"
    dial.locator("[data-rig='sun']").focus()
    page.keyboard.press("Enter")
    assert pictures(page)[0] == "A: suede <insert>, sun"


def test_the_grid_turns_and_back(page):
    first = "document.querySelector('.grid').rows[1].cells[0].textContent"
    heads = "[...document.querySelectorAll('.grid thead th')].map(h => h.scope).join()"
    assert "black leather" in page.evaluate(first)
    page.locator("#turn").click()
    assert "sun" in page.evaluate(first)
    assert page.evaluate("document.querySelector('.grid').rows.length") == 3
    assert page.evaluate(heads) == "col,col,col"
    page.locator("#stage").focus()
    page.keyboard.press("t")
    assert "black leather" in page.evaluate(first)
    assert all_images_decode(page)


def test_the_worst_light_and_cell_are_marked(page):
    grid = page.locator(".grid")
    assert "worst: bulb_left, VWI 4" in grid.locator("tbody th").nth(1).inner_text()
    assert "worst: suede <insert>, VWI 3" in grid.locator("thead th").nth(1).inner_text()
    assert grid.get_by_text("VWI 4: most visible of all").count() == 1


def test_maps_take_a_range_of_their_own(page):
    shown = "[...document.querySelectorAll('.maps img:not([hidden])')].map(i => i.src)"
    assert all_images_decode(page)
    label = page.locator("#maps .range").nth(2)
    assert label.text_content() == "0 to 1.50"
    page.locator("#shared").uncheck()
    assert label.text_content() == "0 to 0.400"
    assert page.evaluate(shown)[2].endswith("W_stretch-own.png")
    page.locator("#shared").focus()
    page.keyboard.press(" ")
    assert label.text_content() == "0 to 1.50"
    assert page.evaluate(shown)[2].endswith("W_stretch.png")


def test_a_wrinkle_is_jumped_to(page):
    page.get_by_role("button", name="wrinkle 1").click()
    assert page.locator("#zoom").input_value() == "2"
    spot = page.locator("#sheet .spot")
    assert spot.is_visible()
    assert spot.evaluate("spot => [spot.style.left, spot.style.top]") == ["100px", "40px"]


def test_wrinkles_are_gone_through_by_key(browser, tmp_path):
    spots = (Spot(label="wrinkle 1", x=50.0, y=20.0), Spot(label="wrinkle 2", x=10.0, y=10.0))
    path = write_page(page_data(tmp_path, spots=spots), tmp_path)
    context = browser.new_context(offline=True)
    page = context.new_page()
    page.goto(path.as_uri())
    page.locator("#stage").focus()
    left = "document.querySelector('#sheet .spot').style.left"
    for expected in ("100px", "20px", "100px"):
        page.keyboard.press("n")
        assert page.evaluate(left) == expected
    context.close()


def test_side_by_side_both_pictures_scroll_and_enlarge_together(page):
    beside = page.locator("#beside")
    assert not beside.is_visible()
    page.locator("#stage").focus()
    for _ in range(3):
        page.keyboard.press("m")
    assert page.locator("#mode").input_value() == "side"
    assert beside.is_visible()
    assert page.locator("#cut").is_disabled()
    assert page.locator("#picture-beside").get_attribute("alt") == "B: black leather, bulb_left"
    assert not page.locator("#picture-b").is_visible()
    page.get_by_label("Overlay").select_option(label="W2")
    assert page.locator("#beside .over").is_visible()
    page.evaluate("for (const p of document.querySelectorAll('.stage')) p.style.width = '100px'")
    page.get_by_label("Size").select_option("4")
    widths = "[...document.querySelectorAll('.bench .sheet')].map(s => s.clientWidth)"
    assert page.evaluate(widths) == [256, 256]
    left = "[...document.querySelectorAll('.bench .stage')].map(p => p.scrollLeft)"
    assert page.evaluate(left) == [78, 78]
    page.evaluate("document.querySelector('#stage').scrollLeft = 30")
    page.wait_for_function(f"{left}.join() === '30,30'")
    beside.scroll_into_view_if_needed()
    box = beside.bounding_box()
    page.mouse.move(box["x"] + 80, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 40, box["y"] + 20)
    page.mouse.up()
    page.wait_for_function(f"{left}.join() === '70,70'")
    page.keyboard.press("m")
    assert page.locator("#mode").input_value() == "wipe"
    assert not beside.is_visible()


def test_size_is_marked_and_the_keys_change_it(page):
    page.locator("#stage").focus()
    assert "scores are for 1:1" in page.locator("#scale").text_content()
    page.keyboard.press("1")
    assert page.locator("#scale").text_content() == "1:1, as scored"
    page.keyboard.press("+")
    assert page.locator("#zoom").input_value() == "2"
    page.keyboard.press("-")
    page.keyboard.press("0")
    assert page.locator("#zoom").input_value() == "fit"


def test_a_large_picture_is_dragged(page):
    page.get_by_label("Mode").select_option("difference")
    page.evaluate("document.querySelector('#stage').style.width = '100px'")
    page.get_by_label("Size").select_option("4")
    page.locator("#stage").scroll_into_view_if_needed()
    box = page.locator("#stage").bounding_box()
    page.mouse.move(box["x"] + 80, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 30, box["y"] + 20)
    page.mouse.up()
    assert page.evaluate("document.querySelector('#stage').scrollLeft") == 78 + 50


def test_the_list_of_keys_opens_and_closes(page):
    page.keyboard.press("?")
    assert page.locator("#keys").is_visible()
    page.keyboard.press("Escape")
    assert not page.locator("#keys").is_visible()
    page.locator("#help").click()
    page.get_by_role("button", name="Close").click()
    assert not page.locator("#keys").is_visible()


def test_parameters_are_copied_as_toml(browser, address):
    context = browser.new_context(offline=True)
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.goto(address)
    page.get_by_role("button", name="Copy as TOML").click()
    page.get_by_role("button", name="Copied").wait_for()
    assert page.evaluate("navigator.clipboard.readText()") == "[mesh]\nseed = 0\n"
    context.close()


def test_one_file_alone_shows_everything(browser, tmp_path):
    (tmp_path / "made").mkdir()
    path = write_page(page_data(tmp_path / "made"), tmp_path / "made", single_file=True)
    (tmp_path / "sent.html").write_bytes(path.read_bytes())
    context = browser.new_context(offline=True)
    page = context.new_page()
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.goto((tmp_path / "sent.html").as_uri())
    assert all_images_decode(page)
    page.get_by_role("button", name="Show suede <insert> under sun as A").click()
    assert pictures(page)[0] == "A: suede <insert>, sun"
    assert messages == []
    context.close()


def test_a_page_of_thirty_cells_is_light_and_opens_at_once(browser, tmp_path):
    textures = tuple(f"texture {k}" for k in range(5))
    rigs = tuple(replace(RIGS[0], name=f"rig {k}") for k in range(6))
    noise = np.random.default_rng(0)
    pictures = {}
    for number, cell in enumerate((t, r.name) for t in textures for r in rigs):
        # A textured picture packs to about two thirds of a megabyte; this one to more.
        image = np.repeat(noise.integers(100, 116, (720, 1280, 1), dtype=np.uint8), 3, axis=2)
        pictures[cell] = f"images/{number}.png"
        write_png(tmp_path / pictures[cell], image)
    data = page_data(
        tmp_path, textures=textures, rigs=rigs, pictures=MappingProxyType(pictures),
        size=(1280, 720), score=None,
    )  # fmt: skip
    page_file = write_page(data, tmp_path)
    weight = sum(f.stat().st_size for f in tmp_path.rglob("*") if f.is_file())
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    page.goto(page_file.as_uri())
    opened = page.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd")
    assert page.locator(".grid img").count() == 30
    print(f"30 cells: {weight / 1e6:.1f} MB, open after {opened:.0f} ms")
    assert weight < 40e6
    context.close()


def test_every_control_is_reached_by_tab(page):
    wanted = page.locator(
        "a[href]:visible, button:visible, select:visible, input:visible, [tabindex='0']:visible"
    ).count()
    seen = set()
    for _ in range(wanted + 5):
        page.keyboard.press("Tab")
        seen.add(page.evaluate("[...document.all].indexOf(document.activeElement)"))
    assert len(seen) >= wanted


def test_nothing_overflows_in_a_narrow_window(page):
    page.set_viewport_size({"width": 360, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    assert page.locator(".narrow").first.is_visible()


@pytest.mark.parametrize("scheme", ["dark", "light"])
@pytest.mark.parametrize("width", [360, 1280, 1920])
def test_no_accessibility_violation_in_any_window(browser, address, width, scheme):
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    # The checker is injected as a script, which the page's own policy rightly refuses.
    context = browser.new_context(
        offline=True, bypass_csp=True, viewport={"width": width, "height": 900}, color_scheme=scheme
    )
    page = context.new_page()
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.goto(address)
    page.evaluate("for (const d of document.querySelectorAll('details')) d.open = true")
    assert page.evaluate("document.documentElement.scrollWidth") == width
    # As it opens, side by side, with the list of keys.
    for steps in ((), ("m", "m", "m"), ("?",)):
        for key in steps:
            page.keyboard.press(key)
        result = axe.run(page)
        assert result.violations_count == 0, result.generate_report()
    context.close()
    assert messages == []


def test_without_scripts_pictures_and_maps_remain(browser, address):
    context = browser.new_context(offline=True, java_script_enabled=False)
    page = context.new_page()
    page.goto(address)
    assert "allow scripts for this file" in page.locator("#compare").inner_text()
    assert page.locator("img:visible").count() == 8
    assert not page.locator(".fold").count()
    assert not page.locator(".pick").first.is_visible()
    context.close()
