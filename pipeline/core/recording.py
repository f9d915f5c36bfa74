"""What an instrument and a register say, in SI, before any physics: Recording and Specimen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from deamat.core.arrays import FloatArray
from deamat.core.flags import Flag
from deamat.core.kinds import Condition
from deamat.core.quantity import Quantity
from deamat.core.schema import Label


@dataclass(frozen=True, slots=True)
class Source:
    """Where a recording came from, down to the lines that hold its data.

    Parameters
    ----------
    path : relative to `raw/`, with forward slashes
    sha256 : of the file's bytes
    first_line, last_line : the data rows, as lines counted from 1
    encoding : as found (`utf-8`, `utf-8-sig`, `utf-16`, `latin-1`)
    reader : name of the format that read it
    """

    path: str
    sha256: str
    first_line: int
    last_line: int
    encoding: str
    reader: str


@dataclass(frozen=True, slots=True)
class Recording:
    """Columns in SI as one instrument wrote them, with its metadata and source; no physics.

    Parameters
    ----------
    columns : name with its SI unit (`force_N`) to values, shape (n,) each
    metadata : what the file says about itself, as text
    column_units : label to unit as written over each column, to hold against other statements
    flags : what the reader noticed (contradictions, identical rows, odd endings)
    """

    columns: Mapping[str, FloatArray]
    metadata: Mapping[str, str]
    column_units: Mapping[str, str]
    source: Source
    flags: tuple[Flag, ...] = ()


@dataclass(frozen=True, slots=True)
class Specimen:
    """One row of a register.

    Parameters
    ----------
    id, material, campaign, technique : who it is
    file : data file relative to `raw/`, or None where the register holds the value itself
    format : name of a reader, or None to detect it
    numbers : geometry and settings in SI by name (`diameter_m`), each with its uncertainty
    conditions : what tells its record apart, keys of `core.properties.CONDITIONS`
    notes : every other column, kept as text
    register, line : the register's path relative to `raw/`, and the row's line
    """

    id: Annotated[str, Label("specimen")]
    material: Annotated[str, Label("material")]
    campaign: Annotated[str, Label("campaign")]
    technique: Annotated[str, Label("technique")]
    file: str | None
    format: str | None
    numbers: Mapping[str, Quantity]
    conditions: Mapping[str, Condition]
    notes: Mapping[str, str]
    register: str
    line: int

    @property
    def place(self) -> str:
        """How exclusions, messages and the state name it: `campaign/technique/specimen`."""
        return f"{self.campaign}/{self.technique}/{self.id}"
