"""Noise of a channel that is smooth but for it."""

from __future__ import annotations

import math

import numpy as np

from deamat.core.arrays import FloatArray


def noise_sd(values: FloatArray) -> float:
    r"""Standard deviation of independent noise on a smooth series, from its second differences.

    $1.4826 \operatorname{median} |v_{i-1} - 2 v_i + v_{i+1}| / \sqrt 6$; 0 of fewer than three.

    Parameters
    ----------
    values : in the order of sampling, shape (n,)
    """
    if values.size < 3:
        return 0.0
    return float(np.median(np.abs(np.diff(values, 2)))) * 1.4826 / math.sqrt(6.0)
