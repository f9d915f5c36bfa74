"""Which format a file has: exactly one must recognise it.

To add a format, see `deamat.formats`: one file, one line.
"""

from __future__ import annotations

import difflib
from collections import Counter

from deamat.core.errors import ConfigError, RawFileError
from deamat.formats import FORMATS
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile

_DELIMITERS = {"tab": "\t", "semicolon": ";", "comma": ","}


def detect(file: RawFile) -> Format:
    """Return the one format that recognises the head of a file.

    Raises
    ------
    RawFileError : none does, or several do; says what was found and which formats there are
    """
    matching = file.once(_recognising)
    if len(matching) == 1:
        return matching[0]
    known = ", ".join(form.name for form in FORMATS)
    if not file.body.strip():
        raise RawFileError(file.path, "the file is empty", hint="export the file again")
    if matching:
        reason = f"several formats recognise this file: {', '.join(f.name for f in matching)}"
    else:
        reason = f"no format recognises this file; there are {known}"
    raise RawFileError(
        file.path,
        f"{reason} ({_found(file)})",
        line=1,
        value=file.head[0][:60],
        hint="name the format in the register's `format` column, or export in one of these forms",
    )


def _recognising(head: Head) -> tuple[Format, ...]:
    text = "".join(head)
    return tuple(form for form in FORMATS if form.delimiter in text and form.recognises(head))


def by_name(name: str) -> Format:
    """Return the format that a register names.

    Raises
    ------
    ConfigError : there is no such format; names the nearest one
    """
    for form in FORMATS:
        if form.name == name:
            return form
    names = [form.name for form in FORMATS]
    near = difflib.get_close_matches(name, names, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    raise ConfigError(f"there is no format {name!r}; there are {', '.join(names)}{hint}")


def _found(file: RawFile) -> str:
    """Describe a file by encoding, delimiter and number of columns."""
    lines = [line for line in file.head if line.strip()]
    counts = {
        word: Counter(line.count(mark) for line in lines if mark in line).most_common(1)
        for word, mark in _DELIMITERS.items()
    }
    word = max(counts, key=lambda known: counts[known][0][1] if counts[known] else 0)
    if not counts[word]:
        return f"{file.encoding}, no delimiter"
    return f"{file.encoding}, probably {word}-separated with {counts[word][0][0] + 1} columns"
