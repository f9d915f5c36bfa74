"""LabVIEW measurements in binary form: groups, channels, times, and files that are not whole."""

from __future__ import annotations

import io
from collections.abc import Mapping

import numpy as np
import pytest
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

from deamat.core.channels import NO_CHANNELS, Channels
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile

WAVE = {"wf_increment": 0.5, "wf_start_offset": 1.0}
RAMP = np.array([0.0, 0.25, 0.5, 0.75])


Written = Mapping[str, tuple[object, Mapping[str, object]]]


def tdms(channels: Written, group: str = "ramp", more: str = "") -> bytes:
    buffer = io.BytesIO()
    with TdmsWriter(buffer) as writer:
        objects = [RootObject({"author": "x"}), GroupObject(group, {"operator": "ab"})]
        for name in filter(None, (group, more)):
            objects += [ChannelObject(name, label, data, properties=dict(properties))
                        for label, (data, properties) in channels.items()]  # fmt: skip
        writer.write_segment(objects)
    return buffer.getvalue()


GOOD: Written = {
    "Voltage": (RAMP, {**WAVE, "unit_string": "kV"}),
    "Current (uA)": (10.0 * RAMP, WAVE),
    "Comment": (["a", "b"], {}),
    "Counter": (np.arange(4), {}),
}


def read(data: bytes, technique: str = "breakdown", channels: Channels = NO_CHANNELS) -> Recording:
    file = RawFile("c/x.tdms", data, technique=technique, channels=channels)
    return detect(file).read(file)


def refused(data: bytes, channels: Channels = NO_CHANNELS) -> str:
    with pytest.raises(RawFileError) as caught:
        read(data, channels=channels)
    return str(caught.value)


def test_channels_with_units_and_a_time_from_the_wave() -> None:
    recording = read(tdms(GOOD))
    assert recording.columns["time_s"].tolist() == [1.0, 1.5, 2.0, 2.5]
    assert recording.columns["voltage_V"].tolist() == (1000.0 * RAMP).tolist()
    assert recording.columns["current_A"].tolist() == pytest.approx((1e-5 * RAMP).tolist())
    source = recording.source
    assert (source.reader, source.encoding, source.last_line) == ("tdms", "binary", 4)
    assert recording.metadata["group"] == "ramp"
    assert recording.metadata["operator"] == "ab"
    assert recording.metadata["columns not used"] == "Counter"


def test_a_channel_of_time_goes_before_the_wave() -> None:
    channels: Written = {**GOOD, "Time": (np.arange(4.0), {"unit_string": "s"})}
    assert read(tdms(channels)).columns["time_s"].tolist() == [0.0, 1.0, 2.0, 3.0]


def test_curves_of_other_techniques_are_read_too() -> None:
    channels: Written = {"Force": (RAMP, {**WAVE, "unit_string": "N"}),
                "Extension": (RAMP, {"unit_string": "mm"})}  # fmt: skip
    assert read(tdms(channels), "tension").columns["displacement_m"][3] == pytest.approx(7.5e-4)


def test_the_register_names_channels_and_ratios() -> None:
    unnamed: Written = {"ai0": (RAMP, {**WAVE, "unit_string": "V"}),
               "ai1": (RAMP, {**WAVE, "unit_string": "V"})}  # fmt: skip
    assert "which column is the voltage? ai0 [V], ai1 [V] have its unit" in refused(tdms(unnamed))
    said = Channels({"voltage_V": "ai1", "current_A": "ai0"}, {"voltage_V": 2e3, "current_A": 2e-3})
    recording = read(tdms(unnamed), channels=said)
    assert recording.columns["voltage_V"].tolist() == (2e3 * RAMP).tolist()
    assert recording.columns["current_A"].tolist() == pytest.approx((2e-3 * RAMP).tolist())
    assert recording.metadata["channel of voltage_V"] == "ai1"
    assert recording.metadata["ratio of voltage_V"] == "2000"
    wrong = Channels({"voltage_V": "ai7"}, {})
    assert "no columns are called 'ai7', which the register names as a channel" in refused(
        tdms(unnamed), channels=wrong
    )


@pytest.mark.parametrize("cut", [8, 20, 200])
def test_a_file_that_is_cut_is_refused_and_nothing_is_printed(
    cut: int, capfd: pytest.CaptureFixture[str]
) -> None:
    assert "not whole" in refused(tdms(GOOD)[:-cut])
    assert capfd.readouterr() == ("", "")


def test_other_faults_are_named() -> None:
    assert "several groups hold what is needed: ramp, again" in refused(tdms(GOOD, more="again"))
    short: Written = {**GOOD, "Current (uA)": (RAMP[:2], WAVE)}
    assert "channels of different lengths" in refused(tdms(short))
    nan: Written = {**GOOD, "Voltage": (np.array([0.0, np.nan, 1.0, 2.0]), GOOD["Voltage"][1])}
    assert "line 2: Voltage holds 1 values that are no numbers" in refused(tdms(nan))
    assert "no column is the voltage" in refused(tdms({"Time": (RAMP, {"unit_string": "s"})}))


def test_spoilt_files_are_read_or_refused(capfd: pytest.CaptureFixture[str]) -> None:
    generator, good = np.random.default_rng(3), tdms(GOOD)
    for _ in range(300):
        data = bytearray(good)
        for at in generator.integers(4, len(data), 2):
            data[at] = int(generator.integers(0, 256))
        try:
            columns = read(bytes(data)).columns
        except RawFileError:
            continue
        assert {"time_s", "voltage_V"} <= set(columns)
    assert capfd.readouterr() == ("", "")
