"""Damaged files are read or refused with a message; nothing else may come out of a reader."""

import pytest

from seatlook import io
from support.fuzz.formats import FORMATS
from support.fuzz.run import fuzz


def found(outcome):
    return dict(outcome.faults)


@pytest.mark.parametrize("name", FORMATS)
def test_damage_is_refused_with_a_message(tmp_path, name):
    outcome = fuzz(name, tmp_path, 40)
    assert found(outcome) == {}
    assert outcome.refused > 0


@pytest.mark.validate
@pytest.mark.parametrize("name", FORMATS)
def test_much_damage_is_refused_with_a_message(tmp_path, name):
    outcome = fuzz(name, tmp_path, 3000, seed=2)
    assert found(outcome) == {}
    assert min(outcome.refused, outcome.read) > 0


def test_every_reader_refuses_by_one_wrapper():
    """What a library stumbles over in a file is told with the file, in every reader."""
    names = [n for n in io.__all__ if n.startswith(("read_", "load_", "report_"))]
    assert len(names) > 12
    assert [n for n in names if not getattr(getattr(io, n), "is_reader", False)] == []
