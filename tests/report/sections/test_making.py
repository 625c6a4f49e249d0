import dataclasses

import pytest

from seatlook.assembly import assemble
from seatlook.report.page.write import page_html
from seatlook.report.sections.making import making_section
from seatlook.solver import solve
from support import scenes
from support.pages import page_data


@pytest.fixture(scope="module")
def solution():
    scene = scenes.two_panels(gap=0.004, element_size=0.02)
    (hook,) = scene.hooks
    hook = dataclasses.replace(hook, pitch=0.05, limit=1e-6)
    return solve(assemble(dataclasses.replace(scene, hooks=(hook,))))


def test_hooks_and_work_are_tabled(solution, tmp_path):
    made = making_section(solution, tmp_path)
    (row,) = made.hooks.rows
    cells = dict(zip(made.hooks.heads, row, strict=True))
    assert cells["rings"] == 3
    assert cells["mean of a ring [N]"] == pytest.approx(cells["pull in all [N]"] / 3)
    assert cells["hardest [N]"] >= cells["mean of a ring [N]"] > 0
    assert len(made.over) == 1
    share = {name: percent for name, _, percent in made.work.rows}
    brought = ("work of seams, hooks and frame", "work of the weight")
    brought += ("stored in the uneven panels at the start",)
    assert sum(share[name] for name in brought) == pytest.approx(100)
    assert sum(share.values()) - share["left over"] == pytest.approx(share["left over"])
    assert share["stored in the uneven panels at the start"] > 0
    assert -100 <= share["damping by the time steps"] < 0
    assert abs(share["left over"]) < 5
    assert made.pictures == ()


def test_page_shows_the_section_and_the_pictures_in_its_folder(solution, tmp_path):
    data = page_data(tmp_path)
    (tmp_path / "timeline.png").write_bytes(b"x")
    made = making_section(solution, tmp_path)
    assert made.pictures == ("timeline.png",)
    text = page_html(dataclasses.replace(data, making=made))
    assert 'src="timeline.png"' in text
    assert "timeline.gif" not in text
    (tmp_path / "timeline.gif").write_bytes(b"x")
    made = making_section(solution, tmp_path)
    assert made.pictures == ("timeline.png", "timeline.gif")
    moving = page_html(dataclasses.replace(data, making=made))
    # It moves only when asked to.
    assert '<details>\n<summary>Moving</summary>\n<img class="own" src="timeline.gif"' in moving
    assert made.over[0] in text
    assert 'id="making"' not in page_html(data)
