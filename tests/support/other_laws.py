"""Files as three instruments write them, of cloths by laws that are not those of seatlook."""

from __future__ import annotations

import numpy as np

HEAD = 'base = "{base}"\nlaboratory = "{name}"\ndate = "2026-11-30"\n'


def instrument_sets():
    """Name of a law -> writer(folder), which returns the file of tests and whether it is left."""
    return {"fung": fung, "crimp": crimp, "creep": creep}


def _write(folder, name, base, x, y, heads, keys, separator=",", decimal="."):
    rows = [separator.join(f"{v:.6g}" for v in row).replace(".", decimal)
            for row in zip(x, y, strict=True)]  # fmt: skip
    text = separator.join(heads) + "\n" + "\n".join(rows) + "\n"
    (folder / f"{name}.csv").write_text(text)
    path = folder / "tests.toml"
    path.write_text(
        HEAD.format(base=base, name=name) + f'[[test]]\nfiles = ["{name}.csv"]\n' + keys
    )
    return path


def fung(folder):
    """Leather by an exponential of the strain, pulled out only; a testing machine in N and mm."""
    rng = np.random.default_rng(5)
    e = np.linspace(0, 0.18, 80)
    F = 250.0 * np.expm1(9.0 * e)  # N/m
    F = 0.05 * (F + 0.004 * F.max() * rng.normal(size=len(F)))
    keys = (
        'kind = "tensile"\ndirection = "warp"\nsides = "held"\nlength_mm = 100\nwidth_mm = 50\n'
        'strain = { column = "Extension", unit = "mm" }\nforce = { column = "Load", unit = "N" }\n'
    )
    return _write(folder, "machine", "black-leather", 100 * e, F,
                  ("Extension [mm]", "Load [N]"), keys), False  # fmt: skip


def crimp(folder):
    """Weave by a crimp that straightens (hyperbola), with a way back of its own; KES in gf/cm."""
    rng = np.random.default_rng(6)
    e = np.concatenate([np.linspace(0, 0.05, 60), np.linspace(0.05, 0.0, 60)[1:]])
    out = 6000.0 * e + 9000.0 * (np.hypot(e - 0.03, 0.008) - np.hypot(0.03, 0.008) + e)
    back = out[59] * (np.clip(e - 0.008, 0, None) / 0.042) ** 2.2
    F = np.where(np.arange(len(e)) < 60, out, np.minimum(back, out)) / 0.980665
    F += 0.004 * F.max() * rng.normal(size=len(F))
    keys = (
        'kind = "tensile"\ndirection = "weft"\nsides = "held"\n'
        'strain = { column = 1, unit = "%" }\nforce = { column = 2, unit = "gf/cm" }\n'
    )
    return _write(
        folder, "kes", "woven", 100 * e, F, ("elongation", "force"), keys, ";", ","
    ), False


def creep(folder):
    """Knit that relaxes while the machine turns: a drop that no elastic law has."""
    rng = np.random.default_rng(7)
    e = np.concatenate([np.linspace(0, 0.12, 60), np.linspace(0.12, 0.0, 60)[1:]])
    F = 3000.0 * e + 30000.0 * e**2
    F[60:] = 0.92 * F[59] * np.clip((e[60:] - 0.004) / 0.116, 0, None) ** 1.9
    F += 0.003 * F.max() * rng.normal(size=len(F))
    keys = (
        'kind = "tensile"\ndirection = "warp"\nsides = "held"\n'
        'strain = { column = "e", unit = "%" }\nforce = { column = "F", unit = "N/cm" }\n'
    )
    return _write(folder, "frame", "woven", 100 * e, F / 100, ("e", "F"), keys, "\t"), True
