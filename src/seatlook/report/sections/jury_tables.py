"""The answers of a jury as tables and plain values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any

from seatlook.jury.calibration import Calibration
from seatlook.jury.fit import Estimate, Fit, JuryResult

Labels = Mapping[str, str]
Part = tuple[tuple[str, ...], list[tuple[Any, ...]]]


def fit_tables(result: JuryResult, labels: Labels) -> Iterator[Part]:
    """Yield heads and rows: ranking and neighbours, with and without screening, and the judges."""
    question = result.question
    for name, fit in _fits(result):
        yield (
            (f"{question}, {name}", "steps", "half_width", "fisher_half_width", "bounded"),
            [
                (labels[code], e.value, e.half_width, e.fisher_half_width, _yes(e.bounded))
                for code, e in fit.strengths.items()
            ],
        )
        yield (
            (f"neighbours, {name}", "over", "steps", "half_width", "separated"),
            [
                (
                    labels[d.upper],
                    labels[d.lower],
                    d.steps.value,
                    _widest(d.steps),
                    _yes(d.separated),
                )
                for d in fit.neighbours
            ],
        )
        yield (
            (f"agreement, {name}", "judges", "votes", "kendall_u", "p_by_chance", "tie_share"),
            [_agreement(fit)],
        )
    yield from _judges(result)


def fit_values(result: JuryResult, labels: Labels) -> dict[str, Any]:
    """Return the same as plain values."""
    left, spread = result.side_bias
    return {
        **{name: _values(fit, labels) for name, fit in _fits(result)},
        "judges": [asdict(record) for record in result.records],
        "left_share": left,
        "left_share_half_width": spread,
        "notices": list(result.notices),
    }


def calibration_rows(calibration: Calibration) -> dict[str, Any]:
    """Return the figures of a calibration by their names."""
    mean, low, high = calibration.advantage
    figures: dict[str, Any] = {
        f"held_out_log_likelihood_{name}": value for name, value in calibration.held_out.items()
    }
    for name, link in calibration.links.items():
        figures |= {f"gain_{name}": link.gain, f"exponent_{name}": link.exponent}
    return {
        **figures,
        "advantage_over_log_ratio": mean,
        "advantage_low": low,
        "advantage_high": high,
        "covers": len(calibration.geometries),
        "votes": calibration.votes,
        "verdict": calibration.verdict,
    }


def _judges(result: JuryResult) -> Iterator[Part]:
    """Yield the figures of every judge, and the side bias of all."""
    heads = ("judge", "votes", "zeta", "catches", "right", "repeats", "same", "left_share")
    rows = [tuple(asdict(record).values()) for record in result.records]
    yield (*heads, "seconds", "left_out"), rows
    yield ("side bias", "left_share", "half_width"), [("all judges", *result.side_bias)]


def _fits(result: JuryResult) -> Iterator[tuple[str, Fit]]:
    yield "all judges", result.everyone
    if result.screened is not None:
        yield "screened judges", result.screened


def _values(fit: Fit, labels: Labels) -> dict[str, Any]:
    heads = ("judges", "votes", "kendall_u", "p_by_chance", "tie_share")
    return {
        "strengths": {labels[code]: asdict(e) for code, e in fit.strengths.items()},
        "neighbours": [
            {
                "upper": labels[d.upper],
                "lower": labels[d.lower],
                **asdict(d.steps),
                "separated": d.separated,
            }
            for d in fit.neighbours
        ],
        **dict(zip(heads, _agreement(fit)[1:], strict=True)),
    }


def _agreement(fit: Fit) -> tuple[Any, ...]:
    u, p = (fit.agreement.u, fit.agreement.p_value) if fit.agreement else (None, None)
    return ("Kendall's u", len(fit.judges), fit.votes, u, p, fit.tie_share)


def _widest(estimate: Estimate) -> float:
    return max(estimate.half_width or 0.0, estimate.fisher_half_width)


def _yes(value: bool) -> str:
    return "yes" if value else "no"
