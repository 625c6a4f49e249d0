"""The command that names corrections: what it refuses before anything is solved."""

import shutil

from seatlook.cli import run


def test_without_a_task_it_says_which(demo_scene, capsys):
    assert run(["improve", str(demo_scene)]) == 2
    error = capsys.readouterr().err
    assert "--propose" in error
    assert "--out" in error


def test_the_number_of_corrections_of_the_loop_stands_in_the_scene(demo_scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert run(["improve", str(demo_scene), "--out", str(out), "--count", "2"]) == 2
    assert "improve.corrections" in capsys.readouterr().err
    assert not out.exists()


def test_contradictory_limits_are_named(demo_scene, tmp_path, capsys):
    folder = tmp_path / "seat"
    shutil.copytree(demo_scene.parent, folder)
    file = folder / "scene.toml"
    file.write_text(file.read_text() + "\n[improve]\nedge_mm = -1\ncorrections = 0\n")
    assert run(["improve", str(file), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert "improve.edge_mm" in error
    assert "improve.corrections" in error
    assert not (tmp_path / "out").exists()


def test_all_frozen_ends_with_2_and_leaves_nothing(demo_scene, tmp_path, capsys):
    folder = tmp_path / "seat"
    shutil.copytree(demo_scene.parent, folder)
    file = folder / "scene.toml"
    limits = "".join(f"{kind}_mm = 0\n" for kind in ("edge", "length", "hook", "foam"))
    file.write_text(f"{file.read_text()}\n[improve]\n{limits}")
    assert run(["improve", str(file), "--out", str(tmp_path / "out"), "--preview"]) == 2
    assert "all frozen" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_frozen_names_must_be_of_the_scene(demo_scene, tmp_path, capsys):
    folder = tmp_path / "seat"
    shutil.copytree(demo_scene.parent, folder)
    file = folder / "scene.toml"
    file.write_text(file.read_text() + '\n[improve]\nfrozen = ["INSERT.FRONT", "INSERT.FRNT"]\n')
    assert run(["improve", str(file), "--propose"]) == 2
    error = capsys.readouterr().err
    assert "improve.frozen" in error
    assert "INSERT.FRNT" in error
