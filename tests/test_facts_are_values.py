"""What a floor reads of another is a typed field: nobody goes by diagnostics, or by words.

Diagnostics and texts (reasons, methods, details, notes) are for people. A static look at every
module finds who reads them to decide or to compute.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

# They show diagnostics to people.
SHOW = re.compile(r"pipeline/((materials|core)/present\.py|materials/trace\.py|report/.*)")

PROSE = {"reason", "method", "detail", "note", "message", "hint", "why"}
LOOKED_INTO = {
    *("startswith", "endswith", "partition", "rpartition", "split", "rsplit", "find", "index"),
    *("removeprefix", "removesuffix", "count"),
}
SEARCHES = {"match", "fullmatch", "search", "findall", "finditer", "split"}
COUNTED = {"coefficients", "parameters"}


def parents_of(tree: ast.AST) -> dict[ast.AST, ast.AST]:
    return {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}


def reads_of_diagnostics(tree: ast.AST) -> Iterator[int]:
    """Lines on which diagnostics are read, other than to hand them on whole."""
    parents = parents_of(tree)
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr="diagnostics", ctx=ast.Load()):
                if not _handed_on(node, parents[node]):
                    yield node.lineno
            case (
                ast.Subscript(slice=ast.Constant("diagnostics"), ctx=ast.Load())
                | ast.Call(func=ast.Attribute(attr="get"), args=[ast.Constant("diagnostics"), *_])
                | ast.Call(func=ast.Name("getattr"), args=[_, ast.Constant("diagnostics"), *_])
                | ast.Call(func=ast.Name("attrgetter"), args=[ast.Constant("diagnostics"), *_])
            ):
                yield node.lineno


def _handed_on(node: ast.expr, parent: ast.AST) -> bool:
    match parent:
        case ast.keyword(arg="diagnostics"):
            return True
        case ast.Dict(keys=keys, values=values):
            return any(k is None and v is node for k, v in zip(keys, values, strict=True))
    return False


def decisions_by_words(tree: ast.AST) -> Iterator[int]:
    """Lines on which a text for people, a class's name or a number of coefficients decides."""
    errors = {n.name for n in ast.walk(tree) if isinstance(n, ast.ExceptHandler) and n.name}
    for node in ast.walk(tree):
        match node:
            case ast.Compare(left=left, ops=ops, comparators=comparators):
                if all(isinstance(op, ast.Is | ast.IsNot) for op in ops):
                    continue  # whether there is a text decides, not what it says
                told = [left, *comparators]
                if any(_is_prose(e, errors) or _is_name(e) or _is_count(e) for e in told):
                    yield node.lineno
            case ast.Call(func=ast.Attribute(value=looked_at, attr=how)) if (
                how in LOOKED_INTO and _is_prose(looked_at, errors)
            ):
                yield node.lineno
            case ast.Call(func=ast.Attribute(attr=how), args=arguments) if how in SEARCHES and any(
                _is_prose(a, errors) for a in arguments
            ):
                yield node.lineno
            case ast.Subscript(slice=key) if _is_name(key) or _is_count(key):
                yield node.lineno
            case ast.Match(subject=subject) if (
                _is_prose(subject, errors) or _is_name(subject) or _is_count(subject)
            ):
                yield node.lineno


def _is_prose(node: ast.AST, errors: set[str]) -> bool:
    match node:
        case ast.Attribute(attr=name) | ast.Name(name):
            return name in PROSE
        case ast.Call(func=ast.Name("str"), args=[ast.Name(name)]):
            return name in errors
        case ast.Call(func=ast.Attribute(value=inner, attr="casefold" | "lower" | "strip")):
            return _is_prose(inner, errors)
    return False


def _is_name(node: ast.AST) -> bool:
    """Whether it is the name of a class: `type(x).__name__`, `x.__class__.__name__`."""
    match node:
        case ast.Attribute(attr="__name__" | "__qualname__", value=ast.Call(func=ast.Name("type"))):
            return True
        case ast.Attribute(attr="__name__" | "__qualname__", value=ast.Attribute(attr="__class__")):
            return True
    return False


def _is_count(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Name("len"), args=[ast.Attribute(attr=name)]):
            return name in COUNTED
    return False


def modules() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted([*(ROOT / "pipeline").rglob("*.py"), *(ROOT / "benchmarks").rglob("*.py")]):
        name = path.relative_to(ROOT).as_posix()
        yield name, ast.parse(path.read_text(encoding="utf-8"))


def test_diagnostics_are_read_only_to_be_shown() -> None:
    found = [
        f"{name}:{line}"
        for name, tree in modules()
        if not SHOW.fullmatch(name)
        for line in reads_of_diagnostics(tree)
    ]
    assert found == []


def test_nobody_decides_by_words() -> None:
    found = [f"{name}:{line}" for name, tree in modules() for line in decisions_by_words(tree)]
    assert found == []


@pytest.mark.parametrize(
    "code",
    [
        "limit = float(record.diagnostics['area_ratio_limit'])",
        "if 'censored' in value.diagnostics: pass",
        "found = law.diagnostics.get('temperature_K')",
        "found = error.diagnostics",
        "for name, value in record.diagnostics.items(): pass",
        "u = spread(record.diagnostics)",
        "found = dict(record.diagnostics)",
        "found = document['diagnostics']",
        "found = document.get('diagnostics', {})",
        "found = getattr(record, 'diagnostics')",
    ],
)
def test_a_read_of_diagnostics_would_be_found(code: str) -> None:
    assert list(reads_of_diagnostics(ast.parse(code))) == [1]


@pytest.mark.parametrize(
    "code",
    [
        "replace(law, diagnostics={**law.diagnostics, 'runs': 3})",
        "Refusal(key, error.reason, 'm', 'c', diagnostics=error.diagnostics)",
        "Origin(diagnostics=value.diagnostics)",
        "self.diagnostics = dict(found)",
    ],
)
def test_diagnostics_may_be_handed_on(code: str) -> None:
    assert list(reads_of_diagnostics(ast.parse(code))) == []


@pytest.mark.parametrize(
    "code",
    [
        "x = entry.reason.startswith('no technique')",
        "x = entry.path in entry.reason",
        "x = entry.note.partition('campaign ')[2]",
        "x = record.method.lower() == 'mean'",
        "x = 'lower bound' in cell.note",
        "x = [reason.partition(' ')[0] for reason in reasons]",
        "x = re.search('found', refusal.reason)",
        "x = error.__class__.__name__ == 'RawFileError'",
        "x = FORMS[type(fit).__name__]",
        "x = KINDS[len(fit.parameters)]",
        "x = len(law.coefficients) == 3",
        "match type(fit).__name__:\n    case 'PolynomialFit': pass",
        "try: ask()\nexcept MissingProperty as error:\n    x = str(error).partition('; there is ')",
        "try: ask()\nexcept MissingProperty as error:\n    x = 'refused' in str(error)",
    ],
)
def test_a_decision_by_words_would_be_found(code: str) -> None:
    assert len(list(decisions_by_words(ast.parse(code)))) == 1


@pytest.mark.parametrize(
    "code",
    [
        "x = f'{entry.path}: {entry.reason}'",
        "x = law.kind == POLYNOMIAL",
        "powers = np.arange(len(law.coefficients))",
        "x = isinstance(error, RawFileError)",
        "specimens.setdefault(refusal.reason, [])",
        "x = reason is not None",
    ],
)
def test_words_may_be_written(code: str) -> None:
    assert list(decisions_by_words(ast.parse(code))) == []
