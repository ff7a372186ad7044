"""Tooth deflection by the energy of a cantilever with the true profile, on Sainsot's body."""

from __future__ import annotations

import numpy as np

from base import Array
from gears.closed_form.contact import constant_contact_compliance, contact_compliances
from gears.closed_form.loaded_tooth import LoadedTooth, loaded_teeth
from gears.closed_form.record import ClosedForm
from gears.closed_form.sainsot import sainsot_body
from gears.pair.gear_pair import GearPair
from gears.pair.path import PathOfContact

SHEAR_FACTOR = 1.2
"""Ratio of the mean square to the squared mean of the shear stress in a rectangular section."""


def _tooth_parts(tooth: LoadedTooth, face_width: float, name: str) -> dict[str, Array]:
    """Compliances of one tooth and its body [m/N]."""
    profile, material = tooth.profile, tooth.material
    load = profile.involute(tooth.rho)
    cosine, sine = np.cos(tooth.load_angle)[:, None], np.sin(tooth.load_angle)[:, None]
    x_load, y_load = load[:, :1], load[:, 1:]

    def bending(y: Array, x: Array) -> Array:
        moment = cosine * (y_load - y) - sine * x_load
        return np.asarray(12.0 * moment**2 / (2.0 * x) ** 3)

    per_section = tooth.integrate(lambda y, x: 0.5 / x, load[:, 1])
    scale = 1.0 / (material.youngs_modulus * face_width)
    shear = SHEAR_FACTOR * 2.0 * (1.0 + material.poisson_ratio)
    body = sainsot_body(
        profile.root_radius,
        profile.bore_radius,
        profile.root_half_angle,
        tooth.load_angle,
        tooth.crossing - profile.root_radius,
        name,
    )
    return {
        "bending": scale * tooth.integrate(bending, load[:, 1]),
        "shear": scale * shear * cosine[:, 0] ** 2 * per_section,
        "axial": scale * sine[:, 0] ** 2 * per_section,
        "body": scale * body,
    }


def potential_energy(pair: GearPair, path: PathOfContact, force: float | None = None) -> ClosedForm:
    """Single-pair deflection by the potential energy of a cantilever on an elastic ring.

    The cantilever has the exact profile of trochoid and involute and stands on the chord between the feet of
    its fillets. With w the load angle and (x_Q, y_Q) the loaded point, the energies give, by Castigliano,

    - bending Int [cos w (y_Q - y) - sin w x_Q]^2 / (E I) dy, I = b (2x)^3 / 12,
    - shear 1.2 cos^2 w Int dy / (G b 2x),
    - axial sin^2 w Int dy / (E b 2x),

    in plane stress, from the chord to y_Q. Body: the ring of `sainsot_body`. Contact: 4 (1 - nu^2) / (pi E b)
    after Yang and Sun without a force, else the force-dependent term of `hertz`.

    Parameters
    ----------
    pair : GearPair
        The gears.
    path : PathOfContact
        Where the load acts, on both involutes.
    force : float or None
        Normal force for the contact term [N]; None takes the constant one.

    Returns
    -------
    ClosedForm
        Parts ``bending``, ``shear``, ``axial``, ``body``, ``contact``.

    Raises
    ------
    GeometryError
        If the force is not a finite positive number, or a point of the path is not on both involutes.

    Warns
    -----
    RangeWarning
        Outside the range of Sainsot's fit, or where the contact is wide for the Hertz term.

    References
    ----------
    D. C. H. Yang, Z. S. Sun, A rotary model for spur gear dynamics, Journal of Mechanisms, Transmissions, and
    Automation in Design 107 (1985) 529-535.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> potential_energy(pair, pair.path_of_contact(9))
    ClosedForm(potential energy, 9 points, stiffness ... N/m, model error unknown)
    """
    teeth = loaded_teeth(pair, path)
    if force is None:
        flanks = tuple(constant_contact_compliance(tooth, pair.face_width) for tooth in teeth)
    else:
        flanks = contact_compliances(pair, path, force, teeth)
    parts = (
        _tooth_parts(tooth, pair.face_width, name) | {"contact": flank}
        for name, tooth, flank in zip(("the pinion", "the wheel"), teeth, flanks, strict=True)
    )
    return ClosedForm.of_both("potential energy", *parts)
