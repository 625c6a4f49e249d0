"""What the source code is like, read from its syntax trees: imports, lengths, parameters."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse.csgraph import connected_components

Graph = dict[str, set[str]]


@dataclass(frozen=True)
class Function:
    """A function: its module, name, code lines without the docstring, and number of parameters."""

    module: str
    name: str
    lines: int
    parameters: int


def modules(package: Path) -> dict[str, Path]:
    """Every module of a package, by its dotted name."""
    names = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        names[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return names


def import_graph(package: Path) -> Graph:
    """Module -> modules of the package that it imports: on top, inside functions, for types only.

    ``from a.b import c`` is an import of the module ``a.b.c`` if there is one, else of ``a.b``.
    """
    paths = modules(package)
    return {name: set(_imports(path, paths)) - {name} for name, path in paths.items()}


def _imports(path: Path, known: dict[str, Path]) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom) and node.module in known:
            longer = (f"{node.module}.{alias.name}" for alias in node.names)
            yield from (name if name in known else node.module for name in longer)


def circles(graph: Graph) -> list[list[str]]:
    """Modules that import each other round and about, circle by circle."""
    names = sorted(graph)
    place = {name: k for k, name in enumerate(names)}
    links = np.zeros((len(names), len(names)))
    for name, imported in graph.items():
        links[place[name], [place[other] for other in imported]] = 1
    count, label = connected_components(links, directed=True, connection="strong")
    groups = ([names[k] for k in np.flatnonzero(label == group)] for group in range(count))
    return sorted(group for group in groups if len(group) > 1)


def functions(package: Path) -> Iterator[Function]:
    """Every function and method of a package; self and cls are no parameters."""
    for module, path in modules(package).items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield Function(module, node.name, _code_lines(node), _parameters(node))


def _code_lines(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines from the first statement after the docstring to the last."""
    documented = ast.get_docstring(function) is not None
    body = function.body[1:] if documented else function.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


def _parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    given = function.args
    named = [a.arg for a in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    rest = [a.arg for a in (given.vararg, given.kwarg) if a is not None]
    return len([name for name in named + rest if name not in ("self", "cls")])
