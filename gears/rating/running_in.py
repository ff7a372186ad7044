"""What running in takes of deviations, after ISO 6336-1."""

from __future__ import annotations

from base import Faults, Limit, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.grades import Tolerances
from gears.rating.steels import RatedSteel, Steels, check_steels
from gears.tooth.errors import GeometryError

SLOW, FAST = 5.0, 10.0
"""Pitch line velocities between which running in of unhardened steels is bounded once, and above twice [m/s]."""


@record
class RunIn:
    """Deviations of a pair after running in, those on which its load factors depend."""

    f_pb: float = quantity("m", "base pitch deviation, the larger of both gears'", shown="um", no_error=EXACT)
    f_falpha: float = quantity(
        "m", "profile form deviation, the larger of both gears'", shown="um", no_error=EXACT
    )
    y_alpha: float = quantity("m", "running-in allowance y_alpha of both gears together", shown="um")
    f_pb_eff: float = quantity("m", "effective base pitch deviation f_pb - y_alpha", shown="um")
    f_falpha_eff: float = quantity("m", "effective profile form deviation f_falpha - y_alpha", shown="um")
    f_alpha_eff: float = quantity(
        "m", "larger one of both, which the transverse load factor takes", shown="um"
    )

    no_error = STANDARD
    headline = ("f_pb_eff", "f_falpha_eff", "y_alpha")


def run_in(pair: GearPair, steels: Steels, speed: float, deviations: Tolerances) -> RunIn:
    """Deviations after running in.

    y_alpha is the mean of both gears' allowances for the larger base pitch deviation f_pb of the pair (equation 80 of
    the standard has that mean for unlike steels). It is taken off the profile form deviation too.

    Parameters
    ----------
    pair : GearPair
    steels : tuple of RatedSteel
        Of pinion and wheel.
    speed : float
        Of the pinion [rad/s].
    deviations : Tolerances

    Returns
    -------
    RunIn

    Raises
    ------
    GeometryError
        With every fault of the steels and of the speed, and for gears that are not of steel.

    Notes
    -----
    A published listing confirms what is taken off and from what (docs/validation/ratings.md): its K_v 1.092 needs
    f_falpha - y_alpha with the allowance of f_pb, its K_Halpha 1.069 the larger of f_pb and f_falpha (1.020 with f_pb).

    References
    ----------
    ISO 6336-1:2006, clauses 6.5.9 (dynamic factor) and 8.3.6 (running-in allowance y_alpha).

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steel = RatedSteel("Eh", 1500e6, 430e6)
    >>> round(1e6 * run_in(pair, (steel, steel), 200.0, tolerances(pair, 6)).f_pb_eff, 2)
    6.52
    """
    with Faults(GeometryError) as faults:
        faults.number("speed", speed, Limit(0.0, 1e5, "rad/s", "give the pinion's speed"))
        check_steels(faults, pair, steels)
    f_pb, f_falpha = max(deviations.f_pb), max(deviations.f_falpha)
    velocity = pair.reference_radii[0] * speed
    first, second = (pitch_allowance(steel, f_pb, velocity) for steel in steels)
    y = 0.5 * (first + second)
    pitch, form = f_pb - y, max(f_falpha - y, 0.0)
    return RunIn(f_pb, f_falpha, y, pitch, form, max(pitch, form))


def pitch_allowance(steel: RatedSteel, f_pb: float, velocity: float) -> float:
    """Running-in allowance y_alpha of one gear [m].

    Hardened steels: 0.075 f_pb, at most 3 um. St and V, with sigma_Hlim in MPa and y_alpha in um: 160/sigma_Hlim f_pb,
    from 5 m/s at most 12 800/sigma_Hlim, from 10 m/s at most 6400/sigma_Hlim; never more than f_pb.

    Parameters
    ----------
    steel : RatedSteel
    f_pb : float
        Base pitch deviation [m].
    velocity : float
        At the pitch circle [m/s].

    Examples
    --------
    >>> round(1e6 * pitch_allowance(RatedSteel("Eh", 1500e6, 430e6), 16e-6, 20.0), 2)
    1.2
    """
    if steel.hardened:
        return min(0.075 * f_pb, 3e-6)
    strength = 1e-6 * steel.contact_strength
    bound = float("inf") if velocity <= SLOW else 12_800.0 if velocity <= FAST else 6_400.0
    return min(160.0 * f_pb / strength, 1e-6 * bound / strength, f_pb)


def lead_allowance(steel: RatedSteel, misalignment: float, velocity: float) -> float:
    """Running-in allowance y_beta of one gear for an initial misalignment F_bx over the face [m].

    Hardened steels: 0.15 F_bx. St and V, with sigma_Hlim in MPa and y_beta in um: 320/sigma_Hlim F_bx, from 5 m/s at
    most 25 600/sigma_Hlim, from 10 m/s at most 12 800/sigma_Hlim; never more than F_bx.

    Parameters
    ----------
    steel : RatedSteel
    misalignment : float
        F_bx [m]; of hardened steels at most 40 um, beyond which `misalignment` refuses them.
    velocity : float
        At the pitch circle [m/s].

    Examples
    --------
    >>> round(1e6 * lead_allowance(RatedSteel("Eh", 1500e6, 430e6), 32e-6, 2.7), 2)
    4.8
    """
    if steel.hardened:
        return 0.15 * misalignment
    strength = 1e-6 * steel.contact_strength
    bound = float("inf") if velocity <= SLOW else 25_600.0 if velocity <= FAST else 12_800.0
    return min(320.0 * misalignment / strength, 1e-6 * bound / strength, misalignment)


def run_in_relief(steels: Steels) -> float:
    """Tip relief C_ay that running in makes of teeth without relief [m]: the mean of both gears'.

    C_ay = (sigma_Hlim/97 - 18.45)^2/18 + 1.5 um, sigma_Hlim in MPa.

    Notes
    -----
    Of two open programs one has 1/8 in place of 1/18; a published listing has 2 um for 1500 MPa, which 1/18 gives
    (1.995), while 1/8 gives 2.61.

    References
    ----------
    ISO 6336-1:2006, clause 6.5.9.

    Examples
    --------
    >>> round(1e6 * run_in_relief((RatedSteel("Eh", 1500e6, 430e6),) * 2), 3)
    1.995
    """
    first, second = (((1e-6 * s.contact_strength / 97.0 - 18.45) ** 2 / 18.0 + 1.5) for s in steels)
    return 0.5e-6 * (first + second)
