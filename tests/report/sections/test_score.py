"""The page's section on visibility: the score, or why there is none."""

from __future__ import annotations

import importlib

import pytest

from seatlook.report import Check, MapView, Table, write_page
from seatlook.report.page.types import ScoreSection
from seatlook.report.page.write import page_html
from support.pages import page_data, picture, write_png

MISSED = Check(name="A: vwi", value="9.66", limit="3", kept=False)
SECTION = ScoreSection(
    grid=Table(heads=("VWI, height", "sun"), rows=(("suede <insert>", "3.75, > 1 mm"),)),
    causes=Table(heads=("texture", "VWI"), rows=(("suede <insert>", 3.75),)),
    zones=Table(heads=("zone", "suede <insert>"), rows=(("INSERT interior", "7.84"),)),
    sentences=("Least visible texture under these lights: suede <insert>.",),
    maps=(MapView(name="D of suede", image="maps/d.png", low=0.0, high=3.0, meaning="visibility"),),
    checks=(MISSED,),
)


def test_the_score_stands_on_the_page(tmp_path):
    text = page_html(page_data(tmp_path, score=SECTION))
    assert 'href="#visibility"' in text
    for part in ("3.75, &gt; 1 mm", "Least visible texture", "A: vwi", "maps/d.png"):
        assert part in text
    assert "<insert>" not in text


def test_a_refused_score_says_why_and_misses_its_limits(tmp_path):
    refused = ScoreSection(refused="VWI 1.27 of a cover without wrinkles", checks=(MISSED,))
    text = page_html(page_data(tmp_path, score=refused))
    assert "No score: VWI 1.27 of a cover without wrinkles" in text
    assert '<td class="missed">NO</td>' in text


def test_without_a_score_there_is_no_section(tmp_path):
    assert 'id="visibility"' not in page_html(page_data(tmp_path, score=None))


@pytest.mark.browser
def test_no_accessibility_violation(browser, tmp_path):
    write_png(tmp_path / "maps/d.png", picture(1))
    axe = importlib.import_module("axe_playwright_python.sync_playwright").Axe()
    # The checker is injected as a script, which the page's own policy rightly refuses.
    context = browser.new_context(offline=True, bypass_csp=True)
    page = context.new_page()
    page.goto(write_page(page_data(tmp_path, score=SECTION), tmp_path).as_uri())
    result = axe.run(page)
    page.set_viewport_size({"width": 360, "height": 740})
    width = page.evaluate("document.documentElement.scrollWidth")
    context.close()
    assert result.violations_count == 0, result.generate_report()
    assert width == 360
