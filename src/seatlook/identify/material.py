"""From tests to a material: what was measured, and what stays judgement."""

from __future__ import annotations

import dataclasses
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.identify.bending import assumed_twist, identify_stiffness
from seatlook.identify.compression import foam_of, identify_foam, thickness_under
from seatlook.identify.findings import Identified, Ledger
from seatlook.identify.look import identify_look
from seatlook.identify.membrane import bounded_poisson, identify_membrane
from seatlook.io.laboratory.read import read_laboratory
from seatlook.io.laboratory.types import Laboratory, Look
from seatlook.io.material import material_path, read_foam_material, read_material
from seatlook.io.parameter_text import file_key
from seatlook.model import Appearance, Fabric, FoamMaterial, Material

_FOAM_KINDS = ("foam", "incline")
_HISTORY = ("warp_unloading", "weft_unloading", "shear_hysteresis", "bending_warp_hysteresis",
            "bending_weft_hysteresis")  # fmt: skip
# field -> which test would measure it
_WANTED = MappingProxyType(
    {
        "thickness": "compression, or a number in [sheet]",
        "density": "a number in [sheet]",
        "warp": "tensile along warp",
        "weft": "tensile along weft",
        "shear": "shear, bias-extension, or tensile at 45 degrees",
        "poisson": "tensile with contraction, or held and free strips of one direction",
        "compression_ratio": "no test of these",
        "bending_warp": "bending or cantilever along warp",
        "bending_weft": "bending or cantilever along weft",
        "bending_twist": "bending at 45 degrees",
        "bending_poisson": "no test of these",
    }
)


def identify_file(path: Any) -> Identified:
    """Read a file of tests and identify its material; see ``identify``."""
    return identify(read_laboratory(path))


def identify(laboratory: Laboratory) -> Identified:
    """Find the material, or the foam, that gives the curves of the tests back.

    What no test says is taken from the base and stays "judgement".

    Raises
    ------
    InputError
        The base is not there; tests of a cloth and of a foam in one file; numbers that contradict
        each other so far that no stiffness is positive definite.
    """
    foams = [test for test in laboratory.tests if test.kind in _FOAM_KINDS]
    if foams and len(foams) < len(laboratory.tests):
        raise InputError.single(
            "test", got="tests of a cloth and of a foam", expected="a file for each",
            file=laboratory.file,
        )  # fmt: skip
    ledger = Ledger(laboratory)
    path = material_path(laboratory.base, beside=laboratory.file.parent)
    if foams:
        return _foam(ledger, read_foam_material(path))
    base = read_material(path)
    _sheet(ledger)
    identify_membrane(ledger, base.fabric)
    identify_stiffness(ledger, base.fabric)
    return _cloth(ledger, base)


def _sheet(ledger: Ledger) -> None:
    """Enter thickness and density, which other tests need."""
    laboratory = ledger.laboratory
    for name in ("thickness", "density"):
        value = getattr(laboratory, name)
        if value is not None:
            ledger.findings[name] = _plain(ledger, name, value)
    for test in ledger.tests("compression"):
        found = thickness_under(test)
        how = f"compression at {test.numbers['at_pa']:g} Pa"
        ledger.enter("thickness", float(found.values[0]), test, found.sigma, how)
    for test in ledger.tests("surface"):
        heights = [float(one.y.std()) for one in test.specimens]
        ledger.notes.append(
            f"surface: {1e6 * np.mean(heights):.3g} um RMS; a hint for texture_depth_mm, not taken"
        )


def _plain(ledger: Ledger, name: str, value: float) -> Any:
    from seatlook.identify.findings import Finding

    laboratory = ledger.laboratory
    source = f"[sheet] of {laboratory.file.name}, {laboratory.place}, {laboratory.date}"
    return Finding(field=name, value=value, sigma=None, source=source)


def _cloth(ledger: Ledger, base: Material) -> Identified:
    values: dict[str, Any] = {
        field.name: ledger.value(field.name, base.fabric) for field in dataclasses.fields(Fabric)
    }
    # The way back of another cloth is no judgement of this one.
    values |= {name: None for name in _HISTORY if name not in ledger.findings}
    assumed = {name: "" for name in _WANTED if name not in ledger.findings}
    if "bending_twist" in assumed and {"bending_warp", "bending_weft"} <= ledger.findings.keys():
        D11, D22, nu = (values[f"bending_{n}"] for n in ("warp", "weft", "poisson"))
        values["bending_twist"] = assumed_twist(D11, D22, nu)
        assumed["bending_twist"] = "(1 - bending_poisson) / 2 of the mean of warp and weft"
    values["poisson"], cut = bounded_poisson(values)
    if cut:
        ledger.notes.append(
            f"poisson was lowered to {values['poisson']:.3g}, the most that keeps the stiffness "
            "positive definite where the curves are softest"
        )
    _settle_unloading(ledger, values)
    fabric = Fabric(**values)
    keys = {name: file_key(name)[0] for name in values}
    source = {keys[one.field]: one.sources for one in ledger.findings.values()
              if values.get(one.field) is not None}  # fmt: skip
    for name, why in assumed.items():
        given = base.source.get(keys[name], "judgement")
        text = why or f"{given.removeprefix('judgement: ')}, as {base.name}"
        source[keys[name]] = f"judgement: not measured; {text}"
    looks = {k: v for k, v in base.source.items() if k not in keys.values()}
    order = {key: source[key] for name, key in keys.items() if key in source}
    appearance = dataclasses.replace(base.appearance, maps=None)
    if ledger.laboratory.look is not None:
        appearance, measured = _surface(ledger, ledger.laboratory.look, appearance)
        looks |= measured
    material = dataclasses.replace(
        base, name=ledger.laboratory.file.stem, fabric=fabric,
        appearance=appearance,
        source=MappingProxyType(order | looks),
    )  # fmt: skip
    return _done(ledger, material, None, assumed)


def _surface(ledger: Ledger, look: Look, like: Appearance) -> tuple[Appearance, dict[str, str]]:
    """Appearance of what instruments measured, and the sources of its numbers."""
    appearance, residual = identify_look(look, like)
    laboratory = ledger.laboratory
    how = f"colour by {look.geometry} and {look.gloss_60:g} GU at 60 degrees" if residual is None \
        else f"goniometer, residual {100 * residual:.2g} %"  # fmt: skip
    text = f"{how}, {look.file.name}, {laboratory.place}, {laboratory.date}"
    names = ("albedo", "roughness") if residual is None else ("albedo", "roughness", "f0")
    if residual is not None:
        ledger.notes.append(f"goniometer: RMS residual {100 * residual:.2g} % of the readings")
    return appearance, dict.fromkeys(names, text)


def _settle_unloading(ledger: Ledger, values: dict[str, Any]) -> None:
    """Leave out a way back that the law cannot follow, and say so."""
    for axis in ("warp", "weft"):
        name = f"{axis}_unloading"
        if values[name] is None:
            continue
        try:
            Fabric(**(values | {other: None for other in _HISTORY if other != name}))
        except InputError as error:
            if name not in error.problems[0].key:
                raise
            values[name] = None
            ledger.notes.append(f"{name} is left out: {error.problems[0].got}")


def _foam(ledger: Ledger, base: FoamMaterial) -> Identified:
    foam = dataclasses.replace(base, name=ledger.laboratory.file.stem)
    for test in ledger.tests("foam"):
        curve = identify_foam(test)
        foam = foam_of(curve, foam, foam.name)
        ledger.residual(test, curve.residual)
        ledger.enter("strain", curve.strain, test)
        ledger.enter("stress", curve.stress, test, curve.sigma)
        ledger.enter("young", curve.young, test, how=f"{test.title}, secant of the first 5 %")
        if curve.back is not None:
            ledger.enter("unloading_stress", curve.back, test)
        lost = curve.hysteresis
        ledger.notes.append(
            f"CLD40 {1e-3 * curve.cld40:.3g} kPa"
            + ("" if lost is None else f", hysteresis {100 * lost:.3g} %")
        )
    for test in ledger.tests("incline"):
        angles = np.concatenate([one.y for one in test.specimens])
        friction = float(np.tan(angles).mean())
        foam = dataclasses.replace(foam, friction=friction)
        ledger.enter("friction", friction, test, how="tangent of the incline at which it slides")
    keys = ("strain", "stress", "young", "poisson", "friction", "unloading_stress")
    names = {name: file_key(name)[0] for name in keys}
    assumed = {
        name: "" for name in keys if name not in ledger.findings and getattr(foam, name) is not None
    }
    source = {names[one.field]: one.sources for one in ledger.findings.values()}
    for name in assumed:
        given = base.source.get(names[name], "judgement").removeprefix("judgement: ")
        source[names[name]] = f"judgement: not measured; {given}, as {base.name}"
    order = {names[k]: source[names[k]] for k in keys if names[k] in source}
    foam = dataclasses.replace(foam, source=MappingProxyType(order))
    return _done(ledger, None, foam, assumed)


def _done(
    ledger: Ledger, material: Material | None, foam: FoamMaterial | None, assumed: dict[str, str]
) -> Identified:
    wanted = {
        file_key(name)[0]: why or _WANTED.get(name, "no test of these")
        for name, why in assumed.items()
    }
    notes = list(ledger.notes)
    notes += [
        f"{one.test} ({one.kind}): the model leaves the record by {100 * one.worst:+.2g} % of its "
        f"peak at {one.at:.3g}"
        for one in ledger.residuals
        if not one.follows
    ]
    return Identified(
        laboratory=ledger.laboratory, material=material, foam=foam,
        findings=tuple(ledger.findings.values()), assumed=MappingProxyType(wanted),
        residuals=tuple(ledger.residuals), notes=tuple(notes),
    )  # fmt: skip
