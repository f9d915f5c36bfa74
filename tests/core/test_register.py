"""Registers: units in the header, uncertainty twins, and every slip by line and column."""

from __future__ import annotations

import pytest

from deamat.core.errors import RawFileError
from deamat.core.instruments import Gauge
from deamat.core.register import Register, RegisterForm, read_register

_PATH = "demo/compression/specimens.csv"
_GOOD = "specimen,material,file,diameter_mm,u_diameter_mm,height_mm,age,cup\na,m,f/a.csv,28,0.02,12,after cure,150 ml\n"


def _read(text: str) -> Register:
    gauges = {"height": Gauge(u_reading_m=3e-5, u_calibration_m=4e-5)}
    return read_register(
        text.encode(), _PATH, "demo", "compression", ("diameter_m", "height_m"), gauges
    )


def test_a_good_row() -> None:
    (specimen,) = _read(_GOOD).specimens
    assert specimen.file == "demo/compression/f/a.csv"
    assert specimen.numbers["diameter_m"].value == pytest.approx(0.028)
    assert specimen.numbers["diameter_m"].u_independent == pytest.approx(2e-5)
    assert specimen.numbers["height_m"].u_independent == 3e-5
    assert specimen.numbers["height_m"].u_shared == 4e-5
    assert specimen.conditions == {"age": "after cure"}
    assert specimen.notes == {"cup": "150 ml"}
    assert specimen.line == 2


def test_the_material_of_the_electrode_is_a_condition() -> None:
    (specimen,) = _read(_GOOD.replace("cup", "electrode").replace("150 ml", "graphite")).specimens
    assert specimen.conditions == {"age": "after cure", "electrode": "graphite"}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            ",28,",
            ",28.0x,",
            "demo/compression/specimens.csv, line 2, column 4: not a number (found '28.0x'); "
            "write it with a decimal point",
        ),
        (",28,", ",,", "demo/compression/specimens.csv, line 2, column 4: must not be empty (found '')"),
        (",28,", ",-28,", "demo/compression/specimens.csv, line 2, column 4: must be positive (found '-28')"),
        (
            ",150 ml",
            "",
            "demo/compression/specimens.csv, line 2, column 7: 7 fields where the header has 8",
        ),
        (
            "f/a.csv",
            "../a.csv",
            "demo/compression/specimens.csv, line 2, column 3: a file is named relative to its "
            "register's folder (found '../a.csv')",
        ),
    ],
)  # fmt: skip
def test_a_bad_row_is_named_and_the_rest_is_read(old: str, new: str, message: str) -> None:
    good = "b,m,f/b.csv,28,0.02,12,after cure,150 ml\n"
    register = _read(_GOOD.replace(old, new) + good)
    assert [s.id for s in register.specimens] == ["b"]
    assert [str(error) for _, error in register.errors] == [message]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("height_mm", "height_furlong", "line 1, column 6: a quantity without a known unit"),
        ("u_diameter_mm", "u_width_mm", "line 1, column 5: an uncertainty without its column"),
        ("height_mm", "height", "line 1, column 6: a quantity without a known unit"),
        ("material", "stuff", "line 1: no column 'material'"),
        ("cup", "age", "line 1, column 8: duplicate column: column 7 has the same name"),
        (
            "height_mm",
            "diameter_um",
            "line 1, column 6: duplicate column: column 4 is the same quantity",
        ),
        ("height_mm", "colour", "line 1: no column for height; add height_mm"),
    ],
)
def test_a_header_that_cannot_be_used(old: str, new: str, message: str) -> None:
    with pytest.raises(RawFileError) as caught:
        _read(_GOOD.replace(old, new, 1))
    assert message in str(caught.value)


def test_a_specimen_stands_once() -> None:
    register = _read(_GOOD + _GOOD.splitlines()[1] + "\n")
    assert "duplicate specimen: it is already in line 2" in str(register.errors[0][1])


def test_multi_word_units_and_temperatures() -> None:
    text = "specimen,material,diameter_mm,height_mm,speed_mm_per_min,temperature_C\na,m,1,1,12,22\n"
    (specimen,) = _read(text).specimens
    assert specimen.numbers["speed_m_per_s"].value == pytest.approx(2e-4)
    assert specimen.numbers["temperature_K"].value == pytest.approx(295.15)


@pytest.mark.parametrize("mu", ["\u00b5", "\u03bc"])
def test_either_letter_mu_is_a_unit(mu: str) -> None:
    text = f"specimen,material,thickness_{mu}m\na,m,300\n"
    register = read_register(text.encode(), "c/t/specimens.csv", "c", "t", ("thickness_m",), {})
    assert register.specimens[0].numbers["thickness_m"].value == pytest.approx(300e-6)


_LINES = RegisterForm(
    file="observations.csv",
    text=("material", "defect"),
    identity=("material", "batch", "bed_temperature_K", "time_s", "line"),
    conditions={"bed_temperature_K": "temperature_K"},
    whole=True,
)
_OBSERVED = "material,batch,bed_temperature_C,time_h,line,defect,limit\n"


def _observations(rows: str) -> Register:
    return read_register(
        (_OBSERVED + rows).encode(), "demo/handling/observations.csv", "demo", "handling",
        ("time_s",), {}, _LINES,
    )  # fmt: skip


def test_a_row_may_be_an_observation_named_by_its_cells() -> None:
    heated, plain = _observations("m,a,50,0,1,none,\nm,a,,1.5,3,gap,\n").specimens
    assert (heated.id, plain.id) == ("m a 50 0 1", "m a 1.5 3")
    assert heated.conditions == {"temperature_K": 323.15}
    assert plain.conditions == {}
    assert heated.numbers["time_s"].value == 0.0
    assert plain.numbers["time_s"].value == 5400.0
    assert heated.notes == {"batch": "a", "line": "1", "defect": "none"}


@pytest.mark.parametrize(
    ("row", "message"),
    [
        (
            "m,a,22,1o,2,none,",
            "line 3, column 4: not a number (found '1o'); write it with a decimal point",
        ),
        ("m,a,22,-1,2,none,", "line 3, column 4: must be positive (found '-1')"),
        ("m,a,22,1,2,,", "line 3, column 6: no defect (found '')"),
        (
            "m,a,22,0.5,1,gap,",
            "line 3, column 1: duplicate specimen: it is already in line 2 (found 'm a 22 0.5 1')",
        ),
    ],
)
def test_one_bad_row_spoils_a_register_whose_rows_hang_together(row: str, message: str) -> None:
    register = _observations(f"m,a,22,0.5,1,none,\n{row}\nm,a,22,2,4,gap,\n")
    assert register.specimens == ()
    assert [str(e) for _, e in register.errors] == [f"demo/handling/observations.csv, {message}"]


def test_a_note_may_begin_like_a_mass() -> None:
    (specimen,) = _read(_GOOD.replace("cup", "mass_flow")).specimens
    assert specimen.notes == {"mass_flow": "150 ml"}
    (specimen,) = _read(_GOOD.replace("cup", "mass_g").replace("150 ml", "100")).specimens
    assert specimen.numbers["mass_kg"].value == pytest.approx(0.1)


@pytest.mark.parametrize("cell", ["0", "0.0", "-12"])
@pytest.mark.parametrize(("column", "header"), [(4, "diameter_mm"), (5, "height_mm")])
def test_a_length_of_zero_or_less_is_named(column: int, header: str, cell: str) -> None:
    row = ["a", "m", "a.csv", "28", "12"]
    row[column - 1] = cell
    register = _read("specimen,material,file,diameter_mm,height_mm\n" + ",".join(row) + "\n")
    assert header == ["specimen", "material", "file", "diameter_mm", "height_mm"][column - 1]
    assert register.specimens == ()
    (error,) = (e for _, e in register.errors)
    assert (error.line, error.column, error.value) == (2, column, cell)
    assert error.reason == "must be positive"


def test_a_length_of_zero_is_a_slip_where_nobody_needs_it_too() -> None:
    rows = "a,m,28,12,0\nb,m,28,12,\nc,m,28,12,5\n"
    register = _read("specimen,material,diameter_mm,height_mm,thickness_um\n" + rows)
    assert [s.id for s in register.specimens] == ["b", "c"]
    assert [(e.line, e.column, e.reason) for _, e in register.errors] == [
        (2, 5, "must be positive")
    ]


@pytest.mark.parametrize(
    ("cell", "reason"),
    [
        ("1e300", "too large for a number"),
        ("9" * 400, "too large for a number"),
        ("1e-320", "too small for a number"),
        ("\u0661\u0662", "not a number"),
    ],
)
def test_a_number_that_nobody_measured(cell: str, reason: str) -> None:
    register = _read(_GOOD.replace(",28,", f",{cell},"))
    assert [(e.line, e.column, e.reason) for _, e in register.errors] == [(2, 4, reason)]


@pytest.mark.parametrize(
    ("old", "new", "column", "reason", "nearest"),
    [
        ("a,m,", "a,EF30/1:1 10% BT,", 2, "not '/'", "ef30-1-1-10-bt"),
        ("a,m,", "a,../../../../escaped,", 2, "not '/'", "escaped"),
        ("a,m,", "a,EF30,", 2, "lower-case letter or a digit", "ef30"),
        ("a,m,", f"a,{'m' * 300},", 2, "300 characters where 80", "m" * 80),
        ("a,m,", "../a,m,", 1, "must not be a path", "a"),
        ("a,m,", "a\u202e1,m,", 1, "RIGHT-TO-LEFT OVERRIDE", "a1"),
        ("after cure", "after\u00a0cure", 7, "NO-BREAK SPACE", "after cure"),
    ],
)
def test_a_name_that_breaks_its_rule_is_rejected_with_the_nearest(
    old: str, new: str, column: int, reason: str, nearest: str
) -> None:
    register = _read(_GOOD.replace(old, new, 1))
    (error,) = (e for _, e in register.errors)
    assert (error.path, error.line, error.column) == (_PATH, 2, column)
    assert reason in error.reason
    assert f"nearest valid: {nearest!r}" in str(error)
    assert len(str(error)) < 320


def test_names_that_differ_only_in_case_are_one_name() -> None:
    first, *rest = _GOOD.splitlines()[1:] * 4
    rows = [
        first,
        rest[0].replace("a,m,", "A,m,"),
        rest[1].replace("a,m,", "c,m-5K,"),
        rest[2].replace("a,m,", "d,m-5k,").replace("after cure", "After  cure"),
        first.replace("a,m,", "e,m,").replace("after cure", "After  cure"),
    ]
    register = _read("\n".join([_GOOD.splitlines()[0], *rows, ""]))
    assert [s.id for s in register.specimens] == ["a", "c"]
    assert [(e.line, e.column, e.reason) for _, e in register.errors] == [
        (3, 1, "duplicate specimen: it is already in line 2"),
        (5, 2, f"material is spelled differently: 'm-5K' in {_PATH}, line 4"),
        (6, 7, f"age is spelled differently: 'after cure' in {_PATH}, line 2"),
    ]


def test_a_field_that_is_too_long_for_csv_is_named() -> None:
    with pytest.raises(RawFileError, match="line 2: not CSV: field larger than field limit"):
        _read(_GOOD.replace("150 ml", "x" * 200_000))
