r"""What ions do to a sweep towards low frequency: polarised electrodes, and conduction.

Ions that pile up before electrodes which they cannot cross add to the capacitance a power of the
frequency, with a loss that rises alike:

$$ C' = (c_0 + c_1 \ln f)\,\big(1 + E\,(f/f_0)^{-s}\big), \qquad 0.5 < s \le 2, $$

on top of a film that itself depends on ln f but weakly. Ions that pass leave C' as it is and add
$D \propto 1/f$.

Source: F. Kremer, A. Schoenhals (eds.), Broadband Dielectric Spectroscopy, Springer 2003, chapter
3.4 for the power law of electrode polarisation; A. Serghei et al., Phys. Rev. B 80 (2009) 184301.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray

_EXPONENTS = np.arange(5, 21) / 10.0
_DECADES = 3.2  # above the frequency asked for
_FEWEST, _FEWEST_OF_ALL = 6, 3  # points for a fit with its scatter, and for an estimate
_LEAST = 0.01  # rise over the first decade, below which nothing is fitted
_TOLD = 5.0  # standard errors
_LOSS_WITH_IT = 0.1  # of the rise, at least, that the loss rises by over a decade
_MOST = 0.6  # of the loss
_STEEPER = 2.0  # times the rise over the next decade: as f^-0.3 and steeper
_NEAR_DECADES = 0.05
_CLOSE = 0.99  # squared correlation of the loss with 1/f


@dataclass(frozen=True, slots=True)
class Rise:
    """A rise of the capacitance by a power of the frequency.

    Parameters
    ----------
    height : E at the frequency asked for, relative to the film `[1]`
    exponent : s
    reference_Hz : the frequency asked for, f_0
    """

    height: float
    exponent: float
    reference_Hz: float

    def at(self, frequency_Hz: float) -> float:
        """Relative rise at another frequency `[1]`."""
        return self.height * math.pow(frequency_Hz / self.reference_Hz, -self.exponent)


def polarisation(
    frequency_Hz: FloatArray, capacitance_F: FloatArray, loss: FloatArray, at_Hz: float
) -> Rise | None:
    """Find a rise of capacitance and loss together towards a low frequency.

    Parameters
    ----------
    frequency_Hz : rising, shape (n,)
    capacitance_F, loss : C' and D, shape (n,) each
    at_Hz : frequency of the value that it would distort

    Returns
    -------
    None where there is no such rise, where it is not told from the scatter or from a film whose
    permittivity depends on ln f, or where fewer than three points lie in the three decades above;
    with fewer than six there is no scatter to tell it from
    """
    x = np.log(frequency_Hz / at_Hz)
    used = (x > -1e-2) & (x < _DECADES * math.log(10.0))
    x, c, d = x[used], capacitance_F[used] / capacitance_F.max(), loss[used]
    if x.size < _FEWEST_OF_ALL:
        return None
    decade = min(int(np.searchsorted(x, math.log(10.0) - 1e-2)), x.size - 1)
    rise = float(c[0] / c[decade]) - 1.0
    more_loss = float(d[0] * c[0] / c[decade] - d[decade])  # of C'', as the rise is of C'
    if rise < _LEAST or more_loss < _LOSS_WITH_IT * rise:
        return None
    height, u, exponent = _fit(x, c) if x.size >= _FEWEST else _of_three(x, c)
    told = height > _TOLD * u and exponent > _EXPONENTS[0]  # a slower rise is a relaxation's
    return Rise(height, exponent, at_Hz) if told else None


def steepening(
    frequency_Hz: FloatArray, capacitance_F: FloatArray, loss: FloatArray, at_Hz: float
) -> tuple[float, float]:
    """Return by how much C' rises over the decade above a frequency, and over the next one `[1]`.

    Both zero unless C'' rises with it, the first is twice the second at least (a permittivity that
    depends on ln f rises by as much in either), and the sweep reaches over both.

    Parameters
    ----------
    frequency_Hz : rising, shape (n,)
    capacitance_F, loss : C' and D, shape (n,) each
    at_Hz : where the first decade begins
    """
    x = np.log10(frequency_Hz / at_Hz)
    if x[0] > _NEAR_DECADES or x[-1] < 2.0 - _NEAR_DECADES:
        return 0.0, 0.0
    c = np.interp([0.0, 1.0, 2.0], x, capacitance_F)
    lossy = np.interp([0.0, 1.0], x, capacitance_F * loss)
    first, second = float(c[0] / c[1]) - 1.0, float(c[1] / c[2]) - 1.0
    together = float(lossy[0] - lossy[1]) > _LOSS_WITH_IT * first * float(c[1])
    return (first, second) if together and first > _STEEPER * max(second, 0.0) else (0.0, 0.0)


def _of_three(x: FloatArray, c: FloatArray) -> tuple[float, float, float]:
    """Height and exponent of the law without ln f through the first three of few points."""
    first, second = float(c[0] - c[1]), float(c[1] - c[2])
    s = 2.0 if second <= 0.0 else math.log(max(first / second, 1e-9)) / float(x[1] - x[0])
    s = min(max(s, float(_EXPONENTS[0])), float(_EXPONENTS[-1]))
    height = first / (1.0 - math.exp(-s * float(x[1] - x[0])))
    return height / (float(c[0]) - height), 0.0, s


def _fit(x: FloatArray, c: FloatArray) -> tuple[float, float, float]:
    """Height E with its standard error, and the exponent that leaves least of c."""
    a = np.empty((_EXPONENTS.size, x.size, 3))
    a[:, :, 0], a[:, :, 1] = 1.0, x
    a[:, :, 2] = np.exp(-_EXPONENTS[:, None] * x)
    basis, triangle = np.linalg.qr(a)
    along = basis.transpose(0, 2, 1) @ c
    squares = np.maximum(float(c @ c) - np.square(along).sum(axis=1), 0.0)
    best = int(squares.argmin())
    found = np.linalg.solve(triangle[best], along[best])
    own = abs(1.0 / float(triangle[best, 2, 2]))
    level = max(float(found[0]), 1e-300)
    u = own * math.sqrt(float(squares[best]) / (x.size - 3))
    return float(found[2]) / level, u / level, float(_EXPONENTS[best])


def conducted(frequency_Hz: FloatArray, loss: FloatArray, at_Hz: float) -> float:
    """Return the part of a loss that falls as 1/f over the decade above, if it is most of it `[1]`.

    Parameters
    ----------
    frequency_Hz : rising, shape (n,)
    loss : D, shape (n,)
    at_Hz : where the decade begins

    Returns
    -------
    zero where it is less than 60 % of the loss, or where the loss does not follow 1/f
    """
    used = (frequency_Hz > 0.99 * at_Hz) & (frequency_Hz < 10.1 * at_Hz)
    if np.count_nonzero(used) < 3:
        return 0.0
    x, y = at_Hz / frequency_Hz[used], loss[used]
    dx, dy = x - x.mean(), y - y.mean()
    along, squares = float(dx @ dy), float(dx @ dx)
    if along <= _MOST * squares * float(y[0]):
        return 0.0
    follows = along**2 > _CLOSE * squares * float(dy @ dy)
    return along / squares if follows else 0.0
