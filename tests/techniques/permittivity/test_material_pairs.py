"""Permittivities that a spectrometer computed: pairs, cell, and what the register adds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.errors import FitRefused, RawFileError
from deamat.core.recording import Recording
from deamat.estimators.dielectric.material_pairs import MATERIAL_PAIRS, complex_permittivity
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques.permittivity.config import PermittivityConfig
from tests.techniques.permittivity.films import EPS0, NO_FORCE, card, context, reduce

FREQUENCY = np.array([1e4, 1e3, 300.0, 100.0, 30.0, 10.0])
EPS, LOSS = 2.9, 0.004
NOTHING = dict.fromkeys(
    ("thickness_m", "plate_length_m", "plate_width_m", "micrometer_force_N", "anvil_diameter_m")
)
CELL = "Diameter[mm] 4.000e+01  Thickness[mm] 5.000e-01  Spacer Capacity[pF] 0.000e+00"
COLUMNS = {  # label to values; each pair says the same film
    "Eps'": np.full(6, EPS),
    "Eps''": np.full(6, EPS * LOSS),
    "Tan(Delta)": np.full(6, LOSS),
    "Sig' [S/cm]": 2e-2 * math.pi * FREQUENCY * EPS0 * EPS * LOSS,
    "Modulus'": np.full(6, 1.0 / EPS / (1.0 + LOSS**2)),
    "Modulus''": np.full(6, LOSS / EPS / (1.0 + LOSS**2)),
}
PAIRS = (
    ("Eps'", "Eps''"),
    ("Eps'", "Tan(Delta)"),
    ("Eps'", "Sig' [S/cm]"),
    ("Modulus'", "Modulus''"),
)


def windeta(labels: tuple[str, ...], cell: str = CELL, temperature: bool = False) -> Recording:
    head = f"X1, 17.2.2025, 11:19\n{cell}\nFixed value(s) :  AC Volt  [Vrms]=5.0000e-01\n"
    table = [" Freq. [Hz]", *(["Temp. [°C]"] if temperature else []), *labels]
    rows = [
        [f, *([22.0] if temperature else []), *(COLUMNS[label][at] for label in labels)]
        for at, f in enumerate(FREQUENCY)
    ]
    body = "".join("\t".join(f"{value:.5e}" for value in row) + "\n" for row in rows)
    text = head + "\t ".join(table) + "\n" + body
    file = RawFile("c/permittivity/a.txt", text.encode("cp1252"), technique="permittivity")
    return detect(file).read(file)


@pytest.mark.parametrize("labels", PAIRS)
def test_every_pair_gives_the_film_that_the_file_states(labels: tuple[str, str]) -> None:
    eps, loss = card(reduce(windeta(labels, temperature=True), **NOTHING))
    assert eps == pytest.approx(EPS, rel=1e-4)
    assert loss == pytest.approx(LOSS, rel=1e-4)


def test_a_text_without_its_cell_is_a_plain_table_and_is_taken_as_it_is() -> None:
    recording = windeta(PAIRS[0], cell="")
    assert recording.source.reader == "plain"
    measured = reduce(recording, context(None), micrometer_force_N=NO_FORCE)
    assert card(measured)[0] == pytest.approx(EPS, rel=1e-12)


def test_the_file_states_name_day_level_and_cell() -> None:
    recording = windeta(PAIRS[0])
    said = recording.metadata
    assert recording.source.reader == "novocontrol"
    assert recording.source.first_line == 5
    assert (said["Sample"], said["Date"], said["level_V"]) == ("X1", "17.2.2025", "0.5")
    assert float(said["cell_diameter_m"]) == pytest.approx(0.04)
    assert float(said["cell_thickness_m"]) == pytest.approx(5e-4)
    assert said["Thickness [mm]"] == "5.000e-01"
    assert "edge_field" not in said


def test_the_rows_dimensions_replace_those_that_the_software_computed_with() -> None:
    """C = eps eps0 A'/d' of the file; eps of the row = C d / (eps0 A)."""
    measured = reduce(windeta(PAIRS[0]), context(None), micrometer_force_N=NO_FORCE)
    vacuum_of_file, vacuum_of_row = math.pi / 4 * 0.04**2 / 5e-4, 45e-3**2 / 300e-6
    assert card(measured)[0] == pytest.approx(EPS * vacuum_of_file / vacuum_of_row, rel=1e-9)


def test_dimensions_of_the_file_have_a_declared_uncertainty() -> None:
    budget = reduce(windeta(PAIRS[0]), **NOTHING).values[0].budget
    stated = {line.source: line.u / EPS for line in budget if "states" in line.source}
    u = PermittivityConfig().u_stated_dimension
    assert stated == pytest.approx(
        {"film thickness, as the file states it": u, "plate area, as the file states it": 2 * u}
    )


def test_an_edge_field_is_not_corrected_twice() -> None:
    corrected = windeta(PAIRS[0], cell=CELL + "  Edge Correction On  Electrode Thickness[mm] 2.0")
    flush = context(None, edge_field="flush")
    measured = reduce(corrected, flush, **NOTHING)
    assert card(measured)[0] == pytest.approx(EPS, rel=1e-12)
    assert "corrected by the spectrometer's software" in measured.values[0].method
    assert card(reduce(windeta(PAIRS[0]), flush, **NOTHING))[0] < 0.999 * EPS


def test_a_cell_without_a_thickness_says_nothing_of_the_material() -> None:
    with pytest.raises(RawFileError, match="thickness of zero") as caught:
        windeta(PAIRS[0], cell=CELL.replace("5.000e-01", "0.000e+00"))
    assert caught.value.line == 2


def test_a_meters_sweep_without_dimensions_is_refused_by_what_is_missing() -> None:
    source = windeta(PAIRS[0], cell="")
    (reason,) = {refusal.reason for refusal in reduce(source, **NOTHING).refusals}
    assert "the register gives no thickness" in reason


def test_a_modulus_of_zero_is_refused() -> None:
    zero = np.zeros(1)
    with pytest.raises(FitRefused, match="an electric modulus of zero at 10 Hz"):
        complex_permittivity("M'-M''", np.array([10.0]), zero, zero)
    assert complex_permittivity("Eps'-Eps''", np.array([10.0]), zero, zero)[0] == 0.0


def test_pairs_have_columns_of_their_own() -> None:
    assert len({(pair.primary, pair.secondary) for pair in MATERIAL_PAIRS.values()}) == 4
