"""Ramps: channels multiplied out by what the file says of them, plain tables in V or kV."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import by_name, detect
from deamat.formats.rawfile import RawFile

VOLTAGE = "# channel 1: voltage monitor, 2000 V/V"
CURRENT = "# channel 2: current monitor, 2e-3 A/V"


def read(*lines: str) -> Recording:
    file = RawFile("r.csv", ("\n".join(lines) + "\n").encode())
    assert detect(file).name == "hv_ramp"
    return detect(file).read(file)


@pytest.mark.parametrize(
    ("label", "cells", "volts"),
    [
        ("voltage_kV", "0.0,1.5", [0.0, 1500.0]),
        ("voltage_V", "0.0,1500", [0.0, 1500.0]),
        ("voltage_kV", "-0.5,-1.5", [-500.0, -1500.0]),
    ],
)
def test_a_plain_table_may_do_without_a_current(label: str, cells: str, volts: list[float]) -> None:
    first, second = cells.split(",")
    recording = read(f"time_s,{label}", f"0.0,{first}", f"0.5,{second}")
    assert list(recording.columns) == ["time_s", "voltage_V"]
    assert recording.columns["voltage_V"].tolist() == volts


def test_a_plain_table_in_another_order_dialect_and_unit() -> None:
    recording = read("current_uA;time_min;voltage_kV", "0,25;0,5;0,5", "1,25;1,5;1,25")
    assert recording.columns["time_s"].tolist() == [30.0, 90.0]
    assert recording.columns["voltage_V"].tolist() == [500.0, 1250.0]
    assert recording.columns["current_A"] == pytest.approx(np.array([2.5e-7, 1.25e-6]))
    assert recording.column_units == {"current": "uA", "time": "min", "voltage": "kV"}


def test_channels_go_by_their_number_and_their_unit() -> None:
    recording = read(
        "# operator: nobody",
        "# channel 3: Voltage Monitor, 2 kV/V",
        "# channel 1: current monitor, 2 mA/V",
        "time_s,ch1_V,ch3_V",
        "0.0,0.5,0.001",
        "0.5,1.0,0.002",
    )
    assert recording.columns["voltage_V"].tolist() == [2.0, 4.0]
    assert recording.columns["current_A"].tolist() == [0.001, 0.002]
    assert recording.metadata["operator"] == "nobody"


MEND = "declare it above the labels: `# channel 1: voltage monitor, 2000 V/V`"


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            ["time_s,ch1_V", "0,1"],
            "r.csv, line 1, column 2: a channel for which the file does not say what it measures "
            f"(found 'ch1'); {MEND}",
        ),
        (
            [VOLTAGE, "time_s,ch1_V,ch2_V", "0,1,1"],
            "r.csv, line 2, column 3: a channel for which the file does not say what it measures "
            f"(found 'ch2'); {MEND}",
        ),
        (
            [VOLTAGE, VOLTAGE, "time_s,ch1_V", "0,1"],
            f"r.csv, line 2: channel 1 is declared in line 1 already (found '{VOLTAGE}'); declare "
            "each channel once",
        ),
        (
            ["# channel 1: voltage monitor, 2,000 V/V", "time_s,ch1_V", "0,1"],
            "r.csv, line 1: not the declaration of a voltage or current monitor (found 'voltage "
            f"monitor, 2,000 V/V'); {MEND}",
        ),
        (
            ["# channel 1: voltage monitor, 2000 A/V", "time_s,ch1_V", "0,1"],
            "r.csv, line 1: a voltage monitor in A per volt (found 'voltage monitor, 2000 A/V'); "
            "declare it in V/V",
        ),
        (
            ["# channel 1: current monitor, 2 furlong/V", "time_s,ch1_V", "0,1"],
            "r.csv, line 1: a current monitor in furlong per volt (found 'current monitor, 2 "
            "furlong/V'); declare it in A/V",
        ),
        (
            [VOLTAGE, "time_s,ch1_A", "0,1"],
            "r.csv, line 2, column 2: a channel that is not in volts (found 'ch1 [A]'); log the "
            "monitor outputs in V",
        ),
        (
            [CURRENT, "time_s,ch2_V", "0,1"],
            f"r.csv, line 2: no channel is a voltage monitor; {MEND}",
        ),
        (
            [VOLTAGE, "time_s,ch1_V,voltage_V", "0,1,2"],
            "r.csv, line 2, column 3: two columns hold the voltage (found 'voltage'); log each "
            "quantity once",
        ),
        (
            ["time_s,voltage_uA", "0,1"],
            "r.csv, line 1, column 2: a voltage in uA (found 'voltage'); name the column voltage_V",
        ),
        (
            ["time_s,voltage", "0,1"],
            "r.csv, line 1, column 2: a column without a unit, neither over the column nor in the "
            "header (found 'voltage'); export the column with its unit, or leave it out",
        ),
    ],
)
def test_what_is_not_said_for_certain_is_refused(lines: list[str], message: str) -> None:
    with pytest.raises(RawFileError) as caught:
        read(*lines)
    assert str(caught.value) == message


def test_a_file_of_another_form_is_refused_by_name() -> None:
    with pytest.raises(RawFileError, match="no row of labels and units as the hv_ramp form has it"):
        by_name("hv_ramp").read(RawFile("r.csv", b"frequency_Hz,Cp_F,D\n1,2,3\n"))
