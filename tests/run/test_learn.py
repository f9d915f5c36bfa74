"""`deamat learn`: an entry proposed from a sample, questions for the rest, and what it makes stale."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from deamat.commands.learn import learn
from deamat.core.errors import ConfigError
from deamat.formats.exports import load_exports
from deamat.formats.rawfile import RawFile
from deamat.materials.database import open_database
from deamat.materials.trace import trace
from deamat.run import explain
from deamat.run.folders import Folders
from deamat.run.learn import Answers, propose
from deamat.run.register import register
from tests.formats.workbooks import Rows, xlsx
from tests.run.conftest import curves, folders, quick_figures, run

__all__ = ["folders", "quick_figures"]

UNITS_MISSING = "Zeit;Kraft;Weg\n0,1;0,2;0,3\n0,2;0,3;0,4\n0,3;0,5;0,5\n"
RAMP = "Scope\nx\tCH1\tCH2\n0.0\t0.00\t1\n0.5\t0.25\t1\n1.0\t0.50\t1\n"
HEADLESS = "RIG 7\n\n1.0 2.0\n2.0 3.0\n3.0 5.0\n"
NOTHING = Answers()
RAMP_ANSWERS = (
    "--technique", "breakdown", "--column", "x=time_s:s", "--column", "CH1=voltage_V:V",
    "--factor", "CH1=2000",
)  # fmt: skip


def put(folder: Path, name: str, content: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_bytes(content.encode())
    return path


def teach(path: Path, *words: str) -> Result:
    config = path.parent / "config"
    config.mkdir(exist_ok=True)
    return CliRunner().invoke(learn, [str(path), "--config", str(config), *words])


def asked(content: str, answers: Answers = NOTHING) -> list[str]:
    return [q.flag for q in propose(RawFile("x", content.encode()), answers).questions]


def test_what_a_sample_does_not_say_is_asked_with_the_option_that_says_it(tmp_path: Path) -> None:
    done = teach(put(tmp_path, "a.csv", UNITS_MISSING))
    assert done.exit_code == 1
    assert (
        "in which unit is 'Kraft', the force?\n      --column 'Kraft=force_N:UNIT'" in done.output
    )
    done = teach(put(tmp_path, "b.txt", RAMP))
    assert "for which technique is it?" in done.output


def test_an_answered_sample_becomes_a_form_that_reads_it(tmp_path: Path) -> None:
    done = teach(put(tmp_path, "b.txt", RAMP), *RAMP_ANSWERS, "--write", "--title", "Scope")
    assert done.exit_code == 0, done.output
    assert "# voltage_V: 3 values from 0 to 1000" in done.output
    (export,) = load_exports(tmp_path / "config")
    assert export.name == "b"
    assert [c.quantity for c in export.form.columns] == ["time_s", "voltage_V"]
    assert export.form.columns[1].factor == 2000.0
    again = teach(tmp_path / "b.txt", *RAMP_ANSWERS, "--write")
    assert again.exception is not None
    assert "has a form b already" in str(again.exception)
    assert teach(tmp_path / "b.txt", *RAMP_ANSWERS, "--write", "--name", "c").exit_code == 0
    assert [e.name for e in load_exports(tmp_path / "config")] == ["b", "c"]


def test_nothing_is_written_unasked(tmp_path: Path) -> None:
    assert teach(put(tmp_path, "b.txt", RAMP), *RAMP_ANSWERS).exit_code == 0
    assert list((tmp_path / "config").iterdir()) == []


def test_rows_without_labels_are_columns_by_number(tmp_path: Path) -> None:
    done = teach(
        put(tmp_path, "h.txt", HEADLESS), "--technique", "tension", "--column",
        "#1=displacement_m:mm", "--column", "#2=force_N:N",
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    assert 'starts_with = "RIG 7"\nfirst_line = 3\n' in done.output
    assert 'separator = "blanks"' in done.output
    assert "# force_N: 3 values from 2 to 5" in done.output


def test_labels_and_units_that_are_known_need_no_question() -> None:
    proposal = propose(RawFile("x", b"Zeit;Kraft;Weg\ns;N;mm\n1;2;3\n2;3;4\n"), Answers())
    assert proposal.questions == ()
    assert proposal.techniques == ("compression", "tension")
    assert set(proposal.columns) == {
        ("Weg", "displacement_m", "mm"), ("Kraft", "force_N", "N"), ("Zeit", "time_s", "s"),
    }  # fmt: skip


def test_a_question_shows_the_first_value_of_each_column() -> None:
    first, *_ = propose(RawFile("x", RAMP.encode()), Answers("breakdown")).questions
    assert "? x (0.0), CH1 (0.00), CH2 (1)" in first.text


def test_between_commas_the_decimal_mark_is_a_point() -> None:
    proposal = propose(RawFile("x", b"Kraft (N),Weg (mm)\n1.5,2\n2,3\n"), NOTHING)
    assert proposal.questions == ()
    assert proposal.decimal == "."


def test_a_comma_that_may_part_thousands_is_asked_for() -> None:
    text = "Kraft (N);Weg (mm)\n1,000;2,000\n2,000;3,000\n"
    assert asked(text) == ["--decimal , (or .)"]
    assert asked(text, Answers(decimal=",")) == []


def test_a_sample_that_may_be_cut_is_asked_for() -> None:
    text = "Kraft (N);Weg (mm)\n1;2\n2;3"
    assert asked(text) == ["--ends-open"]
    assert asked(text, Answers(ends_open=True)) == []


def test_a_sampling_interval_stands_for_a_column_of_time() -> None:
    text = "CH1 (V)\tCH2\n0\t1\n1\t2\n2\t3\n"
    known = Answers("breakdown", columns={"CH1 (V)": ("voltage_V", "V")})
    assert asked(text, known) == ["--column 'LABEL=time_s:UNIT' (or --interval SECONDS)"]
    assert asked(text, replace(known, sampling_interval_s=0.1)) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--technique", "tensoin"), "no technique reads tables as 'tensoin'"),
        (("--column", "CH9=voltage_V:V"), "has no column 'CH9'; x, CH1, CH2"),
        ((*RAMP_ANSWERS, "--name", "Bad Name"), "a name is made of a to z"),
        ((*RAMP_ANSWERS, "--name", "bluehill"), "bluehill is a form of the program"),
    ],
)
def test_an_answer_that_does_not_fit_is_refused(
    tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    done = teach(put(tmp_path, "b.txt", RAMP), *words)
    assert isinstance(done.exception, ConfigError)
    assert said in str(done.exception)


def test_a_file_without_numbers_has_no_form(tmp_path: Path) -> None:
    done = teach(put(tmp_path, "b.txt", "hello\n"))
    assert "it holds no rows of numbers" in str(done.exception)


OWN = """
[rig-7]
title = "Rig 7"
techniques = ["compression"]
separator = "tab"
columns = [
    { label = "CH1", quantity = "force_N", unit = "N" },
    { label = "CH2", quantity = "displacement_m", unit = "mm" },
]
"""


def own_form(folders: Folders) -> None:
    """Rewrite the campaign's curves as a rig writes them that nobody knows."""
    for path in curves(folders):
        rows = path.read_text().split("\n")[5:]
        path.write_text("Rig 7\nn\tCH1\tCH2\tCH3\n" + "\n".join(rows))
    register(folders.raw, "demo", accept_all=True)


def done_again(folders: Folders) -> set[str]:
    return {line.partition(" ")[0] for line in run(folders)["redone"]}


@pytest.mark.usefixtures("quick_figures")
def test_a_changed_entry_makes_its_files_stale_and_stands_on_the_trace(folders: Folders) -> None:
    before = run(folders)
    own_form(folders)
    assert run(folders)["exit_code"] == 1
    (folders.config / "exports.toml").write_text(OWN)
    after = run(folders)
    assert after["exit_code"] == 0, after
    assert {line.partition(" ")[0] for line in after["redone"]} >= {"measurement", "summary"}
    with open_database(folders.processed) as database:
        said = trace(database, "sylgard-182-10to1", "compressive_modulus").text()
    (export,) = load_exports(folders.config)
    assert f"rig-7 (config/exports.toml, version {export.version})" in said
    (folders.config / "exports.toml").write_text(OWN.replace("Rig 7", "Rig 8"))
    assert "measurement" not in done_again(folders)
    (folders.config / "exports.toml").write_text(OWN.replace('"mm" }', '"mm", factor = 1.01 }'))
    assert any("config/exports.toml changed" in line for line in explain(folders)["now"])
    assert "measurement" in done_again(folders)
    assert before["exit_code"] == 0


def test_an_entry_that_does_not_hold_stops_the_run(folders: Folders) -> None:
    (folders.config / "exports.toml").write_text(OWN.replace("force_N", "farce_N"))
    with pytest.raises(ConfigError, match=r"line 7: .*no quantity is called 'farce_N'"):
        run(folders)


def test_a_workbook_is_learned_too(tmp_path: Path) -> None:
    rows: Rows = [["Rig 7"], ["n", "CH1", "CH2"], [1.0, 0.5, 0.1], [2.0, 1.0, 0.2], [3.0, 1.5, 0.3]]
    path = tmp_path / "rig.xlsx"
    path.write_bytes(xlsx({"Data": rows}))
    done = teach(path, "--technique", "tension", "--column", "CH1=force_N:N", "--column",
                 "CH2=displacement_m:mm", "--write")  # fmt: skip
    assert done.exit_code == 0, done.output
    assert 'separator = "workbook"\ncolumns' in done.output
    assert "# force_N: 3 values from 0.5 to 1.5" in done.output
    assert load_exports(tmp_path / "config")[0].form.separator == "workbook"


def test_a_text_in_no_encoding_is_refused() -> None:
    with pytest.raises(ConfigError, match="in no encoding that is known"):
        propose(RawFile("x", b"Kraft\x81\xff;Weg\n1;2\n\xff\xff\x81\n"), Answers())
