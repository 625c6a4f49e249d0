"""Text files from templates; ``| toml`` spells a value and ``| toml_key`` a key as TOML does."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from seatlook.files import write_text
from seatlook.io.toml import quoted, toml_key


def write_template(template: Path, path: Path, **values: Any) -> None:
    """Fill a template and write the text in one step."""
    environment = Environment(
        loader=FileSystemLoader(template.parent),
        autoescape=False,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"toml": quoted, "toml_key": toml_key, "mm": _millimetres}
    write_text(path, environment.get_template(template.name).render(**values) + "\n")


def _millimetres(metres: float) -> float:
    return round(1e3 * metres, 6)
