"""The forms in which instruments and labs write files: numbers in, bytes out."""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime

from pipeline.core.records import FloatArray


def chatillon_log(
    started: datetime, force_N: FloatArray, travel_m: FloatArray, time_s: FloatArray
) -> bytes:
    """Write the log of a Mark-10 or Chatillon stand: CRLF, tabs, N and mm to three decimals.

    The form has no field for a remark.

    Parameters
    ----------
    started : stamp of the first line
    force_N, travel_m, time_s : shape (n,) each
    """
    # by hand: strftime would follow the locale
    clock = f"{started.hour % 12 or 12}:{started.minute:02} {'AM' if started.hour < 12 else 'PM'}"
    stamp = f"{started.month}/{started.day}/{started.year}  {clock}"
    head = [stamp, "Units: N", "X-Axis: Travel", "Travel Unit: mm", "Reading\tLoad\tTravel\tTime"]
    rows = zip(force_N.tolist(), (1e3 * travel_m).tolist(), time_s.tolist(), strict=True)
    body = [f"{i}\t{f:.3f}\t{x:.3f}\t{t:.3f}" for i, (f, x, t) in enumerate(rows, start=1)]
    return _lines(head + body, "\r\n")


def bluehill_csv(
    header: Iterable[tuple[str, str, str]],
    time_s: FloatArray,
    extension_m: FloatArray,
    force_N: FloatArray,
) -> bytes:
    """Write an Instron (Bluehill) raw-data CSV: quoted numbers with thousands commas, CRLF.

    Parameters
    ----------
    header : name, value and unit (or an empty text) of each header line
    time_s, extension_m, force_N : shape (n,) each
    """
    head = [f'{name},"{value}"' + (f",{unit}" if unit else "") for name, value, unit in header]
    head += ["", "Time,Extension,Load", "(s),(mm),(N)"]
    rows = zip(time_s.tolist(), (1e3 * extension_m).tolist(), force_N.tolist(), strict=True)
    body = [f'"{t:,.3f}","{x:,.4f}","{f:,.5f}"' for t, x, f in rows]
    return _lines(head + body, "\r\n")


def register_csv(rows: Sequence[Mapping[str, str]]) -> bytes:
    """Write a register: one row per specimen, columns as in the first row."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()


def manifest(contents: Mapping[str, bytes]) -> bytes:
    """Write what `sha256sum -c` reads: a hash and a path per line, sorted by path."""
    return _lines(
        [f"{hashlib.sha256(contents[path]).hexdigest()}  {path}" for path in sorted(contents)], "\n"
    )


def _lines(lines: Sequence[str], end: str) -> bytes:
    return "".join(line + end for line in lines).encode()
