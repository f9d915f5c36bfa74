"""What the machine and the plates do to a modulus, and a file whose own stress is another."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.recording import Specimen
from deamat.core.records import Measurement
from deamat.techniques.compression import TECHNIQUE
from deamat.techniques.shared.modulus import LoadingCurve
from tests.techniques.curves import CYLINDER, EXACT, context, recording, specimen

AREA, HEIGHT, E = math.pi * 0.025**2, 0.03, 1e6
STRAIN = np.arange(0.0, 0.3, 5e-4)
PLATES = 0.05 / (4 * 0.03)  # shape factor


def compress(
    stress: FloatArray,
    machine: Machine = EXACT,
    plates: str = "",
    own_Pa: FloatArray | None = None,
    strain: FloatArray = STRAIN,
    **config: object,
) -> Measurement[LoadingCurve]:
    columns = {"displacement_m": HEIGHT * strain, "force_N": AREA * stress}
    if own_Pa is not None:
        columns |= {"nominal_strain": strain, "nominal_stress_Pa": own_Pa}
    row = specimen(TECHNIQUE.key, CYLINDER)
    row = Specimen(**{n: getattr(row, n) for n in row.__slots__} | {"notes": {"plates": plates}})
    return TECHNIQUE.reduce(row, recording(**columns), context(TECHNIQUE, machine, **config))


def test_the_compliance_of_the_machine_is_taken_off_with_its_uncertainty() -> None:
    machine = Machine(
        u_force_calibration=0.0, u_displacement_calibration=0.0,
        compliance_m_per_N=1e-6, u_compliance_m_per_N=2e-7,
    )  # fmt: skip
    per_Pa = AREA / HEIGHT * 1e-6
    seen = STRAIN + per_Pa * E * STRAIN  # travel of frame and specimen
    stress = E * STRAIN
    softer = compress(stress, strain=seen).values[0]
    assert softer.quantity.value == pytest.approx(E / (1 + per_Pa * E), rel=1e-9)
    assert "machine compliance not declared" in softer.method
    for value in compress(stress, machine, strain=seen).values:
        assert value.quantity.value == pytest.approx(E, rel=1e-9)
        (line,) = [c for c in value.budget if c.source == "machine compliance"]
        assert line.shared
        assert line.u == pytest.approx(E**2 * AREA / HEIGHT * 2e-7, rel=1e-9)
        assert "less the machine's compliance" in value.method
        assert "compliance not declared" not in value.method


def test_the_effect_of_the_plates_is_stated() -> None:
    plain, bonded, lubricated = (compress(E * STRAIN, plates=p) for p in ("", "bonded", "lubricated"))  # fmt: skip
    for measured in (plain, bonded, lubricated):
        for value in measured.values:
            assert value.quantity.value == pytest.approx(E, rel=1e-9)
            assert value.diagnostics["shape_factor"] == pytest.approx(PLATES)
            assert value.diagnostics["bonded_plates_factor"] == pytest.approx(1 + 2 * PLATES**2)
    assert "friction at the plates not declared (1 to 1.35 times)" in plain.values[0].method
    assert [[f.name for f in v.flags] for v in bonded.values] == [["plate-friction"]] * 2
    assert lubricated.values[0].flags == plain.values[0].flags == ()


def test_bonded_plates_are_corrected_on_request() -> None:
    for value in compress(E * STRAIN, plates="bonded", correct_bonded_plates=True).values:
        assert value.quantity.value == pytest.approx(E / (1 + 2 * PLATES**2), rel=1e-9)
        assert value.flags == ()
        assert "divided by 1 + 2 S^2 = 1.347 for bonded plates (Gent & Lindley 1959)" in value.method  # fmt: skip
    untouched = compress(E * STRAIN, correct_bonded_plates=True).values[0]
    assert untouched.quantity.value == pytest.approx(E, rel=1e-9)


def test_another_word_for_the_plates_is_refused() -> None:
    assert "write bonded or lubricated" in compress(E * STRAIN, plates="glued").refusals[0].reason


@pytest.mark.parametrize("factor", [1e-3, 0.7, 1.3, 1e3])
def test_a_file_whose_own_stress_is_another_gives_nothing(factor: float) -> None:
    measured = compress(E * STRAIN, own_Pa=factor * E * STRAIN)
    assert measured.values == ()
    assert len(measured.refusals) == 2
    assert f"the file's own stress is {factor:.4g} times force over" in measured.refusals[0].reason


def test_own_columns_that_differ_a_little_are_flagged_on_both_moduli() -> None:
    values = compress(E * STRAIN, own_Pa=1.1 * E * STRAIN).values
    assert [[f.name for f in v.flags] for v in values] == [["own-columns-disagree"]] * 2


def test_what_is_wrong_with_the_curve_is_said_of_both_moduli() -> None:
    toe = np.where(STRAIN < 0.02, 1e5 * STRAIN**2 / 0.04, 1e5 * (STRAIN - 0.01))
    assert [v.flags[0].name for v in compress(toe).values] == ["toe", "toe"]
