"""The film of one pair of teeth on its way from A to E, over time, beside the steady films of the same loads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import ehl
import gears
from base import Array, Cost, Faults, Limit, SolverError, Stopwatch, described, part, quantity, record
from base.results import EXACT
from flankfilm.coupling.films.films import contacts_of
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.warn_once import warned_once
from gears.pair.hertz import HERTZ

INSTANTS = 80
"""Times at which films are given, at most."""

FORGOTTEN = 2.0
"""b/u after which the film no longer knows how it came in."""

_SPEED = Limit.above(0.0, 1e6, "rad/s", "give the pinion's speed in rad/s")
_TOLERANCE = Limit.above(0.0, 0.2, remedy="0.01 is 1 %")


@record
class PassageFilm:
    """Film of one pair of teeth over time, from A to E, and the steady one at the same loads."""

    headline = ("greatest_difference", "thinnest", "steady_thinnest")

    no_error = "not estimated: the difference of films that have errors"

    time: Array = quantity("s", "time since the pair reached the first place", "instant", no_error=EXACT)
    rho1: Array = quantity(
        "m", "curvature radius of the pinion's flank at the contact", "instant", shown="mm", no_error=EXACT
    )
    load: Array = quantity("N/m", "force per length of face", "instant", shown="N/mm", no_error=HERTZ)
    least: Array = quantity("m", "minimum film over time", "instant", shown="um", error="error")
    steady_least: Array = quantity(
        "m", "minimum film of the steady contact", "instant", shown="um", error="error"
    )
    central: Array = quantity("m", "central film over time", "instant", shown="um", error="error")
    steady_central: Array = quantity(
        "m", "central film of the steady contact", "instant", shown="um", error="error"
    )
    known: Array = quantity(
        "1", "1 where the film no longer knows how it came in, 0 before", "instant", no_error=EXACT
    )
    film: ehl.TransientFilm = part("the film over time")
    error: float
    cost: Cost
    converged: bool
    message: str

    @described("1", "instant", shown="%")
    def difference(self) -> Array:
        """Minimum film over that of the steady contact, less 1."""
        return self.least / self.steady_least - 1.0

    @described("1", shown="%")
    def greatest_difference(self) -> float:
        """Largest difference of the minimum film from the steady one, with its sign, where the way in is forgotten."""
        told = np.where(self.known > 0.0, self.difference, 0.0)
        return float(told[np.argmax(np.abs(told))])

    @described("m", shown="mm", no_error=EXACT)
    def greatest_at(self) -> float:
        """Curvature radius of the pinion's flank where that is."""
        told = np.where(self.known > 0.0, np.abs(self.difference), 0.0)
        return float(self.rho1[np.argmax(told)])

    @described("m", shown="um", error="error")
    def thinnest(self) -> float:
        """Minimum film on the way, where the way in is forgotten."""
        return float(np.min(self.least[self.known > 0.0]))

    @described("m", shown="um", error="error")
    def steady_thinnest(self) -> float:
        """Smallest of the steady films at the same places."""
        return float(np.min(self.steady_least[self.known > 0.0]))


def passage_film(
    cycle: MeshCycle,
    pair: gears.GearPair,
    speed: float,
    lubricant: ehl.Lubricant,
    *,
    tolerance: float = 0.01,
) -> PassageFilm:
    """Film of one pair of teeth on its way through the mesh: load, entrainment and radius change with time.

    Loads are those of the mesh cycle, as the elastic teeth share them; between its positions they go smoothly. The film
    begins as the steady one of the first place: how a tip edge brings its film is not known, and what it was is gone
    after 2 b/u.

    Parameters
    ----------
    cycle : MeshCycle
        By finite elements, its tip edges free to touch outside the path.
    pair : gears.GearPair
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    tolerance : float
        Relative, of the films.

    Raises
    ------
    InputError
        With every fault of the arguments. Closed forms and contact held to the path hand the load on in jumps, in which
        no oil can leave.
    SolverError
        Where a film has no solution.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    >>> passed = passage_film(mesh_cycle(pair, 300.0, model="fem"), pair, 209.44, oil, tolerance=0.05)
    >>> passed.converged
    True
    """
    with Faults() as faults:
        faults.number("speed", speed, _SPEED)
        faults.number("tolerance", tolerance, _TOLERANCE)
        if cycle.contact is None or not cycle.contact.beyond_path:
            allowed = (
                "must be by finite elements with tip edges free to touch: other loads jump from pair to pair"
            )
            faults.add("cycle", cycle.label, allowed, 'mesh_cycle(pair, torque, model="fem")')
    watch = Stopwatch()
    rho1, contacts = contacts_of(pair, cycle, speed, lubricant)
    times = (rho1 - rho1[0]) / (speed * pair.base_radii[0])
    load = _smooth(times, np.array([contact.load for contact in contacts]))
    chosen = np.unique(np.linspace(0, times.size - 1, min(INSTANTS, times.size)).round().astype(int))
    with warned_once():
        moving = ehl.solve_transient(
            contacts[0],
            load,
            times[chosen],
            entrainment=_smooth(times, np.array([contact.entrainment for contact in contacts])),
            radius=_smooth(times, np.array([contact.radius for contact in contacts])),
            tolerance=tolerance,
        )
        if not moving.converged:
            raise SolverError(f"the film over time: {moving.message}")
        same = [replace(contacts[i], load=float(load(times[i]))) for i in chosen]
        steady = ehl.solve_path(same, tolerance)
    for i, film in zip(chosen, steady, strict=True):
        if not film.converged:
            raise SolverError(f"no film at rho1 = {1e3 * rho1[i]:.3f} mm: {film.message}")
    units = np.array([contact.half_width / contact.entrainment for contact in same])
    return PassageFilm(
        time=times[chosen],
        rho1=rho1[chosen],
        load=moving.load,
        least=moving.least,
        steady_least=np.array([film.minimum_thickness for film in steady]),
        central=moving.central,
        steady_central=np.array([film.central_thickness for film in steady]),
        known=(times[chosen] > FORGOTTEN * units[0]).astype(float),
        film=moving,
        error=moving.error + max(film.error for film in steady),
        cost=Cost(watch.seconds, counts={"films": len(steady), **moving.cost.counts}),
        converged=True,
        message="converged",
    )


def _smooth(times: Array, values: Array) -> Callable[[float], float]:
    """Curve through values that rises and falls where they do."""
    from scipy.interpolate import PchipInterpolator

    curve = PchipInterpolator(times, values)
    return lambda at: float(curve(min(max(at, times[0]), times[-1])))
