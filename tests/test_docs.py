"""What the pages say is so: links, files, names, commands with their options, the example."""

from __future__ import annotations

import pkgutil
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from cyclopts import App

import seatlook
from seatlook.cli import app

ROOT = Path(__file__).parents[1]
PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "tests").rglob("*.md")]
CHANGES = ROOT / "CHANGELOG.md"  # speaks of names as they were
MODULES = [str(file) for top in ("src", "tests", "gallery") for file in (ROOT / top).rglob("*.py")]
ENDINGS = {"toml", "npz", "k"}  # of seat.toml, seat.npz, seat.k
README = (ROOT / "README.md").read_text(encoding="utf-8")

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
PATH = re.compile(r"(?<![\w./-])(?:src/seatlook|tests|gallery|docs)/[\w./-]*[\w/]")
MODULE = re.compile(r"(?<![\w./-])[a-z_][\w/]*\.py\b")
NAME = re.compile(r"\bseatlook\.[a-z_]+(?:\.\w+)*(?![\w.]*\.(?:toml|npz|md))\b")

every_page = pytest.mark.parametrize(
    "page", sorted({*PAGES} - {CHANGES}), ids=lambda page: str(page.relative_to(ROOT))
)


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def prose_of(page: Path) -> str:
    """Return a page without its fenced blocks, in which # is no heading."""
    return BLOCK.sub("", text_of(page))


def anchors_of(page: Path, *, level: int = 1) -> set[str]:
    """Return the anchors of a page's headings from a level on, made as GitHub makes them."""
    headings = [
        re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        for heading in re.findall(rf"^#{{{level},6}} (.*)$", prose_of(page), re.M)
    ]
    return {
        f"{heading}-{n}" if (n := headings[:i].count(heading)) else heading
        for i, heading in enumerate(headings)
    }


def commands_of(page: Path) -> list[str]:
    """Return the lines of a page's blocks that call seatlook, without comments."""
    joined = re.sub(r"\\\n\s*", "", text_of(page))
    blocks = [text for language, text in BLOCK.findall(joined) if language in ("", "bash", "sh")]
    lines = [*re.findall(r"^ {4}(.*)$", BLOCK.sub("", joined), re.M), *"".join(blocks).splitlines()]
    stripped = [line.strip().removeprefix(".venv/bin/") for line in lines]
    return [line for line in stripped if line.startswith("seatlook ")]


def spans_of(page: Path) -> list[str]:
    """Return the pieces of inline code of a page."""
    return [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", prose_of(page))]


def options_of(words: list[str]) -> set[str]:
    """Return the options of the command that the first words name; KeyError if there is none."""
    command: App = app[words[0]]
    if len(words) > 1 and words[1][0] != "-" and words[1] in command:
        command = command[words[1]]
    if any(not name.startswith("-") for name in command):
        return {"--help"}
    arguments = command.assemble_argument_collection()
    return {"--help", "--quiet", *(name for argument in arguments for name in argument.names)}


@pytest.mark.parametrize("page", sorted(PAGES), ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files_and_headings(page):
    for target, anchor in LINK.findall(prose_of(page)):
        if target.startswith("https:"):
            continue
        file = page.parent / target if target else page
        assert file.exists(), target
        assert not anchor or anchor in anchors_of(file), f"{target}#{anchor}"


@every_page
def test_files_it_names_exist(page):
    text = LINK.sub("", text_of(page))
    for path in PATH.findall(text):
        assert "NAME" in path or (ROOT / path).exists(), path
    for module in MODULE.findall(text):
        assert "NAME" in module or any(file.endswith(f"/{module}") for file in MODULES), module


def test_pages_that_the_source_names_exist():
    files = [
        file
        for folder in ("src", "tests", "gallery", "materials")
        for file in (ROOT / folder).rglob("*")
        if file.suffix in (".py", ".toml", ".j2", ".js")
    ]
    named = {
        page
        for file in [*files, ROOT / "pyproject.toml", ROOT / "Makefile"]
        for page in re.findall(r"\bdocs/[\w/-]+\.md\b", text_of(file))
    }
    assert len(named) >= 5
    assert {page for page in named if not (ROOT / page).exists()} == set()


@every_page
def test_python_names_it_gives_exist(page):
    names = {name for span in spans_of(page) for name in NAME.findall(span)}
    for name in sorted(names):
        pkgutil.resolve_name(name)


@every_page
def test_what_it_calls_on_a_seat_exists(page):
    calls = re.findall(r"(?<![\w/-])seat\.([a-z_]+)(?=\(|\.[a-z]|`)", text_of(page))
    assert {*calls} <= {"scene", *ENDINGS, *dir(seatlook.Seat)}


@every_page
def test_commands_it_shows_are_accepted(page):
    for command in commands_of(page):
        words = shlex.split(command.partition(" > ")[0], comments=True)[1:]
        words = [word for word in words if word != "--quiet"]
        app.parse_args(words, print_error=False, exit_on_error=False)


@every_page
def test_commands_and_options_in_its_text_exist(page):
    for span in spans_of(page):
        if match := re.match(r"seatlook ([a-z].*)", span):
            words = match[1].split()
            assert {w for w in words if w.startswith("--")} <= options_of(words), span


def test_a_page_of_faults_is_refused(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "# One\n\n[a](#two) `seatlook demo --bogus` `seatlook.nothing`\n\n    seatlook dem\n"
    )
    for check in (
        test_links_lead_to_files_and_headings,
        test_python_names_it_gives_exist,
        test_commands_it_shows_are_accepted,
        test_commands_and_options_in_its_text_exist,
    ):
        with pytest.raises(Exception, match=r"two|nothing|dem"):
            check(page)


@pytest.mark.render
def test_the_readmes_example_runs(demo_scene, tmp_path):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.S)
    assert len([line for line in example.splitlines() if line]) <= 14
    shutil.copytree(demo_scene.parent, tmp_path / "out" / "demo")
    scene = tmp_path / "out" / "demo" / "scene.toml"
    scene.write_text(scene.read_text().replace("[camera]", "[camera]\nsize = [96, 54]"))
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert re.fullmatch(r"([\w -]+: mean W2 \d\.\d{4}\n)+", done.stdout)
    assert "INSERT interior: mean W2" in done.stdout
    assert (tmp_path / "seat.png").read_bytes().startswith(b"\x89PNG")


def test_the_changelog_begins_with_this_version():
    versions = re.findall(r"^## (\S+) - (\d{4}-\d\d-\d\d)$", text_of(CHANGES), re.M)
    assert len(versions) == len(re.findall(r"^## ", text_of(CHANGES), re.M))
    assert versions[0][0] == seatlook.__version__
    order = [(tuple(int(n) for n in number.split(".")), day) for number, day in versions]
    assert order == sorted(order, reverse=True)


def test_every_make_target_it_names_exists():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in PAGES:
        for target in re.findall(r"^    make (\w+)|`make (\w+)`", text_of(page), re.M):
            assert re.search(rf"^{''.join(target)}:", makefile, re.M), target


def test_the_page_of_equations_names_a_function_for_each():
    spans = spans_of(ROOT / "docs" / "equations.md")
    assert len({span for span in spans if NAME.fullmatch(span)}) >= 8


def test_the_index_has_a_line_for_every_room():
    text = text_of(ROOT / "docs" / "index.md")
    rooms = {
        path.stem
        for path in (ROOT / "src" / "seatlook").iterdir()
        if not path.name.startswith("_")
        and (path.suffix == ".py" or (path / "__init__.py").exists())
    }
    listed = re.findall(r"^\| `(\w+)` \|", text, re.M)
    assert {*listed} == rooms
    contracts = tomllib.loads(text_of(ROOT / "pyproject.toml"))["tool"]["importlinter"]["contracts"]
    (order,) = (c["layers"] for c in contracts if c.get("containers") == ["seatlook"])
    assert listed == [room for room in re.findall(r"\w+", " ".join(order)) if room[0] != "_"]


def test_the_index_answers_with_the_file_in_which_a_name_is_defined():
    index = ROOT / "docs" / "index.md"
    rows = re.findall(r"^\| (?:Where|What|Who) .*$", text_of(index), re.M)
    answered = 0
    for row in rows:
        files = [text_of(index.parent / link) for link, _ in LINK.findall(row) if "src/" in link]
        for name in NAME.findall(row):
            own = name.rpartition(".")[2]
            defined = re.compile(rf"^(?:def|class) {own}\b|^{own}\b.*=", re.M)
            assert any(defined.search(file) for file in files), name
            answered += 1
    assert answered >= 6


def test_every_page_is_reached_from_the_index():
    index = ROOT / "docs" / "index.md"
    linked = {(index.parent / target).resolve() for target, _ in LINK.findall(text_of(index))}
    assert {page for page in PAGES if index.parent in page.parents and page != index} <= linked


def test_every_decision_has_three_parts_and_a_line_in_the_table():
    folder = ROOT / "docs" / "decisions"
    listed = re.findall(
        r"^\| \[.*?\]\((\w+\.md#[^)]*)\) \| .+ \|$", text_of(folder / "index.md"), re.M
    )
    made = []
    for page in sorted(folder.glob("*.md")):
        if page.name == "index.md":
            continue
        for entry in text_of(page).split("\n## ")[1:]:
            parts = re.findall(r"^\*\*(\w+)\.\*\* \S", entry, re.M)
            assert parts == ["Context", "Decision", "Figure"], entry.splitlines()[0]
        made += [f"{page.name}#{a}" for a in anchors_of(page, level=2)]
    assert sorted(listed) == sorted(made)
    assert len(made) >= 60


def test_the_reference_lists_every_command_and_public_name():
    reference = ROOT / "docs" / "reference"
    rows = re.findall(r"^\| `seatlook (\w+)` \|", text_of(reference / "command-line.md"), re.M)
    assert sorted(rows) == sorted(name for name in app if not name.startswith("-"))
    spans = spans_of(reference / "python.md")
    assert {f"seatlook.{name}" for name in seatlook.__all__} <= {*spans}


@pytest.mark.parametrize(
    "page",
    [
        p
        for p in sorted({*PAGES} - {CHANGES})
        if not {"method", "measurements", "decisions", "tests"} & {*p.parts[-3:]}
    ],
    ids=lambda page: str(page.relative_to(ROOT)),
)
def test_pages_for_users_are_plain(page):
    """Short sentences, and none of the words that the glossary replaces."""
    prose = re.sub(r"^\|.*$|^#.*$|^ {4}.*$", "", prose_of(page), flags=re.M)
    words = r"\b(?:is|are|be) told\b|by how much|way down|\bclay\b|standoff|\bstarved\b|\bfacets\b"
    assert not re.search(words, prose, re.I)
    blocks = re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d\.) )", re.sub(r"`[^`]*`|\([^)]*\)", "x", prose))
    sentences = [
        s for block in blocks for s in re.split(r"(?<=[.!?:;])\s+", " ".join(block.split()))
    ]
    assert max((len(sentence.split()) for sentence in sentences), default=0) <= 28
