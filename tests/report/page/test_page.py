"""The page says what it was given, and nothing from outside can get into it."""

from __future__ import annotations

import base64
import hashlib
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest

from seatlook.errors import InputError
from seatlook.report import Check, MapView, Table, write_page
from support.pages import RIGS, TEXTURES, page_data


class Elements(HTMLParser):
    """Every element of a page as (tag, attributes), and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.result: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.result.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.result if name == tag]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("page")
    path = write_page(page_data(folder), folder)
    return folder, path.read_text(encoding="utf-8")


def test_every_picture_and_map_is_shown_with_its_description(page):
    folder, text = page
    images = [i for i in Elements(text).all("img") if i.get("src")]
    # Four maps, two of them in a range of their own as well.
    assert len(images) == len(TEXTURES) * len(RIGS) + 4 + 2
    for image in images:
        assert (folder / unquote(image["src"])).is_file()
    descriptions = [i["alt"] for i in images]
    assert "Seat cover in suede <insert> under bulb_left, view driver_door" in descriptions
    assert "W1 on the cover, view driver_door, colours from −1.50 to 1.50" in descriptions
    assert len(set(descriptions)) == len(descriptions)


def test_column_heads_carry_exposure_and_illuminance(page):
    text = Elements(page[1]).text
    assert "EV 14.6 · 97000 lx" in text
    assert "EV 6.53 · 64 lx" in text
    assert "sun, 97 klx, elevation 70 deg" in text


def test_tables_warnings_and_checks_are_on_the_page(page):
    text = Elements(page[1]).text
    for part in ("812", "0.0312", "judgement", "coarser than lambda/8", "0.08 mm", "NO", "abc"):
        assert part in text


def test_text_from_a_scene_cannot_become_markup(page):
    assert "<script>alert" not in page[1]
    assert "demo & <script>alert(1)</script>" in Elements(page[1]).text


def test_nothing_is_asked_of_the_network(page):
    text = page[1]
    assert "://" not in text
    assert not re.search(r"\sstyle=|\son\w+=", text), "inline attributes would need a weaker policy"
    policy = next(m["content"] for m in Elements(text).all("meta") if "http-equiv" in m)
    assert policy.startswith("default-src 'none'")
    assert "unsafe" not in policy
    for tag in ("style", "script"):
        inside = re.search(rf"<{tag}>(.*?)</{tag}>", text, re.S).group(1)
        digest = base64.b64encode(hashlib.sha256(inside.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy


def test_a_missing_picture_stops_the_page(tmp_path):
    data = page_data(tmp_path)
    (tmp_path / "maps/W2.png").unlink()
    with pytest.raises(InputError, match=r"got no file maps/W2\.png, expected every picture"):
        write_page(data, tmp_path)
    assert not (tmp_path / "index.html").exists()


def test_a_grid_with_a_hole_is_refused(tmp_path):
    whole = page_data(tmp_path)
    holes = {k: v for k, v in whole.pictures.items() if k != ("black leather", "sun")}
    with pytest.raises(InputError, match=r"missing or extra: \('black leather', 'sun'\)"):
        page_data(tmp_path, pictures=holes)


@pytest.mark.parametrize("name", ["/etc/zones.csv", "../zones.csv", "http://a/b", "a\\b"])
def test_only_files_below_the_page_are_linked(tmp_path, name):
    with pytest.raises(InputError, match="relative to the page and below it"):
        page_data(tmp_path, files=(name,))


def test_a_map_needs_a_range():
    with pytest.raises(InputError, match="got 1 to 1, expected low < high"):
        MapView(name="W2", image="a.png", low=1.0, high=1.0)


def test_a_ragged_table_is_refused():
    with pytest.raises(InputError, match=r"table row 1: got 1 cells, expected 2: zone, W2"):
        Table(heads=("zone", "W2"), rows=(("a", 1.0), ("b",)))


def test_a_page_without_checks_history_or_files_has_no_empty_parts(tmp_path):
    data = page_data(tmp_path, checks=(), history={}, files=(), warnings=())
    text = write_page(data, tmp_path).read_text(encoding="utf-8")
    for part in ("Read first", "In this folder", "Met", "<polyline"):
        assert part not in text


def test_a_missed_limit_is_said_in_words_not_in_colour_alone(tmp_path):
    missed = Check(name="gap", value="2 mm", limit="0.1 mm", kept=False)
    text = write_page(page_data(tmp_path, checks=(missed,)), tmp_path).read_text(encoding="utf-8")
    assert '<td class="missed">NO</td>' in text


def test_seams_and_shape_have_tables_of_their_own(tmp_path):
    seams = Table(heads=("seam", "ease [%]"), rows=(("left", 1.25),))
    shape = Table(heads=("zone", "rms [mm]"), rows=(("insert", 0.375),))
    data = page_data(tmp_path, seams=seams, shape=shape)
    text = write_page(data, tmp_path).read_text(encoding="utf-8")
    assert 'id="shape-head"' in text
    assert "0.375" in text
    assert 'id="seams-head"' in text
    assert "1.25" in text
    bare = write_page(page_data(tmp_path), tmp_path).read_text(encoding="utf-8")
    assert "seams-head" not in bare
    assert "shape-head" not in bare
