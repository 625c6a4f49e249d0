"""Seams are sewn, turned, renamed and taken out by edits, and the files read the same."""

from __future__ import annotations

import pytest

from seatlook.io.scene.read import load_scene
from support.scene_files import write_two_panels
from support.studio import studio


@pytest.fixture
def home(tmp_path):
    write_two_panels(tmp_path)
    return tmp_path


def test_the_state_says_what_the_files_hold(home):
    scene = load_scene(home / "scene.toml")
    with studio(home) as (_, page):
        state = page.state
    assert [panel["name"] for panel in state["pattern"]["panels"]] == ["LEFT", "RIGHT"]
    (seam,) = state["seams"]
    assert seam["name"] == "middle"
    assert seam["number"] == 1
    assert seam["lengths_mm"][0] == pytest.approx(
        1e3 * scene.pattern.edge_length(seam["first"]["edges"][0])
    )
    assert state["errors"] == []
    assert state["hooks"][0]["line"] == "middle"
    assert {wire["name"] for wire in state["wires"]} == {"wire", "rail"}


def test_a_seam_is_taken_out_and_picked_again(home):
    seams = home / "seams.toml"
    seams.write_text("# by hand\n" + seams.read_text().replace("pitch_mm", "pitch_mm ", 1))
    with studio(home) as (_, page):
        (seam,) = page.state["seams"]
        answer = page.edit({"kind": "seam.remove", "name": "middle"})
        assert answer.status == 200, answer.content
        assert answer.value["seams"] == []
        assert answer.value["hooks"] == []
        # Picked against its direction: the same edge is meant.
        first = {
            "panel": "LEFT",
            "from_mm": seam["first"]["to_mm"],
            "to_mm": seam["first"]["from_mm"],
        }
        second = {"panel": "RIGHT", **{k: seam["second"][k] for k in ("from_mm", "to_mm")}}
        answer = page.edit({"kind": "seam.add", "first": first, "second": second, "name": "again"})
        assert answer.status == 200, answer.content
        (again,) = answer.value["seams"]
    assert again["first"] == seam["first"]
    assert again["second"] == seam["second"]
    assert seams.read_text().startswith("# by hand\n")
    assert load_scene(home / "scene.toml").pattern.seams[0].name == "again"


def test_what_cannot_be_is_refused_and_nothing_is_written(home):
    before = {path: path.read_bytes() for path in home.iterdir() if path.is_file()}
    with studio(home) as (_, page):
        (seam,) = page.state["seams"]
        sides = {side: {"edges": seam[side]["edges"]} for side in ("first", "second")}
        for edit in (
            {"kind": "seam.add", **sides},
            {"kind": "seam.add", "first": sides["first"], "second": sides["first"]},
            {"kind": "seam.add", "first": {"panel": "NO"}, "second": sides["second"]},
            {
                "kind": "seam.add",
                "first": {"panel": "LEFT", "from_mm": [1, 2], "to_mm": None},
                "second": {},
            },
            {"kind": "seam.add"},
            {"kind": "seam.rename", "name": "middle", "to": " "},
            {"kind": "seam.set", "name": "middle", "key": "pitch_mm", "value": "wide"},
            {"kind": "seam.sew"},
            {"kind": ["seam.add"]},
        ):
            answer = page.edit(edit)
            assert answer.status == 422, edit
            assert answer.value["errors"][0]["text"]
        assert page.edit({"kind": "seam.turn", "name": "gone"}).status == 409
    after = {path: path.read_bytes() for path in home.iterdir() if path.is_file()}
    assert after == before


def test_a_name_is_changed_wherever_it_stands(home):
    with studio(home) as (_, page):
        state = page.edit({"kind": "seam.rename", "name": "middle", "to": "centre"}).value
    assert state["seams"][0]["name"] == "centre"
    assert state["hooks"][0]["line"] == "centre"


def test_a_seat_is_kept_under_a_name_to_compare_with(home):
    text = (home / "scene.toml").read_text()
    with studio(home) as (_, client):
        assert client.state["variants"] == []
        assert client.edit({"kind": "scene.copy", "name": "before"}).status == 200
        assert client.state["variants"] == ["before.toml"]
        assert client.state["scene"] == "scene.toml"
        assert (home / "before.toml").read_text() == text
        for name in ("before", "../out", "scene", ".hidden", "a/b"):
            assert client.edit({"kind": "scene.copy", "name": name}).status == 422
        undone = client.post("/api/undo", {"base": client.state["etag"]})
        assert undone.status == 200, undone.content
        assert undone.value["variants"] == []
        assert not (home / "before.toml").exists()
