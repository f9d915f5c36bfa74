"""What the columns of a table are: their names and the way to SI, by what is written over them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from deamat.core.errors import RawFileError
from deamat.core.records import Flag
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.cells import Dialect
from deamat.formats.documentation import contradictions
from deamat.formats.header import Layout
from deamat.formats.quantities import STANDARD, assign, meaning
from deamat.formats.strain_columns import unknown_strain
from deamat.formats.vocabulary import ASKED, meaning_among


@dataclass(frozen=True, slots=True)
class Reader:
    """What a format adds to the common reading of its tables.

    Parameters
    ----------
    name : of the format
    dialect : how it writes rows
    unwritten : label in lower case to unit, for columns that the exporter documents but writes
        without a unit; each use is kept in the metadata
    """

    name: str
    dialect: Dialect
    unwritten: Mapping[str, str] = field(default_factory=dict, hash=False)


@dataclass(frozen=True, slots=True)
class Columns:
    """The columns of a table, in order.

    Parameters
    ----------
    names : with their SI units
    conversions : factor and offset to SI, `SI = factor * written + offset`
    written : label to unit as it stands in the file, empty where it does not
    documented : `label [unit]` of those whose unit does not stand in the file
    flags : units that contradict each other or are not of what the label means
    kept : which columns of the file these are
    left : labels of the others: they have no unit, and nobody asks for what they mean
    """

    names: tuple[str, ...]
    conversions: tuple[tuple[float, float], ...]
    written: Mapping[str, str]
    documented: tuple[str, ...]
    flags: tuple[Flag, ...]
    kept: tuple[int, ...]
    left: tuple[str, ...]


def columns_of(layout: Layout, reader: Reader, header_units: Mapping[str, str]) -> Columns:
    """Find out what the columns below a layout are.

    Parameters
    ----------
    header_units : label to the unit that the header states for it

    Raises
    ------
    RawFileError : a column without a unit, with an unknown one, or with an already used label; it
        names no file, for files of the same labels share the answer
    """
    return _columns(layout, reader, tuple(header_units.items()))


@lru_cache(maxsize=256)  # the files of a campaign have the same labels
def _columns(layout: Layout, reader: Reader, header_units: tuple[tuple[str, str], ...]) -> Columns:
    everything = range(len(layout.labels))
    _refuse_twins(layout, tuple(label.casefold() for label in layout.labels), everything)
    stated = {label.casefold(): unit for label, unit in header_units}
    left = tuple(
        column
        for column, (label, unit) in enumerate(zip(layout.labels, layout.units, strict=True))
        if not (unit or stated.get(label.casefold()) or label.casefold() in reader.unwritten)
        and _is_note(label)
    )
    kept = tuple(column for column in range(len(layout.labels)) if column not in left)
    over = {layout.labels[column]: layout.units[column] for column in kept}
    written = {label: unit or stated.get(label.casefold(), "") for label, unit in over.items()}
    units = {c: _unit(layout, reader, c, written[layout.labels[c]]) for c in kept}
    found = [_conversion(layout, column, unit) for column, unit in units.items()]
    labels = tuple(over)
    si_units = tuple(si_unit for si_unit, _, _ in found)
    names = assign(labels, si_units)
    _refuse_twins(layout, names, kept)
    documented = tuple(
        f"{label} [{unit}]"
        for (label, said), unit in zip(written.items(), units.values(), strict=True)
        if not said
    )
    conversions = tuple((factor, offset) for _, factor, offset in found)
    flags = contradictions(stated, over, "header") + _kind_flags(labels, si_units)
    flags += unknown_strain(names, names)
    notes = tuple(layout.labels[column] for column in left)
    return Columns(names, conversions, written, documented, flags, kept, notes)


def _is_note(label: str) -> bool:
    """Say whether a column without a unit is a counter or a remark: no word for a quantity."""
    return meaning(label) is None and not any(
        meaning_among(label, asked.quantities) for asked in ASKED.values()
    )


def _refuse_twins(layout: Layout, names: tuple[str, ...], columns: Sequence[int]) -> None:
    if len(set(names)) < len(names):
        twin = columns[next(at for at, name in enumerate(names) if name in names[:at])]
        raise RawFileError(
            "",
            "duplicate column: two columns have the same label",
            line=layout.names + 1,
            column=twin + 1,
            value=layout.labels[twin],
            hint="export each quantity once",
        )


def _unit(layout: Layout, reader: Reader, column: int, written: str) -> str:
    label = layout.labels[column]
    if written:
        return written
    if label.casefold() in reader.unwritten:
        return reader.unwritten[label.casefold()]
    raise RawFileError(
        "",
        "a column without a unit, neither over the column nor in the header",
        line=layout.units_line + 1,
        column=column + 1,
        value=label,
        hint="export the column with its unit, or leave it out",
    )


def _conversion(layout: Layout, column: int, unit: str) -> tuple[str, float, float]:
    try:
        found = meaning(layout.labels[column])
        return si_factor(unit_as_written(unit, STANDARD[found[1]][0] if found else "") or unit)
    except UnknownUnit as error:
        raise RawFileError(
            "",
            f"{layout.labels[column]!r}: {error}",
            line=layout.units_line + 1,
            column=column + 1,
            value=unit,
            hint="export the column in a known unit, or leave it out",
        ) from error


def _kind_flags(labels: Sequence[str], si_units: tuple[str, ...]) -> tuple[Flag, ...]:
    """Notice a column whose unit is not one of what its label means."""
    flags = []
    for label, si_unit in zip(labels, si_units, strict=True):
        found = meaning(label)
        if found is not None and STANDARD[found[1]][0] != si_unit:
            flags.append(
                Flag(
                    "unit-of-another-kind",
                    f"{label} is in {si_unit}, which is not a unit of {found[1]}; it was not "
                    "taken for it",
                )
            )
    return tuple(flags)
