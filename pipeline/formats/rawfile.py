"""A raw file in memory: its bytes once, its text decoded by what the bytes themselves say."""

from __future__ import annotations

import codecs
import hashlib
import re
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Concatenate, ParamSpec, TypeVar, cast

from deamat.core.channels import NO_CHANNELS, Channels
from deamat.core.errors import RawFileError

_MANY_LINES, _FEW_LINES = 64, 16  # enough for any header, and for nearly every one
_ROWS_BELOW = 8  # rows of plain numbers that end a header
_MANY_BYTES, _FEW_BYTES = 16384, 2048
ROW_STARTS = frozenset("0123456789+-.")
_NUMBERS = b"0123456789+-"  # a letter among the numbers, such as of an exponent, is no plain number
_ROW = _NUMBERS + b".,;\t "
# what the register's `encoding` may say, and what Python calls it
_DECLARED = {
    "utf-8": "utf-8", "utf-16": "utf-16", "utf-16-le": "utf-16-le", "utf-16-be": "utf-16-be",
    "cp1252": "cp1252", "windows-1252": "cp1252", "cp1250": "cp1250", "windows-1250": "cp1250",
    "gb18030": "gb18030", "gbk": "gb18030", "gb2312": "gb18030", "cp932": "cp932",
    "shift-jis": "cp932", "latin-1": "cp1252", "iso-8859-1": "cp1252", "iso-8859-2": "iso-8859-2",
}  # fmt: skip
_HEADERS = 16  # a campaign has a few exporters, each of them with a header or two

COLUMNS = re.compile(r"([A-Z]{1,3}):([A-Z]{1,3})")

Answer = TypeVar("Answer")
Details = ParamSpec("Details")


class Head(list[str]):
    """The first lines of a file, without their line ends, and what was found out about them.

    Parameters
    ----------
    lines : without their line ends
    size : bytes of the file in which they were looked for; 0 where these did not hold them whole
    """

    def __init__(self, lines: list[str], size: int = 0) -> None:
        super().__init__(lines)
        self.size = size
        self.rows = _count_rows(lines)  # of plain numbers, at the end
        self._answers: dict[object, object] = {}

    @cached_property
    def texts(self) -> list[int]:
        """Lines that may be more than a row of numbers: most are not, and need no further look."""
        return [
            at
            for at, line in enumerate(self)
            if line[:1] not in ROW_STARTS or "(" in line or "[" in line
        ]

    def once(
        self,
        question: Callable[Concatenate[Head, Details], Answer],
        *args: Details.args,
        **kwargs: Details.kwargs,
    ) -> Answer:
        """Answer a question about these lines; detection and reading ask the same ones.

        The answer may rest on lines that are not rows of plain numbers, and on what parts the
        numbers of those that are, but not on the numbers: other files share it.
        """
        key = (question, args, *kwargs.items())
        if key not in self._answers:
            self._answers[key] = question(self, *args, **kwargs)
        return cast(Answer, self._answers[key])


def _count_rows(lines: list[str]) -> int:
    """Count the rows of plain numbers, and the blank lines, at the end of some lines."""
    others = "\n".join(lines).encode().translate(None, _ROW)
    above = others.rstrip(b"\n")
    return len(others) - len(above) if above else len(lines)


def read_raw(raw: Path, path: str) -> bytes:
    """Return the bytes of a file under `raw/`.

    Raises
    ------
    RawFileError : it vanished, or may not be read
    """
    try:
        # Without the buffer that only helps who reads a file in pieces.
        with (raw / path).open("rb", buffering=0) as file:
            return file.read()
    except FileNotFoundError as error:
        reason = "it vanished while the run was at work"
        raise RawFileError(path, reason, hint="run again") from error
    except OSError as error:
        raise RawFileError(path, f"it cannot be read: {error.strerror}") from error


def column_number(letters: str) -> int:
    """Return the number of a column that a spreadsheet names by letters, counted from 0."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1


def column_letters(number: int) -> str:
    """Return the letters by which a spreadsheet names a column, counted from 0."""
    letters = ""
    while number >= 0:
        number, letter = divmod(number, 26)
        letters = chr(ord("A") + letter) + letters
        number -= 1
    return letters


def _as_found(path: str, data: bytes) -> tuple[bytes, str]:
    """Decode what the bytes themselves declare; `latin-1` where they declare nothing."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        try:
            return data.decode("utf-16").encode(), "utf-16"
        except UnicodeDecodeError as error:
            raise RawFileError(
                path, f"starts as UTF-16 but breaks at byte {error.start}", hint="export it again"
            ) from error
    if data.startswith(codecs.BOM_UTF8):
        body, encoding = data[3:], "utf-8-sig"
    else:
        body, encoding = data, "utf-8"
    if b"\0" in data[:_FEW_BYTES] and (found := _wide(data)) is not None:
        return found
    if not body.isascii():
        try:
            body.decode("utf-8")
        except UnicodeDecodeError:
            body, encoding = body.decode("latin-1").encode(), "latin-1"
    return body, encoding


def _wide(data: bytes) -> tuple[bytes, str] | None:
    """Decode UTF-16 without its mark: of most characters one byte, always the same, is NUL."""
    for at, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        if data[at::2].count(0) > len(data) // 4 > 16 * data[1 - at :: 2].count(0):
            try:
                return data.decode(encoding).encode(), encoding
            except UnicodeDecodeError:
                return None
    return None


# Header, separators of the rows below, the byte at which they end at the latest, and the head.
_SEEN: deque[tuple[bytes, bytes, int, Head]] = deque(maxlen=_HEADERS)


@dataclass(frozen=True)
class RawFile:
    """The bytes of one file under `raw/`.

    Parameters
    ----------
    path : relative to `raw/`, for messages and origins
    data : the bytes as they are on disk
    ends_open : the campaign declares that this exporter writes no final line end
    technique : in whose register it is listed, empty where nobody says: plain tables are asked for
        the quantities of that technique
    place : what the register names behind the `#` of its file: a sheet, columns, or both (`Data`,
        `D:F`, `Data!D:F`)
    declared : encoding that the register declares, empty where the bytes decide
    channels : what the register says of the channels of a recorder
    """

    path: str
    data: bytes
    ends_open: bool = False
    technique: str = ""
    place: str = ""
    declared: str = ""
    channels: Channels = NO_CHANNELS

    @cached_property
    def sha256(self) -> str:
        """Hash of the bytes."""
        return hashlib.sha256(self.data).hexdigest()

    @cached_property
    def _decoded(self) -> tuple[bytes, str]:
        body, encoding = self._as_declared() if self.declared else _as_found(self.path, self.data)
        nul = body.find(b"\0")
        if nul >= 0:
            raise RawFileError(
                self.path,
                "a NUL byte in a text file",
                line=body.count(b"\n", 0, nul) + 1,
                value="\0",
                hint="export the file again as UTF-8 text",
            )
        return body, encoding

    def _as_declared(self) -> tuple[bytes, str]:
        encoding = _DECLARED.get(self.declared.casefold().replace("_", "-"))
        if encoding is None:
            raise RawFileError(
                self.path, f"the register declares an unknown encoding {self.declared!r}",
                hint=f"write one of {', '.join(_DECLARED)}",
            )  # fmt: skip
        try:
            return self.data.decode(encoding).removeprefix("\ufeff").encode(), encoding
        except UnicodeDecodeError as error:
            raise RawFileError(
                self.path, f"it is not in {self.declared}, which the register declares: byte "
                f"{error.start} is no letter there", hint="correct `encoding` in the register",
            ) from error  # fmt: skip

    @property
    def body(self) -> bytes:
        """The text as UTF-8 bytes without a byte order mark."""
        return self._decoded[0]

    @property
    def sheet(self) -> str:
        """Sheet of a workbook that the register names, empty where it names none."""
        sheet, mark, _ = self.place.rpartition("!")
        if not mark and not COLUMNS.fullmatch(self.place):
            sheet = self.place
        return sheet.strip("'")

    @property
    def columns(self) -> range | None:
        """Columns that the register names, counted from 0; None for all."""
        found = COLUMNS.fullmatch(self.place.rpartition("!")[2])
        if found is None:
            return None
        first, last = map(column_number, found.groups())
        return range(first, last + 1)

    @property
    def open_encoding(self) -> bool:
        """Whether neither the bytes nor the register decide the encoding."""
        return not self.declared and self.encoding == "latin-1"

    @property
    def encoding(self) -> str:
        """The encoding as found."""
        return self._decoded[1]

    @cached_property
    def head(self) -> Head:
        """The lines down to the first rows of plain numbers, or the first 64, as text."""
        few = self._first_lines(_FEW_LINES, _FEW_BYTES)
        if len(few) == _FEW_LINES and few.rows >= _ROWS_BELOW:
            return few
        return self._first_lines(_MANY_LINES, _MANY_BYTES)

    def once(
        self,
        question: Callable[Concatenate[Head, Details], Answer],
        *args: Details.args,
        **kwargs: Details.kwargs,
    ) -> Answer:
        """Answer a question about the head, as `Head.once` does, or as an earlier head did.

        Files of one exporter often differ in nothing but their numbers: those with the same lines
        above rows of the same separators share their answers.
        """
        return self._alike.once(question, *args, **kwargs)

    @cached_property
    def _alike(self) -> Head:
        """The head of the first file that differs from this one in numbers alone."""
        for header, separators, reach, head in _SEEN:
            if self.body.startswith(header):
                below = self.body[len(header) : reach].translate(None, _NUMBERS)
                if below.startswith(separators):
                    return head
        head = self.head
        if head.rows >= _ROWS_BELOW and head.size:
            first, end = self.offset(len(head) - head.rows), self.offset(len(head))
            separators = self.body[first:end].translate(None, _NUMBERS)
            reach = min(2 * end - first, head.size)  # longer numbers than these are asked again
            _SEEN.appendleft((self.body[:first], separators, reach, head))
        return head

    def _first_lines(self, lines: int, size: int) -> Head:
        text = self.body[:size].decode("utf-8", "replace").split("\n", lines)
        whole = len(text) > lines  # the last of them has its end
        return Head([line.rstrip("\r") for line in text[:lines]], size if whole else 0)

    def decimal_mark(self, line: int) -> str:
        """Return the decimal mark of rows not separated by commas: point, unless a comma is first.

        Parameters
        ----------
        line : of the first row, counted from 0
        """
        rows = self.offset(line)
        comma, point = self.body.find(b",", rows), self.body.find(b".", rows)
        return "," if comma >= 0 and not 0 <= point < comma else "."

    def offset(self, line: int) -> int:
        """Return the byte of `body` at which a line starts (counted from 0), at most its length."""
        at = 0
        for _ in range(line):
            at = self.body.find(b"\n", at) + 1
            if at == 0:
                return len(self.body)
        return at
