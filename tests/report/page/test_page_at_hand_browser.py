"""What a click, a wheel and a narrow window do on the page, in headless Chromium."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from seatlook.report import write_page
from seatlook.report.page.types import CloseUp
from support.browsers import all_images_decode
from support.pages import page_data

pytestmark = pytest.mark.browser
ANSWER = "No wrinkle shows in any colour under any light of this page."


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder: Path = tmp_path_factory.mktemp("page")
    data = page_data(
        folder,
        summary=(ANSWER, "Nothing is accepted or rejected: the scene sets no limit."),
        warnings=("elements of 7 mm",),
        verdict="resolved",
        again="seatlook evaluate scene.toml --out demo --resume --single-file",
        close_up=CloseUp(image="images/sun/texture 0.png", caption="black, sun", at=(50.0, 20.0)),
    )
    return write_page(data, folder).as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    """Open the page; any console message fails the test."""
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.goto(address)
    yield page
    context.close()
    assert messages == []


def test_the_answer_stands_first_and_the_solver_is_one_word(page):
    lines = page.locator("header").inner_text().splitlines()
    assert [line for line in lines if line][1] == ANSWER
    box = page.locator("details.technical")
    assert box.locator("summary").inner_text() == "Solver: resolved"
    assert not page.get_by_text("45 pixels per degree").is_visible()
    box.locator("summary").click()
    assert page.get_by_text("elements of 7 mm").is_visible()
    assert page.get_by_text("--single-file").is_visible()


def test_the_close_up_shows_its_place_and_no_more(page):
    shown = page.locator(".close-up svg").get_attribute("viewBox")
    left, top, width, height = map(float, shown.split())
    assert (width, height) == (round(64 / 3, 1), 12.0)
    assert left + width == pytest.approx(50 + 64 / 6, abs=0.1)
    assert top + height / 2 == pytest.approx(20, abs=0.1)
    assert page.locator(".close-up circle").first.get_attribute("cx") == "50.0"


def test_a_click_on_a_picture_enlarges_it_in_the_page(page):
    here = page.url
    page.locator(".grid img").nth(2).click()
    assert page.url == here
    box = page.locator("#large")
    assert box.is_visible()
    assert "suede <insert> under sun" in page.locator("#large-name").inner_text()
    assert page.locator("#large-picture").get_attribute("src").endswith("texture%201.png")
    page.locator("#large-zoom").select_option("4")
    assert page.evaluate("document.querySelector('#large-picture').clientWidth") == 256
    page.keyboard.press("Escape")
    assert not box.is_visible()
    page.locator(".close-up .picture").click()
    assert box.is_visible()


def test_what_is_picked_is_compared_where_one_clicks(page):
    page.evaluate("window.scrollTo(0, 0)")
    button = page.get_by_role("button", name="Show suede <insert> under sun as B")
    button.click()
    assert page.locator("#bench-here #picture-b").is_visible()
    assert page.locator("#picture-b").get_attribute("alt") == "B: suede <insert>, sun"
    page.get_by_role("button", name="Close").click()
    assert page.locator("#compare #comparison").count() == 1
    assert button.get_attribute("aria-pressed") == "true"
    assert page.evaluate("document.activeElement.dataset.pick") == "b"


def test_two_exposures_are_said_and_one_is_not(page):
    said = page.locator("#exposures")
    expected = "A is exposed at EV 14.6, B at EV 6.53: compare their shapes, not their brightness."
    assert said.inner_text() == expected
    page.locator("#choice-b").select_option(label="suede <insert>, sun")
    assert not said.is_visible()
    page.locator("#choice-b").select_option(label="W2")
    assert not said.is_visible()


def test_the_wheel_enlarges_about_the_place_under_it(page):
    page.evaluate("document.querySelector('#stage').style.width = '64px'")
    page.locator("#stage").scroll_into_view_if_needed()
    box = page.locator("#stage").bounding_box()
    page.mouse.move(box["x"] + 48, box["y"] + 18)
    for expected in ("1", "2", "4", "4"):
        page.mouse.wheel(0, -100)
        page.wait_for_function(f"document.querySelector('#zoom').value === '{expected}'")
    # Three quarters of the width lay under the pointer, and still do, to a pixel of each step.
    left = page.evaluate("document.querySelector('#stage').scrollLeft")
    assert (left + 48) / 256 == pytest.approx(0.75, abs=4 / 256)
    page.mouse.wheel(0, 100)
    page.wait_for_function("document.querySelector('#zoom').value === '2'")


def test_four_to_one_opens_on_the_seat_in_the_middle(page):
    page.evaluate("document.querySelector('#stage').style.width = '64px'")
    page.evaluate("document.querySelector('#stage').style.height = '36px'")
    page.get_by_label("Size").select_option("4")
    place = "(s => [s.scrollLeft + 32, s.scrollTop + 18])(document.querySelector('#stage'))"
    assert page.evaluate(place) == [128, 72]


def test_a_marked_wrinkle_stays_marked_at_every_size(page):
    page.get_by_role("button", name="wrinkle 1").click()
    page.get_by_label("Size").select_option("4")
    spot = page.locator("#sheet .spot")
    assert spot.evaluate("spot => [spot.style.left, spot.style.top]") == ["200px", "80px"]


def test_sections_are_folded_in_a_narrow_window_only(page):
    heads = page.locator("h2 > .fold")
    assert not heads.first.is_visible()
    assert page.locator("#zones table").is_visible()
    page.set_viewport_size({"width": 360, "height": 800})
    assert page.locator(".grid").is_visible()
    assert not page.locator("#zones table").is_visible()
    head = page.locator("#zones .fold")
    assert head.get_attribute("aria-expanded") == "false"
    head.focus()
    page.keyboard.press("Enter")
    assert page.locator("#zones table").is_visible()
    assert head.get_attribute("aria-expanded") == "true"
    page.locator("nav a[href='#maps']").click()
    assert page.locator("#maps figure").first.is_visible()


def test_colours_are_those_of_the_system(browser, address):
    ground = {}
    for scheme in ("dark", "light"):
        context = browser.new_context(offline=True, color_scheme=scheme)
        page = context.new_page()
        page.goto(address)
        ground[scheme] = page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert all_images_decode(page)
        context.close()
    assert ground == {"dark": "rgb(29, 29, 29)", "light": "rgb(246, 246, 246)"}
