"""Root stress of both gears along the mesh cycle.

Forces of a loaded mesh cycle times the influence functions of the fillets (``fem.influence.fillet_influence``), all
loaded teeth together: a tooth's root also feels the loads of its neighbours. Maximum stresses are those on the cycle's
arcs between events, where forces have corners and steps, whatever the cycle's positions. The fillet is a free edge, so
the stress there is uniaxial along it: sigma_t is a principal stress, the one across is zero, and in plane strain the
third is nu sigma_t.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, InputError, Stopwatch, described, part, quantity, record
from fem.cycle.line_loads import LineLoads
from fem.cycle.mesh_cycle import MeshCycle
from fem.laws.mesh_setup import MeshSetup
from fem.pair.line_fillets import LineFillets, line_fillets
from fem.pair.pair_fillets import Fillets
from fem.pair.pair_fillets import fillets as _fillets
from fem.stress.face_fillets import EVEN, root_influences
from fem.stress.gear_root import GearRootStress
from fem.stress.line_roots import LineRoots
from fem.stress.root_peaks import LOADED, OTHER
from fem.stress.root_search import RootSearch, face_root_stress
from fem.stress.tooth_stress import CellLoads, ToothStress
from gears.sharing.arcs import Arcs

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["RootStress", "root_stress"]


@record
class RootStress:
    """Root stress of both gears along a mesh cycle."""

    headline = ("pinion_tension_Pa", "wheel_tension_Pa")

    pinion: GearRootStress = part("of the pinion")
    wheel: GearRootStress = part("of the wheel")
    error: float = quantity(
        "1",
        "largest estimated relative numerical error of the maximum stresses: of the fillets' mesh, of the forces, and "
        "of what lies between the instants",
    )
    cost: Cost
    converged: bool
    message: str

    @property
    def errors(self) -> Mapping[str, float]:
        """Estimated relative errors of the maximum tensions by their names."""
        gears = {"pinion_tension_Pa": self.pinion, "wheel_tension_Pa": self.wheel}
        return {name: gear.errors["greatest_tension_Pa"] for name, gear in gears.items()}

    @described("Pa", shown="MPa", error="errors")
    def pinion_tension_Pa(self) -> float:
        """Maximum tension on the pinion's fillets."""
        return self.pinion.greatest_tension_Pa

    @described("Pa", shown="MPa", error="errors")
    def wheel_tension_Pa(self) -> float:
        """Maximum tension on the wheel's fillets."""
        return self.wheel.greatest_tension_Pa


def root_stress(
    pair: GearPair,
    cycle: MeshCycle,
    fillets: Fillets | LineFillets | None = None,
    tolerance: float = 0.005,
) -> RootStress:
    """Stress along the fillets of every loaded tooth and its neighbours.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of this pair; its normal forces are used, friction is left out. A tip edge is taken to press along the
        normal of the edge's flank at the end of the involute.
    fillets : Fillets or LineFillets, optional
        Of this pair in the cycle's plane, to be used again for other torques or positions; computed to
        ``tolerance`` unless given. Of a helical pair they are `LineFillets`.
    tolerance : float
        Relative, on the maximum stress.

    Returns
    -------
    RootStress
        With cells of the face also over the face; what else is given for all teeth and samples is then at the place of
        the maximum tension along the face. So with lines of contact, where the cycle's positions alone are looked at.

    Raises
    ------
    base.InputError
        Fillets of another pair or plane, or a cycle without forces or without arcs.
    base.SolverError
        The contact has no solution between the cycle's positions.

    Examples
    --------
    >>> from fem import compliance, mesh_cycle, root_stress
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, 600.0, positions=8, compliance=compliance(pair, tolerance=0.05))
    >>> found = root_stress(pair, cycle, tolerance=0.1)
    >>> round(found.pinion_tension_Pa / 1e6, -1)
    470.0
    """
    faults = Faults()
    if fillets is not None and fillets.pair != pair:
        faults.add("fillets", "of another pair", "must be of this pair", "compute them anew")
    if cycle.lines is not None and isinstance(fillets, Fillets):
        faults.add("fillets", "of a spur pair", "must be LineFillets", "take them from line_fillets")
    if cycle.lines is None and isinstance(fillets, LineFillets):
        faults.add("fillets", "of a helical pair", "must be Fillets", "take them from fillets")
    if isinstance(fillets, Fillets) and fillets.plane != cycle.plane:
        faults.add("fillets", f"plane {fillets.plane}", f"must be of plane {cycle.plane}", "use one plane")
    if not np.all(np.isfinite(cycle.forces)):
        faults.add("cycle", "not converged", "must have finite forces", cycle.message)
    elif cycle.opposite is not None:
        allowed = "must have flanks that bear on one side of the teeth"
        faults.add("cycle", "flanks that bear on both sides", allowed, "give more backlash")
    faults.raise_if_any()
    if cycle.lines is not None:
        assert not isinstance(fillets, Fillets)  # refused above
        return _of_lines(pair, cycle, cycle.lines, fillets, tolerance)
    assert not isinstance(fillets, LineFillets)
    arcs = cycle.arcs
    if arcs is None:
        raise InputError.at(
            "cycle", "curves alone", "must have arcs between events", "take it from mesh_cycle"
        )
    watch = Stopwatch()
    roots = fillets if fillets is not None else _fillets(pair, tolerance, cycle.plane)
    ready = watch.seconds
    model, line_load = _over_cells(pair, cycle)
    searches = (
        RootSearch(ToothStress(root, cycle.pair_offset, gear), arcs, partial(_positions, cycle))
        for gear, root in enumerate(root_influences(roots, pair, model))
    )
    pinion, wheel = (_gear_stress(pair, cycle, roots, search, line_load) for search in searches)
    parts = {**({} if fillets is not None else roots.cost.parts), "superpose": watch.seconds - ready}
    cost = Cost(watch.seconds, roots.cost.unknowns, parts=parts, counts=roots.cost.counts)
    return RootStress(
        pinion,
        wheel,
        max(max(stress.errors.values()) for stress in (pinion, wheel)),
        cost,
        roots.converged and cycle.converged,
        roots.message,
    )


def _of_lines(
    pair: GearPair, cycle: MeshCycle, lines: LineLoads, fillets: LineFillets | None, tolerance: float
) -> RootStress:
    """Stress under the lines of contact of a helical pair."""
    watch = Stopwatch()
    roots = fillets if fillets is not None else line_fillets(pair, tolerance)
    ready = watch.seconds
    pinion, wheel = (
        LineRoots(
            of_gear, lines, gear, cycle.pair_offset, float(roots.errors[gear]), cycle.error
        ).along_cycle()
        for gear, of_gear in enumerate((roots.pinion, roots.wheel))
    )
    parts = {**({} if fillets is not None else roots.cost.parts), "superpose": watch.seconds - ready}
    return RootStress(
        pinion,
        wheel,
        max(max(stress.errors.values()) for stress in (pinion, wheel)),
        Cost(watch.seconds, parts=parts),
        roots.converged and cycle.converged,
        roots.message,
    )


def _over_cells(pair: GearPair, cycle: MeshCycle) -> tuple[str, Array]:
    """What couples the cells of the face, and line loads on them [N/m]; a face of even loads is a single cell."""
    if cycle.face is None:
        return EVEN, cycle.forces[..., None] / pair.face_width
    return cycle.face.setting.model, cycle.face.line_load


def _gear_stress(
    pair: GearPair, cycle: MeshCycle, roots: Fillets, search: RootSearch, line_load: Array
) -> GearRootStress:
    """Stress at the cycle's positions, and the largest on its arcs."""
    stress = search.stress
    gear, even = stress.gear, stress.root.influence
    peaks, loads = search.peaks(), CellLoads(line_load, cycle.flank_rho[gear])
    over_face, tension, compression = None, peaks[LOADED].peak, peaks[OTHER].peak
    if cycle.face is not None:
        over_face = face_root_stress(search, peaks, loads, cycle.loaded_position)
        tension, compression = (
            replace(peak, face_position=float(z))
            for peak, z in zip((tension, compression), search.most, strict=True)
        )
    return GearRootStress(
        even.line,
        even.law,
        cycle.loaded_position,
        stress.teeth,
        stress.at(loads, search.most[:1])[:, :, 0],
        tension,
        compression,
        search.passage(),
        float(roots.errors[gear]),
        over_face,
        webbed=(pair.pinion, pair.wheel)[gear].blank is not None,
    )


def _positions(cycle: MeshCycle, arcs: Arcs) -> Array:
    """Positions of the loaded flanks at all nodes of the arcs, as `MeshCycle.loaded_position`."""
    if cycle.flank == "front":
        return np.concatenate([arc.position for arc in arcs.arcs])
    positions = []
    for arc in arcs.arcs:
        middle = arc.low + 0.5 * arc.width  # ends of arcs may be where the path starts anew
        positions.append((MeshSetup(cycle.pair).mirror - middle) % 1.0 + middle - arc.position)
    return np.concatenate(positions)
