"""What the labels of exports mean: the list in `vocabulary.toml`, and what techniques ask for."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Asked:
    """What a technique asks of a table.

    Parameters
    ----------
    needs : sets of quantities, each of which is enough, the preferred one first
    takes : further quantities that it uses where they are there
    """

    needs: tuple[tuple[str, ...], ...]
    takes: tuple[str, ...] = ()

    @property
    def quantities(self) -> tuple[str, ...]:
        """All of them, once each."""
        return tuple(dict.fromkeys([name for need in self.needs for name in need] + [*self.takes]))


_CURVE = Asked(
    (("displacement_m", "force_N"), ("nominal_strain", "nominal_stress_Pa")),
    ("time_s", "nominal_strain", "nominal_stress_Pa", "extensometer_strain"),
)
ASKED: Mapping[str, Asked] = {
    "compression": _CURVE,
    "tension": _CURVE,
    "viscosity": Asked(
        (
            ("shear_rate_per_s", "viscosity_Pas"),
            ("shear_rate_per_s", "shear_stress_Pa"),
            ("time_s", "viscosity_Pas"),
        ),
        ("time_s", "temperature_K", "shear_stress_Pa"),
    ),
    "permittivity": Asked(
        (
            ("frequency_Hz", "parallel_capacitance_F", "loss_tangent"),
            ("frequency_Hz", "series_capacitance_F", "loss_tangent"),
            ("frequency_Hz", "series_resistance_ohm", "reactance_ohm"),
            ("frequency_Hz", "impedance_ohm", "phase_rad"),
            ("frequency_Hz", "parallel_capacitance_F", "parallel_resistance_ohm"),
            ("frequency_Hz", "series_capacitance_F", "series_resistance_ohm"),
            ("frequency_Hz", "parallel_capacitance_F", "conductance_S"),
            ("frequency_Hz", "parallel_capacitance_F", "quality_factor"),
            ("frequency_Hz", "series_capacitance_F", "quality_factor"),
            ("frequency_Hz", "conductance_S", "susceptance_S"),
            ("frequency_Hz", "relative_permittivity", "relative_loss_index"),
            ("frequency_Hz", "relative_permittivity", "loss_tangent"),
            ("frequency_Hz", "relative_permittivity", "conductivity_S_per_m"),
            ("frequency_Hz", "electric_modulus", "electric_modulus_loss"),
        )
    ),
    "breakdown": Asked((("time_s", "voltage_V"),), ("current_A",)),
    "nanoindentation": Asked((("depth_m", "force_N"),), ("time_s",)),
}


@cache
def needs(technique: str) -> tuple[frozenset[str], ...]:
    """Return the sets of quantities each of which is enough for a technique."""
    return tuple(map(frozenset, ASKED[technique].needs)) if technique in ASKED else (frozenset(),)


_REMARK = re.compile(r"\s*\([^()]*\)$")
_NOISE = frozenset((
    "measurement", "primary", "measured", "actual", "data", "messung", "prim\u00e4re", "absolut",
    "absolute", "standard", "mesure", "medida", "misura",
))  # fmt: skip


@dataclass(frozen=True, slots=True)
class Words:
    """One quantity of the vocabulary: SI unit, labels in order of preference, its reach, sources.

    `seen` says for each label in which language and where it was seen.
    """

    unit: str
    labels: tuple[str, ...]
    general: bool
    seen: tuple[str, ...]


@cache
def vocabulary() -> Mapping[str, Words]:
    """Return every quantity by its SI name."""
    text = Path(__file__).with_name("vocabulary.toml").read_text(encoding="utf-8")
    return {
        name: Words(
            entry["unit"],
            tuple(entry["labels"]),
            entry.get("general", False),
            tuple(entry["labels"].values()),
        )
        for name, entry in tomllib.loads(text).items()
    }


def plain_label(label: str) -> str:
    """Bring a label to the form in which the vocabulary lists it."""
    text = unicodedata.normalize("NFKC", label).casefold().replace("_", " ")
    return " ".join(text.split()).strip(" .:#").removeprefix("%").lstrip()


@lru_cache(maxsize=512)
def meaning_among(label: str, quantities: tuple[str, ...]) -> Mapping[str, int]:
    """Return which of some quantities a label may mean, each with its rank among their labels."""
    words = vocabulary()
    wanted = {name: words[name].labels for name in quantities}
    for form in _forms(plain_label(label)):
        found = {name: labels.index(form) for name, labels in wanted.items() if form in labels}
        if found:
            return found
    return {}


def _forms(plain: str) -> Iterable[str]:
    """A label, then with less and less of what instruments add to it."""
    yield plain
    yield plain.lstrip("-\u2212 ")
    if plain.endswith("(y)"):  # of an admittance, not of an impedance
        return
    bare = _REMARK.sub("", plain)
    yield bare
    yield plain.partition("(")[0].rstrip()
    yield " ".join(word for word in bare.split() if word not in _NOISE)
