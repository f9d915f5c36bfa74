"""What a format declares about itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from deamat.core.recording import Recording
from deamat.formats.rawfile import Head, RawFile

MECHANICS = ("compression", "tension")


@dataclass(frozen=True, slots=True)
class Format:
    """One export format: a file under `formats/` declares exactly one of these as `FORMAT`.

    Parameters
    ----------
    name : what registers and messages call it
    title : instrument and form in words
    recognises : does the file's head look like this format? Given `RawFile.head`; of rows of plain
        numbers it may look at what parts the numbers, not at the numbers
    read : the whole file to a Recording, or `RawFileError`
    delimiter : of its tables: where the head holds none, nobody needs to ask `recognises`
    techniques : for which it is written, empty for any; elsewhere its files are plain tables
    tabular : its files are tables with labels and units: one that it refuses may be a plain table
    looks : by what people know it, for the table of forms
    seen : public file, script or manual that it was written from, as far as there is one
    """

    name: str
    title: str
    recognises: Callable[[Head], bool]
    read: Callable[[RawFile], Recording]
    delimiter: str = ""
    techniques: tuple[str, ...] = ()
    tabular: bool = False
    looks: str = ""
    seen: str = ""
