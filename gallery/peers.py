"""The hanging strip of the work-precision chart by other programs, where they are installed.

Run it with: python gallery/peers.py

CalculiX (package calculix-ccx of the distribution) with its shells of 3, 6 and 8 nodes, and MuJoCo
(package mujoco) with its flexible sheet, which swings until it hangs still. Rows of what is not
installed are not made, and the script says so; those in docs/charts/peers.csv are kept and not run
again. One thread; the time of CalculiX is that of its process, reading and expanding the mesh
included, that of MuJoCo from the compiled model to rest.
"""

from __future__ import annotations

import csv
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "docs" / "charts" / "peers.csv"
sys.path.insert(0, str(ROOT / "tests"))

from support import meshes  # noqa: E402
from support.reference.elastica import hanging_tip  # noqa: E402

COLUMNS = ("panel", "series", "parameter", "seed", "cpu_seconds", "error")
GAMMA, SLENDERNESS, WIDTH = 10.0, 0.02, 0.2
YOUNG, DENSITY = 12.0 / SLENDERNESS**3, 1.0 / SLENDERNESS  # B = 1 and 1 kg/m2
Mesh = tuple[np.ndarray, np.ndarray]
Run = Callable[[], tuple[float, float]]  # CPU s and error


def tip_error(x: float, z: float) -> float:
    """Distance of the tip from the extensible elastica's, over the length."""
    exact = hanging_tip(GAMMA, SLENDERNESS)
    return float(np.hypot(x - exact[0], z - exact[1]))


def with_middles(X: np.ndarray, T: np.ndarray) -> Mesh:
    """Triangles with a node in the middle of every edge."""
    pairs = np.sort(np.stack([T, np.roll(T, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    ends, place = np.unique(pairs, axis=0, return_inverse=True)
    return np.concatenate([X, X[ends].mean(axis=1)]), np.hstack([T, len(X) + place.reshape(-1, 3)])


def quads(edges: int) -> Mesh:
    """Squares with a node in the middle of every edge, one element for two edges of the others."""
    nx, ny = max(1, edges // 2), max(1, round(edges * WIDTH / 2))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(2 * nx + 1), np.arange(2 * ny + 1)))
    keep = (i % 2 == 0) | (j % 2 == 0)
    number = np.full((2 * nx + 1, 2 * ny + 1), -1)
    number[i[keep], j[keep]] = np.arange(keep.sum())
    X = np.column_stack([i[keep] / (2 * nx), WIDTH * j[keep] / (2 * ny)])
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    corner = [(2 * a, 2 * b) for a in range(nx) for b in range(ny)]
    return X, np.array([[number[p + u, q + v] for u, v in around] for p, q in corner])


def deck(X: np.ndarray, T: np.ndarray, shell: str) -> str:
    """Input of CalculiX: a strip clamped at x = 0 under its own weight."""
    nodes = "\n".join(f"{i + 1}, {x:.9g}, {y:.9g}, 0" for i, (x, y) in enumerate(X))
    cells = "\n".join(f"{i + 1}, " + ", ".join(str(n + 1) for n in t) for i, t in enumerate(T))
    held = "\n".join(str(i + 1) for i in np.flatnonzero(X[:, 0] < 1e-9))
    tip = "\n".join(str(i + 1) for i in np.flatnonzero(X[:, 0] > 1 - 1e-9))
    return f"""*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE={shell}, ELSET=STRIP
{cells}
*NSET, NSET=HELD
{held}
*NSET, NSET=TIP
{tip}
*MATERIAL, NAME=M
*ELASTIC
{YOUNG}, 0
*DENSITY
{DENSITY}
*SHELL SECTION, ELSET=STRIP, MATERIAL=M
{SLENDERNESS}
*BOUNDARY
HELD, 1, 6
*STEP, NLGEOM, INC=1000
*STATIC
0.05, 1
*DLOAD
STRIP, GRAV, {GAMMA}, 0, 0, -1
*NODE PRINT, NSET=TIP, FREQUENCY=1000
U
*END STEP
"""


def calculix(shell: str, edges: int) -> tuple[float, float]:
    """Tip of the strip by CalculiX; nan where it gives up."""
    if shell == "S8R":
        X, T = quads(edges)
    else:
        X, T = meshes.rectangle("uns", 1.0, WIDTH, 1.0 / edges)
        if shell == "S6":
            X, T = with_middles(X, T)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "strip.inp").write_text(deck(X, T, shell), encoding="ascii")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(["ccx", "strip"], cwd=folder, capture_output=True, text=True,
                              env=os.environ | {"OMP_NUM_THREADS": "1"}, check=False)  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        text = Path(folder, "strip.dat").read_text(encoding="ascii")
    rows = [line.split() for line in text.splitlines() if len(line.split()) == 4]
    if done.returncode or "Job finished" not in done.stdout or not rows:
        return cpu, float("nan")
    u = np.array(rows, dtype=float)[-int((X[:, 0] > 1 - 1e-9).sum()) :]
    return cpu, tip_error(1.0 + u[:, 1].mean(), u[:, 3].mean())


def mujoco_sheet(edges: int) -> tuple[float, float]:
    """Tip of the strip by MuJoCo, mirrored about the clamp, swinging with damping until still."""
    import mujoco

    X, T = meshes.rectangle("right", 2.0, WIDTH, 1.0 / edges)
    X = X - [1.0, 0.0]
    held = np.flatnonzero(np.abs(X[:, 0]) < 1e-9)
    # A fifth of the time in which a wave crosses an edge.
    step = 0.2 / edges / np.sqrt(YOUNG / DENSITY)
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="{step:.3g}" gravity="0 0 {-GAMMA}"><flag contact="disable"/></option>
      <worldbody><flexcomp name="strip" type="direct" dim="2" radius="0.001" mass="1"
        point="{" ".join(f"{x:.9g} {y:.9g} 0" for x, y in X)}"
        element="{" ".join(str(n) for n in T.ravel())}">
        <pin id="{" ".join(str(i) for i in held)}"/>
        <contact contype="0" conaffinity="0" selfcollide="none"/>
        <elasticity young="{YOUNG}" poisson="0" thickness="{SLENDERNESS}" elastic2d="both"/>
      </flexcomp></worldbody></mujoco>""")
    p = X[T]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    share = np.repeat(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 6.0, 3)
    # Its own mass is the same for every vertex, twice what it should be at the rim.
    mass = np.bincount(T.ravel(), share, minlength=len(X))
    body = model.flex_vertbodyid[: len(X)]
    moved = np.setdiff1d(np.arange(len(X)), held)
    model.body_mass[body[moved]] = mass[moved]
    model.dof_damping[:] = 4.0 * model.body_mass[model.dof_bodyid]
    data = mujoco.MjData(model)
    clock = time.process_time()
    for _ in range(400):
        mujoco.mj_step(model, data, nstep=round(0.05 / step))
        if data.time > 1.0 and np.abs(data.qvel).max() < 1e-4:
            break
    else:
        return time.process_time() - clock, float("nan")
    cpu = time.process_time() - clock
    tip = data.flexvert_xpos[: len(X)][X[:, 0] > 1 - 1e-9].mean(axis=0)
    return cpu, tip_error(tip[0], tip[2])


def cases() -> Iterator[tuple[str, int, Run]]:
    """Series, edges per length and run, of the programs that are there."""
    if shutil.which("ccx") is None:
        print("CalculiX is not installed: no rows of it (apt install calculix-ccx)")
    else:
        for shell in ("S3", "S6", "S8R"):
            for edges in (5, 10, 20):
                yield f"CalculiX {shell}", edges, partial(calculix, shell, edges)
    try:
        import mujoco
    except ImportError:
        print("MuJoCo is not installed: no rows of it (pip install mujoco)")
    else:
        for edges in (5, 10, 20):
            yield f"MuJoCo {mujoco.__version__} flex", edges, partial(mujoco_sheet, edges)


def main() -> None:
    """Run what the table lacks."""
    if not TABLE.exists():
        TABLE.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    with TABLE.open(encoding="utf-8") as file:
        done = {(row["series"], row["parameter"]) for row in csv.DictReader(file)}
    for series, edges, run in cases():
        if (series, str(edges)) in done:
            continue
        cpu, error = run()
        row = ("equilibrium", series, edges, 0, f"{cpu:.4f}", f"{error:.3g}")
        print(*row, flush=True)
        with TABLE.open("a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerow(row)


if __name__ == "__main__":
    main()
