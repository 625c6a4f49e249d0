"""Strain that an earlier revision left in flat panels; record it anew from the sources of one.

Run it from the folder of the tests: python -m support.flattening_before SRC

SRC is the folder ``src`` of a checkout of 08838e7, the last revision with Gauss-Newton steps and
one conformal start. The surfaces are kept with the figures: they would be meshed otherwise by now.
What that revision could not flatten is left out.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from seatlook import io, mesh
from seatlook.flattening import DesignSurface
from seatlook.model import FloatArray
from seatlook.seats import SHAPES, design_surface, shaped
from seatlook.seats.demo import demo_design

FILE = Path(__file__).parents[1] / "data" / "flattening_before.npz"
SIZE = 0.012  # m
QUANTILE = 0.99
# Run by the other revision, whose names are others.
OTHER = """
import sys
from pathlib import Path
import numpy as np
from seatlook import io
from seatlook.design import DesignSurface, flatten
surface = DesignSurface(**io.read_surface(Path(sys.argv[1]), unit="mm")._asdict())
np.save(sys.argv[2], flatten(surface).strain)
"""


def figures(surface: DesignSurface, strain: FloatArray) -> FloatArray:
    """Root mean square and 99 % quantile of every panel's strains (m, 2), by area: (p, 2) [1]."""
    area = mesh.face_areas(surface.vertices, surface.faces)
    rows = []
    for number in range(len(surface.panel_names)):
        own = surface.panel == number
        size, share = np.abs(strain[own]).ravel(), np.repeat(area[own], 2)
        order = np.argsort(size)
        run = np.cumsum(share[order]) / share.sum()
        rms = np.sqrt(share @ size**2 / share.sum())
        rows.append((rms, size[order][np.searchsorted(run, QUANTILE)]))
    return np.array(rows)


def surfaces() -> Iterator[tuple[str, DesignSurface]]:
    """The demo and its family without the lines in panels, in single precision."""
    drawn = {"demo": demo_design(element_size=0.010)}
    for shape in SHAPES:
        drawn[shape] = design_surface(shaped(shape), element_size=SIZE)
    for name, surface in drawn.items():
        vertices = surface.vertices.astype(np.float32)
        yield name, bare(vertices, surface.faces, surface.panel, surface.panel_names)


def bare(vertices, faces, panel, names) -> DesignSurface:
    """Return a surface of plain arrays."""
    return DesignSurface(
        vertices=np.asarray(vertices, dtype=np.float64),
        faces=np.asarray(faces, dtype=np.int64),
        panel=np.asarray(panel, dtype=np.int64),
        panel_names=tuple(map(str, names)),
    )


def kept() -> dict[str, tuple[DesignSurface, FloatArray]]:
    """Surfaces, and the figures (p, 2) of their panels."""
    with np.load(FILE) as file:
        parts = ("vertices", "faces", "panel", "names")
        return {
            name: (bare(*(file[f"{name}/{part}"] for part in parts)), file[f"{name}/figures"])
            for name in file["surfaces"].tolist()
        }


def strain_before(surface: DesignSurface, source: Path, folder: Path) -> FloatArray | None:
    """Strain (m, 2) that the revision in a folder leaves; None where it fails."""
    drawn, out = folder / "surface.obj", folder / "strain.npy"
    rows = (surface.vertices, surface.faces, surface.panel, surface.panel_names)
    io.write_surface(io.GroupedMesh(*rows), drawn)
    done = subprocess.run(
        [sys.executable, "-c", OTHER, str(drawn), str(out)],
        env={**os.environ, "PYTHONPATH": str(source)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    print("flattened" if done.returncode == 0 else done.stderr.strip().splitlines()[-1], flush=True)
    if done.returncode:
        return None
    # Faces come in the order of the file: panel by panel.
    strain = np.empty((len(surface.faces), 2))
    strain[np.argsort(surface.panel, kind="stable")] = np.load(out)
    return strain


def main() -> None:
    """Record the figures of the revision given."""
    rows, names = {}, []
    with tempfile.TemporaryDirectory() as folder:
        for name, surface in surfaces():
            print(name, end=": ")
            strain = strain_before(surface, Path(sys.argv[1]), Path(folder))
            if strain is None:
                continue
            names.append(name)
            rows |= {
                f"{name}/vertices": surface.vertices.astype(np.float32),
                f"{name}/faces": surface.faces.astype(np.uint16),
                f"{name}/panel": surface.panel.astype(np.uint8),
                f"{name}/names": np.array(surface.panel_names),
                f"{name}/figures": figures(surface, strain),
            }
    np.savez_compressed(FILE, surfaces=np.array(names), **rows)


if __name__ == "__main__":
    main()
