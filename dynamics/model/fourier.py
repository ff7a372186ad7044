"""Fourier series through a sampled stiffness, and what the series leaves out."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, described, quantity, record
from dynamics.model.reasons import FITTED
from dynamics.model.stiffness import FourierStiffness


@record
class FourierFit:
    """A Fourier series and what it leaves out."""

    no_error = FITTED

    headline = ("order", "remainder_rms", "remainder_max")

    stiffness: FourierStiffness = quantity("", "the series, in the unit of the samples")
    remainder_rms: float = quantity("1", "root mean square of samples minus series, over the mean")
    remainder_max: float = quantity("1", "largest difference between a sample and the series, over the mean")
    harmonics: tuple[float, ...] = quantity(
        "1",
        "amplitude over mean of the harmonics 1, 2, ...: all that equally spaced samples resolve, so that what a low "
        "order drops can be seen; with unequal spacing those of the series",
        "harmonic",
    )
    condition: float = quantity(
        "1",
        "condition number of the least-squares matrix; 1.41 for equally spaced samples (the mean against a cosine)",
    )
    cost: Cost
    converged: bool = True
    message: str = ""

    @described("1")
    def order(self) -> int:
        """Highest harmonic of the series."""
        return self.stiffness.order

    @described("1")
    def error(self) -> float:
        """Relative error of the series as a description of the samples (its relative root mean square)."""
        return self.remainder_rms


def fit_fourier(samples: npt.ArrayLike, order: int = 1, positions: npt.ArrayLike | None = None) -> FourierFit:
    r"""Fit :math:`K = k_0 + \sum_{j \le n} k_j \cos(j \omega \tau + \varphi_j)` to samples of one period.

    Least squares; for equally spaced samples this is the discrete Fourier transform. The phases refer to the
    start of the period, for a gear pair the instant at which a tooth pair is at A.

    Parameters
    ----------
    samples : array_like, shape (m,)
        Stiffness over one period, [N/m] or any unit, m > 2 order.
    order : int
        Highest harmonic, 0 or more.
    positions : array_like, shape (m,), optional
        Where in the period the samples lie, as fractions of the period. Left out: the midpoints of m equal
        intervals, (i + 1/2)/m.

    Returns
    -------
    FourierFit
        The series, its remainder and the harmonics.

    Raises
    ------
    InputError
        If a sample is not finite, the mean is zero, the order is too high for the samples, or the positions
        cannot separate the harmonics.

    Examples
    --------
    >>> from dynamics import fit_fourier
    >>> fit = fit_fourier([1.2, 1.1, 0.9, 0.8], order=1)
    >>> fit.stiffness.mean, round(fit.harmonics[0], 4)
    (1.0, 0.2121)
    """
    watch = Stopwatch()
    faults = Faults()
    k = np.asarray(samples, dtype=np.float64)
    if k.ndim != 1 or len(k) < 1 or not np.all(np.isfinite(k)):
        allowed = "must be finite numbers in one dimension"
        faults.add("samples", f"shape {k.shape}", allowed, "correct or drop the bad samples")
        faults.raise_if_any()
    m = len(k)
    most = (m - 1) // 2
    n = faults.whole("order", order, 0, most, f"{m} samples resolve {most} harmonics: give more samples")
    midpoints = (np.arange(m) + 0.5) / m
    fractions = midpoints if positions is None else np.asarray(positions, dtype=np.float64)
    if fractions.shape != k.shape or not np.all(np.isfinite(fractions)):
        allowed = f"must be {m} finite numbers"
        faults.add("positions", f"shape {fractions.shape}", allowed, "give one position per sample")
    faults.raise_if_any()

    spacing = np.diff(np.sort(np.mod(fractions, 1.0)))
    equal = bool(np.allclose(spacing, 1.0 / m, rtol=0.0, atol=1e-12))
    resolved = most if equal else n
    angle = 2.0 * np.pi * fractions
    design = _design(angle, resolved)
    condition = float(np.linalg.cond(design[:, : 2 * n + 1]))
    if not condition < 1e8:
        stated = f"condition number {condition:.1e}"
        faults.add("positions", stated, "must be below 1e8", "spread the positions over the period")
    solution = np.linalg.lstsq(design, k, rcond=None)[0]
    mean = float(solution[0])
    if mean == 0.0:
        allowed = "must have a mean other than zero"
        faults.add("samples", "mean 0", allowed, "a relative remainder needs a mean")
    faults.raise_if_any()
    cosine, sine = solution[1::2], solution[2::2]
    amplitudes = np.hypot(cosine, sine)
    phases = np.arctan2(-sine, cosine)
    remainder = (k - design[:, : 2 * n + 1] @ solution[: 2 * n + 1]) / mean
    rms = float(np.sqrt(np.mean(remainder**2)))
    return FourierFit(
        stiffness=FourierStiffness(mean, tuple(amplitudes[:n].tolist()), tuple(phases[:n].tolist())),
        remainder_rms=rms,
        remainder_max=float(np.max(np.abs(remainder))),
        harmonics=tuple((amplitudes / abs(mean)).tolist()),
        condition=condition,
        cost=Cost(watch.seconds, 2 * n + 1),
        message=f"{n} harmonics leave out {rms:.2g} of the mean",
    )


def _design(angle: Array, order: int) -> Array:
    """Columns 1, cos, sin, cos 2, sin 2, ..."""
    columns = [np.ones_like(angle)]
    for j in range(1, order + 1):
        columns += [np.cos(j * angle), np.sin(j * angle)]
    return np.stack(columns, axis=1)
