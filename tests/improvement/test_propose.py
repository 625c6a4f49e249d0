"""Proposals: the spoiled edge is found, what is frozen stays, faults end with a reason."""

from dataclasses import replace

import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.chain.assess import assess
from seatlook.errors import InputError, SolverError
from seatlook.improvement.candidate import frozen_names
from seatlook.improvement.corrected import CORRECTIONS, LENGTHS, PATTERN, SEAMS, write_corrected
from seatlook.improvement.objective import Goal
from seatlook.improvement.propose import propose
from seatlook.improvement.ways import free_of
from seatlook.model.scene import Freedom
from seatlook.solver import solve

MM = 1e-3
LINE = "INSERT.BOLSTER_L"


@pytest.fixture(scope="module")
def asked(scene, changes, candidates):
    """A scene with one line of the insert 8 mm too long; only lengths of lines may change."""
    line = next(c for c in candidates if c.kind == "length" and c.name == LINE)
    freedom = Freedom(edge=0.0, hook=0.0, foam=0.0)
    spoilt = replace(scene, pattern=changes.pattern({line: 8 * MM}), improve=freedom)
    return spoilt, assess(solve(assemble(spoilt)))


def test_the_spoilt_line_is_found_and_made_shorter(asked, tmp_path):
    scene, assessment = asked
    found = propose(scene, assessment, goal=Goal(strain=(-0.003, 0.06), strain_unit=0.02), count=1)
    (best,) = found.proposals
    assert best.move.names == (LINE,)
    assert -14 * MM < best.amount < -3 * MM
    assert best.share > 0.05
    files = write_corrected(scene, assessment.solution, found, tmp_path)
    assert set(files) == {PATTERN, SEAMS, CORRECTIONS, LENGTHS}
    written = io.read_pattern(tmp_path / PATTERN, tmp_path / SEAMS)
    assert written.edges.keys() == scene.pattern.edges.keys()
    change = written.edge_length(LINE) - scene.pattern.edge_length(LINE)
    assert change == pytest.approx(best.amount, abs=0.05 * MM)


def test_all_frozen_is_refused(asked):
    scene, assessment = asked
    nothing = replace(scene, improve=Freedom(edge=0.0, length=0.0, hook=0.0, foam=0.0))
    with pytest.raises(InputError, match="all frozen"):
        propose(nothing, assessment)


def test_a_result_that_is_not_converged_is_refused(asked):
    scene, assessment = asked
    bad = replace(assessment.solution, status="not converged", reason="the cover still moves")
    with pytest.raises(SolverError, match="still moves"):
        propose(scene, assess(bad))


@pytest.mark.validate
def test_a_hook_that_is_missing_is_named_first(scene):
    bare = replace(scene, hooks=tuple(h for h in scene.hooks if h.wire != "trench_left"))
    found = propose(bare, assess(solve(assemble(bare))))
    assert found.proposals[0].move.names == ("trench_left", "INSERT-BOLSTER_L")
    assert "holds nothing" in found.proposals[0].sentence


def test_frozen_seams_freeze_both_edges(scene, changes):
    name = changes.drawn.seams[0].name
    frozen = frozen_names(replace(scene, improve=Freedom(frozen=(name,))))
    seam = changes.drawn.seams[0]
    assert {name, seam.a, *seam.b} == frozen


def test_a_frozen_edge_is_not_moved_by_its_corners(scene, changes):
    frozen = replace(scene, improve=Freedom(frozen=(LINE,)))
    free = free_of(frozen, changes)
    assert free
    panel = next(p for p in scene.pattern.panels if p.name == "INSERT")
    edge = scene.pattern.edges[LINE]
    kept = edge.points(panel)
    for candidate in free:
        assert candidate.name != LINE
        if candidate.kind in ("offset", "length"):
            changed = changes.pattern({candidate: MM})
            own = next(p for p in changed.panels if p.name == "INSERT")
            assert (edge.points(own) == kept).all()
    assert len(free) < len(free_of(scene, changes)) - 1
