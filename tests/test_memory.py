"""Memory that the C library keeps is given back to the system."""

import subprocess
import sys

import pytest

from seatlook import _memory

# Arrays of a size that glibc serves from its heap once one of them was freed, and one that lives
# behind them, as a result does behind the matrices of its solve: too large for any gap before them.
KEPT = """
import numpy as np
from seatlook._memory import give_back

def resident():
    with open("/proc/self/statm") as file:
        return 4 * int(file.read().split()[1])

np.ones(3_000_000)
before = resident()
parts = [np.ones(2_000_000) for _ in range(20)]
result = np.ones(1_000_000)
del parts
kept = resident() - before
give_back()
print(kept, resident() - before, result.sum())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_what_is_free_is_given_back():
    if _memory._trim() is None:
        pytest.skip("no glibc")
    done = subprocess.run([sys.executable, "-c", KEPT], check=True, capture_output=True, text=True)
    kept, left, total = map(float, done.stdout.split())
    assert kept > 200_000  # kB: else nothing is shown here
    assert left < 0.1 * kept
    assert total == 1_000_000


def test_without_glibc_nothing_happens(monkeypatch):
    monkeypatch.setattr(_memory, "_trim", lambda: None)
    _memory.give_back()
