"""Who is told of what happens."""

from __future__ import annotations

import json
import queue
import threading
from contextlib import suppress
from typing import Any


class Listeners:
    """Whoever wants to hear what happens; one that does not listen misses the oldest."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._all: list[queue.Queue[str]] = []

    def __bool__(self) -> bool:
        return bool(self._all)

    def join(self, most: int) -> queue.Queue[str]:
        """Listen from now on; of more than ``most`` the first has to leave."""
        listener: queue.Queue[str] = queue.Queue(64)
        with self._lock:
            self._all.append(listener)
            del self._all[:-most]
        return listener

    def leave(self, listener: queue.Queue[str]) -> None:
        """Listen no more."""
        with self._lock, suppress(ValueError):
            self._all.remove(listener)

    def tell(self, event: str, values: Any) -> None:
        """Send an event to all."""
        text = f"event: {event}\ndata: {json.dumps(values)}\n\n"
        with self._lock:
            for listener in self._all:
                if listener.full():
                    with suppress(queue.Empty):
                        listener.get_nowait()
                listener.put_nowait(text)
