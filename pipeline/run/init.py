"""`deamat init`: an empty folder becomes a project, a project gets a new campaign."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

from deamat.core.atomic import write_atomically
from deamat.core.campaign import CAMPAIGN_FILE, load_campaign
from deamat.core.errors import ConfigError
from deamat.core.slug import label_fault, nearest_slug, slug_fault
from deamat.run.folders import Folders
from deamat.run.other_folders import no_technique
from deamat.run.register import register
from deamat.run.register_schemas import header_of
from deamat.techniques import TECHNIQUES

_CONFIG = {
    "materials.toml": """\
# Names that people read. A material that is not named here goes by its id.
# [gel-a]
# name = "Gel A (10:1)"
""",
    "instruments.toml": """\
# What is declared of machines and gauges: `match` is text that occurs in a register's `instrument`.
# [machines.load-frame]
# match = "load frame"
# u_force_calibration = 0.005
# source = "calibration certificate 123"
#
# [gauges.diameter]
# u_reading_m = 1e-5
""",
    "methods.toml": """\
# Deviations from the defaults of a technique, a section each; see docs/methods/.
""",
    "exclusions.toml": """\
# Files and specimens to leave out, each with its reason; `deamat exclude` writes here.
""",
}


@dataclass(frozen=True, slots=True)
class Declared:
    """What a campaign declares of itself.

    Parameters
    ----------
    name : of its folder
    synthetic : its data are simulated, and all that is made of them says so
    """

    name: str
    title: str
    laboratory: str
    licence: str
    synthetic: bool
    source: str = ""
    timezone: str = ""


def init(folders: Folders, declared: Declared, techniques: Sequence[str]) -> list[str]:
    """Write what is not there yet of a project, and a new campaign; returns what was made.

    Parameters
    ----------
    techniques : whose folders and empty registers are made

    Raises
    ------
    ConfigError : a name that cannot be, a campaign that is there, no such technique
    """
    folder = folders.raw / _checked(declared, techniques)
    if folder.exists():
        raise ConfigError(f"{folder} is there already; choose another --campaign")
    text = _campaign_text(declared).encode()
    load_campaign(folder, text)
    made = []
    for name, content in _CONFIG.items():
        path = folders.config / name
        if not path.exists():
            write_atomically(path, content.encode())
            made.append(str(path))
    write_atomically(folder / CAMPAIGN_FILE, text)
    made.append(str(folder / CAMPAIGN_FILE))
    for key in dict.fromkeys(techniques):
        technique = TECHNIQUES[key]
        path = folder / key / technique.register.file
        write_atomically(path, (",".join(header_of(technique)) + "\n").encode())
        made.append(str(path))
    register(folders.raw, declared.name)
    return made


def _checked(declared: Declared, techniques: Sequence[str]) -> str:
    if fault := slug_fault(declared.name):
        near = nearest_slug(declared.name)
        raise ConfigError(f"--campaign {declared.name!r}: {fault}; nearest valid: {near!r}")
    for option, text in _texts(declared).items():
        if fault := label_fault(text):
            raise ConfigError(f"--{option} {text!r}: {fault}")
    for key in techniques:
        if key not in TECHNIQUES:
            raise ConfigError(no_technique(key, TECHNIQUES))
    return declared.name


def _texts(declared: Declared) -> dict[str, str]:
    return {
        "title": declared.title,
        "laboratory": declared.laboratory,
        "licence": declared.licence,
        "source": declared.source,
        "timezone": declared.timezone,
    }


def _campaign_text(declared: Declared) -> str:
    # A JSON string without escapes of its own kind is a basic string of TOML.
    lines = [
        f"{key} = {json.dumps(text, ensure_ascii=False)}"
        for key, text in _texts(declared).items()
        if text or key in ("title", "laboratory", "licence")
    ]
    lines.append(f"synthetic = {str(declared.synthetic).lower()}")
    return "\n".join(lines) + "\n"
