"""Tables: what is written can be read, and numbers keep nine digits."""

import csv

import numpy as np

from seatlook import io


def rows(path):
    with path.open(newline="") as stream:
        return list(csv.reader(stream))


def test_numbers_keep_nine_digits_and_integers_all(tmp_path):
    ids = np.array([7, 2**53 + 1])
    values = np.array([-1.0 / 3.0, np.nan])
    io.write_numbers(tmp_path / "a.csv", ("shell", "w2"), (ids, values))
    assert rows(tmp_path / "a.csv") == [
        ["shell", "w2"], ["7", "-0.333333333"], ["9007199254740993", "nan"]
    ]  # fmt: skip


def test_without_rows_only_heads_are_left(tmp_path):
    nothing = np.zeros(0)
    io.write_numbers(tmp_path / "a.csv", ("a", "b"), (nothing, nothing))
    assert rows(tmp_path / "a.csv") == [["a", "b"]]
