"""Work in parts on threads: all of it, in order, the same for any number."""

import numpy as np
import pytest

from seatlook.model import Appearance, Rig, bulb, named_view, sun
from seatlook.pbr.kernels import parts
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import sheet


def with_threads(monkeypatch, count):
    monkeypatch.setattr(parts.numba.config, "NUMBA_NUM_THREADS", count)


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 7, 100])
def test_parts_are_all_of_it_in_order(monkeypatch, threads, count):
    with_threads(monkeypatch, threads)
    got = parts.in_parts(count, lambda first, last: list(range(first, last)), least=3)
    assert [i for part in got for i in part] == list(range(count))


def test_one_thread_where_the_environment_says_so(monkeypatch):
    """As in the workers of a pool, which share the cores among themselves already."""
    with_threads(monkeypatch, 1)
    assert parts.in_parts(1000, lambda first, last: (first, last)) == [(0, 1000)]


@pytest.mark.render
def test_the_same_bytes_for_any_number_of_threads(monkeypatch):
    def picture(threads):
        with_threads(monkeypatch, threads)
        studio = Studio(sheet(lambda x, y: 0.01 * np.sin(60 * x), steps=40))
        look = Appearance(albedo=np.full(3, 0.3), texture="leather", texture_depth=1e-4)
        lights = (sun(elevation_deg=40, azimuth_deg=30), bulb(position_mm=(100, 0, 300)))
        camera = named_view("front_34", target=np.zeros(3), size=(96, 64), distance=0.3)
        rig = Rig(name="r", lights=lights, ambient=50.0)
        return studio.render(look, rig=rig, camera=camera).radiance.tobytes()

    one = picture(1)
    assert picture(2) == one
    assert picture(3) == one
