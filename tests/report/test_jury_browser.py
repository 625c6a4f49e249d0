"""The jury page in headless Chromium, from file://, offline: by keyboard alone, and reloaded."""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any

import pytest

from seatlook.jury.questionnaire import Catch, Questionnaire, Stimulus, trials
from seatlook.jury.votes import merge_votes
from seatlook.report.jury_page import write_jury_page
from support.browsers import all_images_decode
from support.pages import SIZE, picture, write_png

pytestmark = pytest.mark.browser
SEED = 7


def stimulus(name: str) -> Stimulus:
    return Stimulus(name=name, picture=f"images/{name}.png")


def make(folder: Path, **options: Any) -> tuple[Questionnaire, str]:
    questionnaire = Questionnaire(
        title="Seat covers <b>",
        stimuli=tuple(stimulus(f"c{k}") for k in range(4)),
        catches=(Catch(wrinkled=stimulus("deep"), smooth=stimulus("flat")),),
        repeat_share=0.2,
        **options,
    )
    for k, name in enumerate(("c0", "c1", "c2", "c3", "deep", "flat")):
        write_png(folder / f"images/{name}.png", picture(k))
    page = write_jury_page(questionnaire, folder, judges=3, seed=SEED, size=SIZE)
    return questionnaire, page.as_uri()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Questionnaire, str]:
    return make(tmp_path_factory.mktemp("jury"))


@pytest.fixture
def page(browser, made):
    """Open the page; any console message or network request fails the test."""
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 900})
    page = context.new_page()
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    outside = ("file:", "blob:")
    page.on("request", lambda r: None if r.url.startswith(outside) else messages.append(r.url))
    page.goto(made[1])
    yield page
    context.close()
    assert messages == []


def begin(page: Any, name: str, number: int) -> None:
    """By keyboard alone: the name has the focus when the page opens."""
    page.keyboard.type(name)
    page.keyboard.press("Tab")
    page.keyboard.type(str(number))
    page.keyboard.press("Enter")


def answer(page: Any, key: str) -> None:
    """Press on where a question is announced, wait for both pictures, then answer."""
    if page.locator("#pause").is_visible():
        page.keyboard.press("Enter")
    page.wait_for_selector("#picture-right:not(.waiting)")
    before = page.locator("#status").text_content()
    page.keyboard.press(key)
    page.wait_for_function(
        "text => document.querySelector('#trial').hidden"
        " || document.querySelector('#status').textContent !== text",
        arg=before,
    )


def saved(page: Any, folder: Path) -> dict[str, Any]:
    with page.expect_download() as download:
        page.keyboard.press("Enter")
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    return json.loads(path.read_text(encoding="utf-8"))


def test_a_whole_session_by_keyboard_alone_comes_back_as_votes(page, made, tmp_path):
    questionnaire, _ = made
    wanted = trials(questionnaire, SEED + 1)
    begin(page, "Anna Ü.", 2)
    for trial in wanted:
        answer(page, "ArrowLeft" if trial.left < trial.right else "ArrowRight")
    assert page.locator("#end").is_visible()
    assert page.evaluate("document.activeElement.id") == "save"
    document = saved(page, tmp_path)
    (path,) = tmp_path.glob("votes-Anna-*.json")
    ballots = merge_votes({path: path.read_text(encoding="utf-8")}, questionnaire)
    assert ballots.problems == ()
    assert ballots.notices == ()
    assert document["seed"] == SEED + 1
    got = [(v.trial, v.question, v.left, v.right, v.kind) for v in ballots.votes]
    assert got == [(t.number, t.question, t.left, t.right, t.kind) for t in wanted]
    assert all(v.chosen == min(v.left, v.right) for v in ballots.votes)
    assert all(0 <= v.seconds < 60 for v in ballots.votes)


def test_answers_survive_a_reload_and_can_be_taken_back(page, made):
    begin(page, "Ben", 1)
    for key in ("ArrowLeft", "ArrowRight", "ArrowLeft"):
        answer(page, key)
    page.reload()
    page.wait_for_selector("#picture-right:not(.waiting)")
    assert page.locator("#status").text_content().startswith("Pair 4 of ")
    page.keyboard.press("Backspace")
    assert page.locator("#status").text_content().startswith("Pair 3 of ")
    page.reload()
    page.wait_for_selector("#picture-right:not(.waiting)")
    assert page.locator("#status").text_content().startswith("Pair 3 of ")


def test_a_number_belongs_to_one_judge(page):
    begin(page, "Carl", 3)
    answer(page, "ArrowLeft")
    page.get_by_role("button", name="Another judge").click()
    begin(page, "Dora", 3)
    assert "Number 3 is already used by another judge" in page.locator("#notice").text_content()
    page.keyboard.press("Backspace")
    page.keyboard.type("1")
    page.keyboard.press("Enter")
    assert page.locator("#pause").is_visible()
    page.get_by_role("button", name="Continue").click()
    assert page.locator("#status").text_content().startswith("Pair 1 of ")


def test_a_held_key_answers_once(page):
    begin(page, "Eva", 1)
    page.keyboard.press("Enter")
    page.wait_for_selector("#picture-right:not(.waiting)")
    page.keyboard.down("ArrowLeft")
    for _ in range(4):
        page.keyboard.down("ArrowLeft")
    page.keyboard.up("ArrowLeft")
    page.wait_for_selector("#picture-right:not(.waiting)")
    assert page.locator("#status").text_content().startswith("Pair 2 of ")


def test_nothing_tells_which_picture_is_which(page):
    begin(page, "Fay", 1)
    page.keyboard.press("Enter")
    page.wait_for_selector("#picture-right:not(.waiting)")
    assert all_images_decode(page)
    text = page.locator("main").inner_text()
    assert "Seat covers <b>" in text
    assert not any(name in text for name in ("c0", "c1", "c2", "c3", "deep", "flat"))
    alts = [page.locator(f"#picture-{side}").get_attribute("alt") for side in ("left", "right")]
    assert alts == ["The left picture", "The right picture"]


def test_equal_only_where_the_questionnaire_allows_it(browser, tmp_path):
    questionnaire, address = make(tmp_path, ties=True)
    context = browser.new_context(offline=True)
    page = context.new_page()
    page.goto(address)
    begin(page, "Gus", 1)
    answer(page, "ArrowDown")
    stored = page.evaluate(f"localStorage.getItem('seatlook-jury-{questionnaire.digest}-0')")
    context.close()
    assert [v["choice"] for v in json.loads(stored)["votes"]] == ["tie"]


def test_nothing_overflows_in_a_narrow_window(page):
    page.set_viewport_size({"width": 360, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    begin(page, "Hal", 1)
    page.keyboard.press("Enter")
    page.wait_for_selector("#picture-right:not(.waiting)")
    assert page.evaluate("document.documentElement.scrollWidth") == 360


@pytest.mark.parametrize("screen", ["start", "pause", "trial", "end"])
def test_no_accessibility_violation(browser, made, screen):
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    # The checker is injected as a script, which the page's own policy rightly refuses.
    context = browser.new_context(offline=True, bypass_csp=True)
    page = context.new_page()
    page.goto(made[1])
    if screen != "start":
        begin(page, "Ida", 1)
    if screen == "trial":
        answer(page, "ArrowLeft")
        page.wait_for_selector("#picture-right:not(.waiting)")
    if screen == "end":
        while not page.locator("#end").is_visible():
            answer(page, "ArrowLeft")
    result = axe.run(page)
    context.close()
    assert result.violations_count == 0, result.generate_report()
