"""A loaded pair by one stiffness model: mesh cycles at any number of positions, dry or with films in series."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

import fem
import gears
from base import Array, Cost, Faults, Stopwatch
from fem.face_setting import FREE_ENDS
from fem.local_law import film_yielding
from fem.setting import Setting
from flankfilm.coupling.believed import believed
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.film_law import FilmLaw, Placed
from flankfilm.coupling.references import MEANINGS
from flankfilm.coupling.single_pairs import CLOSED_FORMS, MODELS, single_pair_stiffness
from gears.events import Sampled, arcs_alike, arcs_between_events
from gears.mesh_figures import CURVES, MeshArcs

if TYPE_CHECKING:
    from flankfilm.coupling.film_table import FilmTable

POSITIONS = 120
"""Positions of curves; figures follow from arcs, whatever the positions."""

SAMPLING = 0.1
"""Part of a tolerance that what the arcs leave out may be."""


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
    base_pitch_difference : float
        Base pitch of the pinion less that of the wheel, by unequal temperatures [m].
    moving_contact : bool, optional
        Whether contacts on the path move under load; unless given those of plastics do (`contacts_move`).
    alignment : gears.Alignment, optional
        How the axes are out of parallel.
    cells : int, optional
        Cells of the face; the load is even along it without them, an alignment and leads.
    face_model : str
        What couples the cells, as of `fem.mesh_cycle`.
    shafts : (gears.Shaft or None, gears.Shaft or None), optional
        Shafts under the face, which bend and twist under the loads on the cells; straight and rigid without them.
    """

    beyond_path: bool = True
    deviations: tuple[gears.GearDeviations | None, gears.GearDeviations | None] | None = None
    tip_rounding: tuple[float, float] = (0.0, 0.0)
    friction: float = 0.0
    moving_contact: bool | None = None
    base_pitch_difference: float = 0.0
    alignment: gears.Alignment | None = None
    cells: int | None = None
    face_model: str = FREE_ENDS
    shafts: tuple[gears.Shaft | None, gears.Shaft | None] | None = None


PLAIN_FLANKS = Flanks()
"""Sharp edges without deviations or friction; they may touch outside the path."""

COMPLIANT = 30e9
"""Young's modulus below which contacts move unless it is said [Pa]: plastics, not metals."""


def contacts_move(pair: gears.GearPair, asked: bool | None) -> bool:
    """Whether contacts on the path move under load.

    With metals their motion changes the stiffness by 0.1 %, no more than the law of the material leaves open, and what
    corners of the tips do just inside the path counts for more, which only contacts that stay have; with a plastic
    gear it is 1 to 5 %.

    Parameters
    ----------
    pair : gears.GearPair
    asked : bool or None
        What was asked for; None decides by the softer material.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> contacts_move(pair, None), contacts_move(pair, True)
    (False, True)
    """
    return min(one.youngs_modulus for one in pair.materials) < COMPLIANT if asked is None else asked


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
        Of the pinion [N m], negative where the wheel drives: the mirrored gears on their back flanks.
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
        moves = contacts_move(self.pair, self.flanks.moving_contact)
        given = {**vars(self.flanks), "moving_contact": moves}
        return {"compliance": self.compliance, "reference": self.reference, **given}

    @property
    def force(self) -> float:
        """Normal force of all pairs together [N]."""
        return abs(self.pair.normal_force(self.torque))

    def on_path(self, position: Array) -> Array:
        """Positions at which the loaded flanks stand on the path of contact: back flanks in the mirror."""
        return position if self.torque > 0.0 else (Setting(self.pair).mirror - position) % 1.0

    def lag(self, approach: Array) -> Array:
        """Transmission error [m] of an approach of the loaded flanks; beyond the backlash on back flanks."""
        return approach if self.torque > 0.0 else -(self.pair.backlash + approach)

    def cycle(
        self,
        positions: int,
        film: FilmLaw | FilmTable | None = None,
        tolerance: float = 1e-3,
        varied: tuple[tuple[FilmLaw, float], ...] = (),
    ) -> MeshCycle:
        """Mesh cycle at the midpoints of some equal intervals of one base pitch.

        Parameters
        ----------
        positions : int
            Number of intervals.
        film : FilmLaw or FilmTable, optional
            Films in series with the pairs; dry without.
        tolerance : float
            Relative, of means, extremes and harmonics.
        varied : tuple of (FilmLaw, float)
            Other films, and how much of what they change of a figure is its error.

        Raises
        ------
        SolverError
            Where the loaded contact did not converge.
        """
        if (self.model, self.pairs) != ("fem", "coupled"):
            assert film is None or isinstance(film, FilmLaw)  # closed forms know no cells of the face
            return self._by_single_pairs(positions, film, tolerance, varied)
        found = fem.mesh_cycle(
            self.pair, self.torque, positions=positions, film=film, tolerance=tolerance, **self.setting
        )
        believed(found, "loaded tooth contact")
        if film is not None and found.problem is not None:
            corners = film.corners(self.pair)
            problem = replace(found.problem, corners=corners, film_yields=True, varied=varied)
            found = replace(found, problem=problem)
        return MeshCycle(label=MODELS["fem"], **MeshCycle.fields_of(found), contact=found)

    def sampled(self, sampling: float, transmission_error: float) -> MeshCycle:
        """Dry mesh cycle whose arcs leave out less than two tolerances.

        Parameters
        ----------
        sampling : float
            Relative, of the mean stiffness.
        transmission_error : float
            Relative, of the transmission error, peak to peak.

        Raises
        ------
        SolverError
            Where the loaded contact has no solution at some positions, or between them.
        """
        found = self.cycle(POSITIONS, tolerance=min(sampling, transmission_error))
        arcs = found.arcs  # raises where there is no solution between the positions
        assert arcs is not None
        return found

    def others(self, positions: int) -> tuple[MeshCycle, ...]:
        """Dry cycles of independent pairs by every other closed form, and by finite elements if these are at hand."""
        models = [*CLOSED_FORMS, *(["fem"] if self.model == "fem" else [])]
        return tuple(
            replace(self, model=model, pairs="independent", reference="bore").cycle(positions)
            for model in models
            if (model, "independent") != (self.model, self.pairs)
        )

    def _by_single_pairs(
        self,
        positions: int,
        film: FilmLaw | None,
        tolerance: float,
        varied: tuple[tuple[FilmLaw, float], ...],
    ) -> MeshCycle:
        """Pairs that know each other only through the force they share."""
        watch = Stopwatch()
        position, _ = contact_places(self.pair, positions)
        rho1 = places_of(self.pair, self.on_path(position))
        pairs = SinglePairsProblem(self, film, tolerance, varied)
        share, secant = pairs.shared(rho1)
        return MeshCycle(
            label=f"{MODELS[self.model]}, {self.pairs} pairs",
            position=position,
            rho1=rho1,
            forces=share.forces,
            load_share=share.forces / self.force,
            secant_stiffness=secant,
            stiffness=np.asarray(share.stiffness),
            transmission_error=self.lag(np.asarray(share.transmission_error)),
            error=pairs.error,
            cost=Cost(watch.seconds),
            reference="bore" if self.model == "fem" else "teeth",
            by_pairs=pairs,
        )


@dataclass(frozen=True)
class SinglePairsProblem:
    """Pairs that know each other only through the force they share, at any position.

    Attributes
    ----------
    teeth : LoadedTeeth
    film : FilmLaw or None
        Films in series.
    tolerance : float
        Relative, of the figures.
    varied : tuple of (FilmLaw, float)
        Other films, and how much of what they change is error.
    """

    teeth: LoadedTeeth
    film: FilmLaw | None = None
    tolerance: float = 1e-3
    varied: tuple[tuple[FilmLaw, float], ...] = ()

    @property
    def error(self) -> float | None:
        """Relative error of a pair's stiffness; None of a closed form, whose model error is unknown."""
        compliance = self.teeth.compliance
        return compliance.error if self.teeth.model == "fem" and compliance is not None else None

    def arcs(self) -> MeshArcs:
        """Curves between events."""
        pair = self.teeth.pair
        ends = [pair.points.A, pair.points.E]
        for gear, profile in enumerate(pair.teeth_profiles):
            if profile.tip_relief is not None:
                start = profile.flank_rho[1] - profile.tip_relief.length
                ends.append(start if gear == 0 else pair.line_of_action - start)
        corners = self.teeth.on_path((np.array(ends) - pair.points.A) / pair.base_pitch)
        if self.film is not None:
            corners = np.concatenate([corners, self.teeth.on_path(self.film.corners(pair))])
        tolerance = SAMPLING * self.tolerance
        division = arcs_between_events(self._sample, CURVES, corners, tolerance=tolerance)
        varied = []
        for film, share in self.varied:
            sample = replace(self, film=film)._sample
            arcs = arcs_alike(sample, CURVES, division)
            if arcs is None:
                arcs = arcs_between_events(sample, CURVES, corners, tolerance=tolerance).arcs
            varied.append((arcs, share))
        return MeshArcs(division, None, 1.0, self.error, tuple(varied))

    def _sample(self, position: Array) -> Sampled:
        rho1 = places_of(self.teeth.pair, self.teeth.on_path(position))
        share, secant = self.shared(rho1)
        moved, tangent = np.asarray(share.transmission_error), np.asarray(share.stiffness)
        if self.teeth.pairs == "independent":
            return Sampled(
                np.stack([self.teeth.lag(moved), tangent, secant]),
                np.zeros((position.size, 0)),
                self._pairs(rho1, share),
            )
        clear = np.where(np.isfinite(rho1), _relief(self.teeth.pair, rho1), np.inf) - moved[:, None]
        if self.film is not None:
            clear = clear - self.film(rho1, np.zeros_like(rho1))[0]
            added = film_yielding(self.film, rho1, share.forces, share.forces / self.teeth.force)
            secant = secant * moved / (moved + added)
        left = np.minimum(-clear / moved.mean(), -1e-300)
        return Sampled(
            np.stack([self.teeth.lag(moved), tangent, secant]),
            np.where(share.forces > 0.0, share.forces / self.teeth.force, left),
            self._pairs(rho1, share),
        )

    def _pairs(self, rho1: Array, share: gears.LoadShare) -> Array:
        """Share, force and places of every pair (positions, pairs, 4)."""
        pair = self.teeth.pair
        rho = np.where(np.isfinite(rho1), rho1, pair.points.C)
        kinds = [share.forces / self.teeth.force, share.forces, rho, pair.line_of_action - rho]
        return np.stack(kinds, axis=-1)

    def shared(self, rho1: Array) -> tuple[gears.LoadShare, Array]:
        """Load share and secant stiffness [N/m] with pairs at curvature radii (positions, pairs) [m]."""
        teeth, force, film = self.teeth, self.teeth.force, self.film
        touching = np.isfinite(rho1)
        k = single_pair_stiffness(teeth.pair, force, rho1, teeth.model, teeth.compliance)
        k = np.where(touching, k, 0.0)
        if teeth.pairs == "independent":
            share = gears.independent_pairs(force, k, None if film is None else film.stiffness(rho1))
            return share, np.asarray(share.stiffness)
        compliance = 1.0 / np.where(touching, k, 1.0)
        bulk = compliance[..., None] * np.eye(k.shape[1])
        gaps = np.where(touching, _relief(teeth.pair, rho1), np.inf)
        placed = None if film is None else Placed(film, rho1)
        share = gears.share_load(force, bulk, Placed(_no_hertz, rho1), gaps, placed)
        return share, force / np.asarray(share.transmission_error)


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
    return position, places_of(pair, position)


def places_of(pair: gears.GearPair, position: Array) -> Array:
    """Curvature radii of the pinion's flank with a pair so many base pitches after A (positions, pairs) [m]."""
    pairs = int(np.ceil(pair.contact_ratio))
    rho1 = pair.points.A + pair.base_pitch * (position[:, None] + np.arange(pairs))
    return np.where(rho1 <= pair.points.E, rho1, np.nan)


def _no_hertz(rho1: Array, force: Array) -> tuple[Array, Array]:
    """Local deflection of closed forms: already in the single pair's stiffness at the full force."""
    return np.zeros_like(force), np.zeros_like(force)


def _relief(pair: gears.GearPair, rho1: Array) -> Array:
    """Clearance that tip relief of both gears leaves [m], nan staying nan, least zero at each position."""
    pinion, wheel = pair.teeth_profiles
    gap = pinion.relief(rho1) + wheel.relief(pair.line_of_action - rho1)
    return np.asarray(gap - np.nanmin(gap, axis=1, keepdims=True))
