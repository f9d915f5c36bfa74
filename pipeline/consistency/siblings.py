"""Lengths of a row against those of its siblings: slips of a factor, and wild values."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import combinations
from statistics import median

from deamat.core.flags import Flag
from deamat.core.recording import Specimen

_FEWEST = 3  # specimens from which one can stand apart
_APART = 1.35  # times the siblings' median, either way
_SCATTERS = 8.0  # robust standard deviations
_FLOOR = 0.03  # of the median: gauges and moulds scatter so much
_MAD_TO_SD = 1.4826
_NEAR = 0.1  # a slip explains a value that it brings so close to the siblings' median
_VARIED = frozenset({"tip_radius_m"})  # chosen for each specimen

_SLIPS = (
    (2.0, "twice: the diameter for the radius?"),
    (0.5, "half: the radius for the diameter?"),
    (10.0, "ten times: a decimal point?"),
    (0.1, "a tenth: a decimal point?"),
    (100.0, "a hundred times: a decimal point?"),
    (0.01, "a hundredth: a decimal point?"),
    (1000.0, "a thousand times: um for mm, or mm for m?"),
    (0.001, "a thousandth: mm for um, or m for mm?"),
    (25.4, "25.4 times: mm for inches?"),
    (1.0 / 25.4, "1/25.4: inches for mm?"),
)  # fmt: skip


def siblings_of_rows(specimens: Sequence[Specimen]) -> dict[str, list[Flag]]:
    """Find lengths that stand apart from those of the same material, or of the same register.

    Parameters
    ----------
    specimens : of one register

    Returns
    -------
    flags by specimen
    """
    materials: dict[object, list[Specimen]] = defaultdict(list)
    for specimen in specimens:
        materials[specimen.material].append(specimen)
    flags: dict[str, list[Flag]] = {}
    for members in materials.values():
        for specimen, odd in _odd(members, members):
            flags[specimen.id] = _flags(odd, "of its material")
    for specimen, odd in _odd(specimens, specimens):
        told = [flag for flag in _flags(odd, "of the register") if _is_slip(flag)]
        if specimen.id not in flags and told:
            flags[specimen.id] = told
    return flags


def _is_slip(flag: Flag) -> bool:
    return flag.name == "register-slip"


def _odd(
    members: Sequence[Specimen], siblings: Sequence[Specimen]
) -> list[tuple[Specimen, dict[str, tuple[float, float, int]]]]:
    """Give each member that stands apart: name to its value, the median, how many siblings."""
    found: dict[str, dict[str, tuple[float, float, int]]] = defaultdict(dict)
    for name in _lengths(siblings):
        values = [s.numbers[name].value for s in siblings if name in s.numbers]
        if len(values) < _FEWEST:
            continue
        middle = median(values)
        spread = _MAD_TO_SD * median(abs(v - middle) for v in values)
        limit = _SCATTERS * max(spread, _FLOOR * middle)
        for one in members:
            value = one.numbers[name].value if name in one.numbers else middle
            if abs(value - middle) > limit and not 1 / _APART < value / middle < _APART:
                found[one.id][name] = (value, middle, len(values))
    return [(one, found[one.id]) for one in members if one.id in found]


def _lengths(specimens: Sequence[Specimen]) -> list[str]:
    names = {
        name: None
        for s in specimens
        for name, q in s.numbers.items()
        if q.unit in ("m", "m2") and name not in _VARIED
    }
    return list(names)


def _flags(odd: Mapping[str, tuple[float, float, int]], whose: str) -> list[Flag]:
    for one, other in combinations(odd, 2):
        (a, usual_a, n), (b, usual_b, _) = odd[one], odd[other]
        if _close(a, usual_b) and _close(b, usual_a):
            detail = (
                f"{_plain(one)} {_shown(one, a)} and {_plain(other)} {_shown(other, b)} are those "
                f"of the {n} siblings {whose} with the names swapped"
            )
            return [Flag("register-slip", detail)]
    flags = []
    for name, (value, usual, n) in odd.items():
        said = f"{_plain(name)} is {_shown(name, value)} where the median of {n} siblings {whose} "
        said += f"is {_shown(name, usual)}"
        slips = [told for factor, told in _SLIPS if _close(value / factor, usual)]
        if slips:
            flags.append(Flag("register-slip", f"{said}, {slips[0]}"))
        else:
            flags.append(Flag("register-outlier", said))
    return flags


def _close(value: float, usual: float) -> bool:
    return abs(value / usual - 1.0) < _NEAR


def _plain(name: str) -> str:
    return name.rpartition("_")[0].replace("_", " ")


def _shown(name: str, value: float) -> str:
    if name.endswith("_m2"):
        return f"{1e6 * value:.4g} mm2"
    return f"{1e3 * value:.4g} mm"
