"""Small files of every kind are read, or refused for what is wrong in them and nothing else."""

from functools import partial
from pathlib import Path

import pytest

from seatlook.errors import InputError
from seatlook.io import read_curves, read_dxf, read_material, read_shells, read_surface

CORPUS = Path(__file__).parents[1] / "data" / "corpus"


def read_all(path):
    result = read_shells(path)
    return [result.read(number) for number in range(len(result))]


READERS = {
    "curves": read_curves,
    "d3plot": read_all,
    "deck": read_all,
    "design_obj": partial(read_surface, unit="m", up="z"),
    "dxf": read_dxf,
    "material": read_material,
}
# By the key of the message; all others are read.
REFUSED = {
    "d3plot": {"no_states": "states", "no_thickness": "thickness"},
    "deck": {
        "body.inc": "thickness",
        "include_itself.k": "*INCLUDE",
        "no_strains.k": "*INITIAL_STRAIN_SHELL",
        "no_thickness.k": "thickness",
        "one_level.k": "*INITIAL_STRAIN_SHELL",
        "set_kind.k": "*SET_SHELL_GENERAL",
        "transformation_absent.k": "*INCLUDE_TRANSFORM",
        "transformation_mirror.k": "*DEFINE_TRANSFORMATION",
        "transformation_no_axis.k": "*DEFINE_TRANSFORMATION",
        "transformation_no_point.k": "*DEFINE_TRANSFORMATION",
        "transformation_uneven.k": "*INCLUDE_TRANSFORM",
        "twice.k": "*INITIAL_STRAIN_SHELL",
        "units.k": "*CONTROL_UNITS",
    },
    "design_obj": {"face_without_group.obj": "f"},
    "material": {"both_thresholds.toml": "fabric.first_wrinkle_radius_mm", "maps.toml": "maps"},
}


@pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")
@pytest.mark.parametrize("kind", READERS)
def test_files_are_read_or_refused_for_what_is_wrong(kind):
    found = {}
    for path in sorted((CORPUS / kind).iterdir()):
        try:
            assert READERS[kind](path)
        except InputError as error:
            found[path.name] = error.problems[0].key
    assert found == REFUSED.get(kind, {})


@pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")
def test_decks_that_say_the_same_are_read_alike():
    """Sets, wide and free fields, other cards for thickness, included and moved files."""
    same = [p for p in sorted((CORPUS / "deck").iterdir()) if p.name not in REFUSED["deck"]]
    assert len(same) > 15
    for path in same:
        (state,) = read_all(path)
        bent = state.strain_outer - state.strain_inner
        assert bent.shape == (4, 3, 3), path.name
        # In whatever axes, the strains of all shells are -0.01 in one direction alone.
        size = abs(bent.trace(axis1=1, axis2=2))
        assert size == pytest.approx(0.01, rel=1e-6), path.name
        assert state.thickness == pytest.approx(1e-3), path.name
