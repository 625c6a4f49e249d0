"""What is said while a command works: a bar to a terminal, lines to files and pipes."""

import time

import pytest

from seatlook.cli import _output


@pytest.fixture
def often(monkeypatch):
    """Lines come thirty times a second and not once a minute."""
    monkeypatch.setattr(_output, "EVERY", 0.03)


def test_a_log_gets_lines_while_one_long_step_says_nothing(often, capsys):
    with _output.progress() as show:
        show("solve", step=30, steps=62, residual=0.01234)
        time.sleep(0.2)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) >= 2
    assert set(lines) == {"0 min: solve, 30 of 62 done, residual 0.012"}


def test_a_line_says_where_the_work_is_now(often, capsys):
    with _output.progress() as show:
        for texture in ("suede", "black"):
            show("render", rig="sun", texture=texture)
            time.sleep(0.1)
    said = capsys.readouterr().err
    assert said.index("render sun suede") < said.index("render sun black")


def test_nothing_is_said_in_the_first_minute_nor_when_quiet(often, capsys, monkeypatch):
    monkeypatch.setattr(_output.manner, "quiet", True)
    with _output.progress() as show:
        show("solve")
        time.sleep(0.1)
    monkeypatch.undo()
    assert _output.EVERY == 60.0
    with _output.progress() as show:
        show("solve")
    assert capsys.readouterr().err == ""


def test_no_line_comes_after_the_work_has_failed(often, capsys):
    with pytest.raises(ValueError, match="broken"), _output.progress():
        raise ValueError("broken")
    capsys.readouterr()
    time.sleep(0.1)
    assert capsys.readouterr().err == ""
