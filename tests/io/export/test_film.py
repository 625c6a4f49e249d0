import os
import shutil

import imageio.v3
import numpy as np
import pytest
from PIL import Image

from seatlook.errors import InputError
from seatlook.io.export.film import check_animation, read_shapes, write_animation, write_shapes


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


@pytest.mark.parametrize(("ending", "off"), [("apng", 0), ("webp", 3)])
def test_files_with_all_colours_keep_them_and_what_is_transparent(tmp_path, ending, off):
    frames = [np.full((9, 14, 4), 255, dtype=np.uint8) for _ in range(3)]
    for k, frame in enumerate(frames):
        frame[..., :3] = (200, 30 + 60 * k, 90)
        frame[:, :7, 3] = 0
    path = tmp_path / f"moving.{ending}"
    write_animation(frames, path, seconds=0.9)
    with Image.open(path) as film:
        assert film.n_frames == 3
        for k in range(3):
            film.seek(k)
            film.load()
            assert film.info["duration"] == pytest.approx(300)
            seen = np.asarray(film.convert("RGBA")).astype(int)
            assert np.abs(seen[:, 8:] - frames[k][:, 8:]).max() <= off
            assert (seen[:, :6, 3] == 0).all()


def test_gif_shows_on_white_what_is_transparent(tmp_path):
    frames = [np.zeros((8, 12, 4), dtype=np.uint8) for _ in range(2)]
    frames[1][..., 3] = 255
    write_animation(frames, tmp_path / "moving.gif", seconds=1.0)
    with Image.open(tmp_path / "moving.gif") as film:
        means = []
        for k in range(2):
            film.seek(k)
            means.append(float(np.asarray(film.convert("RGB")).mean()))
    assert means == pytest.approx([255, 0], abs=2)


def test_a_film_is_refused_before_anything_is_drawn(tmp_path, monkeypatch):
    with pytest.raises(InputError, match=r"got 'moving.avi', expected a name in .gif, .apng"):
        write_animation([np.zeros((2, 2, 3), np.uint8)], tmp_path / "moving.avi", seconds=1.0)
    with pytest.raises(InputError, match="got no picture, expected one or more"):
        write_animation([], tmp_path / "moving.gif", seconds=1.0)
    sizes = [np.zeros((2, 2, 3), np.uint8), np.zeros((2, 4, 3), np.uint8)]
    with pytest.raises(InputError, match="got 2 x 2 and 4 x 2, expected pictures of one size"):
        write_animation(sizes, tmp_path / "moving.gif", seconds=1.0)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="got no program ffmpeg, expected ffmpeg"):
        check_animation(tmp_path / "moving.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="a shell script stands for a program")
def test_ffmpeg_that_fails_is_quoted_and_leaves_no_file(tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\necho no encoder >&2\nexit 3\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    with pytest.raises(InputError, match="ffmpeg, which ended with 3: no encoder"):
        write_animation([np.zeros((2, 2, 3), np.uint8)], tmp_path / "a.mp4", seconds=1.0)
    assert [p.name for p in tmp_path.iterdir()] == ["ffmpeg"]


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs the program ffmpeg")
def test_mp4_is_written_by_ffmpeg(tmp_path):
    frames = [np.full((17, 31, 3), 40 * k, dtype=np.uint8) for k in range(4)]
    write_animation(frames, tmp_path / "moving.mp4", seconds=2.0)
    assert (tmp_path / "moving.mp4").read_bytes()[4:8] == b"ftyp"
