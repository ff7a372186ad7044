"""Local deflection of the flanks in closed form."""

from __future__ import annotations

import math
import warnings

import numpy as np

from base import Array, RangeWarning
from gears.closed_form.loaded_tooth import LoadedTooth, loaded_teeth
from gears.closed_form.record import ClosedForm
from gears.pair.gear_pair import GearPair
from gears.pair.hertz import NORMAL_FORCE, depth_compliance, half_width
from gears.pair.path import PathOfContact
from gears.tooth.errors import GeometryError

_DEEP = 4.0  # depth over half-width below which the far-field form of the approach errs by a per cent


def hertz(pair: GearPair, path: PathOfContact, force: float) -> ClosedForm:
    """Approach of the flanks to the centre lines of their teeth, the Hertz term of Weber and Banaschek.

    delta = 2 F (1 - nu^2) / (pi E b) [ln(4 t1 t2 / a^2) - nu / (1 - nu)] for equal materials, t the distance
    from the flank to the tooth's centre line along the load, a the Hertz half-width at the force F. The
    result is delta / F, a secant.

    Parameters
    ----------
    pair : GearPair
        The gears.
    path : PathOfContact
        Where the load acts.
    force : float
        F > 0, normal force on the pair of teeth [N].

    Returns
    -------
    ClosedForm
        Parts ``pinion`` and ``wheel``.

    Raises
    ------
    GeometryError
        If the force is not a finite positive number, or a point of the path is not on both involutes.

    Warns
    -----
    RangeWarning
        Where the contact is wider than a quarter of the depth.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> hertz(pair, pair.path_of_contact(3), force=10e3)
    ClosedForm(Hertz, 3 points, stiffness ... N/m, model error unknown)
    """
    first, second = contact_compliances(pair, path, force, loaded_teeth(pair, path))
    return ClosedForm("Hertz", {"pinion": first, "wheel": second})


def contact_compliances(
    pair: GearPair, path: PathOfContact, force: float, teeth: tuple[LoadedTooth, LoadedTooth]
) -> tuple[Array, Array]:
    """Compliances of the two flanks at a force, each (n,) [m/N]; see `hertz`."""
    if faults := NORMAL_FORCE.faults("force", force):
        raise GeometryError(faults)
    width = half_width(force / pair.face_width, path.radius, pair.reduced_modulus)
    shallowest = min(float(np.min(tooth.depth / width)) for tooth in teeth)
    if shallowest < _DEEP:
        message = (
            f"the contact is wide for the Hertz term: depth over half-width {shallowest:.2g} < {_DEEP:g}"
        )
        warnings.warn(message, RangeWarning, stacklevel=3)
    first, second = (
        depth_compliance(tooth.depth, width, material.plane_strain_modulus, material.poisson_ratio)
        / pair.face_width
        for tooth, material in zip(teeth, pair.materials, strict=True)
    )
    return first, second


def constant_contact_compliance(tooth: LoadedTooth, face_width: float) -> Array:
    """Compliance of a flank independent of the force, 2 (1 - nu^2) / (pi E b), (n,) [m/N].

    Half of 4 (1 - nu^2) / (pi E b), which Yang and Sun give for a pair of equal materials.
    """
    return np.full_like(tooth.rho, 2.0 / (math.pi * tooth.material.plane_strain_modulus * face_width))
