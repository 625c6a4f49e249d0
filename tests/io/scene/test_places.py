"""Where wires, foam and panels of a scene lie."""

import numpy as np
import pytest

from seatlook.io.curves import write_curves
from seatlook.io.surface.axes import METRES
from seatlook.io.surface.design import write_obj
from support.example_scene import EXAMPLE
from support.io_samples import box


def rewire(folder, *points):
    write_curves({"wire left": np.array(points, float),
                  "wire across": np.array([[0.15, -0.2, 0.08], [0.15, 0.2, 0.08]]),
                  "frame front": np.array([[0.15, -0.2, 0.06], [0.15, 0.2, 0.06]])},
                 folder / "curves.toml")  # fmt: skip


def test_hook_line_longer_than_its_wire(refused, folder):
    rewire(folder, [0.15, -0.2, 0.08], [0.15, 0.2, 0.08])
    got, line = refused(("seed = 0", "seed = 1"))
    assert got == [
        f"scene.toml:{line('line = ')}: hook[0].line: got 'left bolster', 460.2 mm long, "
        "expected at most the length of its wire 'wire left', 400.0 mm"
    ]


def test_wire_inside_solid_foam(refused, folder):
    rewire(folder, [0.15, -0.23, 0.06], [0.15, 0.23, 0.08])
    got, line = refused(("seed = 0", "seed = 1"))
    # The box is 100 mm high and 500 mm deep: 38 mm down at 20 mm or more from its front.
    (message,) = got
    where = f"scene.toml:{line('wire = ')}: hook[0].wire: got 'wire left', "
    assert message.startswith(where)
    depth = float(message.removeprefix(where).split(" mm inside solid foam")[0])
    assert depth == pytest.approx(39.5, abs=0.6)
    assert message.endswith("expected a wire in a trench, or at most 30 mm below the surface")


def test_wire_that_leaves_the_foam_is_not_inside_it(load, folder):
    rewire(folder, [0.15, -0.23, 0.18], [0.15, 0.23, 0.18])
    assert set(load().foam.curves) == {"wire left", "wire across", "frame front"}


@pytest.mark.parametrize(
    ("unit", "written", "size", "fits"),
    [
        ("mm", "m", "0.0005", '0.5 m in "m"'),
        ("m", "mm", "500", '0.5 m in "mm"'),
        ("mm", "inch", "0.01969", '0.1969 m in "cm" or 0.5 m in "inch"'),
    ],
)
def test_foam_in_the_wrong_unit(refused, folder, unit, written, size, fits):
    """A box half a metre wide, read in another unit than it is written in."""
    corners, faces = box()
    write_obj(1e-3 * corners / METRES[written], faces, folder / "foam.obj")
    got, line = refused(('unit = "mm"', f'unit = "{unit}"'))
    assert got[0] == (
        f'scene.toml:{line("unit = ")}: foam.unit: got "{unit}", by which foam.obj is {size} m '
        f'wide, expected 0.05 to 3 m (unit = "{unit}" is taken; it is {fits})'
    )


def test_panels_placed_on_each_other(refused):
    front = '[placement.FRONT]\naxes = ["+x", "+z"]\ntranslation_mm = [-260.0, -260.0, -20.0]'
    on_it = '[placement.FRONT]\naxes = ["+x", "+y"]\ntranslation_mm = [-260.0, -260.0, {}]'
    got, line = refused((front, on_it.format(130.0)))
    (message,) = got
    assert message.startswith(f"scene.toml:{line('[placement.FRONT]')}: placement.FRONT: got ")
    assert message.endswith(
        " cm2 on CENTER, in the same plane, expected panels beside or above each other"
    )
    # 300 x 100 mm; the front edge bulges by 10 mm (2/3 of 300 x 10 mm2), the sides by 6 mm, of
    # which 2.2 cm2 each lie in front.
    assert float(message.split("got ")[1].split(" cm2")[0]) == pytest.approx(324.5, abs=0.5)


def test_panels_placed_above_each_other(load):
    front = 'axes = ["+x", "+z"]\ntranslation_mm = [-260.0, -260.0, -20.0]'
    assert front in EXAMPLE
    above = 'axes = ["+x", "+y"]\ntranslation_mm = [-260.0, -260.0, 140.0]'
    assert load(EXAMPLE.replace(front, above)).placement["FRONT"].translation[2] == 0.14
