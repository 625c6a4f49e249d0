"""A seat begun from uploaded files, sewn by accepted guesses, run in a process of its own."""

from __future__ import annotations

import io as streams
import json
import shutil
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from seatlook import io
from seatlook.cli import run as command
from seatlook.io.scene.read import load_scene
from seatlook.seats.files import write_demo
from support.scene_files import write_two_panels
from support.studio import Client, studio


@pytest.fixture(scope="module")
def seat(tmp_path_factory) -> Path:
    """Files of a seat, as a user has them."""
    folder = tmp_path_factory.mktemp("cushion")
    write_demo(folder, surface_size=0.012, element_size_mm=14.0)
    return folder


@pytest.fixture
def home(tmp_path):
    write_two_panels(tmp_path)
    return tmp_path


def sent(page, folder, names):
    files = {}
    for what, name in names.items():
        answer = page.ask("POST", f"/api/upload?name={name}", (folder / name).read_bytes())
        assert answer.status == 200, answer.content
        assert answer.value["bytes"] == (folder / name).stat().st_size
        files[what] = answer.value["path"]
    return files


def test_a_pattern_is_begun_looked_at_sewn_and_laid_out(seat, tmp_path):
    home = tmp_path / "seat"
    with studio(home) as (_, page):
        assert page.state["has_scene"] is False
        files = sent(page, seat, {"pattern": "pattern.dxf", "foam": "foam.obj"})
        asked = {"kind": "pattern", "files": files}
        seen = page.post("/api/start", {**asked, "dry": True}).value
        names = {panel.name for panel in io.read_panels(seat / "pattern.dxf")}
        assert {piece["name"] for piece in seen["pieces"]} == names
        assert seen["foam_axes"] == {"unit": "mm", "up": "z"}
        assert page.state["has_scene"] is False
        state = page.post("/api/start", {**asked, "guesses": "ask"}).value
        assert state["errors"] == []
        assert state["seams"] == []
        assert state["guesses"]
        chances = [guess["probability"] for guess in state["guesses"]]
        assert chances == sorted(chances, reverse=True)
        wrong, *right = state["guesses"]
        state = page.edit({"kind": "guess.refuse", "id": wrong["id"]}).value
        assert wrong["id"] not in {guess["id"] for guess in state["guesses"]}
        state = page.post("/api/undo", {"base": state["etag"]}).value
        assert wrong["id"] in {guess["id"] for guess in state["guesses"]}
        edits = [{"kind": "guess.accept", "id": guess["id"]} for guess in state["guesses"]]
        answer = page.edit(*edits, {"kind": "scene.arrange"})
        assert answer.status == 200, answer.content
        assert len(answer.value["seams"]) == len(right) + 1
        assert answer.value["guesses"] == []
        assert answer.value["frames"]
        assert page.post("/api/start", asked).status == 422
        assembly = page.get("/api/assembly").value
        assert assembly["faults"] == []
    # The folder is a scene as the command line's own, and its check passes.
    scene = load_scene(home / "scene.toml")
    assert len(scene.pattern.seams) == len(right) + 1
    assert "# probability" in (home / "seams.toml").read_text()


@pytest.mark.parametrize(
    "asked",
    [
        {"kind": "what"},
        {"kind": "pattern", "files": {}},
        {"kind": "pattern", "files": {"pattern": "../../etc/passwd", "foam": "foam.obj"}},
        {"kind": "pattern", "files": {"pattern": "no.dxf", "foam": "no.obj"}},
        {"kind": "pattern", "files": ["a"]},
        {"kind": "demo", "choices": {"shape": "sofa"}},
        {"kind": "demo", "choices": {"out": "/tmp"}},
        {"kind": "surface", "files": {"surface": "a.obj"}},
    ],
)
def test_a_start_that_cannot_be_leaves_nothing(tmp_path, asked):
    home = tmp_path / "seat"
    with studio(home) as (_, page):
        answer = page.post("/api/start", asked)
        assert answer.status == 422
        assert answer.value["errors"][0]["text"]
    assert [p for p in home.rglob("*") if p.is_file() and p.name != "journal.jsonl"] == []


@pytest.mark.parametrize(
    "name", ["../a.dxf", "a/b", "..", "", ".hidden", "a\\b", "a\0b", "x" * 200]
)
def test_uploads_have_plain_names(home, name):
    from urllib.parse import quote

    with studio(home) as (_, page):
        assert page.ask("POST", f"/api/upload?name={quote(name)}", b"x").status == 422
    assert not [*(home / ".seatlook").rglob("*a*")]


class Zeros(streams.RawIOBase):
    """A file of zeros that is nowhere."""

    def __init__(self, size):
        self.left = size

    def read(self, size=-1):
        count = min(self.left, size if size > 0 else self.left, 2**16)
        self.left -= count
        return bytes(count)


def test_a_large_upload_is_written_and_never_held(home):
    with studio(home) as (_, page):
        size = 100 * 2**20
        page.state  # noqa: B018 -- what is read once is read before
        before = resident()
        answer = page.ask(
            "POST", "/api/upload?name=large.obj", Zeros(size), {"Content-Length": str(size)}
        )
        assert answer.status == 200
        assert answer.value == {"path": ".seatlook/uploads/large.obj", "bytes": size}
        assert resident() - before < 30 * 2**20
    assert (home / ".seatlook" / "uploads" / "large.obj").stat().st_size == size


def resident():
    """Memory [bytes] of this process, which holds the server."""
    text = Path("/proc/self/statm").read_text()
    return int(text.split()[1]) * 4096


def test_a_thousand_requests_are_answered_right_and_leave_memory_flat(home):
    with studio(home) as (_, page):
        wanted, wrong = page.get("/api/state").content, []

        def ask(count):
            for _ in range(count):
                answer = page.get("/api/state")
                if answer.status != 200 or answer.content != wanted:
                    wrong.append(answer)

        ask(20)
        before = resident()
        askers = [threading.Thread(target=ask, args=(20,)) for _ in range(50)]
        for one in askers:
            one.start()
        for one in askers:
            one.join()
        assert wrong == []
        assert resident() - before < 40 * 2**20


def test_results_are_served_apart_and_nothing_else(home, tmp_path_factory):
    outside = tmp_path_factory.mktemp("outside") / "secret.txt"
    outside.write_text("hidden words")
    (home / "runs").mkdir()
    (home / "runs" / "page.html").write_text("<p>a page")
    (home / "runs" / "link.txt").symlink_to(outside)
    (home / "runs" / "up").symlink_to(outside.parent)
    with studio(home) as (door, page):
        assert page.edit({"kind": "mesh.set", "key": "seed", "value": 1}).status == 200
        anyone = Client(door.port)
        base = door.results_path
        answer = anyone.get(f"{base}/runs/page.html")
        assert answer.content == b"<p>a page"
        assert answer.headers["content-security-policy"].startswith("sandbox ")
        assert "same-origin" not in answer.headers["content-security-policy"]
        for path in (
            "runs/link.txt",
            "runs/up/secret.txt",
            "../outside/secret.txt",
            "..%2f..%2fetc/passwd",
            "%2e%2e/%2e%2e/etc/passwd",
            "/etc/passwd",
            ".seatlook/journal.jsonl",
            "runs",
            "no%00thing",
            "no.png",
        ):
            answer = anyone.get(f"{base}/{path}")
            assert answer.status in (404, 422), path
            assert b"hidden" not in answer.content
        assert anyone.get("/results/guessed/runs/page.html").status == 401
        evil = {"Origin": "null"}
        assert Client(door.port, {**page.headers, **evil}).get("/api/state").status == 403


def test_links_that_lead_out_are_not_written_to(home, tmp_path_factory):
    outside = tmp_path_factory.mktemp("outside") / "seams.toml"
    shutil.move(home / "seams.toml", outside)
    (home / "seams.toml").symlink_to(outside)
    before = outside.read_bytes()
    with studio(home) as (_, page):
        state = page.state
        assert state["seams"][0]["name"] == "middle"
        answer = page.edit({"kind": "seam.rename", "name": "middle", "to": "x"})
        assert answer.status == 422
        assert "inside the folder" in answer.value["errors"][0]["text"]
    assert outside.read_bytes() == before


def test_contradictions_stand_in_their_places(home):
    with studio(home) as (_, page):
        good = page.get("/api/assembly").value
        assert good["faults"] == []
        assert [tie["kind"] for tie in good["ties"]] == ["seam", "hook", "frame"]
        assert len(good["panels"]) == 2
        for panel in good["panels"]:
            assert max(panel["triangles"]) < len(panel["positions_mm"]) // 3
        again = page.get("/api/assembly").value
        assert {**again, "seconds": 0} == {**good, "seconds": 0}
        answer = page.edit({"kind": "seam.turn", "name": "middle"})
        assert answer.status == 200
        twisted = page.get("/api/assembly").value
        fault = next(one for one in twisted["faults"] if one["kind"] == "twisted seam")
        assert fault["file"] == "seams.toml"
        assert fault["line"]
        assert np.shape(fault["places_mm"])[1] == 3
        # What has nothing to do with it is not computed again.
        page.edit({"kind": "rig.set", "name": "bulb", "key": "ev100", "value": 6.0})
        assert page.get("/api/assembly").value["seconds"] < 0.1


def heard(door, page, events, ready):
    """Listen to what happens until a run ends."""
    import http.client

    connection = http.client.HTTPConnection("127.0.0.1", door.port, timeout=120)
    connection.request("GET", "/api/events", headers=page.headers)
    answer = connection.getresponse()
    assert answer.headers["content-type"].startswith("text/event-stream")
    ready.set()
    for line in answer:
        if line.startswith(b"data: "):
            events.append(json.loads(line[6:]))
            if events[-1].get("status", "running") != "running":
                break
    connection.close()


def ended(page):
    while (run := page.get("/api/runs").value["runs"][0])["status"] == "running":
        time.sleep(0.1)
    return run


@pytest.mark.render
def test_a_run_says_how_far_it_is_and_leaves_what_the_command_leaves(home, tmp_path):
    events, ready = [], threading.Event()
    with studio(home) as (door, page):
        listener = threading.Thread(target=heard, args=(door, page, events, ready))
        listener.start()
        assert ready.wait(20)
        answer = page.post("/api/run", {"score": False})
        assert answer.status == 200, answer.content
        assert page.post("/api/run", {}).status == 422
        run = ended(page)
        listener.join(60)
        assert run["status"] == "done", run
        assert run["found"]
        shares = [event["fraction"] for event in events if event.get("fraction") is not None]
        assert len(shares) > 3
        assert all(0.0 <= share <= 1.0 for share in shares)
        assert any(event.get("seconds_left") is not None for event in events)
        where = run["page_url"].replace(" ", "%20")
        assert b"<html" in Client(door.port).get(where).content
        assert run["snapshots"]
    out = tmp_path / "by the command"
    command(["evaluate", str(home / "scene.toml"), "--out", str(out), "--no-score", "--preview"])
    own = home / "runs" / run["name"]
    names = sorted(path.relative_to(out) for path in out.rglob("*.png"))
    assert names
    for name in [*names, Path("zones.csv")]:
        assert (own / name).read_bytes() == (out / name).read_bytes(), name


@pytest.mark.render
def test_a_run_is_cancelled_and_gone_on_with(home):
    scene = home / "scene.toml"
    scene.write_text(scene.read_text().replace("element_size_mm = 20.0", "element_size_mm = 8.0"))
    with studio(home) as (_, page):
        name = page.post("/api/run", {"score": False}).value["run"]
        while not page.get("/api/runs").value["runs"][0]["snapshots"]:
            assert page.get("/api/runs").value["runs"][0]["status"] == "running"
            time.sleep(0.05)
        assert page.post("/api/run/cancel", {}).status == 200
        assert ended(page)["status"] == "cancelled"
        assert page.post("/api/run", {"resume": "another"}).status == 422
        assert page.post("/api/run", {"resume": name, "score": False}).value["run"] == name
    # The server ended, and the run with it.
    with studio(home) as (_, page):
        run = page.get("/api/runs").value["runs"][0]
        assert run["status"] in ("interrupted", "cancelled")
        assert page.post("/api/run", {"resume": name, "score": False}).status == 200
        assert ended(page)["status"] == "done"


@pytest.mark.render
def test_variants_are_compared_by_the_command(home):
    text = (home / "scene.toml").read_text()
    (home / "other.toml").write_text(text.replace('material = "pvc"', 'material = "suede"'))
    with studio(home) as (door, page):
        for wrong in ({"command": "rm"}, {"others": ["../x.toml"]}, {"others": [3]}):
            assert page.post("/api/run", {"command": "compare", **wrong}).status == 422
        answer = page.post("/api/run", {"command": "compare", "others": ["other.toml"]})
        assert answer.status == 200, answer.content
        run = ended(page)
        assert run["status"] == "done", run
        assert run["command"] == "compare"
        page_of = Client(door.port).get(run["page_url"].replace(" ", "%20"))
        assert b"suede" in page_of.content
        assert page.post("/api/run", {"resume": run["name"]}).status == 422
