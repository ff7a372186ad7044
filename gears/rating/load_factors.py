"""Load factors of ISO 6336-1: dynamic, over the face and between the teeth, each on top of those before it."""

from __future__ import annotations

import math
import warnings

from base import Faults, Limit, RangeWarning, described, part, quantity, record
from base.results import EXACT
from gears.closed_form.dynamic_factor import iso6336_dynamic
from gears.closed_form.face_load import iso6336_face_load
from gears.closed_form.record import STANDARD
from gears.closed_form.transverse_load import iso6336_transverse_load
from gears.pair.gear_pair import GearPair
from gears.rating.reduced_mass import reduced_mass
from gears.rating.running_in import RunIn
from gears.tooth.errors import GeometryError

STEEPEST = 30.0
"""Helix angle up to which ISO 6336 is made [deg]."""

RESONANCE = (0.85, 1.15)
"""Resonance ratios between which the standard advises against operation."""

_LIMITS = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque; which flank it loads does not count"),
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "application_factor": Limit(1.0, 10.0, remedy="K_A, 1 of a torque that is the maximum already"),
    "relief": Limit(0.0, 1e-3, "m", "give C_a in metres, `run_in_relief` of teeth without"),
}
_OPTIONAL = {
    "face_load_factor": Limit(1.0, 10.0, remedy="K_Hbeta of the contact stress, at least 1"),
    "misalignment": Limit(0.0, 5e-3, "m", "give F_by over the face in metres"),
    "mass": Limit.above(0.0, 1e6, "kg/m", "give m_red per length of face"),
}
LIMITS = {**_LIMITS, **_OPTIONAL}
"""What load factors take."""


@record
class LoadFactors:
    """Load factors of a pair at one torque and speed, after ISO 6336-1."""

    K_A: float = quantity("1", "application factor, as given", no_error=EXACT)
    K_v: float = quantity("1", "dynamic factor, method B")
    K_Hbeta: float = quantity("1", "face-load factor of the contact stress")
    K_Fbeta: float = quantity("1", "face-load factor of the root stress")
    K_Halpha: float = quantity("1", "transverse load factor of the contact stress")
    K_Falpha: float = quantity("1", "transverse load factor of the root stress")
    m_red: float = quantity("kg/m", "reduced mass per length of face")
    resonance_speed: float = quantity("rad/s", "pinion speed n_E1 at resonance", shown="rpm")
    N: float = quantity("1", "resonance ratio, speed over resonance speed")
    N_S: float = quantity("1", "end of the subcritical range")
    regime: str = quantity("", "subcritical, main resonance, intermediate or supercritical")
    line_load: float = quantity(
        "N/m", "nominal tangential load per length of face, F_t/b", no_error=EXACT, shown="N/mm"
    )
    effective: RunIn = part("deviations after running in")

    no_error = STANDARD
    headline = ("K_v", "K_Hbeta", "K_Fbeta", "K_Halpha", "K_Falpha", "N")

    @described("1")
    def contact(self) -> float:
        """Product of the factors of the contact stress, whose root multiplies it."""
        return self.K_A * self.K_v * self.K_Hbeta * self.K_Halpha

    @described("1")
    def bending(self) -> float:
        """Product of the factors of the root stress."""
        return self.K_A * self.K_v * self.K_Fbeta * self.K_Falpha

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def load_factors(
    pair: GearPair,
    torque: float,
    speed: float,
    *,
    application_factor: float,
    effective: RunIn,
    relief: float,
    face_load_factor: float | None = None,
    misalignment: float | None = None,
    mass: float | None = None,
) -> LoadFactors:
    """Load factors of a spur or helical pair: K_v, K_Hbeta, K_Fbeta, K_Halpha and K_Falpha in the standard's order.

    K_v is of the load F_t K_A, K_Hbeta of F_t K_A K_v, K_Halpha of F_t K_A K_v K_Hbeta, by
    `gears.closed_form.iso6336_dynamic`, `iso6336_face_load` and `iso6336_transverse_load`. K_Halpha takes the larger
    of the effective base pitch and profile form deviations.

    Parameters
    ----------
    pair : GearPair
        Helix angle up to 30 degrees; a steeper one is rated with a warning.
    torque : float
        Nominal torque of the pinion [N m].
    speed : float
        Of the pinion [rad/s].
    application_factor : float
        K_A.
    effective : RunIn
        Deviations after running in, of `run_in`.
    relief : float
        Tip relief C_a of the smaller one of both gears, or C_ay by running in [m].
    face_load_factor : float or None
        K_Hbeta where it is known.
    misalignment : float or None
        F_by over the face [m], in place of K_Hbeta. One of these two is required.
    mass : float or None
        m_red [kg/m] where it is known, else that of `reduced_mass`.

    Returns
    -------
    LoadFactors

    Raises
    ------
    GeometryError
        With every fault of the numbers, and of K_Hbeta given twice or not at all.

    Warns
    -----
    RangeWarning
        In the main resonance range, N between 0.85 and 1.15, which the standard advises to avoid; of a helix above 30
        degrees, up to which the standard is made.

    References
    ----------
    ISO 6336-1:2006, clauses 5 to 8.

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel, run_in, run_in_relief, tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> effective = run_in(pair, steels, 209.44, tolerances(pair, 6))
    >>> given = {"effective": effective, "relief": run_in_relief(steels), "misalignment": 14e-6}
    >>> load_factors(pair, 600.0, 209.44, application_factor=1.25, **given)
    LoadFactors(K_v 1.0..., K_Hbeta 1.2..., K_Fbeta 1.1..., K_Halpha 1, K_Falpha 1, N 0.16...)
    """
    with Faults(GeometryError) as faults:
        faults.numbers(_LIMITS, (torque, speed, application_factor, relief))
        for (name, limit), value in zip(
            _OPTIONAL.items(), (face_load_factor, misalignment, mass), strict=True
        ):
            if value is not None:
                faults.number(name, value, limit)
        if (face_load_factor is None) == (misalignment is None):
            which = "neither" if misalignment is None else "both"
            allowed = "must be given as K_Hbeta or as a misalignment F_by, one of these"
            faults.add("face_load_factor", which, allowed, "`misalignment` computes F_by by method C")
    warn_of_helix(pair)
    m_red = reduced_mass(pair) if mass is None else mass
    loaded = application_factor * torque
    dynamic = iso6336_dynamic(
        pair,
        pair.normal_force(loaded),
        m_red * pair.face_width,
        speed,
        pitch_deviation=effective.f_pb_eff,
        profile_deviation=effective.f_falpha_eff,
        relief=relief,
    )
    K_v, N = float(dynamic.K_v), float(dynamic.N)
    low, high = RESONANCE
    if low <= N <= high:
        said = f"ISO 6336-1: resonance ratio {N:.3g} is within {low:g} to {high:g}: change the speed, or have the"
        warnings.warn(f"{said} motion computed", RangeWarning, stacklevel=2)
    face = iso6336_face_load(pair, loaded * K_v, 0.0 if misalignment is None else misalignment)
    K_Hbeta = face.K_Hbeta if face_load_factor is None else face_load_factor
    transverse = iso6336_transverse_load(pair, loaded * K_v * K_Hbeta, effective.f_alpha_eff)
    return LoadFactors(
        application_factor,
        K_v,
        K_Hbeta,
        K_Hbeta**face.N_F,
        transverse.K_Halpha,
        transverse.K_Falpha,
        m_red,
        dynamic.resonance_speed,
        N,
        dynamic.N_S,
        _regime(N, dynamic.N_S),
        pair.tangential_force(torque) / pair.face_width,
        effective,
    )


def warn_of_helix(pair: GearPair) -> None:
    """Warn of a helix that is steeper than ISO 6336 has."""
    angle = abs(math.degrees(pair.helix.angle))
    if angle > STEEPEST:
        said = f"ISO 6336 is made for helix angles up to {STEEPEST:g} deg: at {angle:.4g} deg its factors are beyond it"
        warnings.warn(said, RangeWarning, stacklevel=3)


def _regime(N: float, N_S: float) -> str:
    if N <= N_S:
        return "subcritical"
    end = RESONANCE[1]
    return "main resonance" if end >= N else "intermediate" if N < 1.5 else "supercritical"
