"""The process in time: which stage is when, and how far its ties are drawn in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from seatlook.errors import InputError, did_you_mean
from seatlook.model import Anchor, Cover, Stage, Stitching, stage_units

_BEGUN = 1e-9  # of a stage


@dataclass(frozen=True, slots=True)
class Step:
    """One time step.

    Parameters
    ----------
    stage : group, or name, of the stage that began last
    first : whether it is the first step under that name
    time : [s] at the end of the step
    progress, before : stage -> share of its way that is gone at the end and at the start of the
        step; above 1 the stage is over
    """

    stage: str
    first: bool
    time: float
    progress: Mapping[str, float]
    before: Mapping[str, float]


def schedule(stages: Sequence[Stage], dt: float) -> list[Step]:
    """Equal steps of about ``dt`` [s] up to the end of the last stage.

    Raises
    ------
    InputError
        Stages of one name, or groups that are torn apart.

    Examples
    --------
    >>> steps = schedule([Stage(name="sew", start=0.0, end=0.1)], 0.05)
    >>> [step.progress["sew"] for step in steps]
    [0.5, 1.0]
    """
    if not stages:
        return []
    stage_units(stages)
    end = max(stage.end for stage in stages)
    count = max(1, round(end / dt))
    times = [end * k / count for k in range(count + 1)]
    order = sorted(stages, key=lambda stage: stage.start)
    steps: list[Step] = []
    for before, time in pairwise(times):
        middle = 0.5 * (before + time)
        begun = [stage.unit for stage in order if stage.start <= middle] or [order[0].unit]
        first = not steps or steps[-1].stage != begun[-1]
        after, ahead = _progress(stages, time), _progress(stages, before)
        steps.append(Step(begun[-1], first, time, after, ahead))
    return steps


def check_stages(cover: Cover) -> None:
    """Refuse ties whose stage is not in the plan."""
    names = [stage.name for stage in cover.stages]
    ties: list[Stitching | Anchor] = [*cover.stitchings, *cover.anchors]
    for tie in ties:
        if tie.stage not in names:
            raise InputError.single(
                f"{tie.name}.stage",
                got=repr(tie.stage),
                expected=f"one of {names}",
                hint=did_you_mean(tie.stage, names),
            )


def _progress(stages: Sequence[Stage], time: float) -> dict[str, float]:
    """How far each stage is on its way; beyond the end, time since it began over its length."""
    shares = {s.name: (time - s.start) / (s.end - s.start) for s in stages}
    smooth = {s.name for s in stages if s.ramp == "smooth"}
    # Rounding of the time must not let a stage begin with the last step of the one before.
    return {
        name: 0.0 if share <= _BEGUN else _eased(share) if name in smooth else share
        for name, share in shares.items()
    }


def _eased(share: float) -> float:
    """Begin and end without a jump of speed."""
    return share * share * (3.0 - 2.0 * share) if share < 1.0 else share
