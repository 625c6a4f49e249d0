"""Strain that flattening leaves in each panel of the surfaces given, turned faces, warnings.

Run it with: python gallery/flattening.py SURFACE ... [--material NAME]

Ends with 1 where a surface cannot be flattened or a face is turned over. How the strain of the
family compares with that of an earlier revision is held by tests/flattening/test_no_worse.py.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Mapping
from pathlib import Path

from seatlook import io, mesh
from seatlook.errors import SeatlookError
from seatlook.flattening import flatten
from seatlook.flattening.files import read_design
from seatlook.model import Fabric


def show(file: Path, fabric: Fabric | None) -> bool:
    """Flatten a surface and print its strains; return whether no face was turned."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            surface = read_design(file)
            cloth: Mapping[str, Fabric] = (
                {} if fabric is None else dict.fromkeys(surface.panel_names, fabric)
            )
            result = flatten(surface, fabrics=cloth)
        except SeatlookError as error:
            print(file.stem, error)
            return False
    turned = sum(
        int((mesh.face_vectors(result.flat[p.name], p.faces)[:, 2] <= 0).sum())
        for p in surface.patches()
    )
    for panel in result.panels:
        print(
            f"{file.stem} {panel.panel}: {turned} faces turned, rms {100 * panel.rms:.1f} %, "
            f"{100 * panel.smallest:.1f} to {100 * panel.largest:.1f} %"
        )
    for warning in said:
        print(" ", warning.message)
    return turned == 0


def main() -> None:
    """Flatten each file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--material")
    chosen = parser.parse_args()
    fabric = io.read_material(chosen.material).fabric if chosen.material else None
    well = [show(file, fabric) for file in chosen.files]
    sys.exit(not all(well))


if __name__ == "__main__":
    main()
