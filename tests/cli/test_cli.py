"""The command line as a user meets it: exit codes, where output goes, what messages say."""

from __future__ import annotations

import contextlib
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from seatlook.cli import app, run
from seatlook.wrinkle import INDICES

pytestmark = pytest.mark.first

COMMANDS = [name for name in app if not name.startswith("-")]


def seatlook(*words: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "seatlook", *words],
        cwd=cwd,
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        check=False,
    )


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
    assert "[fabric]" in capsys.readouterr().out


def test_a_fault_of_seatlook_is_told_from_wrong_input(capsys, monkeypatch):
    from seatlook import io

    monkeypatch.setattr(io, "load_scene", lambda path, changes: 1 / 0, raising=False)
    assert run(["check", "a.toml"]) == 70
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_doctor_names_the_library_it_found(tmp_path):
    done = seatlook("doctor", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["GL window"].startswith("vtk")
    assert found["cores"] == os.cpu_count()
    assert found["kernel threads"] >= 1
    assert found["kernel cache writable"] is True
    assert found["field cache writable"] is True
    assert found["field cache"] == str(Path(os.environ["SEATLOOK_CACHE_DIR"]) / "fields")
    assert found["fields in cache"].endswith(" MB")
    assert done.stderr == "nothing to do: this machine can solve and draw\n"
    quiet = seatlook("doctor", "--json", "--quiet", cwd=tmp_path)
    assert quiet.stderr == ""


def test_doctor_says_what_to_set(tmp_path):
    done = seatlook(
        "doctor", cwd=tmp_path, OMP_NUM_THREADS="999", NUMBA_CACHE_DIR="/proc/none/such"
    )
    assert done.returncode == 0
    assert f"more threads (999) than cores: set OMP_NUM_THREADS={os.cpu_count()} or less" in (
        done.stderr
    )
    (tmp_path / "file").write_text("in the way")
    shut = seatlook("doctor", cwd=tmp_path, SEATLOOK_CACHE_DIR=str(tmp_path / "file"))
    assert f"{tmp_path / 'file' / 'fields'} cannot be written" in shut.stderr


HIDDEN = """
import ctypes, sys
real = ctypes.CDLL
class Hidden(real):
    def __init__(self, name, *args, **options):
        if name and ("EGL" in str(name) or "OSMesa" in str(name)):
            raise OSError(f"{name}: cannot open shared object file")
        super().__init__(name, *args, **options)
ctypes.CDLL = Hidden
from seatlook.cli import run
sys.exit(run(sys.argv[1:]))
"""


@pytest.mark.parametrize("command", ["doctor", "evaluate"])
def test_without_a_gl_library_it_ends_with_3_before_any_work(command, demo_scene, tmp_path):
    words = ["doctor"]
    if command == "evaluate":
        words = ["evaluate", str(demo_scene), "--out", str(tmp_path / "out")]
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN, *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == 3
    assert bool(re.search(r"(?m)^GL library +-$", done.stdout)) == (command == "doctor")
    assert "as root:" in done.stderr
    assert "without root:" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


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


def test_check_tells_what_would_be_solved(demo_scene, capsys):
    assert run(["check", str(demo_scene), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["panels"], found["seams"], found["hooks_and_frames"]) == (7, 14, 3)
    assert found["element_size_mm"] == pytest.approx(20, rel=0.15)
    ratio = found["wavelength_mm"] / found["element_size_mm"]
    assert found["wavelength_over_element_size"] == pytest.approx(ratio)
    assert found["expected_status"] == "converged, not resolved"
    waves = {wave["material"]: wave for wave in found["waves"]}
    assert not waves["leather-laminate"]["resolved"]
    least = min(wave["wavelength_over_element_size"] for wave in waves.values())
    assert least == pytest.approx(ratio, rel=0.05)
    ease = {row["seam"]: row for row in found["ease"]}
    # The rear panel is cut 1 % narrower across its grain; the insert's rear edge is not.
    assert ease["INSERT-REAR"]["ease_percent"] == pytest.approx(1.0, abs=0.15)
    assert ease["INSERT-REAR"]["ease_mm"] == pytest.approx(2.5, abs=0.4)
    assert abs(ease["INSERT-BOLSTER_L"]["ease_percent"]) < 0.01
    assert ease["INSERT-BOLSTER_L"]["notches_a"] == 3
    assert all(row["matched"] for row in found["ease"])
    assert run(["check", str(demo_scene), "--element-size-mm", "40"]) == 0
    text = capsys.readouterr().out
    assert "element_size_mm" in text
    assert "ease_percent" in text


@pytest.fixture
def own_demo(demo_scene, tmp_path):
    """Scene of a copy of the demo's files, without what commands left beside them."""
    folder = tmp_path / "own"
    folder.mkdir()
    for file in demo_scene.parent.iterdir():
        if file.suffix in (".toml", ".obj", ".dxf"):
            (folder / file.name).write_bytes(file.read_bytes())
    return folder / "scene.toml"


@pytest.mark.render
def test_check_draws_the_start_beside_the_scene(own_demo, capsys):
    picture = own_demo.parent / "check" / "assembly.png"
    assert run(["check", str(own_demo), "--json"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert found["drawing"] == str(picture)
    assert str(picture) in said.err
    assert sorted(int(row["number"]) for row in found["ease"]) == list(range(1, 15))
    assert [row["number"] for row in found["held"]] == ["H1", "H2", "F1"]
    assert found["held"][0]["pulled_to"] == "trench_left"
    assert 30 < found["held"][0]["gap_mm"] < 50
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert [file.name for file in picture.parent.iterdir()] == ["assembly.png"]


@pytest.mark.render
def test_check_draws_what_it_refuses(own_demo, capsys):
    seams = own_demo.with_name("seams.toml")
    seams.write_text(seams.read_text().replace("reverse = true", "reverse = false", 1))
    assert run(["check", str(own_demo)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    first, *refused = said.err.splitlines()
    assert first.endswith("assembly.png")
    assert "whose ties cross" in refused[0]
    assert (own_demo.parent / "check" / "assembly.png").exists()


def test_check_passes_where_the_drawing_cannot_be_written(own_demo, capsys):
    (own_demo.parent / "check").write_text("a file where the folder would be")
    assert run(["check", str(own_demo), "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["drawing"] is None
    assert re.search(r"(?m)^not drawn: .*assembly\.png: got .*, expected a folder that", said.err)


def test_check_passes_without_a_gl_library(own_demo):
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN, "check", str(own_demo), "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert json.loads(done.stdout)["drawing"] is None
    assert (
        len([line for line in done.stderr.splitlines() if "not drawn: no GL library" in line]) == 1
    )
    assert "nothing wrong" in done.stderr
    assert not (own_demo.parent / "check").exists()


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
        # A shell's background job passes an ignored interrupt on to its children.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
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
    assert [p for p in tmp_path.rglob(".*") if p.is_file()] == []


@pytest.fixture(scope="module")
def evaluated(demo_scene: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Evaluate the coarse demo once; one of its two limits cannot be kept."""
    folder = tmp_path_factory.mktemp("evaluated")
    shutil.copytree(demo_scene.parent, folder, dirs_exist_ok=True)
    scene = folder / "scene.toml"
    text = scene.read_text().replace('"driver_door", "top"]', '"top"]\nsize = [96, 54]')
    text += '\n[accept."INSERT interior"]\nw2_mean = 1e-9\n[accept."REAR interior"]\nw2_mean = 50\n'
    scene.write_text(
        text.replace('["black-leather", "bright-leather", "suede"]', '["suede", "pvc"]')
    )
    done = seatlook("evaluate", "scene.toml", "--out", ".", "--no-score", "--preview", cwd=folder)
    (folder / "stdout").write_text(done.stdout)
    (folder / "stderr").write_text(f"{done.returncode}\n{done.stderr}")
    return folder


@pytest.mark.render
def test_evaluate_leaves_a_whole_gallery_and_names_the_missed_limit(evaluated):
    code, *foretold, gallery, first, second, status = (
        (evaluated / "stderr").read_text().splitlines()
    )
    assert code == "1"
    reasons = [line.removeprefix("will not be resolved: ") for line in foretold]
    assert status == f"converged, not resolved: {'; '.join(reasons)}"
    assert first.startswith("INSERT interior: w2_mean is ")
    assert first.endswith(", not resolved, the limit is 1e-09")
    # No limit is kept by a cover that its mesh does not resolve.
    assert second.startswith("REAR interior: w2_mean is ")
    assert second.endswith(", not resolved, the limit is 50")
    assert "leather-laminate: elements of 20" in status
    assert gallery == "gallery: index.html"
    heads, *rows = (evaluated / "stdout").read_text().splitlines()
    assert heads.split()[:3] == ["zone", "area_cm2", "w2_mean"]
    assert any(row.startswith("INSERT interior") for row in rows)
    assert len(list(evaluated.glob("images/*/*.png"))) == 6
    # A map may lie there a second time, in a range of its own.
    maps = {path.stem.removesuffix("-own") for path in evaluated.glob("maps/*.png")}
    indices = set(INDICES)
    texture = {"stretch_along", "stretch_across", "shear", "grain_drift", "checker"}
    assert maps == indices | texture | {"gap", "deviation"}
    page = (evaluated / "index.html").read_text()
    for part in (
        "suede under bulb left",
        "W_compression",
        "judgement",
        "texture pvc",
        "Gap",
        "Shape against the foam",
        "Shape against the design",
        "Seam lines",
        "ease [mm]",
    ):
        assert part in page
    assert '<td class="missed">NO</td>' in page
    assert "larger than an eighth" in page


@pytest.mark.render
def test_a_result_is_judged_and_drawn_again_without_solving(evaluated, tmp_path):
    words = ["wrinkle", "result.npz", "--scene", "scene.toml", "--json", "--preview"]
    exports = [tmp_path / "seat.vtp", tmp_path / "seat.csv"]
    table = seatlook(*words, *(f"--export={path}" for path in exports), cwd=evaluated)
    assert table.returncode == 0, table.stderr
    assert all(path.stat().st_size > 1000 for path in exports)
    wrong = seatlook(*words, "--export", "seat.xyz", cwd=evaluated)
    assert wrong.returncode == 2
    assert "seat.xyz: file: got '.xyz', expected one of .vtp, .csv, .glb" in wrong.stderr
    zones = json.loads(table.stdout)["zones"]
    first = (evaluated / "stdout").read_text()
    assert len(zones) == len(first.splitlines()) - 1
    assert f"{zones[-1]['w2_mean']:.4g}" in first

    words = ["render", "scene.toml", "result.npz", "--out", str(tmp_path), "--rig", "sun"]
    done = seatlook(*words, "--texture", "suede", "--no-maps", cwd=evaluated)
    assert done.returncode == 0, done.stderr
    (again,) = tmp_path.rglob("*.png")
    assert again.read_bytes() == (evaluated / "images/sun/suede.png").read_bytes()


@pytest.mark.render
def test_shape_and_seam_lines_are_compared_with_the_design(evaluated, tmp_path):
    with (evaluated / "seam-lines.csv").open() as file:
        kept = {row["seam"]: row for row in csv.DictReader(file)}
    assert len(kept) == 14
    words = ["shape", "scene.toml", "result.npz", "--json"]
    zones = seatlook(*words, "--out", str(tmp_path), cwd=evaluated)
    assert zones.returncode == 0, zones.stderr
    rows = {row["zone"]: row for row in json.loads(zones.stdout)}
    assert rows["INSERT interior"]["measured_percent"] == pytest.approx(100)
    for row in rows.values():
        assert row["lowest_mm"] <= row["mean_mm"] <= row["highest_mm"]
        assert row["p95_mm"] <= max(-row["lowest_mm"], row["highest_mm"]) + 1e-9
    for name in ("shape.csv", "seam-lines.csv", "maps/deviation.png"):
        assert (tmp_path / name).read_bytes() == (evaluated / name).read_bytes()
    seams = json.loads(seatlook(*words, "--seams", cwd=evaluated).stdout)
    for row in seams:
        assert 0 < row["mean_mm"] < row["largest_mm"]
        assert row["mean_mm"] == pytest.approx(float(kept[row["seam"]]["mean_mm"]))
    text = (evaluated / "scene.toml").read_text()
    bare_text = text.replace('[design]\nfile = "panels.obj"\nunit = "mm"', "[design]")
    (evaluated / "bare.toml").write_text(bare_text)
    bare = seatlook("shape", "bare.toml", "result.npz", cwd=evaluated)
    assert bare.returncode == 2
    assert "bare.toml: design: got nothing, expected a table [design] with a file" in bare.stderr


@pytest.mark.render
def test_render_refuses_a_rig_the_scene_does_not_have(evaluated, tmp_path):
    out = tmp_path / "out"
    words = ["render", "scene.toml", "result.npz", "--out", str(out), "--rig", "son"]
    done = seatlook(*words, cwd=evaluated)
    assert done.returncode == 2
    assert "rig: got 'son', expected one of sun, bulb left, bulb right" in done.stderr
    assert not out.exists()
