"""Writes a whole simulated campaign, as a laboratory would hand it over, and its truth apart."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from deamat.core.atomic import new_folder, write_atomically
from deamat.core.errors import ConfigError
from deamat.twin.breakdown import breakdown_part
from deamat.twin.compression import compression_part
from deamat.twin.handling import handling_part
from deamat.twin.nanoindentation import nanoindentation_part
from deamat.twin.part import SYNTHETIC, Part
from deamat.twin.permittivity import permittivity_part
from deamat.twin.tension import tension_part
from deamat.twin.viscosity import viscosity_part
from deamat.twin.writers import manifest

NAME = "sylgard-2022-twin"
# The first from 2022 on whose every 95 % interval holds its truth: docs/adr/0007-committed-seed.md
SEED = 2033

# One file of this package per technique, each with its own random streams.
PARTS: tuple[Callable[[int], Part], ...] = (
    compression_part,
    tension_part,
    permittivity_part,
    breakdown_part,
    viscosity_part,
    nanoindentation_part,
    handling_part,
)

_CAMPAIGN = """\
title = "Simulated characterisation of the Sylgard compositions of Sikulskyi et al. 2022"
laboratory = "none: simulated by deamat's twin"
licence = "CC BY 4.0"
source = "simulated about the properties that Sikulskyi et al. 2022 print (Front. Robot. AI \
9:1034914, doi:10.3389/frobt.2022.1034914, CC BY)"
synthetic = true
note = "SYNTHETIC: every file here is simulated (deamat simulate --seed {seed}); none is a \
measurement. Tension is written in another maker's export form than compression on purpose."
"""


def simulate(out: Path, seed: int, truth_out: Path | None = None) -> Path:
    """Write a simulated campaign into `out`, and what is true of it to a file elsewhere.

    Parameters
    ----------
    out : folder of campaigns, made if it is not there
    seed : of all random streams; the same seed gives the same bytes
    truth_out : JSON file for the true values, the drawn errors and every specimen's own values;
        None writes no truth

    Returns
    -------
    Path : the campaign's folder

    Raises
    ------
    ConfigError : the campaign is there already, the seed is negative, or the truth would lie in
        `out`, where a reader of the campaign could find it
    """
    if truth_out is not None and truth_out.resolve().is_relative_to(out.resolve()):
        raise ConfigError(
            f"the truth must not lie among the raw files: {truth_out} is inside {out}; name a "
            "file outside it"
        )
    campaign = write_campaign(out, seed)
    if truth_out is not None:
        write_atomically(truth_out, truth_json(seed))
    return campaign


def write_campaign(out: Path, seed: int) -> Path:
    """Write a simulated campaign into a fresh folder under `out`, whole or not at all.

    Parameters
    ----------
    out : folder of campaigns, made if it is not there
    seed : of all random streams

    Returns
    -------
    Path : the campaign's folder

    Raises
    ------
    ConfigError : the campaign is there already, or the seed is negative
    """
    target = out / NAME
    if target.exists():
        raise ConfigError(
            f"{target} exists already and raw files are never overwritten; "
            "remove it or choose another folder"
        )
    contents = campaign_files(seed)
    with new_folder(target) as folder:
        for path, data in contents.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(data)
    return target


def campaign_files(seed: int) -> dict[str, bytes]:
    """Make all files of a campaign in memory: path relative to it to content."""
    contents = {"campaign.toml": _CAMPAIGN.format(seed=seed).encode()}
    for part in PARTS:
        contents = {**contents, **part(seed).files}
    return {**contents, "MANIFEST.sha256": manifest(contents)}


def truth_json(seed: int) -> bytes:
    """Write down what is true of a simulated campaign, in SI."""
    parts = [part(seed) for part in PARTS]
    document = {
        "campaign": NAME,
        "seed": seed,
        "synthetic": True,
        "note": SYNTHETIC,
        "values": [asdict(entry) for part in parts for entry in part.truth],
        "calibration_errors": {part.technique: asdict(part.calibration) for part in parts},
        "specimens": {name: dict(own) for part in parts for name, own in part.specimens.items()},
    }
    return (json.dumps(document, indent=1) + "\n").encode()
