"""The page that ends a run says everything once, and long lists shortly."""

from __future__ import annotations

from typing import Any

from deamat.run import summary

WELL: dict[str, Any] = {
    "raw": "raw",
    "campaigns": [
        {"name": "soft-2026", "synthetic": False, "specimens": 7},
        {"name": "twin-1", "synthetic": True, "specimens": 3},
    ],
    "ignored": [],
    "files": {"used": 12, "refused": 1, "rejected": 0},
    "values": 9,
    "materials": 2,
    "refused": [],
    "waiting": [],
    "rejected": [],
    "manifest": [],
    "internal_errors": [],
    "excluded": [],
    "warnings": [],
    "flags": [],
    "vanished": [],
    "default_limits": [],
    "cards": "processed/cards",
    "release": "0123abcd",
}


def refusal(specimen: str | None, key: str = "tensile_modulus") -> dict[str, Any]:
    place = {"campaign": "soft-2026", "material": "gel-a", "key": key}
    return {**place, "specimen": specimen, "reason": "2 samples, 10 are needed"}


def test_all_is_well() -> None:
    assert summary.text(WELL) == (
        """\
raw        raw: 2 campaigns, 13 files
files      12 used, 1 refused, 0 rejected
values     9 of 2 materials, 0 refused
SYNTHETIC  twin-1: simulated files, not measurements
cards      processed/cards, release 0123abcd"""
    )


def test_whatever_went_wrong_is_said_with_its_place() -> None:
    manifest = {
        "campaign": "soft-2026",
        "changed": ["a.csv", "b.csv", "c.csv", "d.csv"],
        "missing": ["e.csv"],
        "extra": [],
        "extended": ["tension/specimens.csv"],
    }
    error = {"stage": "figure", "subject": "soft-2026/moduli", "error": "RuntimeError: burst"}
    document = {
        **WELL,
        "campaigns": WELL["campaigns"][:1],
        "ignored": ["loose/", "old/"],
        "refused": [refusal("A1"), refusal("A2"), refusal(None, "tensile_strength")],
        "waiting": [{"reason": "soft-2026/dma: no technique is called 'dma'", "files": 4}],
        "rejected": [{"reason": "a.csv, line 3: not a number\na.csv, line 5: not a number"}],
        "manifest": [manifest],
        "internal_errors": [error],
        "excluded": [
            {"path": "soft-2026/x.csv", "reason": "the plate slipped"},
            {"specimen": "soft-2026/handling/bed-23", "reason": "the heater was off"},
        ],
        "warnings": ["a damaged cache was set aside"],
        "vanished": [
            {
                "material": "gel-a",
                "key": "tensile_modulus",
                "campaign": "soft-2026",
                "conditions": "2 months",
                "lost": 1,
                "of": 2,
                "why": "a.csv was removed",
            }
        ],
    }
    assert summary.text(document) == (
        """\
raw        raw: 1 campaigns, 13 files
files      12 used, 1 refused, 0 rejected
ignored    loose/, old/ (no campaign.toml)
values     9 of 2 materials, 3 refused
refused    gel-a tensile_modulus (A1 and 1 more): 2 samples, 10 are needed
refused    gel-a tensile_strength (soft-2026): 2 samples, 10 are needed
not read   soft-2026/dma: no technique is called 'dma': 4 files
REJECTED   a.csv, line 3: not a number
REJECTED   a.csv, line 5: not a number
MANIFEST   soft-2026: 4 changed (a.csv, b.csv, c.csv, ...); 1 missing (e.csv); """
        """1 extended (tension/specimens.csv); look at `deamat register soft-2026`
INTERNAL   figure soft-2026/moduli (RuntimeError: burst): internal error, all the rest is """
        """published; traceback in processed/audit/internal_errors.json
excluded   soft-2026/x.csv: the plate slipped
excluded   soft-2026/handling/bed-23: the heater was off
warning    a damaged cache was set aside
GONE       gel-a tensile_modulus (2 months) of soft-2026, 1 of 2: in the last release, """
        """not in this one: a.csv was removed
cards      processed/cards, release 0123abcd"""
    )
    twice = {**document, "internal_errors": [error, error]}
    assert "(RuntimeError: burst) and 1 more: internal error" in summary.text(twice)


def test_twelve_lines_of_a_kind_are_shown_and_the_rest_counted() -> None:
    for count, shown, last in ((12, 12, "warning    11"), (14, 13, "           ... and 2 more: ")):
        document = {**WELL, "warnings": [str(number) for number in range(count)]}
        lines = summary.text(document).splitlines()[3:-2]
        assert len(lines) == shown
        assert lines[-1].startswith(last)


def test_what_was_redone_is_counted_by_stage() -> None:
    assert summary.redone({}) == "redone     nothing"
    assert summary.redone({"measurement": 6, "card": 2}) == "redone     6 measurement, 2 card"


def test_the_same_of_many_materials_is_said_once() -> None:
    names = [f"gel-{letter}" for letter in "abcde"]
    refused = [{**refusal("A1"), "material": name} for name in names]
    flags = [
        {
            "severity": "serious", "name": "implausible", "material": name, "campaign": "soft-2026",
            "values": ["tensile_modulus"], "detail": f"{i} kPa",
        }
        for i, name in enumerate(names)
    ]  # fmt: skip
    page = summary.text({**WELL, "refused": refused, "flags": flags}).splitlines()
    who = "5 materials (gel-a, gel-b, gel-c, gel-d, ...)"
    assert f"refused    tensile_modulus of {who}: 2 samples, 10 are needed" in page
    assert f"SERIOUS    tensile_modulus of {who}: implausible: gel-a: 0 kPa" in page
    few = summary.text({**WELL, "refused": refused[:3], "flags": flags[:3]}).splitlines()
    assert "refused    gel-c tensile_modulus (A1): 2 samples, 10 are needed" in few
    assert "SERIOUS    gel-c tensile_modulus: implausible: 2 kPa" in few
