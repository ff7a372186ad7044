"""Speeds so far below the resonance that no motion is followed there, found from cheap bounds of the stiffness.

A mesh period of the exact flow is divided into cells by the fastest time scale; their number is bounded
(`dynamics.model.oscillator.MAX_CELLS`), and with it the lowest frequency.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING

from base import Fault, RangeWarning
from flankfilm.building.pair import pinion_torque, supports
from flankfilm.scene.sections.section import required
from flankfilm.scene.wants import ranges

if TYPE_CHECKING:
    import gears
    from flankfilm.coupling import MeshSeries
    from flankfilm.scene import Scene
    from flankfilm.scene.sections.dynamics import DynamicsSection

MOST_HARMONICS = 3.0
"""Sum of the amplitudes over the mean that no series of a mesh stiffness reaches."""

SOFTEST, STIFFEST = 0.2, 3.0
"""Mean stiffness over c_gamma of ISO 6336-1 that no pair on rigid shafts lies outside of."""


def least_frequency(damping_ratio: float, harmonics: float) -> float:
    """Smallest mesh over natural frequency at which a motion is followed.

    Parameters
    ----------
    damping_ratio : float
    harmonics : float
        Sum of the amplitudes of the stiffness over its mean.

    Examples
    --------
    >>> 6e-5 < least_frequency(0.05, 0.0) < 7e-5
    True
    """
    from dynamics.model.oscillator import MAX_CELLS, GearOscillator
    from dynamics.model.stiffness import FourierStiffness

    stiffness = FourierStiffness(1.0, (harmonics,), (0.0,))
    return GearOscillator(stiffness, damping_ratio, 0.0, 0.0, 1.0, 0.0).cells / MAX_CELLS


def faults_of_ranges(scene: Scene, pair: gears.GearPair | None) -> Iterator[Fault]:
    """Faults of ranges of speed that begin where surely no motion is followed; a warning where perhaps none is.

    Parameters
    ----------
    scene : Scene
        Which wants a motion.
    pair : gears.GearPair or None
        Its gears; None in the dimensionless form.
    """
    section, operating = scene.dynamics, scene.operating
    if section is not None and pair is not None and operating is not None and not section.dimensionless:
        surely, _ = _bounds(scene, section, pair, in_rpm=True)
        if (rpm := operating.pinion_speed_rpm) is not None and rpm < surely:
            _warn_of_speed(rpm, surely)
    for name in ranges(scene.wants):
        ranged = getattr(section, name)
        if section is None or ranged is None:
            continue
        in_rpm = ranged.speed_rpm is not None
        key, unit = ("speed_rpm", " rpm") if in_rpm else ("frequency", "")
        (low, high), (surely, safely) = ranged.ends, _bounds(scene, section, pair, in_rpm)
        said = f"must begin at {_up(surely):g}{unit} or more: below, a mesh period has too many natural ones to follow"
        remedy = f"Begin at {_up(safely):g}{unit}"
        if low < surely:
            value = f"[{low:g}, {high:g}]"
            yield Fault(
                f"dynamics.{name}.{key}", value, said, remedy + (", and end above" if safely >= high else "")
            )
        elif low < safely:
            warnings.warn(
                f"dynamics.{name}.{key} = [{low:g}, {high:g}] may begin too far below the resonance for a motion to be "
                f"followed, which the stiffness decides; at {_up(safely):g}{unit} it surely is",
                RangeWarning,
                stacklevel=2,
            )


def followed_speed(scene: Scene, pair: gears.GearPair, series: MeshSeries) -> float:
    """Speed of the pinion at which the scene's oscillator is given: its own [rpm].

    Where that lies so far below the resonance that no motion is followed, a warning says so, and it is the speed at
    which the range begins; likewise for a scene without a speed.

    Parameters
    ----------
    scene : Scene
        Which wants a motion, in physical units.
    pair : gears.GearPair
    series : MeshSeries
        Of its mesh stiffness.
    """
    from flankfilm.coupling import pair_scales

    section = required(scene.dynamics, "[dynamics]", "the motion")
    extra, length = section.extra_inertia_kg_m2.each, section.value("length_scale_um")
    scales = pair_scales(pair, pinion_torque(scene), series.mean, extra, length)
    total = math.fsum(map(abs, series.stiffness.amplitudes)) / series.mean
    least = scales.rpm(least_frequency(section.known_damping, total))
    rpm = scene.rpm
    if rpm is not None and rpm > least:
        return rpm
    if rpm is not None:
        _warn_of_speed(rpm, least)
    ranged = section.sweep or section.diagram
    if ranged is None or ranged.frequency is None:
        return ranged.speed_rpm[0] if ranged and ranged.speed_rpm else scales.rpm(1.0)
    return scales.rpm(ranged.frequency[0])


def _warn_of_speed(rpm: float, least: float) -> None:
    warnings.warn(
        f"operating.pinion_speed_rpm = {rpm:g} lies so far below the resonance that no motion is followed there, but "
        f"from {_up(least):g} rpm on: the motions of the range are computed, and none at this speed",
        RangeWarning,
        stacklevel=3,
    )


def _up(value: float) -> float:
    """The next larger number of three digits, so that what is read is accepted."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.ceil(value / digit * (1 - 1e-12)) * digit:.12g}")


def _bounds(
    scene: Scene, section: DynamicsSection, pair: gears.GearPair | None, in_rpm: bool
) -> tuple[float, float]:
    """Starts of a range below which surely no motion is followed, and from which one surely is."""
    amplitudes = scene.stiffness.amplitudes
    sums = (0.0, MOST_HARMONICS) if amplitudes is None else (math.fsum(map(abs, amplitudes)),) * 2
    surely, safely = (least_frequency(section.known_damping, total) for total in sums)
    if not in_rpm or pair is None:
        return surely, safely
    from flankfilm.coupling import pair_scales

    extra, length = section.extra_inertia_kg_m2.each, section.value("length_scale_um")
    soft, stiff = (
        pair_scales(pair, pinion_torque(scene), mean, extra, length) for mean in _stiffness(scene, pair)
    )
    return soft.rpm(surely), stiff.rpm(safely)


def _stiffness(scene: Scene, pair: gears.GearPair) -> tuple[float, float]:
    """Bounds of the mean stiffness [N/m]; equal where it is given."""
    if scene.stiffness.mean_N_per_m is not None:
        return scene.stiffness.mean_N_per_m, scene.stiffness.mean_N_per_m
    from gears import closed_form

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the form's range, which the bounds allow for
        mean = 1e9 * pair.face_width * closed_form.iso6336(pair).c_gamma
    held = supports(scene) or ()
    shafts = sum(support.compliance(radius) for support, radius in zip(held, pair.base_radii, strict=False))
    return 1.0 / (1.0 / (SOFTEST * mean) + shafts), STIFFEST * mean
