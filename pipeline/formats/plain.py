"""Any table with labels and units: what no form by name recognises, and still says what it is.

Usage
-----
Named `plain`; tried where no other form recognises a file. What a technique needs must be there by
label and unit (`vocabulary.toml`), else the file is refused with all that is missing.

Format
------
Perhaps lines of notes, results or keys, one row of labels, perhaps a row of units, then rows of
fields parted by tabs, semicolons, commas or bars, or aligned by blanks (at least two between
labels). Units stand in the row of units or in the labels
(`Load (N)`, `Load [N]`, `load_N`, `Load / N`, `F in N`). The decimal mark is the one under which
every cell that is used is a number; where both marks fit and mean different numbers the file is
refused. UTF-8, UTF-16 with its mark, or the one of cp1252, cp1250, GB18030 and Shift-JIS in which
the labels are words of the vocabulary. Empty columns, counters and columns of text are notes.

Columns
-------
Those that the technique needs, and further ones that it uses, by their names in
`vocabulary.toml`.

Uncertainties
-------------
None in the file.

Metadata
--------
Every line above the labels; `columns not used` lists the labels of the others.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.choice import Choice, choose
from deamat.formats.format import Format
from deamat.formats.plain_rows import recording_of
from deamat.formats.rawfile import RawFile
from deamat.formats.structure import Heading, fields, headings, looks_numeric_grouped
from deamat.formats.vocabulary import ASKED

_ENCODINGS = ("cp1252", "cp1250", "gb18030", "cp932")  # of texts that are not UTF-8
_BLANK, _BLANKS = re.compile(" +"), re.compile(" {2,}")
_NUMBERS = re.compile(r"[0-9+\-.,eE ]+")
_FEW_ROWS = 4  # of a block of results above the table; more of them are a table of their own


@dataclass(frozen=True, slots=True)
class Text:
    """A text as lines, with what is known of the file it stands in."""

    lines: Sequence[str]
    encoding: str
    ended: bool


def _read(file: RawFile) -> Recording:
    text, choice = understood(file)
    return recording_of(file, text.lines, text.encoding, choice, ended=text.ended)


def form_of(file: RawFile) -> Format:
    """Return the form with what was understood of a file, so that it is not looked for twice.

    Raises
    ------
    RawFileError : see `understood`
    """
    text, choice = understood(file)

    def read(again: RawFile) -> Recording:
        if again is not file:
            return _read(again)
        return recording_of(file, text.lines, text.encoding, choice, ended=text.ended)

    return replace(FORMAT, read=read)


def understood(file: RawFile) -> tuple[Text, Choice]:
    """Find the one table of a file that has what a technique needs.

    Raises
    ------
    RawFileError : there is none, with all that is missing of the nearest; or there are several
    """
    nearest: Choice | None = None
    complete: list[tuple[Text, Choice]] = []
    for text in texts(file):
        choice, near = complete_in(file, text)
        if choice is not None:
            complete.append((text, choice))
        if near is not None and (nearest is None or near.labelled > nearest.labelled):
            nearest = near
    for text in () if complete else texts(file):
        aligned = _aligned(text)
        choice = None if aligned is None else complete_in(file, aligned)[0]
        if aligned is not None and choice is not None:
            complete.append((aligned, choice))
    if complete:
        return max(complete, key=lambda pair: (pair[1].by_label, pair[1].labelled))
    raise refused(file, nearest)


def complete_in(file: RawFile, text: Text) -> tuple[Choice | None, Choice | None]:
    """Return the table of a text that has what is needed, and the nearest one of all.

    Raises
    ------
    RawFileError : there are several, or two separators fit
    """
    choices = [
        choose(heading, technique)
        for technique in ([file.technique] if file.technique in ASKED else ASKED)
        for heading in headings(text.lines)
    ]
    found = [choice for choice in choices if not choice.faults]
    nearest = max(choices, key=lambda choice: choice.labelled, default=None)
    return (_one_table(file, text, found) if found else None), nearest


def texts(file: RawFile) -> list[Text]:
    """Decode a file in every encoding that it may be in, each as lines without their ends."""
    if file.encoding != "latin-1":
        return [_text(file, file.body.decode(), file.encoding)]
    found = []
    for encoding in _ENCODINGS:
        try:
            found.append(_text(file, file.data.decode(encoding), encoding))
        except UnicodeDecodeError:
            continue
    return found


def _aligned(text: Text) -> Text | None:
    """Part columns that are aligned by blanks with bars: words by two of them, numbers by one."""
    if any(mark in line for line in text.lines for mark in "\t;|"):
        return None
    lines = [
        "|".join((_BLANK if _NUMBERS.fullmatch(line) else _BLANKS).split(line.strip(" ")))
        for line in text.lines
    ]
    return replace(text, lines=lines)


def _text(file: RawFile, text: str, encoding: str) -> Text:
    lines = text.replace("\r\n", "\n").split("\n")
    return Text(lines, encoding, file.ends_open or not lines[-1].strip())


def _one_table(file: RawFile, text: Text, found: Sequence[Choice]) -> Choice:
    """Choose among the headings that are complete, or refuse two tables and two separators."""
    technique = found[0].technique
    best: dict[int, Choice] = {}
    for choice in (one for one in found if one.technique == technique):
        first = choice.heading.first
        held = best.get(first)
        if held is not None and held.heading.separator != choice.heading.separator:
            raise RawFileError(
                file.path, "two separators fit: "
                f"{held.heading.separator!r} and {choice.heading.separator!r}",
                first + 1, value=text.lines[choice.heading.names],
                hint="export with one separator, and fields that hold it in quotes",
            )  # fmt: skip
        if held is None or _rank(choice) > _rank(held):
            best[first] = choice
    tables = [best[first] for first in sorted(best)]
    chosen = tables[0]
    for other in tables[1:]:
        if other.heading.labels == chosen.heading.labels:
            break  # the header is repeated: the rows of the first are refused at that line
        between = other.heading.names - chosen.heading.first
        if between > _FEW_ROWS:
            raise RawFileError(
                file.path, f"two tables, below lines {chosen.heading.names + 1} and "
                f"{other.heading.names + 1}", other.heading.names + 1,
                value=text.lines[other.heading.names],
                hint="one file holds one run: export each run to a file of its own",
            )  # fmt: skip
        chosen = other
    _refuse_rows_above(file, text, chosen.heading)
    return chosen


def _rank(choice: Choice) -> tuple[bool, int, int]:
    return choice.by_label, choice.labelled, choice.heading.names


def _refuse_rows_above(file: RawFile, text: Text, heading: Heading) -> None:
    """Refuse a run above the labels; a few rows are a block of results."""
    rows = 0
    for at, line in enumerate(text.lines[: heading.names]):
        cells = fields(line, heading.separator) if heading.separator in line else []
        numeric = len(cells) >= 2 and all(map(looks_numeric_grouped, cells))
        rows = rows + 1 if numeric else 0
        if rows > _FEW_ROWS:
            raise RawFileError(
                file.path, "rows of numbers above the labels", at + 1, value=line,
                hint="one file holds one run: export each run to a file of its own",
            )  # fmt: skip


def refused(file: RawFile, nearest: Choice | None) -> RawFileError:
    """Say what is missing of the nearest table."""
    if nearest is None or not nearest.labelled:
        return RawFileError(file.path, "no table with labels and units")
    heading = nearest.heading
    labels = ", ".join(label for label in heading.labels if label)
    return RawFileError(
        file.path,
        f"columns {labels} found; {'; '.join(nearest.faults)}",
        line=heading.names + 1,
    )


FORMAT = Format("plain", "any table with labels and units", lambda _: False, _read)
