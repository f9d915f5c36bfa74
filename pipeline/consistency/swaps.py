"""Two files swapped between materials: each value stands apart from its own and fits the other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import combinations
from statistics import median

from deamat.core.flags import Flag
from deamat.core.records import Measurement, Result

_APART = 1.5  # times the others' median, either way
_SCATTERS = 6.0  # robust standard deviations of the others
_FLOOR = 0.05  # of the median: what specimens of one material usually scatter
_MAD_TO_SD = 1.4826
_OTHERS = 2  # specimens that show what a material has

Group = tuple[object, ...]


def swapped_files(measurements: Sequence[Measurement[Result]]) -> dict[str, list[Flag]]:
    """Find pairs of specimens whose values would fit if their files changed places.

    Parameters
    ----------
    measurements : of one register

    Returns
    -------
    flags by specimen
    """
    values: dict[str, dict[Group, dict[str, float]]] = defaultdict(lambda: defaultdict(dict))
    for m in measurements:
        group: Group = (m.specimen.material, *sorted(m.specimen.conditions.items()))
        for value in m.values:
            values[value.key][group][m.specimen.id] = value.quantity.value
    flags: dict[str, list[Flag]] = {}
    for key, groups in values.items():
        apart = {group: _apart(members) for group, members in groups.items()}
        for one, other in combinations(apart, 2):
            for a in apart[one]:
                for b in apart[other]:
                    if _fits(groups[one], a, groups[other][b]) and _fits(
                        groups[other], b, groups[one][a]
                    ):
                        for mine, theirs, group in ((a, b, one), (b, a, other)):
                            said = f"{key} stands apart from the others of {group[0]}, and would "
                            said += f"fit if its file and that of {theirs} changed places"
                            flags.setdefault(mine, [Flag("swapped-files", said)])
    return flags


def _apart(members: Mapping[str, float]) -> list[str]:
    return [one for one in members if not _fits(members, one, members[one], _APART)]


def _fits(members: Mapping[str, float], left_out: str, value: float, far: float = 1.0) -> bool:
    """Say whether a value is one of a group, judged by its other members."""
    others = [v for name, v in members.items() if name != left_out]
    if len(others) < _OTHERS or min(*others, value) <= 0.0:
        return far > 1.0  # nobody knows: neither apart nor fitting
    middle = median(others)
    spread = max(_MAD_TO_SD * median(abs(v - middle) for v in others), _FLOOR * middle)
    return abs(value - middle) <= _SCATTERS * spread or 1.0 / far < value / middle < far
