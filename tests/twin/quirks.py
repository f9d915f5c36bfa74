"""Faults that real exports have, to be built into a simulated campaign on purpose.

A quirk turns the files of a campaign (path to content) into other files; the manifest is made
afterwards and agrees with them, as it does when a lab hashes what its instrument wrote.
"""

from __future__ import annotations

import codecs
import csv
import io
from collections.abc import Callable, Mapping

from deamat.core.errors import ConfigError
from deamat.twin.campaign import campaign_files
from deamat.twin.writers import manifest, register_csv

Quirk = Callable[[Mapping[str, bytes]], Mapping[str, bytes]]

_MANIFEST = "MANIFEST.sha256"


def quirky_campaign(seed: int, *quirks: Quirk) -> dict[str, bytes]:
    """Make all files of a campaign in memory, with quirks built in, in turn."""
    contents: Mapping[str, bytes] = campaign_files(seed)
    for quirk in quirks:
        contents = quirk(contents)
    written = {path: data for path, data in contents.items() if path != _MANIFEST}
    return {**written, _MANIFEST: manifest(written)}


def cut_short(path: str) -> Quirk:
    """End a file inside its last number, as an interrupted copy does."""
    return altered(path, lambda data: data.rstrip(b'\r\n"')[:-1])


def rows_lost(path: str, rows: int) -> Quirk:
    """End a file some whole rows early, as a copy to a full disk does."""
    return altered(path, lambda data: b"".join(data.splitlines(keepends=True)[:-rows]))


def typed_otherwise(path: str, row: int, column: str, text: str) -> Quirk:
    """Let someone have typed another text into one cell of a register.

    Parameters
    ----------
    row : counted from 1 below the header
    column : as the header names it
    """

    def retype(data: bytes) -> bytes:
        table = list(csv.DictReader(io.StringIO(data.decode(), newline="")))
        table[row - 1][column] = text
        return register_csv(table)

    return altered(path, retype)


def open_ended(path: str) -> Quirk:
    """Leave the last line end out, as some exporters do."""
    return altered(path, lambda data: data.rstrip(b"\r\n"))


def as_utf16(path: str) -> Quirk:
    """Write the same text in UTF-16 with its byte order mark, as some Windows programs do."""
    return altered(path, lambda data: codecs.BOM_UTF16_LE + data.decode().encode("utf-16-le"))


def altered(path: str, change: Callable[[bytes], bytes]) -> Quirk:
    """Make a quirk that changes the bytes of one file."""

    def quirk(contents: Mapping[str, bytes]) -> Mapping[str, bytes]:
        if path not in contents:
            raise ConfigError(f"a quirk names {path!r}, which the campaign does not hold")
        return {**contents, path: change(contents[path])}

    return quirk
