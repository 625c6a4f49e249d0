"""A library beside a folder: seen, looked at and taken from, with nothing written over."""

from __future__ import annotations

import pytest

from seatlook.io.material import material_path
from seatlook.io.scene.read import load_scene
from seatlook.library.adding import add
from support.scene_files import write_two_panels
from support.studio import studio

NAME = 'Suède "fin" 🪑'


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    root = tmp_path_factory.mktemp("library") / "parts"
    seat = tmp_path_factory.mktemp("seat")
    scene = write_two_panels(seat)
    own = seat / "own.toml"
    own.write_text(material_path("suede").read_text())
    limits = seat / "limits.toml"
    limits.write_text("[accept.A]\nw2_mean = 0.02\n")
    rig = seat / "rig.toml"
    rig.write_text(
        '[[rig]]\nname = "late"\n[[rig.light]]\nkind = "sun"\n'
        "elevation_deg = 12\nazimuth_deg = 40\n"
    )
    rest = {"material": add(root, [own], name=NAME), "limits": add(root, [limits])}
    return root, {"seat": add(root, [scene]), "rig": add(root, [rig]), **rest}


def test_a_seat_and_a_material_are_taken_and_taken_back(parts, tmp_path):
    root, entries = parts
    with studio(tmp_path / "seat", root) as (_, page):
        shown = page.get("/api/library").value
        assert {one["place"] for one in shown["entries"]} == {e.place for e in entries.values()}
        assert NAME in {one["label"] for one in shown["entries"]}
        picture = page.get(next(o["thumbnail"] for o in shown["entries"] if o["name"] == NAME))
        assert picture.content.startswith(b"<svg")
        assert "sandbox" in picture.headers["content-security-policy"]
        took = page.post("/api/library/use", {"place": entries["seat"].place})
        assert took.status == 200, took.content
        assert took.value["errors"] == []
        assert page.post("/api/library/use", {"place": entries["seat"].place}).status == 422
        took = page.post("/api/library/use", {"place": entries["material"].place})
        materials = page.get("/api/materials").value["materials"]
        assert "materials/own.toml" in {one["name"] for one in materials}
        (tmp_path / "seat" / "materials" / "own.toml").write_text("# mine\n")
        refused = page.post("/api/library/use", {"place": entries["material"].place})
        assert refused.status == 422
        assert (tmp_path / "seat" / "materials" / "own.toml").read_text() == "# mine\n"


def test_a_rig_and_limits_become_lines_of_the_scene(parts, tmp_path):
    root, entries = parts
    scene = write_two_panels(tmp_path)
    before = scene.read_bytes()
    with studio(tmp_path, root) as (_, page):
        for kind in ("rig", "limits"):
            took = page.post("/api/library/use", {"place": entries[kind].place})
            assert took.status == 200, took.content
        read = load_scene(scene)
        assert "late" in {rig.name for rig in read.rigs}
        assert ("A", "w2_mean", 0.02) in {(o.zone, o.measure, o.maximum) for o in read.limits}
        for _ in range(2):
            page.post("/api/undo", {"base": page.state["etag"]})
        assert scene.read_bytes() == before


@pytest.mark.parametrize("place", ["", "../..", "/etc", "materials/none", 3, None])
def test_places_that_are_no_entries_are_refused(place, parts, tmp_path):
    with studio(tmp_path, parts[0]) as (_, page):
        assert page.post("/api/library/use", {"place": place}).status == 422
        assert page.get(f"/api/library/thumbnail?place={place}").status == 422


def test_without_a_library_there_is_none(tmp_path):
    with studio(tmp_path) as (_, page):
        assert page.get("/api/library").value == {"library": None, "entries": [], "errors": []}
        assert page.post("/api/library/use", {"place": "a"}).status == 422
