"""A library is its files: entries are added whole, found again, and never believed unread."""

from __future__ import annotations

import hashlib
import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from seatlook import io
from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.io.material import material_path
from seatlook.library.adding import add
from seatlook.library.entry import SHEET, read_entry
from seatlook.library.index import INDEX
from seatlook.library.library import is_supplied, open_library
from seatlook.library.taking import take
from seatlook.seats.files import write_demo
from support.io_samples import solution

NAMES = ('Front "left" seat', "sièges 🪑 d'été", "a\\b", "座椅", "x" * 200, "= [name]")


@pytest.fixture(scope="module")
def seat(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("seat")
    write_demo(folder, surface_size=0.03, element_size_mm=25.0)
    return folder


def material(folder: Path, name: str, thickness: str = "1.2") -> Path:
    text = material_path("black-leather").read_text(encoding="utf-8")
    path = folder / f"{name}.toml"
    path.write_text(text.replace("thickness_mm = 1.2", f"thickness_mm = {thickness}", 1))
    return path


def refused(text: str, do, *words, **more) -> None:
    with pytest.raises(InputError) as caught:
        do(*words, **more)
    assert text in str(caught.value)


@pytest.mark.parametrize("name", NAMES)
def test_any_name_is_kept_found_and_filed_under_a_plain_one(name, tmp_path):
    root = tmp_path / "parts"
    path = material(tmp_path, "own")
    entry = add(root, [path], name=name, words=["Würze", 'a "b"'], note="line\nand more")
    library = open_library(root)
    assert library.get(name) == entry == library.find([name.upper()])[0]
    assert entry.place.isascii()
    assert len(entry.place) < 120
    assert (entry.words, entry.note) == (("Würze", 'a "b"'), "line\nand more")
    assert library.find(["WÜRZE"]) == (entry,)
    assert library.find(["wurst"]) == ()


def test_each_kind_is_seen_from_its_file_and_brings_what_it_names(seat, tmp_path):
    root = tmp_path / "parts"
    found = {
        kind: add(root, [seat / name, *(seat / one for one in more)], kind=said)
        for kind, said, name, *more in (
            ("seat", None, "scene.toml"),
            ("pattern", None, "pattern.dxf", "seams.toml"),
            ("foam", None, "foam.obj", "curves.toml"),
            ("rig", "rig", "scene.toml"),
        )
    }
    found["material"] = add(root, [material_path("suede")])
    assert {kind: one.kind for kind, one in found.items()} == {kind: kind for kind in found}
    assert {"scene.toml", "pattern.dxf", "seams.toml", "foam.obj"} <= {*found["seat"].files}
    # What comes with seatlook is named by its content, not copied.
    assert {part.name for part in found["seat"].parts} >= {"foam-seat"}
    for part in found["seat"].parts:
        assert is_supplied(part)
        assert not is_supplied(replace(part, digest="0" * 64))
        assert not is_supplied(replace(part, name=f"../materials/{part.name}x"))
    assert found["rig"].files == ("scene.toml",)
    assert len(open_library(root).entries) == 5
    out = tmp_path / "again"
    library = open_library(root)
    take(library, library.get(found["seat"].place), out)
    assert io.load_scene(out / "scene.toml").digest == io.load_scene(seat / "scene.toml").digest
    for one in found.values():
        if one.kind != "rig":
            assert (root / one.place / str(one.thumbnail)).read_text().startswith("<svg")


def test_limits_are_taken_out_of_a_scene(tmp_path):
    path = tmp_path / "limits.toml"
    path.write_text("schema = 1\n[accept.A]\nw2_mean = 0.02\n[accept.B]\nw2_mean = 0.1\n")
    entry = add(tmp_path / "parts", [path])
    text = (tmp_path / "parts" / entry.place / "files" / "limits.toml").read_text()
    assert (entry.kind, text) == (
        "limits",
        "[accept.A]\nw2_mean = 0.02\n\n[accept.B]\nw2_mean = 0.1\n",
    )
    path.write_text("[accept.A]\nw2_meen = 0.02\n")
    refused("limits.toml:2: accept.A.w2_meen", add, tmp_path / "parts", [path])


def test_a_scene_that_names_a_folder_above_keeps_its_order_of_folders(seat, tmp_path):
    shutil.copytree(seat, tmp_path / "a")
    (tmp_path / "foams").mkdir()
    (tmp_path / "a" / "foam.obj").rename(tmp_path / "foams" / "foam.obj")
    scene = tmp_path / "a" / "scene.toml"
    text = scene.read_text().replace('"foam.obj"', '"../foams/foam.obj"')
    scene.write_text(text)
    entry = add(tmp_path / "parts", [scene])
    assert entry.main == "a/scene.toml"
    assert "foams/foam.obj" in entry.files
    take(open_library(tmp_path / "parts"), entry, tmp_path / "b")
    io.load_scene(tmp_path / "b" / "a" / "scene.toml")
    scene.write_text(text.replace('"../foams/foam.obj"', f'"{tmp_path}/foams/foam.obj"'))
    refused("foam.file", add, tmp_path / "parts", [scene])


def test_two_of_one_name_are_told_apart_by_place_and_parts_by_content(tmp_path):
    root = tmp_path / "parts"
    (tmp_path / "b").mkdir()
    first = add(root, [material(tmp_path, "own")], name="Cover")
    second = add(root, [material(tmp_path / "b", "own", "1.3")], name="Cover")
    assert add(root, [material(tmp_path, "own")], name="Cover") == first
    assert first.place != second.place
    library = open_library(root)
    assert {library.label(first), library.label(second)} == {
        f"Cover ({first.place})",
        f"Cover ({second.place})",
    }
    refused(f"places: {first.place}, {second.place}", library.get, "cover")
    assert library.get(second.place) == second
    digest = hashlib.sha256((tmp_path / "own.toml").read_bytes()).hexdigest()
    assert library.find(digest=digest[:12]) == (first,)
    # Renamed and moved by hand, it is still the same part.
    (root / "trim").mkdir()
    (root / first.place).rename(root / "trim" / "7")
    sheet = root / "trim" / "7" / SHEET
    sheet.write_text(sheet.read_text().replace('"Cover"', '"Old cover"'))
    part = replace_part(first)
    found = open_library(root).part(part)
    assert found is not None
    assert (found.place, found.name) == ("trim/7", "Old cover")
    assert open_library(root).part(replace(part, digest="0" * 64)) is None


def replace_part(entry):
    from seatlook.library.entry import Part

    return Part(entry.kind, entry.name, entry.digest)


@pytest.mark.parametrize("index", ["", "{", "[]", '{"format": 1, "entries": {"a": 3}}', "folder"])
def test_the_index_is_never_the_truth(index, tmp_path):
    root = tmp_path / "parts"
    one = add(root, [material(tmp_path, "own")])
    other = add(root, [material(tmp_path, "other", "1.4")])
    (root / INDEX).unlink()
    if index == "folder":
        (root / INDEX).mkdir()
    else:
        (root / INDEX).write_text(index)
    assert open_library(root).entries == (other, one) or open_library(root).entries == (one, other)
    # A file is changed by hand, one entry is taken away: no word of the index counts.
    (root / other.place).rename(tmp_path / "gone")
    file = root / one.place / "files" / "own.toml"
    file.write_text(file.read_text() + "# changed\n")
    (found,) = open_library(root).entries
    assert found.digest == hashlib.sha256(file.read_bytes()).hexdigest() != one.digest


def test_an_index_that_lies_is_found_out_where_an_entry_is_used(tmp_path):
    root = tmp_path / "parts"
    entry = add(root, [material(tmp_path, "own")])
    data = json.loads((root / INDEX).read_text())
    data["entries"][entry.place]["entry"] |= {"digest": "0" * 64, "files": ["../../library.toml"]}
    (root / INDEX).write_text(json.dumps(data))
    assert open_library(root).get(entry.place) == entry


def test_files_are_read_once_while_they_do_not_change(tmp_path, monkeypatch):
    root = tmp_path / "parts"
    add(root, [material(tmp_path, "own")])
    add(root, [material(tmp_path, "other", "1.4")])
    read: list[str] = []
    real = read_entry
    monkeypatch.setattr(
        "seatlook.library.library.read_entry",
        lambda at, place: read.append(place) or real(at, place),
    )
    open_library(root)
    assert read == []
    sheet = root / "materials" / "own" / SHEET
    sheet.write_text(sheet.read_text() + 'note = "new"\n')
    assert {one.note for one in open_library(root).entries} == {"", "new"}
    assert read == ["materials/own"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("format = 1", "format = 2", ":1: format: got 2"),
        ('kind = "material"', 'kind = "materiel"', ":2: kind: got 'materiel', expected one of"),
        ('name = "own"', "name = 3", ":3: name: got 3"),
        ('name = "own"', 'name = "a\\tb"', ":3: name: got 'a\\tb'"),
        ('main = "own.toml"', 'main = "../entry.toml"', ":4: main: got '../entry.toml'"),
        ('"thumbnail.svg"', '"../../../library.toml"', ":5: thumbnail.library.toml: got a link"),
        ('"thumbnail.svg"', '"none.png"', ":5: thumbnail: got 'none.png'"),
        ('"thumbnail.svg"', '"thumbnail.svg"\nnotes = 1', ":6: notes: got unknown key"),
        ('kind = "material"', 'kind = "material', ":2: syntax"),
    ],
)
def test_a_broken_entry_is_named_with_file_and_line_and_the_others_stay(
    old, new, said, tmp_path, capsys
):
    root = tmp_path / "parts"
    add(root, [material(tmp_path, "own")])
    add(root, [material(tmp_path, "other", "1.4")])
    sheet = root / "materials" / "own" / SHEET
    assert old in sheet.read_text()
    sheet.write_text(sheet.read_text().replace(old, new, 1))
    assert run(["library", "list", "--library", str(root)]) == 2
    shown = capsys.readouterr()
    assert f"{sheet}{said}" in shown.err
    assert "materials/other" in shown.out
    assert "materials/own" not in shown.out
    assert run(["library", "show", "materials/own", "--library", str(root)]) == 2
    assert f"{sheet}{said}" in capsys.readouterr().err


def test_links_out_of_the_library_are_refused_and_links_inside_are_not(tmp_path):
    root = tmp_path / "parts"
    own = add(root, [material(tmp_path, "own")])
    other = add(root, [material(tmp_path, "other", "1.4")])
    (tmp_path / "secret").mkdir()
    (tmp_path / "secret" / "a.txt").write_text("secret")
    file = root / own.place / "files" / "more.txt"
    for target in (tmp_path / "secret" / "a.txt", tmp_path / "secret", Path("/etc/passwd"), file):
        file.unlink(missing_ok=True)
        file.symlink_to(target)
        library = open_library(root)
        assert library.entries == (other,)
        assert "more.txt: got a link" in str(library.problems[0])
    file.unlink()
    file.symlink_to(root / "library.toml")
    assert {one.name for one in open_library(root).entries} == {"own", "other"}
    file.unlink()
    # A folder that is a link: nothing in it is taken for an entry.
    shutil.copytree(root / own.place, tmp_path / "secret" / "own")
    (root / "linked").symlink_to(tmp_path / "secret")
    library = open_library(root)
    assert library.entries == (other, own)
    assert "linked" in str(library.problems[0])
    for name in ("entry.toml", "files"):
        shutil.rmtree(root / own.place)
        shutil.copytree(tmp_path / "secret" / "own", root / own.place)
        if name == "files":
            shutil.rmtree(root / own.place / name)
        else:
            (root / own.place / name).unlink()
        (root / own.place / name).symlink_to(tmp_path / "secret" / "own" / name)
        assert open_library(root).entries == (other,), name


def test_what_fails_on_the_way_leaves_nothing(tmp_path, monkeypatch):
    root = tmp_path / "parts"
    add(root, [material(tmp_path, "own")])
    before = sorted(root.rglob("*"))

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("seatlook.library.adding.shutil.copyfileobj", full)
    with pytest.raises(OSError, match="No space"):
        add(root, [material(tmp_path, "other", "1.4")])
    assert sorted(root.rglob("*")) == before


def test_taking_writes_over_no_other_file(tmp_path):
    root = tmp_path / "parts"
    entry = add(root, [material(tmp_path, "own")])
    library, out = open_library(root), tmp_path / "out"
    (path,) = take(library, entry, out)
    take(library, entry, out)
    path.write_text("mine")
    refused("own.toml: --out: got another file", take, library, entry, out)
    assert path.read_text() == "mine"
    take(library, entry, out, force=True)
    assert path.read_bytes() == (tmp_path / "own.toml").read_bytes()


def test_a_folder_of_other_things_is_no_library(tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    refused("expected a library", open_library, tmp_path)
    path = material_path("suede")
    refused("files, and no library.toml", add, tmp_path, [path])
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "library.toml").write_text("\nformat = 9\n")
    refused("library.toml:2: format: got 9", open_library, tmp_path / "parts")


def test_the_commands_print_what_they_find(tmp_path, capsys, monkeypatch):
    root = str(tmp_path / "parts")
    assert run(["library", "list"]) == 2
    assert "SEATLOOK_LIBRARY" in capsys.readouterr().err
    monkeypatch.setenv("SEATLOOK_LIBRARY", root)
    path = str(material(tmp_path, "own"))
    words = ["library", "add", path, "--name", 'A "b" 🪑', "--words", "soft", "--words", "warm"]
    assert run([*words, "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["name"], row["kind"], row["words"]) == ('A "b" 🪑', "material", ["soft", "warm"])
    assert run(["library", "find", "WARM", "soft", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == [row]
    assert run(["library", "find", "--digest", row["digest"][:12], "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == [row]
    assert run(["library", "find", "cold", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == []
    assert run(["library", "find", "--digest", "abc"]) == 2
    assert run(["library", "list", "--kind", "sofa"]) == 2
    assert run(["library", "show", "nothing"]) == 2
    capsys.readouterr()
    assert run(["library", "show", row["place"], "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["files"] == ["own.toml"]
    assert shown["digest"] == row["digest"]
    assert run(["library", "take", row["name"], "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out" / "own.toml").is_file()


def test_the_folder_of_a_run_is_kept_with_its_picture(tmp_path):
    run_folder = tmp_path / "run"
    (run_folder / "images").mkdir(parents=True)
    io.write_result(solution(), run_folder / "result.npz")
    entry = add(tmp_path / "parts", [run_folder])
    place = tmp_path / "parts" / entry.place
    assert (entry.kind, entry.name, entry.main) == ("result", "run", "result.npz")
    assert (place / str(entry.thumbnail)).read_text().count("<path") > 0
    (run_folder / "images" / "a.png").write_bytes(b"picture")
    with_picture = add(tmp_path / "parts", [run_folder])
    assert with_picture.files == ("images/a.png", "result.npz")
    assert with_picture.thumbnail == "thumbnail.png"
    assert with_picture.place != entry.place
    (run_folder / "result.npz").write_bytes(b"")
    refused("result.npz", add, tmp_path / "parts", [run_folder])
