"""Which format a file has: exactly one must recognise it.

To add a format, see `deamat.formats`: one file, one line.
"""

from __future__ import annotations

import contextlib
import difflib
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cache, lru_cache, partial

from deamat.core.errors import ConfigError, RawFileError
from deamat.core.recording import Recording
from deamat.core.sheets import is_workbook
from deamat.formats import FORMATS, plain, tdms, workbook
from deamat.formats.declared import format_of, is_declared
from deamat.formats.exports import EXPORTS_FILE, Export
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.vocabulary import needs

_HINT = (
    "export a table with a row of labels and the unit of each column, such as `Load (N)`, or name "
    "the format in the register's `format` column"
)
_AS_TEXT = "export the data as text (CSV) and register that file"
_BLUEHILL = "export the raw data in Bluehill and register Specimen_RawData_1.csv"
# files by the end of their names: what they are, and what to export instead
_NAMED = (
    (re.compile(r"\.i[sm]_[a-z]+"), "a Bluehill sample or method, which holds no curve", _BLUEHILL),
    (re.compile(r"\.id_[a-z]+"), "Bluehill's own binary data", _BLUEHILL),
    (re.compile(r"\.zs2"), "a series of Zwick testXpert in its own form",
     "export the curves from testXpert as text or to Excel"),
    (re.compile(r"\.mpr"), "a BioLogic measurement in binary form",
     "export it as text (.mpt) from EC-Lab"),
    (re.compile(r"\.tri"), "a TRIOS file in its own form", "export it as text from TRIOS"),
    (re.compile(r"\.tdms_index"), "the index of a LabVIEW measurement", "register the .tdms"),
)  # fmt: skip
_COMPRESSED = ("a compressed file", "unpack it and register what is inside")
# how files start that are no text, and what to do with them
_BINARY = {
    b"\xd0\xcf\x11\xe0": ("an Excel workbook of the old form (.xls)", "save it as .xlsx or CSV"),
    b"PK\x03\x04": ("an archive that is no whole Excel workbook", "save the sheet as CSV"),
    b"\x89HDF": ("an HDF5 file", _AS_TEXT),
    b"%PDF": ("a PDF document", _AS_TEXT),
    b"\x1f\x8b\x08\x00": _COMPRESSED,
    b"\x1f\x8b\x08\x08": _COMPRESSED,
}
# those of the list, and those that are known by their first bytes or by none
EVERY_FORM = (*FORMATS, plain.FORMAT, tdms.FORMAT, workbook.FORMAT)
KNOWN_FORMS = tuple(form.name for form in EVERY_FORM)
_DELIMITERS = {"tab": "\t", "semicolon": ";", "comma": ","}


def is_binary(file: RawFile) -> bool:
    """Say whether a file is no text."""
    return file.data[:4] in (*_BINARY, tdms.MAGIC) or _by_its_name(file) is not None


def _by_its_name(file: RawFile) -> tuple[str, str] | None:
    """Return what a file of a machine's own form is, and what to export instead."""
    return _of_ending(file.path[file.path.rfind(".") :])


@lru_cache(maxsize=64)  # the files of a campaign have the same endings
def _of_ending(ending: str) -> tuple[str, str] | None:
    plain_ending = ending.casefold()
    return next(((what, hint) for end, what, hint in _NAMED if end.fullmatch(plain_ending)), None)


def detect(file: RawFile, exports: Sequence[Export] = ()) -> Format:
    """Return the one format that recognises the head of a file, or that of any plain table.

    Parameters
    ----------
    exports : forms that the laboratory declared: they go before those that the program knows

    Raises
    ------
    RawFileError : none does, or several do; says what was found, and what is missing of the
        nearest table
    """
    start = file.data[:4]
    if start == tdms.MAGIC:
        return tdms.FORMAT
    if (own_form := _by_its_name(file)) is not None:
        what, hint = own_form
        raise RawFileError(file.path, f"no format recognises this file: it is {what}", hint=hint)
    own = [export.name for export in exports if is_declared(file, export)]
    if len(own) == 1:
        return by_name(own[0], exports)
    if own:
        raise RawFileError(
            file.path,
            f"several forms of config/{EXPORTS_FILE} recognise this file: {', '.join(own)}",
            hint="name the one that is meant in the register's `format` column",
        )  # fmt: skip
    if start in _BINARY:
        if is_workbook(file.data):
            return workbook.FORMAT
        what, hint = _BINARY[start]
        raise RawFileError(file.path, f"no format recognises this file: it is {what}", hint=hint)
    matching = file.once(_recognising)
    if len(matching) == 1:
        return _form_or_plain(matching[0], file)
    if not file.body.strip():
        raise RawFileError(file.path, "the file is empty", hint="export the file again")
    if matching:
        with contextlib.suppress(RawFileError):
            if file.technique:
                return plain.form_of(file)
        names = ", ".join(form.name for form in matching)
        raise RawFileError(
            file.path,
            f"several formats recognise this file: {names} ({_found(file)})",
            line=1,
            value=file.head[0][:60],
            hint="name the format in the register's `format` column",
        )
    try:
        return plain.form_of(file)
    except RawFileError as error:
        raise RawFileError(
            file.path,
            f"no format recognises this file: {error.reason} ({_found(file)})",
            line=error.line or 1,
            value=error.value or _line(file, error.line or 1)[:60],
            hint=error.hint or _HINT,
        ) from error


def _line(file: RawFile, number: int) -> str:
    """One line of a file, counted from 1; it may be far below the head."""
    return file.body[file.offset(number - 1) :].split(b"\n", 1)[0].decode("utf-8", "replace")


def _form_or_plain(form: Format, file: RawFile) -> Format:
    """Let a file that a form of tables refuses be read as any plain table, where it is one.

    Such a form insists on every column; a technique needs but some of them. A testing machine's
    table in another technique's register means that technique's words.
    """
    if not file.technique:
        return form
    if form.techniques and file.technique not in form.techniques:
        with contextlib.suppress(RawFileError):
            return plain.form_of(file)
        return form
    return _lenient(form) if form.tabular else form


@cache
def _lenient(form: Format) -> Format:
    return replace(form, read=partial(_read_or_plain, form))


def _read_or_plain(form: Format, file: RawFile) -> Recording:
    try:
        recording = form.read(file)
    except RawFileError as error:
        with contextlib.suppress(RawFileError):
            return plain.FORMAT.read(file)
        raise error from None
    if any(need <= recording.columns.keys() for need in needs(file.technique)):
        return recording
    return plain.FORMAT.read(file)


def _recognising(head: Head) -> tuple[Format, ...]:
    text = "".join(head)
    return tuple(form for form in FORMATS if form.delimiter in text and form.recognises(head))


def by_name(name: str, exports: Sequence[Export] = ()) -> Format:
    """Return the format that a register names, one that the laboratory declared among them.

    Raises
    ------
    ConfigError : there is no such format; names the nearest one
    """
    forms = (*EVERY_FORM, *map(format_of, exports))
    for form in forms:
        if form.name == name:
            return form
    names = [form.name for form in forms]
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


def insist_on_channels(file: RawFile, recording: Recording) -> None:
    """Refuse channels of the register where the form of the file says itself what they are.

    Raises
    ------
    RawFileError : a ratio might be applied twice, or not at all
    """
    if file.channels and not file.channels.said.items() <= recording.metadata.items():
        raise RawFileError(
            file.path, "the register names channels or ratios, and a file of the form "
            f"{recording.source.reader} says itself what its columns are",
            hint="leave the register's channel columns empty for this file",
        )  # fmt: skip
