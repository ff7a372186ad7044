"""Deflection of an elastic ring under a tooth after Sainsot, Velex and Duverger."""

from __future__ import annotations

import warnings

import numpy as np

from base import Array, RangeWarning

# rows L*, M*, P*, Q*; columns A to F of X = A/th^2 + B h^2 + C h/th + D/th + E h + F
_COEFFICIENTS = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
RADIUS_RATIO = (1.4, 7.0)
FOOT_ANGLE = (0.01, 0.12)


def sainsot_body(
    root_radius: float,
    bore_radius: float,
    foot_angle: float,
    load_angle: float | Array,
    height: float | Array,
    name: str = "gear",
) -> Array:
    """Deflection of the gear body along the load, times E b / F.

    cos^2 w {L (u/S)^2 + M (u/S) + P (1 + Q tan^2 w)}, S = 2 r_f theta_f; L, M, P, Q are fits in
    h = r_f / r_bore and theta_f.

    Parameters
    ----------
    root_radius, bore_radius : float
        r_f and the radius of the clamped bore [m].
    foot_angle : float
        theta_f, half angle between the feet of the tooth's fillets [rad].
    load_angle : float or (n,) array
        w, angle between the load and the normal to the tooth's centre line [rad].
    height : float or (n,) array
        u, height above the root circle at which the load crosses the centre line [m].
    name : str
        What the warning calls the gear.

    Returns
    -------
    array
        delta E b / F [-].

    Warns
    -----
    RangeWarning
        Outside 1.4 <= h <= 7 and 0.01 <= theta_f <= 0.12, for which the fits were made.

    References
    ----------
    P. Sainsot, P. Velex, O. Duverger, Contribution of gear body to tooth deflections - a new bidimensional
    analytical formula, Journal of Mechanical Design 126 (2004) 748-752, doi:10.1115/1.1758252.

    Examples
    --------
    >>> sainsot_body(33.5e-3, 16.75e-3, foot_angle=0.06, load_angle=0.35, height=3e-3)
    array(...)
    """
    h = root_radius / bore_radius
    for symbol, value, (low, high) in (("h", h, RADIUS_RATIO), ("theta_f", foot_angle, FOOT_ANGLE)):
        if not low <= value <= high:
            message = f"Sainsot's body: {name} has {symbol} = {value:.4g}, fitted for {low:g} to {high:g}"
            warnings.warn(message, RangeWarning, stacklevel=2)
    th = foot_angle
    L, M, P, Q = _COEFFICIENTS @ np.array([1.0 / th**2, h**2, h / th, 1.0 / th, h, 1.0])
    ratio = np.asarray(height) / (2.0 * root_radius * th)
    tangent = np.tan(load_angle)
    bracket = L * ratio**2 + M * ratio + P * (1.0 + Q * tangent**2)
    return np.asarray(np.cos(load_angle) ** 2 * bracket)
