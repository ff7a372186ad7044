"""Nominal contact stress after ISO 6336-2, method B."""

from __future__ import annotations

import math
import warnings

from base import Faults, RangeWarning, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.pair.hertz import NORMAL_FORCE
from gears.tooth.errors import GeometryError

SHARED = 2.0
"""Contact ratio from which no pair of teeth bears alone."""

LARGEST_RATIO = 4.0
"""Contact ratio at which the contact ratio factor is zero."""


@record
class Iso6336ContactStress:
    """Nominal contact stress of both gears after ISO 6336-2."""

    Z_H: float = quantity("1", "zone factor Z_H")
    Z_E: float = quantity("Pa^0.5", "elasticity factor Z_E", shown="MPa^0.5")
    Z_eps: float = quantity("1", "contact ratio factor Z_eps")
    Z_B: float = quantity("1", "single pair tooth contact factor of the pinion, at B")
    Z_D: float = quantity("1", "single pair tooth contact factor of the wheel, at D")
    stresses: tuple[float, float] = quantity(
        "Pa", "nominal contact stress sigma_H0 at the pitch point", "gear", shown="MPa"
    )
    single_pair_stresses: tuple[float, float] = quantity(
        "Pa",
        "contact stress where a single pair begins to bear, Z_B sigma_H0 and Z_D sigma_H0",
        "gear",
        shown="MPa",
    )

    Z_beta: float = quantity(
        "1", "helix angle factor Z_beta of the contact stress, 1 of spur gears", no_error=EXACT, default=1.0
    )

    no_error = STANDARD
    headline = ("stresses", "Z_H", "Z_E", "Z_eps", "Z_B", "Z_D")

    def __repr__(self) -> str:
        """One line: the stress and the factors."""
        factors = ", ".join(f"{name} {getattr(self, name):.4g}" for name in ("Z_H", "Z_eps", "Z_B", "Z_D"))
        return f"Iso6336ContactStress({1e-6 * self.stresses[0]:.5g} MPa, {factors})"

    @property
    def error(self) -> None:
        """Model error, which a closed form cannot know: None stands for unknown, never for zero."""
        return


def iso6336_2(pair: GearPair, force: float) -> Iso6336ContactStress:
    """Nominal contact stress of a pair after ISO 6336-2, method B.

    sigma_H0 = Z_H Z_E Z_eps Z_beta sqrt(F_t/(d_1 b) (u + 1)/u), F_t = F cos(alpha_n) cos(beta) at the reference circle
    (the factors K of part 1 are left to the user), with e = min(epsilon_beta, 1) and

        Z_H = sqrt(2 cos(beta_b)/(cos^2(alpha_t) tan(alpha_wt)))
        Z_E = sqrt(1/(pi [(1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2]))
        Z_eps = sqrt((4 - epsilon_alpha)/3 (1 - e) + e/epsilon_alpha),  Z_beta = 1/sqrt(cos(beta))
        M_1 = sqrt(rho_C1 rho_C2/(rho_B1 rho_B2)),  M_2 = sqrt(rho_C1 rho_C2/(rho_D1 rho_D2))
        Z_B = max(1, M_1 (1 - e) + e),  Z_D = max(1, M_2 (1 - e) + e)

    Z_H Z_E sqrt(...) is the Hertz pressure of the whole force at C; M_1 and M_2, here by curvature radii, take it to
    the inner points of single pair contact, and Z_eps lessens it for the second pair, or for the mean length of the
    lines of contact. Editions before 2006 had Z_beta = sqrt(cos(beta)).

    Parameters
    ----------
    pair : GearPair
        The gears; u = z2/z1 and d_1 of either order give the same stress.
    force : float
        Normal force F, `GearPair.normal_force` of the torque [N].

    Returns
    -------
    Iso6336ContactStress
        Factors and stresses; sigma_H0 is the same for both gears.

    Raises
    ------
    GeometryError
        If the force is not finite and positive, or the contact ratio is 4 or more.

    Warns
    -----
    RangeWarning
        At a contact ratio of 2 or more, where no pair bears alone, or below 1.

    References
    ----------
    ISO 6336-2:2006, Calculation of load capacity of spur and helical gears, part 2: Calculation of surface durability
    (pitting), clauses 5 to 8.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> iso6336_2(pair, force=10e3)
    Iso6336ContactStress(1031.6 MPa, Z_H 2.495, Z_eps 0.875, Z_B 1.006, Z_D 1)
    """
    ratio = pair.contact_ratio
    with Faults(GeometryError) as faults:
        faults.number("force", force, NORMAL_FORCE)
        if ratio >= LARGEST_RATIO:
            allowed = f"must be below {LARGEST_RATIO:g}, where the standard's Z_eps is zero"
            faults.add("contact_ratio", f"{ratio:.4g}", allowed, "take finite elements")
    if ratio >= SHARED:
        said = f"ISO 6336-2: contact ratio {ratio:.3f} is not below {SHARED:g}: no pair bears alone"
        warnings.warn(said, RangeWarning, stacklevel=2)
    if ratio < 1.0:
        said = f"ISO 6336-2: transverse contact ratio {ratio:.3f} is below 1: made for paths of a base pitch at least"
        warnings.warn(said, RangeWarning, stacklevel=2)
    helix, points, overlap = pair.helix, pair.points, min(pair.overlap_ratio, 1.0)
    working = math.tan(pair.working_pressure_angle)
    Z_H = math.sqrt(2.0 * helix.base_cosine / (helix.transverse_cosine**2 * working))
    Z_E = math.sqrt(pair.reduced_modulus / (2.0 * math.pi))
    Z_eps = math.sqrt((LARGEST_RATIO - ratio) / 3.0 * (1.0 - overlap) + overlap / ratio)
    tangential = force * math.cos(pair.rack.alpha) * helix.cosine
    load = tangential / (2.0 * pair.reference_radii[0] * pair.face_width)
    Z_beta = 1.0 / math.sqrt(helix.cosine)
    nominal = Z_H * Z_E * Z_eps * Z_beta * math.sqrt(load * (pair.ratio + 1.0) / pair.ratio)
    Z_B, Z_D = (_inner_factor(pair, rho1, overlap) for rho1 in (points.B, points.D))
    single = Z_B * nominal, Z_D * nominal
    return Iso6336ContactStress(Z_H, Z_E, Z_eps, Z_B, Z_D, (nominal, nominal), single, Z_beta)


def _inner_factor(pair: GearPair, rho1: float, overlap: float) -> float:
    """Z_B or Z_D at an inner point of single pair contact; 1 from an overlap ratio of 1 on, where none bears alone."""
    if overlap >= 1.0:
        return 1.0
    return max(1.0, _over_pitch_point(pair, rho1) * (1.0 - overlap) + overlap)


def _over_pitch_point(pair: GearPair, rho1: float) -> float:
    """Hertz pressure at a place of the line of action over that at the pitch point; infinite on a base circle."""
    total, pitch = pair.line_of_action, pair.points.C
    product = rho1 * (total - rho1)
    return math.sqrt(pitch * (total - pitch) / product) if product > 0.0 else math.inf
