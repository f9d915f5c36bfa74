"""Which distributions are installed: standard library only, and little of it: the no-op path."""

from __future__ import annotations

import json
import os
import sys

_ENDINGS = (".dist-info", ".egg-info")


def installed() -> str:
    """Name the Python and every installed distribution with its version, in order of the search.

    The names of the folders say so much: reading their metadata would take longer than a run with
    nothing to do. Not counted is this package itself, whose sources are looked at one by one.
    """
    names = [
        name
        for folder in dict.fromkeys(sys.path)
        for name in sorted(_names(folder))
        if name.endswith(_ENDINGS) and not name.startswith("deamat")
    ]
    return json.dumps([sys.implementation.cache_tag, sys.platform, *names])


def _names(folder: str) -> list[str]:
    try:
        with os.scandir(folder or ".") as entries:
            return [entry.name for entry in entries]
    except OSError:  # an archive, or a place that is not there
        return []
