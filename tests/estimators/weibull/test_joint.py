from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.weibull.fit import fit, fit_batch
from deamat.estimators.weibull.joint import SCALE, SHAPE, correlations, of_quantile


def test_a_large_complete_sample_has_the_known_correlation() -> None:
    p = (np.arange(200_000) + 0.5) / 200_000
    x = 30e6 * (-np.log1p(-p)) ** (1.0 / 12.0)
    matrix = correlations(fit(x), x, [SCALE, SHAPE, SHAPE])
    assert matrix[0, 1] == pytest.approx(0.2570 / np.sqrt(1.1087 * 0.6079), abs=1e-3)
    assert matrix[1, 2] == pytest.approx(1.0)
    assert np.diagonal(matrix) == pytest.approx(1.0)


@pytest.mark.parametrize("failures", [30, 12])
def test_it_is_what_many_samples_show(failures: int) -> None:
    rng = np.random.default_rng(5)
    x = np.sort(rng.weibull(8.0, (4000, 30)), axis=1)
    censored = np.zeros(x.shape, dtype=bool)
    censored[:, failures:] = True
    x[:, failures:] = x[:, failures - 1 : failures]
    found = fit_batch(x, censored)
    b10 = found.scale * 0.10536 ** (1.0 / found.shape)
    estimates = [np.log(found.scale), -1.0 / found.shape, np.log(b10)]
    seen = np.corrcoef(estimates)
    gradients = [SCALE, SHAPE, of_quantile(0.1)]
    each = [
        correlations(fit(one, left), one, gradients)
        for one, left in zip(x[:300], censored[:300], strict=True)
    ]
    assert np.mean(each, axis=0) == pytest.approx(seen, abs=0.08)
    assert (seen[0, 1] > 0.0) == (failures == 30)  # few failures turn the sign
