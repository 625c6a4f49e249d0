"""What is written as dynain is read back with the same indices."""

import dataclasses
import re

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from seatlook import wrinkle
from seatlook.chain.shells.states import ShellCriteria, shell_indices
from seatlook.errors import InputError
from seatlook.io.export.writers import export_cover
from seatlook.io.lsdyna.deck.reader import read_keyword
from seatlook.io.lsdyna.dynain import write_dynain
from support.wrinkle_samples import shaped, wave


def solved():
    q = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    q *= np.linalg.det(q)
    flat = wave(0.0005, 0.04)
    return shaped(lambda X: flat(X * [1.03, 0.98]) @ q.T, h=0.01, panels=2)


@pytest.mark.parametrize("unit", ["mm", "m", "inch"])
@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_indices_survive_the_file(tmp_path, unit, mode):
    solution = solved()
    path = tmp_path / "cover.dynain"
    write_dynain(solution, path, length_unit=unit)
    result = read_keyword(path, length_unit=unit)
    state = result.read(0)
    np.testing.assert_allclose(state.positions, solution.positions, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(state.thickness, solution.cover.thickness, rtol=1e-8)
    assert (result.shells.part == solution.cover.panel + 1).all()
    assert (result.shells.corners[:, :3] == solution.cover.faces).all()
    here = wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, 20.0, mode,
        strain_measure="logarithmic",
    )  # fmt: skip
    read = shell_indices(result.shells, state, ShellCriteria(curvature=mode, c_threshold=20.0))
    assert read.turned == 0
    np.testing.assert_allclose(read.indices.c, here.c, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(read.indices.w2, here.w2, rtol=1e-6, atol=1e-6)
    # The file holds two surfaces; the mean of their logarithms is not that of the mid surface.
    for name in ("r_stretch", "w_stretch", "w_compression"):
        np.testing.assert_allclose(getattr(read.indices, name), getattr(here, name), atol=1e-3)


SOLVED = solved()


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(names=st.tuples(st.text(), st.text()))
@example(names=("P0\n*NODE\n1", "Wange links"))
@example(names=("*NODE", "$ grün, 座套 🪑 = 'x' \u200d\u2028\x00"))
@example(names=("\ud800", "1,2,3"))
def test_panels_are_titled_parts_with_sections(tmp_path, names):
    """A name comes back as one line; what no text file can hold becomes a blank."""
    cover = dataclasses.replace(SOLVED.cover, panel_names=names)
    path = tmp_path / "a.k"
    write_dynain(dataclasses.replace(SOLVED, cover=cover), path)
    result = read_keyword(path)
    lines = [re.sub(r"[\x00-\x1f\x7f-\x9f\ud800-\udfff]", " ", name) for name in names]
    assert list(result.shells.part_names.values()) == [" ".join(line.split()) for line in lines]
    sections = path.read_text(encoding="utf-8").split("*SECTION_SHELL\n")[1:]
    t = f"{SOLVED.cover.thickness[0] * 1e3:10.4g}"
    assert [s.split("\n")[1] for s in sections] == [t * 4] * 2


@pytest.mark.parametrize(("ending", "columns"), [("k", 20), ("radioss.k", 16)])
def test_strains_of_either_width_are_read_back(tmp_path, ending, columns):
    """The manual doubles the 10 columns of a field; OpenRadioss reads 16."""
    path = tmp_path / f"cover.{ending}"
    export_cover(SOLVED, (), path)
    entry = path.read_text().split("*INITIAL_STRAIN_SHELL\n")[1].split("\n")[:5]
    assert [len(card) for card in entry[1:]] == [5 * columns, 2 * columns] * 2
    assert entry[0].split() == ["1", "1", "2", "1"]
    write_dynain(SOLVED, tmp_path / "other.k", strain_columns=36 - columns)
    one, other = (read_keyword(p).read(0) for p in (path, tmp_path / "other.k"))
    for name in ("strain_inner", "strain_outer"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
        assert np.abs(getattr(one, name)).max() > 1e-3


def test_impossible_strains_and_units_are_refused(tmp_path):
    solution = SOLVED
    crushed = dataclasses.replace(solution, strain_top=np.full_like(solution.strain_top, -0.6))
    with pytest.raises(InputError, match="strains: got -1/2 or less"):
        write_dynain(crushed, tmp_path / "b.k")
    assert not (tmp_path / "b.k").exists()
    with pytest.raises(InputError, match="length_unit: got 'ft'"):
        write_dynain(solution, tmp_path / "b.k", length_unit="ft")
