"""What a look at a file gave, as facts; `text` makes words of them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Column:
    """One column that is used.

    Parameters
    ----------
    name : with its SI unit, `force_N`
    label, unit : as written over it, empty where the form does not say which one it is
    first, last, least, greatest : of its values, in SI
    """

    name: str
    label: str
    unit: str
    first: float
    last: float
    least: float
    greatest: float


@dataclass(frozen=True, slots=True)
class Value:
    """One value that a technique would return.

    Parameters
    ----------
    name : property key, or what stands for it where dimensions are missing (`stiffness`)
    value, u : in SI; u is None where it is not known
    unit : SI
    said : for people, with its conditions
    method : how it was found
    """

    name: str
    value: float
    u: float | None
    unit: str
    said: str
    method: str


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a curve: what it shows, in which unit, and whether by its logarithm."""

    name: str
    unit: str
    log: bool = False

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit != "1" else self.name


@dataclass(frozen=True, slots=True)
class Curve:
    """The curve that a technique looks at, in the units that people read."""

    x_axis: Axis
    y_axis: Axis
    x: tuple[float, ...]
    y: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Reading:
    """What one technique makes of a file.

    Parameters
    ----------
    technique : its key
    row : where its dimensions come from, empty where there are none
    measured : the values are those of the technique; else what the file says without dimensions
    values, refused : what it would return, and why not
    flags : what was noticed
    missing : register columns that it needs yet
    runs : how many of them the file holds, empty for one
    curve : None where there is nothing to look at
    """

    technique: str
    row: str
    measured: bool
    values: tuple[Value, ...]
    refused: tuple[str, ...]
    flags: tuple[str, ...]
    missing: tuple[str, ...]
    runs: str
    curve: Curve | None


@dataclass(frozen=True, slots=True)
class Checked:
    """What a look at one file gave.

    Parameters
    ----------
    failed : the program failed over it
    form, title : of the form that read it, empty where none did
    first_line, last_line : of the rows
    rows : the first of them, as written
    columns, unused : those that are used, and the labels of the others
    faults : all that is wrong, where the file was not read
    nearest : the form that it comes nearest to
    """

    path: str
    read: bool
    failed: bool = False
    encoding: str = ""
    form: str = ""
    title: str = ""
    first_line: int = 0
    last_line: int = 0
    rows: tuple[str, ...] = ()
    columns: tuple[Column, ...] = ()
    unused: str = ""
    readings: tuple[Reading, ...] = ()
    faults: tuple[str, ...] = ()
    hint: str = ""
    nearest: str = ""

    def to_document(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)
