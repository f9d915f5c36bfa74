"""Blocks of a module (bodies of functions, branches, loops): which one a line belongs to."""

from __future__ import annotations

import ast
from collections.abc import Iterator

HIT = "note_block_"
BODIES = ("body", "orelse", "finalbody")


def instrumented(source: str, file: str) -> str:
    """The module with a note at the start of every block that a test runs."""
    tree = ast.parse(source)
    for body, inside in list(_bodies(tree)):
        if inside:
            at = 1 if _is_docstring(body[0]) else 0
            body.insert(at, ast.parse(f"{HIT}({block_name(file, body[0].lineno)!r})").body[0])
    start = sum(1 for node in tree.body if _is_docstring(node) or _is_future(node))
    tree.body.insert(start, ast.parse(f"from benchmarks.mutation.hits import hit as {HIT}").body[0])
    return ast.unparse(ast.fix_missing_locations(tree))


def block_of(source: str, file: str, line: int) -> str | None:
    """The name of the innermost block around a line; None for what runs at import."""
    around = [
        (last - body[0].lineno, body[0].lineno)
        for body, inside in _bodies(ast.parse(source))
        if inside and body[0].lineno <= line <= (last := body[-1].end_lineno or 0)
    ]
    return block_name(file, min(around)[1]) if around else None


def block_name(file: str, line: int) -> str:
    """What a block is called in the log."""
    return f"{file}:{line}"


def _bodies(node: ast.AST, inside: bool = False) -> Iterator[tuple[list[ast.stmt], bool]]:
    inner = inside or isinstance(node, ast.FunctionDef)
    for field in BODIES:
        body = getattr(node, field, None)
        if isinstance(body, list) and body:
            yield body, inner and not isinstance(node, ast.ClassDef)
    for child in ast.iter_child_nodes(node):
        yield from _bodies(child, inner and not isinstance(child, ast.ClassDef))


def _is_docstring(node: ast.stmt) -> bool:
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def _is_future(node: ast.stmt) -> bool:
    return isinstance(node, ast.ImportFrom) and node.module == "__future__"
