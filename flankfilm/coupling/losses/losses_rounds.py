"""Films with heat, load share and bulk temperatures, solved in turn until they agree."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import ehl
from base import Array, SolverError
from flankfilm.coupling.films.agreement import MOST_ROUNDS, in_agreement
from flankfilm.coupling.films.line_contacts import line_contacts, with_sliding
from flankfilm.coupling.films.most_loaded import most_loaded
from flankfilm.coupling.losses.bulk_balance import BulkTrial
from flankfilm.coupling.losses.heated_films import (
    HeatedFilms,
    HeatedOil,
    heated_films,
    sliding_contacts,
    thinned,
)
from flankfilm.coupling.losses.heated_table import FEW as FEW_GRID
from flankfilm.coupling.losses.heated_table import GRID, HeatedTable, heated_table
from flankfilm.coupling.losses.losses_faults import TEMPERATURE
from flankfilm.coupling.losses.mean_losses import Carried, Means, means_of
from flankfilm.coupling.mesh.cells import cells_of, has_cells
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["Agreed", "LossRounds"]

FINER = 8
"""Times as many positions that means are taken over, friction and rolling being carried between the films."""

FINER_FACE = 3
"""The same where the load varies along the contact, whose cells take their time; that of films is part of the error."""

WARMER = 0.2
"""Change of bulk temperatures that is left where they are balanced [K]."""


@dataclass(frozen=True)
class Agreed:
    """Films, forces and temperatures of a round, which agree in the last one.

    Attributes
    ----------
    films : HeatedFilms or HeatedTable
    forces : MeshCycle
        Cycle that their mean friction tilts, at the positions of the films.
    cycle : MeshCycle
        The same at the positions that means are taken over.
    means : Means
    shares : float
        Change of a pair's force over the whole force.
    trial : BulkTrial
        Bulk temperatures of the films, and those that their losses ask for.
    """

    films: HeatedFilms | HeatedTable
    forces: MeshCycle
    cycle: MeshCycle
    means: Means
    shares: float
    trial: BulkTrial

    @property
    def bulk(self) -> tuple[float, float]:
        """Bulk temperatures of pinion and wheel [K]."""
        return self.trial.bulk


@dataclass(frozen=True)
class LossRounds:
    """What films, load share and temperatures are computed from."""

    teeth: LoadedTeeth
    speed: float
    lubricant: ehl.Lubricant
    oil: HeatedOil
    positions: int
    agreement: float
    transfer: Array | None
    ambient: float

    @property
    def power(self) -> float:
        """Put in [W]."""
        return abs(self.teeth.torque) * self.speed

    def cycle(self, friction: float, positions: int) -> MeshCycle:
        """Dry mesh cycle whose forces a mean friction tilts."""
        flanks = replace(self.teeth.flanks, friction=friction)
        return replace(self.teeth, flanks=flanks).cycle(positions)

    def means(
        self, cycle: MeshCycle, films: HeatedFilms | HeatedTable, ratios: Carried | None = None
    ) -> Means:
        """Mean losses of a cycle by films, their friction and rolling times ratios."""
        known = replace(films, ratios=ratios) if isinstance(films, HeatedTable) else Carried.of(films, ratios)
        return means_of(self.teeth.pair, cycle, self.speed, self.power, known)

    def along(self, agreed: Agreed, cycle: MeshCycle) -> HeatedFilms:
        """Films along the path; those of the most loaded cells where the load varies along the face."""
        if isinstance(agreed.films, HeatedFilms):
            return agreed.films
        pair = self.teeth.pair
        rho1, load = most_loaded(pair, cycle, np.arange(cycle.position.size))
        contacts = line_contacts(pair, rho1, load, self.speed, self.lubricant)
        return heated_films(rho1, with_sliding(pair, rho1, contacts, self.speed), self.oil, agreed.bulk)

    def agree(
        self,
        most: int | None,
        friction: float,
        bulk: tuple[float, float],
        films: HeatedFilms | HeatedTable | None = None,
    ) -> tuple[Agreed, int]:
        """Iterate films, load share and temperatures, with so many films at most, from some where they are as many.

        The number of rounds goes with them.
        """
        return in_agreement(
            self._round(most, self.cycle(friction, self.positions), bulk, films),
            lambda last: self._round(most, last.forces, last.trial.following, last.films, last.trial),
            lambda last: last.shares <= self.agreement and last.trial.change <= WARMER,
            lambda last: (
                f"losses and bulk temperatures did not agree within {MOST_ROUNDS} rounds (temperatures still "
                f"change by {last.trial.change:.2g} K, forces by {last.shares:.1e} of the whole): "
                "give bulk_temperatures"
            ),
        )

    def _round(
        self,
        most: int | None,
        cycle: MeshCycle,
        bulk: tuple[float, float],
        near: HeatedFilms | HeatedTable | None,
        before: BulkTrial | None = None,
    ) -> Agreed:
        """Films under the loads of a cycle, the forces that their friction tilts, and the temperatures asked for."""
        films = self._films(cycle, most, bulk, near)
        friction = self.means(cycle, films).friction
        forces = self.cycle(friction, self.positions)
        shares = float(np.nanmax(np.abs(forces.load_share - cycle.load_share)))
        by = FINER if isinstance(films, HeatedFilms) else FINER_FACE
        finer = self.cycle(friction, by * self.positions)
        means = self.means(finer, films)
        asked = bulk if self.transfer is None else self._balanced(means)
        return Agreed(films, forces, finer, means, shares, BulkTrial(bulk, asked, before))

    def _films(
        self,
        cycle: MeshCycle,
        most: int | None,
        bulk: tuple[float, float],
        before: HeatedFilms | HeatedTable | None,
    ) -> HeatedFilms | HeatedTable:
        if has_cells(cycle):
            return self._table(cycle, GRID if most is None else FEW_GRID, bulk, before)
        assert not isinstance(before, HeatedTable)
        rho1, contacts = sliding_contacts(self.teeth.pair, cycle, self.speed, self.lubricant)
        kept = thinned(len(contacts), most or len(contacts))
        same = before is not None and before.rho1.size == kept.size
        return heated_films(
            rho1[kept], [contacts[k] for k in kept.tolist()], self.oil, bulk, before if same else None
        )

    def _table(
        self,
        cycle: MeshCycle,
        grid: tuple[int, int],
        bulk: tuple[float, float],
        before: HeatedFilms | HeatedTable | None,
    ) -> HeatedTable:
        """Films over place and line load: those of the round before where these are the same."""
        table = before if isinstance(before, HeatedTable) and len(before.rows) == grid[0] else None
        greatest = cells_of(cycle).greatest
        if table is not None and table.bulk == bulk and greatest <= table.load[0]:
            return table
        return heated_table(self.teeth.pair, cycle, self.speed, self.lubricant, self.oil, bulk, grid, table)

    def _balanced(self, means: Means) -> tuple[float, float]:
        """Temperatures at which the losses are taken away."""
        assert self.transfer is not None
        first, second = (self.ambient + means.heat / self.transfer).tolist()
        if max(first, second) > TEMPERATURE.high:
            raise SolverError(
                f"bulk temperatures of {first:.4g} and {second:.4g} K would take away the mesh's losses of "
                f"{means.heat.sum():.4g} W: give more heat_transfer"
            )
        return first, second
