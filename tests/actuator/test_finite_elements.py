"""The composite beam against plane-stress finite elements, where scikit-fem is installed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from deamat.actuator.beam import bend

from .stacks import strip

skfem = pytest.importorskip("skfem", reason="scikit-fem is not installed")

STRAIN, POISSON_RATIO, LENGTH_m = 0.006, 0.49, 0.05


def test_a_four_layer_strip_bends_as_quadratic_elements_do() -> None:
    """Ten by four biquadratic elements in plane stress; the film strains along the strip only.

    The left edge is a plane of symmetry; the curvature is read off the bottom face, away from the
    free end, where the layers shear.
    """
    layers = strip().layers
    heights = np.concatenate([[0.0], np.cumsum([float(np.asarray(x.thickness_m)) for x in layers])])
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0, LENGTH_m, 11), heights)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=4)
    which = np.searchsorted(heights, mesh.p[1, mesh.t].mean(axis=0)) - 1
    modulus = np.array([float(np.asarray(x.modulus_Pa)) for x in layers])[which][:, None]
    free = np.array([STRAIN if x.role == "de" else 0.0 for x in layers])[which][:, None]

    def stress(exx: Any, eyy: Any, exy: Any, y: Any) -> tuple[Any, Any, Any]:
        stiff = y / (1 - POISSON_RATIO**2)
        sxx = stiff * (exx + POISSON_RATIO * eyy)
        return sxx, stiff * (eyy + POISSON_RATIO * exx), y / (1 + POISSON_RATIO) * exy

    def strain(u: Any) -> tuple[Any, Any, Any]:
        return u.grad[0][0], u.grad[1][1], 0.5 * (u.grad[0][1] + u.grad[1][0])

    def stiffness(u: Any, v: Any, w: Any) -> Any:
        s, e = stress(*strain(u), w.y), strain(v)
        return s[0] * e[0] + s[1] * e[1] + 2 * s[2] * e[2]

    def load(v: Any, w: Any) -> Any:
        s, e = stress(w.free, 0 * w.free, 0 * w.free, w.y), strain(v)
        return s[0] * e[0] + s[1] * e[1]

    fields = {"y": modulus * np.ones_like(basis.dx), "free": free * np.ones_like(basis.dx)}
    x, y = basis.doflocs
    along = np.unique(basis.get_dofs(lambda p: p[0] < 1e-12).all("u^1"))
    bottom = np.flatnonzero(y < 1e-12)
    across = np.setdiff1d(bottom, np.concatenate([along, basis.get_dofs().all("u^1")]))
    corner = across[np.argmin(x[across])]
    fixed = np.concatenate([along, [corner]])
    solution = skfem.solve(
        *skfem.condense(
            skfem.BilinearForm(stiffness).assemble(basis, **fields),
            skfem.LinearForm(load).assemble(basis, **fields),
            D=fixed,
        )
    )
    near, middle, far = (
        solution[across[np.argmin(np.abs(x[across] - at * LENGTH_m))]] for at in (0.0, 0.3, 0.6)
    )
    # Positive curvature bends down, towards the first layer
    curvature = -(far - 2 * middle + near) / (0.3 * LENGTH_m) ** 2
    expected = bend(strip(), [0, 0, STRAIN, 0]).curvature_per_m
    assert curvature == pytest.approx(expected, rel=1e-4)
