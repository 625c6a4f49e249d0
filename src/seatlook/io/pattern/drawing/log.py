"""What the DXF library says while it reads, and otherwise writes to nobody in particular."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager


class _Collector(logging.Handler):
    def __init__(self, messages: list[str]) -> None:
        super().__init__(logging.WARNING)
        self._messages = messages

    def emit(self, record: logging.LogRecord) -> None:
        self._messages.append(record.getMessage().rstrip("."))


@contextmanager
def listening() -> Iterator[list[str]]:
    """Collect the library's warnings."""
    messages: list[str] = []
    handler, logger = _Collector(messages), logging.getLogger("ezdxf")
    propagates = logger.propagate
    logger.addHandler(handler)
    logger.propagate = False
    try:
        yield messages
    finally:
        logger.removeHandler(handler)
        logger.propagate = propagates


def loses_a_piece(message: str) -> bool:
    """Whether the library has left out a block, which is a piece of the pattern.

    Examples
    --------
    >>> loses_a_piece("Missing required ENDBLK, ignoring content")
    True
    >>> loses_a_piece("Found non-unique entity handle #FE, data validation is required")
    False
    """
    return "ignoring" in message.casefold() and ("BLOCK" in message or "ENDBLK" in message)
