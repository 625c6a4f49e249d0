"""Fixtures that several rooms share."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pytest

# Run once by hand, with packages that the project does not need.
collect_ignore = ["support"]


def pytest_configure(config: pytest.Config) -> None:
    """Keep what is cached between runs out of the user's folder, and his out of the tests."""
    folder = tempfile.TemporaryDirectory(prefix="seatlook-")
    os.environ["SEATLOOK_CACHE_DIR"] = folder.name
    config.add_cleanup(folder.cleanup)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the files that take longest first."""
    items.sort(key=lambda item: item.get_closest_marker("first") is None)


@pytest.fixture(scope="session")
def demo_scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the demo's files, spoiled, on a coarse mesh; return its scene file."""
    from seatlook.seats import write_demo

    folder = tmp_path_factory.mktemp("demo")
    write_demo(
        folder,
        ease={},
        short={"REAR": 0.01},
        material="leather-laminate",
        insert="suede-laminate",
        element_size_mm=20.0,
        seed=3,
        surface_size=0.02,
    )
    return folder / "scene.toml"
