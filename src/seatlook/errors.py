"""Everything seatlook raises on purpose.

::

    SeatlookError                   no result                                exit 3
    ├── InputError(ValueError)      a file, option or argument is wrong      exit 2
    │   └── AssemblyError           the parts are fine, together they are not
    ├── SolverError                 the solver cannot give a result
    │   ├── InvertedElementError
    │   ├── ConvergenceError        seatlook.solver: carries the last Solution
    │   ├── SheetError              seatlook.solver: carries the last SheetSolution
    │   └── UnstableStepError       seatlook.solver: the explicit time step is too long
    └── RenderError                 no picture, or a wrong one
        └── NoOffscreenContext      no software GL library on this machine

    InputWarning(UserWarning)       an input is readable but unusual, or not all of it is used
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

_LONGEST_WORD, _MOST_NAMES = 60, 500  # for which a likeness is sought


class SeatlookError(Exception):
    """Base of all errors; ``exit_code`` is what the command line returns."""

    exit_code: ClassVar[int] = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """One thing wrong with an input: where, which key, what was got, what is expected.

    Examples
    --------
    >>> print(Problem(file=Path("seat.toml"), line=14, key="rig[1].elevation_deg",
    ...               got="'high'", expected="number"))
    seat.toml:14: rig[1].elevation_deg: got 'high', expected number
    """

    key: str
    got: str
    expected: str
    file: Path | None = None
    line: int | None = None
    hint: str = ""

    def __str__(self) -> str:
        place = "" if self.file is None else str(self.file)
        if self.line is not None:
            place += f":{self.line}"
        head = f"{place}: " if place else ""
        tail = f" ({self.hint})" if self.hint else ""
        return f"{head}{self.key}: got {self.got}, expected {self.expected}{tail}"


class InputError(SeatlookError, ValueError):
    """A file, option or argument is wrong; holds every problem found, not only the first."""

    exit_code = 2

    def __init__(self, problems: Problem | Iterable[Problem]) -> None:
        self.problems = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))

    @classmethod
    def single(
        cls,
        key: str,
        *,
        got: object,
        expected: str,
        file: Path | None = None,
        line: int | None = None,
        hint: str = "",
    ) -> InputError:
        """Make an error of one problem."""
        return cls(
            Problem(key=key, got=str(got), expected=expected, file=file, line=line, hint=hint)
        )

    def __reduce__(self) -> tuple[type[InputError], tuple[tuple[Problem, ...]]]:
        return type(self), (self.problems,)


class AssemblyError(InputError):
    """Pattern, foam and materials are readable but do not make a cover together."""


class InputWarning(UserWarning):
    """An input is readable but unusual, or a part of it is not used."""


class SolverError(SeatlookError):
    """The solver cannot give a result."""


class InvertedElementError(SolverError):
    """A triangle of the mesh is turned over or has no area."""


class RenderError(SeatlookError):
    """No picture, or one that would be wrong."""


class NoOffscreenContext(RenderError):  # noqa: N818 -- it says what is missing, not what failed
    """No software GL library can be loaded, so nothing can be drawn on this machine."""


def did_you_mean(word: str, choices: Iterable[str]) -> str:
    """Return ``did you mean 'x'?`` for the closest choice, or an empty text.

    Examples
    --------
    >>> did_you_mean("roughnes", ["albedo", "roughness"])
    "did you mean 'roughness'?"
    """
    names = list(choices)
    # The time goes with the product of the lengths and with the number.
    if len(word) > _LONGEST_WORD or len(names) > _MOST_NAMES:
        return ""
    close = difflib.get_close_matches(word, names, n=1)
    return f"did you mean {close[0]!r}?" if close else ""
