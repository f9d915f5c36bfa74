"""Sweeps of meters and analysers as plain tables: every pair is the same film, traps included."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.instruments import LcrAccuracy
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.spectrum import spectrum_of

F = np.array([1e5, 1e4, 1e3, 100.0, 30.0, 10.0])
C, D = 120e-12, 0.004
W = 2.0 * math.pi * F
COLUMNS = {
    "Cp (pF)": np.full(6, 1e12 * C),
    "Cs (pF)": np.full(6, 1e12 * C * (1.0 + D * D)),
    "D": np.full(6, D),
    "Q": np.full(6, 1.0 / D),
    "G (uS)": 1e6 * W * C * D,
    "B (uS)": 1e6 * W * C,
    "Re(Z)/Ohm": D / (W * C * (1.0 + D * D)),
    "-Im(Z)/Ohm": 1.0 / (W * C * (1.0 + D * D)),
}
PAIRS = (
    ("Cp (pF)", "D"), ("Cp (pF)", "Q"), ("Cs (pF)", "Q"), ("Cp (pF)", "G (uS)"),
    ("G (uS)", "B (uS)"), ("Re(Z)/Ohm", "-Im(Z)/Ohm"),
)  # fmt: skip
# the form of EC-Lab's text: files of the public repository echemdata/galvani name it
MPT = "EC-Lab ASCII FILE\r\nNb header lines : 6\r\n\r\nVa (mV)             10,0\r\n\r\n"


def read(data: bytes) -> Recording:
    file = RawFile("c/permittivity/x.txt", data, technique="permittivity")
    return detect(file).read(file)


def film(recording: Recording) -> tuple[float, float]:
    """Capacitance and loss of a recording at its lowest frequency."""
    spectrum = spectrum_of(recording, 1.0, LcrAccuracy(), PermittivityConfig())
    return float(spectrum.capacitance_F.real[0]), float(spectrum.loss[0])


@pytest.mark.parametrize("labels", PAIRS)
def test_every_pair_is_the_same_film(labels: tuple[str, str]) -> None:
    head = "\t".join(("Frequency (Hz)", *labels))
    rows = [(f, *(COLUMNS[label][at] for label in labels)) for at, f in enumerate(F)]
    text = head + "\n" + "".join("\t".join(f"{v:.9e}" for v in row) + "\n" for row in rows)
    assert film(read(text.encode())) == pytest.approx((C, D), rel=1e-6)


@pytest.mark.parametrize("decimal", [".", ","])
def test_biologic_text_with_points_and_commas(decimal: str) -> None:
    labels = "freq/Hz\tRe(Z)/Ohm\t-Im(Z)/Ohm\t|Z|/Ohm\tPhase(Z)/deg\tCp/\u00b5F\tcycle number\t\r\n"
    rows = "".join(
        f"{f:.6E}\t{COLUMNS['Re(Z)/Ohm'][at]:.6E}\t{COLUMNS['-Im(Z)/Ohm'][at]:.6E}\t1.0\t-89.8\t1E-4"
        "\t1\t\r\n"
        for at, f in enumerate(F)
    ).replace(".", decimal)
    recording = read((MPT + labels + rows).encode("latin-1"))
    assert film(recording) == pytest.approx((C, D), rel=1e-4)
    assert recording.source.first_line == 7


def test_a_time_in_capital_s_is_no_siemens() -> None:
    text = "Time (S);Load (N);Extension (mm);Note\n0;1;2;a\n1;2;3;b\n"
    file = RawFile("x", text.encode(), technique="tension")
    assert detect(file).read(file).columns["time_s"].tolist() == [0.0, 1.0]
