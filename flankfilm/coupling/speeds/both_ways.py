"""Sweeps up and down in speed, of a pair or of its drive train: force of the mesh, effect of a longer series.

The sweep of a pair, that of a drive train and every torque of a dynamic map begin with these.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from base import Array, InputError, quantity, record, unclocked
from base.results import EXACT, ITSELF
from flankfilm.coupling.mesh.extreme_errors import of_greatest
from flankfilm.coupling.vibration.resonance import Vibrations, vibrations

if TYPE_CHECKING:
    import dynamics
    from flankfilm.coupling.drive.pair_drive import PairDrive
    from flankfilm.coupling.speeds.swept_truncation import LongerChanges
    from flankfilm.coupling.vibration.oscillator import PairOscillator

LEFT = (
    "relative change of {} there by the longer series; nan where the motion does not repeat, infinite where there is "
    "none of the same label"
)


@record
class SweptForce:
    """Force of the mesh swept up and down in speed; figures go by direction, ``"up"`` and ``"down"``."""

    frequency: Array = quantity("1", "mesh frequency over natural frequency", "frequency", no_error=EXACT)
    speed: Array | None = quantity("rad/s", "pinion speed", "frequency", shown="rpm", no_error=EXACT)
    labels: Mapping[str, Sequence[str]] = quantity("", "motion n-p-q", "frequency")
    force_factor: Mapping[str, Array] = quantity(
        "1", "maximum force over the mean force", "frequency", error="sampling_error"
    )
    separated: Mapping[str, Array] = quantity(
        "1",
        "part of the time without contact of the driving flanks",
        "frequency",
        shown="%",
        error="separated_error",
    )
    separated_error: Mapping[str, Array] = quantity(
        "1",
        "estimated relative error of that part by samples of a period, between which motions are taken as straight; "
        "force_change is what a longer series changes",
        "frequency",
        no_error=ITSELF,
    )
    sampling_error: float = quantity(
        "1", "largest relative change of what is swept with half as many samples of a period"
    )
    longer_order: int | None = quantity(
        "1",
        "harmonics of the longer series that the figures are held against; None for a given series",
        no_error=EXACT,
    )
    checked: Array | None = quantity(
        "1",
        "frequencies at which motions are computed with the longer series as well",
        "checked",
        no_error=EXACT,
    )
    force_change: Mapping[str, Array] | None = quantity(
        "1", LEFT.format("the maximum force"), "checked", no_error=ITSELF
    )

    @property
    def greatest_separated_error(self) -> float:
        """Relative error of the largest part of the time without contact, of the motions that are known."""
        apart, off = (np.concatenate([*curves.values()]) for curves in (self.separated, self.separated_error))
        known = np.isfinite(apart) & np.isfinite(off)
        return of_greatest(apart[known], off[known]) if known.any() else float("nan")


class BothWays(NamedTuple):
    """Sweeps over the frequency and the vibration of the motions that they met, by direction."""

    sweeps: Mapping[str, dynamics.SweepResult]
    shaken: Mapping[str, Vibrations]

    @property
    def values(self) -> Array:
        """Mesh frequencies over the natural one of the pair on rigid shafts."""
        return self.sweeps["up"].values

    @property
    def forces(self) -> dict[str, Array]:
        """Maximum forces of the mesh over the mean force."""
        return {way: response.force for way, response in self.shaken.items()}

    @property
    def periods(self) -> int:
        """Mesh periods that were computed."""
        return sum(result.cost.periods for result in self.sweeps.values())

    @property
    def error(self) -> float:
        """Relative error of one period map, the largest met."""
        return max(result.error for result in self.sweeps.values())

    def figures(self, changes: LongerChanges | None, *beside: Vibrations) -> dict[str, Any]:
        """Fields of `SweptForce` but for the speed.

        Parameters
        ----------
        changes : LongerChanges or None
            What a longer series changes; None for a given series.
        *beside : Vibrations
            Of further motions that share the error by samples.
        """
        return {
            "frequency": self.values,
            "labels": {way: result.labels for way, result in self.sweeps.items()},
            "force_factor": self.forces,
            "separated": {way: response.separated for way, response in self.shaken.items()},
            "separated_error": {way: response.separated_error for way, response in self.shaken.items()},
            "sampling_error": max(response.change for response in (*self.shaken.values(), *beside)),
            "longer_order": None if changes is None else changes.longer.order,
            "checked": None if changes is None else self.values[changes.at],
            "force_change": None if changes is None else changes.each("force"),
        }


def both_ways(
    motion: PairOscillator | PairDrive,
    values: Array,
    progress: Callable[[int, int], None] | None = None,
) -> BothWays:
    """Sweep the mesh frequency up and down, and follow the motions that are met.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
    values : ndarray, shape (n,)
        Mesh frequencies over the natural one of the pair on rigid shafts.
    progress : callable, optional
        Called with the number of values done, up and down, and that of all.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> from flankfilm.coupling import PairOscillator, given_series
    >>> series = given_series(1.0, [0.18], [0.0])
    >>> motion = PairOscillator(GearOscillator(series.stiffness, 0.05, 0.1, 0.2, 0.5, 0.2), None, series)
    >>> both_ways(motion, np.array([0.5, 0.65])).figures(None)["force_factor"]["up"].round(2)
    array([1.94, 5.68])
    """
    with unclocked():
        from dynamics.motion.up_and_down import up_and_down
    sweeps = up_and_down(motion.oscillator, "frequency", values, progress)
    shaken = vibrations(
        motion.oscillator, list(sweeps.values()), load=motion.mean_force, outputs=motion.outputs
    )
    return BothWays(sweeps, dict(zip(sweeps, shaken, strict=True)))


def frequencies_of(
    motion: PairOscillator, speed: ArrayLike | None, frequency: ArrayLike | None
) -> tuple[Array, Array | None]:
    """Frequencies of pinion speeds [rad/s], or those given, with the speeds where there are any.

    Raises
    ------
    InputError
        Where both are given, or neither; for speeds of an oscillator in its own units.
    """
    if (speed is None) == (frequency is None):
        raise InputError.at("speed", "", "or frequency must be given, one of both")
    if frequency is not None:
        return np.asarray(frequency, dtype=np.float64), None
    if motion.scales is None:
        raise InputError.at("speed", "", "requires an oscillator with physical scales", "give frequency")
    speeds = np.asarray(speed, dtype=np.float64)
    return np.array([motion.scales.frequency(omega) for omega in speeds.tolist()]), speeds
