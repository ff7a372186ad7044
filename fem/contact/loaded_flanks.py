"""Flanks on one side of the teeth: candidates, compliances, laws and levers of all contacts, put together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.laws.contact_candidates import ContactCandidates, contact_candidates
from fem.laws.corner_laws import CornerLaws
from fem.laws.local_law import Film, FilmLaw, PairLaws
from fem.laws.mesh_setup import MeshSetup

if TYPE_CHECKING:
    from fem.influence.gear_compliance import GearCompliance
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["FlanksInPlace", "LoadedFlanks", "flanks_in_place", "hub_lever", "loaded_flanks"]


@record
class FlanksInPlace:
    """Contacts on one side, and what stands between them, before anything yields.

    Attributes
    ----------
    candidates : ContactCandidates
    lever_ratios : (positions, pairs) array
        Levers of the normals about the pinion's axis, over its base radius: by how much a turn closes the gaps along
        them.
    oil : FilmLaw or None
    tilted_lever_ratios : (positions, pairs) array
        The same of forces that friction tilts; of lines of contact without what differs from cell to cell
        (``fem.laws.line_friction``).
    """

    candidates: ContactCandidates
    lever_ratios: Array
    oil: FilmLaw | None
    tilted_lever_ratios: Array

    @property
    def gaps(self) -> Array:
        """Gaps along the normals where the first pair touches (pitches, positions, pairs) [m]."""
        gap = self.candidates.gap
        return np.asarray(self.lever_ratios * (gap - gap.min(axis=-1, keepdims=True)))


@record
class LoadedFlanks(FlanksInPlace):
    """What the contacts on one side yield, as ``share_load`` asks for it.

    Attributes
    ----------
    matrix : (positions, pairs, pairs) array
        Compliance of the bodies along the normals [m/N].
    laws : PairLaws
    largest : (edges,) array
        Forces that the tip edges' laws cover [N].
    corner_laws : CornerLaws or None
        What cells of lines of contact have their laws from, beside tip corners.
    """

    matrix: Array
    laws: PairLaws
    largest: Array
    corner_laws: CornerLaws | None = None

    def at(self, position: int) -> LoadedFlanks:
        """Flanks of a single position, but for their gaps."""
        row = slice(position, position + 1)
        return LoadedFlanks(
            self.candidates.at(row),
            self.lever_ratios[row],
            None if self.oil is None else self.oil.at(position),
            self.tilted_lever_ratios[row],
            self.matrix[row],
            self.laws.at(position),
            self.largest,
            self.corner_laws,
        )


def flanks_in_place(setup: MeshSetup, film: Film | None, reach: float) -> FlanksInPlace:
    """Place the flanks that bear in a setting; arguments as of ``loaded_flanks``."""
    candidates = contact_candidates(setup, reach)
    lever_ratios = np.where(candidates.touchable, candidates.lever[0, : setup.positions], 1.0)
    ends = float(setup.pair.points.A), float(setup.pair.points.E)
    on_path = candidates.touchable & ~candidates.edge
    oil = None if film is None else FilmLaw(film, np.where(on_path, np.clip(candidates.place, *ends), np.nan))
    return FlanksInPlace(candidates, lever_ratios, oil, _tilted_lever_ratios(setup, candidates))


def loaded_flanks(
    setup: MeshSetup,
    bodies: PairCompliance,
    film: Film | None,
    reach: float,
    corner_laws: CornerLaws,
) -> LoadedFlanks:
    """Put together what the flanks yield that bear in a setting.

    Parameters
    ----------
    setup : MeshSetup
    bodies : PairCompliance
    film : Film or None
    reach : float
        Base pitches outside the path within which tip edges are looked for.
    corner_laws : CornerLaws
        Laws of the tip edges.
    """
    placed = flanks_in_place(setup, film, reach)
    candidates = placed.candidates
    laws, largest = corner_laws.at(candidates, setup.moving_contact)
    rho1, rho2 = candidates.rho
    if candidates.lines is None:
        matrix = bodies.bulk(rho1, rho2, candidates.leaning)
        _leave_out_corner(bodies, matrix, candidates)
    else:  # between cells of the lines alone (``fem.contact.line_contact``)
        matrix = np.zeros((*rho1.shape, rho1.shape[-1]))
    return LoadedFlanks(
        candidates,
        placed.lever_ratios,
        placed.oil,
        placed.tilted_lever_ratios,
        matrix,
        laws,
        largest,
        corner_laws if candidates.lines is not None else None,
    )


def _tilted_lever_ratios(setup: MeshSetup, candidates: ContactCandidates) -> Array:
    """Levers about the pinion's axis of forces tilted by friction, over r_b1 (positions, pairs); 1 if none can act."""
    if candidates.lines is not None:
        return np.where(candidates.touchable, candidates.lever[0, : setup.positions], 1.0)
    lever, arm = candidates.lever[:, : setup.positions], candidates.tangent_arm[:, : setup.positions]
    first, second = setup.pair.base_radii
    arm = np.where(candidates.touchable, arm, 0.0)
    slip = np.sign(arm[0] / first - arm[1] / second)
    # the gears turn on, whichever flanks bear: on the back flanks all surfaces move the other way
    turning = -setup.friction if setup.back else setup.friction
    return np.asarray(np.where(candidates.touchable, lever[0], 1.0) + turning * slip * arm[0] / first)


def _leave_out_corner(bodies: PairCompliance, matrix: Array, candidates: ContactCandidates) -> None:
    """Keep of the corner's gear only its turn on the hub: the edge's law holds its tooth and body already.

    The turn stays with that of the other pairs, so that with a weak hub the matrix remains definite.
    """
    width = bodies.pair.face_width
    for corner, chosen in candidates.corners():
        gear = (bodies.pinion, bodies.wheel)[corner]
        position, column = np.nonzero(chosen)
        rho = np.clip(candidates.rho[corner][position, column], *gear.rho_range)
        lever = hub_lever(gear, rho, candidates.leaning[corner][position, column])
        matrix[position, column, column] -= (gear.own(rho) - gear.hub_windup * lever**2) / width


def hub_lever(gear: GearCompliance, rho: Array, leaning: Array) -> Array:
    """Lever about a gear's axis, over its base radius, of forces that lean from its flank's normal.

    It is that of the cross terms along flank and tangent (``PairCompliance.bulk``), at the last place that these know.
    """
    return np.asarray(np.cos(leaning) - np.sin(leaning) * np.clip(rho, *gear.rho_range) / gear.base_radius)
