"""Tooth deflection after Ishikawa: a rectangle that carries a trapezoid."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np

from base import Array, RangeWarning
from gears.closed_form.contact import constant_contact_compliance
from gears.closed_form.loaded_tooth import LoadedTooth, loaded_teeth
from gears.closed_form.record import ClosedForm
from gears.pair.gear_pair import GearPair
from gears.pair.path import PathOfContact
from gears.tooth.profile import ToothProfile


@dataclass(frozen=True)
class IshikawaTooth:
    """Dimensions of the rectangle and the trapezoid, heights above the root chord.

    Parameters
    ----------
    s_F : float
        Chordal thickness at the effective root (form) circle [m].
    s_K : float
        Chordal thickness at the tip circle [m].
    h : float
        Height of the tip chord [m].
    h_r : float
        Height of the rectangle [m].
    h_i : float
        Height at which the sides of the trapezoid would meet [m].
    y_0 : float
        Height of the root chord above the axis, sqrt(r_f^2 - (s_F / 2)^2) [m].
    """

    s_F: float
    s_K: float
    h: float
    h_r: float
    h_i: float
    y_0: float


def dimensions(tooth: ToothProfile) -> IshikawaTooth:
    """Dimensions of the model of a tooth; the effective root circle is its form circle.

    Parameters
    ----------
    tooth : ToothProfile
        The tooth.

    Returns
    -------
    IshikawaTooth
        The rectangle and the trapezoid.
    """
    root, form, tip = tooth.root_radius, tooth.form_radius, tooth.tip_radius
    s_F = 2.0 * form * math.sin(float(tooth.half_angle(form)))
    s_K = 2.0 * tip * math.sin(float(tooth.half_angle(tip)))
    y_0 = math.sqrt(root**2 - 0.25 * s_F**2)
    h = math.sqrt(tip**2 - 0.25 * s_K**2) - y_0
    h_r = math.sqrt(form**2 - 0.25 * s_F**2) - y_0
    return IshikawaTooth(s_F, s_K, h, h_r, (h * s_F - h_r * s_K) / (s_F - s_K), y_0)


def _tooth_parts(tooth: LoadedTooth, face_width: float) -> dict[str, Array]:
    """Compliances of one tooth [m/N]."""
    d = dimensions(tooth.profile)
    E, nu = tooth.material.youngs_modulus, tooth.material.poisson_ratio
    h_x = tooth.radius * np.cos(tooth.half_angle) - d.y_0
    taper = d.h_i - d.h_r
    q = (d.h_i - h_x) / taper
    along = np.cos(tooth.load_angle) ** 2 / (E * face_width)
    rectangle = h_x * d.h_r * (h_x - d.h_r) + d.h_r**3 / 3.0
    return {
        "bending_rectangle": 12.0 * along / d.s_F**3 * rectangle,
        "bending_trapezoid": 6.0 * along / d.s_F**3 * (q * (4.0 - q) - 2.0 * np.log(q) - 3.0) * taper**3,
        "shear": 2.0 * (1.0 + nu) * along / d.s_F * (d.h_r - taper * np.log(q)),
        "root_inclination": 24.0 / math.pi * along * h_x**2 / d.s_F**2,
        "contact": constant_contact_compliance(tooth, face_width),
    }


def ishikawa(pair: GearPair, path: PathOfContact) -> ClosedForm:
    """Single-pair deflection after Ishikawa.

    With F the normal force, w the angle between it and the normal to the centre line, b the face width and q
    = (h_i - h_x) / (h_i - h_r), each tooth deflects by

    - bending of the rectangle 12 F cos^2 w / (E b s_F^3) [h_x h_r (h_x - h_r) + h_r^3 / 3],
    - bending of the trapezoid 6 F cos^2 w / (E b s_F^3) [q (4 - q) - 2 ln q - 3] (h_i - h_r)^3,
    - shear 2 (1 + nu) F cos^2 w / (E b s_F) [h_r + (h_i - h_r) ln((h_i - h_r) / (h_i - h_x))],
    - inclination of the root 24 F h_x^2 cos^2 w / (pi E b s_F^2),
    - contact 2 F (1 - nu^2) / (pi E b), so 4 F (1 - nu^2) / (pi E b) for the pair.

    The first three are the exact integrals of beam theory for the shape (shear without a factor for its
    distribution), in plane stress. The gear body is rigid.

    Parameters
    ----------
    pair : GearPair
        The gears.
    path : PathOfContact
        Where the load acts, on both involutes.

    Returns
    -------
    ClosedForm
        Parts ``bending_rectangle``, ``bending_trapezoid``, ``shear``, ``root_inclination``, ``contact``.

    Raises
    ------
    GeometryError
        If a point of the path is not on both involutes.

    Warns
    -----
    RangeWarning
        If undercut makes a tooth no thicker at its effective root circle than at its tip.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> ishikawa(pair, pair.path_of_contact(9))
    ClosedForm(Ishikawa, 9 points, stiffness 3.711e+08 to 6.638e+08 N/m, model error unknown)
    """
    teeth = loaded_teeth(pair, path)
    for name, tooth in zip(("pinion", "wheel"), teeth, strict=True):
        shape = dimensions(tooth.profile)
        if shape.s_K >= shape.s_F:
            message = f"Ishikawa: the {name} is no thicker at its effective root circle than at its tip"
            warnings.warn(message, RangeWarning, stacklevel=2)
    return ClosedForm.of_both("Ishikawa", *(_tooth_parts(tooth, pair.face_width) for tooth in teeth))
