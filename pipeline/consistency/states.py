"""Temperature and humidity of the specimens: those far apart are never pooled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deamat.core.config import Pooling
from deamat.core.flags import Flag
from deamat.core.recording import Specimen
from deamat.core.records import Condition, Measurement

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class State:
    """Specimens that were tested under the same conditions, as far as they are recorded.

    Parameters
    ----------
    conditions : those of their rows, and the mean temperature and humidity where recorded
    unrecorded : flags of specimens whose rows do not say what those of the others say
    """

    conditions: tuple[tuple[str, Condition], ...]
    specimens: tuple[Specimen, ...]
    unrecorded: tuple[tuple[str, Flag], ...] = ()


def states(specimens: Sequence[Specimen], pooling: Pooling) -> list[State]:
    """Part specimens that share the conditions of their rows by temperature and by humidity.

    A specimen whose row does not state one is with the others if these are of one mind, and is
    flagged; else it stands apart.
    """
    shared = tuple(sorted(specimens[0].conditions.items()))
    found = [State(shared, tuple(specimens))]
    for name, tolerance in (
        ("temperature_K", pooling.temperature_tolerance_K),
        ("humidity", pooling.humidity_tolerance),
    ):
        if name not in specimens[0].conditions:  # a bed's temperature is one already
            found = [part for state in found for part in _parted(state, name, tolerance)]
    return found


def _parted(state: State, name: str, tolerance: float) -> list[State]:
    told = sorted(
        (s for s in state.specimens if name in s.numbers), key=lambda s: s.numbers[name].value
    )
    silent = [s for s in state.specimens if name not in s.numbers]
    clusters: list[list[Specimen]] = []
    for specimen in told:
        value = specimen.numbers[name].value
        if clusters and value <= clusters[-1][0].numbers[name].value + tolerance + _ROUNDING:
            clusters[-1].append(specimen)
        else:
            clusters.append([specimen])
    if not clusters:
        return [state]
    unrecorded = state.unrecorded
    if silent and len(clusters) == 1:
        said = f"the register states no {name.partition('_')[0]} of it, and of others it does"
        clusters[0] += silent
        unrecorded += tuple((s.id, Flag("not-recorded", said)) for s in silent)
        silent = []
    parted = [_state(state, name, cluster, unrecorded) for cluster in clusters]
    return [*parted, replace(state, specimens=tuple(silent))] if silent else parted


def _state(
    state: State, name: str, members: Sequence[Specimen], unrecorded: tuple[tuple[str, Flag], ...]
) -> State:
    values = [s.numbers[name].value for s in members if name in s.numbers]
    mean = values[0] if len(set(values)) == 1 else float(f"{math.fsum(values) / len(values):.6g}")
    ids = {s.id for s in members}
    order = [s for s in state.specimens if s.id in ids]
    told = tuple((who, flag) for who, flag in unrecorded if who in ids)
    return State(tuple(sorted((*state.conditions, (name, mean)))), tuple(order), told)


def under(measurement: Measurement, conditions: tuple[tuple[str, Condition], ...]) -> Measurement:
    """Put the conditions of its state onto a measurement and its refusals."""
    own = dict(conditions)
    return replace(
        measurement,
        specimen=replace(measurement.specimen, conditions=own),
        refusals=tuple(
            replace(r, conditions={**own, **r.conditions}) for r in measurement.refusals
        ),
    )
