"""Indenters of other makers: tables and workbooks that their own labels make readable."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from tests.formats.workbooks import Rows, xlsx

CHIARO = (
    "Date\t06/01/2025\r\nTip radius (um)\t100.000\r\nk (N/m)\t4.350\r\n"
    "Piezo Indentation Sweep Settings\r\n\r\n"
    "Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary\r\n"
    "0.0\t0.0\t-20.0\t0.0\t-20.0\t0.0\r\n0.1\t1.5\t30.0\t5.0\t35.0\t0.0\r\n"
    "0.2\t3.5\t80.0\t9.0\t89.0\t0.0\r\n"
)
KLA_LABELS = [
    "Displacement Into Surface",
    "Load On Sample",
    "Time On Sample",
    "Raw Load",
    "Hardness",
]
KLA_UNITS = ["nm", "mN", "s", "mN", "GPa"]


def read(data: bytes, place: str = "") -> Recording:
    file = RawFile("c/x", data, technique="nanoindentation", place=place)
    return detect(file).read(file)


def kla(sheets: int) -> bytes:
    """A workbook with one sheet for each indent, as a KLA Nano Indenter exports it."""
    indent: Rows = [KLA_LABELS, KLA_UNITS, [0.0, 0.0, 0.0, 0.1, None], [100.0, 0.5, 1.0, 0.6, 1.0],
              [200.0, 1.5, 2.0, 1.6, 1.0]]  # fmt: skip
    tests = {f"Test {number:03}": indent for number in range(1, sheets + 1)}
    return xlsx({"Results": [["Test", "Modulus", "Hardness"]], **tests})


@pytest.mark.parametrize(
    "text", [CHIARO, CHIARO.replace(".", ","), CHIARO.replace("\tAuxiliary", "")]
)
def test_optics11_with_points_commas_and_without_its_last_column(text: str) -> None:
    if "Auxiliary" not in text:
        text = text.replace("\t0.0\r\n", "\r\n")
    columns = read(text.encode()).columns
    assert columns["depth_m"].tolist() == pytest.approx([-20e-9, 30e-9, 80e-9])
    assert columns["force_N"].tolist() == pytest.approx([0.0, 1.5e-6, 3.5e-6])


def test_kla_depth_and_load_on_the_sample() -> None:
    recording = read(kla(1))
    assert np.allclose(recording.columns["depth_m"], [0.0, 1e-7, 2e-7])
    assert np.allclose(recording.columns["force_N"], [0.0, 5e-4, 1.5e-3])
    assert np.allclose(recording.columns["time_s"], [0.0, 1.0, 2.0])


def test_kla_indents_are_named_by_their_sheet() -> None:
    with pytest.raises(RawFileError, match="several tables: sheets Test 001, Test 002"):
        read(kla(2))
    assert read(kla(2), "Test 002").metadata["sheet"] == "Test 002"
