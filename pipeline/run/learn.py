"""Propose a form of `config/exports.toml` from one sample, and ask what the sample does not say."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from deamat.core.errors import ConfigError
from deamat.core.sheets import is_workbook
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.blocks import block_in, split
from deamat.formats.cells import looks_numeric
from deamat.formats.choice import quantity_in_words
from deamat.formats.decimals import Ambiguous, decimal_mark
from deamat.formats.declared import WORKBOOK
from deamat.formats.exports import SEPARATORS
from deamat.formats.plain_tables import Text, texts
from deamat.formats.rawfile import RawFile
from deamat.formats.structure import headings, split_label
from deamat.formats.vocabulary import ASKED, meaning_among, vocabulary
from deamat.formats.workbook import lines_of_sheets

_LARGEST = 1 << 26  # bytes of a sample
_FEWEST = 2  # labels that tell a technique; a single `x` may be anything
_STARTS_WITH = 30  # characters of the first line
_MARKS = {mark: name for name, mark in SEPARATORS.items() if name != WORKBOOK}
_ENCODINGS = {"utf-8-sig": "utf-8", "latin-1": "cp1252"}


@dataclass(frozen=True, slots=True)
class Answers:
    """What the laboratory has said.

    Parameters
    ----------
    technique, decimal : empty where nothing is said
    columns : label (or `#3`) to quantity and unit, either perhaps empty
    factors : label to the ratio of a probe
    sampling_interval_s : 0 where the file has a column of time
    ends_open : the exporter writes no line end after the last row
    """

    technique: str = ""
    decimal: str = ""
    columns: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    sampling_interval_s: float = 0.0
    ends_open: bool = False

    def with_column(self, label: str, quantity: str, unit: str) -> Answers:
        """Add what is said of one column."""
        return replace(self, columns={**self.columns, label: (quantity, unit)})


@dataclass(frozen=True, slots=True)
class Question:
    """What a sample does not say.

    Parameters
    ----------
    text : for a terminal
    flag : how to say it on the command line
    kind : `technique`, `decimal`, `column` (which one is it?), `unit` (of it) or `ends`
    quantity, label : what it is about
    choices : that are possible, empty for any
    """

    text: str
    flag: str
    kind: str
    quantity: str = ""
    label: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Table:
    """Where the table of a sample stands.

    Parameters
    ----------
    labels : as written, or `#1`, `#2` where no row of labels fits the rows
    units : of the columns as far as they are written
    first_line : of the rows from 1, 0 where the labels tell it
    """

    separator: str
    labels: tuple[str, ...]
    units: tuple[str, ...]
    first_line: int
    encoding: str
    starts_with: str
    rows: tuple[tuple[str, ...], ...]
    workbook: bool = False


@dataclass(frozen=True, slots=True)
class Proposal:
    """A form as far as it is known.

    Parameters
    ----------
    columns : label, quantity, unit
    questions : that must be answered before it is a form
    """

    table: Table
    techniques: tuple[str, ...]
    decimal: str
    columns: tuple[tuple[str, str, str], ...]
    answers: Answers
    questions: tuple[Question, ...]

    def toml(self, name: str, title: str) -> str:
        """Write the section of `config/exports.toml`."""
        table = self.table
        lines = [
            f"[{name if name.replace('-', 'a').isalnum() else _text(name)}]",
            f"title = {_text(title)}",
            f"techniques = [{', '.join(map(_text, self.techniques))}]",
            f"separator = {_text(WORKBOOK if table.workbook else _MARKS[table.separator])}",
            *([] if table.workbook else [f"decimal = {_text(self.decimal)}"]),
            *([f"encoding = {_text(table.encoding)}"] if table.encoding != "utf-8" else []),
            *([f"starts_with = {_text(table.starts_with)}"] if table.starts_with else []),
            *([f"first_line = {table.first_line}"] if table.first_line else []),
            *(["ends_open = true"] if self.answers.ends_open else []),
        ]
        if self.answers.sampling_interval_s:
            lines.append(f"sampling_interval_s = {self.answers.sampling_interval_s!r}")
        lines.append("columns = [")
        for label, quantity, unit in self.columns:
            where = f"number = {label[1:]}" if table.first_line else f"label = {_text(label)}"
            said = f", unit = {_text(unit)}" if unit else ""
            factor = self.answers.factors.get(label)
            ratio = f", factor = {factor!r}" if factor is not None else ""
            lines.append(f"    {{ {where}, quantity = {_text(quantity)}{said}{ratio} }},")
        return "\n".join([*lines, "]", ""])


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def propose(file: RawFile, answers: Answers) -> Proposal:
    """Propose a form from a sample.

    Raises
    ------
    ConfigError : no rows of numbers, or an answer about a column that is not there
    """
    if len(file.data) > _LARGEST:
        raise ConfigError(f"{file.path}: too large for a sample; give the first few thousand lines")
    if answers.technique and answers.technique not in ASKED:
        raise ConfigError(
            f"no technique reads tables as {answers.technique!r}; there are {', '.join(ASKED)}"
        )
    table = _table(file, answers.technique)
    for label in {**answers.columns, **answers.factors}:
        if label not in table.labels:
            raise ConfigError(f"{file.path} has no column {label!r}; {', '.join(table.labels)}")
    techniques = _techniques(table, answers)
    if not techniques:
        question = Question(
            "for which technique is it?", "--technique TECHNIQUE", "technique", choices=tuple(ASKED)
        )
        return Proposal(table, (), answers.decimal or ".", (), answers, (question,))
    columns, questions = _columns(table, techniques[0], answers)
    decimal, doubt = _decimal(table, columns, answers)
    if not (table.workbook or file.body.endswith(b"\n") or answers.ends_open):
        text = "the last row has no line end: is the sample whole, as this exporter writes it?"
        doubt += (Question(text, "--ends-open", "ends", choices=("yes", "no")),)
    return Proposal(table, techniques, decimal, tuple(columns), answers, (*questions, *doubt))


def _table(file: RawFile, technique: str) -> Table:
    """Find the row of labels that says most, or else the longest run of numbers."""
    workbook = is_workbook(file.data)
    written = _sheets(file) if workbook else texts(file)
    if not written:
        raise ConfigError(f"{file.path}: an empty workbook, or a text in no encoding that is known")
    best: tuple[int, Table] | None = None
    for text in written:
        encoding = _ENCODINGS.get(text.encoding, text.encoding)
        for heading in headings(text.lines):
            labels = [c.strip() for c in split(text.lines[heading.names], heading.separator)]
            known = len([label for label in labels if _meanings(label, technique)])
            rows = _rows(text.lines, heading.first, heading.separator)
            if known and len(set(filter(None, labels))) > 1 and (best is None or known > best[0]):
                units = (heading.units + ("",) * len(labels))[: len(labels)]
                separator = heading.separator
                best = (
                    known,
                    Table(separator, tuple(labels), units, 0, encoding, "", rows, workbook),
                )
    if best is not None:
        return best[1]
    text = max(written, key=lambda one: len(one.lines))
    block = block_in(text.lines)
    if block is None:
        raise ConfigError(f"{file.path}: it holds no rows of numbers")
    rows = _rows(text.lines, block.first, block.separator)
    encoding = _ENCODINGS.get(text.encoding, text.encoding)
    labels = split(text.lines[block.labels_line], block.separator) if block.labels else []
    if len(labels) == block.columns and len(set(labels)) == block.columns:
        units = tuple(split_label(label)[1] for label in block.labels)
        return Table(block.separator, block.labels, units, 0, encoding, "", rows, workbook)
    numbers = tuple(f"#{number}" for number in range(1, block.columns + 1))
    start = text.lines[0][:_STARTS_WITH].rstrip() if block.first else ""
    unknown = ("",) * block.columns
    at = block.first + 1
    return Table(block.separator, numbers, unknown, at, encoding, start, rows, workbook)


def _sheets(file: RawFile) -> list[Text]:
    """The sheets of a workbook as texts."""
    return [Text(lines, "utf-8", ended=True) for lines in lines_of_sheets(file).values() if lines]


def _rows(lines: Sequence[str], first: int, separator: str) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(split(line, separator)) for line in lines[first:] if line.strip())


def _meanings(label: str, technique: str) -> dict[str, int]:
    """Which quantities a label may mean, whatever its unit."""
    names = ASKED[technique].quantities if technique else tuple(vocabulary())
    stem, _ = split_label(label)
    return dict(meaning_among(stem, names) or meaning_among(label, names))


def _techniques(table: Table, answers: Answers) -> tuple[str, ...]:
    """The technique that is said; else those whose needs the columns come nearest to."""
    if answers.technique:
        return (answers.technique,)
    said = {quantity for quantity, _ in answers.columns.values() if quantity}
    best: dict[str, int] = {}
    for technique, asked in ASKED.items():
        found = said | {q for label in table.labels for q in _meanings(label, technique)}
        best[technique] = max(len(found.intersection(need)) for need in asked.needs)
    most = max(best.values())
    nearest = tuple(technique for technique, count in best.items() if count == most)
    alike = {ASKED[technique] for technique in nearest}
    return nearest if most >= _FEWEST and len(alike) == 1 else ()


def _columns(
    table: Table, technique: str, answers: Answers
) -> tuple[list[tuple[str, str, str]], list[Question]]:
    """Give each quantity of the nearest need its column, and ask for what is missing."""
    asked = ASKED[technique]
    written = dict(zip(table.labels, table.units, strict=True))
    said = answers.columns.items()
    given = {q: (label, unit or written[label]) for label, (q, unit) in said if q}
    found = {**_by_label(table, technique, answers), **given}
    timed = {"time_s"} if answers.sampling_interval_s else set()
    need = max(asked.needs, key=lambda names: len({*found, *timed}.intersection(names)))
    columns, questions = [], []
    for quantity in dict.fromkeys((*need, *asked.takes)):
        if quantity in timed or (quantity not in need and quantity not in found):
            continue
        if quantity not in found:
            questions.append(_which(table, quantity))
            continue
        label, unit = found[quantity]
        if not _is_unit_of(unit, quantity):
            if quantity in need:
                questions.append(_unit(label, unit, quantity))
            continue
        columns.append((label, quantity, unit))
    return columns, questions


def _by_label(table: Table, technique: str, answers: Answers) -> dict[str, tuple[str, str]]:
    """The best column of each quantity by its label, with the unit written or said."""
    found: dict[str, tuple[int, str, str]] = {}
    for label, written in zip(table.labels, table.units, strict=True):
        quantity, said = answers.columns.get(label, ("", ""))
        unit = said or written
        for name, rank in _meanings(label, technique).items() if not quantity else ():
            if name not in found or rank < found[name][0]:
                found[name] = rank, label, unit
    return {name: (label, unit) for name, (_, label, unit) in found.items()}


def _is_unit_of(unit: str, quantity: str) -> bool:
    si = vocabulary()[quantity].unit
    if not unit:
        return si == "1"
    try:
        written = unit_as_written(unit, si)
    except UnknownUnit:
        return False
    return written is not None and si_factor(written)[0] == si


def _which(table: Table, quantity: str) -> Question:
    choices = tuple(label for label in table.labels if label)
    first = table.rows[0] if table.rows else ()
    shown = ", ".join(
        f"{label} ({first[at]})" if at < len(first) else label
        for at, label in enumerate(table.labels)
        if label
    )
    flag = f"--column 'LABEL={quantity}:UNIT'"
    return Question(
        f"which column is the {quantity_in_words(quantity)}? {shown}",
        f"{flag} (or --interval SECONDS)" if quantity == "time_s" else flag,
        "column", quantity, choices=choices,
    )  # fmt: skip


def _unit(label: str, unit: str, quantity: str) -> Question:
    doubt = f" ({unit!r} is none)" if unit else ""
    return Question(
        f"in which unit is {label!r}, the {quantity_in_words(quantity)}?{doubt}",
        f"--column '{label}={quantity}:UNIT'", "unit", quantity, label,
    )  # fmt: skip


def _decimal(
    table: Table, columns: Sequence[tuple[str, str, str]], answers: Answers
) -> tuple[str, tuple[Question, ...]]:
    """The decimal mark of the cells that are used; two that fit are asked for."""
    if answers.decimal:
        return answers.decimal, ()
    if table.separator == "," or table.workbook:
        return ".", ()
    try:
        return decimal_mark(_cells(table, columns)), ()
    except Ambiguous as error:
        question = Question(
            f"is the comma of {error} a decimal comma or one between thousands? , or .",
            "--decimal , (or .)", "decimal", choices=(",", "."),
        )  # fmt: skip
        return ".", (question,)


def _cells(table: Table, columns: Sequence[tuple[str, str, str]]) -> Iterator[str]:
    used = [table.labels.index(label) for label, _, _ in columns]
    for row in table.rows:
        yield from (row[at] for at in used if at < len(row) and looks_numeric(row[at]))
