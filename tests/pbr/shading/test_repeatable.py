"""The same bytes whatever draws them: threads, GL window, other pictures in between."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.render, pytest.mark.first]
TESTS = Path(__file__).parents[2]
DRAW = """
import hashlib, numpy as np
from support.reference.lit_sheets import sheet
from seatlook.model import Appearance, Rig, bulb, named_view, strip, sun
from seatlook.pbr import render
look = Appearance(albedo=np.full(3, 0.1), texture="leather", texture_depth=6e-5)
lights = (sun(elevation_deg=40, azimuth_deg=300), bulb(position_mm=(0, -200, 300)))
lights += (strip(position_mm=(300, 0, 500), lumen=2e5),)
rig = Rig(name="r", lights=lights)
camera = named_view("front_34", target=np.zeros(3), size=(96, 54), distance=0.4)
image = render(sheet(lambda x, y: 0.01 * np.cos(60 * x), steps=20), look, rig=rig, camera=camera)
print(hashlib.sha256(image.radiance.tobytes()).hexdigest())
"""


def drawn(first="", *, code="", **environment):
    """Hash of a picture made by another process, or what other ``code`` prints."""
    load = "from seatlook.pbr import offscreen_backend"
    done = subprocess.run(
        [sys.executable, "-c", "\n".join([first, load, code or DRAW])],
        env={**os.environ, "PYTHONPATH": str(TESTS), **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_one_or_two_threads():
    one = drawn(LP_NUM_THREADS="1", NUMBA_NUM_THREADS="1", OMP_NUM_THREADS="1")
    assert len(one) == 64
    assert one == drawn(LP_NUM_THREADS="2", NUMBA_NUM_THREADS="2", OMP_NUM_THREADS="2")


def loads(library):
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


@pytest.mark.skipif(
    not (loads("libEGL.so.1") and loads("libOSMesa.so.8")), reason="one of both is not installed"
)
def test_egl_or_osmesa():
    osmesa = "from seatlook.pbr import backend; backend._egl = backend._system_osmesa"
    names = [drawn(first, code="print(offscreen_backend().window)") for first in ("", osmesa)]
    assert names == ["vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
    assert drawn() == drawn(osmesa)
