"""One file per instrument export: bytes in, a Recording in SI out.

To add a format: write `formats/<module>.py` with the headings Usage, Format, Columns, Uncertainties
and Metadata in its docstring and one `FORMAT = Format(...)`, and add its line below. Its recogniser
must look at structure, cheaply, and must not accept what another one accepts: `detect` refuses a
file that two formats claim. Most tables need only a layout (`header`) and a dialect (`cells`);
`table.read_table` does the rest. `plain` is asked where none of these recognises a file.
"""

from __future__ import annotations

from importlib import import_module

from deamat.formats.format import Format

FORMATS: tuple[Format, ...] = tuple(
    import_module(f"{__name__}.{module}").FORMAT
    for module in (
        "antonpaar",
        "bluehill",
        "e4980a",
        "e4990a",
        "flow_tab",
        "hv_ramp",
        "hysitron",
        "lcr6000",
        "lcr_csv",
        "lvm",
        "mark10",
        "mts",
        "ndj8s",
        "nexygen",
        "novocontrol",
        "phantom",
        "rheocompass",
        "rheodata",
        "rigol",
        "schmid",
        "soro",
        "tektronix",
        "trios_json",
        "viscometer_csv",
        "zwick",
    )
)
