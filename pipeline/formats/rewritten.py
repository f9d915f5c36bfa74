"""Forms that are plain tables once a few lines are written in another way: scopes, LVM, E4990A."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.plain_rows import recording_of
from deamat.formats.plain_tables import Text, complete_in, refused
from deamat.formats.rawfile import RawFile

CUT = "the file seems cut"


def lines_of(file: RawFile) -> list[str]:
    """Return the lines of a file, without their ends."""
    return file.body.decode().replace("\r\n", "\n").split("\n")


def read_rewritten(file: RawFile, lines: Sequence[str], reader: str, shift: int = 0) -> Recording:
    """Read lines as a plain table.

    Parameters
    ----------
    lines : one for each line of the file, below `shift` lines that are not in it
    reader : name of the form

    Raises
    ------
    RawFileError : as for a plain table, by the lines of the file
    """
    ended = file.ends_open or not lines[-1].strip()
    text = Text(lines, file.encoding, ended)
    try:
        choice, nearest = complete_in(file, text)
        if choice is None:
            raise refused(file, nearest)
        recording = recording_of(file, lines, file.encoding, choice, ended=ended)
    except RawFileError as error:
        raise RawFileError.together(
            [_higher(one, shift) for one in (error, *error.others)]
        ) from error
    source = recording.source
    source = replace(
        source,
        first_line=source.first_line - shift,
        last_line=source.last_line - shift,
        reader=reader,
    )
    return replace(recording, source=source)


def _higher(error: RawFileError, shift: int) -> RawFileError:
    """Name the line of the file instead of that of its rewritten lines."""
    line = None if error.line is None else max(error.line - shift, 1)
    return RawFileError(error.path, error.reason, line, error.column, error.value, error.hint)
