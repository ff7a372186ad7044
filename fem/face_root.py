"""Root stress of one gear along the face: loads on cells of all pairs, at a cycle's positions and on its arcs.

Loads on cells stress a fillet over some modules of the face (``fem.fillet_face``), so that the greatest stress is less
concentrated than the greatest line load. The place along the face where it is greatest is found first, over all
instants; along the fillet and over the cycle the stress at that place is looked at as in the plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, quantity, record
from base.results import EXACT, ITSELF
from fem.fillet_face import FilletFace, places_on_face
from fem.root_peaks import LOADED, OTHER, RootNodes, RootPeak, extreme, peak_of
from gears.arcs import CELLS, FORCE, Arcs

if TYPE_CHECKING:
    from fem.face_loads import FaceLoads
    from gears.mesh_figures import MeshArcs

__all__ = ["CellLoads", "FaceRootStress", "RootOverFace", "StressOverFace", "root_over_face"]

ENDS_ERROR = 0.1
"""Part of what free ends do to the greatest stress that their coarse section leaves uncertain."""

SINGLE = "not estimated at single places; the greatest stresses have errors"


@record
class FaceRootStress:
    """Greatest stresses along the fillets of one gear at places of its face.

    Errors of the greatest stresses are by the cells, by the waves' mesh and by free ends, beyond those of even loads.
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
        "greatest principal stress along the fillet under the loaded flank",
        "position tooth place",
        shown="MPa",
    )
    compression: Array = quantity(
        "Pa",
        "least stress along the other fillet, negative in compression",
        "position tooth place",
        shown="MPa",
    )
    cycle_tension: Array = quantity("Pa", "greatest tension of all teeth and instants", "place", shown="MPa")
    cycle_compression: Array = quantity(
        "Pa", "greatest compression of all teeth and instants, negative", "place", shown="MPa"
    )
    tangential: Array = quantity(
        "Pa",
        "stress along the fillet under the loaded flank at the instant of the greatest tension",
        "place sample",
        shown="MPa",
    )
    face_factor: float = quantity(
        "1",
        "stress face-load factor: greatest tension over its mean over the face in contact, at the instant of the "
        "greatest",
    )
    tension_error: float = quantity(
        "1", "estimated relative error of the greatest tension by what varies along the face", no_error=ITSELF
    )
    compression_error: float = quantity(
        "1",
        "estimated relative error of the greatest compression by what varies along the face",
        no_error=ITSELF,
    )


@record
class CellLoads:
    """Line loads on the cells of all pairs at some instants.

    Attributes
    ----------
    load : (n, pairs, cells) array
        [N/m]
    rho : (n, pairs) array
        Curvature radius at which the gear's flank is touched [m].
    """

    load: Array
    rho: Array

    @classmethod
    def at_nodes(cls, arcs: Arcs, gear: int) -> CellLoads:
        """Loads at all nodes of arcs, one after the other."""
        nodes = [arc.pairs for arc in arcs.arcs if arc.pairs is not None]
        every = np.concatenate(nodes)
        return cls(every[..., CELLS:], every[..., FORCE + 1 + gear])

    def part(self, row: int) -> CellLoads:
        """Loads at a single instant."""
        return CellLoads(self.load[row : row + 1], self.rho[row : row + 1])

    @property
    def even(self) -> CellLoads:
        """The same forces spread evenly."""
        return CellLoads(np.zeros_like(self.load) + self.load.mean(axis=-1, keepdims=True), self.rho)


@record
class StressOverFace:
    """Stress on the fillets of one gear under loads on cells; columns of loads are pairs, so many base pitches ahead.

    Attributes
    ----------
    fillets : FilletFace
    offsets : (pairs,) array of int
    teeth : (teeth,) array of int
        On which the stress is wanted, base pitches ahead.
    turn : int
        1 on the pinion, where the pair ahead is the next tooth anticlockwise; -1 on the wheel.
    offset : float
        Middle of the gear's own face from that of the face in contact [m].
    """

    fillets: FilletFace
    offsets: Integers
    teeth: Integers
    turn: int
    offset: float

    def along(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Stress along the fillets of a tooth (n, places, 2, samples) [Pa] at places of the face in contact."""
        total = np.zeros((len(loads.load), len(z), 2, len(self.fillets.influence.line.arc)))
        for rows, away, rho, load in self._loaded(loads, tooth):
            total[rows] += self.fillets.tangential(away, rho, load, z - self.offset)
        return total

    def von_mises(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Von Mises stress at a single instant (places, 2, samples) [Pa]."""
        parts = [
            self.fillets.components(away, rho, load, z - self.offset)
            for _, away, rho, load in self._loaded(loads, tooth)
        ]
        return self.fillets.von_mises(parts)

    def _loaded(self, loads: CellLoads, tooth: int) -> list[tuple[Integers, int, Array, Array]]:
        """Instants, tooth counted from the loaded one, places and loads of every pair that bears."""
        found = []
        for column, offset in enumerate(self.offsets):
            rows = np.flatnonzero(loads.load[:, column].max(axis=-1) > 0.0)
            away = self.turn * int(tooth - offset)
            found.append((rows, away, loads.rho[rows, column], loads.load[rows, column]))
        return found

    def greatest(self, loads: CellLoads, z: Array) -> tuple[Array, Array]:
        """Greatest tension, and greatest compression as a positive number (n, teeth, places) [Pa]."""
        arc = self.fillets.influence.line.arc
        by_tooth = [self.along(loads, int(tooth), z) for tooth in self.teeth]
        tension = np.stack([extreme(arc, one[:, :, LOADED])[0] for one in by_tooth], axis=1)
        compression = np.stack([extreme(arc, -one[:, :, OTHER])[0] for one in by_tooth], axis=1)
        return tension, compression

    def at_place(self, loads: CellLoads, z: float) -> Array:
        """Stress (n, teeth, 2, samples) [Pa] at one place of the face."""
        return np.stack([self.along(loads, int(tooth), np.array([z]))[:, 0] for tooth in self.teeth], axis=1)

    def beside(self, peak: RootPeak, loads: CellLoads, side: int) -> tuple[float, float, float, float]:
        """Stress at a peak's place by loads at one instant [Pa]: itself, with even loads, between walls, von Mises."""
        z = np.array([peak.face_position])
        sample = int(np.argmin(np.abs(self.fillets.influence.line.arc - peak.arc)))
        walls = replace(self, fillets=replace(self.fillets, ends=None))
        true, even, held = (
            float(of.along(by, peak.tooth, z)[0, 0, side, sample])
            for of, by in ((self, loads), (self, loads.even), (walls, loads))
        )
        return true, even, held, float(self.von_mises(loads, peak.tooth, z)[0, side, sample])


@record
class RootOverFace:
    """What the root stress of one gear is made of where its load varies along the face.

    Attributes
    ----------
    tangential : (positions, teeth, 2, samples) array
        Stress at the cycle's positions where the greatest tension along the face is [Pa].
    tension, compression : RootPeak
    passage : (2, 2, samples) array
        Least and greatest stress of all instants at that place [Pa].
    face : FaceRootStress
    """

    tangential: Array
    tension: RootPeak
    compression: RootPeak
    passage: Array
    face: FaceRootStress


def root_over_face(
    stress: StressOverFace,
    face: FaceLoads,
    rho: Array,
    found: MeshArcs,
    positions: Callable[[Arcs], Array],
    gear: int,
    mesh_error: float,
    loaded_position: Array,
) -> RootOverFace:
    """Greatest stresses of a gear over its face, its fillets, all teeth and instants.

    Parameters
    ----------
    stress : StressOverFace
    face : FaceLoads
        At the cycle's positions.
    rho : (positions, pairs) array
        Curvature radii on the gear [m].
    found : MeshArcs
        With cells.
    positions : callable
        Positions of the loaded flanks at all nodes of arcs.
    gear : int
        0 is the pinion, 1 the wheel.
    mesh_error : float
        Relative, of the mesh that the waves were solved on.
    loaded_position : (positions,) array
        Base pitches from A, of the pair that entered last.
    """
    width, cells = face.pair.face_width, len(face.face_position)
    z = places_on_face(stress.fillets.width, width / cells) + stress.offset
    nodes, here = CellLoads.at_nodes(found.arcs, gear), CellLoads(face.line_load, rho)
    both, sampled = stress.greatest(nodes, z), stress.greatest(here, z)
    over_cycle = [one.max(axis=(0, 1)) for one in both]
    places = [float(extreme(z, one)[1]) for one in over_cycle]
    division = [
        None if arcs is None else (arcs, positions(arcs), CellLoads.at_nodes(arcs, gear))
        for arcs in (found.arcs, found.before)
    ]
    peaks, errors, instants, passage = [], [], [], None
    for side, place in zip((LOADED, OTHER), places, strict=True):
        fine, before = (
            None if one is None else RootNodes(one[0], one[1], stress.at_place(one[2], place))
            for one in division
        )
        assert fine is not None
        peak = peak_of(fine, before, found.gain, stress.teeth, stress.fillets.influence, side)
        peak = replace(peak, face_position=place)
        instant = int(np.argmin(np.abs(fine.position + peak.tooth - peak.position)))
        true, even, walls, compared = stress.beside(peak, nodes.part(instant), side)
        peaks.append(replace(peak, von_mises_Pa=abs(peak.stress_Pa / true) * compared))
        errors.append(_error(face, mesh_error, true, even, walls))
        instants.append(instant)
        if side == LOADED:
            passage = np.stack([fine.stress.min(axis=(0, 1)), fine.stress.max(axis=(0, 1))])
    assert passage is not None
    row = int(np.argmax(stress.teeth == peaks[LOADED].tooth))
    then = both[LOADED][instants[LOADED], row]
    bears = np.abs(z) <= 0.5 * width * (1.0 + 1e-9)
    mean = np.trapezoid(then[bears], z[bears]) / np.ptp(z[bears])
    return RootOverFace(
        stress.at_place(here, places[LOADED]),
        peaks[LOADED],
        peaks[OTHER],
        passage,
        FaceRootStress(
            z,
            loaded_position[:, None] + stress.teeth,
            sampled[0],
            -sampled[1],
            over_cycle[0],
            -over_cycle[1],
            stress.along(nodes.part(instants[LOADED]), peaks[LOADED].tooth, z)[0, :, LOADED],
            float(then.max() / mean),
            *errors,
        ),
    )


def _error(face: FaceLoads, mesh_error: float, true: float, even: float, walls: float) -> float:
    """Relative error of a greatest stress by what varies along the face.

    The waves count by the error of their mesh, as far as they change the stress, free ends by a tenth of what they
    change, and the cells by the error of the greatest line load, as far as the stress follows it.
    """
    load = face.greatest_face_load_factor - 1.0
    follows = min(abs(true / even - 1.0) / load, 1.0) if load > 0.0 else 0.0
    by_waves, by_ends = abs((walls - even) / true), abs((true - walls) / true)
    return mesh_error * by_waves + ENDS_ERROR * by_ends + follows * face.error
