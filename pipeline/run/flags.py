"""The flags of a run, worst first, for the page that ends it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from deamat.core.flags import SEVERITIES, SEVERITY_OF, Flag
from deamat.core.records import Law, PropertyRecord


def listed(records: Iterable[PropertyRecord], laws: Iterable[Law]) -> list[dict[str, Any]]:
    """Say each flag of a material once, with the values that carry it; the worst come first."""
    found: dict[tuple[str, str, str], tuple[Flag, list[str]]] = {}
    entries: list[PropertyRecord | Law] = [*records, *laws]
    for entry in entries:
        for flag in entry.flags:
            place = (flag.name, entry.material, entry.campaign)
            found.setdefault(place, (flag, []))[1].append(entry.key)
    told = [
        {
            "severity": flag.severity,
            "name": name,
            "material": material,
            "campaign": campaign,
            "values": sorted(set(keys)),
            "detail": flag.detail,
        }
        for (name, material, campaign), (flag, keys) in found.items()
    ]
    order = {name: (SEVERITIES.index(worst), name) for name, worst in SEVERITY_OF.items()}
    return sorted(
        told,
        key=lambda f: (
            *order.get(str(f["name"]), (SEVERITIES.index("warning"), str(f["name"]))),
            str(f["material"]),
            str(f["campaign"]),
        ),
    )
