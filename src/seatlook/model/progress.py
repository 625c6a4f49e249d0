"""How long work reports its progress."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """What long work calls as it goes on: the step's name, and the solver's figures if any."""

    def __call__(self, name: str, /, **figures: float | str) -> None:
        """Show the step."""
        ...


def silent(name: str, /, **figures: float | str) -> None:
    """Report nothing."""
