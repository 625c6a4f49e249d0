"""The example notebook is executed as a reader would: in a kernel, cell by cell."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

pytestmark = [pytest.mark.render, pytest.mark.validate]

NOTEBOOK = Path(__file__).parents[1] / "gallery" / "compare_variants.py"


@pytest.mark.filterwarnings("ignore")  # of the notebook machinery, which is not ours
def test_the_notebook_runs_and_its_sliders_respond(tmp_path, monkeypatch):
    jupytext = importlib.import_module("jupytext")
    nbformat = importlib.import_module("nbformat")
    nbclient = importlib.import_module("nbclient")
    monkeypatch.setenv("SEATLOOK_NOTEBOOK", str(tmp_path))
    monkeypatch.setenv("SEATLOOK_ELEMENT_SIZE_MM", "30")
    monkeypatch.setenv("SEATLOOK_WIDTH", "160")
    notebook = jupytext.read(NOTEBOOK)
    notebook.cells.append(
        nbformat.v4.new_code_cell(
            "variant, texture, rig, said, picture = sliders.children\n"
            "before = picture.value\n"
            "texture.value = 'suede'\n"
            "print(said.value, picture.value != before)"
        )
    )
    client = nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3")
    client.execute(cwd=str(tmp_path))
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    data = [output["data"] for output in shown if "data" in output]
    html = "".join(str(d.get("text/html", "")) for d in data)
    assert html.count("data:image/png;base64,") >= 2 * 3 + 2
    assert "seam INSERT-BOLSTER_L" in html
    assert sum("image/png" in d for d in data) >= 3
    assert any("application/vnd.jupyter.widget-view+json" in d for d in data)
    assert shown[-1]["text"].startswith("fits, suede, sun, EV ")
    assert shown[-1]["text"].endswith(" True\n")
