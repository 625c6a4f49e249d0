import tomllib
from dataclasses import replace

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.identify.card_losses import law_stress, losses
from seatlook.io.lsdyna.fabric_card import card_of, fabric_of
from seatlook.io.lsdyna.fabric_deck import read_fabric_card, write_fabric_card
from seatlook.io.material import list_materials, read_material
from seatlook.model import Curve, Hysteresis

LEATHER = read_material("black-leather").fabric
BACK = Curve(strain=[0.0, 0.03, 0.1], stiffness=[9000.0, 12000.0, 14000.0])
LAMINATES = ("leather-laminate", "suede-laminate")


@pytest.fixture
def deck(tmp_path):
    return tmp_path / "cover.k"


@pytest.mark.parametrize("name", list_materials())
def test_read_of_what_was_written_is_the_cloth(deck, name):
    fabric = read_material(name).fabric
    card = card_of(fabric, title=name, coat=name not in LAMINATES)
    write_fabric_card(deck, card)
    read = read_fabric_card(deck)
    made = fabric_of(read, fabric)
    for axis in ("warp", "weft", "shear"):
        np.testing.assert_allclose(getattr(made, axis).strain, getattr(fabric, axis).strain,
                                   rtol=1e-6, atol=1e-9)  # fmt: skip
        np.testing.assert_allclose(
            getattr(made, axis).stiffness, getattr(fabric, axis).stiffness, rtol=1e-6
        )
    assert made.warp_unloading is None
    # Ten columns hold five digits of 3.5556e-10.
    for one in ("thickness", "density", "poisson"):
        assert getattr(made, one) == pytest.approx(getattr(fabric, one), rel=5e-5)
    # Once through the card, nothing changes any more.
    again = card_of(made, title=name, coat=name not in LAMINATES)
    assert again.bending == pytest.approx(card.bending, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("name", [n for n in list_materials() if n not in LAMINATES])
def test_uniaxial_strains_and_shear_are_those_of_our_law(deck, name):
    """Curve and coat together, within 1e-6 of the peak; the way the solver computes it."""
    fabric = read_material(name).fabric
    write_fabric_card(deck, card_of(fabric))
    read = read_fabric_card(deck)
    strain = np.linspace(0.004, 0.2, 99)
    for i in range(3):
        E = np.zeros((len(strain), 3))
        E[:, i] = strain
        law = law_stress(fabric, E)[:, i]
        np.testing.assert_allclose(read.stress(E)[:, i], law, atol=1e-6 * law.max())


def test_mass_and_bending_are_those_of_the_cloth():
    card = card_of(LEATHER)
    assert card.density == pytest.approx(7.5e-10, rel=1e-12)
    mean = 1e3 * np.sqrt(LEATHER.bending_warp * LEATHER.bending_weft)
    assert card.bending == pytest.approx(mean, rel=1e-12)
    assert card.prba * card.ea == pytest.approx(card.prab * card.eb, rel=1e-12)


def test_unloading_and_friction_go_as_far_as_the_card_does(deck):
    fabric = replace(LEATHER, warp_unloading=BACK, shear_hysteresis=Hysteresis(width=30.0))
    card = card_of(fabric)
    write_fabric_card(deck, card)
    made = fabric_of(read_fabric_card(deck), fabric)
    np.testing.assert_allclose(made.warp_unloading.stiffness, BACK.stiffness, rtol=1e-6)
    assert made.weft_unloading is None
    assert 0.0 < card.hysteresis < 1.0
    assert made.shear_hysteresis is None
    assert "friction in shear" in {row[0] for row in losses(fabric, card)}


def test_coats_that_carry_too_much_are_refused():
    with pytest.raises(InputError, match=r"LCA: got coats that carry 2196 of 3400 N/m"):
        card_of(read_material("leather-laminate").fabric)


def test_the_commands_there_and_back(tmp_path, deck, capsys):
    assert run(["materials", "export", "woven", "--out", str(deck)]) == 0
    said = capsys.readouterr().out
    assert "pull along 45 degrees" in said
    assert "bending warp" in said
    out = tmp_path / "back.toml"
    assert run(["materials", "import", str(deck), "--base", "woven", "--out", str(out)]) == 0
    made, woven = read_material(out), read_material("woven")
    np.testing.assert_allclose(made.fabric.warp.stiffness, woven.fabric.warp.stiffness, rtol=1e-5)
    assert {*tomllib.loads(out.read_text())["fabric"]} <= set(made.source)
    assert made.source["compression_ratio"] == "judgement: not on the card, as woven"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("       -14", "         4", r"\*MAT_FABRIC_TITLE: got FORM 4, expected FORM -14 or 14"),
        ("*MAT_FABRIC_TITLE", "*MAT_ELASTIC_TITLE", r"file: got no \*MAT_FABRIC"),
        ("       101       102", "       999       102", r"DEFINE_CURVE: got no curve 999"),
        ("*SECTION_SHELL", "*SECTION_SOLID", "thickness: got none in the deck"),
    ],
)
def test_a_deck_without_what_is_needed_is_refused(deck, old, new, message):
    write_fabric_card(deck, card_of(LEATHER))
    deck.write_text(deck.read_text().replace(old, new, 1))
    with pytest.raises(InputError, match=message):
        read_fabric_card(deck)
