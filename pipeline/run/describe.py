"""Gathers what a run tells into one document."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, get_args

from deamat.core.ledger import FileEntry, Status
from deamat.run.flags import listed
from deamat.run.measure import Group, RunContext
from deamat.run.summary import DEPARTURES
from deamat.run.vanished import Published, vanished

FAILURE = 3  # the exit code of a run with an internal error


def describe(
    run: RunContext,
    groups: Sequence[Group],
    files: Sequence[FileEntry],
    ignored: Sequence[str],
    release: str,
    before: Published,
) -> dict[str, Any]:
    """Say what was read, fitted, refused and rejected, and whether all is well.

    Parameters
    ----------
    before : values of the release before, of which those that are gone are named
    """
    summaries = [g.summary for g in groups if g.summary]
    records = [r for s in summaries for r in s.records]
    laws = [law for s in summaries for law in s.laws]
    refusals = [r for s in summaries for r in s.refusals]
    excluded = [e for s in run.surveys for e in s.excluded]
    counts = Counter(f.status for f in files)
    return {
        "exit_code": FAILURE if run.failures else int(any(f.violates for f in files)),
        "raw": str(run.folders.raw),
        "campaigns": [
            {
                "name": s.campaign.name,
                "synthetic": s.campaign.info.synthetic,
                "specimens": len(s.specimens),
            }
            for s in run.surveys
            if s.campaign
        ],
        "ignored": list(ignored),
        "files": {status: counts[status] for status in get_args(Status)},
        "values": len(records),
        "materials": len({g.material for g in groups}),
        "refused": [
            {
                "material": r.material,
                "key": r.key,
                "campaign": r.campaign,
                "specimen": r.specimen,
                "reason": r.reason,
            }
            for r in refusals
        ],
        "flags": listed(records, laws),
        "default_limits": _default_limits(groups),
        "vanished": vanished(before, [*records, *laws], refusals, files, excluded),
        "waiting": _waiting(files),
        "rejected": [
            {"path": f.path, "line": f.line, "column": f.column, "reason": str(f)}
            for f in files
            if f.status == "rejected"
        ],
        "manifest": _manifest(files),
        "excluded": [
            *({"path": f.path, "reason": f.reason} for f in files if f.status == "excluded"),
            *(
                {"specimen": e.place, "reason": e.reason}
                for s in run.surveys
                for e in s.excluded
                if e.path is None
            ),
        ],
        "internal_errors": [asdict(failure) for failure in run.failures],
        "warnings": [],
        "redone": [str(r) for r in run.cache.redone],
        "redone_by_stage": Counter(r.stage for r in run.cache.redone),
        "release": release,
        "cards": str(run.folders.processed / "cards"),
    }


def _default_limits(groups: Sequence[Group]) -> list[dict[str, Any]]:
    """Name the instruments that no entry of the configuration matches, with their campaigns."""
    found: dict[str, dict[str, None]] = {}
    for group in groups:
        for measurement in group.measurements:
            if any(line.assumed for value in measurement.values for line in value.budget):
                stated = measurement.specimen.notes.get("instrument", "")
                found.setdefault(stated, {})[f"{group.campaign}/{group.technique}"] = None
    return [{"instrument": stated, "of": list(places)} for stated, places in found.items()]


def _waiting(files: Sequence[FileEntry]) -> list[dict[str, Any]]:
    """Files in folders that no technique is called after, counted by campaign."""
    counts = Counter(
        f"{'/'.join(f.path.split('/')[:2])}: {f.reason}"
        for f in files
        if f.status == "refused" and f.awaits is not None
    )
    return [{"reason": reason, "files": n} for reason, n in sorted(counts.items())]


def _manifest(files: Sequence[FileEntry]) -> list[dict[str, Any]]:
    """What departs from each campaign's manifest and is not excluded."""
    found: dict[str, dict[str, Any]] = {}
    for f in files:
        if f.manifest == "ok" or f.status == "excluded":
            continue
        campaign, _, name = f.path.partition("/")
        entry = found.setdefault(
            campaign, {"campaign": campaign, **{kind: [] for kind in DEPARTURES}}
        )
        entry[f.manifest].append(name)
    return [found[campaign] for campaign in sorted(found)]
