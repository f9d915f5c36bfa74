"""Exports as many laboratories have them: other languages, separators, orders, instruments, units.

Each is one small physical run written under another heading; whatever stands above, the same
numbers come out. What may be read in two ways is refused.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile

N = 12
_i = np.arange(1.0, N + 1.0)
_w = 2.0 * np.pi * 10.0 * _i
_Z = 1.0 / (_w * 1.28e-10 * (0.004 + 1j))
SI: Mapping[str, np.ndarray] = {
    "time_s": 0.01 * _i, "displacement_m": 2e-5 * _i, "force_N": 0.006 * _i,
    "nominal_strain": 5e-4 * _i, "nominal_stress_Pa": 300.0 * _i, "depth_m": 3e-7 * (_i - 4.0),
    "shear_rate_per_s": 0.1 * _i, "shear_stress_Pa": 0.35 * _i, "viscosity_Pas": 3.5 + 0.0 * _i,
    "temperature_K": 298.15 + 0.0 * _i, "voltage_V": 125.0 * _i, "current_A": 2e-6 * _i,
    "frequency_Hz": 10.0 * _i, "parallel_capacitance_F": 1.28e-10 * _i / _i,
    "series_capacitance_F": 1.28e-10 * _i / _i, "loss_tangent": 0.004 * _i / _i,
    "series_resistance_ohm": _Z.real, "reactance_ohm": _Z.imag, "impedance_ohm": np.abs(_Z),
    "phase_rad": np.angle(_Z),
}  # fmt: skip
# what stands for a column below: the quantity, and how many of the unit written are one of SI
COLUMNS: Mapping[str, tuple[str, float]] = {
    "s": ("time_s", 1.0), "ms": ("time_s", 1e3), "min": ("time_s", 1 / 60),
    "mm": ("displacement_m", 1e3), "in": ("displacement_m", 1 / 0.0254),
    "N": ("force_N", 1.0), "kN": ("force_N", 1e-3), "mN": ("force_N", 1e3), "daN": ("force_N", 0.1),
    "lbf": ("force_N", 1 / 4.4482216152605), "kgf": ("force_N", 1 / 9.80665),
    "uN": ("force_N", 1e6), "%": ("nominal_strain", 100.0), "1": ("nominal_strain", 1.0),
    "MPa": ("nominal_stress_Pa", 1e-6), "kPa": ("nominal_stress_Pa", 1e-3),
    "nm": ("depth_m", 1e9), "um": ("depth_m", 1e6), "1/s": ("shear_rate_per_s", 1.0),
    "Pa": ("shear_stress_Pa", 1.0), "dyn/cm2": ("shear_stress_Pa", 10.0),
    "Pas": ("viscosity_Pas", 1.0), "mPas": ("viscosity_Pas", 1e3), "P": ("viscosity_Pas", 10.0),
    "V": ("voltage_V", 1.0), "kV": ("voltage_V", 1e-3), "uA": ("current_A", 1e6),
    "Hz": ("frequency_Hz", 1.0), "kHz": ("frequency_Hz", 1e-3),
    "rad/s": ("frequency_Hz", 2.0 * math.pi), "F": ("parallel_capacitance_F", 1.0),
    "pF": ("parallel_capacitance_F", 1e12), "Cs": ("series_capacitance_F", 1.0),
    "D": ("loss_tangent", 1.0), "R": ("series_resistance_ohm", 1.0), "X": ("reactance_ohm", 1.0),
    "-X": ("reactance_ohm", -1.0), "|Z|": ("impedance_ohm", 1.0),
    "deg": ("phase_rad", 180.0 / math.pi), "-deg": ("phase_rad", -180.0 / math.pi),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Export:
    """A heading and how the rows below it are written.

    Parameters
    ----------
    columns : names of `COLUMNS`, `#` for a running number; any other word stands in every row
    """

    technique: str
    head: str
    columns: str
    separator: str = ","
    decimal: str = "."
    quote: str = ""
    tail: str = ""
    encoding: str = "utf-8"

    @property
    def data(self) -> bytes:
        cells = [self._column(name) for name in self.columns.split(" ")]
        rows = "".join(
            self.separator.join(row) + self.tail + "\n" for row in zip(*cells, strict=True)
        )
        return (self.head + "\n" + rows).encode(self.encoding)

    def _column(self, name: str) -> Sequence[str]:
        if name == "#":
            return [str(n) for n in range(1, N + 1)]
        if name not in COLUMNS:
            return ["" if name == "." else name] * N
        quantity, factor = COLUMNS[name]
        written = [f"{value:.9g}" for value in (factor * SI[quantity]).tolist()]
        return [self.quote + text.replace(".", self.decimal) + self.quote for text in written]


_GERMAN: Mapping[str, str] = {"separator": ";", "decimal": ","}
PULLED: Sequence[tuple[str, str, Mapping[str, str]]] = (
    ("Tiempo (s),Extensión (mm),Carga (N),Número de ciclo", "s mm N #", {"encoding": "cp1252"}),
    ('"Total Time (s)";"Total Cycles";"Position(Linear:Digital Position) (mm)";"Load(Linear:Load) '
     '(kN)";', "s 1st mm kN", {**_GERMAN, "tail": ";"}),
    ("Reading\tLoad [lbF]\tTravel [in]\tTime [sec]\tStatus", "# lbf in s OK", {"separator": "\t"}),
    ("Reading,Load [kgF],Travel [mm],Time [sec.]", "# kgf mm s", {}),
    ("SetName,Cycle,Time,Size,Displacement,Force\n,,s,mm,mm,mN", "Hold # s 40 mm mN", {}),
    ("Time;Extension;Load;;;\n(s);(mm);(N);;;", "s mm N", {**_GERMAN, "tail": ";;;"}),
    (",Time,Extension,Load\n,(s),(mm),(N)", ". s mm N", {}),
    ("Segment\tDate/Time\tTime (s)\tForce (N)\tPosition (mm)", "1|Pull 06.01.2025 s N mm",
     {"separator": "\t"}),
    ("Tempo;Estensione;Carico\n(s);(mm);(N)", "s mm N", _GERMAN),
    ("Tiempo;Desplazamiento;Fuerza;Esfuerzo de tracción\n(s);(mm);(N);(MPa)", "s mm N MPa",
     {**_GERMAN, "encoding": "cp1252"}),
    ("Zeit\tVerlängerung\tKraft\n(s)\t(mm)\t(N)", "s mm N",
     {"separator": "\t", "decimal": ",", "encoding": "utf-16"}),
    ("Zeit;Druckverschiebung;Druckkraft\n(s);(mm);(N)", "s mm N", _GERMAN),
    ("Prüfzeit;Standardweg;Standardkraft;Dehnung\ns;mm;N;%", "s mm N %",
     {**_GERMAN, "encoding": "cp1252"}),
    ('"Prüfzeit"\t"Traversenweg absolut"\t"Standardkraft"\n"s"\t"mm"\t"N"', "s mm N",
     {"separator": "\t", "decimal": ",", "encoding": "cp1252"}),
    ("Temps d'essai;Course standard;Force standard\ns;mm;N", "s mm N", _GERMAN),
    ("Czas;Droga trawersy;Siła standardowa\ns;mm;N", "s mm N", {**_GERMAN, "encoding": "cp1250"}),
    ('"Czas","Przemieszczenie","Siła"\n"(s)","(mm)","(N)"', "s mm N", {"decimal": ",", "quote": '"'}),
    ("测试时间,标准行程,标准力\ns,mm,N", "s mm N", {"encoding": "gbk"}),
    ("时间(秒)\t位移(毫米)\t载荷(牛)", "s mm N", {"separator": "\t", "encoding": "gb18030"}),
    ("时间,试验力,行程\nsec,N,mm", "s N mm", {"encoding": "gbk"}),
    ("時間,伸び,荷重\n(s),(mm),(N)", "s mm N", {"encoding": "cp932"}),
    ('"時間","試験力","変位"\n"sec","N","mm"', "s N mm", {"quote": '"', "encoding": "utf-8-sig"}),
    ("時間,ひずみ,応力\nsec,%,MPa", "s % MPa", {"encoding": "cp932"}),
    ("Tempo;Deslocamento;Força\n(s);(mm);(N)", "s mm N", {**_GERMAN, "encoding": "cp1252"}),
    ("Tijd;Verplaatsing;Kracht\n(s);(mm);(N)", "s mm N", _GERMAN),
    ("시간,변위,하중\n(s),(mm),(N)", "s mm N", {}),
    ("Время;Перемещение;Нагрузка\n(с);(мм);(Н)", "s mm N", _GERMAN),
    ("Čas;Posunutí;Síla\ns;mm;N", "s mm N", {**_GERMAN, "encoding": "cp1250"}),
    ("Crosshead \tLoad \tTime \nin\tlbf\tsec", "in lbf s", {"separator": "\t"}),
    ("Time,Crosshead,Load,Extensometer\n(sec),(mm),(N),(mm/mm)", "s mm N 1", {}),
    ("Test Run Name: a\nDate: 1/6/2025\n\nDisplacement,Force,Time\nmm,N,sec", "mm N s", {}),
    ('"Test No.","1 _ 1"\n"Time","Force","Stroke"\n"sec","kgf","mm"', "s kgf mm", {"quote": '"'}),
    ("Load (N),Machine Extension (mm),Time (s)", "N mm s", {}),
    ("Tempo [s];Corsa [mm];Forza [daN]", "s mm daN", _GERMAN),
    ("Zeit [s];Weg [mm];Kraft [N];Spannung [MPa]", "s mm N MPa", _GERMAN),
    ("Time, s;Distance, mm;Load, N", "s mm N", {"separator": ";"}),
    ("Zeit Messung (s);Primäre Kraftmessung (N);Verlängerung (mm)", "s N mm", _GERMAN),
    ("Time (s),Displacement (mm),Force (N),Tensile displacement (mm)", "s mm N mm", {}),
    ("t/s,Weg/mm,F/N", "s mm N", {}),
    ("TIME (S),DISPLACEMENT (MM),FORCE (N)", "s mm N", {}),
    ("# made by a script\n#time_s\tdisplacement_mm\tforce_N", "s mm N", {"separator": "\t"}),
    ("sep=;\ntime_s;displacement_mm;force_N", "s mm N", {"separator": ";"}),
)  # fmt: skip
OTHERS: Sequence[tuple[str, str, str, Mapping[str, str]]] = (
    ("permittivity", "freq/Hz\tRe(Z)/Ohm\t-Im(Z)/Ohm\ttime/s", "Hz R -X s", {"separator": "\t"}),
    ("permittivity", "\tPt\tFreq\tZreal\tZimag\tIERange\n\t#\tHz\tohm\tohm\t#", ". # Hz R X #",
     {"separator": "\t", "decimal": ","}),
    ("permittivity", "Frequency (Hz);Z' (Ω);-Z'' (Ω);Z (Ω);-Phase (°)", "Hz R -X |Z| -deg",
     {"separator": ";"}),
    ("permittivity", '"HIOKI","IM3570"\n"No.","FREQ[Hz]","Z[ohm]","PHASE[deg]"', "# Hz |Z| deg", {}),
    ("permittivity", "FREQ[Hz],CS[F],D[]", "Hz Cs D", {}),
    ("permittivity", "Frequency\tCp\tD\nHz\tF\t", "Hz F D", {"separator": "\t"}),
    ("permittivity", "f (kHz);Cp (pF);tan δ", "kHz pF D", _GERMAN),
    ("permittivity", "Frequenz [Hz];Parallelkapazität [pF];Verlustfaktor", "Hz pF D",
     {**_GERMAN, "encoding": "cp1252"}),
    ("permittivity", "Angular frequency (rad/s),Cp (pF),tan(delta)", "rad/s pF D", {}),
    ("permittivity", "频率(Hz),Cp(F),损耗", "Hz F D", {"encoding": "gbk"}),
    ("permittivity", "No.,frequency_Hz,Cp_F,D,status", "# Hz F D OK", {}),
    ("viscosity", "[step]\nFließkurve - 1\nSpannung\tScherrate\tViskosität\nPa\t1/s\tPa.s",
     "Pa 1/s Pas", {"separator": "\t", "decimal": ","}),
    ("viscosity", "Messpkt.;Scherrate;Schubspannung;Viskosität;Drehmoment;Status\n"
     ";[1/s];[Pa];[Pa·s];[µNm];[]", "# 1/s Pa Pas # M-", {**_GERMAN, "encoding": "cp1252"}),
    ("viscosity", "SegIndex;t in s;GP in 1/s;Tau in Pa;Eta in mPas", "1|1 s 1/s Pa mPas", _GERMAN),
    ("viscosity", "Action Name\tTime (sample)(s)\tShear rate(s⁻¹)\tShear viscosity(Pa s)",
     "flow s 1/s Pas", {"separator": "\t"}),
    ("viscosity", "Viscosity (cP),% Torque (%),Shear Stress (D/cm²),Shear Rate (1/sec)",
     "mPas # dyn/cm2 1/s", {}),
    ("viscosity", "Shear Rate (1/s)\tShear Stress (dyne/cm2)\tViscosity (Poise)",
     "1/s dyn/cm2 P", {"separator": "\t"}),
    ("viscosity", "剪切速率,剪切应力,粘度\n[1/s],[Pa],[Pa·s]", "1/s Pa Pas", {"encoding": "gbk"}),
    ("viscosity", "せん断速度\tせん断応力\t粘度\n1/s\tPa\tmPa･s", "1/s Pa mPas",
     {"separator": "\t", "encoding": "cp932"}),
    ("viscosity", "time_min,rotor,speed_rpm,viscosity_mPas,torque_percent,operator",
     "min 3 30 mPas 50 me", {}),
    ("breakdown", "x-axis,2\nsecond,Volt", "s V", {}),
    ("breakdown", "Time,Channel A,Channel B\n(ms),(V),(mA)\n", "ms V #", {}),
    ("breakdown", "Zeit (s)\tHochspannung (kV)\tStrom (µA)", "s kV uA",
     {"separator": "\t", "decimal": ","}),
    ("breakdown", "time;U;I\ns;kV;uA", "s kV uA", _GERMAN),
    ("breakdown", "时间(s),电压(kV),电流(uA)", "s kV uA", {"encoding": "gbk"}),
    ("breakdown", "time_s,voltage_kV,current_uA,comment", "s kV uA start", {}),
    ("nanoindentation", "Measured values\nTime (s);Pd (µm);Fn (µN);SegmentID", "s um uN 1st",
     {**_GERMAN, "encoding": "cp1252"}),
    ("nanoindentation", "Time\tPd\tFn\ns\tnm\tmN", "s nm mN", {"separator": "\t"}),
    ("nanoindentation", "Displacement Into Surface,Load On Sample,Time On Sample\nnm,mN,s",
     "nm mN s", {}),
    ("nanoindentation", "Zeit [s];Eindringtiefe [nm];Kraft [µN]", "s nm uN",
     {**_GERMAN, "encoding": "cp1252"}),
)  # fmt: skip
EXPORTS = [
    *(Export("tension", head, columns, **how) for head, columns, how in PULLED),
    *(Export(technique, head, columns, **how) for technique, head, columns, how in OTHERS),
]


def read(data: bytes, technique: str) -> Recording:
    file = RawFile("x.csv", data, technique=technique)
    return detect(file).read(file)


@pytest.mark.parametrize("export", EXPORTS, ids=lambda e: f"{e.technique} {e.head[:40]}")
def test_the_same_run_comes_out_of_every_export(export: Export) -> None:
    recording = read(export.data, export.technique)
    wanted = {COLUMNS[name][0] for name in export.columns.split(" ") if name in COLUMNS}
    if export.technique == "tension" and "s" in export.columns.split(" "):
        assert "time_s" in recording.columns
    for name in wanted & recording.columns.keys():
        assert recording.columns[name] == pytest.approx(SI[name], rel=1e-6, abs=1e-15)
    assert any(
        wanted >= {*need} and recording.columns.keys() >= {*need}
        for need in NEEDS[export.technique]
    )


NEEDS = {
    "tension": (("displacement_m", "force_N"), ("nominal_strain", "nominal_stress_Pa")),
    "viscosity": (("shear_rate_per_s", "viscosity_Pas"), ("time_s", "viscosity_Pas")),
    "breakdown": (("time_s", "voltage_V"),),
    "nanoindentation": (("depth_m", "force_N"),),
    "permittivity": (
        ("frequency_Hz", "parallel_capacitance_F", "loss_tangent"),
        ("frequency_Hz", "series_capacitance_F", "loss_tangent"),
        ("frequency_Hz", "series_resistance_ohm", "reactance_ohm"),
        ("frequency_Hz", "impedance_ohm", "phase_rad"),
    ),
}

# quantity, technique, label, and the units in which it is written with how many are one of SI
_UNITS = (
    ("displacement_m", "tension", "Time (s),Load (N),Extension ({})",
     {"mm": 1e3, "inch": 1 / 0.0254, "in": 1 / 0.0254, "inches": 1 / 0.0254, "mil": 1 / 2.54e-5,
      "mils": 1 / 2.54e-5, "µm": 1e6, "micron": 1e6, "cm": 100.0, "㎜": 1e3, "MM": 1e3}),
    ("force_N", "tension", "Time (s),Extension (mm),Load ({})",
     {"lbf": 1 / 4.4482216152605, "lbF": 1 / 4.4482216152605, "kgf": 1 / 9.80665, "KN": 1e-3,
      "kp": 1 / 9.80665, "gf": 1 / 9.80665e-3, "ozf": 1 / 0.27801385095378125, "cN": 100.0,
      "daN": 0.1, "Newton": 1.0, "牛顿": 1.0, "mN": 1e3}),
    ("nominal_stress_Pa", "tension", "Time (s),Strain (%),Stress ({})",
     {"KPa": 1e-3, "kpa": 1e-3, "psi": 1 / 6894.757293168361, "ksi": 1 / 6894757.293168361,
      "Mpa": 1e-6, "N/mm²": 1e-6, "N/cm²": 1e-4, "kgf/cm2": 1 / 98066.5, "dyn/cm2": 10.0,
      "bar": 1e-5, "mbar": 1e-2, "lbf/in²": 1 / 6894.757293168361}),
    ("nominal_strain", "tension", "Time (s),Stress (kPa),Strain ({})",
     {"%": 100.0, "percent": 100.0, "mm/mm": 1.0, "in/in": 1.0}),
    ("viscosity_Pas", "viscosity", "No.;Shear rate (1/s);Viscosity ({})",
     {"cP": 1e3, "mPa s": 1e3, "mPa·s": 1e3, "mPa.s": 1e3, "mPas": 1e3, "Pa s": 1.0, "P": 10.0,
      "Poise": 10.0, "centipoise": 1e3, "N·s/m²": 1.0, "kPa s": 1e-3}),
    ("shear_stress_Pa", "viscosity", "No.;Shear rate (1/s);Shear stress ({})",
     {"dyn/cm2": 10.0, "dyne/cm²": 10.0, "D/cm²": 10.0, "mPa": 1e3, "N/m2": 1.0}),
    ("shear_rate_per_s", "viscosity", "No.;Viscosity (Pa s);Shear rate ({})",
     dict.fromkeys(("1/s", "s-1", "s^-1", "s⁻¹", "1/sec", "/s", "sec-1"), 1.0)),
    ("time_s", "viscosity", "No.;Viscosity (Pa s);Time ({})",
     {"sec.": 1.0, "Sek.": 1.0, "S": 1.0, "min": 1 / 60, "hr": 1 / 3600, "ms": 1e3}),
    ("voltage_V", "breakdown", "No.;Time (s);Voltage ({})", {"kV": 1e-3, "KV": 1e-3, "mV": 1e3}),
    ("parallel_capacitance_F", "permittivity", "D;Frequency (Hz);Cp ({})",
     {"pF": 1e12, "nF": 1e9, "µF": 1e6}),
)  # fmt: skip


def _rows(head: str, last: Sequence[float]) -> bytes:
    mark = ";" if ";" in head else ","
    return (
        head + "\n" + "".join(f"{n}{mark}{n}{mark}{x!r}\n" for n, x in enumerate(last, 1))
    ).encode()


@pytest.mark.parametrize(
    ("quantity", "technique", "head", "unit", "factor"),
    [(q, t, head, unit, f) for q, t, head, units in _UNITS for unit, f in units.items()],
)
def test_units_as_instruments_write_them_end_to_end(
    quantity: str, technique: str, head: str, unit: str, factor: float
) -> None:
    column = read(_rows(head.format(unit), [factor * n for n in range(1, 9)]), technique)
    assert column.columns[quantity] == pytest.approx(np.arange(1.0, 9.0))


@pytest.mark.parametrize(
    ("unit", "degrees"), [("°C", 25), ("℃", 25), ("°F", 77), ("degF", 77), ("F", 77)]
)
def test_temperatures(unit: str, degrees: float) -> None:
    data = _rows(f"Time (s);Viscosity (Pa s);Temperature ({unit})", [degrees] * 8)
    assert read(data, "viscosity").columns["temperature_K"] == pytest.approx(np.full(8, 298.15))


@pytest.mark.parametrize(
    ("technique", "head", "reason"),
    [
        ("tension", "Time (s),Extension (mm),Load (lb)", "may be lbf (a force) or kg (a mass)"),
        ("tension", "Time (s),Extension (mm),Load (oz)", "may be ozf (a force) or kg (a mass)"),
        ("tension", "Time (s),Extension (mm),Load (kg)", "write kgf if a force is meant"),
        ("tension", "Time (s),Strain (%),Stress (MPA)", "may be mPa or MPa"),
        ("viscosity", "No.;Time (s);Viscosity (cps)", "may be cP (centipoise) or 1/s"),
        ("viscosity", "No.;Viscosity (Pa s);Shear rate (rpm)", "which is no unit of shear rate"),
        ("breakdown", "Time (s),CH1 (V),CH2 (V)", "which column is the voltage? CH1 [V], CH2 [V]"),
        ("permittivity", "Freq (Hz),|Y| (ohm),Phase(Y) (deg)", "no column is the impedance"),
    ],
)  # fmt: skip
def test_what_may_be_two_things_is_refused_with_the_choices(
    technique: str, head: str, reason: str
) -> None:
    with pytest.raises(RawFileError) as caught:
        read(_rows(head, [1.0 * n for n in range(1, 9)]), technique)
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("decimal", "cells", "values"),
    [
        (",", ("0,5", "1\N{NO-BREAK SPACE}234,5"), (0.5, 1234.5)),
        (",", ("0,5", "1\N{NARROW NO-BREAK SPACE}234"), (0.5, 1234.0)),
        (",", ("2.345,5", "1,5"), (2345.5, 1.5)),
        (".", ("0.5", "1'234.5"), (0.5, 1234.5)),
        (".", ("0.5", "1 234 567"), (0.5, 1234567.0)),
        (".", ("2,345", "1,234.5"), (2345.0, 1234.5)),
        (".", ("1,234.5", "0.5"), (1234.5, 0.5)),
    ],
)
def test_thousands_that_prove_themselves(
    decimal: str, cells: Sequence[str], values: Sequence[float]
) -> None:
    rows = "".join(f"{n};0{decimal}{n};{cell}\n" for n, cell in enumerate(cells))
    recording = read(("Time (s);Extension (mm);Load (N)\n" + rows).encode(), "tension")
    assert recording.columns["force_N"].tolist() == list(values)


@pytest.mark.parametrize("cell", ["1 234", "1,234", "1'234"])
def test_a_lone_group_among_fractions_may_be_a_damaged_point(cell: str) -> None:
    rows = "".join(f"{n};0.{n};{1.25 + n:.3f}\n" for n in range(6)).replace("3.250", cell)
    with pytest.raises(RawFileError, match="line 4, column 3"):
        read(("Time (s);Extension (mm);Load (N)\n" + rows).encode(), "tension")
