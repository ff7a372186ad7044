"""Root stress of one gear along the face: loads on cells of all pairs, at a cycle's positions and on its arcs.

Loads on cells stress a fillet over some modules of the face (``fem.influence.fillet_face``), so that the maximum stress
is less concentrated than the maximum line load. The place along the face where it is largest is found first, over all
instants; along the fillet and over the cycle the stress at that place is looked at as in the plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, quantity, record
from base.results import EXACT, ITSELF
from fem.contact.face_errors import ENDS_ERROR
from fem.influence.fillet_face import places_on_face
from fem.stress.root_peaks import LOADED, OTHER, RootNodes, RootPeak, extreme, peak_of
from fem.stress.stress_over_face import CellLoads, StressOverFace
from gears.sharing.arcs import CELLS, FORCE, Arcs

if TYPE_CHECKING:
    from fem.cycle.face_loads import FaceLoads
    from gears.sharing.mesh_figures import MeshArcs

__all__ = ["FaceRootStress", "RootOnArcs", "RootOverFace", "root_over_face"]

LEFT_OF_ROOT = 0.9
"""Part of what twice as many cells changed that is left: a third in the second order, the most on few at an end."""

SINGLE = "not estimated at single places; the maximum stresses have errors"


@record
class FaceRootStress:
    """Maximum stresses along the fillets of one gear at places of its face.

    Errors of the maximum stresses are by the cells, by the waves' mesh and by free ends, beyond those of even loads.
    """

    no_error = SINGLE
    headline = ("face_factor",)

    face_position: Array = quantity(
        "m",
        "places on the gear's own face, ends included, 0 at the middle of the face in contact",
        "place",
        shown="mm",
        no_error=EXACT,
    )
    travel: Array = quantity(
        "1", "base pitches since each tooth's pair passed A", "position tooth", no_error=EXACT
    )
    tension: Array = quantity(
        "Pa",
        "maximum principal stress along the fillet under the loaded flank",
        "position tooth place",
        shown="MPa",
    )
    compression: Array = quantity(
        "Pa",
        "minimum stress along the other fillet, negative in compression",
        "position tooth place",
        shown="MPa",
    )
    cycle_tension: Array = quantity("Pa", "maximum tension of all teeth and instants", "place", shown="MPa")
    cycle_compression: Array = quantity(
        "Pa", "maximum compression of all teeth and instants, negative", "place", shown="MPa"
    )
    tangential: Array = quantity(
        "Pa",
        "stress along the fillet under the loaded flank at the instant of the maximum tension",
        "place sample",
        shown="MPa",
    )
    face_factor: float = quantity(
        "1",
        "stress face-load factor: maximum tension over its mean over the face in contact, at the instant of the "
        "greatest",
    )
    over_even: float = quantity(
        "1",
        "maximum tension over that of the same forces of all pairs spread evenly along the face: what uneven loads "
        "cost this root",
    )
    tension_error: float = quantity(
        "1",
        "estimated relative error of the maximum tension from the variation along the face",
        no_error=ITSELF,
    )
    compression_error: float = quantity(
        "1",
        "estimated relative error of the maximum compression from the variation along the face",
        no_error=ITSELF,
    )


@record
class RootOverFace:
    """What the root stress of one gear is made of where its load varies along the face.

    Attributes
    ----------
    tangential : (positions, teeth, 2, samples) array
        Stress at the cycle's positions where the maximum tension along the face is [Pa].
    tension, compression : RootPeak
    passage : (2, 2, samples) array
        Minimum and maximum stress of all instants at that place [Pa].
    face : FaceRootStress
    """

    tangential: Array
    tension: RootPeak
    compression: RootPeak
    passage: Array
    face: FaceRootStress


def root_over_face(on_arcs: RootOnArcs, face: FaceLoads, rho: Array, loaded_position: Array) -> RootOverFace:
    """Maximum stresses of a gear over its face, its fillets, all teeth and instants.

    Parameters
    ----------
    on_arcs : RootOnArcs
    face : FaceLoads
        At the cycle's positions.
    rho : (positions, pairs) array
        Curvature radii on the gear [m].
    loaded_position : (positions,) array
        Base pitches from A, of the pair that entered last.
    """
    stress, width = on_arcs.stress, face.pair.face_width
    z = places_on_face(stress.fillets.width, width / len(face.face_position)) + stress.offset
    nodes, here = on_arcs.loads(on_arcs.mesh_arcs.arcs), CellLoads(face.line_load, rho)
    extremes, sampled = stress.greatest(nodes, z), stress.greatest(here, z)
    over_cycle = [maxima.max(axis=(0, 1)) for maxima in extremes]
    tension, compression = (
        on_arcs.peak(side, _place(z, maxima))
        for side, maxima in zip((LOADED, OTHER), over_cycle, strict=True)
    )
    peak, row = tension.peak, int(np.argmax(stress.teeth == tension.peak.tooth))
    then = extremes[LOADED][tension.instant, row]
    bears = np.abs(z) <= 0.5 * width * (1.0 + 1e-9)
    mean = float(np.trapezoid(then[bears], z[bears]) / np.ptp(z[bears]))
    return RootOverFace(
        stress.at_place(here, peak.face_position),
        peak,
        compression.peak,
        tension.passage,
        FaceRootStress(
            z,
            loaded_position[:, None] + stress.teeth,
            sampled[0],
            -sampled[1],
            over_cycle[0],
            -over_cycle[1],
            stress.along(nodes.part(tension.instant), peak.tooth, z)[0, :, LOADED],
            float(then.max()) / mean,
            float(over_cycle[0].max()) / _even(stress, nodes.even, z),
            tension.error,
            compression.error,
        ),
    )


def _even(stress: StressOverFace, even: CellLoads, z: Array) -> float:
    """Maximum tension by even loads [Pa]: at the instant that is the largest where the face in contact is halved."""
    instant = int(np.argmax(stress.greatest(even, np.zeros(1))[0].max(axis=(1, 2))))
    return float(stress.greatest(even.part(instant), z)[0].max())


def _place(z: Array, values: Array) -> float:
    """Place of the maximum value, between places by the parabola through three."""
    top = int(np.argmax(values))
    return float(z[top] if top in (0, len(z) - 1) else extreme(z, values)[1])


@record
class _Found:
    """A maximum stress, its error from the variation along the face, the nearest node, and extremes of all nodes."""

    peak: RootPeak
    error: float
    instant: int
    passage: Array


@record
class RootOnArcs:
    """Stress of one gear on a cycle's arcs.

    Attributes
    ----------
    stress : StressOverFace
    mesh_arcs : MeshArcs
        With cells.
    positions : callable
        Positions of the loaded flanks at all nodes of arcs.
    gear : int
        0 is the pinion, 1 the wheel.
    mesh_error : float
        Relative, of the mesh that the waves were solved on.
    """

    stress: StressOverFace
    mesh_arcs: MeshArcs
    positions: Callable[[Arcs], Array]
    gear: int
    mesh_error: float

    def loads(self, arcs: Arcs) -> CellLoads:
        """Loads at all nodes of arcs, one after the other."""
        pairs = np.concatenate([arc.pairs for arc in arcs.arcs if arc.pairs is not None])
        return CellLoads(pairs[..., CELLS:], pairs[..., FORCE + 1 + self.gear])

    def peak(self, side: int, z: float) -> _Found:
        """Maximum stress on one side of all teeth and instants at a place of the face."""
        stress, mesh_arcs, line = self.stress, self.mesh_arcs, self.stress.fillets.influence.line
        whole = self._whole(mesh_arcs.arcs, z)
        fine, before = (
            None if of_mesh is None else self._nodes(of_mesh, z)
            for of_mesh in (mesh_arcs.arcs, mesh_arcs.before)
        )
        assert fine is not None
        peak = peak_of(fine, before, mesh_arcs.gain, stress.teeth, stress.fillets.influence, side)
        instant = int(np.argmin(np.abs(fine.position + peak.tooth - peak.position)))
        peak = replace(peak, face_position=z)
        beside = stress.beside(peak, self.loads(mesh_arcs.arcs).part(instant), side)
        error = (self.mesh_error * abs(beside.waves) + ENDS_ERROR * beside.ends) / abs(beside.stress)
        fewer = () if mesh_arcs.fewer is None else ((mesh_arcs.fewer.arcs, self._left(mesh_arcs.fewer.arcs)),)
        for arcs, share in (*fewer, *mesh_arcs.varied):  # half as many cells, other films
            error += share * abs(self._nodes(arcs, z).greatest(line, side).value / abs(peak.stress_Pa) - 1.0)
        passage = np.stack([whole.min(axis=(0, 1)), whole.max(axis=(0, 1))])
        peak = replace(peak, von_mises_Pa=abs(peak.stress_Pa / beside.stress) * beside.von_mises)
        return _Found(peak, float(error), instant, passage)

    def _left(self, fewer: Arcs) -> float:
        """Part of what fewer cells change that is error."""
        many, few = (self.loads(arcs).load.shape[-1] for arcs in (self.mesh_arcs.arcs, fewer))
        return float(LEFT_OF_ROOT / max(many / few - 1.0, 1.0))

    def _nodes(self, arcs: Arcs, z: float) -> RootNodes:
        """Stress at all nodes of arcs at a place of the face, but for what contacts do next to themselves."""
        return RootNodes(
            arcs, self.positions(arcs), self.stress.clear(self._whole(arcs, z), self.loads(arcs))
        )

    def _whole(self, arcs: Arcs, z: float) -> Array:
        """Stress at all nodes of arcs at a place of the face (n, teeth, 2, samples) [Pa]."""
        loads = self.loads(arcs)
        return self.stress.with_cells(loads.load.shape[-1]).at_place(loads, z)
