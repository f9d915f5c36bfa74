"""Channels and ratios of a recorder, as the register says them."""

from __future__ import annotations

import pytest

from deamat.core.channels import Channels, channels_of
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording, Specimen
from deamat.core.register import read_register
from deamat.formats.detect import detect, insist_on_channels
from deamat.formats.exports import parse_exports
from deamat.formats.rawfile import RawFile
from deamat.techniques.breakdown import TECHNIQUE
from tests.formats.test_rewritten import LVM, RIGOL, TEKTRONIX

HEADER = "specimen,material,file,thickness_um,voltage_channel,current_channel,probe_ratio,current_ratio_A_per_V\n"
TWO = "time_s;CH1 (V);CH2 (V)\n0;0.0;0.1\n1;0.5;0.2\n2;1.0;0.3\n"
BOTH = Channels({"voltage_V": "CH1", "current_A": "CH2"}, {"voltage_V": 2e3, "current_A": 1e-3})


def row(cells: str) -> Specimen:
    data = (HEADER + f"s1,m,a.csv,100,{cells}\n").encode()
    register = read_register(
        data, "c/breakdown/specimens.csv", "c", "breakdown", (), {}, TECHNIQUE.register
    )
    return register.specimens[0]


def read(text: str, channels: Channels) -> Recording:
    file = RawFile("c/a.csv", text.encode(), technique="breakdown", channels=channels)
    recording = detect(file).read(file)
    insist_on_channels(file, recording)
    return recording


def refused(text: str, channels: Channels) -> str:
    with pytest.raises(RawFileError) as caught:
        read(text, channels)
    return str(caught.value)


def test_a_row_gives_channels_their_roles() -> None:
    assert channels_of(row("CH1,CH2,2000,1e-3")) == BOTH
    assert not channels_of(row(",,,"))
    assert hash(channels_of(row("CH1,CH2,2000,1e-3"))) == hash(BOTH)
    with pytest.raises(RawFileError, match=r"line 2: probe_ratio is no ratio .found '1000:1'"):
        channels_of(row("CH1,,1000:1,"))
    with pytest.raises(RawFileError, match="is no ratio"):
        channels_of(row("CH1,,0,"))


def test_channels_and_ratios_decide_what_columns_are() -> None:
    recording = read(TWO, BOTH)
    assert recording.columns["voltage_V"].tolist() == [0.0, 1000.0, 2000.0]
    assert recording.columns["current_A"].tolist() == pytest.approx([1e-4, 2e-4, 3e-4])
    assert recording.flags == ()
    swapped = Channels({"voltage_V": "ch2", "current_A": "CH1 "}, {"current_A": 1.0})
    assert read(TWO, swapped).columns["voltage_V"].tolist() == [0.1, 0.2, 0.3]


def test_without_them_the_columns_stay_in_doubt() -> None:
    assert "which column is the voltage?" in refused(TWO, Channels({}, {}))


@pytest.mark.parametrize("text", [RIGOL, TEKTRONIX, LVM])
def test_scopes_and_labview_take_a_probe_ratio(text: str) -> None:
    plain, scaled = (read(text, Channels({}, r)) for r in ({}, {"voltage_V": 10.0}))
    assert (scaled.columns["voltage_V"] == 10.0 * plain.columns["voltage_V"]).all()
    assert scaled.metadata["ratio of voltage_V"] == "10"


def test_a_channel_that_is_not_there_is_named() -> None:
    said = refused(TWO, Channels({"voltage_V": "CH3"}, {}))
    assert "no columns are called 'CH3', which the register names as a channel" in said


def test_a_current_in_volts_needs_its_ratio() -> None:
    assert (
        "current_A" not in read(TWO, Channels({"voltage_V": "CH1", "current_A": "CH2"}, {})).columns
    )


def test_a_form_that_states_its_own_ratios_takes_no_others() -> None:
    text = "# channel 1: voltage monitor, 2000 V/V\ntime_s,ch1_V\n0.0,0.0\n1.0,0.5\n2.0,1.0\n"
    assert "a file of the form hv_ramp says itself" in refused(
        text, Channels({}, {"voltage_V": 5.0})
    )


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("Sample_1.is_tens", "a Bluehill sample or method, which holds no curve"),
        ("Sample_1.id_comp", "Bluehill's own binary data"),
        ("x.ZS2", "a series of Zwick testXpert in its own form"),
        ("x.mpr", "a BioLogic measurement in binary form"),
    ],
)
def test_files_in_a_machines_own_form_are_named(name: str, what: str) -> None:
    with pytest.raises(RawFileError) as caught:
        detect(RawFile(f"c/{name}", b"\x00\x01binary", technique="tension"))
    assert what in caught.value.reason
    assert caught.value.hint


def test_a_declared_form_takes_no_channels_from_the_register() -> None:
    """Its entry in config/exports.toml says what its columns are."""
    entry = (
        '[own]\ntechniques = ["breakdown"]\nseparator = "semicolon"\ncolumns = [\n'
        '  { label = "time_s", quantity = "time_s", unit = "s" },\n'
        '  { label = "CH1 (V)", quantity = "voltage_V", unit = "V" },\n]\n'
    )
    file = RawFile("c/a.csv", TWO.encode(), technique="breakdown", channels=BOTH)
    recording = detect(file, parse_exports(entry.encode(), "x")).read(file)
    with pytest.raises(RawFileError, match="says itself what its columns are"):
        insist_on_channels(file, recording)
