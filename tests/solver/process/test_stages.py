"""When each stage is, step by step."""

from itertools import pairwise

import pytest

from seatlook.errors import InputError
from seatlook.model import Stage, stage_units
from seatlook.solver.process.stages import schedule


def planned(*ends, dt=0.02):
    spans = enumerate(pairwise((0.0, *ends)))
    return schedule([Stage(name=f"{k}", start=a, end=b) for k, (a, b) in spans], dt)


@pytest.mark.parametrize("ends", [(0.1, 0.2, 0.3), (0.2, 0.4, 0.6), (0.14, 0.22, 0.34)])
def test_a_stage_does_not_begin_with_the_last_step_of_the_one_before(ends):
    """0.3 * 5 / 15 is a little more than 0.1: rounding must not pull at the next stage's ties."""
    for step in planned(*ends):
        for stage, progress in step.progress.items():
            if int(stage) > int(step.stage):
                assert progress == 0.0
        assert step.progress[step.stage] > 0.0


def test_progress_is_the_share_of_time_that_has_passed():
    steps = planned(0.1, 0.3, dt=0.05)
    assert [s.stage for s in steps] == ["0", "0", "1", "1", "1", "1"]
    assert [s.progress["1"] for s in steps] == pytest.approx([0, 0, 0.25, 0.5, 0.75, 1.0])
    assert [s.before["1"] for s in steps] == pytest.approx([0, 0, 0, 0.25, 0.5, 0.75])
    assert [s.first for s in steps] == [True, False, True, False, False, False]


def test_smooth_ramp_begins_and_ends_without_a_jump():
    stages = [Stage(name="s", start=0.0, end=0.1, ramp="smooth"), Stage(name="l", start=0, end=0.2)]
    steps = schedule(stages, 0.01)
    way = [0.0, *(s.progress["s"] for s in steps[:10])]
    assert way[5] == pytest.approx(0.5)
    assert way[2] == pytest.approx(3 * 0.2**2 - 2 * 0.2**3)
    speed = [b - a for a, b in pairwise(way)]
    assert max(speed[0], speed[-1]) < 0.3 * 0.1 < max(speed)
    assert [s.progress["l"] for s in steps] == pytest.approx([0.05 * k for k in range(1, 21)])
    # Over, both go on alike: ties stiffen in the time after the end.
    assert steps[14].progress["s"] == pytest.approx(1.5)


def test_steps_are_those_of_the_group():
    stages = [
        Stage(name="insert", start=0.0, end=0.1, group="sew"),
        Stage(name="sides", start=0.1, end=0.2, group="sew"),
        Stage(name="hook", start=0.2, end=0.3),
    ]
    steps = schedule(stages, 0.05)
    assert [s.stage for s in steps] == ["sew"] * 4 + ["hook"] * 2
    assert [s.first for s in steps] == [True, False, False, False, True, False]
    assert [s.progress["sides"] for s in steps[:4]] == pytest.approx([0, 0, 0.5, 1])


def test_groups_torn_apart_and_stages_of_one_name_are_refused():
    def stage(name, start, **options):
        return Stage(name=name, start=start, end=1.0, **options)

    torn = [stage("a", 0, group="sew"), stage("hook", 0.1), stage("b", 0.2, group="sew")]
    with pytest.raises(InputError, match=r"group sew: got 'hook' beginning between its stages"):
        schedule(torn, 0.1)
    with pytest.raises(InputError, match=r"stage: got 'a' twice"):
        stage_units([stage("a", 0), stage("a", 0.5)])
    with pytest.raises(InputError, match=r"stage a.ramp: got 'round', expected linear or smooth"):
        stage("a", 0, ramp="round")
