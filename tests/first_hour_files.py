"""Ten exports of one silicone as a laboratory has them, SYNTHETIC, for `docs/first-hour.md`."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.sheets import write_workbook
from deamat.twin.writers import lcr6000_log, ndj8s_log

REMARK = "SYNTHETIC: simulated, not measured"
MODULUS_Pa = 90e3
_EPSILON_0 = 8.8541878128e-12


def write_inbox(folder: Path) -> None:
    """Write three workbooks, two German exports, three oscilloscope files, a sweep and a log."""
    rng = np.random.default_rng(20260401)
    folder.mkdir()
    for number in (1, 2, 3):
        (folder / f"gel-a compression {number}.xlsx").write_bytes(_compression(rng))
        (folder / f"gel-a ramp {number}.csv").write_bytes(
            _ramp(rng, (9.1e3, 9.8e3, 10.4e3)[number - 1])
        )
    for number in (1, 2):
        (folder / f"gel-a zug {number}.csv").write_bytes(_tension(rng, number))
    (folder / "gel-a lcr.log").write_bytes(_sweep(rng))
    (folder / "gel-a viscometer.log").write_bytes(_curing(rng))


def _stress_Pa(stretch: FloatArray) -> FloatArray:
    """Nominal stress of a neo-Hookean solid."""
    return MODULUS_Pa / 3 * (stretch - stretch**-2)


def _compression(rng: np.random.Generator) -> bytes:
    """28 mm across and 12 mm high, pressed by 20 %."""
    modulus = 1.0 + 0.01 * rng.standard_normal()
    time_s = np.arange(0.0, 12.0, 0.06)
    travel_mm = 0.2 * time_s
    area_m2 = np.pi * 0.014**2
    load_N = -modulus * area_m2 * _stress_Pa(1.0 - travel_mm / 12.0)
    load_N += 0.01 * rng.standard_normal(time_s.size)
    rows: list[list[str | float]] = [
        [REMARK],
        [],
        ["Time (s)", "Displacement (mm)", "Load (N)"],
    ]
    rows += [
        [round(t, 2), round(x, 4), round(f, 4)]
        for t, x, f in zip(time_s.tolist(), travel_mm.tolist(), load_N.tolist(), strict=True)
    ]
    return write_workbook({"Data": rows, "Notes": [["room 2.14"]]})


def _tension(rng: np.random.Generator, number: int) -> bytes:
    """3 mm wide, 0.3 mm thick, 33 mm long, pulled until it breaks; as a German export."""
    strain = np.linspace(0.0, 1.6 + 0.1 * number, 1500)
    force_N = 3e-3 * 0.3e-3 * _stress_Pa(1.0 + strain) * (1.0 + 0.02 * rng.standard_normal())
    force_N += 5e-6 * rng.standard_normal(strain.size)
    force_N[-2:] = 0.0
    head = [f"{REMARK}", "Pr\u00fcfer;A. Beispiel", f"Probe;Zug {number}", ""]
    head += ["Pr\u00fcfzeit;Standardweg;Standardkraft", "s;mm;N"]
    body = [
        f"{49.5 * e:.3f};{33.0 * e:.4f};{f:.6f}".replace(".", ",")
        for e, f in zip(strain.tolist(), force_N.tolist(), strict=True)
    ]
    return ("\r\n".join([*head, *body]) + "\r\n").encode("cp1252")


def _ramp(rng: np.random.Generator, breakdown_V: float) -> bytes:
    """A ramp of 500 V/s that collapses, by a probe of 1000:1, as a TDS 2000 saves it."""
    time_s = np.arange(1000) * 0.025
    voltage_V = np.where(500.0 * time_s < breakdown_V, 500.0 * time_s, 0.0)
    voltage_V += 5.0 * rng.standard_normal(time_s.size)
    head = [
        "Record Length,1.00E+03", "Sample Interval,2.50E-02", "Trigger Point,0.0E+00", ",", ",", ",",
        "Source,CH1", "Vertical Units,V", "Vertical Scale,2.0E+03", "Vertical Offset,0.0E+00",
        "Horizontal Units,s", "Horizontal Scale,2.5E+00", "Pt Fmt,Y", "Yzero,0.0E+00",
        "Probe Atten,1.0E+03", "Model Number,SYNTHETIC", "Serial Number,SIMULATED",
        "Firmware Version,none",
    ]  # fmt: skip
    rows = zip(time_s.tolist(), voltage_V.tolist(), strict=True)
    lines = [
        f"{head[at] if at < len(head) else ','},,{t:.9f},{v:.5f}," for at, (t, v) in enumerate(rows)
    ]
    return ("\r\n".join(lines) + "\r\n").encode()


def _sweep(rng: np.random.Generator) -> bytes:
    """A film of 300 um between plates of 45 mm by 45 mm, permittivity 2.7."""
    frequency_Hz = np.logspace(1.0, 5.0, 41)
    capacitance_F = 2.7 * _EPSILON_0 * 0.045**2 / 300e-6 * (frequency_Hz / 1e3) ** -2e-3
    capacitance_F *= 1.0 + 1e-4 * rng.standard_normal(frequency_Hz.size)
    loss = 2e-3 + 1e-5 * rng.standard_normal(frequency_Hz.size)
    return lcr6000_log(REMARK, "Cp-D", frequency_Hz, capacitance_F, loss)


def _curing(rng: np.random.Generator) -> bytes:
    """Mixed at 9:00, read every 15 minutes for 13 hours; the viscosity doubles in ten."""
    start = datetime.fromisoformat("2026-03-12T09:15:00")
    minutes = [15.0 * at for at in range(53)]
    stamps = [(start + timedelta(minutes=m)).isoformat() for m in minutes]
    viscosity = [
        3.0 * 2.0 ** ((m + 15.0) / 600.0) * (1.0 + 0.005 * float(rng.standard_normal()))
        for m in minutes
    ]
    readings = [(3, 12.0, eta, eta / 10.0) for eta in viscosity]
    return ndj8s_log([REMARK], stamps, readings, [23.0] * len(minutes))
