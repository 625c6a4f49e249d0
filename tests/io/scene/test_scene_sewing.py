"""What a scene says of hem, hog rings and element sizes, and what is refused, with its line."""

import contextlib
import re
from dataclasses import replace

import pytest

import seatlook.io.scene.read as module
from seatlook.errors import InputError, InputWarning
from seatlook.flattening.pattern import cut_outline
from seatlook.io.scene.read import load_scene
from support.example_scene import EXAMPLE, write_example_files


@pytest.fixture
def load(tmp_path):
    write_example_files(tmp_path)

    def load(*changes):
        text = EXAMPLE
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new, 1)
        (tmp_path / "scene.toml").write_text(text)
        return load_scene(tmp_path / "scene.toml")

    return load


def line_of(start):
    return next(i for i, row in enumerate(EXAMPLE.splitlines(), 1) if row.startswith(start))


def test_hem_rings_and_sizes_are_read(load):
    scene = load()
    assert scene.hem
    assert dict(scene.element_sizes) == {"CENTER": 0.004}
    plain, ringed = scene.hooks
    assert (plain.pitch, plain.start, plain.end, plain.limit) == (None, 0.0, None, None)
    assert (ringed.pitch, ringed.start, ringed.end, ringed.limit) == (0.06, 0.02, 0.23, 40.0)
    assert not load(("hem = true", "hem = false")).hem


@pytest.mark.parametrize(
    ("changes", "start", "message"),
    [
        ((("from_mm = 20.0", "from_mm = 240.0"),), "to_mm",
         "hook[1].to_mm: got 230, expected above from_mm, 240"),
        ((("to_mm = 230.0", "to_mm = 900.0"),), "to_mm",
         "hook[1].to_mm: got 900, expected at most the length of 'CENTER/line1', "),
        ((("pitch_mm = 60.0", "pitch_mm = 0.0"),), "pitch_mm", "hook[1].pitch_mm: got 0.0, "),
        ((("limit_n = 40.0", "limit_n = -1.0"),), "limit_n", "hook[1].limit_n: got -1.0, "),
        ((("hem = true", "hem = 1"),), "hem", "hem: got 1, expected true or false"),
        ((("end_s = 0.2", "end_s = 0.0"),), "end_s", "stage[0].end_s: got 0.0, "),
    ],
)  # fmt: skip
def test_refused_with_its_line(load, problems, changes, start, message):
    (got,) = problems(load, *changes)
    assert got.startswith(f"scene.toml:{line_of(start)}: {message}"), got


def test_ramps_groups_and_seams_of_stages_are_read(load):
    scene = load(("end_s = 0.2", 'end_s = 0.2\nseams = "front"'))
    sew, hook, cover = scene.stages
    assert (sew.ramp, sew.unit, sew.seams) == ("linear", "sew", ("front",))
    assert (hook.ramp, hook.unit, cover.ramp, cover.unit) == ("smooth", "pull", "linear", "pull")
    later = load(("end_s = 0.6", 'end_s = 0.6\nseams = ["front"]'))
    assert later.stage_of("front").name == "cover"
    assert later.stage_of("left bolster").name == "sew"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ((('"smooth"', '"soft"'),), r"stage\[1\].ramp: got 'soft', expected .*linear.* .*smooth"),
        ((('name = "cover"', 'name = "sew"'),), r"stage\[2\].stage: got 'sew' twice"),
        ((("end_s = 0.2", 'end_s = 0.2\ngroup = "a"'), ('end_s = 0.6\ngroup = "pull"',
          'end_s = 0.6\ngroup = "a"')), r"stage\[2\].group a: got 'pull' beginning between"),
        ((("end_s = 0.2", 'end_s = 0.2\nseams = ["frnt"]'),),
         r"stage\[0\].seams: got 'frnt', expected .*did you mean 'front'"),
        ((("end_s = 0.2", 'end_s = 0.2\nseams = ["front"]'),
          ("end_s = 0.6", 'end_s = 0.6\nseams = ["front"]')),
         r"stage\[2\].seams: got 'front', expected no seam of stage 'sew'"),
    ],
)  # fmt: skip
def test_stages_that_do_not_fit_each_other(load, problems, changes, message):
    messages = [got for got in problems(load, *changes) if "stage[" in got]
    assert re.match(rf"scene\.toml:\d+: {message}", messages[0]), messages


def test_stage_that_ends_before_it_starts(load, problems):
    (got,) = problems(load, ("start_s = 0.2", "start_s = 0.5"))
    assert re.match(r"scene\.toml:\d+: stage\[1\].*got start 0\.5, end 0\.4, expected", got), got


def test_allowance_wider_than_its_panel(load, problems, monkeypatch):
    """The sample's cut lines, moved out: a panel 130 mm wide with an allowance of 150 mm."""
    whole = module.read_pattern

    def wide(*args, **options):
        pattern = whole(*args, **options)
        panels = tuple(replace(p, cut_outline=cut_outline(p.outline, 0.15)) for p in pattern.panels)
        return replace(pattern, panels=panels)

    monkeypatch.setattr(module, "read_pattern", wide)
    got = problems(load)
    assert got
    assert not load(("hem = true", "hem = false")).hem
    for message in got:
        assert re.match(
            rf"scene\.toml:{line_of('hem')}: hem: got an allowance of 150\.0 mm on \w+, which is "
            r"[\d.]+ mm wide, expected an allowance narrower than its panel",
            message,
        ), message


@pytest.mark.parametrize("scale", [0.1, 10.0])
def test_pattern_out_of_scale_with_its_foam_is_named(load, monkeypatch, scale):
    whole = module.read_pattern

    def scaled(*args, **options):
        pattern = whole(*args, **options)
        panels = tuple(
            replace(p, outline=scale * p.outline, cut_outline=scale * p.cut_outline)
            for p in pattern.panels
        )
        return replace(pattern, panels=panels)

    monkeypatch.setattr(module, "read_pattern", scaled)
    with (
        pytest.warns(InputWarning, match="is the unit of one of them wrong"),
        contextlib.suppress(InputError),
    ):
        load()
