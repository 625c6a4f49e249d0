"""The viewer by itself: in a notebook, or as a page without pictures."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from pathlib import Path

from markupsafe import Markup

from seatlook import files
from seatlook.chain.case import Case
from seatlook.model import Camera
from seatlook.report.page.write import content_policy, environment, inert, page_style
from seatlook.report.viewer.section import viewer_section


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewerPage:
    """A page with the viewer alone; a notebook shows it in a frame.

    Parameters
    ----------
    html : text of the page
    height : int [pixels] of the frame
    """

    html: str
    height: int

    def save(self, path: Path | str) -> Path:
        """Write the page into a file."""
        file = Path(path)
        files.write_text(file, self.html)
        return file

    def __repr__(self) -> str:
        return f"ViewerPage({len(self.html) / 1e6:.1f} MB)"

    def _repr_html_(self) -> str:
        # The frame has an origin of its own: nothing in it reaches the notebook.
        return (
            f'<iframe title="The seat" height="{self.height}" width="100%" frameborder="0" '
            f'sandbox="allow-scripts allow-downloads" srcdoc="{escape(self.html)}"></iframe>'
        )


def viewer_page(case: Case, camera: Camera, *, height: int = 620) -> ViewerPage:
    """Return the viewer of a case, which begins with the view of ``camera``."""
    section, style = viewer_section(case, camera), page_style()
    html = (
        environment()
        .get_template("viewer_page.html.j2")
        .render(
            title=case.scene.name,
            policy=content_policy(style, section.script, images="data:"),
            style=Markup(style),
            content=Markup(inert(section.content)),
            script=Markup(section.script),
        )
    )
    return ViewerPage(html=html, height=height)
