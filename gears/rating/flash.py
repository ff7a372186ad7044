"""Flash temperature along the path of contact by the factors of ISO/TR 13989-1, for a load share that is given."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from base import Array, Faults, Limit, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.scuffing import angle_factor, flash_factor, geometry_factor
from gears.tooth.errors import GeometryError

_LIMITS = {
    "line_load": Limit.above(
        0.0, 1e9, "N/m", "give w_Bt K_Bgamma, tangential load per length of face with factors"
    ),
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "friction": Limit(0.0, 1.0, remedy="give the mean coefficient of friction, 0.03 to 0.08 is usual"),
    "temperature": Limit(200.0, 600.0, "K", "give the bulk temperature of the teeth in kelvins"),
}


@record
class FlashTemperature:
    """Flash temperature of the flanks along the path of contact."""

    rho1: Array = quantity("m", "curvature radius of the pinion", "point", no_error=EXACT, shown="mm")
    theta_fl: Array = quantity("K", "flash temperature, a difference", "point")
    theta_B: Array = quantity("K", "contact temperature, bulk and flash", "point")
    theta_Bmax: float = quantity("K", "maximum contact temperature on the path")
    X_G: Array = quantity("1", "geometry factor with the pressure angle factor in it", "point")

    no_error = STANDARD
    headline = ("theta_Bmax",)

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def flash_temperature(
    pair: GearPair,
    line_load: float,
    speed: float,
    *,
    friction: float,
    temperature: float,
    rho1: npt.ArrayLike,
    share: npt.ArrayLike,
) -> FlashTemperature:
    """Contact temperature theta_B = theta_M + theta_fl at places of the path, of a load share X_Gamma that is given.

    In units of the standard (N, mm, m/s, K):

        theta_fl = mu X_M X_G (X_Gamma w)^0.75 v^0.5/a^0.25
        X_G = 0.51 X_alphabeta sqrt(u + 1) abs(sqrt(rho_1) - sqrt(rho_2/u))/(rho_1 rho_2)^0.25

    At E with X_Gamma = 1 it is the flash temperature theta_flaE of the integral method, whose constants a listing
    confirms.

    Parameters
    ----------
    pair : GearPair
    line_load : float
        w_Bt K_Bgamma [N/m].
    speed : float
        Of the pinion [rad/s].
    friction : float
        mu, `scuffing_friction` or another.
    temperature : float
        theta_M, bulk temperature of the teeth [K].
    rho1 : array_like
        Curvature radii of the pinion's flank [m], between A and E.
    share : array_like
        X_Gamma there, of the load on the most loaded pair, 0 to 1.3: of `fem.mesh_cycle` or another.

    Returns
    -------
    FlashTemperature

    Raises
    ------
    GeometryError
        With every fault of the numbers, places outside of A..E and shares outside of 0 to 1.3.

    Notes
    -----
    Left out, since nothing confirms it: the standard's X_Gamma over the path, its approach factor X_J, its own mu, and
    the temperature that scuffs.

    References
    ----------
    ISO/TR 13989-1:2000, Calculation of scuffing load capacity of cylindrical, bevel and hypoid gears, part 1: Flash
    temperature method; H. Blok, Proc. 2nd World Petroleum Congress (1937).

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> rho1 = [pair.points.B, pair.points.C, pair.points.D]
    >>> given = {"friction": 0.06, "temperature": 353.15, "rho1": rho1, "share": [1.0, 1.0, 1.0]}
    >>> flash_temperature(pair, 420e3, 209.44, **given).theta_fl.round(1)
    array([...])
    """
    places, shares = np.asarray(rho1, dtype=np.float64), np.asarray(share, dtype=np.float64)
    points = pair.points
    with Faults(GeometryError) as faults:
        faults.numbers(_LIMITS, (line_load, speed, friction, temperature))
        if places.ndim != 1 or places.shape != shares.shape or places.size == 0:
            faults.add(
                "share", str(shares.shape), f"must be {places.shape}, one for each place", "give flat arrays"
            )
        slack = 1e-9 * (points.E - points.A)
        if not np.all((places >= points.A - slack) & (places <= points.E + slack)):
            allowed = f"must lie within {1e3 * points.A:.6g} and {1e3 * points.E:.6g} mm, A and E of the path"
            faults.add("rho1", "an entry", allowed, "take `pair.path_of_contact`")
        if not np.all((shares >= 0.0) & (shares <= 1.3)):
            faults.add("share", "an entry", "must be 0 to 1.3", "give the share of the most loaded pair")
    X_G = angle_factor(pair) * np.array([abs(geometry_factor(pair, float(rho))) for rho in places])
    velocity = pair.reference_radii[0] * speed
    distance = 1e3 * sum(pair.base_radii) / math.cos(pair.working_pressure_angle)
    common = friction * flash_factor(pair) * math.sqrt(velocity) / distance**0.25
    flash = common * X_G * (1e-3 * line_load * shares) ** 0.75
    contact = temperature + flash
    return FlashTemperature(places, flash, contact, float(contact.max()), X_G)
