"""Numbers and titles of the user in a d3plot: shells, parts, and which title is whose."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from seatlook.io.lsdyna.d3plot.layout import Layout, Words, is_end
from seatlook.io.lsdyna.d3plot.row import refuse
from seatlook.io.lsdyna.element_tables import text
from seatlook.model import IntArray

_TITLE_BYTES = 72
_RELEASE = slice(13, 14)  # control word with four letters such as R712 or R14
_LAST_BY_USER, _FIRST_BY_COUNT = 9, 13  # releases whose way to number titles has been seen


@dataclass(frozen=True, slots=True)
class Titles:
    """Titles of parts.

    Parameters
    ----------
    of_part : user's number -> title
    end : first word behind the titles
    note : how they were given to the parts, where the file leaves a choice
    """

    of_part: dict[int, str]
    end: int
    note: str = ""


def read_titles(layout: Layout, words: Words, part_ids: IntArray) -> Titles:
    """Read the titles behind the geometry and give each to its part.

    Releases differ in the number beside a title: older ones write the user's number, newer ones
    count the parts from 1. Numbers that are no user's are counted; where both would do, the
    release decides.
    """
    raw, end = _titles(layout, words)
    numbers, ids = set(raw), part_ids.tolist()
    counted = {ids[k - 1]: title for k, title in raw.items() if 1 <= k <= len(ids)}
    is_counted = len(counted) == len(raw)
    is_users = numbers <= set(ids)
    if not raw or (is_users and not is_counted):
        return Titles(raw, end)
    if not is_counted:
        odd = ", ".join(map(str, sorted(numbers - set(ids))[:5]))
        note = (
            f"titles of parts are left out: their numbers ({odd}) are neither the user's nor "
            "counted from 1; choose parts by number"
        )
        return Titles({}, end, note)
    if counted == raw or not is_users:
        return Titles(counted, end)
    return _by_release(layout, words, Titles(raw, end), Titles(counted, end))


def _by_release(layout: Layout, words: Words, users: Titles, counted: Titles) -> Titles:
    """Choose between two ways to number titles, and say so."""
    letters = np.asarray(words[_RELEASE]).tobytes().decode("latin-1")
    release = " ".join(re.findall(r"[\w.]+", letters))
    found = re.match(r"R?(1\d|\d)", release)
    number = int(found[1]) if found else 0
    if 1 <= number <= _LAST_BY_USER:
        note = f"titles of parts are read by the user's numbers, as release {release} writes them"
        return Titles(users.of_part, users.end, note)
    if number >= _FIRST_BY_COUNT:
        note = f"titles of parts are read in the file's order, as release {release} writes them"
        return Titles(counted.of_part, users.end, note)
    note = (
        "titles of parts are left out: their numbers may be the user's or counted from 1, and "
        f"release {release or 'unknown'} does not say which; choose parts by number"
    )
    return Titles({}, users.end, note)


def _titles(layout: Layout, words: Words) -> tuple[dict[int, str], int]:
    """Read part titles as they are numbered; return them and the word behind."""
    at = layout.geometry_end
    size = int(layout.word[2])
    title_words = _TITLE_BYTES // size
    titles: dict[int, str] = {}
    if not is_end(layout, words, at):
        return titles, at
    at += 1
    while at + 1 < len(words):
        kind, count = int(words[at]), int(words[at + 1])
        if kind == 90000:
            at += 1 + title_words
        elif kind in (90001, 90002, 90020):
            end = at + 2 + count * (1 + title_words)
            if count < 0 or end > len(words):
                raise refuse(layout.file, "titles", f"{count} of them", "a whole file")
            if kind == 90001:
                block = np.asarray(words[at + 2 : end]).reshape(count, -1)
                titles = {int(row[0]): text(row[1:].tobytes()) for row in block}
            at = end
        elif kind == 90100:
            at += 2 + max(count, 0) * 80 // size
        else:
            break
    return titles, at + 1 if is_end(layout, words, at) else at


def user_numbers(layout: Layout, words: Words) -> tuple[IntArray, IntArray]:
    """Return the user's numbers of shells and parts; counted from 1 where the file has none."""
    control, at = layout.control, layout.numbering
    plain = np.arange(1, control["nel4"] + 1), np.arange(1, control["nmmat"] + 1)
    wide = control["filetype"] > 1000 and layout.word.endswith("4")
    if control["narbs"] < 10 or wide:
        return plain
    head = words[at : at + 16].astype(np.int64)
    named = head[0] < 0
    counts = [int(c) for c in head[5:10]]
    expected = [control["numnp"], abs(control["nel8"]), control["nel2"], control["nel4"],
                control["nelth"]]  # fmt: skip
    part_count = control["nmmat"] if named else 0
    need = (16 if named else 10) + sum(counts) + part_count
    if counts != expected or (named and control["narbs"] < 16) or need > control["narbs"]:
        raise refuse(
            layout.file, "NARBS", f"{control['narbs']} words for {counts} numbers", f"{expected}"
        )
    shells = at + (16 if named else 10) + sum(counts[:3])
    ids = words[shells : shells + counts[3]].astype(np.int64)
    parts = shells + counts[3] + counts[4]
    return ids, words[parts : parts + part_count].astype(np.int64) if named else plain[1]
