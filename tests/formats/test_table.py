"""Units, names and flags of a table, whatever its form."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.units import UNITS
from deamat.formats.quantities import STANDARD, assign, own_name
from deamat.formats.rawfile import RawFile
from tests.formats.samples import BY_NAME
from tests.formats.test_good_files import read


def phantom(*lines: str) -> Recording:
    return read(RawFile("x.csv", "\n".join([*lines, ""]).encode()))


def flags(recording: Recording) -> dict[str, str]:
    return {flag.name: flag.detail for flag in recording.flags}


def refused(*lines: str) -> str:
    with pytest.raises(RawFileError) as caught:
        phantom(*lines)
    return str(caught.value)


def test_percent_strain_becomes_a_pure_number() -> None:
    recording = phantom("Strain (%),Stress (N/mm²)", "12.5,0.25")
    assert recording.columns["nominal_strain"].tolist() == [0.125]
    assert recording.columns["nominal_stress_Pa"].tolist() == [250_000.0]


@pytest.mark.parametrize("unit", ["µN", "μN", "mN", "N", "kN", "lbf", "gf"])
def test_a_force_comes_out_in_newtons_from_every_unit(unit: str) -> None:
    plain = unit.replace("µ", "u").replace("μ", "u")
    recording = phantom(f"Time (s),Load ({unit})", "0,2.5")
    assert recording.columns["force_N"].tolist() == [2.5 * UNITS[plain][1]]


def test_other_columns_keep_their_name_with_the_si_unit() -> None:
    recording = phantom("Time (min),Load (N),Coil current (mA),Chamber (°C)", "1,2,3,25")
    assert {name: values[0] for name, values in recording.columns.items()} == {
        "time_s": 60.0,
        "force_N": 2.0,
        "coil_current_A": 0.003,
        "chamber_K": 298.15,
    }


@pytest.mark.parametrize(
    ("label", "unit", "name"),
    [
        ("Speed", "m/s", "speed_m_per_s"),
        ("Rate", "1/s", "rate_per_s"),
        ("Shear viscosity", "Pa.s", "shear_viscosity_Pas"),
        ("Cycle count", "1", "cycle_count"),
        ("Tensile strain (Extension)", "m", "tensile_strain_extension_m"),
    ],
)
def test_own_names(label: str, unit: str, name: str) -> None:
    assert own_name(label, unit) == name


def test_the_preferred_of_two_columns_gets_the_standard_name() -> None:
    labels = ("Compressive extension", "Load", "Extension", "Compressive load")
    assert assign(labels, ("m", "N", "m", "N")) == (
        "compressive_extension_m",
        "force_N",
        "displacement_m",
        "compressive_load_N",
    )


def test_no_label_means_two_quantities() -> None:
    labels = [label for _, names in STANDARD.values() for label in names]
    assert len(set(labels)) == len(labels)
    assert all(label == label.casefold() for label in labels)


def test_a_remark_in_brackets_is_no_unit_above_a_row_of_units() -> None:
    text = "Time,Tensile strain (Extension),Load\n(s),(%),(N)\n0,50,1\n"
    assert read(RawFile("x", text.encode())).columns["nominal_strain"].tolist() == [0.5]


def test_a_unit_of_another_kind_is_flagged_and_not_taken() -> None:
    recording = phantom("Time (s),Load (mm),Stress (kPa)", "0,1,2")
    assert "force_N" not in recording.columns
    assert recording.columns["load_m"].tolist() == [0.001]
    assert flags(recording) == {
        "unit-of-another-kind": "Load is in m, which is not a unit of force_N; it was not taken "
        "for it"
    }


def test_an_unknown_unit_is_refused_by_name() -> None:
    message = refused("Sample", "Time (s),Load (N),Grip (kNn)", "0,1,2")
    assert message.startswith("x.csv, line 2, column 3: 'Grip': unknown unit 'kNn'; ")
    assert "kN" in message.split("near it: ")[1]
    assert message.endswith(" (found 'kNn'); export the column in a known unit, or leave it out")


def test_a_column_without_a_unit_is_refused() -> None:
    assert refused("Time (s),Load (N),Stroke", "0,1,2") == (
        "x.csv, line 1, column 3: a column without a unit, neither over the column nor in the "
        "header (found 'Stroke'); export the column with its unit, or leave it out"
    )


def test_two_columns_of_one_label_are_refused() -> None:
    assert refused("Time (s),Load (N),load (kN)", "0,1,2") == (
        "x.csv, line 1, column 3: duplicate column: two columns have the same label (found 'load'); "
        "export each quantity once"
    )


def test_rows_above_the_labels_are_refused() -> None:
    assert refused("0,1", "Time (s),Load (N)", "0,1") == (
        "x.csv, line 1: a row of numbers above the labels (found '0,1'); "
        "one file holds one run: export each run to a file of its own"
    )


def test_a_wider_table_below_the_first_is_refused() -> None:
    message = refused("Time (s),Load (N)", "0,1", "Time (s),Load (N),Compression (mm)", "0,1,2")
    assert message.startswith("x.csv, line 3: a text row between the rows")


def test_header_and_column_that_contradict_each_other_are_flagged() -> None:
    recording = phantom("Engineering stress (N/mm2);", "Time (s),Engineering Stress (kPa)", "0,5")
    assert recording.columns["nominal_stress_Pa"].tolist() == [5000.0]
    assert flags(recording) == {
        "unit-contradiction": "Engineering Stress: the header says N/mm2, the column says kPa; "
        "the column was used"
    }
    agreeing = phantom("Engineering stress (N/mm2);", "Time (s),Engineering Stress (MPa)", "0,5")
    assert agreeing.flags == ()


@pytest.mark.parametrize(
    ("units", "newtons", "metres"),
    [
        (("N", "mm"), 1.0, 1e-3),
        (("lbF", "in"), 4.4482216152605, 0.0254),
        (("gF", "mm"), 9.80665e-3, 1e-3),
    ],
)
def test_mark10_takes_its_units_from_the_header(
    units: tuple[str, str], newtons: float, metres: float
) -> None:
    sample = BY_NAME["mark10"]
    lines = [
        line.replace("Units: N", f"Units: {units[0]}").replace("Unit: mm", f"Unit: {units[1]}")
        for line in sample.lines
    ]
    recording = read(sample.raw(lines))
    written = sample.columns()
    assert np.array_equal(recording.columns["force_N"], written["force_N"] * newtons)
    assert np.allclose(
        recording.columns["displacement_m"], written["displacement_m"] * 1e3 * metres, rtol=1e-15
    )


def test_mark10_without_a_travel_unit_is_refused() -> None:
    sample = BY_NAME["mark10"]
    lines = [line for line in sample.lines if not line.startswith("Travel Unit")]
    with pytest.raises(RawFileError) as caught:
        read(sample.raw(lines))
    assert (caught.value.line, caught.value.column, caught.value.value) == (5, 3, "Travel")
    assert caught.value.reason.startswith("a column without a unit")


def test_units_from_a_form_s_documentation_are_named_and_no_flag() -> None:
    sample = BY_NAME["mark10"]
    recording = read(sample.raw(sample.lines))
    assert recording.metadata["units not written in the file"] == "Reading [1], Time [s]"
    assert recording.flags == ()
    written = phantom("Time (s),Load (N)", "0,1", "1,2")
    assert "units not written in the file" not in written.metadata


def test_a_soro_strain_in_percent_is_read_as_percent() -> None:
    sample = BY_NAME["soro"]
    lines = [line.replace("Engineering Strain", "Engineering Strain (%)") for line in sample.lines]
    recording = read(sample.raw(lines))
    whole = sample.columns()["nominal_strain"] * 0.01
    assert np.array_equal(recording.columns["nominal_strain"], whole)


def test_identical_rows_are_flagged_and_kept() -> None:
    recording = phantom("Time (s),Load (N)", "0,1", "0,1", "1,1", "2,1", "2,1", "2,1")
    assert len(recording.columns["time_s"]) == 6
    assert flags(recording) == {
        "identical-rows": "rows equal to the row before in every column: 3, the first in line 3; "
        "none was dropped"
    }


def test_rows_of_one_time_with_other_values_are_not_identical() -> None:
    assert phantom("Time (s),Load (N)", "0,1", "0,2").flags == ()


def test_identical_rows_are_found_without_a_time_column() -> None:
    recording = phantom("Compression (mm),Load (N)", "0,1", "0,2", "0,2")
    assert flags(recording) == {
        "identical-rows": "rows equal to the row before in every column: 1, the first in line 4; "
        "none was dropped"
    }


def test_time_that_runs_backwards_is_flagged() -> None:
    recording = phantom("Sample", "Time (s),Load (N)", "0,1", "2,1", "1,1", "3,1")
    assert flags(recording) == {
        "time-not-increasing": "steps back in time: 1, the first in line 5 (from 2 to 1 as written)"
    }


def test_zeros_after_the_break_are_flagged_and_kept() -> None:
    sample = BY_NAME["zwick"]
    recording = read(sample.raw(sample.lines))
    assert flags(recording) == {
        "trailing-zeros": "specimen_width_m is exactly 0 in the last 2 rows, from line 14: the "
        "sensor lost the specimen"
    }
    assert len(recording.columns["specimen_width_m"]) == 8


def test_a_column_of_zeros_lost_nothing() -> None:
    sample = BY_NAME["zwick"]
    lines = [*sample.header, "0,0.1,0", "0.1,0.2,0"]
    assert read(sample.raw(lines)).flags == ()


@pytest.mark.parametrize("summaries", [0, 1, 30])
def test_zwick_summaries_vary_in_number(summaries: int) -> None:
    sample = BY_NAME["zwick"]
    summary = [f'"Result {number}",{number},"MPa"' for number in range(summaries)]
    recording = read(sample.raw([*summary, *sample.lines[sample.first - 3 :]]))
    assert recording.source.first_line == summaries + 3
    assert len(recording.metadata) == summaries
