"""The specimens of one material that were tested alike, as a Weibull fit takes them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.quantity import Contribution
from deamat.core.records import Condition, Measurement
from deamat.techniques.breakdown.config import FIELD
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.shared.mean import Pair


@dataclass(frozen=True, slots=True)
class Sample:
    """The films of one material under the same conditions, in register order.

    Parameters
    ----------
    field_V_per_m : of breakdown, or borne unbroken, shape (n,)
    censored : which of them did not break, shape (n,)
    sure : of which of them the log or the register tells whether it broke, shape (n,)
    """

    pairs: tuple[Pair, ...]
    films: tuple[FilmTest, ...]
    conditions: dict[str, Condition]
    field_V_per_m: FloatArray
    censored: NDArray[np.bool_]
    sure: NDArray[np.bool_]

    @property
    def area_m2(self) -> float | None:
        """Area under the electrodes, where the register declares it."""
        area_m2 = self.conditions.get("electrode_area_m2")
        return area_m2 if isinstance(area_m2, float) else None


def samples(measurements: Sequence[Measurement[FilmTest]]) -> Iterator[Sample]:
    """Part the specimens by electrode area and rate of rise; other conditions are one group's."""
    ordered = sorted(measurements, key=lambda m: (m.specimen.line, m.specimen.id))
    groups: dict[tuple[tuple[str, Condition], ...], list[tuple[Pair, FilmTest]]] = {}
    for m in ordered:
        for v in m.values:
            if v.key == FIELD and m.result is not None:
                conditions = {**m.specimen.conditions, **v.conditions}
                group = groups.setdefault(tuple(sorted(conditions.items())), [])
                group.append(((m, v), m.result))
    for conditions_of_group, members in groups.items():
        yield Sample(
            tuple(pair for pair, _ in members),
            tuple(film for _, film in members),
            dict(conditions_of_group),
            np.array([v.quantity.value for (_, v), _ in members]),
            np.array([film.censored for _, film in members]),
            np.array([film.sure for _, film in members]),
        )


def shared_lines(sample: Sample) -> tuple[Contribution, ...]:
    """Average each shared source over the specimens, relative to their fields: one error each."""
    totals: dict[Contribution, float] = {}
    for _, value in sample.pairs:
        for line in value.budget:
            if line.shared:
                cause = replace(line, u=0.0)
                part = line.u / value.quantity.value / len(sample.pairs)
                totals[cause] = totals.get(cause, 0.0) + part
    return tuple(replace(cause, u=u) for cause, u in totals.items())


def methods(sample: Sample) -> str:
    """Say how the specimens were read, each way once."""
    return ", or ".join(dict.fromkeys(v.method for _, v in sample.pairs))
