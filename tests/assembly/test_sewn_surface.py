"""What sewn panels make, known without a pose: a disc, a sphere, or something with handles."""

from __future__ import annotations

import dataclasses
from itertools import combinations
from types import MappingProxyType

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly.sewn_surface import exchanged, sewn_surface
from seatlook.seats import write_demo
from support.boxes import box_scene
from support.scenes import edge, rectangle, two_panels


def surface(pattern):
    return sewn_surface(pattern, pattern.seams)


def degrees(pattern):
    return sorted(round(np.degrees(angle)) for _, angle in surface(pattern).points)


def swapped(pattern, i, j):
    seams = list(pattern.seams)
    one, two = seams[i], seams[j]
    seams[i], seams[j] = dataclasses.replace(one, b=two.b), dataclasses.replace(two, b=one.b)
    return dataclasses.replace(pattern, seams=tuple(seams))


def pattern_of(panels, edges, seams):
    return model.Pattern(
        panels=tuple(panels), edges=MappingProxyType(dict(edges)), seams=tuple(seams)
    )


def pillow():
    """Two squares sewn all round, one of them seen from behind."""
    edges = [edge(f"{p}.{k}", p, k, (k + 1) % 4) for p in "AB" for k in range(4)]
    seams = [model.Seam(name=f"{k}", a=f"A.{k}", b=(f"B.{(4 - k) % 4}",)) for k in range(4)]
    return pattern_of([rectangle(p, 0.4, 0.4) for p in "AB"], edges, seams)


def tube():
    """A strip sewn to a ring by its ends."""
    edges = [edge("S.right", "S", 1, 2), edge("S.left", "S", 3, 0)]
    return pattern_of(
        [rectangle("S", 0.9, 0.1)], edges, [model.Seam(name="close", a="S.right", b=("S.left",))]
    )


def t_junction():
    """One panel above two that are sewn to each other."""
    edges = [
        edge("A.low", "A", 0, 1),
        edge("L.top", "L", 2, 3),
        edge("R.top", "R", 2, 3),
        edge("L.right", "L", 1, 2),
        edge("R.left", "R", 3, 0),
    ]
    seams = [
        model.Seam(name="across", a="A.low", b=("L.top", "R.top")),
        model.Seam(name="down", a="L.right", b=("R.left",)),
    ]
    panels = [rectangle("A", 0.4, 0.1), rectangle("L", 0.25, 0.2), rectangle("R", 0.15, 0.2)]
    return pattern_of(panels, edges, seams)


def test_flat_pieces_and_boxes():
    assert degrees(two_panels().pattern) == [180, 180]
    assert degrees(box_scene(spacing=0.05).pattern) == 4 * [180] + 4 * [270]
    assert degrees(t_junction()) == 3 * [180] + [360]


def test_closed_pieces_and_rings():
    assert degrees(pillow()) == 4 * [180]
    assert degrees(tube()) == [180, 180]
    for pattern in (pillow(), tube(), t_junction()):
        assert surface(pattern).covers()
        assert exchanged(pattern) == ([], [])


def test_opposite_partners_of_a_pillow_make_a_handle():
    pattern = swapped(pillow(), 0, 2)
    assert surface(pattern).handles == 1
    names = [{one.name, two.name} for one, two in exchanged(pattern)[0]]
    assert {"0", "2"} in names


def gusset():
    """Two faces with a strip between them; with exchanged partners they are sewn to each other."""
    edges = [edge("F.rim", "F", 1, 0), edge("B.rim", "B", 1, 0)]
    edges += [edge("G.front", "G", 0, 1), edge("G.back", "G", 2, 3)]
    seams = [
        model.Seam(name="front", a="F.rim", b=("G.front",)),
        model.Seam(name="back", a="G.back", b=("B.rim",)),
    ]
    panels = [rectangle("F", 0.28, 0.17), rectangle("B", 0.28, 0.17), rectangle("G", 0.62, 0.1)]
    return pattern_of(panels, edges, seams)


def test_a_strip_between_two_faces_that_is_sewn_to_itself():
    assert surface(gusset()).parts == 1
    assert exchanged(gusset()) == ([], [])
    wrong = swapped(gusset(), 0, 1)
    assert surface(wrong).parts == 2
    certain, likely = exchanged(wrong)
    assert certain == []
    assert [{one.name, two.name} for one, two in likely] == [{"front", "back"}]


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    from seatlook import io

    folder = tmp_path_factory.mktemp("demo")
    write_demo(folder, element_size_mm=20.0)
    return io.load_scene(folder / "scene.toml").pattern


@pytest.mark.parametrize("shape", ["demo", "box"])
def test_every_exchange_of_seams_of_one_length_is_found(shape, request):
    pattern = demo_or_box(shape, request)
    assert surface(pattern).covers()

    def lengths(seam):
        return [pattern.edge_length(seam.a), sum(map(pattern.edge_length, seam.b))]

    pairs = [
        (i, j)
        for i, j in combinations(range(len(pattern.seams)), 2)
        if np.allclose(lengths(pattern.seams[i]), lengths(pattern.seams[j]), rtol=1e-3)
    ]
    assert len(pairs) >= 6
    for i, j in pairs:
        wrong = swapped(pattern, i, j)
        assert not surface(wrong).covers()
        right = {pattern.seams[i].name, pattern.seams[j].name}
        assert right in [{one.name, two.name} for one, two in exchanged(wrong)[0]]


def demo_or_box(shape, request):
    return request.getfixturevalue("demo") if shape == "demo" else box_scene(spacing=0.05).pattern
