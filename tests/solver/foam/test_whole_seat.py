"""The distance field of a whole seat, 0.9 x 1.2 x 1.0 m, at the spacing of every other foam."""

import json
import subprocess
import sys

import numpy as np
import pytest

# In a process of its own, whose peak of memory is that of the field.
CODE = """
import json, resource, time
import numpy as np
from seatlook.solver.foam.distance import distance_field
from support.rough_surfaces import cushion, whole_seat
small = cushion(2)
distance_field(*small, spacing=0.02)
v, f = whole_seat()
begun = time.process_time()
field = distance_field(v, f)
spent = time.process_time() - begun
points = np.random.default_rng(0).uniform(v.min(axis=0), v.max(axis=0), (4000, 3))
phi, _ = field.at(points)
on, _ = field.at(v[::40])
print(json.dumps([spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
                  points.tolist(), phi.tolist(), on.tolist()]))
"""


@pytest.mark.validate
def test_a_whole_seat_takes_a_minute_and_two_gigabytes(tmp_path, monkeypatch):
    monkeypatch.setenv("SEATLOOK_CACHE_DIR", str(tmp_path))
    for name in ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    monkeypatch.syspath_prepend("tests")
    monkeypatch.setenv("PYTHONPATH", ":".join(sys.path))
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    seconds, gigabytes, points, phi, on = json.loads(done.stdout)
    assert seconds < 60
    assert gigabytes < 2
    points, phi = np.array(points), np.array(phi)
    inside = np.zeros(len(points), dtype=bool)
    for half, middle in (
        ((0.45, 0.6, 0.125), (0, 0, 0.125)),
        ((0.42, 0.12, 0.45), (0, 0.48, 0.55)),
    ):
        inside |= (((points - middle) / half) ** 4).sum(axis=1) < 1.0
    far = np.abs(phi) > 0.004  # the facets lie up to that below the shape of the formula
    assert far.mean() > 0.9
    assert np.array_equal(phi[far] < 0, inside[far])
    # Each body's vertices lie on the surface or inside the other body.
    assert np.max(on) < 5e-4
