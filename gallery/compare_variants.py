# ---
# jupyter:
#   jupytext:
#     formats: py:percent
# ---

# %% [markdown]
# # Two ways to sew one seat
#
# The same cover twice: as it fits, and with one sewing line 4 % too long. Everything below is
# seen from one camera, at one exposure per light, and in one range of colours.
#
# Open this file in Jupyter with jupytext, or run it: `python gallery/compare_variants.py`.

# %%
import os
import tempfile
from pathlib import Path

import pyvista

from seatlook import compare, io, pbr
from seatlook.cli import run

folder = Path(os.environ.get("SEATLOOK_NOTEBOOK", tempfile.mkdtemp()))
coarse = os.environ.get("SEATLOOK_ELEMENT_SIZE_MM", "10")
width = int(os.environ.get("SEATLOOK_WIDTH", "640"))

# %% [markdown]
# ## Make both scenes
#
# `seatlook demo` writes a scene and solves it; the results are kept, so that this notebook opens
# again without solving.

# %%
for name, words in {"fits": [], "eased": ["--ease", "INSERT-BOLSTER_L=4%"]}.items():
    if not (folder / name / "scene.toml").exists():
        size = ["--element-size-mm", coarse]
        run(["demo", "--out", str(folder / name), "--files-only", "--quiet", *size, *words])

# %%
changes = [f"camera.size=[{width}, {width * 9 // 16}]", 'camera.views=["front_34"]']
changes += ['gallery.textures=["black-leather", "suede"]']
comparison = compare(
    {name: folder / name / "scene.toml" for name in ("fits", "eased")},
    changes=changes,
    keep=folder / "results",
)
comparison

# %% [markdown]
# ## Where they differ
#
# Zones by variants, the largest difference first.

# %%
comparison.table("w_compression_mean")

# %%
comparison.show(("fits", "black-leather", "bulb left"), ("eased", "black-leather", "bulb left"))

# %% [markdown]
# ## Any picture, by its names

# %%
comparison["eased", "suede", "sun"]

# %%
comparison.map("eased", "w2")

# %% [markdown]
# ## Sliders
#
# They need the extra `seatlook[notebook]`; everything above does not.

# %%
sliders = comparison.sliders()
sliders

# %% [markdown]
# ## The index in three dimensions
#
# The exported surface carries strains and indices per element; PyVista turns it round.

# %%
pbr.offscreen_backend()
eased = comparison.variants["eased"]
io.export_cover(eased.solution, eased.indices, folder / "eased.vtp")
plotter = pyvista.Plotter(off_screen=True, window_size=(width, width * 9 // 16))
plotter.add_mesh(pyvista.read(folder / "eased.vtp"), scalars="_W2", cmap="viridis")
plotter.camera_position = [(0.9, -1.2, 0.9), (0.0, 0.0, 0.05), (0.0, 0.0, 1.0)]
plotter.show(jupyter_backend="static")
