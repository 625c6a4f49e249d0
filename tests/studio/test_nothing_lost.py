"""What was acknowledged is in the files: after a kill, on a full disk, with two tabs, an editor."""

from __future__ import annotations

import os
import random
import threading
import tomllib
from http.client import HTTPException

import pytest
from filelock import FileLock

from seatlook.errors import InputError
from seatlook.io.scene.read import load_scene
from seatlook.studio.folder import Folder
from seatlook.studio.keeping.durable import prepared
from seatlook.studio.keeping.journal import Change, Journal
from seatlook.studio.server import serve
from seatlook.studio.session import Session
from support.scene_files import write_two_panels
from support.studio import studio, studio_process


@pytest.fixture
def home(tmp_path):
    write_two_panels(tmp_path)
    return tmp_path


def files_of(home):
    return {p.name: p.read_bytes() for p in home.iterdir() if p.is_file()}


def seed(value):
    return {"kind": "mesh.set", "key": "seed", "value": value}


def seed_in(home):
    return tomllib.loads((home / "scene.toml").read_text())["mesh"].get("seed")


def test_edits_are_taken_back_and_made_again_to_the_same_bytes(home):
    states = [files_of(home)]
    with studio(home) as (_, page):
        for edit in (
            seed(3),
            {"kind": "seam.rename", "name": "middle", "to": "centre"},
            {"kind": "rig.set", "name": "bulb", "key": ["light", 0, "lumen"], "value": 500.0},
            {"kind": "stage.set", "index": 1, "key": "end_s", "value": 0.7},
            {"kind": "guess.refuse", "id": "g1"},
        ):
            assert page.edit(edit).status == 200, edit
            states.append(files_of(home))
        for wanted in states[-2::-1]:
            answer = page.post("/api/undo", {"base": page.state["etag"]})
            assert answer.status == 200
            assert files_of(home) == wanted
        assert answer.value["undo"] is False
        assert page.post("/api/undo", {"base": page.state["etag"]}).status == 422
    # The journal outlives the server.
    with studio(home) as (_, page):
        for wanted in states[1:]:
            assert page.post("/api/redo", {"base": page.state["etag"]}).status == 200
            assert files_of(home) == wanted


def test_two_tabs_change_different_things_and_are_asked_about_the_same(home):
    with studio(home) as (_, page):
        base = page.state["etag"]
        assert page.edit(seed(1), base=base).status == 200
        moved = {"kind": "stage.set", "name": "cover", "key": "end_s", "value": 0.65}
        answer = page.edit(moved, base=base)
        assert answer.status == 200, answer.content
        assert answer.value["mesh"]["seed"] == 1
        assert answer.value["stages"][1]["end_s"] == 0.65
        answer = page.edit(seed(2), base=base)
        assert answer.status == 409
        assert "seed" in answer.value["reason"]
        assert answer.value["mine"] == [seed(2)]
        assert answer.value["theirs"]["mesh"]["seed"] == 1
        assert page.edit(seed(2), base="older than all").status == 409
    assert seed_in(home) == 1


def test_tabs_at_once_lose_no_acknowledged_change(home):
    done = []
    with studio(home) as (_, page):

        def tab(number):
            for k in range(5):
                values = {"name": f"rig {number} {k}", "ambient_cd_m2": 1.0}
                if page.edit({"kind": "rig.add", "values": values}).status == 200:
                    done.append(values["name"])

        tabs = [threading.Thread(target=tab, args=(n,)) for n in range(4)]
        for one in tabs:
            one.start()
        for one in tabs:
            one.join()
        names = {rig["name"] for rig in page.state["rigs"]}
    assert len(done) > 4
    assert names == {"sun", "bulb", *done}


def test_what_an_editor_writes_stays(home):
    scene = home / "scene.toml"
    with studio(home) as (_, page):
        base = page.state["etag"]
        scene.write_text(
            scene.read_text().replace("seed", "seed").replace("0.4", "0.45") + "# mine\n"
        )
        assert page.state["etag"] != base
        answer = page.edit(seed(4), base=base)
        assert answer.status == 200
        assert answer.value["stages"][0]["end_s"] == 0.45
        assert scene.read_text().endswith("# mine\n")
        stage = {"kind": "stage.set", "index": 0, "key": "end_s", "value": 0.5}
        assert page.edit(stage, base=base).status == 409
        # What is taken back is the edit alone.
        assert page.post("/api/undo", {"base": page.state["etag"]}).status == 200
        text = scene.read_text()
        assert "0.45" in text
        assert text.endswith("# mine\n")
        assert "seed" not in text
        assert page.post("/api/redo", {"base": page.state["etag"]}).status == 200
        scene.write_text(scene.read_text().replace("seed = 4", "seed = 40"))
        assert page.post("/api/undo", {"base": page.state["etag"]}).status == 409
    assert seed_in(home) == 40


def test_a_folder_that_cannot_be_read_is_shown_with_what_is_wrong(home):
    scene = home / "scene.toml"
    with studio(home) as (_, page):
        whole = scene.read_text()
        scene.write_text(whole.replace("[mesh]", "[mesh"))
        state = page.state
        assert state["errors"][0]["file"] == "scene.toml"
        assert state["errors"][0]["line"]
        assert page.edit(seed(1)).status == 422
        assert scene.read_text() == whole.replace("[mesh]", "[mesh")
        scene.write_text(whole.replace('wire = "wire"', 'wire = "no"'))
        state = page.state
        assert len(state["pattern"]["panels"]) == 2
        assert "wire" in state["errors"][0]["key"]


def test_values_that_json_has_nothing_for_are_sent_as_text(home):
    scene = home / "scene.toml"
    scene.write_text(scene.read_text().replace("ev100 = 5.0", "ev100 = nan\nday = 2026-12-01"))
    with studio(home) as (_, page):
        state = page.state
    assert state["rigs"][1]["ev100"] == "nan"
    assert state["rigs"][1]["day"] == "2026-12-01"
    assert len(state["errors"]) == 2


def test_a_folder_is_open_in_one_studio_only(home):
    (home / ".seatlook").mkdir()
    with FileLock(home / ".seatlook" / "lock"), pytest.raises(InputError, match="another studio"):
        serve(home, started=lambda _: pytest.fail("it began"))


def test_a_change_that_did_not_reach_its_files_is_finished(home):
    before = files_of(home)["scene.toml"]
    after = before.replace(b'name = "two panels"', b'name = "finished"')
    journal = Journal(home / ".seatlook" / "journal.jsonl")
    journal.append(
        Change(
            kind="edit", what="a name", before={"scene.toml": before}, after={"scene.toml": after}
        )
    )
    Session(Folder(home))
    assert files_of(home)["scene.toml"] == after
    # Once it has, what an editor puts back stays.
    (home / "scene.toml").write_bytes(before)
    Session(Folder(home))
    assert files_of(home)["scene.toml"] == before


def test_a_change_that_an_editor_went_on_from_is_left_alone(home):
    before = files_of(home)["scene.toml"]
    journal = Journal(home / ".seatlook" / "journal.jsonl")
    journal.append(
        Change(kind="edit", what="", before={"scene.toml": before}, after={"scene.toml": b"x = 1"})
    )
    (home / "scene.toml").write_bytes(before + b"# mine\n")
    Session(Folder(home))
    assert files_of(home)["scene.toml"] == before + b"# mine\n"


@pytest.mark.parametrize("cut", [1, 20, 60])
def test_a_line_of_the_journal_that_was_cut_short_is_dropped(home, cut):
    path = home / ".seatlook" / "journal.jsonl"
    with studio(home) as (_, page):
        assert page.edit(seed(1)).status == 200
        assert page.edit(seed(2)).status == 200
    content = path.read_bytes().rstrip(b"{}\n") + b"}\n"
    path.write_bytes(content[:-cut])
    with studio(home) as (_, page):
        assert page.edit(seed(3)).status == 200
        assert page.post("/api/undo", {"base": page.state["etag"]}).status == 200
    assert seed_in(home) == 2
    assert all(line for line in path.read_bytes().splitlines())


def asked(page, value, base):
    try:
        return page.edit(seed(value), base=base)
    except (OSError, HTTPException):
        return None  # it was killed


def killed(home, rounds, rng):
    """Kill a server at random moments of edits, and look at what it acknowledged."""
    value = 0
    for _ in range(rounds):
        with studio_process(home) as (process, page):
            state = page.state
            assert state["errors"] == []
            # What was on its way when the last one was killed may have come through.
            assert (seed_in(home) or 0) in (value, value + 1)
            value = seed_in(home) or 0
            timer = threading.Timer(rng.uniform(0.5, 2.0), process.kill)
            timer.start()
            while (answer := asked(page, value + 1, state["etag"])) is not None:
                assert answer.status == 200
                state, value = answer.value, value + 1
            assert process.wait(20) == -9
            timer.join()
        load_scene(home / "scene.toml")
        session = Session(Folder(home))
        assert (seed_in(home) or 0) in (value, value + 1)
        assert not [*(home / ".seatlook" / "tmp").glob("*")]
        assert session.state()["errors"] == []
    return value


def test_a_killed_server_loses_nothing_that_it_acknowledged(home):
    assert killed(home, 2, random.Random(7)) > 1


@pytest.mark.validate
def test_a_server_killed_twenty_times_loses_nothing(home):
    assert killed(home, 20, random.Random(1)) > 20


def test_a_full_disk_refuses_and_leaves_all_as_it_was(home):
    with studio(home) as (_, page):
        assert page.edit(seed(1)).status == 200
    journal = home / ".seatlook" / "journal.jsonl"
    room = journal.stat().st_size + 40
    assert room > (home / "scene.toml").stat().st_size
    with studio_process(home, largest_file=room) as (_, page):
        before, written = files_of(home), journal.read_bytes()
        answer = page.edit(seed(2))
        assert answer.status == 507
        assert answer.value["errors"][0]["text"]
        assert files_of(home) == before
        assert journal.read_bytes() == written
        assert page.state["mesh"]["seed"] == 1
    with studio(home) as (_, page):
        assert page.edit(seed(2)).status == 200


def test_temporary_files_are_gone_when_one_cannot_be_written(tmp_path, monkeypatch):
    calls = []

    def full(handle):
        calls.append(handle)
        if len(calls) == 2:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    contents = {tmp_path / "a.toml": b"1", tmp_path / "b.toml": b"2"}
    with pytest.raises(OSError, match="No space"), prepared(contents, tmp_path / "tmp"):
        raise AssertionError
    assert not [*(tmp_path / "tmp").iterdir()]
    assert not (tmp_path / "a.toml").exists()
