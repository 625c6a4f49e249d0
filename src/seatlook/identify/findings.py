"""Numbers that tests gave, each with its error and source, and how the model follows a record."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.io.laboratory.types import Laboratory, LabTest
from seatlook.io.parameter_text import file_key
from seatlook.model import Curve, Fabric, FloatArray, FoamMaterial, Hysteresis, Material

_DIGITS = 7
# Of the peak, RMS, and locally with noise averaged: beyond, the report says where the model leaves
# the record.
FOLLOWS, LEAVES = 0.02, 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One number or curve of a material.

    Parameters
    ----------
    field : of ``Fabric`` or ``FoamMaterial``
    value : in SI
    sigma : standard error, of every stiffness of a curve; None where nothing can be said of it
    source : test, specimens, laboratory and date
    """

    field: str
    value: Any
    sigma: FloatArray | None
    source: str

    @property
    def key(self) -> str:
        """Name in the files."""
        return file_key(self.field)[0]

    @property
    def sources(self) -> str:
        """Source with the error, as it is written in [source]."""
        if self.sigma is None:
            return self.source
        share = 100.0 * np.max(self.sigma / np.maximum(np.mean(np.abs(self._sizes)), 1e-300))
        return f"{self.source}; standard error {share:.2g} %"

    @property
    def numbers(self) -> list[float]:
        """The value in the unit of its key: a curve by its stiffness, a loop by its width."""
        return [float(size * file_key(self.field)[1]) for size in self._sizes]

    @property
    def errors(self) -> list[float] | None:
        """Standard errors of the numbers, in the same unit."""
        if self.sigma is None:
            return None
        return [float(error * file_key(self.field)[1]) for error in self.sigma]

    @property
    def _sizes(self) -> FloatArray:
        value = getattr(self.value, "stiffness", getattr(self.value, "width", self.value))
        return np.atleast_1d(np.asarray(value, dtype=np.float64))


@dataclass(frozen=True, slots=True, kw_only=True)
class Residual:
    """How closely the model follows a test: RMS and largest deviation over the peak, and where."""

    test: str
    kind: str
    rms: float
    worst: float = 0.0
    at: float = 0.0

    @property
    def follows(self) -> bool:
        """Whether the record is followed within 2 % of its peak, and within 1 % on the mean."""
        return self.rms <= FOLLOWS and abs(self.worst) <= LEAVES


@dataclass(frozen=True, slots=True, kw_only=True)
class Identified:
    """A material from tests.

    Parameters
    ----------
    material : cloth; None where all tests are of a foam
    foam : None where no test is of a foam
    findings : what the tests gave
    assumed : key -> why it stays judgement
    residuals : one for each test with a curve
    notes : what was decided on the way, in sentences
    """

    laboratory: Laboratory
    material: Material | None
    foam: FoamMaterial | None
    findings: tuple[Finding, ...]
    assumed: MappingProxyType[str, str]
    residuals: tuple[Residual, ...]
    notes: tuple[str, ...] = ()


@dataclass(slots=True)
class Ledger:
    """What has been found so far."""

    laboratory: Laboratory
    findings: dict[str, Finding] = field(default_factory=dict)
    residuals: list[Residual] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def tests(self, kind: str, direction: str | None = None) -> list[LabTest]:
        """Return the tests of a kind, of one direction if that is given."""
        return [
            test
            for test in self.laboratory.tests
            if test.kind == kind and direction in (None, test.direction)
        ]

    def enter(self, name: str, value: Any, test: LabTest, sigma: Any = None, how: str = "") -> None:
        """Note a number of a test; a later test of the same number takes its place."""
        files = sorted({one.file.name for one in test.specimens} or {self.laboratory.file.name})
        count = len(test.specimens)
        pieces = f"{count} specimen{'s' * (count != 1)}, " if count else ""
        text = f"{how or test.title}, {pieces}{', '.join(files)}"
        self.findings[name] = Finding(
            field=name,
            value=_rounded(value),
            sigma=_known(sigma),
            source=f"{text}, {self.laboratory.place}, {self.laboratory.date}",
        )

    def value(self, name: str, base: Fabric) -> Any:
        """Return a number found so far, or that of the base."""
        found = self.findings.get(name)
        return getattr(base, name) if found is None else found.value

    def residual(self, test: LabTest, rms: float, worst: tuple[float, float] = (0.0, 0.0)) -> None:
        """Note how closely a test is followed; ``worst`` is where, and by what share."""
        self.residuals.append(
            Residual(test=test.name, kind=test.title, rms=rms, worst=worst[1], at=worst[0])
        )


def _known(sigma: Any) -> FloatArray | None:
    """Standard errors as an array; None where one specimen leaves them open."""
    errors = None if sigma is None else np.atleast_1d(np.asarray(sigma, dtype=np.float64))
    return errors if errors is not None and np.isfinite(errors).all() else None


def _rounded(value: Any) -> Any:
    """A number, an array or a curve to the digits that a file holds."""
    if isinstance(value, Curve | Hysteresis):
        names = [one.name for one in dataclasses.fields(value)]
        return type(value)(**{name: _rounded(getattr(value, name)) for name in names})
    if isinstance(value, np.ndarray):
        return np.array([_rounded(one) for one in value.tolist()])
    return float(f"{value:.{_DIGITS}g}")
