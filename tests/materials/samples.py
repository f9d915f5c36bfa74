"""Small cards made by hand, and hypothesis strategies for arbitrary ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.core.card_lists import CalibrationRecord, Correlation, Excluded
from deamat.core.ledger import FileEntry, Provenance
from deamat.core.properties import CONDITIONS, PROPERTIES
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Specimen
from deamat.core.records import Condition, Flag, Law, Measurement, Origin, PropertyRecord, Refusal
from deamat.materials.card import Credit, MaterialCard

RAW = "soft-2026/compression"

PROVENANCE = Provenance(
    version="1.2.3",
    code="c0de" * 6,
    stages=(
        *(("card", "ca4d"), ("figure compression", "f1"), ("measurement compression", "c0")),
        *(("measurement tension", "7e"), ("summary compression", "5c")),
    ),
    environment=(("Python", "3.11.2"), ("numpy", "2.4.6"), ("platform", "Linux x86_64")),
    config=(("materials.toml", "a" * 64), ("methods.toml", "b" * 64)),
)

FILES = (
    FileEntry(f"{RAW}/A1.csv", "1" * 64, 4096, "recording", "used"),
    FileEntry(f"{RAW}/A2.csv", "2" * 64, 4000, "recording", "used"),
    FileEntry(
        f"{RAW}/A3.csv", "", 0, "missing", "rejected", "missing", "not there", line=4, column=2
    ),
)

CREDIT = Credit("soft-2026", "Compression of gels", "Lab One", "CC BY 4.0", "", synthetic=False)
TWIN = Credit("twin-1", "Simulated gels", "nobody", "CC BY 4.0", "the twin", synthetic=True)


def origin(specimen: str, value: float, line: int, **changes: Any) -> Origin:
    fields: dict[str, Any] = {
        "specimen": specimen,
        "value": value,
        "u_independent": 600.0,
        "u_shared": 800.0,
        "register": f"{RAW}/specimens.csv",
        "register_line": line,
        "path": f"{RAW}/{specimen}.csv",
        "sha256": specimen[-1] * 64,
        "first_line": 12,
        "last_line": 83,
        "reader": "bluehill",
        "technique": "compression",
        "diagnostics": {"samples": 72, "r": 0.9991234},
    }
    return Origin(**{**fields, **changes})


def modulus(**changes: Any) -> PropertyRecord:
    """Two specimens' modulus at the reference age: 158.8 +- 1.0 kPa."""
    fields: dict[str, Any] = {
        "key": "compressive_modulus",
        "material": "gel-a",
        "campaign": "soft-2026",
        "quantity": Quantity(158812.5, "Pa", 600.0, 800.0),
        "n": 2,
        "sd": 848.5,
        "ci95": (156412.5, 161212.5),
        "conditions": {"age": "after cure", "window": (0.0, 0.05)},
        "method": "mean of 2 specimens; slope over 0-5 %",
        "budget": (
            Contribution("scatter between specimens", 600.0, False),
            Contribution("load cell calibration", 800.0, True),
        ),
        "origins": (origin("A1", 158212.5, 2), origin("A2", 159412.5, 3)),
        "flags": (Flag("toe", "2 of 2 specimens, such as A1: slope: 59 kPa up to 1 %"),),
        "diagnostics": {"min": 158212.5, "degrees_of_freedom": 5},
    }
    return PropertyRecord(**{**fields, **changes})


def aged(**changes: Any) -> PropertyRecord:
    fields: dict[str, Any] = {
        "quantity": Quantity(171000.0, "Pa", 1200.0),
        "conditions": {"age": "2 months", "window": (0.0, 0.05)},
        "n": 1,
        "sd": None,
        "ci95": (168600.0, 173400.0),
        "origins": (origin("A9", 171000.0, 9),),
        "flags": (),
        "budget": (),
    }
    return modulus(**{**fields, **changes})


def handling() -> PropertyRecord:
    """A value of the register alone, without an upper bound."""
    line = origin(
        "bed-23",
        21600.0,
        5,
        **dict.fromkeys(("path", "sha256", "first_line", "last_line", "reader")),
        technique="handling",
        diagnostics={},
    )
    return modulus(
        key="handling_time",
        quantity=Quantity(21600.0, "s", 1800.0),
        n=1,
        sd=None,
        ci95=(18000.0, float("inf")),
        conditions={"temperature_K": 296.15},
        method="last clean line",
        budget=(),
        origins=(line,),
        flags=(),
        diagnostics={},
    )


def viscosity_law(**changes: Any) -> Law:
    fields: dict[str, Any] = {
        "key": "viscosity",
        "material": "gel-a",
        "campaign": "soft-2026",
        "kind": "polynomial",
        "unit": "Pa.s",
        "argument": "time since mixing",
        "argument_unit": "s",
        "coefficients": (1.64, 7.4e-05),
        "covariance": ((1e-4, 0.0), (0.0, 1e-12)),
        "valid": (3600.0, 43200.0),
        "conditions": {"temperature_K": 296.15},
        "method": "least squares",
        "origins": (origin("V1", 2.0, 2, u_shared=0.1, u_independent=0.0, technique="viscosity"),),
        "flags": (Flag("toe", "told with the modulus"),),
    }
    return Law(**{**fields, **changes})


def refusal(
    specimen: str | None, reason: str = "2 samples in the window, 10 are needed"
) -> Refusal:
    return Refusal(
        *("tensile_modulus", reason, "gel-a", "soft-2026", specimen),
        conditions={"window": (0.0, 0.01)},
        diagnostics={"samples": 2},
    )


def excluded(specimen: str, reason: str = "torn at the grip", **changes: Any) -> Excluded:
    fields: dict[str, Any] = {
        "campaign": "soft-2026",
        "technique": "compression",
        "specimen": specimen,
        "reason": reason,
        "material": "gel-a",
        "register": "soft-2026/compression/specimens.csv",
        "register_line": 9,
    }
    return Excluded(**{**fields, **changes})


def card(**changes: Any) -> MaterialCard:
    fields: dict[str, Any] = {
        "material": "gel-a",
        "name": "Gel A 10:1",
        "synthetic": False,
        "records": (modulus(), aged(), handling()),
        "laws": (viscosity_law(),),
        "refusals": (refusal("A2"), refusal("A1")),
        "campaigns": (CREDIT,),
    }
    return MaterialCard(**{**fields, **changes})


@dataclass(frozen=True)
class Columns:
    """A result that is its curve and nothing more."""

    columns: Mapping[str, FloatArray]


def measurement(
    specimen: str,
    curve: Mapping[str, list[float]],
    material: str = "gel-a",
    technique: str = "compression",
    campaign: str = "soft-2026",
    line: int = 2,
) -> Measurement:
    who = Specimen(
        *(specimen, material, campaign, technique, None, None, {}, {}, {}),
        *(f"{campaign}/{technique}/specimens.csv", line),
    )
    return Measurement(
        who, (), result=Columns({name: np.array(values) for name, values in curve.items()})
    )


# --- arbitrary content, for properties that must hold for every card

numbers = st.floats(allow_nan=False, allow_infinity=False)
uncertainties = st.floats(0.0, 1e30)
words = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
names = st.text("abcdefgxyz-µ0123456789", min_size=1, max_size=8)
details = st.dictionaries(
    names, st.integers(-(2**60), 2**60) | st.floats(allow_nan=False) | st.just("few"), max_size=3
)
conditions_of: dict[str, st.SearchStrategy[Condition]] = dict.fromkeys(
    CONDITIONS, st.one_of(names, numbers, st.tuples(numbers, numbers))
)
flags = st.lists(st.builds(Flag, names, words), max_size=2).map(tuple)
budgets = st.lists(
    st.builds(
        Contribution,
        *(names, uncertainties, st.booleans()),
        calibration=st.none() | names,
        calibrated=st.none() | names,
        inverse=st.booleans(),
        assumed=st.booleans(),
        degrees_of_freedom=st.none() | st.floats(1.0, 100.0),
    ),
    max_size=3,
    unique_by=lambda c: (c.source, c.u, c.shared),
).map(tuple)
lines = st.none() | st.integers(1, 10**6)
origins = st.lists(
    st.builds(
        Origin,
        specimen=names,
        value=numbers,
        u_independent=uncertainties,
        u_shared=uncertainties,
        register=names,
        register_line=st.integers(1, 10**6),
        path=st.none() | names,
        sha256=st.none() | st.just("f" * 64),
        first_line=lines,
        last_line=lines,
        reader=st.none() | names,
        technique=names,
        diagnostics=details,
        calibrations=st.lists(names, max_size=2).map(tuple),
    ),
    max_size=3,
    unique_by=lambda o: (o.register, o.register_line),
).map(tuple)


@st.composite
def records(draw: st.DrawFn, material: str = "gel-a") -> PropertyRecord:
    key = draw(st.sampled_from(sorted(PROPERTIES)))
    low, high = sorted(draw(st.tuples(*(st.floats(allow_nan=False),) * 2)))
    return PropertyRecord(
        key=key,
        material=material,
        campaign=draw(names),
        quantity=Quantity(
            draw(numbers), PROPERTIES[key].unit, draw(uncertainties), draw(uncertainties)
        ),
        n=draw(st.integers(1, 100)),
        sd=draw(st.none() | uncertainties),
        ci95=(low, high) if low != np.inf and high != -np.inf else (-np.inf, np.inf),
        conditions=draw(st.fixed_dictionaries({}, optional=conditions_of)),
        method=draw(names),
        budget=draw(budgets),
        origins=draw(origins),
        flags=draw(flags),
        diagnostics=draw(details),
    )


cards = st.builds(
    MaterialCard,
    material=st.just("gel-a"),
    name=names,
    synthetic=st.just(True),
    records=st.lists(records(), max_size=3, unique_by=lambda r: (r.key, r.campaign)).map(tuple),
    laws=st.lists(
        st.builds(
            viscosity_law,
            campaign=names,
            coefficients=st.tuples(numbers, numbers),
            flags=flags,
            origins=origins,
            diagnostics=details,
        ),
        max_size=2,
        unique_by=lambda law: law.campaign,
    ).map(tuple),
    refusals=st.lists(st.builds(refusal, st.none() | names, names), max_size=3).map(tuple),
    excluded=st.lists(
        st.builds(
            Excluded,
            *(names, names, names, names, st.just("gel-a"), names, st.integers(1, 10**6)),
            path=st.none() | names,
        ),
        max_size=3,
        unique_by=lambda e: e.place,
    ).map(tuple),
    correlations=st.lists(
        st.builds(
            Correlation,
            key=st.sampled_from(sorted(PROPERTIES)),
            material=st.just("gel-a"),
            campaign=names,
            conditions=st.fixed_dictionaries({}, optional=conditions_of),
            other_key=st.sampled_from(sorted(PROPERTIES)),
            other_campaign=names,
            other_conditions=st.fixed_dictionaries({}, optional=conditions_of),
            coefficient=st.floats(-1.0, 1.0),
            why=names,
        ),
        max_size=2,
        unique_by=lambda c: (c.key, c.campaign),
    ).map(tuple),
    calibrations=st.lists(
        st.builds(
            CalibrationRecord,
            *(names, names, names, st.lists(names, min_size=1, max_size=2).map(tuple), names),
            u_relative=st.none() | uncertainties,
        ),
        max_size=2,
        unique_by=lambda c: c.calibration,
    ).map(tuple),
    campaigns=st.lists(
        st.builds(Credit, names, words, words, words, words, st.booleans()),
        max_size=2,
        unique_by=lambda c: c.campaign,
    ).map(tuple),
)
