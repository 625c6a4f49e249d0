"""A laboratory that tests known fabrics: curves with noise, drift, slack, any unit and sign."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from seatlook.identify.elastica import outline
from seatlook.identify.loops import loop_reading
from seatlook.identify.tensile import force, force_back
from seatlook.model import Curve, Fabric, Hysteresis

GF_CM = 0.980665
FORCE = {"N/m": 1.0, "gf/cm": GF_CM, "N/cm": 100.0, "N": 5.0, "gf": 5.0 * 9.80665e-3}  # of 200 mm
STRAIN = {"1": 1.0, "%": 0.01, "mm": 1e-3 / 0.05}  # of 50 mm
ANGLE = {"deg": np.pi / 180.0, "rad": 1.0}
CURVATURE = {"1/m": 1.0, "1/cm": 100.0}
MOMENT = {"N": 1.0, "gf cm/cm": 9.80665e-3, "mN": 1e-3}
HEAD = """base = "{base}"
laboratory = "Synthetic laboratory"
date = "2026-11-30"

[sheet]
thickness_mm = {thickness}
density_kg_per_m2 = {density}
"""


@dataclass
class Bench:
    """How a laboratory measures: noise and drift as shares of the peak, slack as strain."""

    seed: int = 0
    noise: float = 0.01
    drift: float = 0.005
    offset: float = 0.001
    slack: float = 0.002
    scatter: float = 0.002
    specimens: int = 12
    variants: bool = True
    knots: bool = False
    lines: list[str] = field(default_factory=list)

    def __post_init__(self):
        self.rng = np.random.default_rng(self.seed)

    def reading(self, clean):
        """What an instrument shows of a clean record."""
        rng, peak = self.rng, np.abs(clean).max()
        wander = rng.normal(0, self.offset) + rng.normal(0, self.drift) * np.linspace(
            0.0, 1.0, len(clean)
        )
        own = 1.0 + rng.normal(0, self.scatter)
        return own * clean + peak * (wander + self.noise * rng.normal(size=len(clean)))

    def unit(self, units):
        names = list(units)
        return names[self.rng.integers(len(names))] if self.variants else names[0]

    def sign(self):
        return self.rng.choice([-1.0, 1.0]) if self.variants else 1.0

    def write(self, folder: Path, name, kind, columns, records, **keys):
        """Write one CSV and its [[test]]; columns: (key, unit, factor, sign)."""
        heads = ",".join(["piece", *(f"{key} [{unit}]" for key, unit, _, _ in columns)])
        rows = [
            ",".join([str(i), *(f"{sign * v / factor:.7g}" for v, (_, _, factor, sign)
                                in zip(row, columns, strict=True))])
            for i, record in enumerate(records) for row in zip(*record, strict=True)
        ]  # fmt: skip
        (folder / f"{name}.csv").write_text("\n".join([heads, *rows]) + "\n")
        self.lines += [f'\n[[test]]\nkind = "{kind}"\nfiles = ["{name}.csv"]\nspecimen = "piece"']
        self.lines += [
            f'{key} = {{ column = "{key} [{unit}]", unit = "{unit}" }}'
            for key, unit, _, _ in columns
        ]
        self.lines += [f"{key} = {value}" for key, value in keys.items()]

    def tensile(self, folder, fabric, axis, peak):
        """Strip biaxial test, as in KES: out to a strain and back."""
        out, back = getattr(fabric, axis), getattr(fabric, f"{axis}_unloading")
        records = []
        for _ in range(self.specimens):
            slack = self.rng.uniform(0, self.slack)
            e = np.concatenate([np.linspace(-slack, peak, 26), np.linspace(peak, -slack, 25)[1:]])
            F = force(out, e)
            if back is not None:
                F[26:] = force_back(out, back, e[26:], peak)
            records.append((e + slack, self.reading(F)))
        u, v = self.unit(STRAIN), self.unit(FORCE)
        columns = [("strain", u, STRAIN[u], 1.0), ("force", v, FORCE[v], self.sign())]
        keys = {"direction": f'"{axis}"', "sides": '"held"', "length_mm": 50, "width_mm": 200}
        if self.knots:
            keys["knots"] = out.strain.tolist()
        self.write(folder, f"tensile-{axis}", "tensile", columns, records, **keys)

    def shear(self, folder, fabric, pretension=9.81):
        """A loop of eight degrees."""
        top = np.radians(8.0)
        g = np.concatenate([np.linspace(0, top, 11), np.linspace(top, -top, 21)[1:],
                            np.linspace(-top, 0, 20)[1:]])  # fmt: skip
        path = np.tan(g)
        clean = loop_reading(fabric.shear, fabric.shear_hysteresis, path) + pretension * path
        records = [(g, self.reading(clean)) for _ in range(self.specimens)]
        u, v, sign = self.unit(ANGLE), self.unit(FORCE), self.sign()
        columns = [("angle", u, ANGLE[u], sign), ("force", v, FORCE[v], sign)]
        keys = {"pretension_n_per_m": pretension, "width_mm": 200, "length_mm": 50}
        if self.knots:
            keys["knots"] = fabric.shear.strain.tolist()
        self.write(folder, "shear", "shear", columns, records, **keys)

    def bending(self, folder, fabric, axis):
        """A loop of 2.5 per cm."""
        k = np.concatenate([np.linspace(0, 250, 11), np.linspace(250, -250, 21)[1:],
                            np.linspace(-250, 0, 20)[1:]])  # fmt: skip
        clean = loop_reading(*bending_law(fabric, axis), k)
        records = [(k, self.reading(clean)) for _ in range(self.specimens)]
        u, v, sign = self.unit(CURVATURE), self.unit(MOMENT), self.sign()
        columns = [("curvature", u, CURVATURE[u], sign), ("moment", v, MOMENT[v], sign)]
        self.write(folder, f"bending-{axis}", "bending", columns, records,
                   direction=f'"{axis}"')  # fmt: skip

    def hanging(self, folder, axis, load, length):
        """The traced outline of one strip."""
        points = length * outline(load, 25)
        columns = [("distance", "mm", 1e-3, 1.0), ("depth", "mm", 1e-3, self.sign())]
        self.write(folder, f"hanging-{axis}", "hanging-strip", columns, [points.T],
                   direction=f'"{axis}"')  # fmt: skip

    def finish(self, folder, fabric, base="woven"):
        """Write the file of tests and return its path."""
        head = HEAD.format(base=base, thickness=1e3 * fabric.thickness, density=fabric.density)
        path = folder / "tests.toml"
        path.write_text(head + "\n".join(self.lines) + "\n")
        return path


def bending_law(fabric, axis):
    """Elastic part and friction of bending, as the tester sees it."""
    stiffness = getattr(fabric, f"bending_{axis}")
    width = getattr(fabric, f"bending_{axis}_hysteresis")
    friction = None if width is None else Hysteresis(width=width, strain=12.0)
    return Curve.linear(stiffness), friction


def fabrics(count=12, seed=1):
    """Fabrics from soft weave to leather, all with their ways back, and the strains of the test."""
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        peak = rng.uniform(0.05, 0.10)
        knots = np.array([0.0, 0.25, 0.5, 1.0]) * (peak + 0.5 * peak**2)
        curves = {}
        for axis in ("warp", "weft"):
            stiffness = np.exp(rng.uniform(np.log(3e3), np.log(1.2e4))) * np.cumprod(
                [1.0, *rng.uniform(0.85, 1.6, 3)]
            )
            more = stiffness * rng.uniform(0.2, 0.8, 4)
            curves[axis] = Curve(strain=knots, stiffness=stiffness)
            curves[f"{axis}_unloading"] = Curve(strain=knots, stiffness=stiffness + more)
        G = np.exp(rng.uniform(np.log(200.0), np.log(2000.0)))
        reach = np.tan(np.radians(8.0))
        width = G * rng.uniform(0.02, 0.05)
        D = np.exp(rng.uniform(np.log(6e-5), np.log(6e-4), 2))
        fabric = Fabric(
            thickness=1e-3, density=float(rng.uniform(0.3, 1.0)), **curves,
            shear=Curve(strain=[0.0, reach], stiffness=[G, G * rng.uniform(1.0, 1.6)]),
            shear_hysteresis=Hysteresis(width=width, growth=G * rng.uniform(0.05, 0.3),
                                        strain=rng.uniform(0.006, 0.012)),
            poisson=0.2, compression_ratio=0.3, bending_warp=D[0], bending_weft=D[1],
            bending_twist=0.3 * np.sqrt(D[0] * D[1]),
            bending_warp_hysteresis=D[0] * rng.uniform(20, 80),
            bending_weft_hysteresis=D[1] * rng.uniform(20, 80),
        )  # fmt: skip
        out.append((fabric, float(peak)))
    return out


def whole_set(folder, fabric, peak, bench):
    """Write tension, shear and bending of a fabric; return the file of tests."""
    for axis in ("warp", "weft"):
        bench.tensile(folder, fabric, axis, peak)
        bench.bending(folder, fabric, axis)
    bench.shear(folder, fabric)
    return bench.finish(folder, fabric)
