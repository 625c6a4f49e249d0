"""The drawing of a cover before it is solved: every seam, hook and frame by number, and faults."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from PIL import Image

from seatlook.assembly import assemble
from seatlook.assembly.contradictions import contradictions
from seatlook.report.assembly_picture import draw_assembly
from support.boxes import box_scene
from support.scenes import two_panels

pytestmark = pytest.mark.render

WRONG = (214, 0, 0)


def drawn(scene, path):
    cover = assemble(scene)
    lines = draw_assembly(scene, cover, contradictions(scene, cover), path)
    return lines, np.asarray(Image.open(path))


def count(picture, colour):
    return int((picture == colour).all(axis=-1).sum())


@pytest.mark.parametrize(
    "size", [(0.28, 0.13, 0.176), (0.5, 0.5, 0.1), (0.45, 0.12, 0.65), (0.02, 0.02, 0.4)]
)
def test_every_line_has_a_number_of_its_own(tmp_path, size):
    scene = box_scene(size, radius=0.1 * min(size), spacing=0.02, element_size=0.02)
    lines, picture = drawn(scene, tmp_path / "a.png")
    assert [line.number for line in lines] == [*"12345678", "F1", "F2", "F3", "F4"]
    assert {line.name for line in lines if line.kind == "seam"} == {
        seam.name for seam in scene.pattern.seams
    }
    assert picture.shape[1] == 1400
    assert count(picture, WRONG) == 0


def test_gaps_are_those_of_the_start(tmp_path):
    lines, _ = drawn(two_panels(gap=0.02), tmp_path / "a.png")
    (seam,) = (line for line in lines if line.kind == "seam")
    # Imperfections of the panels are some tenths of a millimetre across them.
    assert seam.gap == pytest.approx(0.02, rel=0.02)
    assert [line.target for line in lines] == ["", "wire", "rail"]
    (hook,) = (line for line in lines if line.kind == "hook")
    assert hook.gap == pytest.approx(0.0044, abs=5e-4)


def test_faults_are_marked_and_written(tmp_path):
    scene = box_scene(spacing=0.02)
    seams = list(scene.pattern.seams)
    seams[0] = dataclasses.replace(seams[0], reverse=False)
    pattern = dataclasses.replace(scene.pattern, seams=tuple(seams))
    _, good = drawn(scene, tmp_path / "good.png")
    _, bad = drawn(dataclasses.replace(scene, pattern=pattern), tmp_path / "bad.png")
    assert count(good, WRONG) == 0
    assert count(bad, WRONG) > 500
    assert bad.shape[0] > good.shape[0]  # what is wrong is written below


def test_a_cover_without_foam_is_drawn(tmp_path):
    scene = two_panels()
    cover = dataclasses.replace(assemble(scene), foam=None)
    draw_assembly(scene, cover, (), tmp_path / "a.png")
    assert np.asarray(Image.open(tmp_path / "a.png")).std() > 5
