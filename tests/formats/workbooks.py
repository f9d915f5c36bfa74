"""Small workbooks, written part by part."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping, Sequence

_MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
_LINKS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_TYPES = (
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships'
    '+xml"/><Default Extension="xml" ContentType="application/xml"/><Override PartName="/xl/'
    'workbook.xml" ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.sheet'
    '.main+xml"/>'
)
_STYLES = (
    f'<styleSheet {_MAIN}><cellXfs count="4"><xf numFmtId="0"/><xf numFmtId="10"/>'
    '<xf numFmtId="21"/><xf numFmtId="22"/></cellXfs></styleSheet>'
)  # general, percent, h:mm:ss, date and time

Rows = Sequence[Sequence[str | float | None]]


def xlsx(
    sheets: Mapping[str, Rows],
    *,
    hidden: int = 0,
    replaced: Mapping[str, str] = {},
    after: str = "",
    put_aside: str = "",
) -> bytes:
    """A workbook of sheets; `replaced` puts other XML in the place of a cell (`C3`).

    Parameters
    ----------
    hidden : number of a row
    after : XML below the rows
    put_aside : name of a sheet that is hidden
    """
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types">{_TYPES}</Types>',
        "_rels/.rels": f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="r" '
        f'Type="{_LINKS}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/styles.xml": _STYLES,
    }
    listed = links = ""
    for at, (name, rows) in enumerate(sheets.items(), start=1):
        state = ' state="hidden"' if name == put_aside else ""
        listed += f'<sheet name="{name}" sheetId="{at}"{state} r:id="r{at}"/>'
        links += (
            f'<Relationship Id="r{at}" Type="{_LINKS}/worksheet" '
            f'Target="worksheets/sheet{at}.xml"/>'
        )
        parts[f"xl/worksheets/sheet{at}.xml"] = (
            f"<worksheet {_MAIN}><sheetData>"
            + "".join(_row(n, row, n == hidden, replaced) for n, row in enumerate(rows, start=1))
            + f"</sheetData>{after}</worksheet>"
        )
    links += f'<Relationship Id="s" Type="{_LINKS}/styles" Target="styles.xml"/>'
    parts["xl/workbook.xml"] = (
        f'<workbook {_MAIN} xmlns:r="{_LINKS}"><sheets>{listed}</sheets></workbook>'
    )
    parts["xl/_rels/workbook.xml.rels"] = (
        f'<Relationships xmlns="{_PACKAGE}/relationships">{links}</Relationships>'
    )
    return _zipped(parts)


def ods(rows: Rows, seen: Mapping[int, str] = {}) -> bytes:
    """An OpenDocument workbook of one sheet.

    Parameters
    ----------
    rows : of cells; a text that starts with `<` is XML
    seen : number of a row, counted from 0, to its visibility
    """
    space = "urn:oasis:names:tc:opendocument:xmlns"
    body = ""
    for number, row in enumerate(rows):
        cells = ""
        for cell in row:
            if isinstance(cell, str) and cell.startswith("<"):
                cells += cell
            elif isinstance(cell, str):
                cells += (
                    f'<table:table-cell office:value-type="string"><text:p>{cell}</text:p>'
                    "</table:table-cell>"
                )
            elif cell is not None:
                cells += f'<table:table-cell office:value-type="float" office:value="{cell}"/>'
            else:
                cells += "<table:table-cell/>"
        visible = f' table:visibility="{seen[number]}"' if number in seen else ""
        body += f"<table:table-row{visible}>{cells}</table:table-row>"
    content = (
        f'<office:document-content xmlns:office="{space}:office:1.0" '
        f'xmlns:table="{space}:table:1.0" xmlns:text="{space}:text:1.0"><office:body>'
        f'<office:spreadsheet><table:table table:name="Daten">{body}</table:table>'
        "</office:spreadsheet></office:body></office:document-content>"
    )
    kind = "application/vnd.oasis.opendocument.spreadsheet"
    manifest = (
        f'<manifest:manifest xmlns:manifest="{space}:manifest:1.0"><manifest:file-entry '
        f'manifest:full-path="/" manifest:media-type="{kind}"/></manifest:manifest>'
    )
    return _zipped({"mimetype": kind, "content.xml": content, "META-INF/manifest.xml": manifest})


def _row(
    number: int, row: Sequence[str | float | None], hidden: bool, replaced: Mapping[str, str]
) -> str:
    cells = ""
    for column, cell in zip("ABCDEFGH", row, strict=False):
        place = f"{column}{number}"
        if place in replaced:
            cells += replaced[place]
        elif isinstance(cell, str):
            cells += f'<c r="{place}" t="inlineStr"><is><t>{cell}</t></is></c>'
        elif cell is not None:
            cells += f'<c r="{place}"><v>{cell!r}</v></c>'
    return (
        f'<row r="{number}"{" hidden=" + chr(34) + "1" + chr(34) if hidden else ""}>{cells}</row>'
    )


def _zipped(parts: Mapping[str, str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return stream.getvalue()
