"""What the cells of the face bear in a mesh cycle: line loads, face-load factor, contact pattern."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Booleans, described, part, quantity, record
from base.results import EXACT
from fem.contact.cell_laws import face_load_factors
from fem.cycle.face_cells import HERTZ, IN_SINGLE_CELLS, FaceCells, of_cells
from fem.cycle.shaft_figures import shaft_figures
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.pair.face_setting import FaceSetting
from gears.pair.hertz import peak_pressure

if TYPE_CHECKING:
    from fem.contact.contact_state import ContactState
    from fem.contact.shared_contacts import SharedContacts
    from fem.laws.mesh_setup import MeshSetup

__all__ = ["FaceLoads", "face_loads"]

OF_BOTH = "off by matrix_error of the root of stiffness times tilt stiffness: it passes through zero itself"


@record
class FaceLoads(FaceCells):
    """Line loads over the face at the positions of a mesh cycle.

    ``error`` and ``line_load_error`` are what more cells would change of the maximum face-load factor and of the
    maximum line load, and a part of what free ends do; ``shaft_error``, ``tilt_error`` and ``matrix_error`` of how far
    shafts give way, of their tilt, and of the mesh between bodies that tilt.
    """

    no_error = IN_SINGLE_CELLS
    headline = ("greatest_face_load_factor", "greatest_line_load")

    face_load_factor: Array = quantity(
        "1", "maximum line load of the most loaded pair over that pair's mean", "position", error="error"
    )
    setting: FaceSetting = part("cells, alignment, leads and ends")
    plane: str = part('"strain" or "stress", as of the compliance')
    curvature_radius: Array = quantity(
        "m", "radius of relative curvature; nan where no two flanks touch", "position pair", no_error=EXACT
    )
    gap: Array = quantity(
        "m",
        "gap left under load along the line of action; zero where flanks bear, inf where a pair cannot touch",
        "position pair cell",
        shown="um",
    )
    error: float = quantity("1", "estimated relative error of the maximum face-load factor")
    line_load_error: float = quantity("1", "estimated relative error of the maximum line load")
    shaft_misalignment: Array = quantity(
        "m",
        "how far the shafts' bending and twist under the load open the flanks over the face, end to end, by the mean "
        "slope: f_sh; zero of rigid shafts",
        "gear position",
        shown="um",
        error="tilt_error",
    )
    shaft_deflection: Array | None = quantity(
        "m",
        "how far the shafts give way along the line of action under the load, mean over the face; none of rigid ones",
        "gear position",
        shown="um",
        error="shaft_error",
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
    mesh_matrix: Array | None = part(
        "the mesh between bodies that turn and tilt, on shafts that are held (positions, 2, 2): force [N] and moment "
        "about mid-face [N m] by the approach there [m] and its slope along z [rad]; None of rigid ones",
        default=None,
    )
    shaft_error: float | None = quantity(
        "1", "estimated relative error of how far shafts give way, of the largest", default=None
    )
    tilt_error: float | None = quantity(
        "1", "estimated relative error of the shafts' tilt and of what it adds, of the largest", default=None
    )
    matrix_error: float | None = quantity(
        "1", "estimated relative error of the mesh between bodies that tilt, of the largest", default=None
    )

    def less(self, slope: Array) -> FaceLoads:
        """Give the same for a deflection less a turn that goes with the force; `slope` dD'/dD (positions,)."""
        if self.mesh_matrix is None:
            return self
        kff, kfm, kmm = self.mesh_matrix[:, 0, 0], self.mesh_matrix[:, 0, 1], self.mesh_matrix[:, 1, 1]
        tilt = kmm + (1.0 - slope) / (kff * slope) * kfm**2
        rows = [[kff / slope, kfm / slope], [self.mesh_matrix[:, 1, 0] / slope, tilt]]
        return replace(self, mesh_matrix=np.moveaxis(np.array(rows), -1, 0))

    @described("1", error="error")
    def greatest_face_load_factor(self) -> float:
        """Largest of the face-load factors of all positions."""
        return float(np.max(self.face_load_factor))

    @described("N/m", shown="N/mm", error="line_load_error")
    def greatest_line_load(self) -> float:
        """Maximum line load of all positions, pairs and cells."""
        return float(np.max(self.line_load))

    @described("N", "position", no_error=OF_BOTH)
    def moment_stiffness(self) -> Array | None:
        """Moment of the mesh about mid-face per approach there, shafts held; None of rigid ones."""
        return None if self.mesh_matrix is None else self.mesh_matrix[:, 1, 0]

    @described("N m/rad", "position", error="matrix_error")
    def tilt_stiffness(self) -> Array | None:
        """Moment of the mesh about mid-face per tilt of the bodies, shafts held; None of rigid ones."""
        return None if self.mesh_matrix is None else self.mesh_matrix[:, 1, 1]

    @described("Pa", "position pair cell", shown="MPa", no_error=HERTZ)
    def hertz_pressure(self) -> Array:
        """Hertz pressure: largest of the contact of every cell; nan where no two flanks touch, as at tip edges."""
        radius = self.curvature_radius[..., None]
        return np.asarray(peak_pressure(self.line_load, radius, reduced_modulus(self.pair, self.plane)))

    @described("Pa", shown="MPa", error="greatest_hertz_pressure_error")
    def greatest_hertz_pressure(self) -> float:
        """Maximum Hertz pressure of all positions, pairs and cells; tip edges left out."""
        return float(np.nanmax(self.hertz_pressure))

    @property
    def greatest_hertz_pressure_error(self) -> float:
        """Relative error of the maximum Hertz pressure: half that of the line load, of which it is the root."""
        return 0.5 * self.line_load_error

    @described("1", error="contact_pattern_error")
    def contact_pattern(self) -> float:
        """Part of the face that is touched at some position of the cycle."""
        return float(np.mean(self._touched))

    @property
    def contact_pattern_error(self) -> float:
        """Relative error of the contact pattern: a cell wherever flanks begin, or cease, to touch along the face."""
        touched, load = self._touched, self.line_load
        ends = [
            touched[end] and np.max(3.0 * load[..., end] - load[..., beside]) <= 0.0
            for end, beside in ((0, 1), (-1, -2))
        ]
        edges = np.count_nonzero(np.diff(touched)) + sum(ends)
        return float(edges / touched.sum()) if touched.any() else 0.0

    @property
    def _touched(self) -> Booleans:
        """Cells that are touched at some position (cells,)."""
        return np.asarray(np.any(self.line_load > 0.0, axis=(0, 1)))


def face_loads(setup: MeshSetup, contact: ContactState, number: int, plane: str) -> FaceLoads | None:
    """Line loads of one torque of a solution; None where they are even along the face, and of helical pairs.

    Parameters
    ----------
    setup : MeshSetup
    contact : ContactState
    number : int
        Of the torque.
    plane : {"strain", "stress"}
    """
    if setup.face.even_load or setup.helical:
        return None
    over, pair, cells = contact.contacts, setup.pair, setup.face.cells
    forces = contact.cell_forces(number).reshape(-1, *over.forces.shape[-2:])
    factors = face_load_factors(forces)
    candidates, (rho1, rho2) = contact.candidates, contact.candidates.rho
    radius = np.where(candidates.touchable & ~candidates.edge, rho1 * rho2 / (rho1 + rho2), np.nan)
    travel = np.where(candidates.touchable, candidates.place - pair.points.A, np.nan)
    return FaceLoads(
        face_position=setup.face.middles(pair.face_width),
        travel=np.tile(travel, (setup.pitches, 1)),
        line_load=forces * cells / pair.face_width,
        face_load_factor=factors,
        curvature_radius=np.tile(radius, (setup.pitches, 1)),
        gap=np.maximum(over.remaining_gaps[number], 0.0).reshape(forces.shape),
        **of_cells(setup, over, number, plane),
        **_shafts(setup, over, number),
    )


def _shafts(setup: MeshSetup, over: SharedContacts, number: int) -> dict[str, Any]:
    """What the shafts do, as fields of the record."""
    if over.shafts is None:
        return {"shaft_misalignment": np.zeros((2, over.share.stiffness[number].size))}
    error = over.errors
    return {
        **shaft_figures(setup, over, number),
        "mesh_matrix": over.shafts.at(number).mesh,
        "matrix_error": float(error.matrix[number] + error.relative[number] + error.ends[number]),
    }
