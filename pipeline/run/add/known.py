"""What a campaign holds already: its files, rows, materials and what its rows have in common."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from deamat.core.config import Config
from deamat.core.errors import ConfigError
from deamat.core.register import ENDINGS, SHEET, Register, read_register
from deamat.core.technique import AnyTechnique
from deamat.formats.rawfile import read_raw
from deamat.run.add.rows import Known
from deamat.run.folders import walk
from deamat.techniques import TECHNIQUES

_ALIKE = ("instrument", "operator")


@dataclass
class Campaign:
    """A campaign as `add` finds it.

    Parameters
    ----------
    rows : file (relative to `raw/`) and sheet that have a row
    sizes : size in bytes to the files of that size
    """

    raw: Path
    name: str
    known: Known
    rows: set[tuple[str, str]] = field(default_factory=set)
    sizes: dict[int, list[str]] = field(default_factory=dict)

    def place_of(self, data: bytes, sheet: str) -> str:
        """Name the registered file with these bytes and this sheet; empty where there is none."""
        for path in self.sizes.get(len(data), ()):
            if {(path, sheet), (path, "")} & self.rows and read_raw(self.raw, path) == data:
                return path
        return ""


def campaign_named(raw: Path, name: str) -> str:
    """Return the campaign that is meant: the one named, or the only one.

    Raises
    ------
    ConfigError : there is none, or several and none is named
    """
    there = sorted(path.parent.name for path in raw.glob("*/campaign.toml"))
    if name in there or (not name and len(there) == 1):
        return name or there[0]
    if not there:
        raise ConfigError(f"no campaign in {raw}; begin one with `deamat init`")
    said = f"there is no campaign {name!r}" if name else "there are several campaigns"
    raise ConfigError(f"{said}; say --campaign with one of {', '.join(there)}")


def look_at_campaign(raw: Path, name: str, config: Config) -> Campaign:
    """Read what the registers of a campaign say.

    Raises
    ------
    RawFileError : a register cannot be read
    """
    found = Campaign(raw, name, Known(set(config.materials)))
    for path, stat in walk(str(raw / name), name):
        if not stat.odd:
            found.sizes.setdefault(stat.size, []).append(path)
    for key, technique in TECHNIQUES.items():
        registers = list(registers_of(raw, name, technique, config))
        specimens = [specimen for register in registers for specimen in register.specimens]
        errors = [error for register in registers for error in register.errors]
        found.rows |= {(path, "") for path, _ in errors if path}
        found.rows |= {(s.file, s.notes.get(SHEET, "")) for s in specimens if s.file}
        found.known.materials |= {s.material for s in specimens}
        found.known.specimens[key] = {s.id.casefold() for s in specimens}
        found.known.constant[key] = _constant([s.notes for s in specimens])
    return found


def registers_of(
    raw: Path, campaign: str, technique: AnyTechnique, config: Config
) -> Iterator[Register]:
    """Read the registers of a technique in a campaign: one as a rule, none where it has none.

    Raises
    ------
    RawFileError : one cannot be read
    """
    for ending in ENDINGS:
        name = technique.register.file.removesuffix(".csv") + ending
        file = f"{campaign}/{technique.key}/{name}"
        if (raw / file).is_file():
            yield read_register(
                read_raw(raw, file), file, campaign, technique.key, technique.required,
                config.instruments.gauges, technique.register,
            )  # fmt: skip


def _constant(rows: list[Mapping[str, str]]) -> dict[str, str]:
    """Find the columns in which all rows say the same."""
    found = {}
    for column in _ALIKE:
        said = {row.get(column, "") for row in rows}
        if len(said) == 1 and "" not in said:
            found[column] = next(iter(said))
    return found
