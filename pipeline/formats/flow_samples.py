"""Several flow curves in one file, in long form: one row per reading and a column of samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.recording import Recording, Source
from deamat.formats.rawfile import RawFile

SEPARATOR = "; "


def long_recording(
    file: RawFile,
    columns: Mapping[str, FloatArray],
    sample_of_row: Sequence[str],
    lines: FloatArray,
    reader: str,
    metadata: Mapping[str, str],
    units: Mapping[str, str],
) -> Recording:
    """Number the samples in order of appearance; `metadata["samples"]` names them in that order.

    Parameters
    ----------
    columns : shape (rows,) each
    sample_of_row : name per row, shape (rows,)
    lines : of the file, per row, counted from 1
    """
    names = list(dict.fromkeys(sample_of_row))
    index = {name: float(i) for i, name in enumerate(names)}
    numbered = np.array([index[name] for name in sample_of_row])
    source = Source(
        file.path, file.sha256, int(lines.min()), int(lines.max()), file.encoding, reader
    )
    said = {**metadata, "samples": SEPARATOR.join(names)}
    return Recording({**columns, "sample": numbered, "line": lines}, said, units, source)
