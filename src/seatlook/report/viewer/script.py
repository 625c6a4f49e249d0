"""Modules of a page as one classic script: a page opened from a folder can load no modules."""

from __future__ import annotations

import re
from pathlib import Path

_FOLDER = Path(__file__).with_name("script")
_IMPORT = re.compile(
    r'^import \{([^}]*)\} from "((?:\./|(?:\.\./)+)[a-z_/]+)\.js";\n', re.MULTILINE
)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|const|class) )", re.MULTILINE)
_NAME = re.compile(
    r"^(?:export )?(?:async )?(?:(?:function|class) (\w+)|(?:const|let) (\w+) =)", re.MULTILINE
)
_LEFT = re.compile(r"^\s*(?:import|export)\b.*$", re.MULTILINE)


def joined(first: str = "main", folder: Path = _FOLDER) -> str:
    """Return a module and all that it imports, each after those it needs, in one function.

    Modules share one scope there, so no two may give the same name, and an import may not rename.

    Raises
    ------
    ValueError
        A name that is given twice, a circle of imports, an import or export in another form, or
        text that would end the page's script element.
    """
    texts: dict[Path, str] = {}
    _visit((folder / f"{first}.js").resolve(), texts, ())
    owner: dict[str, str] = {}
    for path, text in texts.items():
        module = path.stem
        for name in map("".join, _NAME.findall(text)):
            if name in owner:
                raise ValueError(f"{module}.js: {name} is also given by {owner[name]}.js")
            owner[name] = module
    body = "\n".join(_EXPORT.sub("", _IMPORT.sub("", text)) for text in texts.values())
    odd = _LEFT.search(body)
    if odd:
        raise ValueError(f"cannot join {odd.group().strip()!r}")
    if "</script" in body or "<!--" in body:
        raise ValueError("a script in a page must not hold what would end it")
    return f'"use strict";\n(() => {{\n{body}}})();\n'


def _visit(path: Path, texts: dict[Path, str], above: tuple[Path, ...]) -> None:
    """Add the modules that one needs, then itself."""
    if path in above:
        circle = " > ".join(one.stem for one in (*above, path))
        raise ValueError(f"imports go in a circle: {circle}")
    if path in texts:
        return
    text = path.read_text(encoding="utf-8")
    for names, other in _IMPORT.findall(text):
        if " as " in names:
            raise ValueError(f"{path.name} renames what it imports from {other}.js")
        _visit((path.parent / f"{other}.js").resolve(), texts, (*above, path))
    texts[path] = text
