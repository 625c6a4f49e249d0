"""Published thresholds and matches, read from a folder, as pictures to be shown to the model.

The files are not part of this project: ``docs/measurements/score.md`` names their sources.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from seatlook.model import FloatArray
from seatlook.visibility.observer import Observer
from seatlook.visibility.vwi import score
from support.seen.stimuli import axes, gabor, grating, noise

FITTED = ("rovamo1993", "hdrvdp_csf", "robson1966", "virsu1979")
HELD_OUT = "hdr_csf"
_DARK = 1e-4  # [cd/m2] where a mask would be darker than black
_PIXELS_PER_DEGREE = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Detected:
    """Sensitivity to a still pattern in the fovea on a uniform ground [cd/m2]."""

    source: str
    luminance: float
    frequency: float
    sigma: float
    area: float
    grating: bool
    sensitivity: float

    def pattern(self, pixels_per_cycle: float) -> tuple[FloatArray, float]:
        """Contrast (h, w) about 0, and its pixels per degree: twice as many where it is small."""
        side = np.sqrt(self.area)
        size = 3.2 * side + 0.6 if self.grating else 6.4 * self.sigma
        ppd = pixels_per_cycle * self.frequency
        while size * ppd < 64 or ppd < 3 / max(self.sigma, 0.1):
            ppd *= 2
        x, y = axes(size, ppd)
        if not self.grating:
            return gabor(x, y, self.frequency, self.sigma), ppd
        if self.source == "rovamo1993":
            inside = (abs(x) < side / 2) & (abs(y) < side / 2)
        else:
            inside = np.hypot(x, y) < self.sigma
        return grating(x, y, self.frequency) * inside, ppd


@dataclass(frozen=True, slots=True, kw_only=True)
class Masked:
    """Contrast [dB] at which a target was seen on a mask (h, w), both about 0."""

    source: str
    at_db: float
    target: FloatArray
    mask: FloatArray
    luminance: float
    threshold_db: float

    def predicted_db(self, observer: Observer) -> float:
        """Contrast [dB] at which the model is at its threshold."""
        ground = self._show(0 * self.target)
        contrast = -30.0
        for _ in range(12):
            test = self._show(10 ** (contrast / 20) * self.target)
            d = score(test, ground, pixels_per_degree=_PIXELS_PER_DEGREE, observer=observer).vwi
            contrast -= 20 * np.log10(d)
            if abs(d - 1) < 3e-3:
                break
        return float(contrast)

    def _show(self, added: FloatArray) -> FloatArray:
        return np.maximum(self.luminance * (1 + self.mask + added), _DARK)


@dataclass(frozen=True, slots=True, kw_only=True)
class Matched:
    """A grating (frequency, luminance, contrast) that looked as strong as another one."""

    source: str
    at: float
    shown: tuple[float, float, float]
    match: tuple[float, float, float]


def detected(folder: Path) -> list[Detected]:
    """Static or at most 1 Hz, foveal, from 0.25 cycles/deg and 0.02 cd/m2 on."""
    return [
        Detected(
            source=row["dataset"],
            luminance=float(row["luminance_cd_m2"]),
            frequency=float(row["frequency_cpd"]),
            sigma=float(row["ge_sigma_deg"]),
            area=float(row["area_deg2"]),
            grating=row["stimulus"] == "grating",
            sensitivity=float(row["sensitivity"]),
        )
        for row in _rows(folder, "contrast_sensitivity.csv")
        if row["dataset"] in (*FITTED, HELD_OUT)
        and float(row["temporal_hz"]) <= 1
        and float(row["eccentricity_deg"]) == 0
        and float(row["frequency_cpd"]) >= 0.25
        and float(row["luminance_cd_m2"]) >= 0.02
    ]


def masked(folder: Path) -> dict[str, list[Masked]]:
    """Two sets; the first point of each is the one without a mask, or with the least."""
    x, y = axes(4.0, _PIXELS_PER_DEGREE)
    plain = Masked(
        source="gratings", at_db=-60.0, target=gabor(x, y, 2.0, 0.5), mask=0 * x, luminance=32.0,
        threshold_db=0.0,
    )  # fmt: skip
    gratings = []
    for row in _rows(folder, "masking_foley1994.csv"):
        at, turned = row["mask_contrast_db"], float(row["mask_orientation_deg"])
        point = replace(plain, threshold_db=float(row["threshold_contrast_db"]))
        if at != "none":
            bars = 10 ** (float(at) / 20) * grating(x, y, 2.0, turned_deg=turned)
            point = replace(point, source=f"{turned:g} deg", at_db=float(at), mask=bars)
        gratings.append(point)
    x, y = axes(5.0, _PIXELS_PER_DEGREE)
    grain = noise(len(x), _PIXELS_PER_DEGREE, up_to_cycles_per_deg=12.0, seed=8)
    noisy = [
        Masked(
            source="noise",
            at_db=20 * np.log10(rms),
            target=gabor(x, y, 1.2, 0.8),
            mask=rms * grain,
            luminance=37.0,
            threshold_db=20 * np.log10(seen),
        )
        for rms, seen in (
            (float(row["noise_rms_contrast"]), float(row["threshold_contrast"]))
            for row in _rows(folder, "masking_noise_hdrvdp2.csv")
        )
    ]
    return {"gratings": gratings, "noise": noisy}


def matched(folder: Path) -> Iterator[Matched]:
    """Across frequency at 10 cd/m2, by contrast; then across luminance."""
    for row in _rows(folder, "matching_georgeson_sullivan.csv"):
        contrast, frequency = float(row["reference_contrast"]), float(row["test_cpd"])
        if frequency != float(row["reference_cpd"]):
            yield Matched(
                source=f"frequency, {100 * contrast:.2g} %",
                at=frequency,
                shown=(float(row["reference_cpd"]), 10.0, contrast),
                match=(frequency, 10.0, float(row["matching_contrast"])),
            )
    for row in _rows(folder, "ar_matching_exp2.csv"):
        if row["col_direction"] == "1":
            bright, dark = float(row["Y_sum"]), float(row["Y_test"])
            frequency, match = float(row["cpd"]), 10 ** float(row["mean_log_c_phys_meas"])
            yield Matched(
                source="luminance",
                at=bright,
                shown=(frequency, bright, float(row["c_phys"])),
                match=(frequency, dark, match),
            )


def _rows(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))
