"""Root stress along the mesh cycle by finite elements, beside ISO 6336-3, and fields of the loaded gears."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import fem
import gears
from base import Cost, Stopwatch, part, quantity, record, unclocked
from flankfilm.coupling.mesh.face_models import left_out_by_iso
from flankfilm.coupling.mesh.require_converged import believed

if TYPE_CHECKING:
    from fem import ResultStore
    from fem.fields.stress_fields import GearField


@record
class RootStresses:
    """Root stress of both gears along the mesh cycle, and the nominal stress by ISO 6336-3 where that has an answer."""

    headline = ("iso_fault",)

    stress: fem.RootStress = part("along the mesh cycle, by finite elements")
    iso: gears.closed_form.Iso6336RootStress | None = part(
        "nominal stress by ISO 6336-3; None where it has no answer"
    )
    iso_fault: str = quantity("", "why ISO 6336-3 has no answer")
    iso_face: gears.closed_form.Iso6336FaceLoad | None = part(
        "face-load factors by ISO 6336-1, method C; None of loads that are even along the face"
    )
    iso_left_out: str = quantity(
        "", "what varies the load along this face and is not in the factors by ISO 6336-1"
    )
    error: float | None
    cost: Cost
    converged: bool = True
    message: str = ""


@record
class LoadedFields:
    """Stress and displacement of both gears, in the common frame, with a pair at the pitch point."""

    position: int = quantity("1", "row of the mesh cycle")
    pinion: GearField = part("of the pinion")
    wheel: GearField = part("of the wheel")
    error: float | None
    cost: Cost
    converged: bool = True
    message: str = ""


def root_stresses(
    pair: gears.GearPair, cycle: fem.MeshCycle, fillets: fem.Fillets | fem.LineFillets
) -> RootStresses:
    """Stress at the fillets with the forces of a loaded contact.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : fem.MeshCycle
        With the film where there is one.
    fillets : fem.Fillets or fem.LineFillets
        Of the same gears with plain flanks.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> import fem
    >>> cycle = fem.mesh_cycle(pair, torque=600.0, positions=8)
    >>> found = root_stresses(pair, cycle, fillets_of(pair, tolerance=0.05))
    >>> 1e8 < found.stress.pinion.greatest_tension.stress_Pa < 1e9
    True
    """
    with unclocked():
        import fem
        from gears import GeometryError
        from gears.closed_form import iso6336_3, iso6336_face_load
    watch = Stopwatch()
    stresses = fem.root_stress(pair, cycle, replace(fillets, pair=pair))
    iso, fault = None, ""
    try:
        iso = iso6336_3(pair, abs(pair.normal_force(cycle.torque)))
    except GeometryError as error:
        fault = str(error)
    face, over, left_out = cycle.face, None, ""
    if face is not None:
        left_out = left_out_by_iso(face, pair)
        try:
            over = iso6336_face_load(pair, abs(cycle.torque), abs(face.setting.slope))
        except GeometryError as error:
            fault = "; ".join(reason for reason in (fault, str(error)) if reason)
    return RootStresses(stresses, iso, fault, over, left_out, stresses.error, Cost(watch.seconds))


def fillets_over_face(
    fillets: fem.Fillets, pair: gears.GearPair, model: str, kept: ResultStore | None = None
) -> fem.FaceFillets:
    """Fillets of both gears under loads that vary along the face; `root_stresses` finds them in the process.

    Parameters
    ----------
    fillets : fem.Fillets
        Of the same gears with plain flanks.
    pair : gears.GearPair
    model : str
        ``"free-ends"``, ``"walls"`` or ``"slices"``.
    kept : callable, optional
        As of `fem.fillets`.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=20), module=2e-3, face_width=20e-3)
    >>> fillets_over_face(fillets_of(pair, tolerance=0.1), pair, "walls").ends is None
    True
    """
    with unclocked():
        import fem
    return fem.face_fillets(fillets, pair, model, kept)


def fillets_of(
    pair: gears.GearPair, tolerance: float, plane: str = "strain", kept: ResultStore | None = None
) -> fem.Fillets | fem.LineFillets:
    """What loads anywhere on the flanks do to the fillets, by a mesh made for them; of a helical pair with its ends.

    Parameters
    ----------
    pair : gears.GearPair
        With plain flanks, and bores as large as the rigid hubs: what a hub fills carries no stress.
    tolerance : float
        Relative, of the stress.
    plane : str
        ``"strain"`` or ``"stress"``.
    kept : callable, optional
        As of `fem.fillets`.

    Raises
    ------
    SolverError
        Where the tolerance was missed.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> fillets_of(pair, tolerance=0.05).error < 0.05
    True
    """
    if pair.helix_angle != 0.0:
        return believed(fem.line_fillets(pair, tolerance=tolerance, kept=kept), "root stress")
    return believed(fem.fillets(pair, tolerance=tolerance, plane=plane, kept=kept), "root stress")


def pitch_point_fields(
    pair: gears.GearPair, cycle: fem.MeshCycle, compliance: fem.PairCompliance
) -> LoadedFields:
    """Fields with a pair nearest to the pitch point.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : fem.MeshCycle
        Loaded contact that the fields belong to.
    compliance : fem.PairCompliance

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> import fem
    >>> bodies = fem.compliance(pair)
    >>> cycle = fem.mesh_cycle(pair, torque=600.0, positions=8, compliance=bodies)
    >>> pitch_point_fields(pair, cycle, bodies).position
    6
    """
    with unclocked():
        from fem.fields.stress_fields import loaded_fields
    watch = Stopwatch()
    distance = np.abs(np.where(np.isfinite(cycle.rho1), cycle.rho1, np.inf) - pair.points.C)
    position = int(np.argmin(distance.min(axis=1)))
    pinion, wheel = loaded_fields(pair, cycle, position, compliance=compliance)
    return LoadedFields(position, pinion, wheel, compliance.error, Cost(watch.seconds))
