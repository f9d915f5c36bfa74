"""A law as a model of lmfit: to be plotted, and fitted again to somebody's own readings."""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.laws import FORMS, coefficient_names, lower_bounds

if TYPE_CHECKING:
    import lmfit

    from deamat.core.records import Law


class _Function:
    """A form of `core.laws` as a function of x, the shear rate and its coefficients by name."""

    def __init__(
        self, kind: str, parts: Sequence[int], independent: Sequence[str], names: Sequence[str]
    ) -> None:
        self.__name__ = kind
        self._form, self._parts, self._names = FORMS[kind], parts, names
        by_name = inspect.Parameter.POSITIONAL_OR_KEYWORD
        self.__signature__ = inspect.Signature(
            [inspect.Parameter(argument, by_name) for argument in (*independent, *names)]
        )

    def __call__(
        self, x: FloatArray, rate_per_s: FloatArray | None = None, **coefficients: float
    ) -> FloatArray:
        c = np.array([coefficients[name] for name in self._names])
        times = np.asarray(x, dtype=np.float64)
        if rate_per_s is None:
            return self._form(c, times.ravel(), None, self._parts)[0].reshape(times.shape)
        times, rates = np.broadcast_arrays(times, np.asarray(rate_per_s, dtype=np.float64))
        return self._form(c, times.ravel(), rates.ravel(), self._parts)[0].reshape(times.shape)


def lmfit_model(law: Law) -> tuple[lmfit.Model, lmfit.Parameters]:
    """Make the model of a law and its parameters: see `core.records.Law.model`."""
    import lmfit  # costs seconds, so only whoever wants a model pays for it

    names = coefficient_names(law.kind, len(law.coefficients), law.parts)
    independent = ["x"] if law.rates is None else ["x", "rate_per_s"]
    function = _Function(law.kind, law.parts, independent, names)
    model = lmfit.Model(function, independent_vars=independent, param_names=list(names))
    bounds = lower_bounds(law.kind, law.valid)
    covariance = np.asarray(law.covariance)
    parameters = lmfit.Parameters()
    for i, (name, value) in enumerate(zip(names, law.coefficients, strict=True)):
        parameters.add(name, value=value, min=bounds.get(name, -math.inf))
        parameters[name].stderr = math.sqrt(covariance[i, i])
        parameters[name].correl = _correlations(names, covariance, i)
    return model, parameters


def _correlations(names: Sequence[str], covariance: FloatArray, i: int) -> Mapping[str, float]:
    """Correlation of one coefficient with each other one that is not known exactly."""
    return {
        name: float(covariance[i, j] / math.sqrt(covariance[i, i] * covariance[j, j]))
        for j, name in enumerate(names)
        if j != i and covariance[i, i] > 0 and covariance[j, j] > 0
    }
