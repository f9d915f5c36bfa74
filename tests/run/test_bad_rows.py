"""Every bad row of a register is reported, whatever file it names."""

from __future__ import annotations

from pathlib import Path

from tests.run.test_observations import look

_HEADER = "specimen,material,file,diameter_mm,height_mm\n"
_REGISTER = "demo/compression/specimens.csv"


def _reasons(folder: Path, rows: str, *files: str) -> dict[str, list[str]]:
    """Look at a campaign with this register; give the reasons of each rejected file."""
    contents = {f"compression/{name}": name.encode() for name in files}
    seen = look(folder, {**contents, "compression/specimens.csv": (_HEADER + rows).encode()})
    return {
        path: entry.reason.removeprefix(f"{_REGISTER}, ").split(f"\n{_REGISTER}, ")
        for path, entry in seen.entries.items()
        if entry.status == "rejected"
    }


def test_bad_rows_without_a_file_are_all_named_at_the_register(tmp_path: Path) -> None:
    found = _reasons(tmp_path / "demo", "a,M,,28,12\nb,m,,0,12\nc,m,,28,12,x\n")
    assert found == {
        _REGISTER: [
            "line 2, column 2: an id starts with a lower-case letter or a digit (found 'M'); "
            "nearest valid: 'm'",
            "line 3, column 4: must be positive (found '0')",
            "line 4, column 6: 6 fields where the header has 5",
        ]
    }


def test_bad_rows_that_name_one_file_are_all_named_at_it(tmp_path: Path) -> None:
    found = _reasons(tmp_path / "demo", "a,m,x.csv,0,12\nb,m,x.csv,28,0\n", "x.csv")
    assert found == {
        "demo/compression/x.csv": [
            "line 2, column 4: must be positive (found '0')",
            "line 3, column 5: must be positive (found '0')",
        ]
    }


def test_a_bad_row_does_not_take_the_file_of_a_good_one(tmp_path: Path) -> None:
    rows = "a,m,x.csv,28,12\nb,m,x.csv,28,0\nc,m,x.csv,28,12\nd,m,x.csv,28,12\n"
    assert _reasons(tmp_path / "demo", rows, "x.csv") == {
        _REGISTER: [
            "line 3, column 5: must be positive (found '0')",
            "line 4: its file is that of a in line 2 already (found 'c')",
            "line 5: its file is that of a in line 2 already (found 'd')",
        ]
    }


def test_rows_that_name_one_missing_file_are_all_named(tmp_path: Path) -> None:
    (reasons,) = _reasons(tmp_path / "demo", "a,m,x.csv,28,12\nb,m,x.csv,28,12\n").values()
    assert reasons == [
        f"named in {_REGISTER}, line 2, but not there\nnamed in {_REGISTER}, line 3, but not there"
    ]
