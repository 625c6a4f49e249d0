"""Kinds of seams in a scene: read, counted in its digest, refused with their line."""

from __future__ import annotations

import pytest

from seatlook.assembly import assemble
from seatlook.assembly.digest import content_digest
from seatlook.errors import InputError
from seatlook.io.scene.read import load_scene
from seatlook.model import SeamKind
from support.example_scene import EXAMPLE, write_example_files


@pytest.fixture
def load(tmp_path):
    write_example_files(tmp_path)

    def load(more=""):
        (tmp_path / "scene.toml").write_text(EXAMPLE + more)
        return load_scene(tmp_path / "scene.toml")

    return load


@pytest.fixture
def name(load):
    return load().pattern.seams[0].name


def test_kinds_are_read_and_reach_the_cover(load, name):
    scene = load(
        f'\n[seam."{name}"]\nkind = "top stitch 2"\nside = "b"\n[thread]\ngauge_mm = 4.5\n'
    )
    assert dict(scene.seam_kinds) == {name: SeamKind(kind="top stitch 2", side="b")}
    assert scene.thread.gauge == pytest.approx(0.0045)
    assert assemble(scene, element_size=0.03).seam_kinds == scene.seam_kinds


def test_a_kind_is_part_of_the_digest(load, name):
    kinds = ("French", "plain", "lapped")
    digests = {content_digest(load(f'\n[seam."{name}"]\nkind = "{k}"\n')) for k in kinds}
    assert len(digests | {content_digest(load())}) == 4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[seam.nowhere]\nkind = "plain"', r"seam.nowhere: got .*nowhere.*expected one of right"),
        (
            '[seam."NAME"]\nkind = "piped"',
            r"kind: got .*piped.*expected one of plain, top",
        ),
        ('[seam."NAME"]\nside = "b"', r"kind: got nothing"),
        ('[seam."NAME"]\nkind = "plain"\nside = "c"', r"side: got .*c.*expected one of a, b"),
    ],
)
def test_wrong_kinds_are_refused_with_their_line(load, name, text, message):
    with pytest.raises(InputError, match=message) as caught:
        load("\n" + text.replace("NAME", name) + "\n")
    assert any(p.line and p.line > EXAMPLE.count("\n") for p in caught.value.problems)


def test_a_model_refuses_what_is_no_kind():
    with pytest.raises(InputError, match=r"SeamKind.kind: got 'piped', expected one of plain"):
        SeamKind(kind="piped")
