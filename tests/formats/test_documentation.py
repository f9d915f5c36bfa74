"""What a README says of units, against what stands over the columns."""

from __future__ import annotations

from deamat.formats.documentation import contradictions, stated_units


def test_statements_are_read_from_lists_and_lines() -> None:
    text = """
- Time
- Compression (mm)
* Load [N]: compressive force
Engineering stress (N/mm^2)
**True stress** (MPa), derived
- Measured at Queen Mary (London)
- Engineering strain (-)
The load (in N) was recorded (kN).
"""
    assert stated_units(text) == {
        "Compression": "mm",
        "Load": "N",
        "Engineering stress": "N/mm^2",
        "True stress": "MPa",
        "Engineering strain": "-",
    }


def test_of_two_statements_the_first_counts() -> None:
    assert stated_units("Load (N)\nLoad (kN)\n") == {"Load": "N"}


def test_contradictions_name_both_units_whatever_the_case_of_the_label() -> None:
    stated = {"Engineering stress": "N/mm^2", "Load": "kN", "Strain": "%"}
    written = {"Engineering Stress": "kPa", "LOAD": "kN", "Time": "s", "Strain": ""}
    (flag,) = contradictions(stated, written)
    assert str(flag) == (
        "unit-contradiction: Engineering Stress: the README says N/mm^2, the column says kPa; "
        "the column was used"
    )


def test_two_spellings_of_one_unit_do_not_contradict_each_other() -> None:
    assert contradictions({"Stress": "N/mm^2"}, {"Stress": "MPa"}) == ()
    assert contradictions({"Load": "uN"}, {"Load": "µN"}) == ()


def test_an_unknown_unit_over_a_column_contradicts_a_known_one() -> None:
    assert len(contradictions({"Load": "N"}, {"Load": "div"})) == 1
    assert contradictions({"Load": "div"}, {"Load": "div"}) == ()
