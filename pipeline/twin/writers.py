"""The forms in which instruments and labs write files: numbers in, bytes out."""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime

import numpy as np

from deamat.core.arrays import FloatArray

_DAYS = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")
_MONTHS = (
    *("Jan", "Feb", "Mar", "Apr", "May", "Jun"),
    *("Jul", "Aug", "Sep", "Oct", "Nov", "Dec"),
)


def chatillon_log(
    started: datetime, force_N: FloatArray, travel_m: FloatArray, time_s: FloatArray
) -> bytes:
    """Write the log of a Mark-10 or Chatillon stand: CRLF, tabs, N and mm to three decimals.

    The form has no field for a remark.

    Parameters
    ----------
    started : stamp of the first line
    force_N, travel_m, time_s : shape (n,) each
    """
    # by hand: strftime would follow the locale
    clock = f"{started.hour % 12 or 12}:{started.minute:02} {'AM' if started.hour < 12 else 'PM'}"
    stamp = f"{started.month}/{started.day}/{started.year}  {clock}"
    head = [stamp, "Units: N", "X-Axis: Travel", "Travel Unit: mm", "Reading\tLoad\tTravel\tTime"]
    rows = zip(force_N.tolist(), (1e3 * travel_m).tolist(), time_s.tolist(), strict=True)
    body = [f"{i}\t{f:.3f}\t{x:.3f}\t{t:.3f}" for i, (f, x, t) in enumerate(rows, start=1)]
    return _lines(head + body, "\r\n")


def daq_ramp_log(
    remark: str,
    voltage_V_per_V: float,
    current_A_per_V: float,
    time_s: FloatArray,
    voltage_monitor_V: FloatArray,
    current_monitor_V: FloatArray,
) -> bytes:
    """Write the DAQ log of a high-voltage amplifier's two monitors, in volts.

    Parameters
    ----------
    remark : first line of the header
    voltage_V_per_V, current_A_per_V : what one volt of either monitor stands for
    time_s, voltage_monitor_V, current_monitor_V : shape (n,) each
    """
    head = [
        f"# {remark}",
        f"# channel 1: voltage monitor, {voltage_V_per_V:g} V/V",
        f"# channel 2: current monitor, {current_A_per_V:g} A/V",
        "time_s,ch1_V,ch2_V",
    ]
    columns = (time_s.tolist(), voltage_monitor_V.tolist(), current_monitor_V.tolist())
    rows = zip(*columns, strict=True)
    return _lines(head + [f"{t:.3f},{v:.4f},{i:.4f}" for t, v, i in rows], "\n")


def ramp_csv(
    remark: str, time_s: FloatArray, voltage_V: FloatArray, current_A: FloatArray
) -> bytes:
    """Write a high-voltage ramp as a plain table in s, kV and uA under a remark."""
    rows = zip(time_s.tolist(), voltage_V.tolist(), current_A.tolist(), strict=True)
    body = [f"{t:.1f},{v / 1e3:.4f},{i * 1e6:.2f}" for t, v, i in rows]
    return _lines([f"# {remark}", "time_s,voltage_kV,current_uA", *body], "\n")


def bluehill_csv(
    header: Iterable[tuple[str, str, str]],
    time_s: FloatArray,
    extension_m: FloatArray,
    force_N: FloatArray,
) -> bytes:
    """Write an Instron (Bluehill) raw-data CSV: quoted numbers with thousands commas, CRLF.

    Parameters
    ----------
    header : name, value and unit (or an empty text) of each header line
    time_s, extension_m, force_N : shape (n,) each
    """
    head = [f'{name},"{value}"' + (f",{unit}" if unit else "") for name, value, unit in header]
    head += ["", "Time,Extension,Load", "(s),(mm),(N)"]
    rows = zip(time_s.tolist(), (1e3 * extension_m).tolist(), force_N.tolist(), strict=True)
    body = [f'"{t:,.3f}","{x:,.4f}","{f:,.5f}"' for t, x, f in rows]
    return _lines(head + body, "\r\n")


def lcr6000_log(
    remark: str,
    function: str,
    frequency_Hz: FloatArray,
    primary: FloatArray,
    secondary: FloatArray,
) -> bytes:
    """Write the PC-logged replies of a GW Instek LCR-6020 at 1 V and slow speed.

    Parameters
    ----------
    remark : first line of the header
    function : what `FUNC?` replies, such as `Cp-D`
    frequency_Hz, primary, secondary : shape (n,) each, in SI
    """
    head = [
        f"# {remark}",
        "# *IDN? => LCR-6020,REV C1.06,SIMULATED,Good Will Instrument Co., Ltd.",
        f"# FUNC? => {function}",
        "# LEV:VOLT? => 1.000e+00V",
        "# APER? => SLOW,1",
    ]
    rows = zip(frequency_Hz.tolist(), primary.tolist(), secondary.tolist(), strict=True)
    return _lines(head + [f"{f:.5e},{a:+.5e},{b:+.5e},OK" for f, a, b in rows], "\n")


def lcr_csv(
    remark: str, frequency_Hz: FloatArray, capacitance_F: FloatArray, loss_tangent: FloatArray
) -> bytes:
    """Write a sweep as a plain table: `frequency_Hz,Cp_F,D` under a remark."""
    rows = zip(frequency_Hz.tolist(), capacitance_F.tolist(), loss_tangent.tolist(), strict=True)
    body = [f"{f:.6g},{c:.6e},{d:.6f}" for f, c, d in rows]
    return _lines([f"# {remark}", "frequency_Hz,Cp_F,D", *body], "\n")


def ndj8s_log(
    remarks: Iterable[str],
    stamps: Iterable[str],
    readings: Iterable[tuple[int, float, float | None, float]],
    temperatures_C: Iterable[float | None],
) -> bytes:
    """Write the serial lines of an NDJ-8S as a PC stamps them: `EEEE` where it was over range.

    Parameters
    ----------
    readings : rotor, speed in rpm, viscosity in Pa.s (None: over) and torque (fraction of full)
    temperatures_C : None where there was no probe
    """
    lines = [f"# {remark}" for remark in remarks]
    for stamp, (rotor, speed, viscosity, torque), celsius in zip(
        stamps, readings, temperatures_C, strict=True
    ):
        setting = f"{stamp}\t{rotor}#{speed:g} RPM"
        if viscosity is None:
            lines.append(f"{setting}  EEEE")
            continue
        probe = "-.-" if celsius is None else f"{celsius:.1f}"
        lines.append(f"{setting} {1e3 * viscosity:7.0f} {100 * torque:5.1f} {probe:>5}")
    return _lines(lines, "\n")


def viscometer_csv(
    remarks: Iterable[str],
    time_h: Iterable[float],
    readings: Iterable[tuple[int, float, float | None, float]],
    temperatures_C: Iterable[float | None],
) -> bytes:
    """Write the same readings as a laboratory's own CSV, in hours and Pa.s."""
    lines = [f"# {remark}" for remark in remarks]
    lines.append("time_h,rotor,speed_rpm,viscosity_Pas,torque_percent,temperature_C")
    for hours, (rotor, speed, viscosity, torque), celsius in zip(
        time_h, readings, temperatures_C, strict=True
    ):
        probe = "" if celsius is None else f"{celsius:.1f}"
        shown = (
            ("EEEE", "EEEE") if viscosity is None else (f"{viscosity:.3f}", f"{100 * torque:.1f}")
        )
        lines.append(f"{hours:.5f},{rotor},{speed:g},{shown[0]},{shown[1]},{probe}")
    return _lines(lines, "\n")


def hysitron_text(
    started: datetime,
    segments: Sequence[int],
    depth_m: FloatArray,
    force_N: FloatArray,
    time_s: FloatArray,
) -> bytes:
    """Write a Hysitron (TriboScan) export: tabs, six decimals, ISO-8859-1, LF.

    The form has no field for a remark. The signals in volts follow the quantities as they do in a
    real export: a capacitive depth sensor is linear, an electrostatic drive goes with the root.

    Parameters
    ----------
    segments : samples of each segment of the load function; blank lines part them
    depth_m, force_N, time_s : shape (n,) each
    """
    day, month = _DAYS[started.weekday()], _MONTHS[started.month - 1]  # whatever the locale
    stamp = f"{day} {month} {started.day:2} {started:%H:%M:%S} {started.year}"
    head = [stamp, "", f"Number of Points = {depth_m.size}"]
    head.append("Depth (nm)\tLoad (\u00b5N)\tTime (s)\tDepth (V)\tLoad (V)")
    nm, uN = 1e9 * depth_m, 1e6 * force_N
    signals = (-1.8e-4 * nm - 2.5e-3, np.sqrt(np.maximum(uN + 65.0, 0.0) / 297.0))
    table = np.column_stack([nm, uN, time_s, *signals]).tolist()
    rows = ["\t".join(f"{value:.6f}" for value in row) for row in table]
    for end in np.cumsum(segments)[-2::-1].tolist():
        rows.insert(end, "")
    return "".join(line + "\n" for line in head + rows).encode("latin-1")


def register_csv(rows: Sequence[Mapping[str, str]]) -> bytes:
    """Write a register: one row per specimen, columns as in the first row."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()


def manifest(contents: Mapping[str, bytes]) -> bytes:
    """Write what `sha256sum -c` reads: a hash and a path per line, sorted by path."""
    return _lines(
        [f"{hashlib.sha256(contents[path]).hexdigest()}  {path}" for path in sorted(contents)], "\n"
    )


def _lines(lines: Sequence[str], end: str) -> bytes:
    return "".join(line + end for line in lines).encode()
