"""`deamat exclude`: leave a specimen or a file out, with its reason, by `exclusions.toml`."""

from __future__ import annotations

import difflib
import json
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.config import Config, Exclusion, load_config
from deamat.core.errors import ConfigError
from deamat.core.slug import label_fault
from deamat.run.add.known import registers_of
from deamat.run.folders import Folders, walk
from deamat.techniques import TECHNIQUES

_FILE = "exclusions.toml"


def exclude(folders: Folders, named: str, reason: str) -> Exclusion:
    """Append an exclusion to those that are declared; returns it.

    Parameters
    ----------
    named : a specimen by its name or as `campaign/technique/specimen`, or a file below `raw/`

    Raises
    ------
    ConfigError : nothing or several things are called so, it is left out already, no reason
    """
    if fault := label_fault(reason) or (None if len(reason.strip()) > 2 else "say why"):
        raise ConfigError(f"--reason {reason!r}: {fault}")
    config = load_config(folders.config, {key: t.config for key, t in TECHNIQUES.items()})
    found = _found(folders, named, reason.strip(), config)
    for known in config.exclusions.exclude:
        if known.target == found.target:
            raise ConfigError(f"{found.target} is left out already: {known.reason}")
    path = folders.config / _FILE
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    write_atomically(path, (_with_blank_line(text) + _section(found)).encode())
    return found


def _found(folders: Folders, named: str, reason: str, config: Config) -> Exclusion:
    """Find the specimen or the file that is meant."""
    rows = _rows(folders.raw, config)
    matching = [row for row in rows if named in (row, row.split("/", 2)[2])]
    if len(matching) > 1:
        raise ConfigError(f"several specimens are called {named!r}: {', '.join(matching)}")
    if matching:
        return Exclusion(specimen=matching[0], reason=reason)
    files = [path.partition("/")[2] for path, _ in walk(str(folders.raw), "raw")]
    if named in files and named.count("/") > 1:
        return Exclusion(path=named, reason=reason)
    names = [*rows, *(row.split("/", 2)[2] for row in rows), *files]
    near = difflib.get_close_matches(named, names, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise ConfigError(f"no specimen and no file is called {named!r}{hint}")


def _rows(raw: Path, config: Config) -> list[str]:
    """Name every specimen of every campaign as an exclusion does."""
    return [
        f"{campaign}/{technique.key}/{specimen.id}"
        for campaign in sorted(path.parent.name for path in raw.glob("*/campaign.toml"))
        for technique in TECHNIQUES.values()
        for register in registers_of(raw, campaign, technique, config)
        for specimen in register.specimens
    ]


def _with_blank_line(text: str) -> str:
    return text if not text or text.endswith("\n\n") else text.rstrip("\n") + "\n\n"


def _section(exclusion: Exclusion) -> str:
    kind = "path" if exclusion.path is not None else "specimen"
    lines = ["[[exclude]]", f"{kind} = {_quoted(exclusion.target)}"]
    return "\n".join([*lines, f"reason = {_quoted(exclusion.reason)}"]) + "\n"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
