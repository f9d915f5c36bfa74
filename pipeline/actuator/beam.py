"""The multilayer beam: strain and curvature from the balance of force and moment.

Across the section the strain is `eps + kappa z`, and each layer pulls with
`sigma = Y (eps + kappa z - e)`, `e` its free in-plane strain. No net force and no net moment give
two equations; about the elastic centroid they come apart and each is solved by one division.

Positive curvature bends towards the first layer: an expanding film on top bends the strip down.

Source: Sikulskyi et al. 2022, Eqs. 5-13; Timoshenko 1925 for two layers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deamat.actuator.ranges import Reals, check, within
from deamat.actuator.stack import Orientation, Stack
from deamat.actuator.strain import InPlane, film_drive, in_plane_strain, thickness_strain
from deamat.core.errors import OutOfRange


@dataclass(frozen=True, slots=True, eq=False)
class Beam:
    """A section in equilibrium without weight; every number a scalar or an array over designs.

    Parameters
    ----------
    axial_stiffness_N : sum of `b Y t` `[N]`
    bending_stiffness_N_m2 : about the elastic centroid `[N.m2]`
    centroid_m : elastic centroid above the bottom face `[m]`
    elongation : strain of the centroid that the films cause `[1]`
    curvature_per_m : that the films cause, towards the first layer `[1/m]`
    mass_kg_m : mass of a metre of undeformed strip `[kg/m]`
    """

    axial_stiffness_N: Reals
    bending_stiffness_N_m2: Reals
    centroid_m: Reals
    elongation: Reals
    curvature_per_m: Reals
    mass_kg_m: Reals


def bend(
    stack: Stack,
    free_strains: Sequence[Reals],
    thickness_strains: Sequence[Reals] | None = None,
) -> Beam:
    """Solve force and moment equilibrium of a stack whose layers want to strain on their own.

    With `A_i = b_i Y_i t_i`, centre heights `z_i` and centroid `zc = sum A z / sum A`:
    `eps = sum A e / sum A`,
    `kappa = sum A e (z - zc) / sum A ((z - zc)^2 + t^2 / 12)`.

    Parameters
    ----------
    stack : layers as made
    free_strains : in-plane strain `e_i` each layer would take alone, 0 for one that only resists;
        that of a film under voltage, or of any other active material `[1]`
    thickness_strains : compression of each layer's thickness; none thins when left out `[1]`

    Raises
    ------
    OutOfRange : not one strain per layer, a strain outside `ranges.RANGES`

    Source: Sikulskyi et al. 2022, Eqs. 5-9, 12.
    """
    layers = stack.layers
    thinned = [0.0] * len(layers) if thickness_strains is None else list(thickness_strains)
    for name, strains in (("free_strains", free_strains), ("thickness_strains", thinned)):
        if len(strains) != len(layers):
            raise OutOfRange(
                f"{name} has {len(strains)} values; the stack has {len(layers)} layers"
            )
        for i, value in enumerate(strains):
            check("strain", value, f"layer {i + 1} ({layers[i].role})")

    t = [layer.thickness_m * (1.0 - s) for layer, s in zip(layers, thinned, strict=True)]
    pull = [layer.width_m * layer.modulus_Pa * t for layer, t in zip(layers, t, strict=True)]
    origin = _origin(stack)
    z = _centre_heights(t, origin)

    stiffness = _total(pull)
    forces = [a * e for a, e in zip(pull, free_strains, strict=True)]
    force = _total(forces)
    moment = _total([f * h for f, h in zip(forces, z, strict=True)], origin)
    centroid = _total([a * h for a, h in zip(pull, z, strict=True)], origin) / stiffness
    bending = _total(
        [
            a * ((h - centroid) * (h - centroid) + t * t * (1.0 / 12.0))
            for a, h, t in zip(pull, z, t, strict=True)
        ]
    )
    return Beam(
        axial_stiffness_N=stiffness,
        bending_stiffness_N_m2=bending,
        centroid_m=centroid + _total(t[:origin]) + 0.5 * t[origin],
        elongation=force / stiffness,
        curvature_per_m=(moment - centroid * force) / bending,
        mass_kg_m=_total([x.width_m * x.thickness_m * x.density_kg_m3 for x in layers]),
    )


def actuate(stack: Stack, voltage_V: Reals, in_plane: InPlane, thinning: bool = True) -> Beam:
    """Put every `de` layer of a stack under the same voltage.

    Parameters
    ----------
    stack : layers as made
    voltage_V : across each `de` layer `[V]`
    in_plane : rule of `strain.in_plane_strain`
    thinning : solve the films in their thinned configuration; otherwise the small-strain rung,
        with the nominal field and the thicknesses as made

    Raises
    ------
    OutOfRange : a voltage above pull-in, a stack without `de` layer
    MissingProperty : a `de` layer without permittivity or Poisson's ratio

    Source: Sikulskyi et al. 2022, Eqs. 4-9.
    """
    if all(layer.role != "de" for layer in stack.layers):
        raise OutOfRange("the stack has 0 de layers; a voltage needs at least one to act on")
    compression: list[Reals] = []
    expansion: list[Reals] = []
    for number, layer in enumerate(stack.layers, start=1):
        s: Reals = 0.0
        e: Reals = 0.0
        if layer.role == "de":
            permittivity, poisson_ratio = layer.dielectric()
            where = f"layer {number} (de)"
            s = film_drive(voltage_V, layer.thickness_m, layer.modulus_Pa, permittivity, where)
            if thinning:
                s = thickness_strain(s)
            e = in_plane_strain(s, poisson_ratio, in_plane)
        compression.append(s)
        expansion.append(e)
    return bend(stack, expansion, compression if thinning else None)


def weight(beam: Beam, orientation: Orientation) -> Reals:
    """Return the weight of a metre of the elongated strip; thinning moves no mass `[N/m]`."""
    return beam.mass_kg_m * orientation.gravity_m_s2 / (1.0 + beam.elongation)


def curvature(beam: Beam, x_m: Reals, length_m: Reals, orientation: Orientation) -> Reals:
    """Return the curvature along a strip that bends little, `kappa + w sin(a) (L - x)^2 / (2 B)`.

    Parameters
    ----------
    beam : from `bend` or `actuate`
    x_m : distance from the clamp, 0 to `length_m`; broadcasts against the designs `[m]`
    length_m : of the strip `[m]`
    orientation : `a` is its angle

    Raises
    ------
    OutOfRange : a position off the strip, a length outside `ranges.RANGES`

    Source: Sikulskyi et al. 2022, Eq. 9.
    """
    _check_position(x_m, length_m)
    load = weight(beam, orientation) * np.sin(orientation.angle_rad)
    lever = length_m - x_m
    return beam.curvature_per_m + load * lever * lever / (2.0 * beam.bending_stiffness_N_m2)


def deflection(beam: Beam, x_m: Reals, length_m: Reals, orientation: Orientation) -> Reals:
    """Return the small-deflection shape, positive towards the first layer; else as `curvature`.

    `w(x) = kappa x^2 / 2 + w sin(a) (6 L^2 x^2 - 4 L x^3 + x^4) / (24 B)` `[m]`

    Source: Sikulskyi et al. 2022, Eq. 10.
    """
    _check_position(x_m, length_m)
    load = weight(beam, orientation) * np.sin(orientation.angle_rad)
    sag = x_m * x_m * (6.0 * length_m**2 - 4.0 * length_m * x_m + x_m * x_m)
    own = 0.5 * beam.curvature_per_m * (x_m * x_m)
    return own + load * sag / (24.0 * beam.bending_stiffness_N_m2)


def displacement(beam: Beam, x_m: Reals, length_m: Reals) -> Reals:
    """Return how far the films push a point along the strip, `u(x) = eps x` `[m]` (Eq. 13)."""
    _check_position(x_m, length_m)
    return beam.elongation * x_m


def neutral_axis(beam: Beam, curvature_per_m: Reals) -> Reals:
    """Return the height above the bottom face at which nothing stretches, `zc - eps / kappa` `[m]`.

    It is infinite in a section that stretches without bending, and the centroid in one that does
    neither.

    Parameters
    ----------
    beam : from `bend` or `actuate`
    curvature_per_m : local curvature, with or without the part of the weight `[1/m]`

    Source: Sikulskyi et al. 2022, Eq. 7.
    """
    eps, kappa = np.broadcast_arrays(beam.elongation, curvature_per_m)
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.where(eps == 0.0, 0.0, np.divide(eps, kappa))
    return np.asarray(beam.centroid_m - shift)


def _origin(stack: Stack) -> int:
    # Heights counted from the middle of the driven part, and summed in pairs about it: what
    # mirrors itself there cancels exactly, so stiff electrodes cost a soft stack no digits.
    films = [i for i, layer in enumerate(stack.layers) if layer.role == "de"]
    return (films[0] + films[-1]) // 2 if films else 0


def _centre_heights(t: Sequence[Reals], origin: int) -> list[Reals]:
    heights: list[Reals] = [0.0] * len(t)
    for step in (1, -1):
        face: Reals = step * 0.5 * t[origin]
        i = origin + step
        while 0 <= i < len(t):
            heights[i] = face + step * 0.5 * t[i]
            face = face + step * t[i]
            i += step
    return heights


def _total(terms: Sequence[Reals], origin: int = 0) -> Reals:
    total: Reals = terms[origin] if terms else 0.0
    for i in range(1, len(terms)):
        pair = [terms[j] for j in (origin - i, origin + i) if 0 <= j < len(terms)]
        if pair:
            total = total + (pair[0] + pair[1] if len(pair) == 2 else pair[0])
    return total


def _check_position(x_m: Reals, length_m: Reals) -> None:
    check("length_m", length_m)
    # A tip that was computed may lie a rounding beyond the length
    within("x_m over length_m", x_m / length_m, 0.0, 1.0 + 1e-12, hint="it is off the strip")
