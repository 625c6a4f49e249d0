"""Run the damage: what came out of a reader, how long it took, how much memory at most."""

from __future__ import annotations

import random
import time
import traceback
import warnings
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from seatlook.errors import InputError
from support.fuzz.formats import FORMATS

SLOWEST = 10.0  # [s] that the reading of a small file may take


@dataclass
class Outcome:
    """What came of all the damage to one format.

    ``faults``: what is neither read nor refused with words, with the bytes that led to it.
    """

    count: int = 0
    read: int = 0
    refused: int = 0
    slowest: float = 0.0
    faults: Counter[str] = field(default_factory=Counter)
    examples: dict[str, bytes] = field(default_factory=dict)


def fuzz(name: str, folder: Path, count: int, *, seed: int = 1) -> Outcome:
    """Read the whole files of a format, then ``count`` damaged ones."""
    form, rng = FORMATS[name], random.Random(f"{name} {seed}")
    seeds = form.seeds(folder)
    path, outcome = folder / form.file, Outcome()
    whole = path.read_bytes() if path.exists() else None
    for number in range(len(seeds) + count):
        is_whole = number < len(seeds)
        content = seeds[number] if is_whole else form.damage(rng.choice(seeds), rng)
        path.write_bytes(content)
        _count(outcome, form.ways or form.read, path, content)
    if whole is not None:
        path.write_bytes(whole)
    return outcome


def _count(outcome: Outcome, read, path: Path, content: bytes) -> None:
    began = time.process_time()
    fault = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            read(path)
        outcome.read += 1
    except InputError as error:
        outcome.refused += 1
        if not error.problems or not all(p.key and p.got and p.expected for p in error.problems):
            fault = f"refused without words: {error}"[:200]
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        place = traceback.extract_tb(error.__traceback__)[-1]
        fault = f"{type(error).__name__} at {Path(place.filename).name}:{place.lineno}"
    took = time.process_time() - began
    if took > SLOWEST:
        fault = fault or f"took over {SLOWEST:g} s"
    outcome.count += 1
    outcome.slowest = max(outcome.slowest, took)
    if fault:
        outcome.faults[fault] += 1
        outcome.examples.setdefault(fault, content)
