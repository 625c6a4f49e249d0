"""The pattern in Chromium: sewn by four picks and by guesses, by mouse and by keyboard."""

from __future__ import annotations

import pytest

from support.studio import studio
from support.studio_page import (
    Hands,
    accessible,
    bare_folder,
    corner_on_screen,
    opened,
    settled,
    true_pattern,
    write_seat,
)

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    return write_seat("horseshoe", tmp_path_factory.mktemp("whole"))


@pytest.fixture
def bare(whole, tmp_path):
    """A folder with the panels, their edges, and no seam."""
    return bare_folder(whole, tmp_path / "bare")


def picked(page, hands, pattern, seam):
    """Sew a seam by four picks of the mouse: both ends of one side, start and end of the other."""
    near, far = pattern.edge_points(seam.a), pattern.edge_points(seam.b[0])
    far = far[::-1] if seam.reverse else far
    panels = [pattern.edges[name].panel for name in (seam.a, seam.a, seam.b[0], seam.b[0])]
    places = [near[0], near[-1], far[0], far[-1]]
    for panel, place in zip(panels, places, strict=True):
        hands.pick(corner_on_screen(page, panel, 1e3 * place))
    settled(page)


def sewn(state):
    """Both sides of every seam, whatever they are called."""
    return {frozenset((*s["first"]["edges"], *s["second"]["edges"])) for s in state["seams"]}


def test_four_picks_sew_a_seam_and_say_its_lengths(browser, bare, whole):
    pattern = true_pattern(whole)
    with studio(bare) as (door, client), opened(browser, door.address) as page:
        hands = Hands(page)
        settled(page)
        for seam in pattern.seams[:3]:
            picked(page, hands, pattern, seam)
            assert f"{1e3 * pattern.edge_length(seam.a):.1f} mm to" in page.inner_text("#status")
        assert hands.clicks == 12
        assert sewn(client.state) == {frozenset((s.a, *s.b)) for s in pattern.seams[:3]}
        assert page.locator("#seam-list li").count() == 3
        page.locator("#undo").click()
        settled(page)
        assert page.locator("#seam-list li").count() == 2
        page.locator("#redo").click()
        settled(page)
        assert page.locator("#seam-list li").count() == 3


def test_a_seam_is_sewn_by_keyboard_alone(browser, bare):
    with studio(bare) as (door, client), opened(browser, door.address) as page:
        settled(page)
        hands = Hands(page)
        page.locator("#sheet").focus()
        # The cursor stands at the first corner of the first panel; after two picks it goes to the
        # likeliest partner.
        hands.key("Enter", "ArrowRight", "Enter", "Enter", "ArrowLeft", "Enter")
        settled(page)
        (seam,) = client.state["seams"]
        assert abs(seam["ease_percent"]) < 1
        assert "Sewn" in page.inner_text("#status")
        hands.key("Control+z")
        settled(page)
        assert client.state["seams"] == []


def test_guesses_are_accepted_above_a_bound_and_refused_one_by_one(browser, bare, whole):
    pattern = true_pattern(whole)
    with studio(bare) as (door, client), opened(browser, door.address) as page:
        settled(page)
        count = page.locator("#guess-list .guess-row").count()
        page.locator("#guess-list .guess-row button", has_text="Refuse").first.click()
        settled(page)
        assert page.locator("#guess-list .guess-row").count() == count - 1
        page.locator("#accept-all").click()
        settled(page)
        state = client.state
        assert len(state["seams"]) == count - 1
        assert sewn(state) <= {frozenset((s.a, *s.b)) for s in pattern.seams}


def test_a_seam_is_turned_renamed_eased_and_removed(browser, whole, tmp_path):
    home = write_seat("cushion", tmp_path / "cushion")
    with studio(home) as (door, client), opened(browser, door.address) as page:
        settled(page)
        first = client.state["seams"][0]
        page.locator("#seam-list .row").first.click()
        page.get_by_role("button", name="Turn").click()
        settled(page)
        assert client.state["seams"][0]["reverse"] != first["reverse"]
        page.get_by_role("button", name="Turn").click()
        settled(page)
        page.locator("#seam-list input[type=text]").fill("front seam")
        page.keyboard.press("Enter")
        settled(page)
        assert client.state["seams"][0]["name"] == "front seam"
        page.locator("#seam-list .row").first.click()
        page.get_by_role("button", name="Remove").click()
        settled(page)
        assert "front seam" not in {seam["name"] for seam in client.state["seams"]}


def test_what_cannot_be_sewn_is_said_before_it_is(browser, bare, whole):
    pattern = true_pattern(whole)
    long, short = pattern.edges["SIDE_L.BOLSTER_L"], pattern.edges["INSERT_FRONT.FRONT"]
    with studio(bare) as (door, client), opened(browser, door.address) as page:
        settled(page)
        hands = Hands(page)
        for edge in (long, short):
            points = 1e3 * pattern.edge_points(edge.name)
            for place in (points[0], points[-1]):
                hands.pick(corner_on_screen(page, edge.panel, place))
        settled(page)
        assert "mm to" in page.inner_text("#sew-doubt")
        assert client.state["seams"] == []


@pytest.mark.parametrize("width", [360, 1280, 1920])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_no_accessibility_violation_and_nothing_overflows(browser, whole, width, scheme):
    window = {
        "viewport": {"width": width, "height": 900},
        "color_scheme": scheme,
        # The checker is injected as a script, which the page's own policy rightly refuses.
        "bypass_csp": True,
    }
    with studio(whole) as (door, _), opened(browser, door.address, **window) as page:
        settled(page)
        page.locator("#seam-list .row").first.click()
        for room in ("pattern", "start", "assembly", "process", "looks", "run"):
            page.locator(f"#tab-{room}").click()
            settled(page)
            assert page.evaluate("document.documentElement.scrollWidth") == width, room
            accessible(page)
