"""`curves.h5`: the reduced curves of all specimens in one flat layout, read as one Dataset.

Every column of every curve is laid end to end in one dataset of float64 named after the column
(`nominal_stress_Pa`; its attribute `units` is the unit). `<column>.offsets`, shape (curves + 1,),
says where each curve's piece begins and ends; a curve without that column has an empty piece.
`curve.specimen`, `curve.material`, `curve.campaign` and `curve.technique` label the curves,
`curve.synthetic` marks the simulated ones. Curves are sorted by material, so that one material is
one piece of each dataset. There are no groups and no time stamps: equal content, equal bytes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import PipelineError
from deamat.core.recording import Specimen
from deamat.core.records import Measurement
from deamat.core.schema import labels_of
from deamat.core.units import known, si_factor

if TYPE_CHECKING:
    import xarray

IntArray = NDArray[np.int64]

VERSION = 1
LABELS = labels_of(Specimen)  # name to attribute of the specimen
_RESERVED = frozenset({*LABELS, "synthetic", "of_curve", "curve", "sample"})


class CurvesError(PipelineError):
    """Curves that cannot be stored, or a file that does not hold any."""


def unit_of_column(name: str) -> str:
    """Read the SI unit from a column's name: `nominal_stress_Pa` is in Pa, `nominal_strain` in 1.

    The longest ending that is a unit counts.

    Raises
    ------
    CurvesError : an ending in another unit than SI (`height_mm`), or in a ratio that is not one
        of the known units (`slope_Pa_per_N`)
    """
    parts = name.split("_")
    for start in range(1, len(parts)):
        ending = "_".join(parts[start:])
        if known(ending):
            unit, factor, offset = si_factor(ending)
            if parts[start - 1] == "per" or (factor, offset) != (1.0, 0.0):
                break
            return unit
    else:
        return "1"
    raise CurvesError(f"the column {name} is not in an SI unit of the closed table")


def write_curves(
    path: Path, measurements: Sequence[Measurement], *, synthetic_campaigns: Collection[str]
) -> None:
    """Write the curves of all measurements that have one; their order plays no part.

    Parameters
    ----------
    path : the file to make; one that is there is unlinked first, never written into
    measurements : of all specimens
    synthetic_campaigns : names of the simulated campaigns; their curves are marked

    Raises
    ------
    CurvesError : a curve whose columns differ in length, a column name that cannot be kept or is
        not in SI
    """
    curves = sorted((m for m in measurements if m.curve), key=_order)
    for measurement in curves:
        _check(measurement)
    units = {name: unit_of_column(name) for name in sorted({n for m in curves for n in m.curve})}
    # In memory: HDF5 crashes the whole process where a disk is full.
    image = BytesIO()
    # A fixed format version: `latest` would change the bytes with the library.
    with h5py.File(image, "w", libver=("v110", "v110")) as file:
        file.attrs["title"] = "deamat: reduced curves"
        file.attrs["version"] = VERSION
        for label in LABELS:
            _put(file, f"curve.{label}", _words([_label(m, label) for m in curves]))
        marks = [m.specimen.campaign in synthetic_campaigns for m in curves]
        _put(file, "curve.synthetic", np.array(marks, np.uint8))
        for column, unit in units.items():
            pieces = [m.curve.get(column, _NOTHING) for m in curves]
            dataset = _put(file, column, np.concatenate(pieces).astype("<f8"))
            dataset.attrs["units"] = unit
            offsets = np.cumsum([0, *map(len, pieces)], dtype="<i8")
            _put(file, f"{column}.offsets", offsets)
    path.unlink(missing_ok=True)
    path.write_bytes(image.getbuffer())


_NOTHING: FloatArray = np.empty(0)


def _order(m: Measurement) -> tuple[str, str, str, str, int, str]:
    s = m.specimen
    return s.material, s.technique, s.campaign, s.register, s.line, s.id


def _label(m: Measurement, label: str) -> str:
    return str(getattr(m.specimen, LABELS[label]))


def _check(measurement: Measurement) -> None:
    who = f"{measurement.specimen.campaign}, {measurement.specimen.id}"
    lengths = {name: np.shape(column) for name, column in measurement.curve.items()}
    if len(set(lengths.values())) > 1 or any(len(shape) != 1 for shape in lengths.values()):
        raise CurvesError(f"{who}: the columns of a curve must have one length, not {lengths}")
    for name in lengths:
        if not name.isidentifier() or name in _RESERVED:
            raise CurvesError(f"{who}: a column of a curve cannot be called {name!r}")


def _words(texts: Sequence[str]) -> Any:
    """Encode labels as UTF-8 of one fixed width; variable-length text is not reproducible."""
    encoded = [text.encode() for text in texts]
    width = max(1, *map(len, encoded)) if encoded else 1
    return np.array(encoded, f"S{width}").astype(h5py.string_dtype("utf-8", width))


def _put(file: Any, name: str, data: Any) -> Any:
    return file.create_dataset(name, data=data, track_times=False)


def read_curves(
    path: str | Path, material: str | None = None, technique: str | None = None
) -> xarray.Dataset:
    """Read curves as one Dataset, its samples laid end to end.

    Parameters
    ----------
    path : `curves.h5`
    material, technique : read only these; None reads all

    Returns
    -------
    dimension `curve` with coordinates `specimen`, `material`, `campaign`, `technique`,
    `synthetic`; dimension `sample` with the coordinate `of_curve` (index of the curve that a
    sample belongs to) and one variable for each column `[units]`, NaN where the curve of another
    technique has no such column. No curve at all gives an empty Dataset.

    Raises
    ------
    CurvesError : no such file, or not one of curves
    """
    if not Path(path).is_file():
        raise CurvesError(f"no curves {path}; `make all` writes them")
    try:
        with h5py.File(path, "r") as file:
            if "version" not in file.attrs or file.attrs["version"] != VERSION:
                raise CurvesError(f"{path} does not hold curves of version {VERSION}")
            return _dataset(file, {"material": material, "technique": technique})
    except (OSError, KeyError) as error:
        raise CurvesError(f"{path} is not a file of curves: {error}") from error


def _dataset(file: Any, wanted: Mapping[str, str | None]) -> xarray.Dataset:
    import xarray  # costs seconds, so only whoever wants a Dataset pays for it

    chosen = np.ones(file["curve.material"].shape, bool)
    for label, value in wanted.items():
        if value is not None:
            chosen &= file[f"curve.{label}"][:] == value.encode()
    columns = {
        name: _pieces(file, name, chosen)
        for name in sorted(file)
        if "." not in name and chosen.any()
    }
    columns = {name: piece for name, piece in columns.items() if piece[1].any()}
    lengths = np.zeros(int(chosen.sum()), np.int64)
    for _, counts in columns.values():
        lengths = np.maximum(lengths, counts)
    data = {}
    for name, (values, counts) in columns.items():
        laid = np.full(int(lengths.sum()), np.nan)
        laid[np.repeat(counts > 0, lengths)] = values
        data[name] = ("sample", laid, {"units": file[name].attrs["units"]})
    coordinates = {
        label: ("curve", np.char.decode(file[f"curve.{label}"][:][chosen], "utf-8"))
        for label in LABELS
    }
    coordinates["synthetic"] = ("curve", file["curve.synthetic"][:][chosen].astype(bool))
    coordinates["of_curve"] = ("sample", np.repeat(np.arange(len(lengths)), lengths))
    return xarray.Dataset(data, coordinates, {"title": file.attrs["title"]})


def _pieces(file: Any, name: str, chosen: NDArray[np.bool_]) -> tuple[FloatArray, IntArray]:
    """Read the chosen curves' pieces of a column, end to end, and the length of each."""
    offsets = file[f"{name}.offsets"][:]
    first, last = np.flatnonzero(chosen)[[0, -1]]
    lengths = np.diff(offsets)
    values = file[name][offsets[first] : offsets[last + 1]]
    here = slice(first, last + 1)
    return values[np.repeat(chosen[here], lengths[here])], lengths[chosen]


def curves_digest(path: Path) -> str:
    """Hash what a file of curves holds, whichever version of HDF5 laid it out."""
    digest = hashlib.sha256()
    with h5py.File(path, "r") as file:
        for name in sorted(file):
            data, about = file[name][:], sorted(file[name].attrs.items())
            digest.update(f"{name} {data.dtype.str} {data.shape} {about}\n".encode())
            digest.update(data.tobytes())
    return digest.hexdigest()
