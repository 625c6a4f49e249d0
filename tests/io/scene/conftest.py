"""The example of the scene page, written, changed and loaded."""

import pytest

from seatlook.io.scene.read import load_scene
from support.example_scene import EXAMPLE, write_example_files


@pytest.fixture
def folder(tmp_path):
    return write_example_files(tmp_path)


@pytest.fixture
def load(folder):
    def load(text=EXAMPLE):
        (folder / "scene.toml").write_text(text)
        return load_scene(folder / "scene.toml")

    return load


@pytest.fixture
def refused(load, problems):
    """Load the example with texts replaced; return the messages, {} stands for the line."""

    def refused(*changes):
        text = EXAMPLE
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new, 1)
        rows = text.splitlines()
        got = problems(load, text)
        return got, lambda start: next(
            i for i, row in enumerate(rows, start=1) if row.startswith(start)
        )

    return refused
