"""The page of wrong input is what readers say, and the limits on it hold."""

from collections import Counter

from support.bad_input import PAGE, page
from support.fuzz.formats import FORMATS


def test_the_page_is_what_is_said():
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_format_has_eight_rows():
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    counts = Counter(line.split(" | ")[0].removeprefix("| ") for line in lines)
    assert {name: counts[name] for name in FORMATS if counts[name] < 8} == {}
