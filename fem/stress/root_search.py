"""The maximum stresses of one gear: where along the face, and there along its fillets, on all teeth and over a cycle.

Loads on cells stress a fillet over some modules of the face (``fem.influence.root_influence``), so that the maximum
stress is less concentrated than the maximum line load. The place along the face where it is largest is found first,
over all instants; along the fillet and over the cycle the stress at that place is looked at next. Where loads are even
along the face, a single cell, all places are alike.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from base import Array, record
from fem.contact.face_errors import ENDS_ERROR
from fem.elasticity.plane_elasticity import MIRROR
from fem.stress.gear_root import FaceRootStress
from fem.stress.root_peaks import LOADED, OTHER, SIGNS, RootNodes, RootPeak, extreme
from fem.stress.tooth_stress import Beside, CellLoads, ToothStress
from gears.sharing.arcs import Arcs
from gears.sharing.mesh_arcs import MeshArcs

__all__ = ["Maximum", "RootSearch", "face_root_stress"]

LEFT_OF_ROOT = 0.9
"""Part of what twice as many cells changed that is left: a third in the second order, the most on few at an end."""


@record
class Maximum:
    """A maximum stress on one side of the teeth, the nearest node of the arcs, and what the stress is made of there."""

    peak: RootPeak
    side: int
    instant: int
    beside: Beside


@record
class RootSearch:
    """Search of the maximum stresses of one gear on a cycle's arcs.

    Attributes
    ----------
    stress : ToothStress
    mesh_arcs : MeshArcs
        Of finite elements.
    positions : callable
        Positions of the loaded flanks at all nodes of arcs.
    """

    stress: ToothStress
    mesh_arcs: MeshArcs
    positions: Callable[[Arcs], Array]

    @cached_property
    def loads(self) -> CellLoads:
        """At all nodes of the arcs, one after the other."""
        return self.stress.on_arcs(self.mesh_arcs.arcs)

    @cached_property
    def places(self) -> Array:
        """Places of the face that are looked at (places,) [m]."""
        return self.stress.root.places(self.loads.load.shape[-1])

    @cached_property
    def maxima(self) -> Array:
        """Maximum tension and compression at all nodes and places (2, n, teeth, places) [Pa]."""
        return self.stress.greatest(self.loads, self.places)

    @cached_property
    def most(self) -> Array:
        """Places of the face where maximum tension and compression are (2,) [m]."""
        return np.array([_place(self.places, maxima) for maxima in self.maxima.max(axis=(1, 2))])

    @cached_property
    def whole(self) -> Array:
        """Stress at all nodes and those two places (n, teeth, 2, 2, samples) [Pa]."""
        return self.stress.at(self.loads, self.most)

    def passage(self) -> Array:
        """Minimum and maximum of all instants at the place of the maximum tension (2, 2, samples) [Pa]."""
        there = self.whole[:, :, LOADED]
        return np.stack([there.min(axis=(0, 1)), there.max(axis=(0, 1))])

    def peaks(self) -> tuple[Maximum, Maximum]:
        """Maximum tension and compression of all teeth and instants."""
        arcs, coarse = self.mesh_arcs.arcs, self.mesh_arcs.compared.before
        fine = self._clear(arcs, self.loads, self.whole)
        before = fine if coarse is None else self._nodes(coarse)
        return self._peak(fine, before, LOADED), self._peak(fine, before, OTHER)

    def _peak(self, fine: RootNodes, before: RootNodes, side: int) -> Maximum:
        stress, line = self.stress, self.stress.root.influence.line
        best, coarse = (nodes.greatest(line, side) for nodes in (fine, before))
        tooth, arc = int(stress.teeth[best.tooth]), float(extreme(line.arc, best.along)[1])
        position = best.position + float(tooth)
        instant = int(np.argmin(np.abs(fine.position + tooth - position)))
        beside = stress.beside(self.loads.part(instant), tooth, side, arc, float(self.most[side]))
        point = np.array([np.interp(arc, line.arc, line.points[:, axis]) for axis in (0, 1)])
        peak = RootPeak(
            stress_Pa=SIGNS[side] * best.value,
            von_mises_Pa=abs(best.value / beside.stress) * beside.von_mises,
            tooth=tooth,
            position=position,
            arc=arc,
            tangent_angle=float(np.interp(arc, line.arc, line.tangent_angle)),
            point=point * MIRROR if side == LOADED else point,
            along_Pa=SIGNS[side] * best.along,
            sampling=best.off / best.value,
            forces=abs(coarse.value / best.value - 1.0) / self.mesh_arcs.gain,
        )
        return Maximum(peak, side, instant, beside)

    def error(self, maximum: Maximum) -> float:
        """Estimated relative error of a maximum stress from the variation along the face."""
        beside, root = maximum.beside, self.stress.root
        error = root.waves_error * abs(beside.waves) + ENDS_ERROR * beside.ends
        error /= abs(beside.stress)
        for nodes, share in self._others:
            changed = nodes.greatest(root.influence.line, maximum.side).value / abs(maximum.peak.stress_Pa)
            error += share * abs(changed - 1.0)
        return error

    @cached_property
    def _others(self) -> list[tuple[RootNodes, float]]:
        """Stress with half as many cells and with other films, and how much of what they change is error."""
        compared = self.mesh_arcs.compared
        fewer, others = compared.fewer, [*compared.varied]
        if fewer is not None:
            many, few = (loads.load.shape[-1] for loads in (self.loads, self.stress.on_arcs(fewer.arcs)))
            others.insert(0, (fewer.arcs, float(LEFT_OF_ROOT / max(many / few - 1.0, 1.0))))
        return [(self._nodes(arcs), share) for arcs, share in others]

    def _nodes(self, arcs: Arcs) -> RootNodes:
        """Stress at all nodes of other arcs."""
        loads = self.stress.on_arcs(arcs)
        return self._clear(arcs, loads, self.stress.at(loads, self.most))

    def _clear(self, arcs: Arcs, loads: CellLoads, whole: Array) -> RootNodes:
        """Stress of either fillet at its own place, but for what contacts do next to themselves."""
        clear = self.stress.clear(whole, loads)
        own = np.stack([clear[:, :, side, side] for side in (LOADED, OTHER)], axis=2)
        return RootNodes(arcs, self.positions(arcs), own)


def _place(z: Array, values: Array) -> float:
    """Place of the maximum value, between places by the parabola through three."""
    top = int(np.argmax(values))
    return float(z[top] if top in (0, len(z) - 1) else extreme(z, values)[1])


def face_root_stress(
    search: RootSearch, peaks: tuple[Maximum, Maximum], loads: CellLoads, loaded_position: Array
) -> FaceRootStress:
    """Maximum stresses of a gear at places of its face.

    Parameters
    ----------
    search : RootSearch
    peaks : (Maximum, Maximum)
        Maximum tension and compression.
    loads : CellLoads
        At the cycle's positions.
    loaded_position : (positions,) array
        Base pitches from A, of the pair that entered last.
    """
    (tension, compression), stress, z = peaks, search.stress, search.places
    sampled, cycle = stress.greatest(loads, z), search.maxima.max(axis=(1, 2))
    row = int(np.argmax(stress.teeth == tension.peak.tooth))
    then = search.maxima[LOADED, tension.instant, row]
    bears = np.abs(z) <= 0.5 * stress.root.contact_width * (1.0 + 1e-9)
    mean = float(np.trapezoid(then[bears], z[bears]) / np.ptp(z[bears]))
    return FaceRootStress(
        face_position=z,
        travel=loaded_position[:, None] + stress.teeth,
        tension=sampled[LOADED],
        compression=-sampled[OTHER],
        cycle_tension=cycle[LOADED],
        cycle_compression=-cycle[OTHER],
        tangential=stress.along(search.loads.part(tension.instant), tension.peak.tooth, z)[0, :, LOADED],
        face_factor=float(then.max()) / mean,
        over_even=float(cycle[LOADED].max()) / _even(search),
        tension_error=search.error(tension),
        compression_error=search.error(compression),
    )


def _even(search: RootSearch) -> float:
    """Maximum tension by even loads [Pa]: at the instant that is the largest where the face in contact is halved."""
    stress, even = search.stress, search.loads.even
    instant = int(np.argmax(stress.greatest(even, np.zeros(1))[LOADED].max(axis=(1, 2))))
    return float(stress.greatest(even.part(instant), search.places)[LOADED].max())
