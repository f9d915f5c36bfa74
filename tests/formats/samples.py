"""The good synthetic file of every format, and how to spoil it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.formats.rawfile import RawFile

DATA = Path(__file__).resolve().parent.parent / "data" / "formats"

TIME = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
TRAVEL_MM = (0.0, 0.00725, 0.02801, 0.04634, 0.0629, 0.0801, 0.09689, 0.11362)
FORCE = (0.00061, 0.02189, -0.02731, 0.04411, 0.08023, 0.11927, 0.15888, 0.20418)
BIG = (0.00061, 12.3, 999.99, 1000.00001, -2345.6, 12345.0, 242370.29658, 1234567.8)
CURRENT = (-0.0002, 0.0001, 0.0003, -0.0004, 0.0005, 0.0001, 9.3, 8.75)
DEPTH_NM = (-49.207661, -20.5, -0.720947, 1.810255, 6.311193, 20.2318, 19.75, 0.5)
LOAD_UN = (0.236883, -0.2213, 0.996201, 11.3033, 29.461702, 143.9746, 100.25, -0.865001)
SIGNAL_V = (-0.00185, 0.481918, 0.006321, 0.447365, 0.002201, 0.515, 0.573401, -0.0033)
STRAIN = (-0.0, -0.000242, -0.000934, -0.001545, -0.002097, -0.00267, -0.00323, -0.003787)
STRESS_KPA = (
    *(-0.000311, -0.011148, -0.013909, -0.022465),
    *(-0.040861, -0.060743, -0.080917, -0.103988),
)
SORO: dict[str, tuple[tuple[float, ...], float]] = {
    "time_s": ((0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14, 0.16), 1.0),
    "true_strain": ((0.0044, 0.0177, 0.0306, 0.0436, 0.057, 0.0657, 0.077, 0.0869), 1.0),
    "true_stress_Pa": (
        (0.0000555555555555556, 0.0019, 0.0038, 0.0057, 0.0075, 0.0092, 0.0108, 0.0126),
        1e6,
    ),
    "nominal_strain": (
        (
            *(0.00440969, 0.0178576, 0.0310730, 0.0445645),
            *(0.0586558, 0.0679063, 0.0800421, 0.0907876),
        ),
        1.0,
    ),
    "nominal_stress_Pa": (
        (0.0000555, 0.0018, 0.0036, 0.0054, 0.0071, 0.0087, 0.01, 0.0115),
        1e6,
    ),
}


@dataclass(frozen=True)
class Sample:
    """A good file, its table as numbers and its form.

    `written` gives each column's values as printed and the factor to SI, `first` the line of its
    first row counted from 1.
    """

    format: str
    file: str
    written: dict[str, tuple[tuple[float, ...], float]]
    first: int
    delimiter: str = ","
    decimal: str = "."
    quoted: bool = False
    encoding: str = "utf-8"
    newline: str = "\n"
    counted: bool = False  # the header states the number of rows; blank lines part segments
    flags: tuple[str, ...] = ()
    metadata: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)

    @cached_property
    def data(self) -> bytes:
        return (DATA / self.file).read_bytes()

    @cached_property
    def lines(self) -> list[str]:
        """Every line without its end."""
        return self.data.decode(self.encoding).split(self.newline)[:-1]

    @property
    def width(self) -> int:
        return len(self.written)

    @property
    def last(self) -> int:
        return len(self.lines)

    @property
    def header(self) -> list[str]:
        return self.lines[: self.first - 1]

    def raw(self, lines: list[str], *, end: str | None = None, encoding: str = "") -> RawFile:
        """Make a file of other lines in the same form."""
        text = self.newline.join(lines) + (self.newline if end is None else end)
        return RawFile(self.file, text.encode(encoding or self.encoding))

    def with_cell(self, row: int, column: int, text: str) -> RawFile:
        """Replace one cell, both counted from 0."""
        lines = list(self.lines)
        cells = self.cells(row)
        cells[column] = text
        lines[self.first - 1 + row] = self.delimiter.join(cells)
        return self.raw(lines, encoding="utf-8" if self.encoding == "latin-1" else "")

    def cells(self, row: int) -> list[str]:
        line = self.lines[self.first - 1 + row]
        if self.quoted:
            return [f'"{cell}"' for cell in line.strip('"').split('","')]
        return line.split(self.delimiter)

    def columns(self, rows: int | None = None) -> dict[str, FloatArray]:
        """The values in SI that must come out."""
        return {
            name: np.array(values[:rows]) * factor
            for name, (values, factor) in self.written.items()
        }


SAMPLES = (
    Sample(
        "hv_ramp",
        "hv_ramp.csv",
        {
            "time_s": (TIME, 1.0),
            "voltage_V": (FORCE, 2000.0),
            "current_A": (CURRENT, 2e-3),
        },
        first=5,
        metadata={
            "line 1": "Synthetic data, made for tests",
            "channel 1": "voltage monitor, 2000 V/V",
        },
        units={"time": "s", "ch1": "V", "ch2": "V"},
    ),
    Sample(
        "phantom",
        "phantom.csv",
        {
            "time_s": (TIME, 1.0),
            "displacement_m": (TRAVEL_MM, 1e-3),
            "force_N": (FORCE, 1.0),
            "nominal_strain": (STRAIN, 1.0),
            "nominal_stress_Pa": (STRESS_KPA, 1e3),
        },
        first=8,
        metadata={"Cylinder Diameter": "50mm", "line 2": "Synthetic data, made for tests"},
        units={"Engineering Strain": "-", "Engineering Stress": "kPa"},
    ),
    Sample(
        "soro",
        "soro.csv",
        SORO,
        first=9,
        delimiter=";",
        newline="\r\n",
        metadata={
            "units not written in the file": "True Strain [1], Engineering Strain [1]",
            "Material": "Synthetic 10 https://example.org",
            "Standard": "ASTM D412",
        },
        units={"True Strain": "", "True Stress": "MPa"},
    ),
    Sample(
        "bluehill",
        "bluehill.csv",
        {
            "time_s": (TIME, 1.0),
            "displacement_m": (TRAVEL_MM, 1e-3),
            "force_N": (BIG, 1.0),
        },
        first=7,
        quoted=True,
        metadata={"Specimen label": "synthetic 1", "Height": "30 mm"},
        units={"Time": "s", "Compressive extension": "mm", "Load": "N"},
    ),
    Sample(
        "mark10",
        "mark10.log",
        {
            "reading": (tuple(range(1, 9)), 1.0),
            "force_N": (FORCE, 1.0),
            "displacement_m": (TRAVEL_MM, 1e-3),
            "time_s": (TIME, 1.0),
        },
        first=7,
        delimiter="\t",
        newline="\r\n",
        metadata={
            "units not written in the file": "Reading [1], Time [s]",
            "timestamp": "11/22/2021  10:46 AM",
            "Units": "N",
            "Travel Unit": "mm",
        },
        units={"Reading": "", "Load": "N", "Travel": "mm", "Time": ""},
    ),
    Sample(
        "nexygen",
        "nexygen.txt",
        {
            "time_s": (TIME, 1.0),
            "force_N": (FORCE, 1.0),
            "displacement_m": (TRAVEL_MM, 1e-3),
        },
        first=4,
        delimiter="\t",
        encoding="utf-16",
        newline="\r\n",
        metadata={"Sample": "synthetic data, made for tests"},
        units={"Load": "N", "Machine Extension": "mm"},
    ),
    Sample(
        "mts",
        "mts.txt",
        {
            "displacement_m": (TRAVEL_MM, 1e-3),
            "force_N": (FORCE, 1e3),
            "time_s": (TIME, 1.0),
        },
        first=4,
        delimiter="\t",
        decimal=",",
        encoding="utf-8-sig",
        newline="\r\n",
        metadata={"Test Run Name": "synthetic data, made for tests"},
        units={"Load": "kN"},
    ),
    Sample(
        "hysitron",
        "hysitron.txt",
        {
            "depth_m": (DEPTH_NM, 1e-9),
            "force_N": (LOAD_UN, 1e-6),
            "time_s": (TIME, 1.0),
            "depth_signal_V": (SIGNAL_V, 1.0),
            "load_signal_V": (SIGNAL_V[::-1], 1.0),
        },
        first=5,
        delimiter="\t",
        encoding="latin-1",
        counted=True,
        metadata={
            "timestamp": "Mon Jan 10 09:00:00 2022",
            "line 2": "synthetic data, made for tests",
            "Number of Points": "8",
        },
        units={"Depth": "nm", "Load": "µN", "Time": "s", "Depth signal": "V"},
    ),
    Sample(
        "zwick",
        "zwick.tra",
        {
            "displacement_m": ((1.46484e-007, *TRAVEL_MM[1:]), 1e-3),
            "force_N": (FORCE, 1.0),
            "specimen_width_m": ((6.0, 5.99, 5.98, 5.97, 5.96, 5.95, 0.0, 0.0), 1e-3),
        },
        first=8,
        flags=("trailing-zeros",),
        metadata={"Force maximum": "0.0113 MPa", "Yield strain": "Unknown"},
        units={"Standard travel": "mm", "Specimen width": "mm"},
    ),
)
BY_NAME = {sample.format: sample for sample in SAMPLES}
# Readers of lines that are no plain table of numbers: test_viscometer.py and test_flow.py.
TESTED_APART = (
    "antonpaar", "flow_tab", "ndj8s", "rheocompass", "rheodata", "schmid", "viscometer_csv",
)  # fmt: skip
