"""The command that solves to a tolerance, as a user meets it."""

import json

from seatlook import io
from seatlook.cli import run
from support.scene_files import TEXT, write_two_panels

# It wrinkles at 65 mm on its foam, so that few elements do.
LAMINATE = TEXT.replace('material = "pvc"', 'material = "leather-laminate"')


def test_scene_is_solved_no_finer_than_asked(tmp_path, capsys):
    scene, out = write_two_panels(tmp_path, text=LAMINATE), tmp_path / "fine.npz"
    code = run(["precision", str(scene), "--tolerance", "0.9", "--out", str(out), "--json"])
    told = capsys.readouterr()
    rows = json.loads(told.out)
    assert {row["zone"] for row in rows} >= {"seam middle", "LEFT interior", "RIGHT interior"}
    assert any(row["w2_mesh_error"] > 0.0 for row in rows)
    assert {row["criterion"] for row in rows} == {"tensor, 0.02 per mm"}
    # Eight elements to a wave, however loose the tolerance.
    assert 0.007 < io.read_result(out).cover.element_size < 0.009
    assert ", 8 to a wave of 6" in told.err
    assert "not converged" not in told.err
    assert code == 0, told.err


def test_bad_words_are_refused(tmp_path, capsys):
    scene = str(write_two_panels(tmp_path, text=LAMINATE))
    assert run(["precision", scene, "--out", "fine.vtp"]) == 2
    assert "a name that ends in .npz" in capsys.readouterr().err
    assert run(["precision", scene, "--tolerance", "2"]) == 2
    assert "a share between 0 and 1" in capsys.readouterr().err
