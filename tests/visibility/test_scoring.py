"""The score of a scene: limits by zone and class, refusal, and what page and command say of it."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Foam, Limit, WrinkleMap, ZoneBox
from seatlook.report.sections.score import (
    cause_table,
    draw_maps,
    grid_table,
    height_text,
    score_checks,
    score_values,
    sentences,
    zone_table,
)
from seatlook.visibility.concentration import CONCENTRATED
from seatlook.visibility.observer import VISIBLE
from seatlook.visibility.scoring import score_scene
from seatlook.visibility.view import View
from support import scenes
from support.reference.lit_sheets import flat
from support.seen.covers import BLACK, COARSE, RIG, ROUGH, block, oblique
from visibility.test_view import wrinkled

pytestmark = pytest.mark.render
__all__ = ["wrinkled"]  # the fixture


def foam_under(solution, top, steps):
    vertices, faces = block(lambda x, y: top(x, y) - 0.0005, steps)
    foam = Foam(vertices=vertices, faces=faces, material=scenes.foam_material())
    return replace(solution, cover=replace(solution.cover, foam=foam))


def scene(**change):
    box = ZoneBox(
        name="left interior", panel="LEFT", low=np.zeros(2), high=np.ones(2), visibility="A"
    )
    base = replace(
        scenes.two_panels(),
        rigs=(RIG,),
        cameras=(oblique((320, 240)),),
        textures=MappingProxyType({"black": BLACK, "rough": ROUGH}),
        boxes=(box,),
    )
    return replace(base, **change)


def indices(solution):
    one = np.ones(len(solution.cover.faces))
    return WrinkleMap(c=one, w1=one, w2=one, r_stretch=one, w_stretch=one, w_compression=0 * one)


def scored_of(scene, solution):
    view = View(solution, scene.cameras[0], sampling=COARSE)
    return score_scene(scene, view, indices(solution))


LIMITS = (
    Limit(zone="A", measure="vwi", maximum=0.01),
    Limit(zone="right interior", measure="equivalent_height_mm", maximum=1e9),
    Limit(zone="right interior", measure="w2_mean", maximum=1.0),
)


@pytest.fixture(scope="module")
def scored(wrinkled):
    solution = foam_under(wrinkled, flat, 20)
    return scored_of(scene(limits=LIMITS), solution)


def test_limits_of_a_class_and_of_a_zone(scored):
    first, second = scored.verdicts
    assert not scored.accepted
    cells = [sight.zones["left interior"] for sight in scored.grid.sights.values()]
    assert first.value == max(cells) > 0.01
    heights = [
        scored.zone_height("right interior", texture, "sun") for texture in ("black", "rough")
    ]
    assert second.kept == (second.resolved and bool(np.isfinite(second.value)))
    assert second.value == pytest.approx(1e3 * max(heights))
    assert [c.kept for c in score_checks(scored)] == [False, second.kept]


def test_all_say_the_same(scored):
    values = score_values(scored)
    assert values["worst_rig"] == {"black": "sun", "rough": "sun"}
    assert values["least_visible"] == scored.grid.least_visible
    assert values["cells"][0]["vwi"] == scored.grid.vwi[0, 0]
    assert values["cells"][0]["vwi_compression"] is None
    assert values["cells"][0]["vwi_stretch"] == pytest.approx(scored.grid.vwi[0, 0])
    assert values["null_vwi"] == scored.null < 0.1
    heads, rows = grid_table(scored).heads, grid_table(scored).rows
    assert heads == ("VWI, height", "sun", "mean", "worst rig")
    assert [row[0] for row in rows] == ["black", "rough", "mean", "worst texture"]
    assert rows[3][1] == scored.grid.worst_texture("sun")
    assert len(cause_table(scored).rows) == 2
    assert {row[0] for row in zone_table(scored).rows} == {"left interior", "right interior"}
    lines = list(sentences(scored))
    least = scored.grid.least_visible
    assert lines[0] == (
        f"Least visible texture under these lights: {least}."
        if least
        else "No texture can be told to be the least visible: the measures disagree."
    )
    assert any(line.startswith("Waves shorter than 12.5 mm are left out") for line in lines)
    assert any(line.startswith("Compare equivalent heights within one texture") for line in lines)
    assert values["cells"][0]["share_in_top_pixels"] < CONCENTRATED
    assert any("the yardstick of equivalent heights" in line for line in lines)
    for zone, height in values["visible_from_mm"].items():
        ladder = scored.ladder.zones[zone]
        if height is None:
            assert ladder.vwi.max() < VISIBLE
        else:
            assert np.interp(1e-3 * height, ladder.heights, ladder.vwi) == pytest.approx(VISIBLE)
    assert ("Not separable" in " ".join(lines)) == bool(scored.grid.not_separable())


def test_maps_of_visibility_share_one_range(scored, tmp_path):
    views = draw_maps(scored, scored.grid.sights, tmp_path)
    assert [v.image for v in views] == [f"maps/visibility-{n}-sun.png" for n in ("black", "rough")]
    assert len({(v.low, v.high) for v in views}) == 1
    assert all((tmp_path / v.image).stat().st_size > 1000 for v in views)


def test_heights_above_the_ladder_say_so():
    assert height_text(float("inf"), 0.001) == "> 1 mm"
    assert height_text(0.00005, 0.001) == "0.0500 mm"


def test_a_limit_on_a_zone_out_of_view_is_refused(wrinkled):
    solution = foam_under(wrinkled, flat, 20)
    limits = (Limit(zone="B", measure="vwi", maximum=1.0),)
    with pytest.raises(InputError, match=r"accept\.B\.vwi: got no pixel of it in view oblique"):
        scored_of(scene(limits=limits), solution)


def test_over_a_foam_as_rough_as_wrinkles_no_score_is_given(wrinkled):
    """A noisy scan: no cover can be laid on it smoothly, so no reference could be trusted."""
    noise = np.random.default_rng(0)
    solution = foam_under(wrinkled, lambda x, y: 0.004 * noise.normal(size=x.shape), 60)
    with pytest.raises(InputError, match=r"got (VWI|no pixel of the zones)"):
        scored_of(scene(), solution)
