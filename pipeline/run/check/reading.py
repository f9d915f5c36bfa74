"""What techniques make of a recording, with the row of a register or without."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from deamat.consistency.calibrations import instrument_of
from deamat.core.config import Config
from deamat.core.errors import FitRefused, RawFileError
from deamat.core.present import readable, readable_conditions
from deamat.core.recording import Recording, Specimen
from deamat.core.records import MeasuredValue, Refusal
from deamat.core.register_columns import usual_column
from deamat.core.technique import AnyTechnique, Context
from deamat.formats.exports import Export
from deamat.run.check.curves import bare_values, curve_of, runs_of
from deamat.run.check.found import Reading, Value
from deamat.run.check.row import OPTIONS, Place, of_options, registered
from deamat.techniques import TECHNIQUES


@dataclass(frozen=True, slots=True)
class Asked:
    """What the command line asks.

    Parameters
    ----------
    technique : the only one to try, empty for those that fit
    format : name of a reader, empty to detect it
    columns : register columns with their cells (`diameter_mm`, `28.6`)
    config : folder, which need not be there
    exports : forms that it declares
    """

    technique: str
    format: str
    columns: Mapping[str, str]
    config: Path
    exports: tuple[Export, ...] = ()


def reading_of(
    key: str, recording: Recording, asked: Asked, place: Place, config: Config
) -> Reading:
    """Return what a technique makes of a recording."""
    technique = TECHNIQUES[key]
    refused: tuple[str, ...] = ()
    values: tuple[Value, ...] = ()
    flags = tuple(map(str, recording.flags))
    row, where = None, ""
    try:
        row, where = _row(technique, asked, place, config)
    except RawFileError as error:
        refused = (str(error),)
    missing = _missing(technique, row)
    try:
        curve = curve_of(key, recording)
    except FitRefused as error:
        curve, refused = None, (*refused, error.reason)
    if row is not None:
        machine = instrument_of(row, config.instruments)
        context = Context(config.methods[key], machine, {}, place.info.timezone)
        measured = technique.reduce(row, recording, context)
        values = tuple(map(_value, measured.values))
        refused += _by_reason(measured.refusals)
        flags = tuple(dict.fromkeys([*flags, *(str(f) for v in measured.values for f in v.flags)]))
    measured_all = bool(values)
    if not values and curve is not None:
        values = bare_values(key, recording)
    return Reading(
        key, where, measured_all, values, refused, flags, missing, runs_of(key, recording), curve
    )


def _by_reason(refusals: Sequence[Refusal]) -> tuple[str, ...]:
    """Say each reason once, with all that is refused for it."""
    keys: dict[str, list[str]] = {}
    for one in refusals:
        keys.setdefault(one.reason, []).append(one.key)
    return tuple(f"{', '.join(names)}: {reason}" for reason, names in keys.items())


def _row(
    technique: AnyTechnique, asked: Asked, place: Place, config: Config
) -> tuple[Specimen | None, str]:
    """The row to measure with, and where it stands; options win over the register."""
    if asked.columns:
        return of_options(asked.columns, technique, config), OPTIONS
    rows = registered(place, technique, config) if place.technique == technique.key else ()
    if rows:
        return rows[0], f"{rows[0].register}, line {rows[0].line}"
    return (of_options({}, technique, config) if not technique.required else None), ""


def _missing(technique: AnyTechnique, row: Specimen | None) -> tuple[str, ...]:
    given = row.numbers if row is not None else {}
    return tuple(usual_column(name) for name in technique.required if name not in given)


def _value(measured: MeasuredValue) -> Value:
    quantity = measured.quantity
    said = readable(quantity, measured.key)
    if measured.bound == "lower":
        said = f">= {said}"
    if measured.conditions:
        said += f" ({readable_conditions(measured.conditions)})"
    return Value(
        measured.key, quantity.value, quantity.standard_uncertainty, quantity.unit, said,
        measured.method,
    )  # fmt: skip
