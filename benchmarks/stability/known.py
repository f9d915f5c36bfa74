"""Cells that are silently wrong and known to be: why nothing in the sample could tell.

Everything here is a limit that a user must know; the pages in docs/methods print them.
"""

from __future__ import annotations

from benchmarks.stability.cells import Cell

_WEAK = (
    "one weak specimen of five is found in a third of samples, and two or three hide one another: "
    "the sample cannot tell them from a wide population"
)
_FORM = (
    "samples this small do not tell the forms apart (20 of a lognormal: one in five), and the "
    "quantile lies below all of them; `extrapolated` says so, but stands on sound samples too"
)
_CORRELATED = (
    "a polynomial follows slow drift, and the rest of a short series looks independent; only a "
    "second series would show it"
)
_GROWING = (
    "the mean of the squares is right, their place is not; the sizes of the errors must be "
    "declared (`sigma`)"
)
_HIDDEN = "an amplitude like the noise's is lost in it, though the interval is narrower than that"
_MAJORITY = "wrong values that are many widen what the majority looks like, and hide one another"
_POLYNOMIALS = (
    "polynomial of given degree",
    "polynomial of chosen order",
    "non-decreasing polynomial",
)
_KNOWN: dict[tuple[str, str], tuple[str, tuple[str, ...]]] = {
    ("Weibull", "at half strength"): (_WEAK, ("1 of n", "2 of n", "3 of n")),
    ("Weibull", "one weak specimen"): (_WEAK, ("at 0.8", "at 0.7", "at 0.6", "at 0.3")),
    ("Weibull", "lognormal truth"): (_FORM, ("sd ln 0.05", "sd ln 0.15", "sd ln 0.5")),
    ("Weibull", "3-parameter truth"): (
        _FORM,
        tuple(f"starts at {part:g}" for part in (0.1, 0.3, 0.5, 0.7, 0.9)),
    ),
    ("polynomial of chosen order", "noise [Pa s]"): (
        (
            "noise hides the higher orders; the interval is that of the law chosen and does "
            "not know that another one might be right"
        ),
        ("1", "10"),
    ),
    ("polynomial of chosen order", "clusters of width [h]"): (
        (
            "there are no readings between the clusters: the simplest law through them fits, and "
            "nothing says that it is wrong elsewhere"
        ),
        ("0.01", "0.0001", "1e-06", "1e-08"),
    ),
    ("nonlinear model", "second decay"): (
        "one decay of another rate takes the place of two, but for residuals below the noise",
        ("0.3", "1"),
    ),
    ("power law", "readings at half"): (_MAJORITY, ("10 %", "30 %")),
    ("power law", "noise of full scale"): (
        "which error model holds must be declared; few readings are small enough to show it",
        ("0.1",),
    ),
    ("compression", "readings at half force"): (_MAJORITY, ("30 %",)),
    ("compression", "toe up to strain"): (
        (
            "the zero of the tangent lies inside the toe, whose end is then still in the window; "
            "the flag `toe` stands on the plain modulus"
        ),
        ("1 %",),
    ),
    ("nonlinear model", "values at half"): (_MAJORITY, ("30 %",)),
    ("linear model", "values at half"): (_MAJORITY, ("30 %",)),
    ("mean", "lognormal"): (
        "a few specimens do not show skew; no value is extreme yet",
        ("sd ln 0.5", "sd ln 1", "sd ln 2"),
    ),
    ("mean with limits", "lognormal, sd ln"): (
        "a few specimens do not show skew; no value is extreme yet",
        ("0.8",),
    ),
    ("mean", "undeclared batch error"): (
        "values that share an error agree with each other: only a second batch could show it",
        tuple(f"{part} % of variance" for part in (5, 20, 50, 80)),
    ),
    **{
        (key, "readings at half value"): (_MAJORITY, ("5 %", "10 %", "20 %"))
        for key in _POLYNOMIALS
    },
    **{
        (key, "correlation"): (_CORRELATED, ("0.2", "0.4", "0.6", "0.8", "0.95"))
        for key in _POLYNOMIALS
    },
    **{(key, "noise grows by"): (_GROWING, ("0.5", "1", "3", "9")) for key in _POLYNOMIALS},
    **{(key, "oscillation [Pa s]"): (_HIDDEN, ("0.01", "0.05", "1")) for key in _POLYNOMIALS},
}


def reason_for(cell: Cell) -> str | None:
    """Return the reason why a cell may be silently wrong, or None if it may not."""
    if (cell.estimator, cell.failure) not in _KNOWN:
        return None
    reason, settings = _KNOWN[cell.estimator, cell.failure]
    return reason if cell.setting in settings else None
