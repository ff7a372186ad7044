r"""Fourier stiffness of a mesh cycle, of a given order or of as few harmonics as leave out less than a share.

What a series of order n leaves out of the curve is the root mean square of the dropped harmonics,
:math:`\sqrt{\tfrac12 \sum_{j>n} \kappa_j^2}` over the mean. In the motion a dropped harmonic excites the pair by
:math:`\kappa_j` times its static deflection; to first order, about a mesh of mean stiffness in contact, it answers with
the amplitude :math:`\kappa_j H(j \omega)`, :math:`H(r) = [(1-r^2)^2 + (2 \zeta r)^2]^{-1/2}`. Where a wanted range of
frequencies passes :math:`j \omega = 1` that is :math:`\kappa_j / (2 \zeta)`: harmonics far too small for the curve
make resonances of their own at low speed. Both estimates have to stay below the share.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import dynamics
from base import Array, Cost, Stopwatch, described, part, quantity, record
from flankfilm.coupling.cycle import MeshCycle, harmonics

MOST_HARMONICS = 50
"""Highest order of a series."""

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
    converged: bool = True
    message: str = ""

    @described("")
    def reference(self) -> str | None:
        """What the deflection of the stiffness is measured against."""
        return None if self.cycle is None else self.cycle.reference

    @described("1", "position")
    def position(self) -> Array | None:
        """Position of the samples that were fitted, base pitches from A."""
        return None if self.cycle is None else self.cycle.position

    @described("N/m", "position")
    def samples(self) -> Array | None:
        """Samples of the stiffness that were fitted."""
        return None if self.cycle is None else self.cycle.curve(self.kind)

    @described("N/m")
    def mean(self) -> float:
        """Mean of the stiffness."""
        return self.stiffness.mean

    @described("N/m", "harmonic")
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
        """Amplitude over the mean of the harmonics 1, 2, ... of the samples."""
        return None if self.fit is None else np.array(self.fit.harmonics)

    @described("1")
    def order(self) -> int:
        """Highest harmonic of the series."""
        return len(self.stiffness.amplitudes)

    @described("1")
    def remainder(self) -> float | None:
        """Root mean square of samples less series, over the mean."""
        return None if self.fit is None else self.fit.remainder_rms

    @property
    def error(self) -> float | None:
        """Relative error of the series as a description of the samples; None for a given one."""
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


def left_out(harmonics: Array, bounds: tuple[float, float] | None, damping_ratio: float) -> LeftOut:
    r"""Estimate what series of every order leave out.

    Parameters
    ----------
    harmonics : ndarray, shape (n,)
        Amplitudes of the harmonics 1, 2, ... over the mean.
    bounds : (float, float), optional
        Range of the mesh frequency over the natural one.
    damping_ratio : float
        :math:`\zeta`, above zero for a finite estimate at resonance.
    """
    order = np.arange(1, harmonics.size + 1)
    curve = _tails(0.5 * harmonics**2)
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


def least_order(found: LeftOut, share: float) -> int:
    """Least order that leaves out no more than a share; the highest where none does."""
    most = min(MOST_HARMONICS, found.curve.size - 1)
    enough = np.flatnonzero(found.largest[1 : most + 1] <= share)
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
    from dynamics import fit_fourier

    watch = Stopwatch()
    samples = cycle.curve(kind)
    beyond = left_out(harmonics(samples)[: (samples.size - 1) // 2], bounds, damping_ratio)
    chosen = least_order(beyond, share) if order is None else order
    fit = fit_fourier(samples, order=chosen)
    return MeshSeries(
        kind=kind,
        source=cycle.label,
        stiffness=fit.stiffness,
        fit=fit,
        other=fit_fourier(cycle.curve(OTHER[kind]), order=chosen),
        cycle=cycle,
        left_out=beyond,
        share=share if order is None else None,
        cost=Cost(watch.seconds),
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
