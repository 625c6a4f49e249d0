"""Timings of the evaluation."""

import time

import numpy as np
import pytest

from seatlook.wrinkle import wrinkle_indices


@pytest.mark.bench
@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_a_million_strain_states(mode, capsys):
    a = np.random.default_rng(0).uniform(-0.5, 0.5, (3, 1_000_000, 2, 2))
    strains = 0.5 * (a + np.swapaxes(a, 2, 3))
    seconds = []
    for _ in range(5):
        start = time.process_time()
        indices = wrinkle_indices(*strains, 0.0012, 20.0, mode)
        seconds.append(time.process_time() - start)
    with capsys.disabled():
        print(f"\na million states, {mode}: {min(seconds):.3f} CPU s")
    assert len(indices.w2) == 1_000_000
