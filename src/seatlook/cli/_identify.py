"""The command that makes a material file from the curves of a laboratory."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from seatlook.cli._output import Json, note, show_json, table
from seatlook.errors import InputError
from seatlook.model.table import spaced

if TYPE_CHECKING:
    from seatlook.identify.findings import Identified


def identify(
    tests: Annotated[Path, Parameter(help="File of tests (TOML), which names curves as CSV.")],
    /,
    *,
    out: Annotated[Path, Parameter(help="Material file (TOML) to write.")],
    report: Path | None = None,
    foam: str = "foam-seat",
    force: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Make a material, or a foam, from the curves of test rigs.

    Prints every number with its standard error and its source. What no test says is taken from the
    base that the file of tests names, and stays "judgement". Notes say where the model cannot
    follow a record.

    Example: seatlook identify tests.toml --out my-cloth.toml

    Parameters
    ----------
    report
        Folder for a page: every test again in the virtual rig against what was measured, and what
        follows for wrinkles.
    foam
        Foam of that outlook, a name or a file.
    force
        Overwrite the material file if it is there.
    """
    from seatlook.identify.material import identify_file
    from seatlook.io.parameter_text import write_material

    if out.exists() and not force:
        raise InputError.single(
            "--out", got="a file that is there", expected="a new one", file=out, hint="or --force"
        )
    found = identify_file(tests)
    made = found.foam if found.material is None else found.material
    assert made is not None
    write_material(out, made, head=f"Identified from {tests.name}, {found.laboratory.place}.")
    if json:
        show_json(document(found))
    else:
        table(("key", "value", "standard_error", "source"), _rows(found), json=False)
    if report is not None:
        note(f"page: {_write_page(found, report, out.stem, foam)}")
    note(*found.notes, f"{'foam' if found.material is None else 'material'}: {out}")


def _write_page(found: Identified, folder: Path, name: str, foam: str) -> Path:
    from seatlook import io
    from seatlook.identify.outlook import outlook
    from seatlook.identify.rig.retest import retests
    from seatlook.report.identify_page import write_identify_page

    if found.material is None:
        return write_identify_page(found, (), (), folder, name=name)
    fabric = found.material.fabric
    below = io.read_foam_material(foam)
    retested = tuple(retests(found.laboratory.tests, fabric))
    rows = outlook(fabric, below)
    return write_identify_page(found, retested, rows, folder, name=name, foam=below.name)


def _rows(found: Identified) -> list[tuple[Any, ...]]:
    rows: list[tuple[Any, ...]] = [
        (one.key, spaced(one.numbers), spaced(one.errors), one.source) for one in found.findings
    ]
    return rows + [(key, "not measured", None, why) for key, why in found.assumed.items()]


def document(found: Identified) -> dict[str, Any]:
    """Return all findings as JSON holds them."""
    return {
        "findings": [
            {
                "key": one.key,
                "value": one.numbers,
                "standard_error": one.errors,
                "source": one.source,
            }
            for one in found.findings
        ],
        "not_measured": dict(found.assumed),
        "residuals": [
            {"test": one.test, "kind": one.kind, "rms_share": one.rms, "worst_share": one.worst,
             "at": one.at, "follows": one.follows}
            for one in found.residuals
        ],
        "notes": list(found.notes),
    }  # fmt: skip
