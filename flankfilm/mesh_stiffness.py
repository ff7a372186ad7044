"""Mesh stiffness over one base pitch, from whichever model, in one form for all that follows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from fem import MeshCycle

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MeshStiffness:
    """Stiffness, load share and deflection at the midpoints of equal intervals of one base pitch.

    Attributes
    ----------
    label : str
        Model, as figures name it.
    phase : ndarray, shape (n,)
        Travel along the line of action after a pair is at A, over the base pitch, in (0, 1).
    rho1 : ndarray, shape (n, pairs)
        Curvature radius of the pinion's flank at each pair's contact [m]; NaN without contact.
    forces : ndarray, shape (n, pairs)
        Normal force of each pair [N].
    load_share : ndarray, shape (n, pairs)
        Each pair's share of the torque, rows summing to one.
    secant, tangent : ndarray, shape (n,)
        Force over deflection, and its slope [N/m].
    transmission_error : ndarray, shape (n,)
        Deflection along the line of action [m].
    error : float or None
        Estimated relative numerical error at each position; None where the model's error is unknown.
    seconds : float
        Cost [s].
    contact : MeshCycle or None
        The loaded contact by finite elements that it was taken from, for fields.
    """

    label: str
    phase: Array
    rho1: Array
    forces: Array
    load_share: Array
    secant: Array
    tangent: Array
    transmission_error: Array
    error: float | None
    seconds: float
    contact: MeshCycle | None = None

    @property
    def mean_error(self) -> float | None:
        """Estimated relative numerical error of the mean secant: that of the positions and of their number."""
        return None if self.error is None else self.error + sampling_error(self.secant)

    def stiffness(self, kind: str) -> Array:
        """Curve named `kind`: ``"secant"`` or ``"tangent"`` [N/m]."""
        return {"secant": self.secant, "tangent": self.tangent}[kind]


def sampling_error(stiffness: Array) -> float:
    r"""Estimate the relative error of the mean of `stiffness` over its sampled period.

    A step :math:`\Delta` between two of :math:`n` midpoints lies anywhere between them and moves
    the mean by :math:`\Delta/(n\sqrt{12})` in the root mean square; independent steps add in
    square. On smooth stretches the estimate falls as :math:`n^{-3/2}`, above the true error.

    Parameters
    ----------
    stiffness : ndarray, shape (n,)
        Samples at the midpoints of equal intervals.
    """
    steps = np.diff(stiffness, append=stiffness[:1])
    return float(np.sqrt(np.sum(steps**2) / 12) / (stiffness.size * stiffness.mean()))


def peak_to_peak_error(curve: Array) -> float:
    r"""Bound the relative error of the peak-to-peak value of `curve` from the number of its samples.

    At a cusp, such as the transmission error has where contact passes to the next pair, the extremum is missed by
    up to half the distance h of the samples times the slope. The three sets of every third sample have three times
    the distance; the worst of them misses the highest sample by about h times the slope, wherever the cusp lies
    between samples. Half the largest difference is the bound.

    Parameters
    ----------
    curve : ndarray, shape (n,)
        Samples at the midpoints of equal intervals; n a multiple of three.
    """
    whole = float(np.ptp(curve))
    if whole == 0.0:
        return 0.0
    return max(whole - float(np.ptp(curve[k::3])) for k in range(3)) / (2 * whole)
