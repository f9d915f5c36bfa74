"""Curated flow curves of the `rheodata` collection: `data.csv` beside a `dataset.yaml`.

Usage
-----
Named `rheodata`; detected by the row of labels `sample_id,shear_rate_1/s,stress_Pa`.

Format
------
One row per reading, several samples below each other; units stand in the labels, decimal points.
The viscosity is stress over rate. What `dataset.yaml` adds (geometry, temperature, authors) is not
needed to read the numbers, and is not read.

Columns
-------
`shear_rate_per_s [1/s]`, `shear_stress_Pa [Pa]`, `viscosity_Pas [Pa.s]` (stress over rate),
`sample [1]` (index into the samples), `line [1]` (of the file).

Uncertainties
-------------
None in the file; many sets are digitised from print.

Metadata
--------
`samples`: the sample ids in order.
"""

from __future__ import annotations

import numpy as np

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.cells import Dialect, read_cells
from deamat.formats.flow_samples import long_recording
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile

_NAME = "rheodata"
_LABELS = "sample_id,shear_rate_1/s,stress_Pa"


def _recognises(head: list[str]) -> bool:
    return head[0].strip() == _LABELS


def _read(file: RawFile) -> Recording:
    if not _recognises(file.head):
        raise RawFileError(
            file.path, f"no row of labels {_LABELS!r}", 1, value=file.head[0],
            hint="leave the register's `format` empty to have the form detected",
        )  # fmt: skip
    text = file.body.decode().replace("\r\n", "\n")
    rows = text.rstrip("\n").split("\n")[1:]
    if not rows:
        raise RawFileError(file.path, "no data rows: the file ends with its header", 1)
    parts = [row.partition(",") for row in rows]
    for at, (sample, _, _) in enumerate(parts, start=2):
        if not sample.strip():
            raise RawFileError(file.path, "a row without its sample", at, 1, sample)
    ended = text.endswith("\n") or file.ends_open
    block = "\n".join(rest for _, _, rest in parts)
    table = read_cells(file, block, 2, 2, Dialect(","), ended=ended)
    if not np.all(table[:, 0] > 0):
        at = int(np.flatnonzero(~(table[:, 0] > 0))[0])
        raise RawFileError(
            file.path, "a shear rate that is not positive", at + 2, 2, f"{table[at, 0]:g}"
        )
    columns = {
        "shear_rate_per_s": table[:, 0],
        "shear_stress_Pa": table[:, 1],
        "viscosity_Pas": table[:, 1] / table[:, 0],
    }
    lines = np.arange(2.0, 2.0 + len(rows))
    units = {"shear_rate": "1/s", "stress": "Pa"}
    samples = [sample.strip() for sample, _, _ in parts]
    return long_recording(file, columns, samples, lines, _NAME, {}, units)


FORMAT = Format(
    _NAME,
    "rheodata collection",
    _recognises,
    _read,
    looks="`sample_id,shear_rate_1/s,stress_Pa`",
    seen="PyPI rheopy-rheodata",
)
