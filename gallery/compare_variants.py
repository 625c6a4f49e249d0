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

from seatlook import compare
from seatlook.cli import run
from seatlook.comparison.widgets import sliders

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
sliders(comparison)

# %% [markdown]
# ## The index in three dimensions
#
# Any index of the registry, turned by PyVista.

# %%
comparison.variants["eased"].view_3d("w2", size=(width, width * 9 // 16)).show(
    jupyter_backend="static"
)
