"""Line contact of two elastic bodies after Hertz."""

from __future__ import annotations

import math

import numpy as np

from base import Array, Limit

HERTZ = "not estimated: Hertz's law of the contact's force, whose error is not known in single positions"
"""Why pressures and widths of single contacts have no error."""

NORMAL_FORCE = Limit.above(0.0, unit="N", remedy="give the normal force on the pair of teeth")
"""What the force between two teeth may be."""


def half_width(load: float | Array, radius: float | Array, reduced_modulus: float) -> Array:
    """Half-width of the contact, a = sqrt(8 w R / (pi E')).

    Parameters
    ----------
    load : float or (n,) array
        w, force per face width [N/m].
    radius : float or (n,) array
        R, radius of relative curvature [m].
    reduced_modulus : float
        E' = 2 / [(1 - nu1^2)/E1 + (1 - nu2^2)/E2] [Pa].

    Returns
    -------
    array
        a [m].

    Examples
    --------
    >>> 1e6 * half_width(4.4e5, radius=6.5e-3, reduced_modulus=226e9)
    179.5...
    """
    return np.asarray(np.sqrt(8.0 * np.asarray(load) * radius / (math.pi * reduced_modulus)))


def peak_pressure(load: float | Array, radius: float | Array, reduced_modulus: float) -> Array:
    """Largest pressure of the contact, p_H = 2 w / (pi a) = sqrt(w E' / (2 pi R)).

    Parameters
    ----------
    load : float or (n,) array
        w, force per face width [N/m].
    radius : float or (n,) array
        R, radius of relative curvature [m].
    reduced_modulus : float
        E' [Pa].

    Returns
    -------
    array
        p_H [Pa], also E' a / (4 R).

    Examples
    --------
    >>> 1e-9 * peak_pressure(4.4e5, radius=6.5e-3, reduced_modulus=226e9)
    1.56...
    """
    return np.asarray(np.sqrt(np.asarray(load) * reduced_modulus / (2.0 * math.pi * np.asarray(radius))))


def depth_compliance(
    depth: float | Array, half_width: float | Array, plane_strain_modulus: float, poisson_ratio: float
) -> Array:
    """Approach of a body's surface to a point below it, over the load per face width.

    delta / w = 2 / (pi E*) [ln(2 t / a) - nu / (2 (1 - nu))] for a half-plane in plane strain, t >> a:
    the difference of the displacements under a Hertz pressure at the surface and at the depth t. It is the
    Hertz term of Weber and Banaschek for one body.

    Parameters
    ----------
    depth : float or (n,) array
        t [m].
    half_width : float or (n,) array
        a > 0 [m].
    plane_strain_modulus : float
        E* = E / (1 - nu^2) [Pa].
    poisson_ratio : float
        nu [-].

    Returns
    -------
    array
        delta / w [m^2/N].
    """
    logarithm = np.log(2.0 * np.asarray(depth) / half_width)
    constant = 0.5 * poisson_ratio / (1.0 - poisson_ratio)
    return np.asarray(2.0 / (math.pi * plane_strain_modulus) * (logarithm - constant))
