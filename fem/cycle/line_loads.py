"""What lines of contact of a helical pair carry in a mesh cycle: line loads, pressure, centre of the load, moments."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from base import Array, InputError, described, part, quantity, record
from base.results import EXACT, ITSELF
from fem.contact.line_contact import WINDOW
from fem.cycle.face_cells import HERTZ, of_cells
from fem.cycle.line_cells import IN_SINGLE_CELLS, CellsOfLines
from fem.cycle.shaft_figures import shaft_figures
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.laws.line_friction import rubbed_arms
from fem.pair.face_setting import FaceSetting
from gears.pair.hertz import half_width, peak_pressure
from gears.pair.tilting_shaft import bearing_forces

if TYPE_CHECKING:
    from fem.contact.contact_state import ContactState
    from fem.laws.mesh_setup import MeshSetup

__all__ = ["LineLoads", "line_loads"]

BY_CENTRE = "off by centre_error: it passes through zero"

ALONG_AXES = "exact without friction; with it, as the forces before and after C share the torque"

BY_LEVER = "off by the force times centre_error: it passes through zero"


@record
class LineLoads(CellsOfLines):
    """Lines of contact over the positions of a mesh cycle, each divided into equal cells.

    Two bodies that a mesh joins reach two motions of it: cells approach each other by a displacement D along the
    transverse line of action, times cos(beta_b), and by a tilt t as D + t zeta does, with
    zeta = z + (rho1 - rho1 at C) tan(beta_b). `tilting` is what (F, M), sums of cos(beta_b) F_c and of
    cos(beta_b) F_c zeta, grow by (D, t): symmetric, with the couplings of all cells by the bodies.
    """

    no_error = IN_SINGLE_CELLS
    headline: ClassVar[tuple[str, ...]] = ("greatest_line_load_factor", "greatest_line_load", "axial_force")

    gap: Array = quantity(
        "m",
        "gap left under load along the common normal; zero where flanks touch",
        "position pair cell",
        shown="um",
        no_error=IN_SINGLE_CELLS,
    )
    most_loaded: Array = part("largest mean over half a module of each line (positions, pairs) [N/m]")
    levers: Array = part(
        "levers of the normal about both axes in the section, over the base radii (2, positions, pairs, cells)"
    )
    arms: Array = part(
        "distances from the feet of both axes on it to the contact (2, positions, pairs, cells) [m]"
    )
    setting: FaceSetting = part("cells, alignment and leads")
    fewer: Array = part("forces with half as many cells of each line (positions, pairs, cells) [N]")
    slopes: Array = part("slopes of the forces on cells by D (positions, pairs, cells) [N/m], without shafts")
    tilting: Array = part(
        "stiffness of the mesh against approach and tilt, and with half as many cells (2, positions, 2, 2), "
        "without shafts [N/m, N, N m]"
    )
    slope: float = quantity(
        "1", "change of the pinion's curvature radius along the face: tan(beta_b)", no_error=EXACT
    )
    plane: str = part('"strain", as of the compliance')
    error: float = quantity("1", "estimated relative error of the maximum line-load factor")
    line_load_error: float = quantity("1", "estimated relative error of the maximum line load")
    centre_error: float = quantity(
        "m",
        "estimated error of the centre of the load, root mean square over the positions",
        shown="um",
        no_error=ITSELF,
    )

    shaft_deflection: Array | None = quantity(
        "m",
        "how far the shafts give way along the line of action under the load, at mid-face; none of rigid ones",
        "gear position",
        shown="um",
        error="shaft_error",
        default=None,
    )
    shaft_misalignment: Array | None = quantity(
        "m",
        "how far bending, tilt and twist of the shafts under the load open the lines over the face, end to end; none "
        "of rigid ones",
        "gear position",
        shown="um",
        error="tilt_error",
        default=None,
    )
    shaft_transmission_error: Array | None = quantity(
        "m",
        "the shafts' part of the transmission error: both deflections at mid-face; none of rigid ones",
        "position",
        shown="um",
        error="shaft_error",
        default=None,
    )
    tilt_transmission_error: Array | None = quantity(
        "m",
        "the tilt's part of the transmission error: what tilt and bend of the shafts over the face move the first "
        "touch by; none of rigid ones",
        "position",
        shown="um",
        error="tilt_error",
        default=None,
    )
    shaft_error: float | None = quantity(
        "1", "estimated relative error of how far shafts give way, of the largest", default=None
    )
    tilt_error: float | None = quantity(
        "1", "estimated relative error of the shafts' tilt and of what it adds, of the largest", default=None
    )

    @described("m", "position pair cell", shown="mm", no_error=EXACT)
    def curvature_radius(self) -> Array:
        """Radius of relative curvature across the line of contact: that of the section over cos(beta_b)."""
        rho1, rho2 = self.rho
        return np.asarray(rho1 * rho2 / (rho1 + rho2) / self.pair.helix.base_cosine)

    @described("Pa", "position pair cell", shown="MPa", no_error=HERTZ)
    def hertz_pressure(self) -> Array:
        """Hertz pressure: largest of the contact of every cell; nan at tip edges, where it is no ellipse."""
        return peak_pressure(*self._contacts)

    @described("m", "position pair cell", shown="um", no_error=HERTZ)
    def half_width(self) -> Array:
        """Half-width of the Hertz contact of every cell; nan at tip edges."""
        return half_width(*self._contacts)

    @property
    def _contacts(self) -> tuple[Array, Array, float]:
        load = np.where(self.on_path > 0.0, self.line_load, np.nan)
        return load, self.curvature_radius, reduced_modulus(self.pair, self.plane)

    @described("m", "position", shown="mm", no_error=EXACT)
    def whole_length(self) -> Array:
        """Length of all lines of contact together, between the ends of the path."""
        return np.asarray((self.on_path * self.length[..., None]).sum(axis=(1, 2)))

    @described("N/m", "position", shown="N/mm", error="line_load_error")
    def maximum_line_load(self) -> Array:
        """Maximum line load: the largest mean over half a module of a line."""
        return np.asarray(self.most_loaded.max(axis=1))

    @described("1", "position", error="error")
    def line_load_factor(self) -> Array:
        """Maximum line load over the mean of all lines of contact."""
        mean = self.force.sum(axis=(1, 2)) / self.whole_length
        return np.asarray(self.maximum_line_load / mean)

    @described("1", error="error")
    def greatest_line_load_factor(self) -> float:
        """Largest of the line-load factors of all positions."""
        return float(self.line_load_factor.max())

    @described("N/m", shown="N/mm", error="line_load_error")
    def greatest_line_load(self) -> float:
        """Maximum line load of all positions."""
        return float(self.most_loaded.max())

    @property
    def across(self) -> Array:
        """Sum of the normal forces in the section (positions,) [N]: the same at all positions without friction."""
        return np.asarray(self.force.sum(axis=(1, 2)) * self.pair.helix.base_cosine)

    @property
    def rubbed(self) -> Array:
        """Sums of the forces by their arms about both gears across the lines (2, positions) [N m].

        Times the coefficient of friction they are the torques of an even friction; above 0 after C.
        """
        pair, forces = self.pair, self.force
        place = np.nan_to_num(self.travel) + pair.points.A
        width = np.where(self.length > 0.0, self.length, pair.face_width) * abs(pair.helix.base_sine)
        arms = rubbed_arms(pair, place, width[..., None], np.nan_to_num(self.arms))
        return np.asarray((forces * arms).sum(axis=(-2, -1)))

    @property
    def turned(self) -> Array:
        """What normals that edges and relief turn add to the torques of involutes' forces (2, positions) [N m]."""
        longer = np.sum(self.force * (np.nan_to_num(self.levers, nan=1.0) - 1.0), axis=(-2, -1))
        return np.asarray(longer * self.pair.helix.base_cosine * np.reshape(self.pair.base_radii, (2, 1)))

    @described("N", no_error=ALONG_AXES)
    def axial_force(self) -> float:
        """Axial force on the pinion, positive along z, mean over the positions; the wheel has the opposite."""
        return float(self.across.mean() * self.slope)

    @described("m", "position", shown="mm", no_error=BY_CENTRE)
    def load_centre(self) -> Array:
        """Centre of the load along the face, 0 at mid-face."""
        force = self.force
        return np.asarray((force * np.nan_to_num(self.z)).sum(axis=(1, 2)) / force.sum(axis=(1, 2)))

    @described("N m", "gear", no_error=ALONG_AXES)
    def axial_moment(self) -> tuple[float, float]:
        """Moment of the axial force on pinion and wheel about the transverse line of action, F_a r_b."""
        first, second = (self.axial_force * radius for radius in self.pair.base_radii)
        return first, second

    @described("N m", "gear position", no_error=BY_LEVER)
    def tilting_moment(self) -> Array:
        """Moment on either gear about the normal of shaft and line of action through mid-face.

        The sum of F_t (z + rho tan(beta_b)), F_t the force in the section: the load's centre and the axial force.
        """
        rho, slopes = np.nan_to_num(self.rho), np.array([self.slope, -self.slope])
        lever = np.nan_to_num(self.z) + slopes[:, None, None, None] * rho
        return np.asarray((self.force * lever).sum(axis=(2, 3)) * self.pair.helix.base_cosine)

    def bearing_forces(self, gear: int) -> Array:
        """Radial forces that the bearings of a shaft carry under the mesh (bearings, positions, 2) [N].

        Along the transverse line of action and across it; weights, friction and what couplings add are left out.
        Axially one bearing carries `axial_force`.

        Parameters
        ----------
        gear : {0, 1}
            Pinion, wheel.

        Raises
        ------
        base.InputError
            Of a shaft that is rigid.
        """
        shaft = self.setting.shafts[gear]
        if shaft is None:
            raise InputError.at(
                "shafts", "None", "must be given where bearings are asked for", "give a Shaft"
            )
        axial = self.across * self.slope * self.pair.base_radii[gear]
        loads = self.across, self.tilting_moment[gear], axial
        return bearing_forces(shaft, *loads, self.pair.face_offsets[gear])

    def less(self, slope: Array) -> Self:
        """Leave a turn per force out of D: `slope` is what D then grows by the D that was (positions,)."""
        stiffness = self.tilting[0, :, 0, 0]
        yielding = np.divide(1.0 - slope, stiffness, out=np.zeros_like(slope), where=stiffness > 0.0)
        column = self.tilting[..., 0]
        rest = 1.0 - yielding * column[..., 0]
        added = (yielding / rest)[..., None, None] * column[..., :, None] * column[..., None, :]
        return replace(self, slopes=self.slopes / slope[:, None, None], tilting=self.tilting + added)

    @described("1")
    def contact_pattern(self) -> float:
        """Part of the length of all lines, over the whole cycle, that is touched."""
        touched = ((np.nan_to_num(self.line_load) > 0.0) * self.on_path * self.length[..., None]).sum()
        return float(touched / self.whole_length.sum())


def line_loads(setup: MeshSetup, contact: ContactState, number: int, plane: str) -> LineLoads | None:
    """Lines of contact under one torque of a solution; None of spur pairs.

    Parameters
    ----------
    setup : MeshSetup
    contact : ContactState
    number : int
        Of the torque.
    plane : {"strain"}
    """
    lines = contact.candidates.lines
    if lines is None:
        return None
    over, pair = contact.contacts, setup.pair
    forces = contact.cell_forces(number)
    pitches, cells = len(forces), lines.divided(forces.shape[-1])
    place = lines.places(cells)
    length = np.where(lines.touches, cells.length, 0.0) / pair.helix.base_cosine
    per_length = forces / np.where(length > 0.0, length, 1.0)[..., None]

    def of_used(values: Array) -> Array:
        known = np.where(cells.used, values, np.nan)
        known = known if known.ndim == forces.ndim else np.tile(known, (pitches, 1, 1, 1))
        return known.reshape(-1, *known.shape[2:])

    def of_gears(values: Array) -> Array:
        return np.stack([of_used(of_gear) for of_gear in values])

    largest = cells.largest_mean(forces, WINDOW * pair.module * pair.helix.base_cosine)
    assert over.slopes is not None
    assert over.tilting is not None
    slopes, tilting = over.slopes[number], over.tilting[:, number]
    fewer = forces if over.fewer is None else over.fewer[number]
    return LineLoads(
        position=contact.candidates.position,
        z=of_used(cells.z),
        travel=of_used(place - pair.points.A),
        length=np.tile(length, (pitches, 1)),
        line_load=of_used(per_length),
        gap=of_used(np.maximum(over.remaining_gaps[number], 0.0)),
        levers=of_gears(lines.levers(place)),
        arms=of_gears(lines.arms(place, pair.base_radii)),
        most_loaded=largest.reshape(-1, largest.shape[-1]) * pair.helix.base_cosine,
        fewer=fewer.reshape(-1, *fewer.shape[2:]),
        slopes=slopes.reshape(-1, *slopes.shape[2:]),
        tilting=tilting.reshape(2, -1, 2, 2),
        slope=lines.slope,
        ends=setup.ends,
        centre_error=float(over.errors.centre[number]),
        **of_cells(setup, over, number, plane),
        **shaft_figures(setup, over, number),
    )
