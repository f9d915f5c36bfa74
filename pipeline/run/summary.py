"""What a run tells: a document for programs, a page of text for people. Standard library only."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

_ALIKE = 4  # materials of which the same is said once
_LONG = 12  # more lines than this of one kind are counted, the rest is in `deamat audit`

DEPARTURES = ("changed", "missing", "extra", "extended")  # from a manifest


def text(document: Mapping[str, Any]) -> str:
    """Write the page that a lab engineer reads at the end of a run."""
    files = document["files"]
    lines = [
        (
            f"raw        {document['raw']}: {len(document['campaigns'])} campaigns, "
            f"{sum(files.values())} files"
        ),
        "files      " + ", ".join(f"{n} {status}" for status, n in files.items()),
    ]
    if document["ignored"]:
        lines.append(f"ignored    {', '.join(document['ignored'])} (no campaign.toml)")
    lines.append(
        f"values     {document['values']} of {document['materials']} materials, "
        f"{len(document['refused'])} refused"
    )
    lines += _some("refused", _refusals(document["refused"]))
    lines += _some("not read", [f"{w['reason']}: {w['files']} files" for w in document["waiting"]])
    lines += _some(
        "REJECTED", [line for r in document["rejected"] for line in r["reason"].split("\n")]
    )
    lines += _some("MANIFEST", [_violation(m) for m in document["manifest"]])
    lines += _internal(document)
    lines += _some("excluded", _excluded(document["excluded"]))
    lines += _some("warning", document["warnings"])
    lines += flag_lines(document["flags"])
    lines += _defaults(document["default_limits"])
    lines += _some("GONE", [_gone(value) for value in document["vanished"]])
    synthetic = [c["name"] for c in document["campaigns"] if c["synthetic"]]
    if synthetic:
        lines.append(f"SYNTHETIC  {', '.join(synthetic)}: simulated files, not measurements")
    lines.append(f"cards      {document['cards']}, release {document['release']}")
    return "\n".join(lines)


def redone(counts: Mapping[str, int]) -> str:
    """Say how much was redone of each stage."""
    if not counts:
        return "redone     nothing"
    return "redone     " + ", ".join(f"{n} {stage}" for stage, n in counts.items())


def _some(label: str, said: list[str]) -> list[str]:
    shown = [f"{label:<11}{line}" for line in said[:_LONG]]
    if len(said) > _LONG:
        shown.append(f"{'':<11}... and {len(said) - _LONG} more: deamat audit")
    return shown


def _excluded(excluded: Iterable[Mapping[str, Any]]) -> list[str]:
    return [f"{e.get('path') or e['specimen']}: {e['reason']}" for e in excluded]


def _defaults(found: Sequence[Mapping[str, Any]]) -> list[str]:
    """Say in one line which instruments have default limits, and what would settle it."""
    if not found:
        return []
    said = "; ".join(
        f"{one['instrument'] or 'no instrument stated'} ({', '.join(one['of'])})" for one in found
    )
    line = (
        f"limits     default limits of error for {said}: add [machines.NAME] with "
        '`match = "..."` to config/instruments.toml, or the column `instrument` to the register'
    )
    return [line]


def _gone(value: Mapping[str, Any]) -> str:
    """Name a value that the release before had."""
    under = f" ({value['conditions']})" if value["conditions"] else ""
    count = f", {value['lost']} of {value['of']}" if value["of"] > 1 else ""
    return (
        f"{value['material']} {value['key']}{under} of {value['campaign']}{count}: in the last "
        f"release, not in this one: {value['why']}"
    )


def _internal(document: Mapping[str, Any]) -> list[str]:
    """Say in one line that the program itself failed, over what, and where the traceback is."""
    errors = document["internal_errors"]
    if not errors:
        return []
    first = errors[0]
    more = f" and {len(errors) - 1} more" if len(errors) > 1 else ""
    line = (
        f"INTERNAL   {first['stage']} {first['subject']} ({first['error']}){more}: internal error, "
        "all the rest is published; traceback in processed/audit/internal_errors.json"
    )
    return [line]


def _refusals(refused: Iterable[Mapping[str, Any]]) -> list[str]:
    """Say each refused value of a material once, with the first specimen's reason."""
    groups: dict[tuple[str, str, str], list[Mapping[str, Any]]] = {}
    for refusal in refused:
        place = (refusal["campaign"], refusal["material"], refusal["key"])
        groups.setdefault(place, []).append(refusal)
    alike: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for (campaign, material, key), mine in groups.items():
        who = mine[0]["specimen"] or campaign
        more = f" and {len(mine) - 1} more" if len(mine) > 1 else ""
        alike.setdefault((key, mine[0]["reason"]), []).append((material, f"{who}{more}"))
    said = []
    for (key, reason), found in alike.items():
        if len(found) >= _ALIKE:
            said.append(f"{key} of {_several([m for m, _ in found])}: {reason}")
        else:
            said += [f"{material} {key} ({who}): {reason}" for material, who in found]
    return said


def _several(materials: Sequence[str]) -> str:
    """Count materials of which the same is to be said, and name the first ones."""
    more = ", ..." if len(materials) > _ALIKE else ""
    return f"{len(materials)} materials ({', '.join(materials[:_ALIKE])}{more})"


def flag_lines(flags: Sequence[Mapping[str, Any]]) -> list[str]:
    """Count the flags by severity; the serious ones in full, the others by name."""
    if not flags:
        return []
    counts = Counter(flag["severity"] for flag in flags)
    told = ", ".join(f"{n} {severity}" for severity, n in counts.items())
    lines = [f"flags      {told} (of a material each; `deamat card` has them in full)"]
    lines += _some("SERIOUS", _worst([f for f in flags if f["severity"] == "serious"]))
    for severity in counts:
        names = Counter(f["name"] for f in flags if f["severity"] == severity)
        if severity != "serious":
            lines.append(f"{severity:<11}" + ", ".join(f"{k} ({n})" for k, n in names.items()))
    return lines


def _worst(flags: Sequence[Mapping[str, Any]]) -> list[str]:
    """Say each serious flag in full; the same one of many materials once, with the first detail."""
    alike: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for flag in flags:
        alike.setdefault((flag["name"], ", ".join(flag["values"])), []).append(flag)
    said = []
    for (name, values), mine in alike.items():
        if len(mine) >= _ALIKE:
            who = _several([flag["material"] for flag in mine])
            first = f"{mine[0]['material']}: {mine[0]['detail']}"
            said.append(f"{values} of {who}: {name}: {first}")
        else:
            said += [f"{flag['material']} {values}: {name}: {flag['detail']}" for flag in mine]
    return said


def _violation(violation: Mapping[str, Any]) -> str:
    said = [
        f"{len(violation[kind])} {kind} ({', '.join(violation[kind][:3])}"
        + (", ...)" if len(violation[kind]) > 3 else ")")
        for kind in DEPARTURES
        if violation[kind]
    ]
    return (
        f"{violation['campaign']}: {'; '.join(said)}; "
        f"look at `deamat register {violation['campaign']}`"
    )
