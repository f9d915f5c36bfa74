"""Names that exports write against the names of their rows: a file under another specimen's row."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from deamat.core.flags import Flag
from deamat.core.recording import Specimen

_FEWEST = 4  # characters of a name that tells something: `3` or `S1` may count anything


def labels_against_rows(
    specimens: Sequence[Specimen], labels: Mapping[str, str]
) -> dict[str, list[Flag]]:
    """Find exports whose specimen's name is that of another row.

    Parameters
    ----------
    specimens : of one register
    labels : specimen to the name in its file, where there is one

    Returns
    -------
    flags by specimen
    """
    names = {_plain(s.id): s for s in specimens}
    files = {_plain(_stem(s.file)): s for s in specimens if s.file is not None}
    flags: dict[str, list[Flag]] = {}
    for specimen in specimens:
        label = _plain(labels.get(specimen.id, ""))
        if len(label) < _FEWEST or label in (_plain(specimen.id), _plain(_stem(specimen.file))):
            continue
        meant = names.get(label) or files.get(label)
        if meant is not None and meant is not specimen:
            said = f"the file calls its specimen {labels[specimen.id]!r}, which is {meant.id} of "
            said += f"{meant.material} in line {meant.line}"
            flags[specimen.id] = [Flag("file-of-another-specimen", said)]
    return flags


def _plain(text: str) -> str:
    return re.sub(r"[\W_]+", "", text.casefold())


def _stem(file: str | None) -> str:
    return (file or "").rpartition("/")[2].rpartition(".")[0]
