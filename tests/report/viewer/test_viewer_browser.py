"""The viewer in Chromium with WebGL by software: from file://, offline, by mouse and keyboard."""

from __future__ import annotations

import importlib
import shlex
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow

import seatlook
from seatlook import io
from seatlook.chain.case import Case
from seatlook.model import Rig, bulb
from seatlook.report import write_page
from seatlook.report.page.types import ViewerSection
from seatlook.report.viewer.section import viewer_section
from seatlook.report.viewer_page import viewer_page
from support.browsers import FLAGS
from support.commands import seatlook as command
from support.pages import page_data, write_png
from support.viewing import (
    STILL,
    assert_accessible_and_narrow,
    differs,
    listen,
    open_viewer,
    pixels,
    put,
    said,
    settle,
)

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def case(demo_scene) -> Case:
    solved = seatlook.open(demo_scene)
    # A threshold this low makes wrinkles of what the coarse cover has.
    return Case(replace(solved.scene, c_threshold=2.0), solution=solved.solution)


@pytest.fixture(scope="module")
def viewer(case) -> ViewerSection:
    io.write_result(case.solution, case.scene.path.with_name("result.npz"))
    return viewer_section(case, case.camera(None), case.scene.path.parent)


@pytest.fixture(scope="module")
def address(viewer, tmp_path_factory) -> str:
    folder: Path = tmp_path_factory.mktemp("page")
    return write_page(page_data(folder, viewer=viewer), folder).as_uri()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    """Open the page; a console message, an error or a request from outside fails the test."""
    context = browser.new_context(
        offline=True, viewport={"width": 760, "height": 700}, accept_downloads=True
    )
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto(address)
    yield page
    context.close()
    assert messages == []


def test_nothing_is_drawn_before_it_is_asked_for(page):
    assert not page.locator("#viewer-canvas").is_visible()
    page.locator("#viewer-open").click()
    assert page.locator("#viewer-canvas").is_visible()
    settle(page)


def test_it_is_turned_and_enlarged_by_mouse_and_by_keyboard(page):
    open_viewer(page)
    canvas = page.locator("#viewer-canvas")
    area = canvas.bounding_box()
    middle = area["x"] + area["width"] / 2, area["y"] + area["height"] / 2
    shown = [pixels(page)]

    def step(act: Any) -> None:
        act()
        settle(page)
        shown.append(pixels(page))
        assert differs(shown[-2], shown[-1])

    def drag(button: str) -> None:
        page.mouse.move(*middle)
        page.mouse.down(button=button)
        page.mouse.move(middle[0] + 60, middle[1] + 10, steps=3)
        page.mouse.up(button=button)

    step(lambda: drag("left"))
    step(lambda: drag("right"))
    step(lambda: page.mouse.wheel(0, -300))
    canvas.focus()
    for key in ("ArrowLeft", "Shift+ArrowUp", "-"):
        step(lambda key=key: page.keyboard.press(key))
    page.get_by_role("button", name="driver door").click()
    settle(page)
    assert differs(shown[-1], pixels(page))


def test_fingers_turn_enlarge_and_shift(browser, address):
    context = browser.new_context(
        offline=True, viewport={"width": 760, "height": 700}, has_touch=True
    )
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto(address)
    open_viewer(page)
    page.locator("#viewer-canvas").scroll_into_view_if_needed()
    area, scrolled = page.locator("#viewer-canvas").bounding_box(), page.evaluate("window.scrollY")
    x, y = area["x"] + area["width"] / 2, area["y"] + area["height"] / 2
    protocol = context.new_cdp_session(page)

    def touch(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x + u, "y": y + v, "id": k} for k, (u, v) in enumerate(places)]
        protocol.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def swipe(*ways: tuple[tuple[float, float], tuple[float, float]]) -> np.ndarray:
        touch("touchStart", *(start for start, _ in ways))
        for share in (0.25, 0.5, 0.75, 1.0):
            touch(
                "touchMove",
                *((a + share * (c - a), b + share * (d - b)) for (a, b), (c, d) in ways),
            )
        touch("touchEnd")
        settle(page)
        return pixels(page)

    def covered(picture: np.ndarray) -> np.ndarray:
        return np.abs(picture - picture[0, 0]).max(axis=2) > 12

    first = pixels(page)
    turned = swipe(((-40, 0), (40, 10)))
    assert differs(first, turned)
    apart = swipe(((-30, 0), (-60, 0)), ((30, 0), (60, 0)))
    assert covered(apart).sum() > 1.5 * covered(turned).sum()
    together = swipe(((-60, 0), (-30, 0)), ((60, 0), (30, 0)))
    assert abs(covered(together).sum() / covered(turned).sum() - 1) < 0.05
    shifted = swipe(((-30, 0), (30, 0)), ((30, 0), (90, 0)))
    middles = [np.argwhere(covered(seen)).mean(axis=0) for seen in (together, shifted)]
    # The seat goes where the fingers go, in pixels of the screen.
    assert middles[1][1] - middles[0][1] == pytest.approx(60, abs=8)
    assert middles[1][0] == pytest.approx(middles[0][0], abs=8)
    # A tap names a place, and the page itself has stayed.
    touch("touchStart", (0, 0))
    touch("touchEnd")
    assert page.locator("#viewer-here").text_content().startswith("Here: ")
    assert page.evaluate("window.scrollY") == scrolled
    context.close()
    assert messages == []


def test_light_material_and_map_change_what_is_seen(page):
    open_viewer(page)
    last = pixels(page)
    changes = [
        lambda: put(page, "elevation", "20"),
        lambda: put(page, "azimuth", "90"),
        lambda: put(page, "power", "1"),
        lambda: page.locator("#viewer-follow").check(),
        lambda: page.locator("#viewer-look").select_option(index=1),
        lambda: (put(page, "hex", "#7a1020"), page.locator("#viewer-hex").press("Enter")),
        lambda: (put(page, "lab", "70, 0, 30"), page.locator("#viewer-lab").press("Enter")),
        lambda: put(page, "roughness", "0.1"),
        lambda: put(page, "nap", "0.9"),
        lambda: page.locator("#viewer-layer").select_option(label="W2"),
        lambda: page.locator("#viewer-layer").select_option(label="Gap"),
        lambda: page.locator("#viewer-layer").select_option(label="nothing"),
        lambda: page.locator("#viewer-rig").select_option(index=1),
    ]
    for number, change in enumerate(changes):
        change()
        settle(page)
        now = pixels(page)
        assert differs(last, now), f"change {number}"
        last = now
    assert page.locator("#viewer-hex").input_value().startswith("#")


def test_a_colour_that_is_none_is_said(page):
    open_viewer(page)
    put(page, "hex", "wine")
    page.locator("#viewer-hex").press("Enter")
    assert "six digits" in page.locator("#viewer-status").text_content()
    assert page.locator("#viewer-hex").get_attribute("aria-invalid") == "true"


def test_a_place_is_named_by_mouse_and_by_keyboard(page):
    open_viewer(page)
    page.locator("#viewer-canvas").focus()
    page.keyboard.press("Enter")
    by_key = page.locator("#viewer-here").text_content()
    assert "W2" in by_key
    assert "Nearest seam" in by_key
    assert "along the grain" in by_key
    area = page.locator("#viewer-canvas").bounding_box()
    page.mouse.click(area["x"] + area["width"] / 2, area["y"] + area["height"] / 2)
    panel = by_key.split(",")[0]
    assert page.locator("#viewer-here").text_content().startswith(panel)
    page.mouse.click(area["x"] + 3, area["y"] + 3)
    assert page.locator("#viewer-here").text_content() == "Here: nothing of the seat."


def test_wrinkles_are_flown_to(page, case):
    assert case.assessment.wrinkles
    open_viewer(page)
    before = pixels(page)
    page.locator("#viewer-wrinkle").select_option(index=1)
    settle(page)
    assert differs(before, pixels(page))
    assert page.locator("#viewer-here").text_content().startswith("Wrinkle 1: ")


def test_what_is_copied_is_a_light_and_a_look_that_a_scene_can_hold(page, tmp_path):
    tomllib = importlib.import_module("tomllib")
    open_viewer(page)
    put(page, "elevation", "35")
    page.locator("#viewer-toml").click()
    text = page.locator("#viewer-text").input_value()
    said = tomllib.loads(text)
    assert said["rig"][0]["light"][0]["elevation_deg"] == pytest.approx(35.0)
    assert len(said["appearance"]["albedo"]) == 3


def test_the_command_draws_the_same_view(page, case, tmp_path):
    open_viewer(page)
    for name in ("front 34", "top"):
        page.get_by_role("button", name=name).click()
        for moves in ("", "turned"):
            if moves:
                page.locator("#viewer-canvas").focus()
                for key in ("ArrowLeft", "ArrowLeft", "Shift+ArrowUp", "+"):
                    page.keyboard.press(key)
            settle(page)
            page.locator("#viewer-command").click()
            text = page.locator("#viewer-text").input_value()
            assert ("--position-mm" in text) == bool(moves)
            program, *words = shlex.split(text)
            assert program == "seatlook"
            words[words.index("view")] = str(tmp_path / f"{name}{moves}")
            done = command(*words, "--quality", "draft", cwd=case.scene.path.parent)
            assert done.returncode == 0, done.stderr
            (drawn,) = (tmp_path / f"{name}{moves}").rglob("*.png")
            shown = pixels(page)
            there = (
                Pillow.open(drawn).convert("RGB").resize(shown.shape[1::-1], Pillow.Resampling.BOX)
            )
            away = np.abs(np.asarray(there).astype(float) - shown).max(axis=2) > 40
            # The seat is a third of the picture; a view that is off by 1 % of it is off on more.
            assert away.mean() < 0.03


def test_names_are_quoted_for_a_shell(page, case):
    open_viewer(page)
    page.locator("#viewer-rig").select_option(index=1)
    put(page, "power", "1")
    page.locator("#viewer-command").click()
    words = shlex.split(page.locator("#viewer-text").input_value())
    assert f"--rig={case.scene.rigs[1].name}" in words
    assert "It takes light and material as they were" in said(page, "kept")


def test_it_is_sent_as_one_file_that_looks_the_same(page, browser, tmp_path):
    write_png(
        tmp_path / "fabric.png", np.random.default_rng(0).integers(0, 255, (40, 60, 3), np.uint8)
    )
    open_viewer(page)
    put(page, "elevation", "25")
    page.locator("#viewer-photo").set_input_files(tmp_path / "fabric.png")
    settle(page)
    with page.expect_download() as sent:
        page.locator("#viewer-send").click()
    shown = pixels(page)
    (tmp_path / "elsewhere").mkdir()
    sent.value.save_as(tmp_path / "elsewhere/seat.html")
    context = browser.new_context(offline=True, viewport={"width": 760, "height": 700})
    other, messages = context.new_page(), []
    listen(other, messages)
    other.goto((tmp_path / "elsewhere/seat.html").as_uri())
    settle(other)
    there = pixels(other)
    assert there.shape == shown.shape
    assert np.abs(there - shown).mean() < 0.5
    assert messages == []
    context.close()


def test_a_notebook_shows_it_in_a_frame(browser, case, tmp_path):
    shown = viewer_page(case, case.camera("top"))
    (tmp_path / "cell.html").write_text(f"<!doctype html>{shown._repr_html_()}", encoding="utf-8")
    context = browser.new_context(offline=True, viewport={"width": 760, "height": 700})
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto((tmp_path / "cell.html").as_uri())
    frame = page.frame_locator("iframe")
    frame.locator("#viewer-open").click()
    frame.locator(STILL).wait_for(timeout=90_000)
    assert frame.locator("#viewer-canvas").is_visible()
    assert messages == []
    context.close()


def test_what_a_light_loses_is_said(browser, case, tmp_path):
    lamps = tuple(
        bulb(lumen=100.0, position_mm=(100.0 * k, 0.0, 900.0), radius_mm=20.0) for k in range(10)
    )
    rigs = (
        Rig(name="many", lights=lamps),
        Rig(name="garden", lights=(), panorama=np.full((4, 8, 3), 300.0)),
        Rig(name="one", lights=lamps[:1]),
    )
    lit = Case(replace(case.scene, rigs=rigs), solution=case.solution)
    file = viewer_page(lit, lit.camera(None)).save(tmp_path / "seat.html")
    context = browser.new_context(offline=True, viewport={"width": 760, "height": 700})
    page, messages = context.new_page(), []
    listen(page, messages)
    page.goto(file.as_uri())
    open_viewer(page)
    assert "8 of its 10 lamps" in said(page, "rig-note")
    assert not page.locator("#viewer-command").is_visible()
    page.locator("#viewer-rig").select_option(index=1)
    assert said(page, "rig-note") == "Its sky is a picture; here it is even, as bright."
    page.locator("#viewer-rig").select_option(index=2)
    assert not page.locator("#viewer-rig-note").is_visible()
    assert messages == []
    context.close()


def test_without_webgl_the_pictures_stay(browser, address):
    flags = [flag for flag in FLAGS if "swiftshader" not in flag and "angle" not in flag]
    other = browser.browser_type.launch(
        executable_path=shutil.which("chromium"), args=[*flags, "--disable-3d-apis"]
    )
    page = other.new_page()
    page.goto(address)
    page.locator("#viewer-open").click()
    page.get_by_text("it draws no WebGL 2").wait_for()
    assert not page.locator("#viewer-canvas").is_visible()
    assert page.locator(".grid img").first.is_visible()
    other.close()


def test_a_lost_context_leaves_the_pictures(page):
    open_viewer(page)
    page.evaluate(
        "() => document.getElementById('viewer-canvas').getContext('webgl2')"
        ".getExtension('WEBGL_lose_context').loseContext()"
    )
    page.get_by_text("The graphics card stopped.").wait_for()
    assert not page.locator("#viewer-canvas").is_visible()
    assert page.locator(".grid img").first.is_visible()


@pytest.mark.parametrize("width", [360, 1280, 1920])
def test_no_accessibility_violation_and_nothing_overflows(browser, address, width):
    def colour_and_copy(page):
        page.locator("#viewer-layer").select_option(label="W2")
        page.locator("#viewer-toml").click()
        settle(page)

    assert_accessible_and_narrow(browser, address, width, colour_and_copy)
