"""A picture of 3840 x 2160 in `high` as the first of a process."""

import subprocess
import sys

import pytest

pytestmark = [pytest.mark.validate, pytest.mark.render]
PROGRAM = """
import resource
import numpy as np
from seatlook.model import Appearance, Rig, named_view, sun
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import sheet

camera = named_view("front_34", target=np.zeros(3), size=(3840, 2160), distance=2.5)
studio = Studio(sheet(lambda x, y: 0.01 * np.sin(60 * x), steps=60))
rig = Rig(name="r", lights=(sun(elevation_deg=30, azimuth_deg=30),), ambient=1000.0)
look = Appearance(albedo=np.full(3, 0.3), roughness=0.4)
image = studio.render(look, rig=rig, camera=camera, quality="high")
shown = image.to_srgb()
assert shown.shape == (2160, 3840, 3) and shown.std() > 1
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20)
"""


def test_a_large_picture_in_high_comes_first_and_takes_less_than_2_gb():
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM], cwd="tests", capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr[-2000:]
    print(f"{float(run.stdout):.2f} GB")
    assert float(run.stdout) <= 2.0
