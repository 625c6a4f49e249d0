"""The lazy door of a package: public names are loaded when they are first used."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from typing import Any


def door(package: str, public: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], Any]]:
    """Make ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    public : name -> module that holds it, or "module:attribute" where it is called otherwise there
    """

    def load(name: str) -> Any:
        if name not in public:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, _, attribute = public[name].partition(":")
        return getattr(importlib.import_module(module), attribute or name)

    def names() -> list[str]:
        return sorted({*vars(importlib.import_module(package)), *public})

    return load, names
