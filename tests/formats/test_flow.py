"""Flow curves of four makers and collections; the real files where they are at hand."""

from __future__ import annotations

import codecs
from pathlib import Path

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile

ANTON_PAAR = (
    "Shear Rate;Shear Stress;Viscosity;Torque\r\n[1/s];[Pa];[Pa\u00b7s];[\u00b5Nm]\r\n"
    "0,1;0,419;4,19;1,71\r\n0,126;0,539;4,28;2,2\r\n"
)
TAB = (
    "Point No.\tShear Rate [1/s]\tViscosity [mPa\u00b7s]\tTemperature [\u00b0C]\r\n"
    "1\t0.001\t55568\t22\r\n2\t0.00278\t49997\t22\r\n"
)
SCHMID = (
    "%ID\tA\t\tB\t\r\n%Material\tsynthetic\t\tsynthetic\t\r\n"
    "%Shear rate\tShear stress\tViscosity\tShear stress\tViscosity\r\n"
    "%s^-1\tPa\tPa s\tPa\tPa s\r\n0.1\t1\t10\t2\t20\r\n0.2\t1.8\t9\t3.6\t18\r\n"
)
RHEODATA = "sample_id,shear_rate_1/s,stress_Pa\na,0.1,1\na,1,5\nb,0.1,2\n"
COMPASS = (
    "Projekt:\tsynthetic\r\n\r\nAbschnitt und Datenpunkte:\t1\t2\r\n"
    "Abschnittsdaten:\tPunkt Nr.\tDatum\tZeit\tSchubspannung\tScherrate\r\n"
    "\t\tKonstanter Anteil\t\t\tKonstanter Anteil\r\n\t[]\t[]\t[s]\t[Pa]\t[1/s]\r\n"
    "\t1\t15.11.2022 11:08:33\t0,5\t30\t10\r\n\t2\t15.11.2022 11:08:33\t1\t20\t5\r\n"
)


def read(data: str | bytes) -> Recording:
    file = RawFile("x", data if isinstance(data, bytes) else data.encode())
    return detect(file).read(file)


def refused(data: str | bytes) -> str:
    with pytest.raises(RawFileError) as caught:
        read(data)
    return str(caught.value)


def utf16(text: str) -> bytes:
    return codecs.BOM_UTF16_LE + text.encode("utf-16-le")


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_anton_paar_with_decimal_commas_in_either_encoding(encoding: str) -> None:
    found = read(ANTON_PAAR.encode(encoding))
    assert found.source.reader == "antonpaar"
    assert found.columns["shear_rate_per_s"].tolist() == [0.1, 0.126]
    assert found.columns["viscosity_Pas"].tolist() == [4.19, 4.28]
    assert found.columns["torque_Nm"] == pytest.approx([1.71e-6, 2.2e-6])
    assert refused(ANTON_PAAR.replace("4,28", "4.28")) == (
        "x, line 4, column 3: a decimal point in a file with decimal commas (found '4.28'); "
        "export with one decimal mark"
    )


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "mac-roman"])
def test_tab_separated_labels_with_units_in_any_encoding(encoding: str) -> None:
    found = read(TAB.encode(encoding))
    assert found.source.reader == "flow_tab"
    assert found.columns["viscosity_Pas"] == pytest.approx([55.568, 49.997])
    assert found.columns["temperature_K"] == pytest.approx([295.15, 295.15])
    names = [flag.name for flag in found.flags]
    assert names == (["mac-roman"] if encoding == "mac-roman" else [])


@pytest.mark.parametrize(
    ("labels", "column", "label"),
    [
        ("Shear Rate\tViscosity", 1, "Shear Rate"),
        ("Shear Rate [1/s]\tViscosity", 2, "Viscosity"),
        ("Shear Rate\tViscosity [mPa.s]", 1, "Shear Rate"),
    ],
)
def test_a_unit_is_never_assumed(labels: str, column: int, label: str) -> None:
    assert refused(f"{labels}\n0.126\t4.28\n0.158\t4.31\n") == (
        f"x, line 1, column {column}: a column without a unit, neither over the column nor in the "
        f"header (found '{label}'); export the column with its unit, or leave it out"
    )


def test_samples_side_by_side_come_out_below_each_other() -> None:
    found = read(SCHMID)
    assert found.source.reader == "schmid"
    assert found.metadata["samples"] == "A; B"
    assert found.columns["sample"].tolist() == [0, 0, 1, 1]
    assert found.columns["shear_rate_per_s"].tolist() == [0.1, 0.2, 0.1, 0.2]
    assert found.columns["viscosity_Pas"].tolist() == [10, 9, 20, 18]
    assert found.columns["line"].tolist() == [5, 6, 5, 6]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "%s^-1\tPa\tPa s\tPa\tPa s",
            "%s^-1\tPa\tPa s\tPa\tPa",
            "x, line 4, column 5: a unit that does not stand for Pa.s (found 'Pa')",
        ),
        (
            "%ID\tA\t\tB",
            "%ID\tA\t\tA",
            "x, line 3: 2 different samples need as many pairs of columns (found '%Shear "
            "rate\\tShear stress\\tViscosity\\tShear stress\\tViscosity'); name every pair of "
            "columns once in the `%ID` line",
        ),
        ("\r\n0.1\t", "\r\n0\t", "x, line 5, column 1: a shear rate that is not positive"),
    ],
)
def test_a_bad_table_of_samples_is_refused(old: str, new: str, message: str) -> None:
    assert refused(SCHMID.replace(old, new)) == message


def test_rheodata_names_its_samples() -> None:
    found = read(RHEODATA)
    assert found.source.reader == "rheodata"
    assert found.metadata["samples"] == "a; b"
    assert found.columns["viscosity_Pas"].tolist() == [10, 5, 20]
    assert refused(RHEODATA.replace("a,1,", "a,-1,")) == (
        "x, line 3, column 2: a shear rate that is not positive (found '-1')"
    )
    assert refused(RHEODATA.replace("b,0.1,2", ",0.1,2")) == (
        "x, line 4, column 1: a row without its sample (found '')"
    )


def test_rheocompass_in_utf_16_with_three_header_rows() -> None:
    found = read(utf16(COMPASS))
    assert (found.source.reader, found.source.encoding) == ("rheocompass", "utf-16")
    assert found.columns["shear_rate_per_s"].tolist() == [10, 5]
    assert found.columns["viscosity_Pas"].tolist() == [3, 4]
    assert found.metadata["Datum"] == "15.11.2022 11:08:33"
    assert refused(utf16(COMPASS.replace("\t1\t2\r\n", "\t1\t3\r\n", 1))) == (
        "x, line 8: 2 rows where the header states 3 points; export the file again"
    )


@pytest.mark.shared
def test_every_real_flow_file_is_read(shared: Path) -> None:
    counts = {}
    for path in sorted((shared / "real" / "flow").glob("*/*")):
        if path.suffix != ".yaml":
            file = RawFile(path.name, path.read_bytes(), ends_open=True)
            if path.name == "rotation_ec07_data.csv":
                with pytest.raises(RawFileError, match="a column without a unit"):
                    detect(file).read(file)
                continue
            found = detect(file).read(file)
            counts[f"{path.parent.name}/{path.name}"] = len(found.columns["shear_rate_per_s"])
            if "shear_stress_Pa" in found.columns:  # the files' own redundancy
                stress = found.columns["viscosity_Pas"] * found.columns["shear_rate_per_s"]
                apart = stress / found.columns["shear_stress_Pa"] - 1.0
                assert np.abs(apart[found.columns["shear_stress_Pa"] != 0]).max() < 0.009
    assert counts == {
        "cement_rheocompass_utf16/SYS_0.55_250_1.csv": 2339,
        "ethylcellulose_flow_antonpaar/ec_shear_viscosity_02-00.csv": 43,
        "ethylcellulose_flow_antonpaar/ec_shear_viscosity_05-00.csv": 43,
        "ethylcellulose_flow_antonpaar/ec_shear_viscosity_07-00.csv": 43,
        "ethylcellulose_flow_antonpaar/ec_shear_viscosity_10-00.csv": 43,
        "glucose_flow_schmid/1_GlucoWheat_45.txt": 10,
        "glucose_flow_schmid/1_GlucoWheat_45_t.txt": 10,
        "glucose_flow_schmid/2_GlucoWheat_60.txt": 10,
        "glucose_flow_schmid/2_GlucoWheat_60_t.txt": 10,
        "pdms_flow_schmid/Results.txt": 114,
        "rheodata_caggioni_linear_polymer_flow/data.csv": 51,
        "rheodata_caggioni_pg_carbopol_2pct/data.csv": 61,
        "rheodata_dinkgreve2015_fig2/data.csv": 146,
    }
