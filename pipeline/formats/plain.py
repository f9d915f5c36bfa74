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
refused. UTF-8, UTF-16, or the one of cp1252, cp1250, GB18030 and Shift-JIS in which the labels are
words of the vocabulary; where that is open the register declares it. Times as a clock shows them
(`0:15:00`) are in seconds. The register may name the columns of one specimen (`x.csv#A:C`). Empty
columns, counters and columns of text are notes.

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

from dataclasses import replace

from deamat.core.recording import Recording
from deamat.formats.format import Format
from deamat.formats.plain_block import block_of
from deamat.formats.plain_rows import recording_of
from deamat.formats.plain_tables import understood
from deamat.formats.rawfile import RawFile


def _read(file: RawFile) -> Recording:
    block = block_of(file)
    if block is not None:
        return block
    text, choice = understood(file)
    return recording_of(file, text.lines, text.encoding, choice, ended=text.ended)


def form_of(file: RawFile) -> Format:
    """Return the form with what was understood of a file, so that it is not looked for twice.

    Raises
    ------
    RawFileError : see `understood`
    """
    block = block_of(file)
    if block is not None:
        return replace(FORMAT, read=lambda again: block if again is file else _read(again))
    text, choice = understood(file)

    def read(again: RawFile) -> Recording:
        if again is not file:
            return _read(again)
        return recording_of(file, text.lines, text.encoding, choice, ended=text.ended)

    return replace(FORMAT, read=read)


FORMAT = Format(
    "plain",
    "any table with labels and units",
    lambda _: False,
    _read,
    looks="see below",
    seen="each label in `vocabulary.toml`",
)
