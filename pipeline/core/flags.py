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

# One line each, in alphabetical order.
SEVERITY_OF: dict[str, Severity] = {
    "adhesion": "serious",
    "another-tip-fits-better": "serious",
    "approximate-interval": "warning",
    "calibration-after-test": "warning",
    "calibration-expired": "warning",
    "calibration-not-dated": "info",
    "clean-again": "warning",
    "coarse-rounding": "warning",
    "coarse-sampling": "warning",
    "columns-not-used": "info",
    "conduction": "warning",
    "contact": "serious",
    "contradicting": "warning",
    "copied-rows": "serious",
    "counted-both-ways": "info",
    "current-spikes": "serious",
    "curved": "warning",
    "dates-disagree": "serious",
    "deep-indentation": "warning",
    "displacement-zeroed": "warning",
    "edge-field": "info",
    "electrode-aspect": "info",
    "electrode-polarisation": "serious",
    "end-unsure": "warning",
    "equal-files": "serious",
    "extensometer": "warning",
    "extrapolated": "info",
    "falls": "warning",
    "fast-rise": "info",
    "few-failures": "warning",
    "few-independent-samples": "info",
    "field-as-given": "info",
    "file-of-another-specimen": "serious",
    "finite-height": "info",
    "flashover": "serious",
    "form-curved": "warning",
    "form-untested": "info",
    "grips": "warning",
    "header-disagrees": "warning",
    "height-unknown": "info",
    "held-channel": "serious",
    "held-to-shape": "warning",
    "hidden-rows": "warning",
    "high-start": "info",
    "id-of-another-material": "serious",
    "ideal-tip-area": "info",
    "identical-rows": "warning",
    "implausible": "serious",
    "interpolated": "info",
    "label-by-unit": "warning",
    "law-ends": "warning",
    "level-declared": "info",
    "loss-unresolved": "info",
    "low-frequency-rise": "warning",
    "low-outlier": "warning",
    "mac-roman": "info",
    "meter-limit": "info",
    "method-changed": "warning",
    "missing-rows": "warning",
    "mixed-tests": "serious",
    "near-name": "warning",
    "no-break": "info",
    "no-current-channel": "info",
    "no-ramp": "info",
    "not-in-every-reading": "warning",
    "not-one-viscosity": "warning",
    "not-positive": "warning",
    "not-recorded": "warning",
    "other-frequency": "info",
    "outlier": "warning",
    "outlying-point": "warning",
    "outlying-readings": "warning",
    "outside-torque-window": "warning",
    "over-range": "warning",
    "own-columns-disagree": "serious",
    "plate-friction": "warning",
    "poor-fit": "warning",
    "preload": "warning",
    "range-step": "serious",
    "rate-of-rise": "warning",
    "register-disagrees": "serious",
    "register-implausible": "serious",
    "register-outlier": "warning",
    "register-slip": "serious",
    "right-censored": "info",
    "runs-differ": "warning",
    "self-clearing": "serious",
    "series-resistance": "warning",
    "setting-changed": "warning",
    "settings-disagree": "warning",
    "several-loadings": "warning",
    "several-sweeps": "warning",
    "single-run": "info",
    "single-specimen": "info",
    "slack": "warning",
    "slip": "serious",
    "specimens-refused": "warning",
    "speed-disagrees": "serious",
    "squeezed-film": "warning",
    "starts-in-contact": "warning",
    "stopped-early": "warning",
    "survivors": "serious",
    "swapped-files": "serious",
    "systematic-misfit": "warning",
    "temperature-corrected": "warning",
    "temperature-drift": "warning",
    "tested-on-disagrees": "warning",
    "thickness-dependence": "warning",
    "thickness-under-force": "info",
    "time-not-increasing": "warning",
    "time-unit": "serious",
    "tip-not-rigid": "warning",
    "toe": "warning",
    "torque-not-recorded": "info",
    "trailing-zeros": "warning",
    "unit-contradiction": "serious",
    "unit-of-another-kind": "warning",
    "unregistered": "warning",
    "untared-load": "serious",
    "voltage-noise": "warning",
    "wide-interval": "warning",
    "wild-reading": "warning",
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
