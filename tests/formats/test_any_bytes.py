"""Whatever the bytes, a reader gives finite columns of one length or a RawFileError."""

from __future__ import annotations

import contextlib

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deamat.core.errors import RawFileError
from deamat.formats import FORMATS
from deamat.formats.rawfile import RawFile
from tests.formats.samples import SAMPLES, Sample
from tests.formats.test_good_files import read

spoils = st.tuples(
    st.floats(0, 1, exclude_max=True), st.integers(0, 3), st.binary(min_size=0, max_size=3)
)


def whole(file: RawFile) -> None:
    recording = read(file)
    lengths = {len(values) for values in recording.columns.values()}
    assert lengths == {recording.source.last_line - recording.source.first_line + 1}
    assert all(np.isfinite(values).all() for values in recording.columns.values())
    assert all(recording.columns)


@settings(max_examples=150)
@given(st.sampled_from(SAMPLES), st.lists(spoils, min_size=1, max_size=3))
def test_a_spoilt_file_is_read_whole_or_refused(
    sample: Sample, changes: list[tuple[float, int, bytes]]
) -> None:
    data = sample.data
    for where, cut, new in changes:
        at = int(where * len(data))
        data = data[:at] + new + data[at + cut :]
    with contextlib.suppress(RawFileError):
        whole(RawFile("x", data))


@settings(max_examples=150)
@given(st.text(alphabet='0123456789.,;\t\n\r"()[]%:-+eENTimeLoadkms ', max_size=120))
def test_any_text_is_read_whole_or_refused_by_every_reader(text: str) -> None:
    file = RawFile("x", text.encode())
    for form in FORMATS:
        with contextlib.suppress(RawFileError):
            form.read(file)
    with contextlib.suppress(RawFileError):
        whole(file)


@settings(max_examples=150)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_whole_or_refused(data: bytes) -> None:
    with contextlib.suppress(RawFileError):
        whole(RawFile("x", data))
