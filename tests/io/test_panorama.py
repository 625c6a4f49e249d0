"""Radiance pictures: packed and plain rows, and what is said of bad ones."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import InputError, InputWarning
from seatlook.exr import write_exr
from seatlook.io.panorama import read_panorama

HEAD = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n"
# 1, 2 and 4 with the exponent of 2^3: mantissas over 256.
PIXEL = (32, 64, 128, 131)


def packed():
    """Eight rows, each channel one run of 16."""
    row = bytes([2, 2, 0, 16]) + b"".join(bytes([128 + 16, value]) for value in PIXEL)
    return HEAD + 8 * row


def test_packed_rows(tmp_path):
    path = tmp_path / "sky.hdr"
    path.write_bytes(packed())
    got = read_panorama(path)
    assert got.shape == (8, 16, 3)
    assert got == pytest.approx(np.broadcast_to([1.0, 2.0, 4.0], got.shape), rel=0.02)


def test_plain_rows_and_literals_are_the_same(tmp_path):
    plain, literal, runs = (tmp_path / f"{name}.hdr" for name in "abc")
    plain.write_bytes(HEAD + bytes(PIXEL) * 16 * 8)
    row = bytes([2, 2, 0, 16]) + b"".join(bytes([16]) + bytes([value] * 16) for value in PIXEL)
    literal.write_bytes(HEAD + 8 * row)
    runs.write_bytes(packed())
    a, b, c = (read_panorama(path) for path in (plain, literal, runs))
    assert (a == b).all()
    assert (a == c).all()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PNG", "expected a Radiance picture"),
        (HEAD.replace(b"X 16", b"X 12"), "got 12 x 8, expected twice as wide as high"),
        (packed()[:-3], "got a file cut short, expected 8 rows of 16"),
        (HEAD + bytes(PIXEL) * 20, "got a file cut short"),
    ],
)
def test_bad_pictures(tmp_path, content, message):
    path = tmp_path / "sky.hdr"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as raised:
        read_panorama(path)
    assert "sky.hdr" in str(raised.value)


def test_panorama_of_a_rig(demo_scene):
    """Named beside the scene and scaled; a missing file is named with its key."""
    from seatlook.io import load_scene

    text = demo_scene.read_text()
    name = "ambient_cd_m2 = 4000.0"
    assert name in text
    scene = demo_scene.with_name("with-sky.toml")
    scene.write_text(text.replace(name, 'panorama = "sky.hdr"\npanorama_cd_m2 = 100.0', 1))
    with pytest.raises(InputError, match=r"panorama: got 'sky.hdr', expected a file \(there"):
        load_scene(scene)
    demo_scene.with_name("sky.hdr").write_bytes(packed())
    rigs = [rig for rig in load_scene(scene).rigs if rig.panorama is not None]
    assert len(rigs) == 1
    assert rigs[0].panorama[0, 0] == pytest.approx([100.0, 200.0, 400.0], rel=0.02)


def test_openexr_is_the_same_sky(tmp_path):
    sky = np.random.default_rng(0).random((8, 16, 3)).astype(np.float32) * 1e4
    write_exr(sky, tmp_path / "sky.exr")
    assert (read_panorama(tmp_path / "sky.exr") == sky).all()


def test_openexr_with_values_below_zero_warns(tmp_path):
    sky = np.ones((8, 16, 3), dtype=np.float32)
    sky[2, 3] = -100.0
    write_exr(sky, tmp_path / "sky.exr")
    with pytest.warns(InputWarning, match="3 of 384 values below 0 are taken for 0"):
        assert read_panorama(tmp_path / "sky.exr").min() == 0.0


def test_openexr_of_another_shape(tmp_path, problems):
    write_exr(np.ones((8, 8, 3), dtype=np.float32), tmp_path / "sky.exr")
    assert problems(read_panorama, tmp_path / "sky.exr") == [
        "sky.exr: panorama: got 8 x 8, expected twice as wide as high"
    ]
