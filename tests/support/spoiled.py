"""The demo with one seam spoiled, solved once for everything that is measured on it."""

import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.seats import write_demo
from seatlook.solver import solve


@pytest.fixture(scope="session")
def spoiled(tmp_path_factory):
    """Scene and solution of the demo in plain leather, one sewing line 4 % too long."""
    folder = tmp_path_factory.mktemp("eased")
    write_demo(
        folder,
        ease={"INSERT-BOLSTER_L": 0.04},
        short={},
        tension=0.005,
        material="black-leather",
        insert="black-leather",
        element_size_mm=7.0,
        seed=0,
    )
    scene = io.load_scene(folder / "scene.toml")
    return scene, solve(assemble(scene))
