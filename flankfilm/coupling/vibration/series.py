r"""Fourier stiffness of a mesh cycle, of a given order or of as few harmonics as leave out less than a share.

What a series of order n leaves out of the curve is the root mean square of the dropped harmonics,
:math:`\sqrt{\tfrac12 \sum_{j>n} \kappa_j^2}` over the mean. In the motion a dropped harmonic excites the pair by
:math:`\kappa_j` times its static deflection; to first order, about a mesh of mean stiffness in contact, it answers with
the amplitude :math:`\kappa_j H(j \omega)`, :math:`H(r) = [(1-r^2)^2 + (2 \zeta r)^2]^{-1/2}`. Where a wanted range of
frequencies passes :math:`j \omega = 1` that is :math:`\kappa_j / (2 \zeta)`: harmonics far too small for the curve
make separate resonances at low speed. Both estimates have to stay below the share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import dynamics
from base import Array, Cost, Stopwatch, described, part, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.vibration.harmonics import CURVES, harmonics_of
from gears.closed_form.record import UNKNOWN

MOST_HARMONICS = 50
"""Highest order of a series."""

MEANS = {"secant": "mean_secant_stiffness", "tangent": "mean_stiffness"}
"""Figure of a mesh cycle that is the mean of a kind of stiffness."""

OTHER = {"secant": "tangent", "tangent": "secant"}

_FREQUENCIES = 2000


@record
class MeshSeries:
    """Fourier series of a mesh stiffness, in N/m, or over the mean where none is given; tau = 0 with a pair at A."""

    headline = ("kind", "order", "mean", "remainder")

    kind: str = quantity("", "stiffness that the series is of: secant, tangent or given")
    source: str = quantity("", "mesh cycle that the series is of")
    stiffness: dynamics.FourierStiffness = part("the series")
    fit: dynamics.FourierFit | None = part("the series with its remainder; None if it was given")
    other: dynamics.FourierFit | None = part(
        "that of the kind which was not chosen; None if the series was given"
    )
    cycle: MeshCycle | None = part("mesh cycle that was fitted; None if the series was given")
    left_out: LeftOut | None = part("what the order leaves out; None where it was not looked at")
    share: float | None = part("what an order that was found may leave out; None for one that was named")
    cost: Cost
    harmonic_error: Array | None = quantity(
        "1",
        "estimated error of the amplitudes over the mean, of meshes and arcs; None where it is unknown",
        "harmonic",
        default=None,
    )
    tried: tuple[tuple[int, float], ...] = part(
        "lower orders that jump speeds ruled out, with what these err by", default=()
    )
    converged: bool = True
    message: str = ""

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        if self.cycle is None:
            return EXACT
        return UNKNOWN if self.cycle.error is None else "not estimated; the amplitudes have harmonic_error"

    @property
    def mean_error(self) -> float | None:
        """Relative error of the mean; None where it is unknown, and of a given series."""
        kinds = {"secant": "mean_secant_stiffness", "tangent": "mean_stiffness"}
        return None if self.cycle is None else self.cycle.errors[kinds[self.kind]]

    @property
    def samples_error(self) -> float | None:
        """Relative error of the samples; None where it is unknown."""
        return None if self.cycle is None else self.cycle.error

    @described("")
    def reference(self) -> str | None:
        """What the deflection of the stiffness is measured against."""
        return None if self.cycle is None else self.cycle.reference

    @described("1", "position")
    def position(self) -> Array | None:
        """Position, base pitches from A."""
        return None if self.cycle is None else self.cycle.position

    @described("N/m", "position", error="samples_error")
    def samples(self) -> Array | None:
        """Samples of the stiffness that were fitted."""
        return None if self.cycle is None else self.cycle.curve(self.kind)

    @described("N/m", error="mean_error")
    def mean(self) -> float:
        """Mean of the stiffness."""
        return self.stiffness.mean

    @described("N/m", "harmonic", error="harmonic_error")
    def amplitude(self) -> Array:
        """Amplitude of cos(j omega tau + phase)."""
        return np.array(self.stiffness.amplitudes)

    @described("rad", "harmonic")
    def phase(self) -> Array:
        """Phase; tau = 0 when a pair is at A."""
        return np.array(self.stiffness.phases)

    @described("N/m")
    def other_mean(self) -> float | None:
        """Mean of the stiffness of the other kind."""
        return None if self.other is None else self.other.stiffness.mean

    @described("N/m", "harmonic")
    def other_amplitude(self) -> Array | None:
        """Amplitude of the stiffness of the other kind."""
        return None if self.other is None else np.array(self.other.stiffness.amplitudes)

    @described("rad", "harmonic")
    def other_phase(self) -> Array | None:
        """Phase of the stiffness of the other kind; tau = 0 when a pair is at A."""
        return None if self.other is None else np.array(self.other.stiffness.phases)

    @described("1", "sampled")
    def harmonics(self) -> Array | None:
        """Amplitudes of the harmonics over the mean."""
        return None if self.fit is None else np.array(self.fit.harmonics)

    @described("1", no_error=EXACT)
    def order(self) -> int:
        """Highest harmonic of the series."""
        return len(self.stiffness.amplitudes)

    @described("1", no_error=ITSELF)
    def remainder(self) -> float | None:
        """Root mean square of curve less series, over the mean."""
        return None if self.fit is None else self.fit.remainder_rms

    @property
    def error(self) -> float | None:
        """Relative error of the series as a description of the curve; None for a given one."""
        return self.remainder


@dataclass(frozen=True, eq=False)
class LeftOut:
    """What series of the orders 0, 1, 2, ... leave out.

    Attributes
    ----------
    curve : ndarray, shape (orders,)
        Root mean square over the mean.
    motion : ndarray or None, shape (orders,)
        Largest amplitude over the static deflection; None without a range of frequencies.
    """

    curve: Array
    motion: Array | None

    @property
    def largest(self) -> Array:
        """The larger of both, shape (orders,)."""
        return self.curve if self.motion is None else np.maximum(self.curve, self.motion)


def left_out(
    harmonics: Array, bounds: tuple[float, float] | None, damping_ratio: float, beyond: float = 0.0
) -> LeftOut:
    r"""Estimate what series of every order leave out.

    Parameters
    ----------
    harmonics : ndarray, shape (n,)
        Amplitudes of the harmonics 1, 2, ... over the mean.
    bounds : (float, float), optional
        Range of the mesh frequency over the natural one.
    damping_ratio : float
        :math:`\zeta`, above zero for a finite estimate at resonance.
    beyond : float
        Root mean square over the mean of all that lies beyond these harmonics.
    """
    order = np.arange(1, harmonics.size + 1)
    curve = np.hypot(_tails(0.5 * harmonics**2), beyond)
    if bounds is None:
        return LeftOut(curve, None)
    low, high = bounds
    # resonances of all harmonics that lie in the range, and places between them
    at = np.concatenate([np.geomspace(low, high, _FREQUENCIES), np.clip(1.0 / order, low, high)])
    ratio = order[:, None] * at
    answer = (harmonics[:, None] ** 2) / ((1.0 - ratio**2) ** 2 + (2.0 * damping_ratio * ratio) ** 2)
    return LeftOut(curve, np.max(_tails(answer), axis=1))


def _tails(squares: Array) -> Array:
    """Roots of the sums of what lies beyond each order, from order 0 on; along the first axis."""
    sums = np.cumsum(squares[::-1], axis=0)[::-1]
    return np.asarray(np.sqrt(np.concatenate([sums, np.zeros_like(squares[:1])])))


def least_order(omitted: LeftOut, share: float) -> int:
    """Lowest order that leaves out no more than a share; the highest where none does."""
    most = min(MOST_HARMONICS, omitted.curve.size - 1)
    enough = np.flatnonzero(omitted.largest[1 : most + 1] <= share)
    return int(enough[0]) + 1 if enough.size else most


def mesh_series(
    cycle: MeshCycle,
    kind: str = "secant",
    order: int | None = None,
    share: float = 0.005,
    bounds: tuple[float, float] | None = None,
    damping_ratio: float = 0.0,
) -> MeshSeries:
    """Fourier series of a mesh stiffness.

    Parameters
    ----------
    cycle : MeshCycle
    kind : str
        ``"secant"`` or ``"tangent"``.
    order : int, optional
        Highest harmonic; as few as leave out no more than `share` unless given.
    share : float
        What the series may leave out of the curve and of the motion, relative.
    bounds : (float, float), optional
        Range of the mesh frequency over the natural one, for what a series leaves out of the motion.
    damping_ratio : float
        Likewise.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> series = mesh_series(mesh_cycle(pair, 600.0, model="potential-energy"), order=2)
    >>> series.order, series.remainder < 0.1
    (2, True)
    """
    watch = Stopwatch()
    curves = {law: harmonics_of(cycle, law) for law in OTHER}
    whole = curves[kind].fit(MOST_HARMONICS if order is None else order)
    harmonics = np.array(whole.harmonics)
    beyond = np.sqrt(max(whole.remainder_rms**2 - 0.5 * np.sum(harmonics[whole.order :] ** 2), 0.0))
    rest = left_out(harmonics, bounds, damping_ratio, float(beyond))
    chosen = least_order(rest, share) if order is None else order
    fit = curves[kind].fit(chosen)
    assert cycle.arcs is not None
    _, errors = cycle.arcs.over_mean(CURVES[kind], np.arange(1, chosen + 1))
    return MeshSeries(
        kind=kind,
        source=cycle.label,
        stiffness=fit.stiffness,
        fit=fit,
        other=curves[OTHER[kind]].fit(chosen),
        cycle=cycle,
        left_out=rest,
        share=share if order is None else None,
        cost=Cost(watch.seconds),
        harmonic_error=errors,
    )


def given_series(
    mean: float = 1.0, amplitudes: Sequence[float] = (), phases: Sequence[float] | None = None
) -> MeshSeries:
    """Series by its mean [N/m], or 1, its amplitudes over the mean, and its phases [rad], zero unless given.

    Examples
    --------
    >>> given_series(8e8, [0.1], [0.0]).amplitude
    array([80000000.])
    """
    series = dynamics.FourierStiffness(
        mean, tuple(mean * kappa for kappa in amplitudes), tuple(phases or (0.0,) * len(amplitudes))
    )
    return MeshSeries("given", "given", series, None, None, None, None, None, Cost(0.0))
