"""CPU seconds of the element's set-up and of one energy and gradient, printed."""

import time

import numpy as np
import pytest

from seatlook.solver.element.elastic import ElasticSheet
from support import fabrics, meshes


@pytest.mark.bench
@pytest.mark.parametrize("edges", [45, 138])
def test_setup(edges, capsys):
    X, T = meshes.rectangle("uns", 1.0, 1.0, 1.0 / edges)
    panel, fabric = np.zeros(len(T), dtype=np.int64), [fabrics.woven()]
    ElasticSheet(X, T, panel, fabric)
    begin = time.process_time()
    sheet = ElasticSheet(X, T, panel, fabric)
    seconds = [time.process_time() - begin]
    x = np.column_stack([X, 0.01 * np.sin(9 * X[:, 0])])
    gradient = np.zeros_like(x)
    for energy in sheet.energies:
        begin = time.process_time()
        for _ in range(10):
            energy.value(x, gradient)
        seconds.append((time.process_time() - begin) / 10)
    assert np.isfinite(gradient).all()
    with capsys.disabled():
        print(
            f"\n    {len(X)} vertices: set-up {seconds[0]:.2f} s, "
            f"membrane {1e3 * seconds[1]:.1f} ms, bending {1e3 * seconds[2]:.1f} ms",
            end="",
        )
