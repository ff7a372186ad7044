"""A loaded pair by one stiffness model: mesh cycles at any number of positions, dry or with films in series."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, TypedDict

import numpy as np

import fem
import gears
from base import Array, Cost, Faults, Stopwatch
from flankfilm.coupling.believed import believed
from flankfilm.coupling.cycle import MeshCycle, peak_to_peak_error, sampling_error
from flankfilm.coupling.film_law import FilmLaw, Placed
from flankfilm.coupling.references import MEANINGS
from flankfilm.coupling.single_pairs import CLOSED_FORMS, MODELS, single_pair_stiffness

POSITIONS = (120, 360, 1080)
"""Numbers of positions tried, the cheapest first; each holds every third of the next one."""


@dataclass(frozen=True)
class Flanks:
    """What finite elements take into account beside the pair's geometry, as `fem.mesh_cycle` does.

    Attributes
    ----------
    beyond_path : bool
        Whether tip edges may touch outside A to E.
    deviations : tuple, optional
        Deviations of pinion and wheel, either may be None.
    tip_rounding : (float, float)
        Radii of the tip edges of pinion and wheel [m].
    friction : float
        Coefficient of friction by which the forces are tilted.
    """

    beyond_path: bool = True
    deviations: tuple[gears.GearDeviations | None, gears.GearDeviations | None] | None = None
    tip_rounding: tuple[float, float] = (0.0, 0.0)
    friction: float = 0.0


PLAIN_FLANKS = Flanks()
"""Sharp edges without deviations or friction; they may touch outside the path."""


class TeethOptions(TypedDict, total=False):
    """Fields of `LoadedTeeth` that may be left out, as keyword arguments."""

    model: str
    pairs: str
    compliance: fem.Compliance | None
    flanks: Flanks
    reference: str


@dataclass(frozen=True)
class LoadedTeeth:
    """A pair under a torque, and the model of its stiffness.

    Attributes
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    model : str
        ``"fem"``, ``"ishikawa"``, ``"weber-banaschek"`` or ``"potential-energy"``.
    pairs : str
        ``"coupled"``: one approach for all loaded pairs, with the gaps that tip relief leaves and the film's
        separation as a function of its force; the gear body couples them in finite elements alone.
        ``"independent"``: each pair's secant stiffness, in series with its film's, the force in proportion.
    compliance : fem.Compliance, optional
        For finite elements; see `meshed`.
    flanks : Flanks
        For finite elements of coupled pairs.
    reference : {"bore", "body", "teeth"}
        What the deflection of these is measured against, as of `fem.mesh_cycle`.
    """

    pair: gears.GearPair
    torque: float
    model: str = "fem"
    pairs: str = "coupled"
    compliance: fem.Compliance | None = None
    flanks: Flanks = PLAIN_FLANKS
    reference: str = "bore"

    def __post_init__(self) -> None:
        """Check the names of the models."""
        with Faults() as faults:
            faults.choice("model", self.model, tuple(MODELS))
            faults.choice("pairs", self.pairs, ("coupled", "independent"))
            faults.choice("reference", self.reference, tuple(MEANINGS))
            if self.reference != "bore" and (self.model, self.pairs) != ("fem", "coupled"):
                allowed = "requires coupled pairs by finite elements"
                faults.add("reference", repr(self.reference), allowed, "leave it out, or take them")

    def meshed(self, tolerance: float) -> LoadedTeeth:
        """Give the same with the compliance computed to a tolerance, where it is needed and not there.

        Raises
        ------
        SolverError
            Where it misses the tolerance.
        """
        if self.model != "fem" or self.compliance is not None:
            return self

        found = fem.compliance(self.pair, tolerance=tolerance)
        return replace(self, compliance=believed(found, "tooth compliance"))

    @property
    def setting(self) -> dict[str, Any]:
        """What `fem.mesh_cycle` takes beside pair, torque and positions."""
        return {"compliance": self.compliance, "reference": self.reference, **vars(self.flanks)}

    @property
    def force(self) -> float:
        """Normal force of all pairs together [N]."""
        return self.pair.normal_force(self.torque)

    def cycle(self, positions: int, film: FilmLaw | None = None) -> MeshCycle:
        """Mesh cycle at the midpoints of some equal intervals of one base pitch.

        Parameters
        ----------
        positions : int
            Number of intervals.
        film : FilmLaw, optional
            Films in series with the pairs; dry without.

        Raises
        ------
        SolverError
            Where the loaded contact did not converge.
        """
        if (self.model, self.pairs) != ("fem", "coupled"):
            return self._by_single_pairs(positions, film)
        found = fem.mesh_cycle(self.pair, self.torque, positions=positions, film=film, **self.setting)
        believed(found, "loaded tooth contact")
        return MeshCycle(label=MODELS["fem"], **MeshCycle.fields_of(found), contact=found)

    def sampled(self, sampling: float, transmission_error: float) -> MeshCycle:
        """Dry mesh cycle at as few of `POSITIONS` as two tolerances need.

        Parameters
        ----------
        sampling : float
            Relative, of the mean stiffness.
        transmission_error : float
            Relative, of the transmission error, peak to peak.
        """
        found = self.cycle(POSITIONS[0])
        for positions in POSITIONS[1:]:
            enough = sampling_error(found.secant_stiffness) <= sampling
            if enough and peak_to_peak_error(found.transmission_error) <= transmission_error:
                break
            found = self.cycle(positions)
        return found

    def others(self, positions: int) -> tuple[MeshCycle, ...]:
        """Dry cycles of independent pairs by every other closed form, and by finite elements if these are at hand."""
        models = [*CLOSED_FORMS, *(["fem"] if self.model == "fem" else [])]
        return tuple(
            replace(self, model=model, pairs="independent", reference="bore").cycle(positions)
            for model in models
            if (model, "independent") != (self.model, self.pairs)
        )

    def _by_single_pairs(self, positions: int, film: FilmLaw | None) -> MeshCycle:
        """Pairs that know each other only through the force they share."""
        from gears import independent_pairs, share_load

        watch, force = Stopwatch(), self.force
        position, rho1 = contact_places(self.pair, positions)
        touching = np.isfinite(rho1)
        k = single_pair_stiffness(self.pair, force, rho1, self.model, self.compliance)
        k = np.where(touching, k, 0.0)
        if self.pairs == "independent":
            share = independent_pairs(force, k, None if film is None else film.stiffness(rho1))
            secant = stiffness = np.asarray(share.stiffness)
        else:
            compliance = 1.0 / np.where(touching, k, 1.0)
            bulk = compliance[..., None] * np.eye(k.shape[1])
            gaps = np.where(touching, _relief(self.pair, rho1), np.inf)
            placed = None if film is None else Placed(film, rho1)
            share = share_load(force, bulk, Placed(_no_hertz, rho1), gaps, placed)
            secant, stiffness = force / np.asarray(share.transmission_error), np.asarray(share.stiffness)
        return MeshCycle(
            label=f"{MODELS[self.model]}, {self.pairs} pairs",
            position=position,
            rho1=rho1,
            forces=share.forces,
            load_share=share.forces / force,
            secant_stiffness=secant,
            stiffness=stiffness,
            transmission_error=np.asarray(share.transmission_error),
            error=self.compliance.error if self.model == "fem" and self.compliance is not None else None,
            cost=Cost(watch.seconds),
            reference="bore" if self.model == "fem" else "teeth",
        )


def contact_places(pair: gears.GearPair, positions: int) -> tuple[Array, Array]:
    """Place the pairs of teeth on the path.

    Parameters
    ----------
    pair : gears.GearPair
    positions : int
        Number of equal intervals of one base pitch.

    Returns
    -------
    position : ndarray, shape (positions,)
        Travel after a pair is at A, in base pitches, at the intervals' midpoints.
    rho1 : ndarray, shape (positions, pairs)
        Curvature radius of the pinion's flank [m]; nan beyond E.
    """
    position = (np.arange(positions) + 0.5) / positions
    pairs = int(np.ceil(pair.contact_ratio))
    rho1 = pair.points.A + pair.base_pitch * (position[:, None] + np.arange(pairs))
    return position, np.where(rho1 <= pair.points.E, rho1, np.nan)


def _no_hertz(rho1: Array, force: Array) -> tuple[Array, Array]:
    """Local deflection of closed forms: already in the single pair's stiffness at the full force."""
    return np.zeros_like(force), np.zeros_like(force)


def _relief(pair: gears.GearPair, rho1: Array) -> Array:
    """Clearance that tip relief of both gears leaves [m], nan staying nan, least zero at each position."""
    pinion, wheel = pair.teeth_profiles
    gap = pinion.relief(rho1) + wheel.relief(pair.line_of_action - rho1)
    return np.asarray(gap - np.nanmin(gap, axis=1, keepdims=True))
