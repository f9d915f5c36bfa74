"""Every reader's docstring names the columns that it returns, each with its SI unit."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Iterable

import pytest

from deamat.formats import FORMATS
from deamat.formats.format import Format
from deamat.formats.lcr_sweep import PAIRS
from deamat.formats.rawfile import RawFile
from deamat.materials.curves import unit_of_column
from tests.conftest import ROOT
from tests.formats.samples import BY_NAME
from tests.formats.test_flow import ANTON_PAAR, COMPASS, RHEODATA, SCHMID, TAB, utf16
from tests.formats.test_rewritten import FILES
from tests.formats.test_viscometer import CSV, LOG
from tests.formats.trios import document, rows

LCR = ROOT / "tests" / "data" / "lcr"
STAMPS = ("2022-03-01T20:30:00", "2022-03-01T20:30:00+01:00", "20:30:00")


def sweeps(name: str, function: str, functions: Iterable[str]) -> list[bytes]:
    """The good file of a meter, under every function that it has."""
    text = (LCR / name).read_text(encoding="utf-8")
    assert function in text
    return [text.replace(function, other).encode() for other in functions]


def plain_sweeps() -> list[bytes]:
    pairs = ("Cp_F,D", "Cp_F,Rp_ohm", "Cs_F,D", "Cs_F,Rs_ohm", "R_ohm,X_ohm", "Z_ohm,theta_deg")
    return [f"frequency_Hz,{pair}\n10,1,1\n20,1,2\n".encode() for pair in pairs]


def logs() -> list[bytes]:
    return [f"{stamp}\t3#30 RPM  1925 48.1  22.0\n".encode() for stamp in STAMPS]


def stamped() -> list[bytes]:
    return [f"timestamp,viscosity_Pas\n{stamp},1\n".encode() for stamp in STAMPS]


def computed() -> list[bytes]:
    """A spectrometer's text under every pair that it may show."""
    text, pair = FILES["novocontrol"], "Eps'    \t Eps''   "
    assert pair in text
    pairs = (pair, "Eps'\tTan(Delta)", "Eps'\tSig' [S/cm]", "Modulus'\tModulus''")
    return [text.replace(pair, other).encode() for other in pairs]


GOOD: dict[str, list[bytes]] = {
    "antonpaar": [ANTON_PAAR.encode()],
    "flow_tab": [TAB.encode()],
    "schmid": [SCHMID.encode()],
    "rheodata": [RHEODATA.encode()],
    "rheocompass": [utf16(COMPASS)],
    "ndj8s": ["\n".join([*LOG, ""]).encode(), *logs()],
    "viscometer_csv": ["\n".join([*CSV, ""]).encode(), *stamped()],
    "lcr6000": sweeps("lcr6000.log", "Cp-D", PAIRS),
    "e4980a": sweeps(
        "e4980a.csv",
        "Function,RX",
        [f"Function,{f}" for f in ("CPD", "CPRP", "CSD", "CSRS", "RX", "ZTD")],
    ),
    "lcr_csv": plain_sweeps(),
    **{name: [text.encode()] for name, text in FILES.items()},
    "novocontrol": computed(),
    "trios_json": [json.dumps(document(rows("a")), indent=1).encode()],
    **{name: [sample.data] for name, sample in BY_NAME.items()},
}


def stated(form: Format) -> dict[str, str]:
    """Column to unit, as the docstring's Columns says them."""
    documentation = importlib.import_module(f"deamat.formats.{form.name}").__doc__ or ""
    section = documentation.split("\nColumns\n-------\n")[1].split("\n\n")[0]
    return dict(re.findall(r"`(\w+) \[([^\]`]+)\]`", section))


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)
def test_the_columns_named_are_those_that_come_out(form: Format) -> None:
    returned: dict[str, None] = {}
    for data in GOOD[form.name]:
        file = RawFile("x", data)
        assert form.recognises(file.head)
        returned |= dict.fromkeys(form.read(file).columns)
    assert set(stated(form)) == set(returned)


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)
def test_the_units_named_are_those_of_the_columns(form: Format) -> None:
    assert {name: unit_of_column(name) for name in stated(form)} == stated(form)
