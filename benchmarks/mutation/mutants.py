"""What slips can be made in a module: each one is the source text with one expression changed."""

from __future__ import annotations

import ast
import copy
import hashlib
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Div, ast.Mod: ast.Mult, ast.BitOr: ast.BitAnd, ast.BitAnd: ast.BitOr,
}  # fmt: skip
PAIRS = (("min", "max"), ("any", "all"), ("floor", "ceil"), ("minimum", "maximum"))
CALLS = {one: other for pair in PAIRS for one, other in (pair, pair[::-1])}
TYPE_CALLS = {"isinstance", "issubclass", "cast", "TypeVar", "NewType", "TypeAlias"}
UNMOVED = {"dtype", "strict"}  # a type; and a guard of `zip` against what cannot be
DECIDED = (ast.Eq, ast.NotEq, ast.Is, ast.IsNot, ast.In, ast.NotIn)


@dataclass(frozen=True)
class Mutant:
    """One slip: in `file` (within the package's folder), `before` is replaced by `after`."""

    file: str
    function: str
    line: int
    before: str
    after: str
    occurrence: int
    start: int
    end: int

    @property
    def name(self) -> str:
        """A name that outlives edits elsewhere in the file."""
        return "\n".join((self.file, self.function, self.before, self.after, str(self.occurrence)))

    @property
    def place(self) -> str:
        """Where it is, for people."""
        return f"pipeline/{self.file}:{self.line} in {self.function}"

    def applied_to(self, source: str) -> str:
        """The source text with the slip in it."""
        raw = source.encode()
        after = self.after if self.after == "pass" else f"({self.after})"
        if self.after.startswith("return"):
            after = self.after
        return (raw[: self.start] + after.encode() + raw[self.end :]).decode()


def mutants_of(folder: Path, package: str) -> list[Mutant]:
    """All slips in the modules of `folder/package`, in the order of files and lines."""
    found: list[Mutant] = []
    for path in sorted((folder / package).rglob("*.py")):
        found.extend(mutants_in(path.read_text(encoding="utf-8"), str(path.relative_to(folder))))
    return found


def sample_of(mutants: Sequence[Mutant], count: int, seed: int) -> list[Mutant]:
    """Draw `count` of them by the hash of seed and name: an edit changes few of those drawn."""

    def rank(mutant: Mutant) -> str:
        return hashlib.sha256(f"{seed}\n{mutant.name}".encode()).hexdigest()

    drawn = sorted(mutants, key=rank)[:count]
    return sorted(drawn, key=lambda mutant: (mutant.file, mutant.start, mutant.after))


def mutants_in(source: str, file: str) -> Iterator[Mutant]:
    """All slips in one module that still compile."""
    starts = [0]
    for line in source.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    seen: Counter[tuple[str, str, str]] = Counter()
    for node, function, after in _changes(ast.parse(source)):
        end_line, end_col = node.end_lineno, node.end_col_offset
        if end_line is None or end_col is None:
            continue
        key = (function, ast.unparse(node), after)
        mutant = Mutant(
            file, *key[:1], node.lineno, *key[1:], seen[key],
            starts[node.lineno - 1] + node.col_offset, starts[end_line - 1] + end_col,
        )  # fmt: skip
        seen[key] += 1
        yield mutant


Change = tuple[ast.expr | ast.stmt, str, str]


def _changes(tree: ast.Module) -> Iterator[Change]:
    yield from _in_body(tree.body, "<module>")


def _in_body(body: Sequence[ast.stmt], function: str) -> Iterator[Change]:
    for position, statement in enumerate(body):
        if position == 0 and _is_text(statement):
            continue  # the docstring
        yield from _in_statement(statement, function)


def _in_statement(node: ast.stmt, function: str) -> Iterator[Change]:
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            inner = name if function == "<module>" else f"{function}.{name}"
            if isinstance(node, ast.FunctionDef):
                defaults = [*node.args.defaults, *node.args.kw_defaults]
                yield from _in_all([one for one in defaults if one is not None], function)
            yield from _in_body(node.body, inner)
            return
        case ast.If(test=ast.Name(id="TYPE_CHECKING")) | ast.Import() | ast.ImportFrom():
            return
        case ast.Assign(targets=[ast.Name(id="__all__")]):
            return
        case ast.AnnAssign(value=value):
            if value is not None:
                yield from _in_expression(value, function)
            return
        case ast.Return(value=value) if value is not None and not _is_none(value):
            yield node, function, "return None"
        case ast.Expr(value=ast.Call()) | ast.AugAssign() | ast.Raise() | ast.Continue():
            yield node, function, "pass"
        case ast.Break() | ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield node, function, "pass"
        case _:
            pass
    if isinstance(node, ast.If | ast.While):
        yield from _negated(node.test, function)
    for field, value in ast.iter_fields(node):
        if field in {"body", "orelse", "finalbody"}:
            yield from _in_body(value, function)
        elif field == "handlers":
            for handler in value:
                yield from _in_body(handler.body, function)
        elif field == "cases":
            for case in value:
                yield from _in_all([one for one in [case.guard] if one], function)
                yield from _in_body(case.body, function)
        elif field == "items":
            yield from _in_all([item.context_expr for item in value], function)
        elif isinstance(value, ast.expr):
            yield from _in_expression(value, function)


def _in_all(nodes: Sequence[ast.expr], function: str) -> Iterator[Change]:
    for node in nodes:
        yield from _in_expression(node, function)


def _in_expression(node: ast.expr, function: str) -> Iterator[Change]:
    if isinstance(node, ast.JoinedStr) or _called(node) in TYPE_CALLS:
        return
    for changed in _changed(node, function == "<module>"):
        yield node, function, ast.unparse(ast.fix_missing_locations(changed))
    if isinstance(node, ast.IfExp):
        yield from _negated(node.test, function)
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.expr):
            yield from _in_expression(child, function)
        elif isinstance(child, ast.comprehension):
            for condition in child.ifs:
                yield from _negated(condition, function)
            yield from _in_all([child.iter, *child.ifs], function)
        elif isinstance(child, ast.keyword) and child.arg not in UNMOVED:
            yield from _in_expression(child.value, function)


def _negated(test: ast.expr, function: str) -> Iterator[Change]:
    decided = isinstance(test, ast.Compare) and isinstance(test.ops[0], DECIDED)
    if not decided and not isinstance(test, ast.UnaryOp):
        yield test, function, f"not ({ast.unparse(test)})"


def _changed(node: ast.expr, at_import: bool) -> Iterator[ast.expr]:
    match node:
        case ast.Constant(value=bool() as truth):
            yield ast.Constant(not truth)
        case ast.Constant(value=int() as number):
            yield ast.Constant(number + 1)
            yield ast.Constant(number - 1)
        case ast.Constant(value=float() as number):
            yield ast.Constant(2.0 * number if number else 1.0)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            if not isinstance(operand, ast.Constant):
                yield copy.deepcopy(operand)
        case ast.BoolOp(op=op, values=values):
            yield ast.BoolOp(ast.And() if isinstance(op, ast.Or) else ast.Or(), values)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC:
            bits = isinstance(op, ast.BitOr | ast.BitAnd)
            if not (_is_string(left) or _is_string(right) or (bits and at_import)):
                yield ast.BinOp(left, ARITHMETIC[type(op)](), right)
        case ast.Compare(ops=ops):
            for position, comparison in enumerate(ops):
                other = copy.deepcopy(node)
                other.ops[position] = COMPARISONS[type(comparison)]()
                yield other
        case ast.Call():
            yield from _changed_call(node)
        case _:
            return


def _changed_call(node: ast.Call) -> Iterator[ast.expr]:
    name = _called(node)
    if name in CALLS:
        other = copy.deepcopy(node)
        if isinstance(other.func, ast.Name):
            other.func.id = CALLS[name]
        elif isinstance(other.func, ast.Attribute):
            other.func.attr = CALLS[name]
        yield other
    if name[:1].isupper():
        return  # a record needs all its fields: without one it fails at once and tests nothing
    for position, keyword in enumerate(node.keywords):
        if keyword.arg is not None and keyword.arg not in UNMOVED:
            other = copy.deepcopy(node)
            del other.keywords[position]
            yield other


def _called(node: ast.expr) -> str:
    match node:
        case ast.Call(func=ast.Name(id=name)) | ast.Call(func=ast.Attribute(attr=name)):
            return name
    return ""


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and _is_string(node.value)


def _is_string(node: ast.expr) -> bool:
    text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return text or isinstance(node, ast.JoinedStr)


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None
