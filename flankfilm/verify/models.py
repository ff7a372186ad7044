"""What is compared: one pair along the path and the mesh cycle, by each closed form and by finite elements."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.stages.closed_forms import CLOSED_FORMS, closed_form
from flankfilm.stages.separate_pairs import contacts_of

if TYPE_CHECKING:
    from fem import Compliance
    from gears import GearPair

Array = NDArray[np.float64]

POINTS = 81
"""Equally spaced points of the path A to E, both ends included; the pitch point C is added to them."""

REFERENCES: Mapping[str, tuple[bool, tuple[str, ...]]] = {
    "finite elements": (True, ()),
    "held to the path": (False, ()),
    "without hub wind-up": (False, ("hub_windup",)),
    "without coupling": (False, ("coupling",)),
    "without hub wind-up and coupling": (False, ("hub_windup", "coupling")),
}
"""Label to: whether tip edges may touch outside the path, and the parts of the compliance left out."""


@dataclass(frozen=True, eq=False)
class Curves:
    """Stiffness by one model.

    Attributes
    ----------
    label : str
        Model.
    single : ndarray, shape (POINTS + 1,)
        Secant stiffness of one pair under the whole force, at `stations` [N/m].
    secant : ndarray, shape (n,)
        Of the mesh, at midpoints of equal intervals of one base pitch [N/m].
    transmission_error : ndarray, shape (n,)
        [m]
    pairs : ndarray of int, shape (n,)
        Pairs on the path of contact.
    seconds : float
        Cost, without what several models share [s].
    error : float or None
        Estimated relative numerical error of the single pair; None for closed forms, whose error is
        what is asked for.
    means : mapping
        Figures that a model gives without curves, such as those of ISO 6336-1 [N/m].
    left_out : tuple of str
        Parts of the compliance by finite elements that are left out.
    """

    label: str
    single: Array
    secant: Array
    transmission_error: Array
    pairs: NDArray[np.int64]
    seconds: float
    error: float | None = None
    means: Mapping[str, float] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()


def stations(pair: GearPair) -> Array:
    """Curvature radii of the pinion's flank from A to E, with C among them, (POINTS + 1,) [m]."""
    points = pair.points
    return np.sort(np.append(np.linspace(points.A, points.E, POINTS), points.C))


def closed_form_curves(pair: GearPair, force: float, positions: int) -> Iterator[Curves]:
    """Evaluate every closed form, its pairs independent as closed forms have them."""
    from gears import closed_form as forms
    from gears import independent_pairs

    path = pair.path_at(stations(pair))
    _, rho1 = contacts_of(pair, positions)
    touching = np.isfinite(rho1)
    for name, label in CLOSED_FORMS.items():
        began = time.perf_counter()
        single = np.asarray(closed_form(name, pair, path, force))
        k = np.zeros_like(rho1)
        k[touching] = np.asarray(closed_form(name, pair, pair.path_at(rho1[touching]), force))
        share = independent_pairs(force, k)
        yield Curves(
            label,
            single,
            np.asarray(share.stiffness),
            np.asarray(share.transmission_error),
            touching.sum(axis=1),
            time.perf_counter() - began,
        )
    began = time.perf_counter()
    iso = forms.iso6336(pair, force=force)
    nothing = np.full(0, np.nan)
    means = {"one pair, largest": iso.single_stiffness, "mesh, mean": iso.mesh_stiffness}
    yield Curves(
        "ISO 6336-1",
        nothing,
        nothing,
        nothing,
        np.zeros(0, dtype=np.int64),
        time.perf_counter() - began,
        means=means,
    )


def reference_curves(
    pair: GearPair, torque: float, bodies: Compliance, positions: int, beyond_path: bool
) -> Iterator[Curves]:
    """Evaluate finite elements with all parts, and with the parts left out that closed forms lack.

    Parameters
    ----------
    beyond_path : bool
        Whether tip edges may touch outside the path in the first of them.
    """
    import fem

    force = pair.normal_force(torque)
    _, rho1 = contacts_of(pair, positions)
    for label, (whole, left_out) in REFERENCES.items():
        if whole and not beyond_path:
            continue  # the next one is the same
        began = time.perf_counter()
        parts = bodies.without(*left_out)
        cycle = fem.mesh_cycle(pair, torque=torque, positions=positions, compliance=parts, beyond_path=whole)
        single = fem.single_pair_stiffness(pair, force=force, rho1=stations(pair), compliance=parts)
        yield Curves(
            label,
            single,
            cycle.secant_stiffness,
            cycle.transmission_error,
            np.isfinite(rho1).sum(axis=1),
            time.perf_counter() - began,
            error=bodies.error,
            left_out=left_out,
        )
