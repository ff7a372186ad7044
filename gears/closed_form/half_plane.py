"""Tooth deflection after Weber and Banaschek: true profile, elastic half-plane as body, Hertz contact."""

from __future__ import annotations

import math

import numpy as np

from base import Array
from gears.closed_form.contact import contact_compliances
from gears.closed_form.loaded_tooth import LoadedTooth, loaded_teeth
from gears.closed_form.record import ClosedForm
from gears.pair.gear_pair import GearPair
from gears.pair.path import PathOfContact


def tooth_compliance(tooth: LoadedTooth, face_width: float) -> Array:
    """Compliance of the tooth from its root section to where the load crosses the centre line [m/N]."""
    nu = tooth.material.poisson_ratio
    top = tooth.crossing
    shear = 2.4 / (1.0 - nu) + np.tan(tooth.load_angle) ** 2

    def per_height(y: Array, x: Array) -> Array:
        width = 2.0 * x
        return np.asarray(12.0 * (top[:, None] - y) ** 2 / width**3 + shear[:, None] / width)

    modulus = tooth.material.plane_strain_modulus
    return np.asarray(
        np.cos(tooth.load_angle) ** 2 / (modulus * face_width) * tooth.integrate(per_height, top)
    )


def body_compliance(tooth: LoadedTooth, face_width: float) -> Array:
    """Compliance of the half-plane under the root section [m/N]."""
    nu = tooth.material.poisson_ratio
    foot, width = tooth.root_section
    u = (tooth.crossing - foot) / width
    axial = 1.0 + (1.0 - nu) / 2.4 * np.tan(tooth.load_angle) ** 2
    bracket = 18.0 / math.pi * u**2 + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * u + 4.8 / math.pi * axial
    modulus = tooth.material.plane_strain_modulus
    return np.asarray(np.cos(tooth.load_angle) ** 2 / (modulus * face_width) * bracket)


def weber_banaschek(pair: GearPair, path: PathOfContact, force: float) -> ClosedForm:
    """Single-pair deflection after Weber and Banaschek, in plane strain.

    With w the load angle, y_P the height at which the load crosses the centre line, x(y) the half width of
    the true profile above the chord between the feet of the fillets, s_F that chord, u = (y_P - y_F) / s_F:

    - tooth F cos^2 w (1 - nu^2) / (E b) {12 Int (y_P - y)^2 / (2x)^3 dy + (2.4 / (1 - nu) + tan^2 w)
      Int dy / (2x)}, both integrals from the chord to y_P,
    - body F cos^2 w (1 - nu^2) / (E b) {18/pi u^2 + 2 (1 - 2 nu) / (1 - nu) u + 4.8/pi (1 + (1 - nu) / 2.4
      tan^2 w)},
    - contact as in `hertz`, at the force F.

    For nu = 0.3 these are the coefficients 10.92, 3.1, 0.294 and 5.2, 1, 1.4 in which the formula is usually
    quoted. The gear body has no bore and no neighbouring teeth.

    Parameters
    ----------
    pair : GearPair
        The gears.
    path : PathOfContact
        Where the load acts, on both involutes.
    force : float
        F > 0, normal force on the pair of teeth [N]; only the contact depends on it.

    Returns
    -------
    ClosedForm
        Parts ``tooth``, ``body``, ``contact``; secant at the force.

    Raises
    ------
    GeometryError
        If the force is not a finite positive number, or a point of the path is not on both involutes.

    Warns
    -----
    RangeWarning
        Where the contact is wider than a quarter of the depth of the Hertz term.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> weber_banaschek(pair, pair.path_of_contact(9), force=10e3)
    ClosedForm(Weber-Banaschek, 9 points, stiffness ... N/m, model error unknown)
    """
    teeth, b = loaded_teeth(pair, path), pair.face_width
    parts = (
        {"tooth": tooth_compliance(tooth, b), "body": body_compliance(tooth, b), "contact": flank}
        for tooth, flank in zip(teeth, contact_compliances(pair, path, force, teeth), strict=True)
    )
    return ClosedForm.of_both("Weber-Banaschek", *parts)
