"""OpenEXR: exact, atomic, and plain words where it does not work."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import numpy as np
import OpenEXR
import pytest

from seatlook.errors import InputError
from seatlook.exr import read_exr, write_exr


def test_round_trip_is_exact_and_repeatable(tmp_path):
    pixels = np.random.default_rng(0).random((5, 7, 3)).astype(np.float32) * 1e6
    for name in "ab":
        write_exr(pixels, tmp_path / f"{name}.exr")
    assert (read_exr(tmp_path / "a.exr") == pixels).all()
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        assert file.header()["whiteLuminance"] == 1.0


@pytest.mark.parametrize(
    ("names", "shape"), [("RGBA", (4, 4, 3)), ("Y", (4, 4)), ("height", (4, 4))]
)
def test_other_channels(tmp_path, names, shape):
    channels = 4 if names == "RGBA" else 1
    pixels = np.full((4, 4, channels), 0.25, dtype=np.float16).squeeze()
    with OpenEXR.File({"type": OpenEXR.scanlineimage}, {names: pixels}) as file:
        file.write(str(tmp_path / "a.exr"))
    assert read_exr(tmp_path / "a.exr").shape == shape


def refused(path):
    with pytest.raises(InputError) as caught:
        read_exr(path)
    return str(caught.value).replace(str(path), path.name)


def test_bad_files_say_why(tmp_path):
    path = tmp_path / "a.exr"
    write_exr(np.ones((64, 64, 3), dtype=np.float32), path)
    path.write_bytes(path.read_bytes()[:300])
    assert refused(path).endswith("expected a whole OpenEXR picture")
    assert refused(tmp_path / "none.exr") == "none.exr: file: got no such file, expected a file"
    write_exr(np.full((4, 4, 3), np.nan, dtype=np.float32), path)
    assert refused(path) == "a.exr: picture: got nan or inf, expected finite values"
    plane = np.ones((4, 4), dtype=np.float32)
    with OpenEXR.File({"type": OpenEXR.scanlineimage}, {"u": plane, "v": plane}) as file:
        file.write(str(path))
    assert refused(path) == "a.exr: channels: got u, v, expected R, G and B, or one"


def test_without_the_extra_the_message_names_it(tmp_path):
    code = """
    import sys
    from pathlib import Path
    import numpy as np
    sys.modules["OpenEXR"] = None
    from seatlook.errors import InputError
    from seatlook.exr import read_exr, write_exr
    for call in (lambda p: read_exr(p), lambda p: write_exr(np.ones((2, 2, 3), "f4"), p)):
        try:
            call(Path("a.exr"))
        except InputError as error:
            print(error)
    assert not Path("a.exr").exists()
    """
    run = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)],
        capture_output=True, text=True, check=True, cwd=tmp_path, timeout=60,
    )  # fmt: skip
    assert run.stdout.splitlines() == 2 * [
        "a.exr: picture: got OpenEXR, which needs a package that is not installed, "
        "expected the extra: pip install 'seatlook[exr]'"
    ]


def test_a_damaged_picture_is_refused_once(tmp_path, capfd):
    """The library prints what it stumbles over, past Python; the error says it."""
    path = tmp_path / "a.exr"
    write_exr(np.random.default_rng(0).random((64, 128, 3)).astype(np.float32), path)
    path.write_bytes(path.read_bytes()[:9000])
    refused(path)
    assert capfd.readouterr().err == ""
