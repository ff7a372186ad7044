"""What a film with heat does to its surroundings: friction, temperatures, and where its power goes."""

from __future__ import annotations

import math

import numpy as np

from base import Array
from ehl.discrete.thermal_oil import ThermalOil

_GAUSS = np.polynomial.legendre.leggauss(12)


def traction(oil: ThermalOil) -> float:
    """Mean shear stress over the load, positive where the first surface is the faster; of film and cavity."""
    return -(_along(oil, oil.shear.flow[:, 0]) + cavity(oil)) / oil.contact.load


def cavity(oil: ThermalOil) -> float:
    """Integral of the mean shear stress of the oil in the cavity [N/m].

    Behind the film's end oil fills the share h_e/h of the gap in streams from wall to wall, h_e the gap at the end. Its
    stress is that of a full gap there, at ambient pressure. Beyond the outlet the gap is a parabola.
    """
    end, gap, stress = oil.last + 1, oil.shear.gap, oil.shear.flow[:, 0]
    if end >= gap.size:
        return 0.0
    behind = stress[end:] * gap[end - 1] / gap[end:]
    x, h, radius = oil.x[-1], gap[-1], oil.contact.radius
    part = 0.5 * (_GAUSS[0] + 1.0)  # of x, beyond the outlet: the outlet's over it
    off = 2.0 * radius * h / x**2 - 1.0  # h = (x^2 + off x_o^2)/(2 R)
    beyond = (
        float(x) * (1.0 + float(off)) ** 2 * float(0.5 * _GAUSS[1] @ (part**2 / (1.0 + off * part**2) ** 2))
    )
    return float(behind @ oil.lengths[end:]) + float(behind[-1]) * beyond


def _along(oil: ThermalOil, values: Array) -> float:
    """Integrate values of cells along the film."""
    to = oil.last + 1
    return float(values[:to] @ oil.lengths[:to])


def rises(oil: ThermalOil) -> tuple[float, float]:
    """Maximum rise of the oil above the mean bulk temperature, and of a surface above its own [K]."""
    first, second = (float(np.max(oil.temperature[:, j]) - oil.bulk[j]) for j in (0, -1))
    return float(np.max(oil.temperature) - oil.bulk.mean()), max(first, second)


def rolling(oil: ThermalOil, P: Array) -> float:
    """Integral of h p'/2 [N/m]."""
    return float(0.5 * np.sum(oil.shear.gap * np.diff(P * oil.groups.pressure)))


def stresses(oil: ThermalOil, P: Array) -> Array:
    """Shear stress at both surfaces (n, 2) [Pa]; 0 behind the film."""
    tilt = 0.5 * oil.shear.gap * np.diff(P * oil.groups.pressure) / oil.lengths
    mean = oil.shear.flow[:, 0]
    stress = np.stack([mean - tilt, mean + tilt], axis=1)
    stress[oil.last + 1 :] = 0.0
    return oil.at_nodes(stress)


def losses(oil: ThermalOil) -> dict[str, float]:
    """Where the power of one metre of face goes [W/m]."""
    shear, weights = oil.shear, oil.across.weights
    made = shear.gap * ((shear.across * shear.rate) @ weights)
    streams = -cavity(oil) * oil.contact.sliding
    sheared = _along(oil, made) + streams
    sliding = -_along(oil, shear.flow[:, 0]) * oil.contact.sliding + streams
    if oil.solids is None:
        held = dict.fromkeys(("compression", "first_body", "second_body", "oil", "closure"), math.nan)
        return {"dissipation": sheared, "sliding": sliding, "rolling": sheared - sliding} | held
    made[oil.first :] = 0.0
    compression = (
        _along(oil, shear.gap * ((shear.speed * oil.temperature) @ weights) * oil.gradient)
        * oil.contact.lubricant.expansion
    )
    first, second = (_along(oil, row) for row in oil.into)
    away = _along(oil, made) + _carried_off(oil) + streams
    return {
        "dissipation": sheared,
        "sliding": sliding,
        "rolling": sheared - sliding,
        "compression": compression,
        "first_body": first,
        "second_body": second,
        "oil": away,
        "closure": (first + second + away) / (sheared + compression) - 1.0 if sheared > 0.0 else 0.0,
    }


def _carried_off(oil: ThermalOil) -> float:
    """Heat that leaves with the oil at both ends of the cells where it is followed [W/m].

    Oil enters at the undisturbed temperature and runs back at that of the first cell. All of it counts from the mean
    bulk temperature: between surfaces of other temperatures the undisturbed oil carries heat too, which changes along
    the gap with the profile of the flow.
    """
    k, T, mean = oil.last, oil.temperature, oil.bulk.mean()
    near = oil.lengths[k] / (oil.lengths[k] + oil.lengths[k - 1])
    behind = T[k] + near * (T[k] - T[k - 1])
    ahead = np.where(oil.carried[oil.first] < 0.0, T[oil.first], oil.undisturbed)
    off = oil.carried[k + 1] * (behind - mean) - oil.carried[oil.first] * (ahead - mean)
    return float(off @ oil.across.weights)
