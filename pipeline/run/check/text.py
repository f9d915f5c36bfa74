"""What a look at a file gave, in words for the laboratory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from deamat.core.present import aligned
from deamat.run.check.found import Checked, Column, Reading
from deamat.run.check.preview import preview

_WIDE = 110
_FAULTS = 8  # of a file that are shown


def text(checked: Checked) -> str:
    """Return the lines about one file."""
    return "\n".join(_lines(checked))


def _lines(checked: Checked) -> Iterator[str]:
    yield checked.path
    if not checked.read:
        yield f"  NOT READ   {checked.faults[0]}"
        yield from (f"             {fault}" for fault in checked.faults[1:_FAULTS])
        if len(checked.faults) > _FAULTS:
            yield f"             and {len(checked.faults) - _FAULTS} more (--json lists them all)"
        if checked.nearest:
            yield f"  nearest    {checked.nearest}"
        if checked.hint:
            yield f"  hint       {checked.hint}"
        return
    title = f": {checked.title}" if checked.title else ""
    yield f"  form       {checked.form}{title}, {checked.encoding}"
    yield f"  table      lines {checked.first_line} to {checked.last_line}"
    yield from (f"             {_short(row)}" for row in checked.rows)
    yield from _columns(checked.columns)
    if checked.unused:
        yield f"  not used   {checked.unused}"
    alike: dict[Reading, list[str]] = {}
    for reading in checked.readings:
        alike.setdefault(replace(reading, technique="", missing=()), []).append(reading.technique)
    for reading, techniques in alike.items():
        missing = [one.missing for one in checked.readings if one.technique in techniques]
        yield from _reading(reading, techniques, missing)
    yield from _curve(checked)


def _columns(columns: tuple[Column, ...]) -> Iterator[str]:
    rows = [
        (c.name, f"from {c.least:.6g} to {c.greatest:.6g}", _written(c)) for c in columns
    ]  # fmt: skip
    for at, line in enumerate(aligned(rows)):
        yield f"  {'' if at else 'columns':<11}{line}"


def _written(column: Column) -> str:
    if not column.label:
        return ""
    return f"as {column.label}" + (f" [{column.unit}]" if column.unit else "")


def _reading(
    reading: Reading, techniques: Sequence[str], missing: Sequence[tuple[str, ...]]
) -> Iterator[str]:
    """What techniques make of a file; several that make the same of it are named together."""
    row = f", with {reading.row}" if reading.row else ""
    yield f"  {' or '.join(techniques)}{row}"
    if reading.runs:
        yield f"    runs     {reading.runs}"
    for name, said, method in aligned_values(reading):
        yield f"    {name}  {said}  ({method})" if method else f"    {name}  {said}"
    for reason in reading.refused:
        yield f"    refused  {reason}"
    for technique, names in zip(techniques, missing, strict=True):
        if names:
            yield f"    fill in  {', '.join(names)} for {technique}"
    for flag in reading.flags:
        yield f"    flag     {flag}"


def aligned_values(reading: Reading) -> list[tuple[str, str, str]]:
    """Return name, value and method of each value, the names of one length."""
    wide = max((len(value.name) for value in reading.values), default=0)
    return [(value.name.ljust(wide), value.said, value.method) for value in reading.values]


def _curve(checked: Checked) -> Iterator[str]:
    """Each curve once, though two techniques look at it."""
    curves = dict.fromkeys(r.curve for r in checked.readings if r.curve is not None)
    for curve in curves:
        yield ""
        yield from (f"  {line}" for line in preview(curve))


def _short(row: str) -> str:
    return row if len(row) <= _WIDE else row[:_WIDE] + "..."
