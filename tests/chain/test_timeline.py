"""Stages kept on disk: killed, gone on from, and done again, to the same bits."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

from seatlook import io, model
from seatlook.assembly import assemble
from seatlook.chain.timeline import solve_in_stages, stage_order
from seatlook.errors import InputError
from support import scenes

KILLED = """
import os, signal, sys
from pathlib import Path
from chain.test_timeline import cover
from seatlook.chain.timeline import solve_in_stages

def progress(*, stage, **figures):
    if stage == "cover":
        os.kill(os.getpid(), signal.SIGKILL)

solve_in_stages(cover(), Path(sys.argv[1]), progress=progress)
"""
# The stages overlap and one is eased, the allowances are folded in, the fabric keeps some strain.
CLOTH = scenes.material(
    warp_unloading=model.Curve.linear(9000.0), weft_unloading=model.Curve.linear(8000.0)
)
DEMANDING = {
    "stages": (
        model.Stage(name="sew", start=0.0, end=0.2),
        model.Stage(name="hook", start=0.1, end=0.25),
        model.Stage(name="cover", start=0.15, end=0.3, ramp="smooth"),
    ),
    "hem": True,
    "materials": MappingProxyType({"LEFT": CLOTH, "RIGHT": scenes.material()}),
}


class Stopped(Exception):
    """Raised by a run's progress: the run ends where a killed one would."""


def cover(**change):
    """The two panels on coarse elements, sewn, hooked and covered one after the other."""
    scene = scenes.two_panels(element_size=0.02, gap=0.004)
    stages = tuple(
        model.Stage(name=name, start=0.1 * k, end=0.1 * (k + 1))
        for k, name in enumerate(("sew", "hook", "cover"))
    )
    hooks = tuple(dataclasses.replace(hook, stage="hook") for hook in scene.hooks)
    return assemble(dataclasses.replace(scene, **({"stages": stages, "hooks": hooks} | change)))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """One run without a stop, and its folder."""
    folder = tmp_path_factory.mktemp("whole")
    return solve_in_stages(cover(), folder), folder


def content(path):
    """Everything of an .npz, arrays as bytes; the seconds that a run took as their number."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    result = {name: (a.dtype.str, a.shape, a.tobytes()) for name, a in arrays.items()}
    if "meta" in arrays:
        tree = json.loads(str(arrays["meta"]))
        del tree["solution"]["figures"]["map"]["cpu_seconds"]
        seconds = arrays["history.cpu_seconds"]
        assert (np.diff(seconds) >= 0.0).all()
        result |= {"meta": tree, "history.cpu_seconds": len(seconds)}
    return result


def assert_same_files(a, b):
    """Two result files, or two folders of stages with their shapes on the way."""
    if a.is_dir():
        names = sorted(p.relative_to(a) for p in a.rglob("*.npz"))
        assert names == sorted(p.relative_to(b) for p in b.rglob("*.npz"))
        assert names
        for name in names:
            assert_same_files(a / name, b / name)
        return
    one, two = content(a), content(b)
    assert one.keys() == two.keys()
    assert [name for name in one if one[name] != two[name]] == [], a.name


def assert_same_bits(a, b):
    with tempfile.TemporaryDirectory() as folder:
        paths = Path(folder) / "a.npz", Path(folder) / "b.npz"
        for solution, path in zip((a, b), paths, strict=True):
            io.write_result(solution, path)
        assert_same_files(*paths)


def stopped_at(stage, made, folder):
    """Run until the first step of ``stage``, whose predecessors are then in the folder."""

    def progress(**figures):
        if figures["stage"] == stage:
            raise Stopped

    with pytest.raises(Stopped):
        solve_in_stages(made, folder, progress=progress)


@pytest.mark.parametrize("change", [{}, DEMANDING], ids=["plain", "demanding"])
def test_stopped_after_any_stage_it_ends_in_the_same_files(change, tmp_path):
    """Every array of the result, the snapshots and the shapes; also with only the rest to do."""
    made = cover(**change)
    whole = tmp_path / "whole"
    io.write_result(solve_in_stages(made, whole / "seat.stages"), whole / "seat.npz")
    for stage in (*stage_order(made), "at rest"):
        folder = tmp_path / stage.replace(" ", "-")
        stopped_at(stage, made, folder / "seat.stages")
        resumed = solve_in_stages(made, folder / "seat.stages", resume=True)
        io.write_result(resumed, folder / "seat.npz")
        assert_same_files(folder, whole)


def test_every_stage_leaves_a_snapshot(whole):
    solution, folder = whole
    assert stage_order(solution.cover) == ["sew", "hook", "cover"]
    assert sorted(p.name for p in folder.glob("*.npz")) == [
        "1-sew.npz",
        "2-hook.npz",
        "3-cover.npz",
    ]
    ends = [io.read_result(p).history["time"][-1] for p in sorted(folder.glob("*.npz"))]
    assert ends == pytest.approx([0.1, 0.2, 0.3])
    assert solution.stage == "at rest"


def test_killed_run_goes_on_to_the_same_bits(whole, tmp_path):
    paths = os.pathsep.join(str(Path(__file__).parents[1]) for _ in range(1))
    killed = subprocess.run(
        [sys.executable, "-c", KILLED, str(tmp_path)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([paths, *filter(None, sys.path)])},
        check=False,
        capture_output=True,
        text=True,
    )
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    assert sorted(p.name for p in tmp_path.glob("*.npz")) == ["1-sew.npz", "2-hook.npz"]
    for name in ("1-sew.npz", "2-hook.npz"):
        assert_same_bits(io.read_result(tmp_path / name), io.read_result(whole[1] / name))
    seen = []
    resumed = solve_in_stages(
        cover(), tmp_path, resume=True, progress=lambda *, stage, **figures: seen.append(stage)
    )
    assert set(seen) == {"cover", "at rest"}
    assert_same_bits(resumed, whole[0])
    assert_same_bits(
        io.read_result(tmp_path / "3-cover.npz"), io.read_result(whole[1] / "3-cover.npz")
    )


def test_another_cover_is_not_resumed(whole):
    seen = []
    other = dataclasses.replace(cover(), scene_digest="changed")
    solve_in_stages(
        other, whole[1].parent / "none", resume=True,
        progress=lambda *, stage, **figures: seen.append(stage),
    )  # fmt: skip
    assert seen[0] == "sew"


def test_changed_hook_does_not_sew_again(whole, tmp_path):
    """The wire 2 mm lower: the same result as from the start, with only the hooking done again."""
    for path in whole[1].glob("*.npz"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    scene = scenes.two_panels()
    lower = {**scene.foam.curves, "wire": scene.foam.curves["wire"] - [0, 0, 0.002]}
    foam = dataclasses.replace(scene.foam, curves=type(scene.foam.curves)(lower))
    seen = []
    changed = cover(foam=foam)
    again = solve_in_stages(
        changed, tmp_path, again_from="hook",
        progress=lambda *, stage, **figures: seen.append(stage),
    )  # fmt: skip
    assert set(seen) == {"hook", "cover", "at rest"}
    new = solve_in_stages(changed, tmp_path / "new")
    # What was begun with another scene says so, and is never taken for a result of this one.
    assert again.settings == f"{new.settings}, begun with another scene"
    assert_same_bits(dataclasses.replace(again, settings=new.settings), new)
    moved = again.positions[:, 2] - whole[0].positions[:, 2]
    assert moved.min() < -0.001
    assert_same_bits(io.read_result(tmp_path / "1-sew.npz"), io.read_result(whole[1] / "1-sew.npz"))


def test_from_the_first_stage_is_from_the_start(whole, tmp_path):
    assert_same_bits(solve_in_stages(cover(), tmp_path, again_from="sew"), whole[0])


def test_unknown_stage_and_missing_snapshot(tmp_path):
    with pytest.raises(
        InputError, match=r"got 'hok', expected one of .* \(did you mean 'hook'\?\)"
    ):
        solve_in_stages(cover(), tmp_path, again_from="hok")
    with pytest.raises(
        InputError, match=r"1-sew.npz: snapshot: got no such file, expected the end"
    ):
        solve_in_stages(cover(), tmp_path, again_from="hook")


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"element_size": 0.025}, "another rest, faces, positions"),
        ({"stages": (model.Stage(name="sew", start=0.0, end=0.08),
                     model.Stage(name="hook", start=0.1, end=0.2),
                     model.Stage(name="cover", start=0.2, end=0.3))}, "another stage sew"),
        ({"stages": (model.Stage(name="sew", start=0.0, end=0.1, ramp="smooth"),
                     model.Stage(name="hook", start=0.1, end=0.2),
                     model.Stage(name="cover", start=0.2, end=0.3))}, "another stage sew"),
        ({"stages": (model.Stage(name="sew", start=0.0, end=0.1),
                     model.Stage(name="hook", start=0.12, end=0.2),
                     model.Stage(name="cover", start=0.2, end=0.3))}, "another stage hook"),
    ],
)  # fmt: skip
def test_what_was_made_before_must_not_have_changed(whole, change, named):
    with pytest.raises(InputError, match=named):
        solve_in_stages(cover(**change), whole[1], again_from="hook")


def test_changed_pitch_needs_sewing_again(whole):
    scene = scenes.two_panels()
    seam = dataclasses.replace(scene.pattern.seams[0], pitch=0.05)
    pattern = dataclasses.replace(scene.pattern, seams=(seam,))
    with pytest.raises(InputError, match="another seam, hook or frame of these stages"):
        solve_in_stages(cover(pattern=pattern), whole[1], again_from="hook")
    assert np.isfinite(whole[0].positions).all()


def test_a_group_is_kept_and_done_again_as_one(whole, tmp_path):
    """Hook and cover as one group, ramped smoothly: one snapshot, and the same from it."""
    pull = {"group": "pull", "ramp": "smooth"}
    stages = (
        model.Stage(name="sew", start=0.0, end=0.1),
        model.Stage(name="hook", start=0.1, end=0.2, **pull),
        model.Stage(name="cover", start=0.15, end=0.3, **pull),
    )
    grouped = cover(stages=stages)
    assert stage_order(grouped) == ["sew", "pull"]
    new = solve_in_stages(grouped, tmp_path / "new")
    assert sorted(p.name for p in (tmp_path / "new").glob("*.npz")) == ["1-sew.npz", "2-pull.npz"]
    assert io.read_result(tmp_path / "new" / "2-pull.npz").stage == "pull"
    (tmp_path / "1-sew.npz").write_bytes((tmp_path / "new" / "1-sew.npz").read_bytes())
    seen = []
    again = solve_in_stages(
        grouped, tmp_path, again_from="pull",
        progress=lambda *, stage, **figures: seen.append(stage),
    )  # fmt: skip
    assert set(seen) == {"pull", "at rest"}
    assert_same_bits(again, new)
    with pytest.raises(InputError, match=r"got 'hook', expected one of \['sew', 'pull'\]"):
        solve_in_stages(grouped, tmp_path, again_from="hook")
    for name in new.history:
        assert len(new.history[name]) == len(again.history[name])


def test_a_seam_closes_in_the_stage_that_names_it():
    (seam,) = scenes.two_panels().pattern.seams
    *before, last = cover().stages
    stages = (*before, dataclasses.replace(last, seams=(seam.name,)))
    assert [s.stage for s in cover(stages=stages).stitchings] == ["cover"]
    assert [s.stage for s in cover().stitchings] == ["sew"]
