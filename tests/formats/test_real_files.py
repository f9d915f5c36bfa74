"""The real files beside the project, against numpy and pandas on the same bytes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from deamat.core.recording import Recording
from deamat.formats import FORMATS
from deamat.formats.detect import detect
from deamat.formats.documentation import contradictions, stated_units
from deamat.formats.rawfile import RawFile

PHANTOM = {
    "time_s": 1.0,
    "displacement_m": 1e-3,
    "force_N": 1.0,
    "nominal_strain": 1.0,
    "nominal_stress_Pa": 1e3,
    "true_strain": 1.0,
    "true_stress_Pa": 1e3,
}
SORO = {
    "time_s": 1.0,
    "true_strain": 1.0,
    "true_stress_Pa": 1e6,
    "nominal_strain": 1.0,
    "nominal_stress_Pa": 1e6,
}

_MACHINES = ("bluehill", "mark10", "mts", "nexygen", "phantom", "soro", "zwick")


def check(path: Path, form: str, factors: dict[str, float], skip: int, delimiter: str) -> Recording:
    """Read a file and compare it with numpy's and pandas' reading bit for bit."""
    file = RawFile(path.name, path.read_bytes())
    found = detect(file)
    recording = found.read(file)
    assert found.name == form
    assert list(recording.columns) == list(factors)
    by_numpy = np.loadtxt(path, delimiter=delimiter, skiprows=skip)
    by_pandas = pd.read_csv(path, sep=delimiter, skiprows=skip, header=None)
    for column, (name, factor) in enumerate(factors.items()):
        values = recording.columns[name]
        assert values.tobytes() == (by_numpy[:, column] * factor).tobytes()
        pandas_values = by_pandas[column].to_numpy(dtype=np.float64)
        assert values.tobytes() == (pandas_values * factor).tobytes()
    assert recording.source.first_line == skip + 1
    assert recording.source.last_line == skip + len(by_numpy)
    return recording


@pytest.mark.shared
def test_all_thirty_phantom_files_read_as_numpy_and_pandas_read_them(shared: Path) -> None:
    folder = shared / "real" / "ecoflex-phantom-2026"
    paths = sorted(folder.glob("compression/*/*.csv"))
    assert len(paths) == 30
    stated = stated_units((folder / "UPSTREAM_README.txt").read_text())
    for path in paths:
        recording = check(path, "phantom", PHANTOM, 8, ",")
        assert recording.flags == ()
        assert recording.metadata["Cylinder Diameter"] == "50mm"
        assert recording.column_units["Engineering Stress"] == "kPa"
        assert [str(flag) for flag in contradictions(stated, recording.column_units)] == [
            f"unit-contradiction: {label}: the README says N/mm^2, the column says kPa; the column "
            "was used"
            for label in ("Engineering Stress", "True Stress")
        ]


@pytest.mark.shared
def test_all_seven_soro_files_read_as_numpy_and_pandas_read_them(shared: Path) -> None:
    paths = sorted((shared / "real" / "soro-2019" / "tension" / "curves").glob("*.csv"))
    assert len(paths) == 7
    for path in paths:
        recording = check(path, "soro", SORO, 18, ";")
        backwards = any(flag.name == "time-not-increasing" for flag in recording.flags)
        assert backwards == (path.stem == "Ecoflex 00-30")
        assert recording.metadata["Standard"] == "ASTM D412"


@pytest.mark.shared
def test_files_of_other_instruments_are_not_claimed(shared: Path) -> None:
    others = ("flow", "dielectric", "instrument_lines")
    others = ("dielectric", "nanoindentation", "instrument_lines")
    paths = [
        path
        for folder in others
        for path in (shared / "real" / folder).rglob("*")
        if path.is_file() and path.suffix not in {".yaml", ""}
    ]
    assert len(paths) > 10
    for path in paths:
        head = RawFile(path.name, path.read_bytes()).head
        machines = [f.name for f in FORMATS if f.name in _MACHINES and f.recognises(head)]
        assert machines == [], path
