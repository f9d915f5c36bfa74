"""`deamat audit`: every raw file hashed again and accounted for exactly once."""

from __future__ import annotations

import json
import os
from collections import Counter
from dataclasses import asdict
from typing import Any

from deamat.core.errors import PipelineError
from deamat.core.ledger import FileEntry
from deamat.run import last_run, run_all
from deamat.run.folders import Folders, look


def audit(folders: Folders) -> dict[str, Any]:
    """Verify every hash, bring the results up to date and give the whole account.

    The document holds `exit_code`, `files` (one entry each) and `unaccounted`, which must be empty.
    Where nothing can be written the account is that of the last run, and `stale` what is not up to
    date in it.

    Raises
    ------
    PipelineError : there is no account, and none can be written
    """
    processed = folders.processed
    if processed.is_dir() and not os.access(processed, os.W_OK):
        document, stale = last_run(folders)
        if "release" not in document:
            raise PipelineError(f"there is no account in {processed}, and none can be written")
    else:
        document, stale = run_all(folders, 1, lambda *_: None, verify=True), []
    account = folders.processed / "audit" / "files.json"
    if not account.is_file():
        raise PipelineError(f"the last run could not write {account}; `deamat all` says why")
    entries = [FileEntry(**entry) for entry in json.loads(account.read_bytes())]
    campaigns = {c["name"] for c in document["campaigns"]}
    there = {
        path.removeprefix("raw/")
        for path in look(folders)
        if path.startswith("raw/") and path.split("/")[1] in campaigns
    }
    counts = Counter(e.path for e in entries)
    return {
        "exit_code": document["exit_code"] or int(bool(stale)),
        "release": document["release"],
        "files": [asdict(e) for e in entries],
        "manifest": document["manifest"],
        "internal_errors": document["internal_errors"],
        "warnings": document["warnings"],
        "stale": stale,
        "ignored": document["ignored"],
        "unaccounted": sorted(there - set(counts)),
        "twice": sorted(path for path, n in counts.items() if n > 1),
    }


def audit_text(document: dict[str, Any]) -> str:
    """Write the account as a page: what is wrong in full, what is right in counts."""
    entries = [FileEntry(**e) for e in document["files"]]
    counts = Counter((e.path.partition("/")[0], e.role, e.status) for e in entries)
    lines = [f"release {document['release']}: {len(entries)} files, each accounted for once", ""]
    lines += [
        f"{campaign:<28} {role:<10} {status:<9} {n:>5}"
        for (campaign, role, status), n in sorted(counts.items())
    ]
    for title, wanted in (
        ("rejected", [e for e in entries if e.status == "rejected"]),
        ("refused", [e for e in entries if e.status == "refused"]),
        ("excluded", [e for e in entries if e.status == "excluded"]),
        ("differs from the manifest", [e for e in entries if e.manifest != "ok"]),
    ):
        if wanted:
            lines += ["", f"{title}:", *(f"  {_line(e)}" for e in wanted)]
    if document["internal_errors"]:
        lines += ["", "internal errors:"]
        for e in document["internal_errors"]:
            lines += [f"  {e['stage']} {e['subject']} ({', '.join(e['files'])})"]
            lines += [f"    {line}" for line in (e["traceback"] or e["error"]).splitlines()]
    lines += [f"warning: {warning}" for warning in document["warnings"]]
    lines += [f"not up to date, and cannot be written: {line}" for line in document["stale"]]
    for what in ("unaccounted", "twice"):
        lines += [f"{what}: {path}" for path in document[what]]
    if document["ignored"]:
        lines += ["", f"ignored: {', '.join(document['ignored'])}"]
    return "\n".join(lines)


def _line(entry: FileEntry) -> str:
    said = str(entry).replace("\n", "\n  ")  # one line for each bad row
    return f"[{entry.manifest}] {said}" if entry.manifest != "ok" else said
