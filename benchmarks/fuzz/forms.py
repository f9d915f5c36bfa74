"""The forms that the twin does not write, filled with its recordings or with simulated liquids."""

from __future__ import annotations

import codecs
from collections.abc import Mapping, Sequence

import numpy as np

from deamat.core.arrays import FloatArray

REMARK = "SYNTHETIC: simulated, not measured"
Columns = Mapping[str, FloatArray]


def _rows(
    head: Sequence[str],
    columns: Sequence[tuple[FloatArray, str]],
    delimiter: str,
    newline: str = "\n",
    start: str = "",
) -> str:
    """Set columns, each with the format of its numbers, below some header lines."""
    cells = [[f"{value:{form}}" for value in values.tolist()] for values, form in columns]
    rows = [start + delimiter.join(row) for row in zip(*cells, strict=True)]
    return "".join(line + newline for line in (*head, *rows))


def phantom(c: Columns, diameter_m: float, height_m: float) -> bytes:
    """Write a compression curve with its own strain and stress, negative as in that collection."""
    area_m2 = np.pi / 4.0 * diameter_m**2
    head = [
        "synthetic_sample_1",
        f"{REMARK};",
        f"Cylinder Diameter: {1e3 * diameter_m:g}mm;",
        f"Cylinder Height: {1e3 * height_m:g}mm;",
        "Time (s),Compression (mm),Load (N),Engineering Strain [-],Engineering Stress (kPa)",
    ]
    strain, stress = -c["displacement_m"] / height_m, -c["force_N"] / area_m2
    return _rows(
        head,
        [
            (c["time_s"], ".3f"), (1e3 * c["displacement_m"], ".5f"), (c["force_N"], ".5f"),
            (strain, ".6f"), (1e-3 * stress, ".6f"),
        ],
        ",",
    ).encode()  # fmt: skip


def nexygen(c: Columns) -> bytes:
    """Write a curve as UTF-16 text with tabs."""
    head = [f"Sample: {REMARK}", "", "Time (s)\tLoad (N)\tMachine Extension (mm)"]
    columns = [(c["time_s"], ".3f"), (c["force_N"], ".5f"), (1e3 * c["displacement_m"], ".5f")]
    text = _rows(head, columns, "\t", "\r\n")
    return codecs.BOM_UTF16_LE + text.encode("utf-16-le")


def mts(c: Columns) -> bytes:
    """Write a curve with decimal commas, the load in kN."""
    head = [f"Test Run Name: {REMARK}", "", "Crosshead (mm)\tLoad (kN)\tTime (s)"]
    columns = [
        (1e3 * c["displacement_m"], ".5f"), (1e-3 * c["force_N"], ".8f"), (c["time_s"], ".3f"),
    ]  # fmt: skip
    text = _rows([], columns, "\t", "\r\n").replace(".", ",")
    return codecs.BOM_UTF8 + (_rows(head, [], "\t", "\r\n") + text).encode()


def zwick(c: Columns) -> bytes:
    """Write a curve under quoted labels and units."""
    head = [
        f'"Remark","{REMARK}"', '"Yield strain","Unknown"',
        '"Standard travel ","Standard force "', '"mm","N"',
    ]  # fmt: skip
    columns = [(1e3 * c["displacement_m"], ".5f"), (c["force_N"], ".6f")]
    return _rows(head, columns, ",").encode()


def soro(c: Columns, width_m: float, thickness_m: float, gauge_length_m: float) -> bytes:
    """Write a tensile curve as true and engineering strain and stress."""
    head = [
        "PARAMETER;INFO;URL;;",
        f"Specimen Thickness (mm);{1e3 * thickness_m:g};;;",
        f"Specimen Width (mm);{1e3 * width_m:g};;;",
        "Standard;ASTM D412;;;",
        f"Material;{REMARK};;;",
        ";;;;",
        "Time (s);True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)",
    ]
    strain = c["displacement_m"] / gauge_length_m
    stress_MPa = 1e-6 * c["force_N"] / (width_m * thickness_m)
    columns = [
        (c["time_s"], ".3f"), (np.log1p(strain), ".7f"), (stress_MPa * (1.0 + strain), ".8f"),
        (strain, ".7f"), (stress_MPa, ".8f"),
    ]  # fmt: skip
    return _rows(head, columns, ";", "\r\n").encode()


def plain_german(c: Columns) -> bytes:
    """Write a curve as a plain table of a German program, in Windows' encoding."""
    head = [f"Bemerkung;{REMARK}", "Prüfzeit / s;Weg in mm;Kraft [N]"]
    columns = [(c["time_s"], ".3f"), (1e3 * c["displacement_m"], ".5f"), (c["force_N"], ".5f")]
    rows = _rows([], columns, ";", "\r\n").replace(".", ",")
    return (_rows(head, [], ";", "\r\n") + rows).encode("cp1252")


def plain_bars(c: Columns) -> bytes:
    """Write a curve as a plain table between bars, its units in the labels."""
    head = [f"Remark|{REMARK}", "time_s|displacement_mm|force_N"]
    columns = [(c["time_s"], ".3f"), (1e3 * c["displacement_m"], ".5f"), (c["force_N"], ".5f")]
    return _rows(head, columns, "|").encode()


def plain_counted(c: Columns) -> bytes:
    """Write a curve as UTF-16 with counters, texts and missing values that nobody needs."""
    head = [
        f"Test\t{REMARK}\t\t\t\t",
        "Set\tPoint\tTime\tLoad\tExtension\tStress",
        "\t\ts\tN\tmm\tkPa",
    ]
    points = np.arange(1.0, c["time_s"].size + 1.0)
    columns = [
        (points, ".0f"), (c["time_s"], ".3f"), (c["force_N"], ".5f"),
        (1e3 * c["displacement_m"], ".5f"),
    ]  # fmt: skip
    rows = _rows([], columns, "\t", "\tN/A\r\n", "run A\t")
    return (_rows(head, [], "\t", "\r\n") + rows).encode("utf-16")


def plain_quoted(c: Columns) -> bytes:
    """Write a curve with every cell in quotes, in German, a separator at the end of each line."""
    head = [f'"Bemerkung";"{REMARK}";;', '"Zeit";"Traversenweg";"Last";', '"(s)";"(mm)";"(N)";']
    columns = [(c["time_s"], ".3f"), (1e3 * c["displacement_m"], ".5f"), (c["force_N"], ".5f")]
    rows = _rows([], columns, '";"', '";\r\n', '"').replace(".", ",")
    return (_rows(head, [], ";", "\r\n") + rows).encode()


def plain_depth(c: Columns) -> bytes:
    """Write an indent as a plain table."""
    head = [f"Remark\t{REMARK}", "Time (s)\tLoad (uN)\tIndentation (nm)"]
    columns = [(c["time_s"], ".4f"), (1e6 * c["force_N"], ".5f"), (1e9 * c["depth_m"], ".3f")]
    return _rows(head, columns, "\t").encode()


def plain_impedance(c: Columns) -> bytes:
    """Write a sweep as modulus and phase of the impedance."""
    head = [f"Remark;{REMARK};;", "No.;Frequenz [kHz];|Z| [Ohm];Phasenwinkel [Grad]"]
    w = 2.0 * np.pi * c["frequency_Hz"]
    ohm = 1.0 / (w * c["parallel_capacitance_F"] * (c["loss_tangent"] + 1j))
    columns = [
        (np.arange(1.0, w.size + 1.0), ".0f"), (1e-3 * c["frequency_Hz"], ".6g"),
        (np.abs(ohm), ".7g"), (np.degrees(np.angle(ohm)), ".5f"),
    ]  # fmt: skip
    return _rows(head, columns, ";", "\r\n").encode()


def plain_cure(c: Columns) -> bytes:
    """Write a cure over times as a clock shows them."""
    head = [f"Remark;{REMARK}", "Elapsed time;Viscosity;Temp.", "hh:mm:ss;cP;C"]
    rows = "".join(
        f"{round(t) // 3600}:{round(t) // 60 % 60:02d}:{round(t) % 60:02d};{1e3 * eta:.0f};22.0\n"
        for t, eta in zip(c["time_s"].tolist(), c["viscosity_Pas"].tolist(), strict=True)
    )
    return (_rows(head, [], ";") + rows).encode()


def e4980a(c: Columns) -> bytes:
    """Write a sweep as a log of a Keysight E4980A."""
    head = [
        "Instrument,Keysight E4980A (synthetic)", "Function,CPD", "Voltage level,1 V",
        "Aperture,LONG", "Frequency (Hz),Primary,Secondary,Status",
    ]  # fmt: skip
    columns = [
        (c["frequency_Hz"], ".5E"), (c["parallel_capacitance_F"], "+.5E"),
        (c["loss_tangent"], "+.5E"), (np.zeros_like(c["loss_tangent"]), "+.0f"),
    ]  # fmt: skip
    return _rows(head, columns, ",").encode()


def rigol(c: Columns) -> bytes:
    """Write the voltage of a ramp as a Rigol oscilloscope saves a waveform."""
    t = c["time_s"]
    head = ["X,CH1,Start,Increment,", f"Sequence,Volt,{t[0]:.6e},{t[1] - t[0]:.6e}"]
    columns = [(np.arange(float(t.size)), ".0f"), (c["voltage_V"], ".4e")]
    rows = _rows([], columns, ",").replace("\n", ",\n")
    return (_rows(head, [], ",") + rows).encode()


def tektronix(c: Columns) -> bytes:
    """Write the voltage of a ramp as a Tektronix oscilloscope does: its header beside the rows."""
    said = [
        f"Record Length,{c['time_s'].size:.6e}", "Source,CH1", "Vertical Units,V",
        "Horizontal Units,s", "Probe Atten,1",
    ]  # fmt: skip
    rows = _rows([], [(c["time_s"], ".6f"), (c["voltage_V"], ".3f")], ",").splitlines()
    beside = [*said, *[","] * (len(rows) - len(said))]
    return "".join(f"{a},,{row},\n" for a, row in zip(beside, rows, strict=True)).encode()


def lvm(c: Columns) -> bytes:
    """Write voltage and current of a ramp as LabVIEW does."""
    head = [
        "LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Decimal_Separator\t.",
        "Multi_Headings\tNo", "X_Columns\tOne", f"Description\t{REMARK}",
        "***End_of_Header***\t", "\t", "Channels\t2\t", f"Samples\t{c['time_s'].size}\t",
        "Y_Unit_Label\tkV\tmA", "X_Dimension\tTime\tTime", "***End_of_Header***\t\t",
        "X_Value\tVoltage\tCurrent\tComment",
    ]  # fmt: skip
    columns = [
        (c["time_s"], ".6f"), (1e-3 * c["voltage_V"], ".6f"), (1e3 * c["current_A"], ".6f"),
    ]  # fmt: skip
    return _rows(head, columns, "\t").encode()


def e4990a(c: Columns) -> bytes:
    """Write a sweep as the trace of a Keysight E4990A: series resistance and reactance."""
    head = [
        "!Keysight Technologies,E4990A,SYNTHETIC", "BEGIN CH1_DATA",
        "Frequency(Hz), R(Ohm)-data, X(Ohm)-data",
    ]  # fmt: skip
    w = 2.0 * np.pi * c["frequency_Hz"]
    admittance = w * c["parallel_capacitance_F"] * (c["loss_tangent"] + 1j)
    ohm = 1.0 / admittance
    columns = [(c["frequency_Hz"], "+.6e"), (ohm.real, "+.6e"), (ohm.imag, "+.6e")]
    return (_rows(head, columns, ", ") + "END\n").encode()


def liquid(seed: int) -> Columns:
    """Simulate a flow curve: a power law (K = 30 Pa.s^n, n = 0.6) with 1 % noise."""
    rng = np.random.default_rng([seed, *b"fuzz liquid"])
    rate = np.logspace(-1.0, 2.0, 25)
    stress = 30.0 * rng.normal(1.0, 0.03) * rate**0.6 * rng.normal(1.0, 0.01, rate.size)
    return {"rate": rate, "stress": stress, "viscosity": stress / rate}


def antonpaar(c: Columns) -> bytes:
    """Write a flow curve with semicolons and decimal commas."""
    head = ["Shear Rate;Shear Stress;Viscosity", "[1/s];[Pa];[Pa·s]"]
    columns = [(c["rate"], ".4g"), (c["stress"], ".4g"), (c["viscosity"], ".4g")]
    body = _rows([], columns, ";", "\r\n").replace(".", ",")
    return (_rows(head, [], ";", "\r\n") + body).encode()


def flow_tab(c: Columns) -> bytes:
    """Write a flow curve with tabs and units in brackets."""
    head = ["Point No.\tShear Rate [1/s]\tViscosity [mPa·s]\tTemperature [°C]"]
    n = c["rate"].size
    columns = [
        (np.arange(1.0, n + 1.0), ".0f"), (c["rate"], ".5g"), (1e3 * c["viscosity"], ".1f"),
        (np.full(n, 22.0), ".0f"),
    ]  # fmt: skip
    return _rows(head, columns, "\t", "\r\n").encode()


def rheocompass(c: Columns) -> bytes:
    """Write a flow curve as a German RheoCompass exports an interval."""
    n = c["rate"].size
    head = [
        f"Projekt:\t{REMARK}", "", f"Abschnitt und Datenpunkte:\t1\t{n}",
        "Abschnittsdaten:\tPunkt Nr.\tZeit\tSchubspannung\tScherrate",
        "\t\t\tKonstanter Anteil\t", "\t[]\t[s]\t[Pa]\t[1/s]",
    ]  # fmt: skip
    points = np.arange(1.0, n + 1.0)
    columns = [(points, ".0f"), (10.0 * points, ".1f"), (c["stress"], ".5g"), (c["rate"], ".5g")]
    body = _rows([], columns, "\t", "\r\n", "\t").replace(".", ",")
    text = _rows(head, [], "\t", "\r\n") + body
    return codecs.BOM_UTF16_LE + text.encode("utf-16-le")


def rheodata(c: Columns) -> bytes:
    """Write a flow curve in long form, with its sample's name in every row."""
    columns = [(c["rate"], ".5g"), (c["stress"], ".5g")]
    return _rows(["sample_id,shear_rate_1/s,stress_Pa"], columns, ",", "\n", "a,").encode()


def schmid(c: Columns) -> bytes:
    """Write a flow curve below `%` lines."""
    head = ["%ID\tA\t", f"%Material\t{REMARK}\t", "%Shear rate\tShear stress\tViscosity"]
    head.append("%s^-1\tPa\tPa s")
    columns = [(c["rate"], ".5g"), (c["stress"], ".5g"), (c["viscosity"], ".5g")]
    return _rows(head, columns, "\t", "\r\n").encode()


FLOW = {
    "antonpaar": antonpaar, "flow_tab": flow_tab, "rheocompass": rheocompass,
    "rheodata": rheodata, "schmid": schmid,
}  # fmt: skip
