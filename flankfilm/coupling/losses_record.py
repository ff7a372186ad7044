"""Losses and temperatures of a mesh cycle: the record."""

from __future__ import annotations

from base import Array, Cost, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.losses_along_path import LossesAlongPath
from flankfilm.coupling.losses_over_face import FaceLosses

ROLLING = "not estimated: by the grid it errs as the film does"


@record
class LossBand:
    """Mean losses at the ends of the band of Eyring's stress, in which that of most oils lies.

    Load share and bulk temperatures stay; films are solved at some contacts, and the ratio of friction and rolling
    to those of the stress that was given is carried to the others along the path.
    """

    headline = ("error",)

    eyring_stress: Array = quantity("Pa", "Eyring's stress", "end", shown="MPa", no_error=EXACT)
    mean_friction: Array = quantity("1", "mean coefficient of friction", "end", error="error")
    sliding_loss: Array = quantity("W", "mean power lost by sliding", "end", error="error")
    rolling_loss: Array = quantity("W", "mean power lost by rolling", "end", error="error")
    mesh_loss: Array = quantity("W", "mean power lost in the mesh", "end", error="error")
    efficiency: Array = quantity("1", "power put out over power put in", "end", error="error")
    friction_coefficient: Array = quantity(
        "1", "coefficient of friction at the contacts in the order of the path", "end point", error="error"
    )
    error: float = quantity(
        "1", "relative error of the ratios by being carried along the path", no_error=ITSELF
    )


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
        "1", "mean coefficient of friction, weighted by force and sliding", error="error"
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
        "1", "tooth loss factor H_V of the forces: power lost at a friction of 1 over the power put in"
    )
    ohlendorf_loss_factor: float | None = quantity(
        "1", "H_V after Ohlendorf; None where that does not hold", no_error="unknown: a closed form"
    )
    bulk_temperatures: Array = quantity("K", "bulk temperatures of pinion and wheel", "gear")
    heat: Array = quantity(
        "W", "mean heat that pinion and wheel take up, the oil's divided as theirs", "gear"
    )
    heat_transfer: Array | None = quantity(
        "W/K", "heat transfer of pinion and wheel; None where bulk temperatures were given", "gear"
    )
    band: LossBand = part("losses at the ends of the band of Eyring's stress")
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

    @described("K")
    def greatest_contact_temperature(self) -> float:
        """Maximum temperature of the flanks."""
        return self.path.greatest_contact_temperature

    @described("m", shown="um")
    def least_film(self) -> float:
        """Minimum film of the contacts."""
        return self.path.least_film
