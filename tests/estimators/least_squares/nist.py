"""The NIST reference problems: data, certified values, and the nonlinear models with Jacobians.

Each model takes the parameters b, shape (p,), and the columns x, and returns the prediction, shape
(n,), and the columns of its derivatives by b, shape (n,) each.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray

Model = Callable[[FloatArray, Mapping[str, FloatArray]], tuple[FloatArray, list[FloatArray]]]


def problems(kind: str) -> dict[str, dict[str, Any]]:
    """Read `linear` or `nonlinear` problems by name."""
    path = Path(__file__).parents[2] / "data" / "nist" / f"{kind}.toml"
    return tomllib.loads(path.read_text(encoding="utf-8"))


def predictors(problem: Mapping[str, Any]) -> dict[str, FloatArray]:
    """Columns x, x1, x2, ... of a problem."""
    return {k: np.array(v, dtype=float) for k, v in problem.items() if k[0] == "x"}


def digits(found: ArrayLike, certified: ArrayLike) -> float:
    """Fewest digits that agree, at most 15; a certified zero asks for small values."""
    a, c = np.asarray(found, dtype=float), np.asarray(certified, dtype=float)
    error = np.abs(a - c) / np.where(c == 0, 1.0, np.abs(c))
    return float(np.min(-np.log10(np.maximum(error, 1e-15))))


def bennett5(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    shifted = b[1] + d["x"]
    power = shifted ** (-1 / b[2])
    y = b[0] * power
    return y, [power, -y / (b[2] * shifted), y * np.log(shifted) / b[2] ** 2]


def misra1a(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    decay = np.exp(-b[1] * d["x"])
    grown = -np.expm1(-b[1] * d["x"])
    return b[0] * grown, [grown, b[0] * d["x"] * decay]


def misra1b(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    base = 1 + b[1] * d["x"] / 2
    return b[0] * (1 - base**-2), [1 - base**-2, b[0] * d["x"] * base**-3]


def misra1c(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    base = 1 + 2 * b[1] * d["x"]
    return b[0] * (1 - base**-0.5), [1 - base**-0.5, b[0] * d["x"] * base**-1.5]


def misra1d(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    base = 1 + b[1] * d["x"]
    return b[0] * b[1] * d["x"] / base, [b[1] * d["x"] / base, b[0] * d["x"] / base**2]


def chwirut(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x, base = d["x"], b[1] + b[2] * d["x"]
    y = np.exp(-b[0] * x) / base
    return y, [-x * y, -y / base, -x * y / base]


def danwood(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    power = d["x"] ** b[1]
    return b[0] * power, [power, b[0] * power * np.log(d["x"])]


def enso(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x = d["x"]
    turn = 2 * np.pi * x
    y = b[0] + b[1] * np.cos(turn / 12) + b[2] * np.sin(turn / 12)
    columns = [np.ones_like(x), np.cos(turn / 12), np.sin(turn / 12)]
    for period, cosine, sine in ((b[3], b[4], b[5]), (b[6], b[7], b[8])):
        c, s = np.cos(turn / period), np.sin(turn / period)
        y = y + cosine * c + sine * s
        columns += [(cosine * s - sine * c) * turn / period**2, c, s]
    return y, columns


def eckerle4(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    z = (d["x"] - b[2]) / b[1]
    bell = np.exp(-0.5 * z**2) / b[1]
    y = b[0] * bell
    return y, [bell, y * (z**2 - 1) / b[1], y * z / b[1]]


def gauss(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x = d["x"]
    decay = np.exp(-b[1] * x)
    y, columns = b[0] * decay, [decay, -x * b[0] * decay]
    for height, centre, width in (b[2:5], b[5:8]):
        z = (x - centre) / width
        bell = np.exp(-(z**2))
        y = y + height * bell
        columns += [bell, 2 * height * bell * z / width, 2 * height * bell * z**2 / width]
    return y, columns


def rational(
    above: int, below: int
) -> Callable[[FloatArray, Mapping[str, FloatArray]], tuple[FloatArray, list[FloatArray]]]:
    """Make (sum of `above` powers) / (1 + `below` powers from the first)."""

    def model(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
        x = d["x"]
        denominator = 1 + sum(b[above + k] * x ** (k + 1) for k in range(below))
        y = sum(b[k] * x**k for k in range(above)) / denominator
        numerator_columns = [x**k / denominator for k in range(above)]
        return y, numerator_columns + [-y * x ** (k + 1) / denominator for k in range(below)]

    return model


def lanczos(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x, y, columns = d["x"], np.zeros_like(d["x"]), []
    for k in (0, 2, 4):
        decay = np.exp(-b[k + 1] * x)
        y = y + b[k] * decay
        columns += [decay, -x * b[k] * decay]
    return y, columns


def mgh09(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x = d["x"]
    above, below = x**2 + x * b[1], x**2 + x * b[2] + b[3]
    y = b[0] * above / below
    return y, [above / below, b[0] * x / below, -y * x / below, -y / below]


def mgh10(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    shifted = d["x"] + b[2]
    growth = np.exp(b[1] / shifted)
    y = b[0] * growth
    return y, [growth, y / shifted, -y * b[1] / shifted**2]


def mgh17(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x = d["x"]
    first, second = np.exp(-x * b[3]), np.exp(-x * b[4])
    y = b[0] + b[1] * first + b[2] * second
    return y, [np.ones_like(x), first, second, -x * b[1] * first, -x * b[2] * second]


def nelson(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    fading = d["x1"] * np.exp(-b[2] * d["x2"])
    y = b[0] - b[1] * fading
    return y, [np.ones_like(fading), -fading, b[1] * d["x2"] * fading]


def rat42(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    growth = np.exp(b[1] - b[2] * d["x"])
    y = b[0] / (1 + growth)
    slope = y * growth / (1 + growth)
    return y, [1 / (1 + growth), -slope, slope * d["x"]]


def rat43(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    growth = np.exp(b[1] - b[2] * d["x"])
    power = (1 + growth) ** (-1 / b[3])
    y = b[0] * power
    slope = y * growth / (b[3] * (1 + growth))
    return y, [power, -slope, slope * d["x"], y * np.log1p(growth) / b[3] ** 2]


def roszman1(b: FloatArray, d: Mapping[str, FloatArray]) -> tuple[FloatArray, list[FloatArray]]:
    x = d["x"]
    away = x - b[3]
    y = b[0] - b[1] * x - np.arctan(b[2] / away) / np.pi
    below = np.pi * (away**2 + b[2] ** 2)
    return y, [np.ones_like(x), -x, -away / below, -b[2] / below]


MODELS: dict[str, Model] = {
    "Bennett5": bennett5,
    "BoxBOD": misra1a,
    "Chwirut1": chwirut,
    "Chwirut2": chwirut,
    "DanWood": danwood,
    "ENSO": enso,
    "Eckerle4": eckerle4,
    "Gauss1": gauss,
    "Gauss2": gauss,
    "Gauss3": gauss,
    "Hahn1": rational(4, 3),
    "Kirby2": rational(3, 2),
    "Lanczos1": lanczos,
    "Lanczos2": lanczos,
    "Lanczos3": lanczos,
    "MGH09": mgh09,
    "MGH10": mgh10,
    "MGH17": mgh17,
    "Misra1a": misra1a,
    "Misra1b": misra1b,
    "Misra1c": misra1c,
    "Misra1d": misra1d,
    "Nelson": nelson,
    "Rat42": rat42,
    "Rat43": rat43,
    "Roszman1": roszman1,
    "Thurber": rational(4, 3),
}
