"""The command that names corrections: what it refuses before anything is solved."""

import shutil

from seatlook.cli import run


def test_without_a_task_it_says_which(demo_scene, capsys):
    assert run(["improve", str(demo_scene)]) == 2
    assert "--propose" in capsys.readouterr().err


def test_frozen_names_must_be_of_the_scene(demo_scene, tmp_path, capsys):
    folder = tmp_path / "seat"
    shutil.copytree(demo_scene.parent, folder)
    file = folder / "scene.toml"
    file.write_text(file.read_text() + '\n[improve]\nfrozen = ["INSERT.FRONT", "INSERT.FRNT"]\n')
    assert run(["improve", str(file), "--propose"]) == 2
    error = capsys.readouterr().err
    assert "improve.frozen" in error
    assert "INSERT.FRNT" in error
