"""Whether the seam that was spoiled is the one that is named, with its side and millimetres.

Run it with: python gallery/seam_advice.py FOLDER [PART ...]

Solves demo seats, one sewing line of each 3 % too long, and good ones, into FOLDER; results that
are there are not solved again. Parts: "demo", the 14 seams of the demo cushion in black leather;
"family", other shapes and materials, 20 good and 20 spoiled. Only solved shapes are read: what was
put in is known to the last columns of docs/charts/seam_advice.csv alone.
"""

from __future__ import annotations

import csv
import sys
import time
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from seatlook import io, seats, solver
from seatlook.assembly import assemble
from seatlook.chain.assess import Assessment, assess
from seatlook.wrinkle import advise

TABLE = Path(__file__).parents[1] / "docs" / "charts" / "seam_advice.csv"
EASE = 0.03
DEMO_SEAMS = 14
# Shape, scale, material, which of its seams is spoiled in the second of each pair.
FAMILY = (
    ("horseshoe", 0.7, "leather-laminate", 1),
    ("horseshoe", 0.7, "suede-laminate", 4),
    ("horseshoe", 0.9, "leather-laminate", 7),
    ("backrest", 0.7, "leather-laminate", 0),
    ("backrest", 0.7, "suede-laminate", 3),
    ("backrest", 0.9, "suede-laminate", 6),
    ("headrest", 0.8, "leather-laminate", 0),
    ("headrest", 0.8, "suede-laminate", 1),
    ("headrest", 1.0, "leather-laminate", 2),
    ("box", 0.7, "leather-laminate", 0),
    ("box", 0.7, "suede-laminate", 2),
    ("box", 0.9, "leather-laminate", 4),
    ("saddle", 0.7, "leather-laminate", 1),
    ("saddle", 0.7, "suede-laminate", 3),
    ("saddle", 0.9, "suede-laminate", 5),
    ("cushion", 0.7, "leather-laminate", 1),
    ("cushion", 0.7, "suede-laminate", 4),
    ("cushion", 0.9, "leather-laminate", 8),
    ("cushion", 0.9, "suede-laminate", 10),
    ("cushion", 0.8, "leather-laminate", 6),
)


@dataclass(frozen=True, kw_only=True)
class Seat:
    """One seat; ``seam`` counts its seams, None is a good seat."""

    part: str
    shape: str
    scale: float
    material: str
    seam: int | None

    @property
    def name(self) -> str:
        """Folder of the seat."""
        which = "good" if self.seam is None else f"seam{self.seam}"
        return f"{self.part}-{self.shape}-{self.scale:g}-{self.material}-{which}"


def seats_of(part: str) -> Iterator[Seat]:
    """List the seats of a part."""
    if part == "demo":
        for seam in (None, *range(DEMO_SEAMS)):
            yield Seat(part=part, shape="cushion", scale=1.0, material="black-leather", seam=seam)
        return
    for shape, scale, material, seam in FAMILY:
        good = Seat(part=part, shape=shape, scale=scale, material=material, seam=None)
        yield from (good, replace(good, seam=seam))


def solved(seat: Seat, folder: Path) -> tuple[str, str, float, Assessment]:
    """Return the spoiled seam, its long side, what was put in [m], and the assessment."""
    place = folder / seat.name
    result = place / "result.npz"
    choices = {"shape": seat.shape, "scale": seat.scale, "material": seat.material}
    if not (place / "scene.toml").is_file():
        seats.write_demo(place, **choices)
    name, panel = "", ""
    if seat.seam is not None:
        seams = tomllib.loads((place / "seams.toml").read_text())["seam"]
        chosen = seams[seat.seam % len(seams)]
        name, panel = chosen["name"], chosen["a"].split(".")[0]
        if not result.is_file():
            seats.write_demo(place, **choices, ease={name: EASE})
    scene = io.load_scene(place / "scene.toml")
    put = 0.0
    if name:
        seam = next(s for s in scene.pattern.seams if s.name == name)
        far = sum(scene.pattern.edge_length(edge) for edge in seam.b)
        put = scene.pattern.edge_length(seam.a) - far
    if not result.is_file():
        started = time.process_time()
        io.write_result(solver.solve(assemble(scene)), result)
        print(f"{seat.name}: {time.process_time() - started:.0f} CPU s", flush=True)
    return name, panel, put, assess(io.read_result(result))


def row_of(seat: Seat, folder: Path) -> dict[str, object]:
    """What is read from a seat, and what was put in."""
    name, panel, put, assessment = solved(seat, folder)
    resolved = [replace(s, resolved=True) for s in assessment.stretches]
    wrinkles = [replace(w, resolved=True) for w in assessment.wrinkles]
    read = advise(assessment.solution, resolved, wrinkles)
    first = read[0] if read else None
    parts = [s for s in resolved if first and (s.seam, s.long_panel) == (first.seam, first.panel)]
    excess = sum(s.excess for s in parts)
    return {
        "seat": seat.name,
        "status": assessment.resolution.status,
        "advice": len(assessment.advice),
        "read": len(read),
        "first_seam": first.seam if first else "",
        "first_panel": first.panel if first else "",
        "action": first.action if first else "",
        "amount_mm": f"{1e3 * first.amount:.2f}" if first else "",
        "scatter_mm": f"{1e3 * first.scatter:.2f}" if first else "",
        "confidence": first.confidence if first else "",
        "compressed_share": f"{sum(s.compression for s in parts) / excess:.2f}" if excess else "",
        "waves_mm": f"{1e3 * sum(s.waves for s in parts):.2f}" if parts else "",
        "spoiled_seam": name,
        "spoiled_panel": panel,
        "put_in_mm": f"{1e3 * put:.2f}",
        "share_found": f"{first.amount / put:.2f}" if first and put else "",
    }


def main(folder: Path, parts: list[str]) -> None:
    """Solve what is missing, read everything, say how many are right."""
    rows: list[dict[str, object]] = []
    for part in parts:
        first = len(rows)
        for seat in seats_of(part):
            rows.append(row_of(seat, folder))
            print(*rows[-1].values(), sep="  ", flush=True)
            write(rows)
        print(part, summary(rows[first:]))


def write(rows: list[dict[str, object]]) -> None:
    """Write the table, so that what is there stays where a later seat fails."""
    with TABLE.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def summary(rows: list[dict[str, object]]) -> str:
    """Say how many seams were named rightly, and how many good seats were left alone."""
    good = [row for row in rows if not row["spoiled_seam"]]
    spoiled = [row for row in rows if row["spoiled_seam"]]
    right = [
        row
        for row in spoiled
        if (row["first_seam"], row["first_panel"]) == (row["spoiled_seam"], row["spoiled_panel"])
    ]
    near = [row for row in right if abs(float(str(row["share_found"])) - 1.0) <= 0.25]
    return (
        f"seam and side right in {len(right)} of {len(spoiled)}, the amount within 25 % in "
        f"{len(near)}; no advice on {sum(not row['read'] for row in good)} of {len(good)} good ones"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:] or ["demo", "family"])
