"""Boxes of several proportions, closed covers all round: the same contradictions on other seats."""

import dataclasses

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly import assemble
from seatlook.assembly.contradictions import contradictions
from seatlook.chain.case import Case
from seatlook.errors import InputError
from support.boxes import SIDES, box_scene

BOXES = {
    "headrest": {"size": (0.28, 0.13, 0.176)},
    "box cushion": {"size": (0.5, 0.5, 0.1), "radius": 0.01},
    "standing back": {"size": (0.45, 0.12, 0.65), "radius": 0.04},
}


@pytest.fixture(params=BOXES)
def box(request):
    """A box of the given size on a coarse mesh."""
    return box_scene(**BOXES[request.param], spacing=0.02, element_size=0.02)


def refused(scene):
    """Names of what is refused."""
    return {one.name for one in contradictions(scene, assemble(scene))}


def sewn(scene, change):
    """The scene with other seams."""
    seams = change(list(scene.pattern.seams))
    return dataclasses.replace(
        scene, pattern=dataclasses.replace(scene.pattern, seams=tuple(seams))
    )


def with_curve(scene, name, points):
    foam = dataclasses.replace(scene.foam, curves={**scene.foam.curves, name: points})
    return dataclasses.replace(scene, foam=foam)


def test_boxes_contradict_nothing(box):
    assert refused(box) == set()


@pytest.mark.parametrize("seam", range(8))
def test_a_twisted_seam_of_a_box(box, seam):
    def twist(seams):
        seams[seam] = dataclasses.replace(seams[seam], reverse=False)
        return seams

    assert "twisted seam" in refused(sewn(box, twist))


@pytest.mark.parametrize("pair", [(0, 4), (2, 6), (1, 3), (1, 5), (3, 7)])
def test_exchanged_partners_of_a_box(box, pair):
    one, two = pair

    def exchange(seams):
        a, b = seams[one], seams[two]
        seams[one], seams[two] = dataclasses.replace(a, b=b.b), dataclasses.replace(b, b=a.b)
        return seams

    assert "exchanged seams" in refused(sewn(box, exchange))


@pytest.mark.parametrize(
    ("partners", "what"),
    [
        ((0, 2, 4), "a surface with 1 handle;"),
        ((1, 5, 3), "degrees at the point where these meet:"),
    ],
)
def test_seams_that_no_exchange_mends_are_refused_with_places(partners, what):
    """Three seams have each other's partners, one after the other."""
    one, two, three = partners
    box = box_scene(**BOXES["headrest"], spacing=0.02, element_size=0.02)

    def pass_on(seams):
        b = [seams[k].b for k in (two, three, one)]
        for k, partner in zip(partners, b, strict=True):
            seams[k] = dataclasses.replace(seams[k], b=partner)
        return seams

    scene = sewn(box, pass_on)
    found = [c for c in contradictions(scene, assemble(scene)) if what in c.problem.got]
    assert len(found) == 1
    assert len(found[0].places) > 1
    assert found[0].problem.got.count(") mm") == len(found[0].places)
    assert found[0].problem.key != "seam[1]"


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("apart", [0.032, 0.040])
def test_frame_curves_of_a_box_that_part(box, side, apart):
    name = f"rim {side}"
    moved_curve = box.foam.curves[name] - [0.0, 0.0, apart]
    assert "ties apart" in refused(with_curve(box, name, moved_curve))


def test_edges_of_one_frame_in_a_wrong_order(box):
    """A ring of four edges on one curve, two of them exchanged."""
    ring = np.concatenate([box.foam.curves[f"rim {side}"][:1] for side in SIDES])
    box = with_curve(box, "ring", np.vstack([ring, ring[:1]]))
    frame = dataclasses.replace(
        box.frames[0], name="ring", edges=tuple(f"{s}.free" for s in SIDES), curve="ring"
    )
    good = dataclasses.replace(box, frames=(frame,))
    wrong = dataclasses.replace(frame, edges=(*frame.edges[:2], frame.edges[3], frame.edges[2]))
    # Sides of two lengths do not go to the corners of the ring at their shares; see the places.
    assert "ties apart" not in refused(good)
    assert "ties apart" in refused(dataclasses.replace(box, frames=(wrong,)))


@pytest.mark.parametrize("deep", [0.02, 0.04])
def test_a_curve_through_the_foam_of_a_box(box, deep):
    low, high = box.foam.curves["rim FRONT"]
    middle = 0.5 * (low + high) + [0.0, deep, deep]
    assert "curve inside" in refused(with_curve(box, "rim FRONT", np.stack([low, middle, high])))


def test_hooks_of_a_box_to_the_other_side_and_two_millimetres_apart(box):
    depth = np.ptp(box.foam.vertices[:, 1])
    line = box.foam.curves["rim FRONT"] + [0.0, 0.0, np.ptp(box.foam.vertices[:, 2])]
    wires = {"near": line, "far": line + np.array([0.0, depth, 0.0])}
    for name, points in wires.items():
        box = with_curve(box, name, points)
    hook = model.Hook(name="front", line="TOP-FRONT", wire="near", stage="cover")
    good = dataclasses.replace(box, hooks=(hook,), frames=())
    assert refused(good) == set()
    far = dataclasses.replace(good, hooks=(dataclasses.replace(hook, wire="far"),))
    # The front hook's line and the back one's share the corners' panels but no point.
    both = (hook, dataclasses.replace(hook, name="back", line="TOP-BACK", wire="far"))
    swapped = tuple(
        dataclasses.replace(h, wire=w) for h, w in zip(both, ("far", "near"), strict=True)
    )
    assert refused(dataclasses.replace(good, hooks=both)) == set()
    assert "hook far" in refused(dataclasses.replace(good, hooks=swapped))
    assert "hook far" in refused(far) or depth < 0.1
    again = with_curve(good, "shifted", line + np.array([0.0, 0.0, 0.002]))
    hooks = (hook, dataclasses.replace(hook, name="again", line="FRONT-RIGHT", wire="shifted"))
    assert "ties apart" in refused(dataclasses.replace(again, hooks=hooks))


@pytest.mark.parametrize("factor", [0.1, 10.0])
def test_a_box_with_a_pattern_out_of_scale(box, factor):
    panels = tuple(
        dataclasses.replace(panel, outline=factor * panel.outline) for panel in box.pattern.panels
    )
    scene = dataclasses.replace(box, pattern=dataclasses.replace(box.pattern, panels=panels))
    with pytest.raises(InputError) as caught:
        Case(scene).check()
    assert any('allow = ["scale"]' in problem.hint for problem in caught.value.problems)
