"""What was made for one picture and is used again for the next."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any

_MOST = 24


class Cache:
    """Values by key, the 24 used last.

    It knows nothing of its owner. A studio that its own parts refer to would wait, with all of
    its pictures' data, for Python's collector, which counts objects and not their megabytes.
    """

    def __init__(self) -> None:
        self._values: OrderedDict[Hashable, Any] = OrderedDict()

    def __call__(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return the value of ``key``, made where it is not there; the oldest goes."""
        if key not in self._values:
            self._values[key] = make()
            if len(self._values) > _MOST:
                self._values.popitem(last=False)
        self._values.move_to_end(key)
        return self._values[key]
