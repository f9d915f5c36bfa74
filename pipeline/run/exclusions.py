"""Holds `config/exclusions.toml` against what there is: an exclusion of nothing is an error."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

from deamat.core.config import Exclusion
from deamat.core.errors import ConfigError
from deamat.run.survey import Survey


def insist_on_targets(
    exclusions: Iterable[Exclusion], surveys: Sequence[Survey], broken: Iterable[str]
) -> None:
    """Refuse exclusions that leave nothing out: a slip of the pen would keep a bad value.

    Parameters
    ----------
    broken : campaigns whose survey failed, of which nothing is known

    Raises
    ------
    ConfigError : an exclusion names no file and no row; the message says the nearest name
    """
    files = {path for survey in surveys for path in survey.entries}
    rows = {specimen.place for survey in surveys for specimen in survey.specimens}
    rows |= {excluded.place for survey in surveys for excluded in survey.excluded}
    unread = [f"{campaign}/" for campaign in broken]
    for survey in surveys:
        unread += _unread(survey)
    faults = []
    for exclusion in exclusions:
        known = files if exclusion.path is not None else rows
        target = exclusion.target
        if target in known or (exclusion.specimen and target.startswith(tuple(unread))):
            continue
        what = "no file" if exclusion.path is not None else "no specimen of a register"
        near = difflib.get_close_matches(target, sorted(known), n=1, cutoff=0.0)
        hint = f"nearest: {near[0]!r}" if near else "there is none"
        faults.append(f"{what} is called {target!r}; {hint}")
    if faults:
        raise ConfigError(f"exclusions.toml: {'; '.join(faults)}")


def _unread(survey: Survey) -> list[str]:
    """Name what rows of which nothing is known begin with: those of registers with bad rows."""
    return [
        path.rpartition("/")[0] + "/"
        for path, entry in survey.entries.items()
        if entry.status != "used" and entry.role in ("register", "campaign")
    ]
