"""The command line as a user meets it: exit codes, where output goes, what messages say."""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import time

import pytest

from seatlook.cli import app, run
from support.commands import heeded

COMMANDS = [name for name in app if not name.startswith("-")]


@pytest.mark.parametrize("command", [*COMMANDS, "materials list", "materials show"])
def test_every_command_explains_itself_with_an_example(command, capsys):
    assert run([*command.split(), "--help"]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    if command != "materials":
        assert f"Example: seatlook {command}" in " ".join(said.out.split())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["chek", "a.toml"], 'Unknown command "chek". Did you mean "check"?'),
        (["evaluate"], 'Command "evaluate" parameter'),
        (["evaluate", "a.toml"], "--out"),
        (["evaluate", "a.toml", "--out", "o", "--seed", "x"], "seed"),
        (["materials", "show", "sued"], "did you mean 'suede'?"),
        (["solve", "a.toml", "--out", "a.txt"], "--out: got a.txt, expected a name that ends in"),
        (
            ["solve", "a.toml", "--out", "a.npz", "--from", "hook", "--resume"],
            "--from: got --resume as well, expected one of them",
        ),
        (["demo", "--ease", "2%"], "--ease: got '2%', expected NAME=2%"),
        (["demo", "--short", "INSERT=much"], "--short: got 'INSERT=much', expected NAME=2%"),
        (["demo", "--material", "sued"], "did you mean 'suede'?"),
        (["init", "a.dxf", "a.obj"], "see: seatlook init --help"),
        (["materials", "sow"], "see: seatlook materials --help"),
        (
            ["evaluate", "a.dxf", "--out", "o"],
            "make one of a pattern and a foam with: seatlook init",
        ),
        (["init", "a.obj", "a.dxf", "--out", "o"], "expected first the pattern, then the foam"),
    ],
)
def test_wrong_words_end_with_2_and_one_message(words, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(words) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert message in said.err
    assert "Traceback" not in said.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["check", "evaluate", "solve"])
def test_all_faults_of_a_scene_are_told_with_their_lines(command, capsys, tmp_path):
    scene = tmp_path / "seat.toml"
    scene.write_text(
        'schema = 1\n[pattern]\nfile = "none.dxf"\nseams = 3\n[foam]\nfiel = "a.obj"\n'
        '[mesh]\nelement_size_mm = "small"\n'
    )
    out = [] if command == "check" else ["--out", str(tmp_path / "out.npz")]
    assert run([command, str(scene), *out]) == 2
    errors = capsys.readouterr().err
    assert f"{scene}:8: mesh.element_size_mm: got 'small', expected a number" in errors
    assert f"{scene}:4: pattern.seams: got 3" in errors
    assert "did you mean 'file'?" in errors
    assert sorted(p.name for p in tmp_path.iterdir()) == ["seat.toml"]


def test_a_missing_scene_is_named(capsys, tmp_path):
    assert run(["check", str(tmp_path / "none.toml")]) == 2
    assert "none.toml" in capsys.readouterr().err


def test_materials_as_data(capsys):
    assert run(["materials", "list", "--json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)}
    assert rows["suede"]["kind"] == "cover"
    assert rows["suede"]["thickness_mm"] == pytest.approx(0.9)
    assert rows["foam-seat"] == {
        "name": "foam-seat",
        "kind": "foam",
        "thickness_mm": None,
        "roughness": None,
    }
    assert run(["materials", "show", "suede"]) == 0
    out = capsys.readouterr().out
    assert "[fabric]" in out
    assert "# L* a* b* by 45/0: " in out
    assert "# gloss units: " in out


def test_a_fault_of_seatlook_is_told_from_wrong_input(capsys, monkeypatch):
    from seatlook import io

    monkeypatch.setattr(io, "load_scene", lambda path, changes: 1 / 0, raising=False)
    assert run(["check", "a.toml"]) == 70
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_the_demo_scene_is_complete_and_says_what_is_spoiled(demo_scene):
    from seatlook import io

    scene = io.load_scene(demo_scene)
    assert len(scene.pattern.panels) == 7
    assert len(scene.hooks) == 2
    (frame,) = scene.frames  # one curve all round
    assert len(frame.edges) == 4
    assert [rig.name for rig in scene.rigs] == ["sun", "bulb left", "bulb right"]
    assert scene.seed == 3
    assert scene.materials["INSERT"].name == "suede-laminate"
    assert scene.materials["FRONT"].name == "leather-laminate"
    assert "Spoiled on purpose: short REAR 1.0%" in demo_scene.read_text()


def test_stages_are_kept_and_gone_on_from(demo_scene, tmp_path, capsys):
    from seatlook import io

    words = ["solve", str(demo_scene), "--element-size-mm", "40", "--out"]
    code = run([*words, str(tmp_path / "a.npz"), "--stages"])
    folder = tmp_path / "a.stages"
    kept = sorted(p.name for p in folder.glob("*.npz"))
    assert kept == ["1-sew.npz", "2-hook-and-cover.npz", "3-rest.npz"]
    assert "stage: sew\nstage: hook and cover\nstage: rest\n" in capsys.readouterr().err
    whole = io.read_result(tmp_path / "a.npz")
    for option in (["--from", "hook and cover"], ["--resume"]):
        assert run([*words, str(tmp_path / "a.npz"), *option]) == code
        assert "stage: sew" not in capsys.readouterr().err
        again = io.read_result(tmp_path / "a.npz")
        assert again.positions.tobytes() == whole.positions.tobytes()
        assert again.figures["steps"] == whole.figures["steps"]
    assert run([*words, str(tmp_path / "a.npz"), "--from", "rset"]) == 2
    assert "(did you mean 'rest'?)" in capsys.readouterr().err


def test_flatten_eases_one_side_of_a_seam(demo_scene, tmp_path):
    from seatlook import io

    surface = str(demo_scene.with_name("design.obj"))
    assert run(["flatten", surface, "--out", str(tmp_path), "--ease", "INSERT-BOLSTER_L=2%"]) == 0
    pattern = io.read_pattern(tmp_path / "pattern.dxf", tmp_path / "seams.toml")
    seam = next(s for s in pattern.seams if s.name == "INSERT-BOLSTER_L")
    lengths = [pattern.edge_length(name) for name in (seam.a, *seam.b)]
    assert max(lengths) / min(lengths) == pytest.approx(1.02, abs=0.002)


@pytest.mark.parametrize("share", ["ease", "short"])
def test_flatten_names_a_seam_or_panel_that_does_not_exist(demo_scene, tmp_path, capsys, share):
    surface = str(demo_scene.with_name("design.obj"))
    assert run(["flatten", surface, "--out", str(tmp_path / "o"), f"--{share}", "INSRT=2%"]) == 2
    assert "INSRT" in capsys.readouterr().err
    assert not (tmp_path / "o").exists()


def test_an_interrupted_command_ends_with_130_and_leaves_nothing_half_written(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-m", "seatlook", "demo", "--out", str(tmp_path / "demo")],
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heeded,
    )
    errors = ""
    try:
        # Python drops an interrupt that meets a finaliser; a person presses the keys again.
        for _ in range(20):
            time.sleep(3)
            process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                _, errors = process.communicate(timeout=3)
                break
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 130
    before, said = errors[: errors.find("interrupted;")], errors[errors.find("interrupted;") :]
    assert said == (
        "interrupted; no file was left half written; "
        "the same command with --resume takes the result, if it was solved already\n"
    )
    assert before == ""
    # Half-written files have hidden names; lock and record of a folder are whole, and stay.
    hidden = {p.name for p in tmp_path.rglob(".*") if p.is_file()}
    assert hidden <= {".seatlook.lock", ".seatlook.json"}
