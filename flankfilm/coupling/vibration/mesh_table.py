"""What a program for the vibration of shafts takes of a pair: stiffness over angle, transmission error, inertias."""

from __future__ import annotations

import math

import numpy as np

import gears
from base import Array, Cost, described, quantity, record
from base.results import EXACT
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.coupling.vibration.oscillator import pair_inertias, pair_scales


@record
class MeshTable:
    """A pair over one base pitch as a spring between two rigid discs, acting along the transverse line of action.

    The spring's force is f = k (r_b1 theta_1 - r_b2 theta_2 - e) with k over the pinion's turn; on the discs it acts by
    the moments f r_b1 and f r_b2. The stiffness is measured against the bodies, as discs turn, where the model has a
    turn that all pairs share; see `reference`.
    """

    no_error = EXACT

    headline = ("mean_stiffness", "equivalent_mass", "backlash")

    angle: Array = quantity("rad", "rotation of the pinion after a pair is at A", "position", shown="deg")
    stiffness: Array = quantity(
        "N/m",
        "tangent stiffness of the mesh, for small vibration",
        "position",
        error="error",
        called="tangent_stiffness",
    )
    secant_stiffness: Array = quantity(
        "N/m", "secant stiffness of the mesh, for motion with separation", "position", error="error"
    )
    transmission_error: Array = quantity(
        "m", "loaded transmission error along the line of action", "position", shown="um", error="error"
    )
    mean_stiffness: float = quantity(
        "N/m", "mean of the tangent stiffness", error="error", called="mean_tangent_stiffness"
    )
    mean_secant_stiffness: float = quantity("N/m", "mean of the secant stiffness", error="error")
    force: float = quantity("N", "force of the mesh along the transverse line of action")
    backlash: float = quantity("m", "backlash along the transverse line of action", shown="um")
    equivalent_mass: float = quantity("kg", "equivalent mass along the line of action")
    inertias: tuple[float, float] = quantity("kg m2", "moments of inertia of pinion and wheel", "gear")
    base_radii: tuple[float, float] = quantity("m", "base radii of pinion and wheel", "gear", shown="mm")
    teeth: tuple[int, int] = quantity("1", "numbers of teeth", "gear")
    pressure_angle: float = quantity("rad", "working pressure angle", shown="deg")
    face_width: float = quantity("m", "face width", shown="mm")
    reference: str = quantity("", "what the deflection is measured against")
    label: str = quantity("", "model of the mesh cycle")
    error: float | None
    cost: Cost

    @described("1")
    def relative_error(self) -> float:
        """Estimated relative numerical error of stiffness and transmission error; nan where a model's is unknown."""
        return math.nan if self.error is None else self.error


def mesh_table(
    pair: gears.GearPair, cycle: MeshCycle, extra_inertia: tuple[float, float] = (0.0, 0.0)
) -> MeshTable:
    """Table of a mesh cycle for programs that vibrate shafts.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of the pair, dry or with its film.
    extra_inertia : (float, float)
        What turns with pinion and wheel, on their bores [kg m2].

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> table = mesh_table(pair, mesh_cycle(pair, 600.0, positions=40, model="potential-energy"))
    >>> table.angle.size, round(table.equivalent_mass, 3)
    (40, 0.381)
    """
    measured, extra = cycle, extra_inertia
    if cycle.contact is not None:
        measured = cycle.against("body", extra_inertia)
    pitch = pair.teeth_profiles[0].pitch_angle
    force = float(np.sum(measured.forces[0])) * pair.helix.base_cosine
    scales = pair_scales(pair, force * pair.base_radii[0], measured.mean_stiffness, extra)
    return MeshTable(
        angle=measured.position * pitch,
        stiffness=measured.stiffness,
        secant_stiffness=measured.secant_stiffness,
        transmission_error=measured.transmission_error,
        mean_stiffness=measured.mean_stiffness,
        mean_secant_stiffness=measured.mean_secant_stiffness,
        force=force,
        backlash=pair.base_tangent_backlash,
        equivalent_mass=scales.equivalent_mass,
        inertias=pair_inertias(pair, extra),
        base_radii=pair.base_radii,
        teeth=(pair.pinion.teeth, pair.wheel.teeth),
        pressure_angle=pair.working_pressure_angle,
        face_width=pair.face_width,
        reference=MEANINGS[measured.reference],
        label=measured.label,
        error=measured.error,
        cost=measured.cost,
    )
