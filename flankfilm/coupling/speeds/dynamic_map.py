"""Dynamic factor over speed and torque: each torque with the stiffness that the mesh has under it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Faults, Stopwatch, described, quantity, record
from base.results import EXACT, ITSELF
from dynamics.model.limits import NUMBER, checked_grid
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.both_ways import both_ways
from flankfilm.coupling.speeds.swept_truncation import LongerChanges, longer_changes
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.part_loads import greatest, part_figures
from flankfilm.coupling.vibration.speed_ranges import standard_factors
from gears.closed_form.record import STANDARD


@record
class DynamicMap:
    """Maximum force over the mean one, over speed and torque, of settled motions up and down in speed."""

    headline = ("greatest", "sampling_error")

    speed: Array = quantity("rad/s", "pinion speed", "speed", shown="rpm", no_error=EXACT)
    torque: Array = quantity("N m", "torque of the pinion", "torque", no_error=EXACT)
    resonance: Array = quantity(
        "rad/s",
        "pinion speed at which the mesh frequency is the natural one",
        "torque",
        shown="rpm",
        no_error="half that of the mean stiffness",
    )
    factor: Array = quantity(
        "1",
        "K_v: maximum force over the mean force, of the sweeps up and down the greater",
        "torque speed",
        error="sampling_error",
    )
    factor_up: Array = quantity("1", "the same of the sweep up", "torque speed", error="sampling_error")
    factor_down: Array = quantity("1", "the same of the sweep down", "torque speed", error="sampling_error")
    separated: Array = quantity(
        "1",
        "part of the time without contact, of both sweeps the greater",
        "torque speed",
        shown="%",
        error="separated_error",
    )
    separated_error: Array = quantity(
        "1",
        "estimated relative error of that part by samples of a period, between which motions are taken as straight",
        "torque speed",
        no_error=ITSELF,
    )
    iso: Array = quantity(
        "1", "K_v after ISO 6336-1, method B; nan where it does not hold", "torque speed", no_error=STANDARD
    )
    bearings: tuple[str, ...] = quantity(
        "", "bearings of a drive train, in the order of their forces", "bearing"
    )
    bearing_force: Array = quantity(
        "N",
        "maximum modulus of the force of bearings, of both sweeps the greater",
        "torque speed bearing",
        error="sampling_error",
    )
    bearing_force_swing: Array = quantity(
        "N",
        "root mean square about the mean force of bearings, likewise",
        "torque speed bearing",
        error="sampling_error",
    )
    shafts: tuple[str, ...] = quantity(
        "", "shafts and couplings of a drive train, in the order of their torques", "shaft"
    )
    shaft_torque: Array = quantity(
        "N m",
        "maximum modulus of the torque of shafts and couplings, of both sweeps the greater",
        "torque speed shaft",
        error="sampling_error",
    )
    shaft_torque_swing: Array = quantity(
        "N m",
        "root mean square about the mean torque of shafts and couplings, likewise",
        "torque speed shaft",
        error="sampling_error",
    )
    sampling_error: float = quantity(
        "1", "largest relative change of factors, forces and torques with half as many samples"
    )
    truncation: float | None = quantity(
        "1",
        "largest relative change of factors, forces and torques by a longer series, at a dozen speeds of every torque "
        "where that has the same motion; None for given series",
        no_error=ITSELF,
    )
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed", no_error=EXACT)
    message: str = ""

    @property
    def error(self) -> float:
        """Relative error of the factors by samples; what the series leaves out is `truncation`."""
        return self.sampling_error

    @property
    def greatest(self) -> float:
        """Maximum factor of the map."""
        return float(np.nanmax(self.factor))

    @described("N", error="sampling_error")
    def greatest_bearing_force(self) -> float | None:
        """Maximum force of a bearing of the map; None without bearings."""
        return greatest(self.bearing_force)

    @described("N m", error="sampling_error")
    def greatest_shaft_torque(self) -> float | None:
        """Maximum torque of a shaft or coupling of the map; None without one that yields."""
        return greatest(self.shaft_torque)


def dynamic_map(
    motion_at: Callable[[float], PairOscillator | PairDrive],
    torques: Sequence[float],
    speeds: ArrayLike,
    *,
    progress: Callable[[str, int, int], None] = lambda what, done, every: None,
) -> DynamicMap:
    """Maximum force over the mean one, over speed and torque.

    Parameters
    ----------
    motion_at : callable
        Gives the oscillator of a pair under a torque of the pinion [N m], with the stiffness that it has then; or its
        drive train, whose parts are the same under every torque.
    torques : sequence of float
        [N m]
    speeds : array_like, shape (n,)
        Pinion speeds, rising [rad/s].
    progress : callable
        Called with what is counted, how many are done, and of how many, of all torques together.

    Raises
    ------
    InputError
        For torques and speeds that are none, or an oscillator without physical scales.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(50e-6)
    >>> series = given_series(4e8, [0.2])
    >>> found = dynamic_map(lambda torque: pair_oscillator(pair, series, torque, 500.0), [50.0, 100.0], [500.0, 900.0])
    >>> found.factor.shape, found.greatest > 1.0
    ((2, 2), True)
    """
    watch = Stopwatch()
    with Faults() as faults:
        at = checked_grid(faults, "speeds", speeds)
        loads = [faults.number(f"torques[{k}]", load, NUMBER) for k, load in enumerate(torques)]
        if not loads:
            faults.add("torques", "none", "must be at least one", "give a list of torques")
    rows: dict[str, list[Array]] = {
        name: [] for name in ("up", "down", "separated", "separated_error", "iso", "parts")
    }
    resonances, changed, lost, off, used = [], list[Array](), 0, 0.0, 0
    for row, torque in enumerate(loads):

        def shown(done: int, of_torque: int, before: int = row) -> None:
            progress("speeds", before * of_torque + done, len(loads) * of_torque)

        motion = motion_at(torque)
        assert motion.scales is not None
        values = np.array([motion.scales.frequency(speed) for speed in at.tolist()])
        swept = both_ways(motion, values, shown)
        for way, force in swept.forces.items():
            rows[way].append(force)
        responses = swept.shaken.values()
        off, used = max(off, *(response.change for response in responses)), used + swept.periods
        lost += sum(not result.converged for result in swept.sweeps.values())
        changed += _changed(longer_changes(motion, swept.sweeps, swept.shaken))
        apart, off_apart = (
            [getattr(response, figure) for response in responses]
            for figure in ("separated", "separated_error")
        )
        rows["separated"].append(np.fmax(*apart))
        rows["separated_error"].append(np.where(rows["separated"][-1] == apart[0], *off_apart))
        rows["parts"].append(np.fmax(*(response.parts for response in responses)))
        rows["iso"].append(standard_factors(motion.rigid, values))
        resonances.append(motion.scales.speed(1.0))
    maps = {name: np.array(values) for name, values in rows.items()}
    return DynamicMap(
        at,
        np.array(loads),
        np.array(resonances),
        np.fmax(maps["up"], maps["down"]),
        maps["up"],
        maps["down"],
        maps["separated"],
        maps["separated_error"],
        maps["iso"],
        **part_figures(motion.outputs, {"": maps["parts"][:, :, 2], "_swing": maps["parts"][:, :, 1]}),
        sampling_error=off,
        truncation=greatest(np.concatenate([np.empty(0), *changed])),
        cost=Cost(watch.seconds, periods=used),
        converged=lost == 0,
        message="" if lost == 0 else "some motions grow without bound; their factors are nan",
    )


def _changed(changes: LongerChanges | None) -> list[Array]:
    """What a longer series changes of factors and of what parts carry; nothing for a given one."""
    if changes is None:
        return []
    by_way = changes.by_way.values()
    return [part for change in by_way for part in (change.force, change.parts[:, 1:].ravel())]
