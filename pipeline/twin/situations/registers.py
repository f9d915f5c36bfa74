"""Registers as laboratories have them: slips of the hand beside one cylinder, or beside five."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.twin.situations.cylinders import (
    MODULUS,
    SPECIMENS,
    Cylinder,
    MODULUS_Pa,
    SPEED_mm_per_min,
    cylinder,
    log,
    made,
    naive_modulus,
    row,
)
from deamat.twin.situations.situation import Made, Situation
from deamat.twin.writers import bluehill_csv, register_csv

Rows = list[dict[str, str]]


@dataclass(frozen=True, slots=True)
class _Kept:
    """What a laboratory keeps of its cylinders.

    Parameters
    ----------
    logs : file to the cylinder that is in it
    header : further lines of the export, by file
    at : the row that goes wrong
    """

    cylinders: list[Cylinder]
    rows: Rows
    logs: dict[str, Cylinder]
    header: dict[str, tuple[tuple[str, str, str], ...]]
    at: int


Slip = Callable[[Generator, _Kept, float], None]


def _kept(rng: Generator, count: int) -> _Kept:
    cylinders = [cylinder(rng) for _ in range(count)]
    rows = [row(one, i) for i, one in enumerate(cylinders, start=1)]
    logs = {cells["file"]: one for cells, one in zip(rows, cylinders, strict=True)}
    header: dict[str, tuple[tuple[str, str, str], ...]] = {cells["file"]: () for cells in rows}
    return _Kept(cylinders, rows, logs, header, int(rng.integers(count)))


def _handed(kept: _Kept) -> Made:
    files = {file: log(one, *kept.header[file]) for file, one in kept.logs.items()}
    naive = [naive_modulus(kept.logs[cells["file"]], cells) for cells in kept.rows]
    return made(kept.cylinders, kept.rows, files, naive)


def _slipped(slip: Slip, count: int, misstated: bool, rng: Generator, severity: float) -> Made:
    kept = _kept(rng, count)
    if severity:
        slip(rng, kept, severity)
    return replace(_handed(kept), misstated=misstated)


def _times(column: str, factor: float, _rng: Generator, kept: _Kept, _severity: float) -> None:
    cells = kept.rows[kept.at]
    cells[column] = f"{factor * float(cells[column]):.6g}"


def _swapped(_rng: Generator, kept: _Kept, _severity: float) -> None:
    cells = kept.rows[kept.at]
    diameter, height = cells["diameter_mm"], cells["height_mm"]
    cells["diameter_mm"], cells["height_mm"] = height, diameter


def _stated(slip: Slip, rng: Generator, kept: _Kept, severity: float) -> None:
    """The export's own header says the diameter as well."""
    for cells in kept.rows:
        size = ("Specimen : Diameter", cells["diameter_mm"], "mm")
        kept.header[cells["file"]] = (size,)
    slip(rng, kept, severity)


def _equal_bytes(_rng: Generator, kept: _Kept, _severity: float) -> None:
    file = kept.rows[kept.at]["file"]
    other = kept.rows[kept.at - 1]["file"]
    kept.logs[file] = kept.logs[other]


def _copied(_rng: Generator, kept: _Kept, fraction: float) -> None:
    """The end of a curve is that of another one, from a sample on."""
    file, other = kept.rows[kept.at]["file"], kept.rows[kept.at - 1]["file"]
    one, two = kept.logs[file], kept.logs[other]
    n = min(one.time_s.size, two.time_s.size)
    cut = round(n * (1.0 - fraction))
    kept.logs[file] = replace(
        one,
        time_s=two.time_s[:n],
        travel_m=two.travel_m[:n],
        force_N=np.concatenate([one.force_N[:cut], two.force_N[cut:n]]),
    )


def _speed(_rng: Generator, kept: _Kept, excess: float) -> None:
    for cells in kept.rows:
        cells["speed_mm_per_min"] = f"{SPEED_mm_per_min:g}"
    kept.rows[kept.at]["speed_mm_per_min"] = f"{SPEED_mm_per_min * (1.0 + excess):g}"


def _before_cure(_rng: Generator, kept: _Kept, days: float) -> None:
    for cells in kept.rows:
        cells["cured_on"], cells["tested_on"] = "2022-01-10", "2022-01-18"
    cured = np.datetime64("2022-01-18") + np.timedelta64(round(days), "D")
    kept.rows[kept.at]["cured_on"] = str(cured)


def _no_day(rng: Generator, kept: _Kept, _severity: float) -> None:
    for cells in kept.rows:
        cells["tested_on"] = "2022-01-18"
    days = ("2022-02-30", "2222-01-18", "yesterday", "18.1.22", "2022-13-01")
    kept.rows[kept.at]["tested_on"] = str(rng.choice(days))


def _age(_rng: Generator, kept: _Kept, _severity: float) -> None:
    for cells in kept.rows:
        cells["age"], cells["cured_on"], cells["tested_on"] = "after cure", "2022-01-10", ""
        cells["tested_on"] = "2022-01-18"
    kept.rows[kept.at]["tested_on"] = "2022-03-20"


def _labelled(_rng: Generator, kept: _Kept, _severity: float) -> None:
    """Every export names its specimen; one row names the file of another."""
    for cells in kept.rows:
        kept.header[cells["file"]] = (("General : Specimen label", cells["specimen"], ""),)
    mine, other = kept.rows[kept.at], kept.rows[kept.at - 1]
    mine["file"], other["file"] = other["file"], mine["file"]


def _near_name(rng: Generator, kept: _Kept, _severity: float) -> None:
    names = ("simulatd", "simulated-", "simualted", "simullated", "simulate")
    kept.rows[kept.at]["material"] = str(rng.choice(names))


def _header(rng: Generator, severity: float) -> Made:
    """One letter of a column's name is off."""
    kept = _kept(rng, SPECIMENS)
    for cells in kept.rows:
        cells["age"], cells["temperature_C"] = "after cure", "22"
    if severity:
        label, wrong = _HEADERS[int(rng.integers(len(_HEADERS)))]
        kept.rows[:] = [
            {wrong if name == label else name: cell for name, cell in cells.items()}
            for cells in kept.rows
        ]
    files = {file: log(one) for file, one in kept.logs.items()}
    return replace(made(kept.cylinders, kept.rows, files, [MODULUS_Pa]), misstated=True)


_HEADERS = (
    ("age", "Age"), ("age", "agee"), ("temperature_C", "temprature_C"),
    ("temperature_C", "temperature_F"), ("temperature_C", "temperatureC"),
    ("diameter_mm", "diametr_mm"), ("height_mm", "heigth_mm"), ("height_mm", "Height_mm"),
)  # fmt: skip


def _two_materials(rng: Generator, ratio: float) -> Made:
    """Two files are swapped between two materials, one `ratio` times as stiff as the other."""
    kept = _kept(rng, SPECIMENS)
    stiff = [cylinder(rng, MODULUS_Pa * (ratio or 1.5)) for _ in range(SPECIMENS)]
    rows = [
        {**row(one, SPECIMENS + i), "material": "another"} for i, one in enumerate(stiff, start=1)
    ]
    files = {**kept.logs, **{c["file"]: one for c, one in zip(rows, stiff, strict=True)}}
    if ratio:
        mine, other = kept.rows[kept.at], rows[int(rng.integers(SPECIMENS))]
        mine["file"], other["file"] = other["file"], mine["file"]
    naive = [naive_modulus(files[cells["file"]], cells) for cells in kept.rows]
    handed = made(
        kept.cylinders, [*kept.rows, *rows], {f: log(one) for f, one in files.items()}, naive
    )
    return replace(handed, misstated=False)


def _two_registers(rng: Generator, severity: float) -> Made:
    """A strip of another register has the id of a cylinder, and another material."""
    kept = _kept(rng, SPECIMENS)
    strip = cylinder(rng)
    pulled = {
        "specimen": kept.rows[kept.at]["specimen"] if severity else "strip-1",
        "material": "another", "file": "1.csv", "width_mm": "6", "thickness_um": "2000",
        "gauge_length_mm": "40", "comment": kept.rows[0]["comment"],
    }  # fmt: skip
    force = np.concatenate([strip.force_N, np.zeros(5)])
    time = 0.1 * np.arange(float(force.size))
    travel = 2e-3 * time
    elsewhere = {
        "tension/specimens.csv": register_csv([pulled]),
        "tension/1.csv": bluehill_csv((), time, travel, force),
    }
    return replace(_handed(kept), elsewhere=elsewhere, misstated=True)


def _situation(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    make: Callable[[Generator, float], Made],
    severity: str = "1: the slip",
    severities: tuple[float, ...] = (1.0,),
    undetectable: Mapping[float, str] | None = None,
) -> Situation:
    return Situation(
        name, "compression", MODULUS, told, answer, causes, severity, severities, make,
        undetectable or {},
    )  # fmt: skip


def _value(slip: Slip, count: int) -> Callable[[Generator, float], Made]:
    return partial(_slipped, slip, count, False)


def _statement(slip: Slip, count: int) -> Callable[[Generator, float], Made]:
    return partial(_slipped, slip, count, True)


_RADIUS = partial(_times, "diameter_mm", 0.5)
_DECIMAL = partial(_times, "diameter_mm", 0.1)
_METRES = partial(_times, "height_mm", 0.001)
_ODD = (
    "specimens-refused",
    "register-slip",
    "register-outlier",
    "register-implausible",
    "implausible",
)
_GROUP = "Flagged: it stands apart from its siblings by the factor of a slip."
_LONELY = {
    1.0: "a cylinder of this size could be; no sibling, length in the file or stress of its own "
    "tells"
}

SITUATIONS = (
    _situation(
        "register-radius", "One of five rows has the radius for the diameter.", _GROUP, _ODD,
        _value(_RADIUS, SPECIMENS),
    ),
    _situation(
        "register-radius-alone", "The only row has the radius for the diameter.",
        "Nothing tells it.", _ODD, _value(_RADIUS, 1), undetectable=_LONELY,
    ),
    _situation(
        "register-radius-header",
        "The only row has the radius for the diameter, and its file states the diameter.",
        "Flagged: the file contradicts its row.", ("header-disagrees",),
        _value(partial(_stated, _RADIUS), 1),
    ),
    _situation(
        "register-decimal", "One of five rows has 2.82 for 28.2 mm.", _GROUP, _ODD,
        _value(_DECIMAL, SPECIMENS),
    ),
    _situation(
        "register-decimal-alone", "The only row has 2.82 for 28.2 mm.",
        "Flagged: such a cylinder may buckle.", _ODD, _value(_DECIMAL, 1),
    ),
    _situation(
        "register-metres", "One of five rows has metres under a heading of mm.", _GROUP, _ODD,
        _value(_METRES, SPECIMENS),
    ),
    _situation(
        "register-metres-alone", "The only row has metres under a heading of mm.",
        "Refused: at this height the file has no samples in the window.", _ODD, _value(_METRES, 1),
    ),
    _situation(
        "register-sides", "One of five rows has diameter and height swapped.", _GROUP, _ODD,
        _value(_swapped, SPECIMENS),
    ),
    _situation(
        "register-sides-alone", "The only row has diameter and height swapped.",
        "Flagged: such a cylinder may buckle.", _ODD, _value(_swapped, 1),
    ),
    _situation(
        "register-files-swapped",
        "Two files are swapped between two materials of five cylinders each.",
        "Flagged where each value would fit the other material.",
        ("swapped-files",), _two_materials, "stiffness of the other material over its own",
        (1.15, 1.5, 2.5),
    ),
    _situation(
        "register-equal-bytes", "The export of one of five cylinders was saved under two names.",
        "Both rejected.", (), _statement(_equal_bytes, SPECIMENS),
    ),
    _situation(
        "register-copied", "The end of a curve is a copy of another one's.",
        "Flagged with the fraction that they share.", ("copied-rows",),
        _statement(_copied, SPECIMENS), "copied, fraction", (0.1, 0.3, 0.6),
    ),
    _situation(
        "register-id-twice", "A specimen of another register has the same id, and another "
        "material.", "Flagged.", ("id-of-another-material",), _two_registers,
    ),
    _situation(
        "register-heading", "One letter of a column's name is off.",
        "Rejected with the name that was meant.", (), _header,
    ),
    _situation(
        "register-speed", "A row's speed is not that of its file.",
        "Flagged beyond 15 %: travel over time says another one.", ("speed-disagrees",),
        _statement(_speed, SPECIMENS), "speed of the row over that of the file, less 1",
        (0.3, 1.0, 59.0),
    ),
    _situation(
        "register-speed-alone", "The only row's speed is not that of its file.",
        "Flagged beyond 15 %: travel over time says another one.", ("speed-disagrees",),
        _statement(_speed, 1), "speed of the row over that of the file, less 1",
        (0.3, 1.0, 59.0),
    ),
    _situation(
        "register-dates", "A specimen was tested before it was cured.", "Flagged.",
        ("dates-disagree",), _statement(_before_cure, SPECIMENS), "days before the cure",
        (1.0, 30.0, 365.0),
    ),
    _situation(
        "register-no-day", "A date is none, or lies in the future.", "Rejected.",
        ("dates-disagree",), _statement(_no_day, SPECIMENS),
    ),
    _situation(
        "register-age", "A row says `after cure` of a specimen tested ten weeks after.", "Flagged.",
        ("dates-disagree",), _statement(_age, SPECIMENS),
    ),
    _situation(
        "register-label", "Two files are swapped between rows; each export names its specimen.",
        "Flagged: the file calls its specimen by another row's name.",
        ("file-of-another-specimen",), _statement(_labelled, SPECIMENS),
    ),
    _situation(
        "register-near-name", "One of five rows misspells its material.",
        "Flagged: the two names differ by one letter.", ("near-name",),
        _statement(_near_name, SPECIMENS),
    ),
)  # fmt: skip
