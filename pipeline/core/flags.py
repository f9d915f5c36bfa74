"""Flags: what a reader of a value must know, each with its severity from the one table of names."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Literal, Self

from deamat.core.kinds import Kind, named
from deamat.core.schema import Entry

# `serious`: the value, or what it is said to be of, is likely wrong beyond its interval.
# `warning`: it may be, or its interval is not to be relied on.
# `info`: a limit of what is known; the value and its interval are as good as they say.
Severity = Literal["serious", "warning", "info"]
SEVERITIES: tuple[Severity, ...] = ("serious", "warning", "info")

_SERIOUS = (
    "adhesion", "another-tip-fits-better", "contact", "copied-rows", "current-spikes",
    "dates-disagree", "equal-files", "file-of-another-specimen", "flashover",
    "id-of-another-material", "implausible", "mixed-tests", "own-columns-disagree",
    "register-disagrees", "register-implausible", "register-slip", "self-clearing", "slip",
    "speed-disagrees", "survivors", "swapped-files", "unit-contradiction", "untared-load",
)  # fmt: skip
_WARNING = (
    "approximate-interval", "clean-again", "coarse-rounding", "coarse-sampling", "contradicting",
    "cross-validation", "curved", "deep-indentation", "displacement-zeroed", "end-unsure",
    "extensometer", "falls", "few-failures", "few-independent-samples", "grips",
    "header-disagrees", "hidden-rows", "identical-rows", "label-by-unit", "law-ends", "low-outlier",
    "method-changed",
    "missing-rows", "not-in-every-reading", "not-one-viscosity", "not-positive", "outlier",
    "outlying-readings", "outside-torque-window", "over-range", "plate-friction", "poor-fit",
    "preload", "rate-of-rise", "register-outlier", "runs-differ", "series-resistance",
    "setting-changed", "settings-disagree", "several-loadings", "slack", "specimens-refused",
    "squeezed-film", "stopped-early", "tested-on-disagrees", "time-not-increasing",
    "tip-not-rigid", "toe", "trailing-zeros", "unit-of-another-kind", "unregistered",
    "voltage-noise", "wide-interval",
)  # fmt: skip
_INFO = (
    "columns-not-used", "counted-both-ways", "edge-field", "electrode-aspect", "extrapolated",
    "fast-rise",
    "field-as-given", "finite-height", "height-unknown", "high-start", "ideal-tip-area",
    "interpolated", "level-declared", "loss-unresolved", "mac-roman", "meter-limit", "no-break",
    "no-current-channel", "no-ramp", "right-censored", "single-run", "single-specimen",
    "thickness-under-force", "torque-not-recorded",
)  # fmt: skip

SEVERITY_OF: dict[str, Severity] = {
    **dict.fromkeys(_SERIOUS, "serious"),
    **dict.fromkeys(_WARNING, "warning"),
    **dict.fromkeys(_INFO, "info"),
}


@dataclass(frozen=True, slots=True)
class Flag:
    """Something a reader of the value must know; it changes no number."""

    ENTRY: ClassVar = Entry(
        "flag",
        "flags",
        as_text=named(
            "flag",
            Kind({"type": "string", "pattern": "^[^:]+: "}, "TEXT"),
            "What a reader of the value must know, as `name: detail`; no flag changes a number.",
        ),
    )

    name: str
    detail: str

    def __str__(self) -> str:
        return f"{self.name}: {self.detail}"

    @classmethod
    def from_text(cls, text: str) -> Self:
        """Read back what `str` gives."""
        return cls(*text.split(": ", 1))

    @property
    def severity(self) -> Severity:
        """Severity of its name in the one table; `warning` for a name that is not in it."""
        return SEVERITY_OF.get(self.name, "warning")


def merged(noticed: Iterable[tuple[str, Flag]], specimens: int) -> tuple[Flag, ...]:
    """Say each flag once, with who has it and the first one's numbers.

    Parameters
    ----------
    noticed : specimen and flag
    specimens : how many there are; of a single one its flags are kept as they are
    """
    pairs = list(noticed)
    if specimens == 1:
        return tuple(dict.fromkeys(flag for _, flag in pairs))
    found: dict[str, list[tuple[str, str]]] = {}
    for specimen, flag in pairs:
        found.setdefault(flag.name, []).append((specimen, flag.detail))
    flags = []
    for name, said in found.items():
        who = list(dict.fromkeys(specimen for specimen, _ in said))
        detail = f"{len(who)} of {specimens} specimens, such as {who[0]}: {said[0][1]}"
        flags.append(Flag(name, detail))
    return tuple(flags)
