from pathlib import Path

import pytest

from seatlook.errors import InputError


@pytest.fixture
def write(tmp_path):
    """Write a file below a fresh folder and return its path."""

    def write(name, text):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


@pytest.fixture
def problems():
    """Call a function that must fail; return its messages with file names but without folders."""

    def problems(function, *args, **kwargs):
        with pytest.raises(InputError) as caught:
            function(*args, **kwargs)
        return [
            str(p).replace(str(p.file), Path(p.file).name) if p.file else str(p)
            for p in caught.value.problems
        ]

    return problems
