r"""How many harmonics the Fourier stiffness of a scene has: as few as leave out less than their share.

What a series of order n leaves out of the curve is the root mean square of the dropped harmonics,
:math:`\sqrt{\tfrac12 \sum_{j>n} \kappa_j^2}` over the mean. In the motion a dropped harmonic excites the pair by
:math:`\kappa_j` times its static deflection; to first order, about a mesh of mean stiffness in contact, it answers with
the amplitude :math:`\kappa_j H(j \omega)`, :math:`H(r) = [(1-r^2)^2 + (2 \zeta r)^2]^{-1/2}`. Where a wanted range of
frequencies passes :math:`j \omega = 1` that is :math:`\kappa_j / (2 \zeta)`: harmonics far too small for the curve
make resonances of their own at low speed. Both estimates have to stay below the share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flankfilm.stages.decisions import Candidate, Decision, per_cent

Array = NDArray[np.float64]

MOST_HARMONICS = 50
"""As many as a scene may ask for."""

_FREQUENCIES = 2000


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


def choose_order(found: LeftOut, share: float) -> tuple[int, Decision]:
    """Give the least order that leaves out less than a share, and the decision; the highest where none does."""
    most = min(MOST_HARMONICS, found.curve.size - 1)
    largest = found.largest[: most + 1]
    enough = np.flatnonzero(largest[1:] <= share)
    order = int(enough[0]) + 1 if enough.size else most
    why = f"{order}, leaves out {_told(found, order)}"
    if enough.size:
        why += f", below its share of {per_cent(share)}"
        if order > 1:
            why += f"; order {order - 1} would leave {_told(found, order - 1)}"
    else:
        why += f": above its share of {per_cent(share)}, which no series of up to {most} harmonics meets"
    tried = tuple(
        Candidate(str(n), float(found.largest[n]), None)
        for n in range(max(1, order - 1), min(order + 1, most) + 1)
    )
    return order, Decision("Fourier order", str(order), False, why, float(largest[order]), share, None, tried)


def asked_order(found: LeftOut, order: int) -> Decision:
    """Say what an order that the scene names leaves out."""
    why = f"{order}, as the scene asks; leaves out {_told(found, order)}"
    return Decision("Fourier order", str(order), True, why, float(found.largest[order]))


def _told(found: LeftOut, order: int) -> str:
    told = f"{per_cent(found.curve[order])} of the curve"
    return told if found.motion is None else f"{told} and up to {per_cent(found.motion[order])} of the motion"
