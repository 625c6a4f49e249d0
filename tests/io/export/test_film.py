import imageio.v3
import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.export.film import read_shapes, write_animation, write_shapes


def test_shapes_come_back(tmp_path):
    shapes = np.random.default_rng(0).standard_normal((3, 5, 3)).astype(np.float32)
    path = tmp_path / "shapes" / "1-sew.npz"
    write_shapes(path, [0.1, 0.2, 0.3], shapes)
    times, again = read_shapes(path)
    np.testing.assert_array_equal(times, [0.1, 0.2, 0.3])
    assert again.tobytes() == shapes.tobytes()
    first = path.read_bytes()
    write_shapes(path, [0.1, 0.2, 0.3], shapes)
    assert path.read_bytes() == first


def test_damaged_shapes_are_refused(tmp_path):
    path = tmp_path / "shapes.npz"
    write_shapes(path, [0.1], np.zeros((1, 5, 3), dtype=np.float32))
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(InputError, match=r"shapes.npz: file: got .* expected shapes of a stage"):
        read_shapes(path)
    write_shapes(path, [0.1, 0.2], np.zeros((1, 5, 3), dtype=np.float32))
    with pytest.raises(InputError, match=r"got times \(2,\), positions \(1, 5, 3\), expected"):
        read_shapes(path)
    for arrays in ({"times": np.zeros(1)}, {"times": np.zeros(1), "positions": np.array("x")}):
        np.savez(path, **arrays)
        with pytest.raises(InputError, match=r"shapes.npz: file: got "):
            read_shapes(path)


def test_animation_has_its_pictures_and_lasts_as_long_as_said(tmp_path):
    frames = [np.full((8, 12, 3), level, dtype=np.uint8) for level in (0, 100, 250, 100)]
    path = tmp_path / "moving.gif"
    write_animation(frames, path, seconds=2.0)
    again = imageio.v3.imread(path, plugin="pillow", mode="RGB")
    assert again.shape == (4, 8, 12, 3)
    assert [int(picture.mean()) for picture in again] == pytest.approx([0, 100, 250, 100], abs=2)
    assert imageio.v3.immeta(path, plugin="pillow")["duration"] == pytest.approx(500)


def test_animation_needs_a_gif_and_a_picture(tmp_path):
    with pytest.raises(InputError, match=r"got 'moving.mp4', expected a name in .gif"):
        write_animation([np.zeros((2, 2, 3), np.uint8)], tmp_path / "moving.mp4", seconds=1.0)
    with pytest.raises(InputError, match="got no picture, expected one or more"):
        write_animation([], tmp_path / "moving.gif", seconds=1.0)
