"""Mesh stiffness over one base pitch, from whichever model, in one form for all that follows."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol, Self

import numpy as np

import fem
from base import Array, Cost, InputError, described, part, quantity, record
from base.results import ITSELF
from gears.closed_form.record import UNKNOWN
from gears.sharing.mesh_arcs import MeshArcs
from gears.sharing.mesh_figures import MeshFigures


class ByPairs(Protocol):
    """Pairs that share a load by themselves, at any position."""

    def arcs(self) -> MeshArcs:
        """Find the arcs."""


@record
class MeshCycle(MeshFigures):
    """Stiffness, load share and deflection at the midpoints of equal intervals of one base pitch, by any model.

    Means, extremes and harmonics are those of the curves on smooth arcs between events, whatever the positions.
    ``error`` is the estimated relative numerical error at each position; None where the model's error is unknown.
    """

    headline: ClassVar[tuple[str, ...]] = (
        "label",
        "mean_secant_stiffness",
        "mean_stiffness",
        "transmission_error_range",
    )

    label: str = quantity("", "model of the mesh cycle")
    position: Array = quantity("1", "position, base pitches from A", "position")
    rho1: Array = quantity(
        "m",
        "curvature radius of the pinion's flank at the contact; nan without contact",
        "position pair",
        shown="mm",
    )
    forces: Array = quantity("N", "normal force of each pair", "position pair")
    load_share: Array = quantity("1", "load share: each pair's share of the torque", "position pair")
    secant_stiffness: Array = quantity(
        "N/m", "secant stiffness: force over deflection", "position", error="error"
    )
    stiffness: Array = quantity(
        "N/m",
        "tangent stiffness: slope of force over deflection",
        "position",
        error="error",
        called="tangent_stiffness",
    )
    transmission_error: Array = quantity(
        "m",
        "loaded transmission error: deflection along the line of action",
        "position",
        shown="um",
        error="error",
    )
    error: float | None
    cost: Cost
    contact: fem.MeshCycle | None = part(
        "loaded contact by finite elements that it was taken from; None by other models", default=None
    )
    by_pairs: ByPairs | None = part(
        "what the arcs of other models are found from; None by finite elements of coupled pairs", default=None
    )
    converged: bool = True
    message: str = ""
    reference: str = quantity(
        "",
        'what the deflection is measured against: "body", "bore" or "teeth", as which closed forms count',
        default="teeth",
    )

    def against(self, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)) -> Self:
        """Measure the deflection of coupled finite elements against something else; no force changes.

        Parameters
        ----------
        reference : {"body", "bore", "teeth"}
            As of `fem.mesh_cycle`.
        bore_inertia : (float, float)
            What turns with the bores of pinion and wheel beside their own bodies, for "body" [kg m2].

        Raises
        ------
        InputError
            For closed forms and independent pairs, whose pairs have no turn in common; no such reference.
        """
        if self.contact is None:
            allowed = "requires a loaded contact by finite elements of coupled pairs"
            raise InputError.at("reference", f"{reference!r} of {self.label}", allowed, "take them")
        before, after = self.contact, self.contact.against(reference, bore_inertia)
        softer = before.force / before.secant_stiffness - after.force / after.secant_stiffness  # D - D'
        steeper = after.stiffness / before.stiffness
        return replace(
            self,
            contact=after,
            reference=after.reference,
            transmission_error=self.transmission_error - softer,
            secant_stiffness=before.force / (before.force / self.secant_stiffness - softer),
            stiffness=self.stiffness * steeper,
            error=None if self.error is None else self.error * max(1.0, float(np.max(steeper))),
        )

    @cached_property
    def arcs(self) -> MeshArcs | None:
        """Curves on smooth arcs between events, found when they are first asked for.

        Raises
        ------
        SolverError
            Where the contact has no solution between the positions.
        """
        if self.contact is not None:
            return self.contact.arcs
        return None if self.by_pairs is None else self.by_pairs.arcs()

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        return UNKNOWN if self.error is None else super().no_error

    @described("1", shown="%", no_error=ITSELF)
    def model_error(self) -> float | None:
        """Estimated relative error of transmission error and secant stiffness by the model of the contacts.

        Large strain, second order, the width of contacts, and motion of contacts that stay; None of closed forms,
        of which it is not known.
        """
        return None if self.contact is None else self.contact.model_error

    @described("1", no_error=ITSELF)
    def mean_error(self) -> float | None:
        """Estimated relative numerical error of the mean secant stiffness, of meshes and arcs."""
        return self.errors["mean_secant_stiffness"]

    @described("1", no_error=ITSELF)
    def range_error(self) -> float | None:
        """Estimated relative numerical error of the peak-to-peak transmission error, of meshes and arcs."""
        return self.errors["transmission_error_range"]

    @property
    def face(self) -> fem.FaceLoads | None:
        """What cells of the face bear; None where the load is even along it, as closed forms take it."""
        return None if self.contact is None else self.contact.face

    @property
    def lines(self) -> fem.LineLoads | None:
        """What lines of contact across the face carry; None of spur pairs, and of other models."""
        return None if self.contact is None else self.contact.lines

    @property
    def film_compliance(self) -> Array:
        """What films yield by the mean load beyond dry teeth, over that load (positions,) [m/N]: nothing."""
        return np.zeros(self.position.size)

    def curve(self, kind: str) -> Array:
        """Curve of a kind of stiffness, ``"secant"`` or ``"tangent"`` (positions,) [N/m]."""
        return {"secant": self.secant_stiffness, "tangent": self.stiffness}[kind]

    def mean(self, kind: str) -> float:
        """Mean of a kind of stiffness [N/m]."""
        return {"secant": self.mean_secant_stiffness, "tangent": self.mean_stiffness}[kind]

    @classmethod
    def fields_of(cls, other: object) -> dict[str, Any]:
        """Fields of this class that another record has as well, for one made of it."""
        return {field.name: getattr(other, field.name) for field in fields(cls) if hasattr(other, field.name)}
