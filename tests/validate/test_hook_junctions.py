"""Rings of a horseshoe pull alike left and right of the junctions of its seams."""

import numpy as np
import pytest

import seatlook
from seatlook import mesh
from seatlook.seats import write_demo

pytestmark = pytest.mark.validate


def test_pull_per_length_is_the_same_on_both_sides(tmp_path):
    write_demo(tmp_path, shape="horseshoe")
    scene = seatlook.load_scene(tmp_path / "scene.toml")
    solution = seatlook.solve(seatlook.assemble(scene), strict=True)
    (hook,) = (h for h in scene.hooks if h.chain)
    anchor = next(a for a in solution.cover.anchors if a.name == hook.name)
    force = solution.forces[hook.name]
    pull = np.linalg.norm(force, axis=1) / anchor.length
    near = {seam.name: seam.a for seam in scene.pattern.seams}
    ends = np.cumsum([scene.pattern.edge_length(near[line]) for line in hook.chain])
    assert len(ends) == 7
    for end in ends[:-1]:
        k = int(np.abs(anchor.at - end).argmin())
        assert anchor.at[k] == pytest.approx(end, abs=1e-6)
        assert pull[k - 2 : k].mean() == pytest.approx(pull[k + 1 : k + 3].mean(), rel=0.1)
    place = anchor.wire.nearest(anchor.points.at(solution.positions))
    assert (np.diff(place) > 0.0).all()
    along = np.einsum("ij,ij->i", force, mesh.directions_at(anchor.wire.curve, place))
    assert np.abs(along).sum() < 0.01 * np.linalg.norm(force, axis=1).sum()
