"""What a first scene says of its guesses, and what it leaves to be filled in."""

from __future__ import annotations

import numpy as np

from seatlook.assembly.ease import notches_on
from seatlook.assembly.seam_guess import Proposal
from seatlook.assembly.unfolding import Layout
from seatlook.io.toml import quoted
from seatlook.mesh import face_areas
from seatlook.model import Foam, Pattern

# Area of all panels over that of the foam's surface, which a cover goes partly round.
_SMALLEST, _LARGEST = 0.2, 2.5


def seam_reasons(proposal: Proposal) -> dict[str, str]:
    """Seam -> why it was guessed, and what else would fit."""
    return {
        name: reason
        + (f"; would fit as well: {', '.join(also)}" if (also := proposal.rivals.get(name)) else "")
        for name, reason in proposal.reasons.items()
    }


def seam_notes(proposal: Proposal) -> dict[str, str]:
    """Comments for the seams file: the reasons of seams, length and notches of edges."""
    pattern = proposal.pattern
    notes = {}
    for name in pattern.edges:
        at = ", ".join(f"{1e3 * s:.0f}" for s in np.sort(notches_on(pattern, name)))
        marks = f"notches at {at} mm" if at else "no notch"
        free = "; free" if name in proposal.free else ""
        notes[name] = f"{1e3 * pattern.edge_length(name):.1f} mm; {marks}{free}"
    return notes | seam_reasons(proposal)


def doubtful_seams(proposal: Proposal) -> tuple[str, ...]:
    """Comments with the seams that are not sure, to be taken in by hand."""
    remarks = []
    for doubt in proposal.doubtful:
        also = f"; would fit as well: {', '.join(doubt.rivals)}" if doubt.rivals else ""
        near = doubt.a.split(" + ")
        edges = "" if len(near) == 1 else f"\nfirst make one edge of {doubt.a}"
        remarks.append(
            f"not sure, probability {doubt.probability:.2f}{also}{edges}\n"
            f"[[seam]]\nname = {quoted(f'{near[0]} - {doubt.b[0]}')}\n"
            f"a = {quoted(near[0])}\nb = [{', '.join(map(quoted, doubt.b))}]"
        )
    return tuple(remarks)


def what_is_missing(proposal: Proposal, layout: Layout) -> tuple[str, ...]:
    """Say what is left to be filled in by hand."""
    missing = []
    if proposal.doubtful:
        rows = [f"{d.a} with {' + '.join(d.b)} ({d.probability:.2f})" for d in proposal.doubtful]
        missing.append(f"{len(rows)} seams that are not sure: {'; '.join(rows)}")
    if layout.apart:
        missing.append(
            f"seams that join {', '.join(layout.apart)} to {layout.first}; "
            "until then they lie beside the foam"
        )
    framed = {edge for border in layout.borders for edge in border.edges}
    bare = [
        name
        for name in proposal.free
        if name not in framed and proposal.pattern.edges[name].panel not in layout.apart
    ]
    if bare:
        missing.append(f"curves for free edges that make no closed border: {', '.join(bare)}")
    return tuple(missing)


def scale_notes(pattern: Pattern, foam: Foam) -> tuple[str, ...]:
    """Name a pattern that is far too large or too small for its foam."""
    cloth = sum(panel.area for panel in pattern.panels)
    ratio = cloth / float(face_areas(foam.vertices, foam.faces).sum())
    if _SMALLEST <= ratio <= _LARGEST:
        return ()
    what = "small" if ratio < 1 else "large"
    return (
        f"the panels have {ratio:.2g} times the area of the foam: the pattern is too {what} for it "
        "(are --units and --unit right?)",
    )
