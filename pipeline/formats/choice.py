"""Which column of a plain table is which quantity, by label and unit, and what is missing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deamat.core.channels import NO_CHANNELS, Channels
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.durations import clock_unit
from deamat.formats.structure import Heading
from deamat.formats.vocabulary import ASKED, Asked, meaning_among, plain_label, vocabulary

HERTZ_PER_RADIAN = 1.0 / (2.0 * math.pi)
# pure numbers by their nature; a strain may be in %
_WITHOUT_UNIT = frozenset(
    ("loss_tangent", "quality_factor", "relative_permittivity", "relative_loss_index",
     "electric_modulus", "electric_modulus_loss")
)  # fmt: skip
_NEGATED = frozenset(("reactance_ohm", "phase_rad"))  # often written as -X


@dataclass(frozen=True, slots=True)
class Taken:
    """One column that is used: `SI = factor * written + offset`."""

    name: str
    column: int
    label: str
    unit: str
    factor: float
    offset: float
    by_unit: bool = False


@dataclass(frozen=True, slots=True)
class Choice:
    """What was understood of a heading for one technique.

    Parameters
    ----------
    needed, further : columns that must be whole, and those that are used if they are
    faults : why nothing complete was found; empty where it was
    labelled : how many columns have a label that the technique knows
    twins : are several columns the same quantity?
    decimal : mark that is declared, empty where the cells tell it
    channels : what the register says of the columns, which is applied
    """

    heading: Heading
    technique: str
    needed: tuple[Taken, ...]
    further: tuple[Taken, ...]
    faults: tuple[str, ...]
    labelled: int
    twins: bool = False
    decimal: str = ""
    channels: Channels = NO_CHANNELS

    @property
    def used(self) -> tuple[Taken, ...]:
        """Every column that is used."""
        return (*self.needed, *self.further)

    @property
    def by_label(self) -> bool:
        """Whether every needed column was known by its label."""
        return not self.faults and not any(taken.by_unit for taken in self.needed)


@dataclass(frozen=True, slots=True)
class _Column:
    label: str
    written: str
    unit: str  # of the table, empty where none stands there or it is unknown
    si: str
    fault: str
    means: dict[str, int]


def choose(heading: Heading, technique: str, channels: Channels = NO_CHANNELS) -> Choice:
    """Understand a heading for one technique, or say what is missing.

    Parameters
    ----------
    channels : what the register says of single columns; their labels are what it says
    """
    asked = ASKED[technique]
    columns = [
        _column(label, unit, asked)
        for label, unit in zip(heading.labels, heading.units, strict=True)
    ]
    missing = _missing_channels(heading, channels)
    if missing:
        return Choice(heading, technique, (), (), missing, len(columns))
    if channels.labels:
        columns = [_in_its_role(column, channels) for column in columns]
    labelled = len([column for column in columns if column.means])
    twins: dict[str, str] = {}
    known = {
        name: taken
        for name in asked.quantities
        if (taken := _by_label(columns, name, twins)) is not None
    }
    for need in asked.needs:
        if all(name in known for name in need):
            return _scaled(_complete(heading, technique, asked, need, known, labelled), channels)
    for need in asked.needs:
        found = None if twins else _by_unit(columns, need, known)
        if found is not None:
            complete = _complete(heading, technique, asked, need, {**known, **found}, labelled)
            return _scaled(complete, channels)
    faults = [*twins.values()] or _faults(columns, asked, known)
    return Choice(heading, technique, (), (), tuple(dict.fromkeys(faults)), labelled, bool(twins))


def _column(label: str, written: str, asked: Asked) -> _Column:
    means = dict(meaning_among(label, asked.quantities))
    whole = f"{label}({written})"
    if not means and written and (function := meaning_among(whole, asked.quantities)):
        return _Column(whole, "", "", "", "", dict(function))  # `Tan(Delta)` has no unit
    wanted = {vocabulary()[name].unit for name in means}
    if wanted == {"K"} and written == "F":
        written = "degF"  # a temperature is not in farads
    if clock := clock_unit(written):
        return _Column(label, written, clock, "s", "", means)
    try:
        unit = unit_as_written(written, next(iter(wanted)) if len(wanted) == 1 else "") or ""
    except UnknownUnit as error:
        return _Column(label, written, "", "", f"{label!r}: {error}", means)
    if written and not unit and means:
        return _Column(label, written, "", "", f"{label!r} has the unknown unit {written!r}", means)
    return _Column(label, written, unit, si_factor(unit)[0] if unit else "", "", means)


def _missing_channels(heading: Heading, channels: Channels) -> tuple[str, ...]:
    """Name the channels of the register that the heading does not have, or has twice."""
    written = [plain_label(label) for label in heading.labels]
    counts = {label: written.count(plain_label(label)) for label in channels.labels.values()}
    return tuple(
        f"{'no' if not count else str(count)} columns are called {label!r}, which the register "
        "names as a channel"
        for label, count in counts.items()
        if count != 1
    )


def _in_its_role(column: _Column, channels: Channels) -> _Column:
    """Let a column mean what the register says, and no other column mean that."""
    for name, label in channels.labels.items():
        if plain_label(column.label) == plain_label(label):
            volts = name == "current_A" and name in channels.ratios and column.si == "V"
            return replace(column, means={name: 0}, si="A" if volts else column.si)
    means = {name: rank for name, rank in column.means.items() if name not in channels.labels}
    return replace(column, means=means)


def _scaled(choice: Choice, channels: Channels) -> Choice:
    """Multiply the channels by the ratios of their probes."""
    ratios = channels.ratios

    def scaled(taken: Taken) -> Taken:
        return replace(taken, factor=taken.factor * ratios.get(taken.name, 1.0))

    if not channels:
        return choice
    return replace(
        choice,
        channels=channels,
        needed=tuple(map(scaled, choice.needed)),
        further=tuple(map(scaled, choice.further)),
    )


def _fits(column: _Column, name: str) -> bool:
    si = vocabulary()[name].unit
    if column.si == si or (name == "frequency_Hz" and column.si == "rad/s"):
        return True
    return not column.written and name in _WITHOUT_UNIT


def _by_label(columns: Sequence[_Column], name: str, twins: dict[str, str]) -> Taken | None:
    ranked = sorted(
        (column.means[name], at)
        for at, column in enumerate(columns)
        if name in column.means and _fits(column, name)
    )
    if not ranked:
        return None
    if len(ranked) > 1 and ranked[0][0] == ranked[1][0]:
        first, second = (columns[at].label for _, at in ranked[:2])
        twins[name] = (
            f"duplicate column: columns {ranked[0][1] + 1} and {ranked[1][1] + 1} ({first}, "
            f"{second}) are both {quantity_in_words(name)}"
        )
        return None
    return _taken(columns, ranked[0][1], name)


def _by_unit(
    columns: Sequence[_Column], need: Sequence[str], known: dict[str, Taken]
) -> dict[str, Taken] | None:
    """Find what is missing as the only column of unknown label that has the unit."""
    found = {}
    for name in need:
        if name in known:
            continue
        si = vocabulary()[name].unit
        fitting = [at for at, c in enumerate(columns) if c.si == si and not c.means]
        if si == "1" or len(fitting) != 1:
            return None
        found[name] = _taken(columns, fitting[0], name, by_unit=True)
    return found if len({taken.column for taken in found.values()}) == len(found) else None


def _taken(columns: Sequence[_Column], at: int, name: str, *, by_unit: bool = False) -> Taken:
    column = columns[at]
    clock = clock_unit(column.unit)  # its times are read as seconds
    _, factor, offset = si_factor("s" if clock else column.unit or "1")
    if name == "frequency_Hz" and column.si == "rad/s":
        factor *= HERTZ_PER_RADIAN
    if name in _NEGATED and plain_label(column.label)[:1] in ("-", "\u2212"):
        factor = -factor
    return Taken(name, at, column.label, column.unit, factor, offset, by_unit)


def _complete(
    heading: Heading,
    technique: str,
    asked: Asked,
    need: Sequence[str],
    known: dict[str, Taken],
    labelled: int,
) -> Choice:
    needed = tuple(known[name] for name in need)
    used = {taken.column for taken in needed}
    further = tuple(
        known[name]
        for name in asked.takes
        if name in known and name not in need and known[name].column not in used
    )
    return Choice(heading, technique, needed, further, (), labelled)


def _faults(columns: Sequence[_Column], asked: Asked, known: dict[str, Taken]) -> list[str]:
    """Say what is missing of the need that is nearest to complete."""

    def hinted(name: str) -> bool:
        return any(name in column.means for column in columns)

    need = max(
        asked.needs,
        key=lambda names: (
            len([name for name in names if hinted(name)]),
            sum(name in known for name in names),
        ),
    )
    missing = [name for name in need if name not in known]
    if len(asked.needs) > 2 and not any(map(hinted, missing)):
        pairs = "; or ".join(
            " and ".join(map(quantity_in_words, names[1:])) for names in asked.needs
        )
        return [f"beside {quantity_in_words(need[0])} it needs {pairs}"] if need[0] in known else [
            f"no column is the {quantity_in_words(need[0])}"
        ]  # fmt: skip
    return [_missing(columns, name) for name in missing]


def _missing(columns: Sequence[_Column], name: str) -> str:
    si, words = vocabulary()[name].unit, quantity_in_words(name)
    for column in columns:
        if name in column.means:
            if column.fault:
                return column.fault
            if not column.written:
                return f"no unit stands beside {column.label!r} ({words})"
            said = f"{column.label!r} is in {column.written}, which is no unit of {words}"
            mass = si == "N" and column.unit in ("g", "kg")
            return f"{said}; write {column.unit}f if a force is meant" if mass else said
    doubtful = [f"{c.label} [{c.written}]" for c in columns if c.si == si and not c.means]
    if len(doubtful) > 1 and si != "1":
        return (
            f"which column is the {words}? {', '.join(doubtful)} have its unit; name the column "
            "after what it is"
        )
    return f"no column is the {words} (unit of {si})"


def quantity_in_words(name: str) -> str:
    """`shear_rate_per_s` in words: `shear rate`."""
    unit = vocabulary()[name].unit
    ending = (
        ""
        if unit == "1"
        else "_" + unit.replace("1/", "per_").replace("/", "_per_").replace(".", "")
    )
    return name.removesuffix(ending).replace("_", " ")
