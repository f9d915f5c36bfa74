"""From Python 3.12 on `sum` adds floats with a compensation; cards must not depend on it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import deamat

_PACKAGE = Path(deamat.__file__).parent
_MODULES = sorted(p.relative_to(_PACKAGE).as_posix() for p in _PACKAGE.rglob("*.py"))


def _counts(call: ast.Call) -> bool:
    """Say whether a call of `sum` counts things: lengths, comparisons, truths, entries of a dict."""
    what = call.args[0]
    if isinstance(what, ast.GeneratorExp):
        each = what.elt
        return isinstance(each, ast.Compare) or (
            isinstance(each, ast.Call) and ast.unparse(each.func) == "len"
        )
    return ast.unparse(what).startswith("map(bool, ") or ast.unparse(what) == "files.values()"


@pytest.mark.parametrize("module", [m for m in _MODULES if not m.startswith("twin/")])
def test_floats_are_added_by_fsum(module: str) -> None:
    tree = ast.parse((_PACKAGE / module).read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "sum":
            assert _counts(node), f"{module}:{node.lineno}: {ast.unparse(node)}: use math.fsum"
