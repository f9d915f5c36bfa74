"""One row of a register by itself and against other registers: odd numbers, dates, names."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping

from deamat.consistency.dates import dates_of_row
from deamat.core.flags import Flag
from deamat.core.recording import Specimen
from deamat.core.register_bounds import usual

_SLENDER = 1.6  # height over diameter: ISO 7743 goes up to 1.4, beyond it soft cylinders buckle
_FEWEST = 4  # characters of an id that names one specimen: every register has an `s1`


def flags_of_row(
    specimen: Specimen, materials_of: Mapping[tuple[str, str], Mapping[str, str]]
) -> tuple[Flag, ...]:
    """Flag numbers that no laboratory has, dates that contradict, an id of two materials.

    Parameters
    ----------
    materials_of : see `materials_by_id`
    """
    flags = [*_odd_numbers(specimen), *_slender(specimen), *dates_of_row(specimen)]
    others = materials_of.get((specimen.campaign, specimen.id), {})
    for material, register in others.items():
        if material != specimen.material and len(specimen.id) >= _FEWEST:
            said = f"{register} says that {specimen.id} is of {material}"
            flags.append(Flag("id-of-another-material", said))
    return tuple(flags)


def materials_by_id(specimens: Iterable[Specimen]) -> dict[tuple[str, str], dict[str, str]]:
    """Give campaign and id to each material under that id, with a register that says so."""
    found: dict[tuple[str, str], dict[str, str]] = defaultdict(dict)
    for specimen in specimens:
        found[specimen.campaign, specimen.id].setdefault(specimen.material, specimen.register)
    return found


def _odd_numbers(specimen: Specimen) -> list[Flag]:
    flags = []
    for name, quantity in specimen.numbers.items():
        limits = usual(name)
        if limits is not None and not limits[0] <= quantity.value <= limits[1]:
            low, high = limits
            flags.append(
                Flag(
                    "register-implausible",
                    f"{name} is {quantity.value:.4g}; usual are {low:g} to {high:g} "
                    f"{quantity.unit}: a unit or a decimal point?",
                )
            )
    return flags


def _slender(specimen: Specimen) -> list[Flag]:
    """Flag a cylinder so slender that it may buckle: its sides may be swapped."""
    sides = [specimen.numbers.get(name) for name in ("height_m", "diameter_m")]
    if specimen.technique != "compression" or None in sides:
        return []
    height, diameter = (side.value for side in sides if side is not None)
    if height <= _SLENDER * diameter:
        return []
    said = f"a height of {1e3 * height:.4g} mm on a diameter of {1e3 * diameter:.4g} mm: such a "
    said += "cylinder may buckle; are they swapped, or is a decimal point wrong?"
    return [Flag("register-implausible", said)]
