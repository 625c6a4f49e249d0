"""Which lines of the modules of a reader can be reached from it: writers beside it do not count."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

Node = ast.FunctionDef | ast.ClassDef | ast.Assign | ast.AnnAssign


def readers_lines(files: Iterable[Path], entries: Iterable[str]) -> dict[Path, set[int]]:
    """Return file -> its lines but those of functions and classes that no entry leads to.

    What leads where goes by names alone: a function is reached where its name stands in one that is
    reached. That takes too much for reachable, never too little. A class counts as a whole.

    Parameters
    ----------
    files : modules of one reader
    entries : names of the functions to begin with
    """
    trees = {file: ast.parse(file.read_text()) for file in files}
    named: dict[str, list[Node]] = {}
    for tree in trees.values():
        for node in tree.body:
            for name in _names(node):
                named.setdefault(name, []).append(node)
    reached: set[int] = set()
    left = [node for name in entries for node in named[name]]
    while left:
        node = left.pop()
        if id(node) not in reached:
            reached.add(id(node))
            left += [n for word in _words(node) for n in named.get(word, [])]
    return {
        file: {
            line
            for node in tree.body
            if id(node) in reached or not isinstance(node, ast.FunctionDef | ast.ClassDef)
            for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
        }
        for file, tree in trees.items()
    }


def _names(node: ast.stmt) -> Iterator[str]:
    """Names that a statement of a module gives to something."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        yield node.name
    elif isinstance(node, ast.Assign | ast.AnnAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        yield from (part.id for t in targets for part in ast.walk(t) if isinstance(part, ast.Name))


def _words(node: ast.AST) -> Iterator[str]:
    for part in ast.walk(node):
        if isinstance(part, ast.Name):
            yield part.id
        elif isinstance(part, ast.Attribute):
            yield part.attr
