"""Set-ups that no solve can mend, on seats of the family; all of them in tests/validate."""

import re
import warnings

import pytest

from seatlook.assembly import assemble
from seatlook.assembly.contradictions import contradictions, out_of_scale
from seatlook.cli import run
from seatlook.errors import InputWarning
from support.broken import SET_UPS, GoodSeat, refused_names

SHAPES = ("headrest", "box", "horseshoe")
SIZE = {"element_size_mm": 30.0, "surface_size": 0.016}
pytestmark = pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")
# Nothing is hooked on a headrest, and its two seams are not 100 mm apart.
NONE = {
    *(("headrest", way) for way in ("hooks_that_contradict", "hooks_to_the_other_side")),
    *(("box", way) for way in ("hooks_to_the_other_side", "exchanged_partners")),
}


@pytest.fixture(scope="module", params=SHAPES)
def seat(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return GoodSeat(folder, shape=request.param, **SIZE)


def some(spoiled):
    """The first, the middle and the last of what can be made."""
    return [spoiled[k] for k in sorted({0, len(spoiled) // 2, len(spoiled) - 1})] if spoiled else []


def test_a_good_seat_is_not_refused(seat):
    assert out_of_scale(seat.scene) == ()
    assert contradictions(seat.scene, assemble(seat.scene)) == ()


@pytest.mark.parametrize("way", SET_UPS)
def test_a_broken_seat_is_refused(seat, way):
    made = list(SET_UPS[way](seat))
    assert bool(made) == ((seat.shape, way) not in NONE)
    for spoiled in some(made):
        assert set(spoiled.names) & refused_names(spoiled.scene), spoiled.what


@pytest.mark.parametrize("way", SET_UPS)
def test_the_command_says_file_line_and_places(seat, way, tmp_path, capsys):
    """On the small seat, and on one with wires what cannot be made there."""
    if seat.shape != ("horseshoe" if ("headrest", way) in NONE else "headrest"):
        return
    spoiled = next(iter(SET_UPS[way](seat)))
    scene = seat.write(spoiled.scene, tmp_path)
    assert run(["check", str(scene), "--quiet"]) == 2
    said = capsys.readouterr().err
    assert re.search(rf"{re.escape(str(tmp_path))}/(scene|seams)\.toml:\d+: ", said), said
    if way == "patterns_out_of_scale":
        assert re.search(r"panels of [\d.e+]+ cm2, [\d.]+ times the foam's area", said)
    else:
        assert len(re.findall(r"\(-?\d+, -?\d+, -?\d+\) mm", said)) >= 1
        assert (tmp_path / "check" / "assembly.png").exists()
