"""The one table of a text that has what a technique needs, or what is missing of the nearest."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from deamat.core.errors import RawFileError
from deamat.formats.choice import Choice, choose
from deamat.formats.rawfile import RawFile, column_letters
from deamat.formats.structure import Heading, fields, headings, looks_numeric_grouped
from deamat.formats.vocabulary import ASKED

_ENCODINGS = ("cp1252", "cp1250", "gb18030", "cp932")  # of texts that are not UTF-8
_BLANK, _BLANKS = re.compile(" +"), re.compile(" {2,}")
_NUMBERS = re.compile(r"[0-9+\-.,eE ]+")
FEW_ROWS = 4  # of a block of results above the table; more of them are a table of their own


@dataclass(frozen=True, slots=True)
class Text:
    """A text as lines, with what is known of the file it stands in."""

    lines: Sequence[str]
    encoding: str
    ended: bool


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
        return best(file, complete)
    raise refused(file, nearest)


def best(file: RawFile, complete: Sequence[tuple[Text, Choice]]) -> tuple[Text, Choice]:
    """Choose the encoding in which most labels are words.

    Raises
    ------
    RawFileError : two encodings are as good and mean different columns
    """

    def words(pair: tuple[Text, Choice]) -> tuple[bool, int, int]:
        return pair[1].by_label, pair[1].labelled, len(pair[1].used)

    text, choice = max(complete, key=words)
    for other, rival in complete:
        if words((other, rival)) == words((text, choice)) and _meant(rival) != _meant(choice):
            raise RawFileError(
                file.path, f"it may be in {text.encoding} or {other.encoding}, which read its "
                "labels differently", choice.heading.names + 1,
                value=text.lines[choice.heading.names],
                hint="write the right one into the column `encoding` of the register",
            )  # fmt: skip
    return text, choice


def _meant(choice: Choice) -> set[tuple[str, int, float, float]]:
    used = (*choice.needed, *choice.further)
    return {(taken.name, taken.column, taken.factor, taken.offset) for taken in used}


def complete_in(file: RawFile, text: Text) -> tuple[Choice | None, Choice | None]:
    """Return the table of a text that has what is needed, and the nearest one of all.

    Raises
    ------
    RawFileError : there are several, or two separators fit
    """
    return complete_among(file, text, headings(text.lines))


def complete_among(
    file: RawFile, text: Text, proposed: Iterable[Heading]
) -> tuple[Choice | None, Choice | None]:
    """Return the one of the proposed tables that has what is needed, and the nearest of all.

    Raises
    ------
    RawFileError : there are several, or two separators fit
    """
    within = [heading.only(file.columns) for heading in proposed]
    choices = [
        choose(heading, technique, file.channels)
        for technique in ([file.technique] if file.technique in ASKED else ASKED)
        for heading in within
    ]
    found = [choice for choice in choices if not choice.faults]
    nearest = max(choices, key=lambda choice: choice.labelled, default=None)
    return (_one_table(file, text, found) if found else None), nearest


def texts(file: RawFile) -> list[Text]:
    """Decode a file in every encoding that it may be in, each as lines without their ends."""
    return [
        _text(file, text, encoding)
        for encoding, text in decoded(file.body, file.encoding, undecided=file.open_encoding)
    ]


def decoded(body: bytes, encoding: str, *, undecided: bool) -> Iterable[tuple[str, str]]:
    """Decode the body of a `RawFile`, or a part of it, in every encoding that it may be in."""
    text = body.decode()
    if not undecided:
        yield encoding, text
        return
    written = text.encode("latin-1")
    for one in _ENCODINGS:
        try:
            yield one, written.decode(one)
        except UnicodeDecodeError:
            continue


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
        if between > FEW_ROWS:
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
        if rows > FEW_ROWS:
            raise RawFileError(
                file.path, "rows of numbers above the labels", at + 1, value=line,
                hint="one file holds one run: export each run to a file of its own",
            )  # fmt: skip


def refused(file: RawFile, nearest: Choice | None) -> RawFileError:
    """Say what is missing of the nearest table."""
    if nearest is None or not nearest.labelled:
        return RawFileError(file.path, "no table with labels and units")
    labels = nearest.heading.labels
    apart = _side_by_side(labels) if nearest.twins else []
    places = ", ".join(f"`{file.path.rpartition('/')[2]}#{columns}`" for columns in apart)
    hint = f"name the columns of each specimen in the register: {places}"
    return RawFileError(
        file.path,
        f"columns {', '.join(filter(None, labels))} found; {'; '.join(nearest.faults)}",
        line=nearest.heading.names + 1,
        hint=hint if len(apart) > 1 else "",
    )


def _side_by_side(labels: Sequence[str]) -> list[str]:
    """Name the columns of each group of labels, where all of them are the same labels again."""
    first = next((label for label in labels if label and labels.count(label) > 1), "")
    starts = [at for at, label in enumerate(labels) if label == first]
    groups = []
    if not starts:
        return []
    for start, end in zip(starts, [*starts[1:], len(labels)], strict=True):
        while end > start and not labels[end - 1]:
            end -= 1
        groups.append((start, end))
    if len({tuple(labels[start:end]) for start, end in groups}) > 1:
        return []
    return [f"{column_letters(start)}:{column_letters(end - 1)}" for start, end in groups]
