"""What a process holds after many pictures, and after many covers."""

from __future__ import annotations

import gc
import json
import subprocess
import sys
import weakref
from pathlib import Path

import numpy as np
import pytest

from seatlook.model import Rig, bulb
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import above, sheet

PICTURES, WARM = 500, 60
# What the process may hold more at the end than once the cache is full [MB], by the trend
# of all pictures, and in all: the allocator takes two or three more in one step, now and then.
GROWTH, STEP = 2.0, 8.0
CODE = """
import json
from pathlib import Path
import numpy as np
from support.reference.lit_sheets import above, sheet
from seatlook.model import Appearance, Rig, TextureMaps, bulb, sun
from seatlook.pbr.shading.studio import Studio

def held():
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6

random = np.random.default_rng(0)
studio = Studio(sheet(lambda x, y: 0.01 * np.sin(60 * x), steps=16, element_size=1e-3))
camera = above(size=(48, 32), fov=10.0)
textures = ("none", "leather", "suede", "weave")
rss = []
for k in range({pictures}):
    maps = None
    if k % 3 == 0:
        pixels = random.integers(0, 255, (256, 256, 3)).astype(np.uint8)
        maps = TextureMaps(folder="made", width=0.1, height=0.1, albedo=pixels)
    look = Appearance(
        albedo=random.random(3), roughness=0.2 + 0.6 * random.random(), texture=textures[k % 4],
        texture_depth=1e-4, sheen=random.random(3), coat=random.random(), maps=maps,
    )
    if k % 2:
        light = sun(elevation_deg=20 + 60 * random.random(), azimuth_deg=360 * random.random())
    else:
        light = bulb(position_mm=tuple(random.uniform((-300, -300, 200), (300, 300, 600))))
    sky = np.full((8, 16, 3), 50 + 100 * random.random()) if k % 50 == 0 else None
    rig = Rig(name="one", lights=(light,), panorama=sky)
    image = studio.render(look, rig=rig, camera=camera, quality="standard")
    image.to_png()
    rss.append(held())
print(json.dumps(rss))
"""


@pytest.mark.validate
@pytest.mark.render
@pytest.mark.skipif(
    not Path("/proc/self/statm").is_file(), reason="resident memory as Linux has it"
)
def test_memory_stays_flat_over_500_pictures():
    run = subprocess.run(
        [sys.executable, "-c", CODE.replace("{pictures}", str(PICTURES))],
        capture_output=True, text=True, check=False, timeout=1800,
        cwd=Path(__file__).parents[2],
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    rss = json.loads(run.stdout)
    assert len(rss) == PICTURES
    print(f"{rss[0]:.1f} MB after 1, {rss[WARM]:.1f} after {WARM}, {rss[-1]:.1f} after {PICTURES}")
    later = np.array(rss[WARM:])
    first, second = np.triu_indices(len(later), 1)
    slope = np.median((later[second] - later[first]) / (second - first))
    assert slope * len(later) < GROWTH
    assert later.max() - later[0] < STEP


@pytest.mark.render
def test_a_studio_goes_at_once_with_all_it_kept():
    """Python's collector counts objects: of 40 MB arrays in a cycle it would see a dozen."""
    cover = sheet(lambda x, y: 0.01 * np.sin(60 * x), steps=8, element_size=1e-3)
    rig = Rig(name="bulb", lights=(bulb(position_mm=(100, 100, 400)),))

    def used() -> Studio:
        studio = Studio(cover)
        studio.render(rig=rig, camera=above(size=(48, 32), fov=10.0))
        return studio

    used()  # compiling kernels leaves tracebacks that hold on to what called them
    gc.disable()
    try:
        studio = used()
        owner, cache = weakref.ref(studio), weakref.ref(studio._cache)
        del studio
        assert owner() is None
        assert cache() is None
    finally:
        gc.enable()
