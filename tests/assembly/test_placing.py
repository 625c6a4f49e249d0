import dataclasses
from types import MappingProxyType

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.assembly.placing import with_poses
from seatlook.errors import InputError
from seatlook.solver import solve
from seatlook.solver.foam.distance import distance_field
from support import scenes


def without(*names):
    scene = scenes.two_panels(element_size=0.02)
    poses = {n: p for n, p in scene.placement.items() if n not in names}
    return dataclasses.replace(scene, placement=MappingProxyType(poses))


def test_stated_poses_stay():
    scene = without()
    assert with_poses(scene) is scene
    one = with_poses(without("RIGHT"))
    np.testing.assert_array_equal(
        one.placement["LEFT"].translation, scene.placement["LEFT"].translation
    )


def test_panels_without_a_pose_start_clear_of_the_foam_and_can_be_sewn():
    bare = without("LEFT", "RIGHT")
    # The layout lies over the middle of the foam, the wire and rail elsewhere: sewing alone.
    scene = dataclasses.replace(bare, hooks=(), frames=())
    cover = assemble(scene)
    field = distance_field(scene.foam.vertices, scene.foam.faces)
    distance, _ = field.at(cover.positions)
    assert distance.min() > 0.005
    solution = solve(cover)
    assert solution.status == "converged", solution.reason
    assert solution.figures["seam_gap_max"] < 1e-4


def test_a_panel_sewn_to_none_is_named():
    bare = without("LEFT", "RIGHT")
    loose = dataclasses.replace(bare.pattern, seams=())
    with pytest.raises(InputError, match="none that joins RIGHT to LEFT"):
        with_poses(dataclasses.replace(bare, pattern=loose))
