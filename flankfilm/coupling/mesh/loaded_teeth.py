"""A loaded pair by one stiffness model: mesh cycles at any number of positions, dry or with films in series."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, TypedDict

import fem
import gears
from base import Faults, Limit, SolverError
from flankfilm.coupling.mesh.deflection_law import DeflectionLaw
from flankfilm.coupling.mesh.flanks import PLAIN_FLANKS, Flanks
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.coupling.mesh.require_converged import believed
from flankfilm.coupling.mesh.resolution import POSITIONS
from flankfilm.coupling.mesh.sharing_pairs import SharingPairs
from flankfilm.coupling.mesh.single_pairs import CLOSED_FORMS, MODELS
from gears.pair.spur_only import check_spur

SOFTER = (
    "films softer than the teeth draw the load to the pair that has most of it; raise the torque, or lower speed and "
    "viscosity"
)
"""Why films and load share do not agree, and what to do."""


class TeethOptions(TypedDict, total=False):
    """Fields of `LoadedTeeth` that may be left out, as keyword arguments."""

    model: str
    pairs: str
    compliance: fem.PairCompliance | None
    flanks: Flanks
    reference: str | None
    bore_inertia: tuple[float, float]


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
    compliance : fem.PairCompliance, optional
        For finite elements; see `meshed`.
    flanks : Flanks
        For finite elements of coupled pairs.
    reference : {"body", "bore", "teeth"}, optional
        What the deflection by finite elements is measured against, as of `fem.mesh_cycle`: the bodies unless given.
        Closed forms describe the deflection against the teeth, and independent pairs by finite elements that against
        the bores; both are what they are.
    bore_inertia : (float, float)
        What turns with the bores of pinion and wheel beside their own bodies, for "body" [kg m2].
    """

    pair: gears.GearPair
    torque: float
    model: str = "fem"
    pairs: str = "coupled"
    compliance: fem.PairCompliance | None = None
    flanks: Flanks = PLAIN_FLANKS
    reference: str | None = None
    bore_inertia: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Check what is given, and the names of the models."""
        with Faults() as faults:
            ready = faults.instance("pair", self.pair, gears.GearPair)
            if ready and (self.model, self.pairs) != ("fem", "coupled"):
                check_spur(faults, self.pair, "single pairs")
            faults.number("torque", self.torque, Limit(unit="N m", remedy="give the pinion's torque"))
            faults.instance(
                "compliance", self.compliance, fem.PairCompliance, "as of fem.compliance", optional=True
            )
            faults.instance("flanks", self.flanks, Flanks)
            faults.choice("model", self.model, tuple(MODELS))
            faults.choice("pairs", self.pairs, ("coupled", "independent"))
            if self.reference is not None:
                faults.choice("reference", self.reference, tuple(MEANINGS))
            if self.reference is not None and (self.model, self.pairs) != ("fem", "coupled"):
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

        compliance = fem.compliance(self.pair, tolerance=tolerance)
        return replace(self, compliance=believed(compliance, "tooth compliance"))

    @property
    def setting(self) -> dict[str, Any]:
        """What `fem.mesh_cycle` takes beside pair, torque and positions."""
        return {"compliance": self.compliance, "reference": self.reference, **vars(self.flanks)}

    def measured(self, contact: fem.MeshCycle) -> fem.MeshCycle:
        """Loaded contact with the inertia on the bores, which counts for what it is measured against."""
        if contact.reference != "body" or self.bore_inertia == (0.0, 0.0):
            return contact
        return replace(contact.against("body", self.bore_inertia), origin=None)

    @property
    def force(self) -> float:
        """Normal force of all pairs together [N]."""
        return abs(self.pair.normal_force(self.torque))

    def cycle(
        self,
        positions: int,
        film: DeflectionLaw | None = None,
        tolerance: float = 1e-3,
        varied: tuple[tuple[DeflectionLaw, float], ...] = (),
    ) -> MeshCycle:
        """Mesh cycle at the midpoints of some equal intervals of one base pitch.

        Parameters
        ----------
        positions : int
            Number of intervals.
        film : DeflectionLaw, optional
            Films in series with the pairs; dry without.
        tolerance : float
            Relative, of means, extremes and harmonics.
        varied : tuple of (DeflectionLaw, float)
            Other films, and how much of what they change of a figure is its error.

        Raises
        ------
        SolverError
            Where the loaded contact did not converge.
        """
        if (self.model, self.pairs) != ("fem", "coupled"):
            arguments = self.pair, self.torque, self.model, self.pairs, self.compliance
            return SharingPairs(*arguments, film, tolerance, varied).cycle(positions)
        contact = fem.mesh_cycle(
            self.pair, self.torque, positions=positions, film=film, tolerance=tolerance, **self.setting
        )
        contact = self.measured(believed(contact, "loaded tooth contact"))
        if film is not None and contact.problem is not None:
            corners = film.corners(self.pair)
            problem = replace(contact.problem, corners=corners, film_yields=True, varied=varied)
            contact = replace(contact, problem=problem)
        return MeshCycle(label=MODELS["fem"], **MeshCycle.fields_of(contact), contact=contact)

    def with_films(
        self,
        positions: int,
        film: DeflectionLaw,
        tolerance: float = 1e-3,
        varied: tuple[tuple[DeflectionLaw, float], ...] = (),
    ) -> MeshCycle:
        """Mesh cycle with films, of teeth that have one without; arguments as of `cycle`.

        Raises
        ------
        SolverError
            Where films are so soft that no load share is found.
        """
        try:
            return self.cycle(positions, film, tolerance, varied)
        except (gears.LoadSharingError, SolverError) as fault:
            raise SolverError(f"no load share with these films was found: {SOFTER}") from fault

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
        cycle = self.cycle(POSITIONS, tolerance=min(sampling, transmission_error))
        arcs = cycle.arcs  # raises where there is no solution between the positions
        assert arcs is not None
        return cycle

    def others(self, positions: int) -> tuple[MeshCycle, ...]:
        """Dry cycles of independent pairs by every other closed form, and by finite elements if these are at hand."""
        models = [*CLOSED_FORMS, *(["fem"] if self.model == "fem" else [])]
        return tuple(
            replace(self, model=model, pairs="independent", reference=None).cycle(positions)
            for model in models
            if (model, "independent") != (self.model, self.pairs)
        )
