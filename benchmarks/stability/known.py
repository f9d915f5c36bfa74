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
    "quantile lies below all of them; the card says `extrapolated`, as on sound samples too"
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
_KNOWN: dict[tuple[str, str], str] = {
    ("Weibull", "at half strength"): _WEAK,
    ("Weibull", "one weak specimen"): _WEAK,
    ("Weibull", "lognormal truth"): _FORM,
    ("Weibull", "3-parameter truth"): _FORM,
    ("polynomial of chosen order", "noise [Pa s]"): (
        "noise hides the higher orders; the interval is that of the law chosen and does not know "
        "that another one might be right"
    ),
    ("polynomial of chosen order", "three clusters, half width [h]"): (
        "there are no readings between the clusters: the simplest law through them fits, and "
        "nothing says that it is wrong elsewhere"
    ),
    ("polynomial of chosen order", "readings"): "six readings do not carry the quartic they are of",
    ("nonlinear model", "second decay"): (
        "one decay with another rate and constant takes its place but for residuals below the noise"
    ),
    ("power law", "readings at half"): _MAJORITY,
    ("power law", "noise of full scale"): (
        "which error model holds must be declared; few readings are small enough to show it"
    ),
    ("compression", "readings at half force"): _MAJORITY,
    ("compression", "toe up to strain"): (
        "the zero of the tangent lies inside the toe, whose end is then still in the window; the "
        "flag `toe` stands on the plain modulus"
    ),
    ("linear model", "values at half"): _MAJORITY,
    ("mean", "lognormal"): "three to five specimens do not show skew; no value is extreme yet",
    ("mean", "undeclared batch error"): (
        "values that share an error agree with each other: only a second batch could show it"
    ),
    **{(key, "readings at half value"): _MAJORITY for key in _POLYNOMIALS},
    **{(key, "correlation"): _CORRELATED for key in _POLYNOMIALS},
    **{(key, "noise grows by"): _GROWING for key in _POLYNOMIALS},
    **{(key, "oscillation [Pa s]"): _HIDDEN for key in _POLYNOMIALS},
}


def reason_for(cell: Cell) -> str | None:
    """Give the reason why a cell may be silently wrong, or None if it may not."""
    return _KNOWN.get((cell.estimator, cell.failure))
