"""The page of a correction."""

import re
from html import unescape

import pytest
from PIL import Image

from seatlook import io
from seatlook.assembly import assemble
from seatlook.chain.assess import assess
from seatlook.chain.case import Case
from seatlook.improvement.changes import Changes
from seatlook.improvement.corrected import length_rows, rows_made
from seatlook.improvement.loop import Iteration
from seatlook.improvement.moves import Move
from seatlook.improvement.objective import Parts
from seatlook.improvement.proof import Proof
from seatlook.report.improvement_page import PAGE, PICTURES, Corrected, write_improvement_page
from seatlook.report.pattern_drawing import draw_changes
from seatlook.solver import solve

MM = 1e-3
LINE = "INSERT.BOLSTER_L"


def parts(total):
    return Parts(w2=0.5 * total, strain=0.3 * total, gap=0.2 * total)


@pytest.fixture(scope="module")
def page(demo_scene, tmp_path_factory):
    """A page whose seats are one and the same; the pattern is changed by 3 mm and what follows."""
    folder = tmp_path_factory.mktemp("corrected")
    scene = io.load_scene(demo_scene)
    assessment = assess(solve(assemble(scene)))
    changes = Changes(assessment.solution, scene.pattern)
    line = next(c for c in changes.partners._lengths if c.name == LINE)
    follows = changes.partners.followers(line)
    move = Move(
        kind="length", names=(LINE,), places=(("", ""),), share={line: 1.0}, follows=follows
    )
    made = move.amounts(-3 * MM)
    after = changes.pattern(made)
    steps = [
        Iteration(number=0, value=parts(0.05), beyond=0.05),
        Iteration(
            number=1, value=parts(0.03), beyond=0.03, made=made, chosen=(move,), sentence="made it"
        ),
        Iteration(
            number=2, value=parts(0.03), beyond=0.03, made=made, chosen=(move,), ended="no gain",
            limit="foam below <INSERT>",
        ),
    ]  # fmt: skip
    proof = Proof(seeds=(0, 1, 2), before=(parts(0.05),) * 3, after=(parts(0.03),) * 3, error=0.001)
    rows = rows_made(changes, made, (move,))
    draw_changes(scene.pattern, after, {}, folder)
    case = Case(scene, solution=assessment.solution)
    found = Corrected(
        name="a seat",
        seats=(assessment, assessment),
        steps=steps,
        proof=proof,
        corrections=rows,
        lengths=length_rows(scene.pattern, after),
    )
    return write_improvement_page(found, folder, camera=case.camera(None), rig=case.rig(None))


def test_it_shows_both_seats_in_one_light_and_on_one_scale(page):
    text = page.read_text(encoding="utf-8")
    assert page.name == PAGE
    for name in PICTURES:
        assert f'src="{name}"' in text
        assert len(set(Image.open(page.parent / name).convert("L").tobytes())) > 20
    old, new = (Image.open(page.parent / f"{side}.png").tobytes() for side in ("old", "new"))
    assert old == new


def test_it_says_what_is_changed_and_what_only_keeps_a_seam(page):
    text = page.read_text(encoding="utf-8")
    rows = re.findall(r"make it (\d+\.\d) mm (?:longer|shorter).*?</tr>", text, re.DOTALL)
    assert rows[0] == "3.0"
    assert "correction" in text
    assert "keeps its seam" in text
    assert "40 % of what was wrong is gone" in text
    assert "foam below &lt;INSERT&gt;" in text


def test_the_seam_whose_ease_is_changed_stands_with_its_difference(page):
    text = page.read_text(encoding="utf-8")
    row = re.search(r"INSERT-BOLSTER_L</t[hd]>(.*?)</tr>", text, re.DOTALL).group(1)
    before, now = (float(v) for v in re.findall(r">(-?[\d.]+)<", row)[-2:])
    assert before - now == pytest.approx(3.0, abs=0.06)
    assert "-0.00" not in text


def test_it_asks_nothing_of_the_network(page):
    text = unescape(page.read_text(encoding="utf-8"))
    assert "default-src 'none'" in text
    assert "http://" not in text
    assert "https://" not in text
