"""Flow curves in the JSON of TRIOS: steps, columns, and exports that are not whole."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from tests.formats.trios import RATES, document, rows


def read(made: dict[str, Any] | str) -> Recording:
    text = made if isinstance(made, str) else json.dumps(made, indent=1)
    file = RawFile("c/x.json", text.encode(), technique="viscosity")
    return detect(file).read(file)


def refused(made: dict[str, Any] | str) -> str:
    with pytest.raises(RawFileError) as caught:
        read(made)
    return str(caught.value)


def test_one_flow_sweep_in_si() -> None:
    recording = read(document(rows("a")))
    assert recording.columns["shear_rate_per_s"].tolist() == RATES
    assert recording.columns["viscosity_Pas"].tolist() == pytest.approx([2.0] * 4)
    assert recording.columns["shear_stress_Pa"].tolist() == pytest.approx([2.0 * r for r in RATES])
    assert recording.columns["temperature_K"].tolist() == pytest.approx([295.15] * 4)
    assert recording.metadata["step"] == "Flow sweep - 1"
    assert recording.metadata["Sample"] == "silicone"
    assert recording.metadata["Date"] == "2025-02-17"
    source = recording.source
    assert (source.reader, source.first_line, source.last_line) == ("trios_json", 1, 4)


def test_a_step_of_conditioning_is_left_out() -> None:
    before = [{"Results Step Id": "b", "Temperature_°C": 22.0, "Time_s": 1.0}]
    recording = read(document([*before, *rows("a")]))
    assert recording.source.first_line == 2
    assert recording.columns["viscosity_Pas"].size == 4


def test_on_one_line_it_is_the_same() -> None:
    assert read(json.dumps(document(rows("a")))).columns["viscosity_Pas"].size == 4


def test_two_sweeps_are_refused_by_name() -> None:
    said = refused(document([*rows("a"), *rows("b")]))
    assert "several steps hold a flow curve: Flow sweep - 1, Conditioning" in said


def test_a_row_without_a_value_spoils_the_step() -> None:
    broken = rows("a")
    del broken[2]["Viscosity_mPa.s"]
    said = "Viscosity of step Flow sweep - 1 has no number in 1 of 4 rows (found 'None')"
    assert f"line 3: {said}" in refused(document(broken))


def test_a_flow_curve_without_a_shear_rate_is_no_viscosity_over_time() -> None:
    broken = rows("a")
    broken[1]["Shear rate_1/s"] = "OVER"
    assert "line 2: Shear rate of step Flow sweep - 1 has no number" in refused(document(broken))


def test_a_step_without_what_is_needed_is_said() -> None:
    bare = [{"Results Step Id": "b", "Temperature_°C": 22.0, "Time_s": 1.0}]
    assert "no step holds a flow curve in all of its rows" in refused(document(bare))


def test_what_is_not_whole_is_refused() -> None:
    text = json.dumps(document(rows("a")), indent=1)
    assert "not whole JSON" in refused(text[: len(text) // 2])
    assert "no Results.Processed in the export" in refused(text.replace('"Processed"', '"Raw"'))
    assert "no Results.Processed.Rows" in refused(text.replace('"Rows"', '"Row"'))


def test_spoilt_files_are_read_or_refused() -> None:
    generator = np.random.default_rng(5)
    good = json.dumps(document(rows("a")), indent=1).encode()
    for _ in range(300):
        data = bytearray(good)
        for at in generator.integers(0, len(data), 2):
            data[at] = int(generator.integers(32, 127))
        file = RawFile("x", bytes(data), technique="viscosity")
        try:
            columns = detect(file).read(file).columns
        except RawFileError:
            continue
        assert all(np.isfinite(values).all() for values in columns.values())
