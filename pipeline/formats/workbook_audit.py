"""What the parts of a workbook say of its cells beyond their values: .xlsx and .ods."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element, fromstring

from deamat.formats.rawfile import column_letters, column_number

_FORMULA = re.compile(rb"f(?<=[<:]f)[ />]")  # with a namespace or without; f is rare, < is not
_FAR = re.compile(rb' r="(?:[A-Z]{2}|[A-Z]?[0-9]{6})')
_ANYWHERE = re.compile(rb' r="([A-Z]+)([0-9]+)"')
_MOST_CELLS = 20_000_000
_PLACE = re.compile(r"([A-Z]+)([0-9]+)")
_PERCENT_FORMATS = (9, 10)  # built into every .xlsx: 0 % and 0.00 %
_WIDEST = 16384  # columns of a sheet

Place = tuple[int, int]  # row and column, counted from 0


@dataclass(frozen=True, slots=True)
class Marks:
    """What a sheet says of its cells beyond their values.

    Parameters
    ----------
    unsaved : formulas without a stored value
    percent : cells that are stored as fractions and shown in percent
    hidden : rows, counted from 0
    filtered : does a filter hide them?
    sheet_hidden : is the sheet itself hidden?
    """

    unsaved: frozenset[Place] = frozenset()
    percent: frozenset[Place] = frozenset()
    hidden: frozenset[int] = frozenset()
    filtered: bool = False
    sheet_hidden: bool = False


def marks_of(archive: zipfile.ZipFile, sheet: str) -> Marks:
    """Look for what a reader of values would miss; `zipfile` holds each part against its sum.

    Raises
    ------
    ValueError : a cell stands so far off that the sheet would not fit into memory
    """
    if "xl/sharedStrings.xml" in archive.namelist():
        archive.read("xl/sharedStrings.xml")
    if "content.xml" in archive.namelist():
        return _open_document(archive.read("content.xml"), sheet)
    part = _part(archive, sheet)
    if part is None:
        return Marks()
    xml, percent = archive.read(part), _percent_styles(archive)
    if _FAR.search(xml):
        _insist_on_extent(sheet, xml)
    if not percent and b"hidden=" not in xml and not _FORMULA.search(xml):
        return Marks()
    return _office(fromstring(xml), percent)


def _insist_on_extent(sheet: str, xml: bytes) -> None:
    places = [
        (int(row), column_number(letters.decode())) for letters, row in _ANYWHERE.findall(xml)
    ]
    rows = max((row for row, _ in places), default=0)
    columns = max((column for _, column in places), default=0) + 1
    if rows * columns > _MOST_CELLS:
        raise ValueError(
            f"sheet {sheet} reaches to {column_letters(columns - 1)}{rows}; delete what stands far "
            "from the table"
        )


def _office(sheet: Element, percent_styles: frozenset[str]) -> Marks:
    unsaved: set[Place] = set()
    percent: set[Place] = set()
    hidden: set[int] = set()
    number = 0
    for row in _named(sheet, "row"):
        number = int(row.get("r", number + 1))
        if row.get("hidden") in ("1", "true"):
            hidden.add(number - 1)
        column = -1
        for cell in _named(row, "c"):
            place = _PLACE.fullmatch(cell.get("r", ""))
            column = column_number(place[1]) if place else column + 1
            parts = {_local(part): part.text for part in cell}
            if "f" in parts and not parts.get("v") and cell.get("t") != "str":
                unsaved.add((number - 1, column))
            if cell.get("s") in percent_styles and parts.get("v"):
                percent.add((number - 1, column))
    filtered = any(True for _ in _named(sheet, "filterColumn"))
    return Marks(frozenset(unsaved), frozenset(percent), frozenset(hidden), filtered)


def _open_document(xml: bytes, name: str) -> Marks:
    if not any(mark in xml for mark in (b"percentage", b":visibility=", b":formula=")):
        return Marks()
    unsaved: set[Place] = set()
    percent: set[Place] = set()
    hidden: set[int] = set()
    filtered = False
    number = 0
    for table in _named(fromstring(xml), "table"):
        if _attribute(table, "name") != name:
            continue
        for row in _named(table, "table-row"):
            seen = _attribute(row, "visibility")
            repeated = int(_attribute(row, "number-rows-repeated") or 1)
            if seen in ("collapse", "filter") and repeated < _WIDEST:
                hidden.update(range(number, number + repeated))
                filtered = filtered or seen == "filter"
            column = 0
            for cell in row:
                places = {(number, column + i) for i in range(_columns_of(cell))}
                kind = _attribute(cell, "value-type")
                if _attribute(cell, "formula") and not kind:
                    unsaved |= places
                if kind == "percentage":
                    percent |= places
                column += _columns_of(cell)
            number += repeated
    return Marks(frozenset(unsaved), frozenset(percent), frozenset(hidden), filtered)


def _columns_of(cell: Element) -> int:
    return min(int(_attribute(cell, "number-columns-repeated") or 1), _WIDEST)


def _part(archive: zipfile.ZipFile, name: str) -> str | None:
    """Name the part of an .xlsx archive that holds a sheet."""
    links = {
        relation.get("Id"): relation.get("Target", "").removeprefix("/").removeprefix("xl/")
        for relation in _named(
            fromstring(archive.read("xl/_rels/workbook.xml.rels")), "Relationship"
        )
    }
    for sheet in _named(fromstring(archive.read("xl/workbook.xml")), "sheet"):
        if sheet.get("name") == name:
            part = f"xl/{links.get(_attribute(sheet, 'id'), '')}"
            return part if part in archive.namelist() else None
    return None


def _percent_styles(archive: zipfile.ZipFile) -> frozenset[str]:
    """Number the cell styles that show a fraction in percent."""
    if "xl/styles.xml" not in archive.namelist():
        return frozenset()
    styles = fromstring(archive.read("xl/styles.xml"))
    own = {
        int(form.get("numFmtId", "-1"))
        for form in _named(styles, "numFmt")
        if "%" in re.sub(r'"[^"]*"|\\.', "", form.get("formatCode", ""))
    }
    cells = next(_named(styles, "cellXfs"), Element("none"))
    return frozenset(
        str(at)
        for at, form in enumerate(_named(cells, "xf"))
        if int(form.get("numFmtId", "0")) in {*_PERCENT_FORMATS, *own}
    )


def _named(element: Element, name: str) -> Iterator[Element]:
    """Find the elements of a local name: their namespace differs from program to program."""
    return (found for found in element.iter() if _local(found) == name)


def _local(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _attribute(element: Element, name: str) -> str:
    """Return an attribute by its local name, empty where there is none."""
    return next((v for k, v in element.items() if k.rpartition("}")[2] == name), "")
