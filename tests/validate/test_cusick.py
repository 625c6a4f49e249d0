"""A limp cloth that hangs freely: L-BFGS alone is too slow, Newton's method takes over."""

import subprocess
import sys

import pytest

from seatlook.solver import solve
from support.cusick import cusick

pytestmark = pytest.mark.validate

DIGEST = """
import hashlib, sys
sys.path.insert(0, "tests")
import numba
from seatlook.solver import solve
from support.cusick import cusick
numba.set_num_threads(int(sys.argv[1]))
s = solve(cusick(439), strict=True)
print(int(s.figures["changes_of_method"]), hashlib.sha256(s.positions.tobytes()).hexdigest())
"""


@pytest.mark.parametrize("vertices", [439, 1700])
def test_the_drape_comes_to_rest_by_itself(vertices):
    s = solve(cusick(vertices), strict=True)
    assert s.figures["changes_of_method"] >= 1
    assert 0.05 < -s.positions[:, 2].min() < 0.065
    print(vertices, s.figures["cpu_seconds"], s.figures["iterations"])


def test_the_change_of_method_gives_the_same_bytes_for_any_number_of_threads(pytestconfig):
    told = {
        subprocess.run(
            [sys.executable, "-c", DIGEST, threads],
            capture_output=True, text=True, check=True, cwd=pytestconfig.rootpath,
        ).stdout
        for threads in ("1", "2")
    }  # fmt: skip
    assert len(told) == 1
    assert told.pop().startswith("1 ")
