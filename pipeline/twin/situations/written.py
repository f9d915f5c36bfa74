"""Writes a situation as a small campaign, as the laboratory that has it would hand it over."""

from __future__ import annotations

import difflib
import json
from pathlib import Path

import numpy as np

from deamat.core.atomic import new_folder, write_atomically
from deamat.core.errors import ConfigError
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.situation import Made, Situation
from deamat.twin.writers import manifest

_CAMPAIGN = """\
title = "{told}"
laboratory = "none: simulated by deamat's twin"
licence = "CC0 1.0"
synthetic = true
note = "SYNTHETIC: every file here is simulated (deamat simulate --situation {name} --severity \
{severity:g} --seed {seed}); none is a measurement."
"""


def situation_named(name: str) -> Situation:
    """Find a situation on the one list.

    Raises
    ------
    ConfigError : there is none of this name
    """
    if name in SITUATIONS:
        return SITUATIONS[name]
    near = difflib.get_close_matches(name, SITUATIONS, n=3)
    hint = f"nearest: {', '.join(near)}" if near else "deamat simulate --list names them"
    raise ConfigError(f"no situation {name!r}; {hint}")


def make_situation(situation: Situation, severity: float, seed: int) -> Made:
    """Make one material in a situation; the same severity and seed make the same bytes."""
    rng = np.random.default_rng([seed, *situation.name.encode(), round(1e6 * severity)])
    return situation.make(rng, severity)


def situation_files(situation: Situation, severity: float, seed: int) -> dict[str, bytes]:
    """Make all files of a situation's campaign in memory: path relative to it to content."""
    return campaign_of(situation, severity, seed, make_situation(situation, severity, seed))


def write_situation(
    out: Path, situation: Situation, severity: float, seed: int, truth_out: Path
) -> Path:
    """Write a situation as a campaign of its name into `out`, and what is true of it elsewhere.

    Parameters
    ----------
    out : folder of campaigns, made if it is not there
    severity : 0 (no fault), or from the least to the greatest that the situation names
    truth_out : JSON file for the true value and what a short script says

    Returns
    -------
    Path : the campaign's folder

    Raises
    ------
    ConfigError : the campaign is there already, the seed is negative, the severity is not one of
        this situation
    """
    low, high = min(situation.severities), max(situation.severities)
    if severity != 0.0 and not low <= severity <= high:
        raise ConfigError(
            f"a severity of {severity:g} is none of {situation.name}: {situation.severity}, "
            f"0 (no fault) or {low:g} to {high:g}"
        )
    if seed < 0:
        raise ConfigError(f"the seed must be 0 or more, not {seed}")
    target = out / situation.name
    if target.exists():
        raise ConfigError(
            f"{target} exists already and raw files are never overwritten; "
            "remove it or choose another folder"
        )
    made = make_situation(situation, severity, seed)
    with new_folder(target) as folder:
        for path, data in campaign_of(situation, severity, seed, made).items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(data)
    write_atomically(truth_out, _truth(situation, severity, seed, made))
    return target


def campaign_of(situation: Situation, severity: float, seed: int, made: Made) -> dict[str, bytes]:
    """Put a material that was made into a campaign: path relative to it to content."""
    declared = _CAMPAIGN.format(
        told=situation.told, name=situation.name, severity=severity, seed=seed
    )
    contents = {
        "campaign.toml": declared.encode(),
        **{f"{situation.technique}/{path}": data for path, data in made.files.items()},
        **made.elsewhere,
    }
    return {**contents, "MANIFEST.sha256": manifest(contents)}


def _truth(situation: Situation, severity: float, seed: int, made: Made) -> bytes:
    document = {
        "campaign": situation.name,
        "severity": severity,
        "seed": seed,
        "synthetic": True,
        "note": SYNTHETIC,
        "key": situation.key,
        "conditions": dict(made.conditions),
        "value": made.truth,
        "a short script says": made.naive,
    }
    return (json.dumps(document, indent=1) + "\n").encode()


def listed() -> str:
    """List every situation with its severities, for people."""
    lines = []
    for name, situation in SITUATIONS.items():
        severities = ", ".join(f"{one:g}" for one in situation.severities)
        lines += [f"{name}  {situation.told}", f"    {situation.severity}: {severities}"]
    return "\n".join(lines)
