import dataclasses
import itertools

import numpy as np
import pytest
from PIL import Image

from seatlook import io, model
from seatlook.assembly import assemble
from seatlook.chain.film import draw, ends, film, shots, strip
from seatlook.chain.timeline import solve_in_stages
from seatlook.errors import InputError
from support import scenes


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The two panels sewn, then covered; the solution and the folder of its stages."""
    scene = scenes.two_panels(element_size=0.02, gap=0.004)
    stages = (
        model.Stage(name="sew", start=0.0, end=0.1),
        model.Stage(name="cover", start=0.1, end=0.2),
    )
    folder = tmp_path_factory.mktemp("stages")
    cover = assemble(dataclasses.replace(scene, stages=stages))
    return scene, solve_in_stages(cover, folder), folder


def test_shots_run_from_placed_to_rest(made):
    _, solution, folder = made
    taken = shots(solution, folder)
    assert [s.stage for s in ends(taken)] == ["placed", "sew", "cover", "at rest"]
    times = [s.time for s in taken]
    assert times == sorted(times)
    assert len(taken) == 2 + 10
    np.testing.assert_array_equal(taken[0].positions, solution.cover.positions)
    np.testing.assert_array_equal(taken[-1].positions, solution.positions)
    moves = [np.abs(b.positions - a.positions).max() for a, b in itertools.pairwise(taken)]
    assert max(moves) < 0.02
    assert sum(moves) > 0.002


def test_a_folder_without_shapes_and_another_mesh_are_refused(made, tmp_path):
    scene, solution, _ = made
    with pytest.raises(InputError, match="got no shapes, expected the folder of a run"):
        shots(solution, tmp_path)
    other = assemble(dataclasses.replace(scene, element_size=0.025, stages=solution.cover.stages))
    assert len(other.rest) != len(solution.positions)
    (tmp_path / "shapes").mkdir()
    io.write_shapes(
        tmp_path / "shapes" / "1-sew.npz", [0.1], np.zeros((1, len(other.rest), 3), np.float32)
    )
    with pytest.raises(InputError, match=r"1-sew.npz: stages: got \d+ vertices, expected"):
        shots(solution, tmp_path)


def test_strip_lays_out_rows():
    pictures = [np.full((2, 3, 3), k, dtype=np.uint8) for k in range(1, 5)]
    sheet = strip(pictures, columns=3)
    assert sheet.shape == (4, 9, 3)
    assert sheet[0, ::3, 0].tolist() == [1, 2, 3]
    assert sheet[2, ::3, 0].tolist() == [4, 248, 248]


@pytest.mark.render
@pytest.mark.parametrize("rendered", [False, True])
def test_all_panels_are_in_every_picture_and_move(made, rendered):
    scene, solution, folder = made
    camera = dataclasses.replace(scene.cameras[0], size=(160, 120))
    taken = ends(shots(solution, folder))
    rig = scene.rigs[0] if rendered else None
    pictures = list(draw(solution, taken, camera=camera, rig=rig))
    assert len(pictures) == 4
    for picture in pictures:
        assert picture[:120].max() > 20
        border = np.concatenate([picture[0], picture[119], picture[:120, 0], picture[:120, -1]])
        assert np.ptp(border.astype(int)) < 10  # nothing is cut off
    assert np.abs(pictures[0].astype(int) - pictures[-1]).max() > 30


@pytest.mark.render
def test_film_is_a_strip_and_an_animation(made, tmp_path, monkeypatch):
    monkeypatch.setattr("seatlook.chain.film._MOST", 3)
    scene, solution, folder = made
    still, moving = film(solution, folder, tmp_path, camera=scene.cameras[0], width=80)
    with Image.open(still) as strip_of_four:
        assert strip_of_four.size == (3 * 80, 2 * (60 + 30))
    with Image.open(moving) as animation:
        assert (animation.size, animation.n_frames) == ((80, 60 + 30), 3)
