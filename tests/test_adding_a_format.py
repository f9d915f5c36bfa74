"""The page on adding a format shows files as they are and messages as they come."""

from __future__ import annotations

import re

import pytest

from deamat.core.errors import RawFileError
from deamat.formats.detect import detect
from deamat.formats.forms_table import with_table
from deamat.formats.rawfile import RawFile
from deamat.techniques import TECHNIQUES
from tests.formats.samples import BY_NAME
from tests.run.conftest import ROOT

PAGE = (ROOT / "docs" / "adding-a-format.md").read_text(encoding="utf-8")
LIST = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(?:python|text)\n(.*?)```", PAGE, re.DOTALL)
EXPORT, MODULE, LINE, SAMPLE, CUT, GROUPED, ROW = BLOCKS
NEXYGEN = BY_NAME["nexygen"]


def test_the_page_shows_the_files_as_they_are() -> None:
    assert NEXYGEN.data.decode("utf-16").replace("\r\n", "\n") == EXPORT
    folder = ROOT / "pipeline" / "formats"
    assert (folder / "nexygen.py").read_text(encoding="utf-8") == MODULE
    assert LINE in (folder / "__init__.py").read_text(encoding="utf-8")
    assert SAMPLE in (ROOT / "tests" / "formats" / "samples.py").read_text(encoding="utf-8")
    assert ROW in LIST


@pytest.mark.parametrize(
    ("file", "message"),
    [
        (NEXYGEN.raw([*NEXYGEN.lines[:-1], NEXYGEN.lines[-1][:-1]], end=""), CUT),
        (NEXYGEN.with_cell(0, 1, "1,234.5"), GROUPED),
    ],
)
def test_the_page_says_what_a_laboratory_will_see(file: RawFile, message: str) -> None:
    with pytest.raises(RawFileError) as caught:
        detect(file).read(file)
    assert f"{caught.value}\n" == message


def test_the_table_of_forms_is_made_from_the_code() -> None:
    assert with_table(LIST) == LIST


def test_the_list_lacks_no_technique_of_the_house() -> None:
    named = set(re.findall(r"^\| (\w+) \|", LIST, re.MULTILINE))
    assert set(TECHNIQUES) - {"handling"} <= named
    assert "handling/observations.csv" in LIST
