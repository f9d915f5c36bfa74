"""A learned form is tried on its sample before it is shown, and appended whole or not at all."""

from __future__ import annotations

import re
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.errors import ConfigError
from deamat.core.recording import Recording
from deamat.formats.declared import format_of
from deamat.formats.detect import KNOWN_FORMS
from deamat.formats.exports import EXPORTS_FILE, load_exports, parse_exports
from deamat.formats.rawfile import RawFile

_HEADER = "# Forms of this laboratory's own exports; `deamat learn FILE` proposes an entry.\n"


def name_for(file: Path) -> str:
    """Make the name of a form from that of a file."""
    plain = re.sub(r"[^a-z0-9]+", "-", file.stem.casefold()).strip("-")[:40].strip("-")
    return plain or "own-export"


def tried(sample: RawFile, text: str, technique: str) -> Recording:
    """Read the sample by a proposed section.

    Raises
    ------
    ConfigError : the section does not hold
    RawFileError : it does not read its own sample
    """
    (export,) = parse_exports(text.encode(), "the proposal", KNOWN_FORMS)
    file = RawFile(sample.path, sample.data, technique=technique)
    return format_of(export).read(file)


def append(folder: Path, name: str, text: str) -> Path:
    """Append a section to `config/exports.toml` and return its path.

    Raises
    ------
    ConfigError : there is such a section already, or the file does not hold
    """
    if not folder.is_dir():
        raise ConfigError(f"no configuration folder {folder}; give one with --config")
    path = folder / EXPORTS_FILE
    if any(export.name == name for export in load_exports(folder, KNOWN_FORMS)):
        raise ConfigError(f"{path} has a form {name} already; choose another --name")
    before = path.read_text(encoding="utf-8") if path.is_file() else _HEADER
    whole = before.rstrip("\n") + "\n\n" + text
    parse_exports(whole.encode(), str(path), KNOWN_FORMS)
    write_atomically(path, whole.encode())
    return path
