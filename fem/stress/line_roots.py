"""Root stress of one gear of a helical pair, by the forces on all cells of its lines of contact.

On a helicoid's free surface stress has two principal values at right angles. Along the fillet under the loaded flank
the larger one counts, along the other fillet the smaller one; what is kept at every sample is the one that is larger in
size, with its sign. All positions of a cycle are looked at, on places along the gear's own face.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from base import Array, Integers, record
from fem.contact.face_errors import ENDS_ERROR, LEFT
from fem.cycle.line_loads import LineLoads
from fem.elasticity.fillet_strain import von_mises
from fem.elasticity.helix_fillet import principal
from fem.elasticity.plane_elasticity import MIRROR
from fem.influence.helix_fillet_waves import NEAR_LOAD, CellLoad, away_from
from fem.pair.line_fillets import FilletsOfLines
from fem.stress.gear_root import FaceRootStress, GearRootStress
from fem.stress.root_peaks import LOADED, OTHER, SIGNS, RootPeak, extreme

__all__ = ["LineRoots"]

PLACES = 0.5
"""Modules of the face from one place to the next, about."""


@record
class LineRoots:
    """Stress along the fillets of one gear under the lines of contact of a cycle.

    Attributes
    ----------
    fillets : FilletsOfLines
    lines : LineLoads
    gear : int
        0 is the pinion, 1 the wheel.
    offsets : (pairs,) array of int
        Base pitches by which each line is ahead.
    fillets_error, forces_error : float
        Relative errors by the fillets' mesh and by the forces of the cycle.
    """

    fillets: FilletsOfLines
    lines: LineLoads
    gear: int
    offsets: Integers
    fillets_error: float
    forces_error: float

    @property
    def teeth(self) -> Integers:
        """Teeth whose stress is looked at (teeth,), base pitches ahead: of all lines, and one more at either end."""
        return np.arange(self.offsets.min() - 1, self.offsets.max() + 2)

    @cached_property
    def places(self) -> Array:
        """Places of the gear's own face, ends included (places,) [m], 0 at mid-face."""
        fillets = self.fillets
        count = int(np.ceil(fillets.width / (PLACES * fillets.module))) + 1
        return np.asarray(fillets.offset + fillets.width * np.linspace(-0.5, 0.5, max(count, 3)))

    @cached_property
    def stress(self) -> Array:
        """Sizes of the loads' stress at all positions (n, teeth, places, 2, samples) [Pa], with signs."""
        return _larger(*self._components(self.lines.force, self.places))

    def along_cycle(self) -> GearRootStress:
        """Stress at the cycle's positions, and the largest of all."""
        tension, compression = (self._peak(side) for side in (LOADED, OTHER))
        errors = [self._face_error(side, *peak) for side, peak in ((LOADED, tension), (OTHER, compression))]
        at = np.array([tension[0].face_position])
        whole = _larger(*self._components(self.lines.force, at))
        whole = self._clear(whole, at)[:, :, 0]
        return GearRootStress(
            self.fillets.line,
            self.fillets.law,
            self.lines.position,
            self.teeth,
            whole,
            tension[0],
            compression[0],
            np.stack([whole.min(axis=(0, 1)), whole.max(axis=(0, 1))]),
            self.fillets_error,
            self._over_face(tension[0], *errors),
            helical=True,
        )

    @cached_property
    def maxima(self) -> Array:
        """Maximum tension and compression, both positive, at all positions and places (2, n, teeth, places) [Pa]."""
        arc, clear = self.fillets.line.arc, self._clear(self.stress, self.places)
        return np.stack([extreme(arc, SIGNS[side] * clear[:, :, :, side])[0] for side in (LOADED, OTHER)])

    def _peak(self, side: int) -> tuple[RootPeak, float]:
        """Maximum stress on one side of the teeth, and the most that free ends add to it [Pa]."""
        line, maxima = self.fillets.line, self.maxima[side]
        instant, tooth, _ = np.unravel_index(int(np.argmax(maxima)), maxima.shape)
        z = float(extreme(self.places, maxima[instant, tooth])[1])
        at = np.array([np.clip(z, self.places[0], self.places[-1])])
        rows = slice(int(instant), int(instant) + 1)
        parts, added = self._parts(self.lines.force[rows], at, rows)
        here = self._clear(_larger(*np.moveaxis(parts, 3, 0)), at, rows)[0, tooth, 0, side]
        value, arc = (float(each) for each in extreme(line.arc, SIGNS[side] * here))
        there, ends = (
            [np.array(np.interp(arc, line.arc, each)) for each in of[0, tooth, 0, :, side]]
            for of in (parts, added)
        )
        point = np.array([np.interp(arc, line.arc, line.points[:, axis]) for axis in (0, 1)])
        every_other = [float(maxima.max(axis=(1, 2))[first::2].max(initial=0.0)) for first in (0, 1)]
        peak = RootPeak(
            stress_Pa=SIGNS[side] * value,
            von_mises_Pa=float(von_mises(*there)),
            tooth=int(self.teeth[tooth]),
            position=float(self.lines.position[instant] + self.teeth[tooth]),
            arc=arc,
            tangent_angle=float(np.interp(arc, line.arc, line.tangent_angle)),
            point=point * MIRROR if side == LOADED else point,
            along_Pa=here,
            sampling=1.0 - min(every_other) / max(every_other),
            forces=self.forces_error,
            face_position=float(at[0]),
        )
        return peak, float(np.max(np.abs(principal(*ends))))

    def _face_error(self, side: int, peak: RootPeak, added: float) -> float:
        """Relative error of a maximum stress by the cells of the lines, and by the addition of free ends [Pa]."""
        at = np.array([peak.face_position])
        few = self._clear(_larger(*self._components(self.lines.fewer, at)), at)[:, :, 0, side]
        changed = float(extreme(self.fillets.line.arc, SIGNS[side] * few)[0].max()) / abs(peak.stress_Pa)
        return LEFT * abs(changed - 1.0) + ENDS_ERROR * added / abs(peak.stress_Pa)

    def _over_face(self, tension: RootPeak, tension_error: float, compression_error: float) -> FaceRootStress:
        """Maximum stresses at places of the face."""
        maxima, z = self.maxima, self.places
        cycle = maxima.max(axis=(1, 2))
        row = int(np.argmax(self.teeth == tension.tooth))
        instant = int(np.argmin(np.abs(self.lines.position + tension.tooth - tension.position)))
        then = maxima[LOADED, instant, row]
        length = self.lines.whole_length
        even = self.lines.on_path * self.lines.length[..., None]
        even = even * (self.lines.force.sum(axis=(1, 2)) / length)[:, None, None]
        spread = self._clear(_larger(*self._components(even, z)), z)
        most_even = extreme(self.fillets.line.arc, spread[:, :, :, LOADED])[0].max()
        return FaceRootStress(
            face_position=z,
            travel=self.lines.position[:, None] + self.teeth,
            tension=maxima[LOADED],
            compression=-maxima[OTHER],
            cycle_tension=cycle[LOADED],
            cycle_compression=-cycle[OTHER],
            tangential=self.stress[instant, row, :, LOADED],
            face_factor=float(then.max() * np.ptp(z) / np.trapezoid(then, z)),
            over_even=float(cycle[LOADED].max() / most_even),
            tension_error=tension_error,
            compression_error=compression_error,
        )

    def _components(self, force: Array, z: Array, rows: slice = slice(None)) -> Array:
        """sigma_t, sigma_b and tau (3, n, teeth, places, 2, samples) [Pa]."""
        return np.moveaxis(self._parts(force, z, rows)[0], 3, 0)

    def _parts(self, force: Array, z: Array, rows: slice = slice(None)) -> tuple[Array, Array]:
        """Stresses, and what of them free ends add (n, teeth, places, 3, 2, samples) [Pa]."""
        samples = len(self.fillets.line.arc)
        total, added = np.zeros((2, len(force), len(self.teeth), len(z), 3, 2, samples))
        for row, position in enumerate(range(len(self.lines.position))[rows]):
            for column, offset in enumerate(self.offsets):
                load = self._load(position, column, force[row, column])
                if load is not None:
                    whole, ends = self.fillets.stress(load, (self.teeth - offset).tolist(), z)
                    total[row] += whole
                    added[row] += ends
        return total, added

    def _load(self, position: int, column: int, force: Array) -> CellLoad | None:
        """Forces on the cells of a line, as many of the whole face as given; None of a line without force."""
        lines = self.lines
        used = np.isfinite(lines.z[position, column])
        if not used.any() or not force.any():
            return None
        cell = float(lines.length[position, column] * lines.pair.helix.base_cosine)
        whole = cell * np.count_nonzero(used)
        count = int(np.ceil(whole / lines.pair.face_width * len(force) - 1e-9))
        along = whole / count * (np.arange(count) + 0.5)
        slope = lines.slope if self.gear == 0 else -lines.slope
        first, rho = lines.z[position, column, 0], lines.unlimited_rho[self.gear, position, column, 0]
        rho = lines.within(self.gear, rho + slope * (along - 0.5 * cell))
        return CellLoad(rho, first - 0.5 * cell + along, whole / count, force[:count])

    def _clear(self, stress: Array, z: Array, rows: slice = slice(None)) -> Array:
        """Stress (n, teeth, places, 2, samples) without what contacts do next to themselves, under the loaded flank.

        There the fillet ends short of the contact, with the stress where it does.
        """
        lines, clear, module = self.lines, stress.copy(), self.fillets.module
        profile = lines.pair.teeth_profiles[self.gear]
        places, rho, force = lines.z[rows], lines.rho[self.gear][rows], lines.force[rows]
        for column, offset in enumerate(self.offsets):
            tooth = int(np.argmax(self.teeth == offset))
            for position in np.flatnonzero(force[:, column].any(axis=-1)):
                bears = np.isfinite(places[position, column]) & (force[position, column] > 0.0)
                cells = places[position, column, bears]
                nearest = np.argmin(np.abs(z[:, None] - cells), axis=1)
                # past the last cell that bears the contact is as far away along the face
                beyond = np.abs(z - cells[nearest]) - 0.5 * lines.length[position, column]
                at = rho[position, column, bears][nearest]
                away = np.hypot(away_from(profile, self.fillets.line, at), np.maximum(beyond, 0.0)[:, None])
                apart = away >= NEAR_LOAD * module
                last = np.where(apart.all(axis=1), away.shape[1], np.argmin(apart, axis=1))
                last = np.maximum(last, 3) - 1
                samples = np.minimum(np.arange(away.shape[1]), last[:, None])
                clear[position, tooth, :, LOADED] = np.take_along_axis(
                    stress[position, tooth, :, LOADED], samples, axis=-1
                )
        return clear


def _larger(along: Array, across: Array, shear: Array) -> Array:
    """Principal stress of the larger size, with its sign."""
    larger, smaller = principal(along, across, shear)
    return np.where(np.abs(larger) >= np.abs(smaller), larger, smaller)
