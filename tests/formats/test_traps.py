"""Every trap that `../shared/instruments.md` names: read right, or rejected by name and place.

One row per trap, in the order of the notes: their words, the file that carries it, what must come
out. Viscometer, LCR meter and ramp stand in `traps_of_instruments.py`; the builders of the files in
`trap_files.py`.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

from deamat.core.errors import RawFileError
from deamat.run.folders import Folders
from deamat.run.register import register
from tests.formats.samples import BY_NAME
from tests.formats.trap_files import (
    CYLINDER,
    ELAPSED,
    HOURS,
    STAMPED,
    STRIP,
    VISCOSITIES,
    Trap,
    autumn,
    compression,
    elapsed,
    log,
    pulled,
    reading,
    viscosity,
)
from tests.formats.traps_of_instruments import METER, RAMP, VISCOMETER
from tests.run.conftest import ROOT, TWIN, run

MODULUS = {"compressive_modulus": 1e6}
SOFT = "Time (s);Load (N);Displacement ({})\n0.0;1.0;0.1\n0.5;1.5;0.2\n"


def _as_it_is(said: str, sample: str, *columns: str, flags: tuple[str, ...] = ()) -> Trap:
    """Read the small good file of a format, whose numbers are known by heart."""
    good = BY_NAME[sample]
    values = good.columns()
    return Trap(
        said, f"tests/data/formats/{good.file}", good.data,
        columns={name: values[name].tolist() for name in columns or values}, flags=flags,
    )  # fmt: skip


MACHINES = (
    _as_it_is(
        "Instron-type CSV: optional `key,\"value\",unit` header, blank line, names row, units row "
        "`(s),(mm),(N)`, quoted numbers, THOUSANDS COMMAS `\"242,370.29658\"`.", "bluehill",
    ),
    Trap("Compression may be signed either way", "positive", compression(), "compression", CYLINDER,
         values=MODULUS),
    Trap("Compression may be signed either way", "negative", compression(-1.0), "compression",
         CYLINDER, values=MODULUS),
    Trap(
        "preload not zeroed", "5 N before contact", compression(offset_N=5.0), "compression",
        CYLINDER, values=MODULUS,
        flags=("preload: the line meets zero strain at 15.9 kPa",),
    ),
    Trap(
        "header says N/mm2 while columns are kPa", "a header that contradicts the column",
        "ef\nEngineering stress (N/mm2);\nTime (s),Load (N),Engineering Stress (kPa)\n0.1,2,1.5\n",
        columns={"nominal_stress_Pa": [1500]},
        flags=("unit-contradiction: Engineering Stress: the header says N/mm2, the column says "
               "kPa; the column was used",),
    ),
    _as_it_is("strain and stress negative, load positive; `-0.000000`.", "phantom"),
    _as_it_is(
        "semicolon, 18 header lines with differing labels, engineering and true columns", "soro"
    ),
    Trap(
        "2.3 % strain per sample.", "no second sample below 1 %", pulled(), "tension", STRIP,
        values={"tensile_strength": 5e5},
        refused="1 sample in the window of 0-1 % strain, 5 are needed",
    ),
    _as_it_is(
        "CRLF, timestamp, `Units: N`, `X-Axis: Travel`, `Travel Unit: mm`, tab-separated `Reading "
        "Load Travel Time`.", "mark10",
    ),
    _as_it_is("Nexygen: UTF-16 tab `Load (N)`, `Machine Extension (mm)`.", "nexygen"),
    _as_it_is(
        "`\"label\",value,\"unit\"` lines of varying number, exponents `1.46e-007`, trailing zeros "
        "after break", "zwick", flags=("trailing-zeros: specimen_width_m is exactly 0 in the last 2 "
                                       "rows, from line 14",),
    ),
    Trap(
        "truncated last line.", "a Zwick export cut in its last row",
        BY_NAME["zwick"].data.rpartition(b",")[0], rejected="x, line 15, column 2: too few "
        "fields: 2 where the header names 3; the file seems cut",
    ),
    _as_it_is("MTS: BOM, CRLF, tab, decimal comma, load in kN.", "mts"),
    _as_it_is(
        "ISO-8859-1, date, `Number of Points = 5304`, `Depth (nm)<TAB>Load (uN)<TAB>Time (s)<TAB>"
        "Depth (V)<TAB>Load (V)`; negative depths before contact.", "hysitron",
    ),
    Trap(
        "toe compensation by tangent to zero stress.", "0.1 mm before contact",
        compression(gap_mm=0.1), "compression", CYLINDER,
        values={"compressive_modulus_toe_compensated": 1e6}, flags=("contact: slope 0 kPa up to 1 %",),
    ),
)  # fmt: skip

SEEN = (
    Trap("Decimal comma with `;`", "Anton Paar",
         "Shear Rate;Shear Stress;Viscosity\n[1/s];[Pa];[Pa·s]\n0,1;0,419;4,19\n",
         columns={"shear_rate_per_s": [0.1], "viscosity_Pas": [4.19]}),
    _as_it_is("or tab", "mts"),
    _as_it_is("UTF-16LE BOM", "nexygen"),
    _as_it_is("latin-1", "hysitron"),
    Trap("cp949", "a remark of two bytes a letter", ("Specimen;표본;\n;;\n" + SOFT.format("mm")).encode("cp949"),
         columns={"force_N": [1, 1.5], "displacement_m": [1e-4, 2e-4]}),
    Trap("cp949", "a unit of two bytes a letter", SOFT.format("μm").encode("cp949"),
         rejected="x, line 1, column 3: 'Displacement': unknown unit"),
    Trap("GBK", "a remark of two bytes a letter", ("Specimen;样品;\n;;\n" + SOFT.format("mm")).encode("gbk"),
         columns={"force_N": [1, 1.5], "displacement_m": [1e-4, 2e-4]}),
    Trap("GBK", "a label of two bytes a letter",
         SOFT.format("mm").replace("Load", "载荷").encode("gbk"),
         columns={"force_N": [1, 1.5], "displacement_m": [1e-4, 2e-4]}),
    _as_it_is("utf-8-sig", "mts"),
    Trap("unit row under the header", "an LCR table", "frequency,Cp,D\nHz,pF,1\n10,158.2,0.0012\n",
         columns={"parallel_capacitance_F": [158.2e-12]}),
    Trap(
        "three-row headers", "RheoCompass: labels, remarks, units",
        ("Projekt:\tsynthetic\r\nAbschnittsdaten:\tPunkt Nr.\tZeit\tSchubspannung\tScherrate\r\n"
         "\t\t\t\tKonstanter Anteil\r\n\t[]\t[s]\t[Pa]\t[1/s]\r\n\t1\t0,5\t30\t10\r\n").encode("utf-16"),
        columns={"shear_rate_per_s": [10], "viscosity_Pas": [3]},
    ),
    Trap("translated names", "German names and bare units",
         "Zeit\tStandardweg\tStandardkraft\ns\tmm\tN\n0,0\t0,0\t1,0\n0,1\t0,2\t1,5\n",
         columns={"time_s": [0, 0.1], "displacement_m": [0, 2e-4], "force_N": [1, 1.5]}),
    Trap("dd.mm.yyyy", "a stamp that is no ISO 8601",
         "01.03.2022 20:30:00\t3#30 RPM  1925 48.1  22.0\n",
         rejected="x, line 1, column 1: not a time stamp (found '01.03.2022 20:30:00'); stamp with "
         "ISO 8601"),
    Trap("mPa.s and Pa.s mixed in one lab", "two files, each with its unit", elapsed(), "viscosity",
         "specimen,material,file\na,m,f\nb,m,g\n", values=VISCOSITIES,
         more={"g": elapsed({h: f"{viscosity(h):.3f}" for h in HOURS}, "time_h,viscosity_Pas")}),
    Trap("mPa.s and Pa.s mixed in one lab", "Pa.s under the label of mPa.s in one of two files",
         elapsed(), "viscosity", "specimen,material,file\na,m,f\nb,m,g\n",
         more={"g": elapsed({h: f"{viscosity(h):.3f}" for h in HOURS})},
         refused="a lies 1e+03 times above b, as when Pa.s and mPa.s are mixed; correct the unit"),
    Trap("mPa.s and Pa.s mixed in one lab", "Pa.s under mPa.s, with rotor, speed and torque",
         elapsed({h: f"{viscosity(h):.3f},3,12,{10 * viscosity(h):.1f}" for h in HOURS},
                 "time_h,viscosity_mPas,rotor,speed_rpm,torque_percent"), "viscosity", ELAPSED,
         refused="viscosity, torque and speed contradict each other in 25 of 25 readings"),
    Trap("over-range as text", "EEEE in a table", elapsed({6.0: "EEEE"}), "viscosity", ELAPSED,
         values=VISCOSITIES, flags=("over-range: 1 readings left out: lines 13",)),
    Trap("or as a plausible number (12000, 0)", "12000 at the end of a rise, again and again",
         elapsed({h: f"{min(12000.0, 2000 * 1.3**h):.0f}" for h in HOURS}), "viscosity", ELAPSED,
         values={"viscosity": 2.6}, within=2e-3,
         flags=("at-its-limit: 12 Pa.s again and again at the top of a rise, as a display at the "
                "end of its range shows it: 12 readings left out, lines 15-26",)),
    Trap("or as a plausible number (12000, 0)", "0 in the middle of a run", elapsed({6.0: "0"}),
         "viscosity", ELAPSED, values=VISCOSITIES,
         flags=("not-positive: a viscosity of zero or less: 1 readings left out, lines 13",)),
    Trap("sentinels -1", "-1 for a viscosity", elapsed({6.0: "-1"}), "viscosity", ELAPSED,
         values=VISCOSITIES,
         flags=("not-positive: a viscosity of zero or less: 1 readings left out, lines 13",)),
    Trap("sentinels -1", "-1 for a time", "time_s,viscosity_mPas\n-1,12\n2,13\n",
         rejected="x, line 2, column 1: a time before mixing (found '-1'); log the time since "
         "mixing; -1 often stands for a time that is not known"),
    Trap("-.-", "no probe in a table", "time_s,viscosity_mPas,temperature_C\n1,1200,-.-\n",
         columns={"viscosity_Pas": [1.2]}),
    Trap("-327.67", "an open probe in a table",
         elapsed({6.0: f"{1000 * viscosity(6):.0f},-327.67"} | {
             h: f"{1000 * viscosity(h):.0f},22.0" for h in HOURS if h != 6.0},
             "time_h,viscosity_mPas,temperature_C"), "viscosity", ELAPSED, values=VISCOSITIES),
    Trap("-327.67", "an open probe in a register", "", "handling",
         "material,time_h,defect,bed_temperature_C\nm,1,none,-327.67\n",
         rejected="c/handling/observations.csv, line 2, column 4: a temperature below absolute zero "
         "(found '-327.67'); leave the cell empty where it was not recorded"),
    Trap("three-digit exponents", "1.2e+003", "time_s,viscosity_mPas\n1,1.2e+003\n",
         columns={"viscosity_Pas": [1.2]}),
    Trap("unit suffix on numbers", "mPa.s behind the viscosity",
         "time_s,viscosity_mPas\n1,1200 mPa.s\n", rejected="x, line 2, column 2: not a number for "
         "the viscosity_mPas (found '1200 mPa.s')"),
    Trap("unit suffix on numbers", "N behind the load", SOFT.format("mm").replace("1.5", "1.5 N"),
         rejected="x, line 3, column 2: a unit behind the number (found '1.5 N'); export numbers "
         "alone; the unit belongs over the column"),
    Trap("missing final newline", "a table without its last line end",
         SOFT.format("mm").rstrip("\n"), rejected="x, line 3, column 3: no line end after the last "
         "row, so its last number may be cut (found '0.2')"),
    Trap("aborted curve", "a test stopped at 3 % of 5 %",
         "".join(compression().splitlines(keepends=True)[:35]), "compression", CYLINDER,
         refused="the window of 0-5 % strain is not covered: its 31 samples (10 are needed) reach from 0 % to 3 %"),
    Trap("truncated last number", "1.5 that may have been 1.57", SOFT.format("mm")[:-3],
         rejected="x, line 3, column 3: no line end after the last row"),
    Trap("identical rows (flag, never drop)", "a row twice",
         SOFT.format("mm") + "0.5;1.5;0.2\n", columns={"force_N": [1, 1.5, 1.5]},
         flags=("identical-rows: rows equal to the row before in every column: 1, the first in line "
                "4; none was dropped",)),
    Trap("a start stamp repeated while the clock is elapsed seconds", "both in one table",
         elapsed({h: f"2022-03-01T20:30:00,{1000 * viscosity(h + 0.5):.0f}" for h in HOURS},
                 "time_h,timestamp,viscosity_mPas"), "viscosity", STAMPED, values=VISCOSITIES),
    Trap("a start stamp repeated while the clock is elapsed seconds", "the stamp alone",
         "".join(f"2022-03-01T20:30:00\t{reading(h)}\n" for h in HOURS),
         rejected="x, line 1, column 1: all 25 readings have one time stamp: the start of the log, "
         "not when each was taken (found '2022-03-01T20:30:00'); stamp every reading, or log the "
         "elapsed time as time_s"),
    Trap("sampling interval and method changing mid-run", "2 s, then 10 s and another viscosity",
         "time_s,viscosity_mPas\n" + "".join(
             f"{t},{20 + 0.2 * t if t < 130 else 90:.1f}\n"
             for t in (*range(10, 130, 2), *range(139, 400, 10))),
         "viscosity", ELAPSED,
         flags=("method-changed: sampling goes from 2 s to 11 s after line 61 (128 s): the 27 "
                "readings after it are of another method and were not fitted",)),
    Trap("Cp/Cs unknown", "a bare C", "frequency_Hz,C_F,D\n10,1.5e-10,0.001\n",
         rejected="x, line 1, column 2: the label does not say whether the capacitance is in "
         "parallel or in series (found 'C'); name the column Cp_F or Cs_F"),
    Trap("midnight roll-over in a 12 h run", "times of day alone, mixed at 20:00",
         log(dated=False), "viscosity", STAMPED, values=VISCOSITIES),
    Trap("DST", "clocks that fell back at 03:00",
         autumn(),
         "viscosity", STAMPED.replace("2022-03-01", "2022-10-29"), "Europe/Berlin",
         values=VISCOSITIES),
    Trap("DST", "the same clocks in a zone that knows no summer time",
         autumn(),
         "viscosity", STAMPED.replace("2022-03-01", "2022-10-29"),
         refused="the clock steps back by 1800 s after line 13, which no change of time in UTC "
         "explains"),
    Trap("rotor changed mid-run", "rotor 3 at 12 rpm, then rotor 2 at 3 rpm",
         log({h: reading(h, 2, "3", 10000.0) for h in HOURS if h > 6.0}), "viscosity", STAMPED,
         values=VISCOSITIES, flags=("setting-changed: 3#12 to 2#3 rpm at line 13; each reading has "
                                    "the errors of its own full scale",)),
    *(Trap(f"`{name}`", f"{name} in a unit", SOFT.format(f"{mu}m"),
           columns={"displacement_m": [1e-7, 2e-7]})
      for name, mu in (("U+00B5", "\u00b5"), ("U+03BC", "\u03bc"))),
    Trap("viscosity, torque and rpm that contradict each other", "every torque half of the true one",
         log({h: f"3#12 RPM  {1000 * viscosity(h):.0f} {5 * viscosity(h):.1f}  22.0" for h in HOURS}),
         "viscosity", STAMPED,
         refused="viscosity, torque and speed contradict each other in 25 of 25 readings, first in "
         "line 1: 4.095 Pa.s of 10 Pa.s full scale is 40.9 %, not 20.5 %; check rotor, speed and "
         "unit"),
)  # fmt: skip

TRAPS = (*VISCOMETER, *METER, *RAMP, *MACHINES, *SEEN)


@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: f"{trap.said[:40]} - {trap.carries}")
def test_every_trap_is_read_right_or_rejected_by_name_and_place(trap: Trap, tmp_path: Path) -> None:
    if trap.rejected and not trap.register:
        with pytest.raises(RawFileError) as caught:
            trap.read()
        assert str(caught.value).startswith(trap.rejected)
        return
    if not trap.register:
        found = trap.read()
        for name, values in trap.columns.items():
            assert found.columns[name] == pytest.approx(list(values), rel=1e-12, abs=1e-300), name
        _begin(trap.flags, list(map(str, found.flags)))
        return
    outcome = trap.outcome(tmp_path)
    _begin((trap.rejected,) if trap.rejected else (), outcome.rejected)
    assert bool(outcome.rejected) == bool(trap.rejected)
    _begin((trap.refused,) if trap.refused else (), outcome.refusals)
    for key, value in trap.values.items():
        assert outcome.value(key) == pytest.approx(value, rel=trap.within), key
    for key, value in trap.shared.items():
        assert outcome.shared(key) == pytest.approx(value, rel=1e-6)
    _begin(trap.flags, outcome.flags)
    assert trap.words in outcome.words


def test_a_whole_run_names_every_rejected_file_and_uses_none(tmp_path: Path) -> None:
    """All rejected files in one campaign beside a good one: it alone reaches a card."""
    folders = Folders(tmp_path / "raw", tmp_path / "config", tmp_path / "processed")
    shutil.copytree(ROOT / "config", folders.config)
    place = folders.raw / "traps" / "viscosity"
    place.mkdir(parents=True)
    shutil.copy(TWIN / "campaign.toml", place.parent)
    bad = [trap for trap in TRAPS if trap.rejected and not trap.register]
    (place / "good").write_text(log())
    rows = ["specimen,material,file,mixed_at", "good,good,good,2022-03-01T20:00:00"]
    for i, trap in enumerate(bad):
        (place / f"x{i}").write_bytes(trap.data)
        rows.append(f"x{i},bad,x{i},2022-03-01T20:00:00")
    (place / "specimens.csv").write_text("\n".join([*rows, ""]))
    register(folders.raw, "traps", accept_all=True)
    document = run(folders)
    assert document["exit_code"] == 1
    found = {r["path"].rpartition("/")[2]: r["reason"] for r in document["rejected"]}
    assert len(bad) > 10
    assert set(found) == {f"x{i}" for i in range(len(bad))}
    for i, trap in enumerate(bad):
        assert trap.rejected.partition(",")[2] in found[f"x{i}"]
    cards = [json.loads(p.read_text()) for p in (folders.processed / "cards").glob("*.json")]
    origins = [o["path"] for card in cards for p in card["properties"] for o in p["origins"]]
    assert set(origins) == {"traps/viscosity/good"}


def _begin(wanted: Sequence[str], found: Sequence[str]) -> None:
    for beginning in wanted:
        assert any(text.startswith(beginning) for text in found), (beginning, found)


def test_the_list_is_complete_for_the_traps_seen_in_real_files(shared: Path) -> None:
    """What the rows quote leaves nothing but punctuation of the notes' own list."""
    rest = _squeezed(_notes(shared).partition("## Traps seen in real files")[2])
    for said in sorted({_squeezed(trap.said) for trap in SEEN}, key=len, reverse=True):
        assert said in rest, said
        rest = rest.replace(said, " ", 1)
    assert re.sub(r"[\s;,.]|\band\b|\bmu\b", "", rest) == ""


@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: trap.said[:40])
def test_every_row_quotes_the_notes(trap: Trap, shared: Path) -> None:
    assert _squeezed(trap.said) in _squeezed(_notes(shared))


def _notes(shared: Path) -> str:
    return (shared / "instruments.md").read_text(encoding="utf-8")


def _squeezed(text: str) -> str:
    return " ".join(text.split())
