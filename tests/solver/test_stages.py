"""When each stage is, step by step."""

from itertools import pairwise

import pytest

from seatlook.model import Stage
from seatlook.solver.stages import schedule


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
