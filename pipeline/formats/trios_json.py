"""JSON of TA Instruments' TRIOS: steps of a rheometer's run as rows of named values.

Usage
-----
Named `trios_json`; detected by the address of its schema, `TRIOSJSONExportSchema`, near the top.

Format
------
`Results.Processed` holds `ResultsSteps` (`Id`, `Name`), `ColumnHeaders` (key to `DisplayName`,
`ValueType` and `Unit.Name`) and `Rows`, objects with a value for some of the keys, each of one
step. Exactly one step may hold what the technique needs in all of its rows; its unprocessed data
are not looked at. A column `Stress (step)` beside `Stress` is left out.

Columns
-------
`shear_rate_per_s [1/s]`, `viscosity_Pas [Pa.s]`, `shear_stress_Pa [Pa]`, `time_s [s]`,
`temperature_K [K]`, as far as the step has them in every row.

Uncertainties
-------------
None in the file.

Metadata
--------
`Sample`, `step`, `Date` (`StartTime`), `geometry`, `columns not used`. Lines are the rows of the
step, counted from 1 in `Rows`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.choice import Choice, choose
from deamat.formats.format import Format
from deamat.formats.plain_rows import Rows, recording_from
from deamat.formats.plain_tables import refused
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.structure import Heading
from deamat.formats.vocabulary import ASKED, meaning_among

_NAME, _SCHEMA = "trios_json", "TRIOSJSONExportSchema"
_TECHNIQUE = "viscosity"
_LARGEST = 1 << 53  # integers that a float holds
_OF_STEP = " (step)"
_AGAIN = "export it from TRIOS again, or as text"


@dataclass(frozen=True, slots=True)
class _Step:
    name: str
    first: int  # row, counted from 1
    rows: Sequence[Mapping[str, Any]]


def _recognises(head: Head) -> bool:
    return head[:1] != [] and head[0].lstrip().startswith("{") and any(_SCHEMA in x for x in head)


def _read(file: RawFile) -> Recording:
    document = _document(file)
    results = _part(file, document, "Results", "Processed")
    headers = _part(file, results, "ColumnHeaders")
    found: list[tuple[_Step, list[str], Choice]] = []
    nearest: Choice | None = None
    for step in _steps(file, results):
        keys = [key for key in headers if _is_whole(file, step, key, headers)]
        choice = choose(_heading(keys, headers), _TECHNIQUE)
        if not choice.faults:
            found.append((step, keys, choice))
        elif nearest is None or choice.labelled > nearest.labelled:
            nearest = choice
    if not found:
        error = refused(file, nearest)
        raise RawFileError(
            file.path, f"no step holds a flow curve in all of its rows: {error.reason}",
            hint="export the flow sweep with shear rate and viscosity or stress",
        )  # fmt: skip
    if len(found) > 1:
        names = ", ".join(step.name for step, _, _ in found)
        raise RawFileError(
            file.path, f"several steps hold a flow curve: {names}",
            hint="one file holds one run: export each step to a file of its own",
        )  # fmt: skip
    return _recording(file, document, *found[0])


def _recording(
    file: RawFile, document: Mapping[str, Any], step: _Step, keys: Sequence[str], choice: Choice
) -> Recording:
    values = {
        taken.name: np.array([row[keys[taken.column]] for row in step.rows], dtype=np.float64)
        for taken in choice.used
    }
    rows = Rows(values, {}, step.first, step.first + len(step.rows) - 1)
    said = {"Sample": _text(document, "Sample", "Name"), "step": step.name,
            "Date": _text(document, "StartTime")[:10]}  # fmt: skip
    metadata = {key: text for key, text in said.items() if text}
    recording = recording_from(file, choice, rows, file.encoding, metadata)
    return replace(recording, source=replace(recording.source, reader=_NAME))


def _document(file: RawFile) -> Mapping[str, Any]:
    try:
        document = json.loads(file.body)
    except json.JSONDecodeError as error:
        raise RawFileError(
            file.path, f"not whole JSON: {error.msg}", error.lineno, hint=_AGAIN
        ) from error
    except (ValueError, RecursionError) as error:
        raise RawFileError(file.path, "JSON that cannot be read", hint=_AGAIN) from error
    if not isinstance(document, dict):
        raise RawFileError(file.path, "JSON that is no export of TRIOS", 1, hint=_AGAIN)
    return document


def _part(file: RawFile, document: Mapping[str, Any], *path: str) -> Mapping[str, Any]:
    for key in path:
        inner = document.get(key)
        if not isinstance(inner, dict):
            raise RawFileError(file.path, f"no {'.'.join(path)} in the export", hint=_AGAIN)
        document = inner
    return document


def _text(document: Mapping[str, Any], *path: str) -> str:
    inner: Any = document
    for key in path:
        inner = inner.get(key, "") if isinstance(inner, dict) else ""
    return inner if isinstance(inner, str) else ""


def _steps(file: RawFile, results: Mapping[str, Any]) -> Iterator[_Step]:
    """The rows of each step, which stand under each other."""
    rows, steps = results.get("Rows"), results.get("ResultsSteps")
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise RawFileError(file.path, "no Results.Processed.Rows in the export", hint=_AGAIN)
    known = [step for step in steps if isinstance(step, dict)] if isinstance(steps, list) else []
    names = {_text(step, "Id"): _text(step, "Name") for step in known}
    at = 0
    while at < len(rows):
        step = _text(rows[at], "Results Step Id")
        end = at
        while end < len(rows) and _text(rows[end], "Results Step Id") == step:
            end += 1
        yield _Step(names.get(step, "") or f"row {at + 1}", at + 1, rows[at:end])
        at = end


def _heading(keys: Sequence[str], headers: Mapping[str, Any]) -> Heading:
    every = {_text(headers, key, "DisplayName") for key in headers}
    labels = [_text(headers, key, "DisplayName") for key in keys]
    shown = [
        "" if label.endswith(_OF_STEP) and label.removesuffix(_OF_STEP) in every else label
        for label in labels
    ]
    units = [_text(headers, key, "Unit", "Name") for key in keys]
    named = tuple(unit if label else "" for label, unit in zip(shown, units, strict=True))
    return Heading("\t", 0, 0, tuple(shown), named)


def _is_whole(file: RawFile, step: _Step, key: str, headers: Mapping[str, Any]) -> bool:
    """Say whether a column has a number in every row of a step.

    Raises
    ------
    RawFileError : a column that is asked for has one in some of them only: without its shear rate a
        flow curve would be taken for a viscosity over time
    """
    wrong = [at for at, row in enumerate(step.rows) if not _is_number(row.get(key))]
    label = _text(headers, key, "DisplayName")
    asked = meaning_among(label, ASKED[_TECHNIQUE].quantities)
    if asked and 0 < len(wrong) < len(step.rows):
        raise RawFileError(
            file.path, f"{label} of step {step.name} has no number in {len(wrong)} of "
            f"{len(step.rows)} rows", step.first + wrong[0],
            value=str(step.rows[wrong[0]].get(key))[:60], hint=_AGAIN,
        )  # fmt: skip
    return not wrong


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return math.isfinite(value) if isinstance(value, float) else abs(value) < _LARGEST


FORMAT = Format(
    _NAME,
    "TA Instruments TRIOS, JSON",
    _recognises,
    _read,
    techniques=(_TECHNIQUE,),
    looks="`TRIOSJSONExportSchema`, `ColumnHeaders`, `Rows`",
    seen="TA-Instruments/tadatakit, rheopy/rheofit",
)
