"""How instruments and laboratories write the curves that are timed, and how a rival is told."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deamat.core.arrays import FloatArray

COLUMNS = ("time", "travel", "load")


@dataclass(frozen=True, slots=True)
class Form:
    """How an instrument writes a curve, and what pandas must be told to read it.

    Parameters
    ----------
    ending : of the file's name
    render : time `[s]`, travel `[mm]` and load `[N]`, shape (n,) each, to the file's bytes
    skip : rows above the numbers
    columns : all of them, in order
    separator, decimal, encoding : for `pandas.read_csv`; no separator for a workbook
    targets : contender to the multiple of our time that it shall take at least
    """

    name: str
    ending: str
    render: Callable[[FloatArray, FloatArray, FloatArray], bytes]
    skip: int
    columns: tuple[str, ...]
    separator: str
    decimal: str
    encoding: str
    targets: Mapping[str, float]


# Decimals as machines of this kind resolve: 10 ms, 0.1 um, 1 mN.
_ROW = "{time:.2f}{mark}{travel:.4f}{mark}{load:.3f}{end}"
_READING = "{reading}{mark}" + _ROW


def _text(
    head: str, row: str, mark: str, encoding: str, decimal: str = "."
) -> Callable[[FloatArray, FloatArray, FloatArray], bytes]:
    def render(time_s: FloatArray, travel_mm: FloatArray, load_N: FloatArray) -> bytes:
        samples = zip(time_s.tolist(), travel_mm.tolist(), load_N.tolist(), strict=True)
        rows = "".join(
            row.format(reading=n, time=time, travel=travel, load=load, mark=mark, end="\r\n")
            for n, (time, travel, load) in enumerate(samples, start=1)
        )
        return (head + rows.replace(".", decimal)).encode(encoding)

    return render


def _workbook(time_s: FloatArray, travel_mm: FloatArray, load_N: FloatArray) -> bytes:
    from openpyxl import Workbook

    book = Workbook(write_only=True)
    sheet = book.create_sheet("Data")
    sheet.append(["Time", "Extension", "Load"])
    sheet.append(["s", "mm", "N"])
    for time, travel, load in zip(time_s, travel_mm, load_N, strict=True):
        sheet.append([round(float(time), 2), round(float(travel), 4), round(float(load), 3)])
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


_NAMED = {"pandas + OLS": 2.0, "pandas + lmfit": 10.0}
_PLAIN = {"pandas + OLS": 2.0}
_COUNTED = ("reading", *COLUMNS)
FORMS = (
    Form(
        "bluehill", "csv",
        _text("Time,Extension,Load\r\n(s),(mm),(N)\r\n", _ROW, ",", "ascii"),
        2, COLUMNS, ",", ".", "utf-8", _NAMED,
    ),
    Form(
        "mts", "txt", _text("Time (s)\tCrosshead (mm)\tLoad (N)\r\n", _ROW, "\t", "ascii", ","),
        1, COLUMNS, "\t", ",", "utf-8", _NAMED,
    ),
    Form(
        "plain, comma", "dat",
        _text("Reading,Time (s),Travel (mm),Load (N)\r\n", _READING, ",", "ascii"),
        1, _COUNTED, ",", ".", "utf-8", _PLAIN,
    ),
    Form(
        "plain, German semicolon", "asc",
        _text('"Nr.";"Zeit";"Traversenweg";"Pr\u00fcfkraft"\r\n"";"s";"mm";"N"\r\n', _READING, ";",
              "cp1252", ","),
        2, _COUNTED, ";", ",", "cp1252", _PLAIN,
    ),
    Form(
        "plain, UTF-16 tab", "tsv",
        _text("Reading\tTime (s)\tTravel (mm)\tLoad (N)\r\n", _READING, "\t", "utf-16"),
        1, _COUNTED, "\t", ".", "utf-16", _PLAIN,
    ),
    Form("workbook", "xlsx", _workbook, 2, COLUMNS, "", ".", "", {"pandas + OLS": 5.0}),
)  # fmt: skip
