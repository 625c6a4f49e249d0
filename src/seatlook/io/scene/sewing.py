"""How a scene is sewn, as far as that is seen: its thread, and the kinds of its seams."""

from __future__ import annotations

from types import MappingProxyType
from typing import Any

from seatlook.io.schema import known
from seatlook.io.toml import Document
from seatlook.model import Pattern, SeamKind, Thread

Row = dict[str, Any]


def make_thread(document: Document, row: Row) -> Thread:
    """Build the thread; what is wrong with it is reported, and the usual one taken."""
    values, built = {key.removesuffix("_mm"): v for key, v in row.items() if v is not None}, []
    with document.blame(("thread",)):
        built.append(Thread(**values))
    return built[0] if built else Thread()


def make_seam_kinds(
    document: Document, rows: dict[str, Row], pattern: Pattern | None
) -> MappingProxyType[str, SeamKind]:
    """Build the kinds of the seams that are named."""
    if pattern is not None:
        names = [seam.name for seam in pattern.seams]
        for name in rows:
            known(document, ("seam", name), name, names, "a seam of the seams file")
    return MappingProxyType(
        {
            name: SeamKind(kind=row["kind"], side=row["side"])
            for name, row in rows.items()
            if row["kind"] is not None and row["side"] is not None
        }
    )
