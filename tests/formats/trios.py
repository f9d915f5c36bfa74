"""A small export of TRIOS as JSON; synthetic, made for tests."""

from __future__ import annotations

from typing import Any

RATES = [100.0, 10.0, 1.0, 0.1]
_UNITS = {
    "Shear rate": "1/s", "Viscosity": "mPa.s", "Stress": "Pa", "Stress (step)": "Pa",
    "Time": "s", "Temperature": "°C", "Axial force": "N",
}  # fmt: skip


def rows(step: str) -> list[dict[str, Any]]:
    return [
        {
            "Shear rate_1/s": rate, "Viscosity_mPa.s": 2000.0, "Stress_Pa": 2.0 * rate,
            "Stress (step)_Pa": 2.0 * rate, "Time_s": 10.0 * at, "Temperature_°C": 22.0,
            "Axial force_N": 0.1, "Results Step Id": step, "Termination reason": "Steady state",
        }
        for at, rate in enumerate(RATES)
    ]  # fmt: skip


def document(made: list[dict[str, Any]]) -> dict[str, Any]:
    headers: dict[str, Any] = {
        f"{name}_{unit}": {"DisplayName": name, "ValueType": "Number", "Unit": {"Name": unit}}
        for name, unit in _UNITS.items()
    }
    headers["Termination reason"] = {"DisplayName": "Termination reason", "ValueType": "Text"}
    steps = [{"Id": "a", "Name": "Flow sweep - 1"}, {"Id": "b", "Name": "Conditioning"}]
    processed = {"ResultsSteps": steps, "ColumnHeaders": headers, "Rows": made}
    return {
        "Schema": {"Url": "https://software.tainstruments.com/schemas/TRIOSJSONExportSchema"},
        "Sample": {"Name": "silicone"},
        "Results": {"Processed": processed},
        "StartTime": "2025-02-17T10:00:00Z",
    }
