"""Losses and temperatures of a mesh cycle: the record."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from base import Array, Cost, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.losses.losses_along_path import LossesAlongPath
from flankfilm.coupling.losses.losses_on_lines import LineLosses
from flankfilm.coupling.losses.losses_over_face import FaceLosses
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

ROLLING = "not estimated by itself: by the grid it errs as the film does"


@record
class LossBand:
    """Mean losses at the ends of the band of Eyring's stress, in which that of most oils lies.

    Load share and bulk temperatures stay; films are solved at some contacts, and the ratio of friction and rolling
    to those of the stress that was given is carried to the others along the path.
    """

    headline = ("error",)

    eyring_stress: Array = quantity("Pa", "Eyring's stress", "end", shown="MPa", no_error=EXACT)
    mean_friction: Array = quantity("1", "mean coefficient of friction", "end", error="end_error")
    sliding_loss: Array = quantity("W", "mean power lost by sliding", "end", error="end_error")
    rolling_loss: Array = quantity("W", "mean power lost by rolling", "end", error="end_error")
    mesh_loss: Array = quantity("W", "mean power lost in the mesh", "end", error="end_error")
    efficiency: Array = quantity("1", "power put out over power put in", "end", error="efficiency_error")
    friction_coefficient: Array = quantity(
        "1", "coefficient of friction at the contacts in the order of the path", "end point", error="error"
    )
    end_error: Array = quantity(
        "1",
        "relative numerical error of the means: of films, and of ratios that are carried along the path",
        "end",
        no_error=ITSELF,
    )

    @described("1", no_error=ITSELF)
    def error(self) -> float:
        """Greater relative error of both ends."""
        return float(self.end_error.max())

    @described("1", "end", no_error=ITSELF)
    def efficiency_error(self) -> Array:
        """Relative error of the efficiency."""
        return np.asarray(self.end_error * (1.0 - self.efficiency) / self.efficiency)


@record
class BoundaryBand:
    """Mean losses at the ends of the band of the asperities' friction: load share, films and temperatures stay."""

    no_error = "that of the mean losses: films and load share are theirs"
    headline = ("loss_part",)

    boundary_friction: Array = quantity(
        "1", "coefficient of friction of what asperities carry", "end", no_error=EXACT
    )
    mean_friction: Array = quantity("1", "mean coefficient of friction", "end")
    sliding_loss: Array = quantity("W", "mean power lost by sliding", "end")
    mesh_loss: Array = quantity("W", "mean power lost in the mesh", "end")
    efficiency: Array = quantity("1", "power put out over power put in", "end")
    loss_part: float = quantity("1", "part of the losses that the asperities' friction makes")


@record
class MeshLosses:
    """Losses and temperatures of a lubricated mesh over one base pitch.

    Power is lost in the contacts of the flanks alone: bearings, seals, churning and windage are not in it.
    """

    headline = ("mean_friction", "mesh_loss", "efficiency", "greatest_contact_temperature")
    no_error = "not estimated; films, friction and temperatures along the path have an error"

    cycle: MeshCycle = part("the dry cycle whose forces the mean friction tilts")
    path: LossesAlongPath = part("friction, losses and temperatures at the contacts")
    speed: float = quantity("rad/s", "speed of the pinion", shown="rpm", no_error=EXACT)
    input_power: float = quantity("W", "power put in", shown="kW", no_error=EXACT)
    mean_friction: float = quantity(
        "1",
        "mean coefficient of friction, weighted by force and sliding",
        error="error",
    )
    sliding_loss: float = quantity("W", "mean power lost by sliding on the path", error="error")
    rolling_loss: float = quantity(
        "W", "mean power lost by the oil's flow under its pressure", no_error=ROLLING
    )
    edge_loss: float = quantity(
        "W",
        "mean power lost by tip edges that slide outside the path, at the mean friction: no film is solved there",
        error="error",
    )
    loss_factor: float = quantity(
        "1",
        "tooth loss factor H_V of the forces: power lost at a friction of 1 over the power put in",
        no_error="not estimated: a mean of forces in single positions, in which their error is not known",
    )
    ohlendorf_loss_factor: float | None = quantity(
        "1", "H_V after Ohlendorf; None where that does not hold", no_error="unknown: a closed form"
    )
    bulk_temperatures: Array = quantity(
        "K", "bulk temperatures of pinion and wheel", "gear", error="bulk_temperatures_error"
    )
    heat: Array = quantity(
        "W", "mean heat that pinion and wheel take up, the oil's divided as theirs", "gear"
    )
    heat_transfer: Array | None = quantity(
        "W/K", "heat transfer of pinion and wheel; None where bulk temperatures were given", "gear"
    )
    band: LossBand = part("losses at the ends of the band of Eyring's stress")
    boundary: BoundaryBand | None = part(
        "losses at the ends of the band of the asperities' friction; None of smooth flanks"
    )
    rounds: int = quantity("1", "times that films, load share and temperatures were solved", no_error=EXACT)
    share_mismatch: float = quantity(
        "1", "last change of a pair's force over the whole force", no_error=ITSELF
    )
    temperature_mismatch: float = quantity("K", "last change of a bulk temperature", no_error=ITSELF)
    error: float
    cost: Cost
    converged: bool = True
    message: str = ""
    over_face: FaceLosses | None = part(
        "friction, losses and temperatures over the face; None where the load is even along it", default=None
    )
    over_lines: LineLosses | None = part(
        "friction, losses and temperatures on lines of contact; None of spur pairs", default=None
    )

    @described("W", error="error")
    def mesh_loss(self) -> float:
        """Mean power lost in the mesh: by sliding, rolling and tip edges."""
        return self.sliding_loss + self.rolling_loss + self.edge_loss

    @described("1", error="loss_error")
    def efficiency(self) -> float:
        """Power put out over power put in."""
        return 1.0 - self.mesh_loss / self.input_power

    @property
    def loss_error(self) -> float:
        """Relative error of the efficiency."""
        return self.error * self.mesh_loss / (self.input_power - self.mesh_loss)

    @property
    def model_errors(self) -> Mapping[str, float]:
        """What the bands of Eyring's stress and of the asperities' friction leave open, relative, by figure."""
        names = ("mean_friction", "sliding_loss", "mesh_loss", "efficiency")
        bands = [self.band] if self.boundary is None else [self.band, self.boundary]
        return {
            name: sum(_farthest(getattr(band, name), getattr(self, name)) for band in bands) for name in names
        }

    @described("1", no_error=ITSELF)
    def model_error(self) -> float:
        """What these bands leave open of the losses, relative."""
        return self.model_errors["mesh_loss"]

    @described("K", error="greatest_contact_temperature_error")
    def greatest_contact_temperature(self) -> float:
        """Maximum temperature of the flanks."""
        return self.path.greatest_contact_temperature

    @property
    def greatest_contact_temperature_error(self) -> float:
        """Relative error of the flanks' maximum temperature [K]: of their rise, and of a balanced bulk."""
        bulk = float(np.max(self._bulk_off))
        return self.path.greatest_contact_temperature_error + bulk / self.greatest_contact_temperature

    @property
    def _bulk_off(self) -> Array:
        """Error of the bulk temperatures [K]: of the losses, and of the balance; zero where they were given."""
        if self.heat_transfer is None:
            return np.zeros(2)
        return np.asarray(self.temperature_mismatch + self.error * self.heat / self.heat_transfer)

    @described("1", "gear", no_error=ITSELF)
    def bulk_temperatures_error(self) -> Array:
        """Relative error of the bulk temperatures [K], by the losses that they balance; 0 where they were given."""
        return np.asarray(self._bulk_off / self.bulk_temperatures)

    @described("m", shown="um", error="least_film_error")
    def least_film(self) -> float:
        """Minimum film of the contacts."""
        return self.path.least_film

    @property
    def least_film_error(self) -> float:
        """Relative error of the minimum film."""
        return self.path.least_film_error


def _farthest(ends: Array, value: float) -> float:
    """Maximum relative difference of the ends of a band from a value."""
    return float(np.max(np.abs(ends - value))) / abs(value) if value else 0.0
