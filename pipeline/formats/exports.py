"""`config/exports.toml`: forms that a laboratory declares for its own instruments, without code.

```toml
[ramp-room-214]
techniques = ["breakdown"]
separator = "tab"
decimal = ","
columns = [
    { label = "t", quantity = "time_s", unit = "s" },
    { label = "CH1", quantity = "voltage_V", unit = "V", factor = 2000.0 },  # probe 2000:1
]
```

Nothing here is a pattern: labels and texts are compared as they are written.
"""

from __future__ import annotations

import difflib
import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, RootModel, ValidationError, field_validator, model_validator
from pydantic_core import ErrorDetails

from deamat.core.declared import Declared
from deamat.core.errors import ConfigError
from deamat.core.toml import line_of, parse_toml
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.vocabulary import ASKED, vocabulary

EXPORTS_FILE = "exports.toml"
SEPARATORS = {
    "tab": "\t",
    "semicolon": ";",
    "comma": ",",
    "bar": "|",
    "blanks": " ",
    "workbook": "\t",
}
_MOST_FORMS, _MOST_COLUMNS, _LARGEST = 200, 64, 1 << 20

_Text = Annotated[str, Field(max_length=200)]
_NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,39}")


class ExportColumn(Declared):
    """One column of a declared form that is used."""

    label: _Text = Field(default="", description="as written above it, units and all")
    number: int = Field(default=0, ge=0, le=1000, description="counted from 1, instead of a label")
    quantity: _Text = Field(description="SI name of the vocabulary: `force_N`")
    unit: _Text = Field(default="", description="in which its numbers are written")
    factor: float = Field(
        default=1.0, allow_inf_nan=False, description="on the numbers: the ratio of a probe"
    )

    @field_validator("quantity")
    @classmethod
    def _known(cls, quantity: str) -> str:
        if quantity not in vocabulary():
            near = difflib.get_close_matches(quantity, vocabulary(), n=3) or sorted(vocabulary())
            raise ValueError(f"no quantity is called {quantity!r}; nearest: {', '.join(near)}")
        return quantity

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if bool(self.label) == bool(self.number):
            raise ValueError("a column has a label or a number")
        if self.factor == 0.0:
            raise ValueError("a factor of zero leaves nothing")
        si = vocabulary()[self.quantity].unit
        try:
            unit = unit_as_written(self.unit, si) or ("" if self.unit else "1")
        except UnknownUnit as error:
            raise ValueError(str(error)) from error
        written = si_factor(unit)[0] if unit else ""
        if written != si and not (self.quantity == "frequency_Hz" and written == "rad/s"):
            given = f"{self.unit!r} is no unit of" if self.unit else "no unit for"
            raise ValueError(f"{given} {self.quantity} (it must come to {si})")
        return self


class ExportForm(Declared):
    """One section of `config/exports.toml`."""

    title: _Text = Field(default="", description="of the instrument, for people")
    techniques: tuple[_Text, ...] = Field(min_length=1, max_length=len(ASKED))
    separator: Literal["tab", "semicolon", "comma", "bar", "blanks", "workbook"]
    decimal: Literal[".", ","] = "."
    encoding: Literal["utf-8", "utf-16", "cp1252", "cp1250", "gb18030", "cp932"] = "utf-8"
    starts_with: _Text = Field(default="", description="text with which the first line starts")
    labels_line: int = Field(
        default=0, ge=0, le=100_000, description="0: the first with all labels"
    )
    first_line: int = Field(
        default=0, ge=0, le=100_000, description="of the rows; 0: below the labels"
    )
    ends_before: _Text = Field(
        default="", description="text with which the line below the rows starts"
    )
    ends_open: bool = Field(default=False, description="the last row has no line end")
    sampling_interval_s: float = Field(default=0.0, ge=0.0, allow_inf_nan=False)
    level_V: float = Field(default=0.0, ge=0.0, allow_inf_nan=False, description="of an LCR meter")
    columns: tuple[ExportColumn, ...] = Field(min_length=1, max_length=_MOST_COLUMNS)

    @field_validator("techniques")
    @classmethod
    def _asked(cls, techniques: tuple[str, ...]) -> tuple[str, ...]:
        for name in techniques:
            if name not in ASKED:
                raise ValueError(f"no technique reads tables as {name!r}: {', '.join(ASKED)}")
        return techniques

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.separator == "workbook" and self.decimal != ".":
            raise ValueError("a workbook stores numbers: leave `decimal` out")
        given = [column.quantity for column in self.columns]
        if len(set(given)) < len(given):
            raise ValueError("two columns are the same quantity")
        if self.sampling_interval_s and "time_s" in given:
            raise ValueError("a sampling interval and a column of time_s; declare one of them")
        if not any(column.label for column in self.columns) and not self.first_line:
            raise ValueError("no column has a label; declare first_line, that of the first row")
        for technique in self.techniques:
            if self.need(technique) is None:
                wanted = " or ".join(" with ".join(need) for need in ASKED[technique].needs)
                raise ValueError(f"{technique} needs {wanted}")
        return self

    @property
    def quantities(self) -> frozenset[str]:
        """All that a file gives, a time by its sampling interval too."""
        timed = {"time_s"} if self.sampling_interval_s else set()
        return frozenset({column.quantity for column in self.columns} | timed)

    def need(self, technique: str) -> tuple[str, ...] | None:
        """Return the first set of quantities that a technique can use."""
        needs = ASKED[technique].needs
        return next((need for need in needs if self.quantities.issuperset(need)), None)


class _Exports(RootModel[Mapping[str, ExportForm]]):
    """`config/exports.toml`: name to form."""

    @field_validator("root")
    @classmethod
    def _named(cls, root: Mapping[str, ExportForm]) -> Mapping[str, ExportForm]:
        if len(root) > _MOST_FORMS:
            raise ValueError(f"{len(root)} forms; at most {_MOST_FORMS}")
        for name in root:
            if not _NAME.fullmatch(name):
                raise ValueError(
                    f"the form {name!r}: a name is made of a to z, digits, - and _, at most 40"
                )
        return root


@dataclass(frozen=True, slots=True)
class Export:
    """A declared form with its name."""

    name: str
    form: ExportForm

    @property
    def version(self) -> str:
        """Hash of all that decides how files are read; the title does not."""
        said = self.form.model_dump(mode="json", exclude={"title"})
        return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:12]


def load_exports(folder: Path, reserved: Sequence[str] = ()) -> tuple[Export, ...]:
    """Read the declared forms of a configuration folder; none where it has no such file.

    Parameters
    ----------
    reserved : names of the forms that the program knows

    Raises
    ------
    ConfigError : it does not parse or does not hold; names file and line, and all that is wrong
    """
    path = folder / EXPORTS_FILE
    if not path.is_file():
        return ()
    data = path.read_bytes()
    if len(data) > _LARGEST:
        raise ConfigError(f"{path}: {len(data)} bytes; at most {_LARGEST}")
    return parse_exports(data, str(path), reserved)


def parse_exports(data: bytes, path: str, reserved: Sequence[str] = ()) -> tuple[Export, ...]:
    """Read declared forms from the bytes of a file.

    Raises
    ------
    ConfigError : see `load_exports`
    """
    try:
        declared = parse_toml(data)
    except ValueError as error:
        raise ConfigError(f"{path}: {error}") from error
    try:
        forms = _Exports.model_validate(declared).root
    except ValidationError as error:
        said = [_sentence(data, one) for one in error.errors()]
        raise ConfigError(f"{path}: " + "; ".join(said)) from error
    for name in forms:
        if name in reserved:
            line = line_of(data, (name,))
            raise ConfigError(f"{path}, line {line}: {name} is a form of the program; rename it")
    return tuple(Export(name, form) for name, form in sorted(forms.items()))


def _sentence(data: bytes, slip: ErrorDetails) -> str:
    place = slip["loc"]
    line = line_of(data, place)
    where = f"line {line}: " if line else ""
    name = ".".join(map(str, place))
    if slip["type"] == "extra_forbidden":
        known = (*ExportForm.model_fields, *ExportColumn.model_fields)
        near = difflib.get_close_matches(str(place[-1]), known, n=1)
        return f"{where}unknown key {name!r}" + (f"; did you mean {near[0]!r}?" if near else "")
    own = slip["type"] == "value_error"
    return f"{where}{name}: {slip['ctx']['error'] if own else slip['msg']}"
