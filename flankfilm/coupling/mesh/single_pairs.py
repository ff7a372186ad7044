"""Stiffness of one pair of teeth along the path of contact by every model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

import fem
import gears
from base import Array, Cost, Faults, Stopwatch, part, quantity, record, unclocked
from gears.closed_form.record import UNKNOWN

CLOSED_FORMS = {
    "ishikawa": "Ishikawa",
    "weber-banaschek": "Weber-Banaschek",
    "potential-energy": "potential energy, Sainsot body",
}
"""Closed forms by name, with the label that figures give them."""

MODELS = {**CLOSED_FORMS, "fem": "finite elements"}
"""All models of one pair of teeth likewise."""

STATIONS = 81
"""Equally spaced points of the path A to E, both ends included."""


@record
class SinglePairs:
    """Stiffness of one pair of teeth along the path of contact by every model at hand.

    ``error`` is that of the finite elements; None without them, since the closed forms' own is unknown.
    """

    travel: Array = quantity("m", "travel from A along the path of contact", "path", shown="mm")
    rho1: Array = quantity("m", "curvature radius of the pinion's flank", "path", shown="mm")
    stiffness: Mapping[str, Array] = quantity(
        "N/m", "stiffness of one pair", "path", error="errors", no_error=UNKNOWN
    )
    iso: gears.closed_form.Iso6336Stiffness = part("stiffness by ISO 6336-1")
    contact: gears.closed_form.Iso6336ContactStress = part("nominal contact stress by ISO 6336-2")
    error: float | None
    cost: Cost
    converged: bool = True
    message: str = ""
    reference: str = quantity(
        "", "what the deflection of one pair by finite elements is measured against", default="body"
    )

    @property
    def errors(self) -> Mapping[str, float]:
        """Relative errors of the stiffness by its label, where they are known."""
        return {} if self.error is None else {MODELS["fem"]: self.error}


def closed_form(model: str, pair: gears.GearPair, path: gears.PathOfContact, force: float) -> Array:
    """Evaluate a closed form by its name in `CLOSED_FORMS` on a path of contact under a force [N]."""
    if model == "ishikawa":
        return np.asarray(gears.closed_form.ishikawa(pair, path))
    if model == "weber-banaschek":
        return np.asarray(gears.closed_form.weber_banaschek(pair, path, force))
    return np.asarray(gears.closed_form.potential_energy(pair, path, force=force))


def single_pair_stiffness(
    pair: gears.GearPair,
    force: float,
    rho1: ArrayLike,
    model: str = "fem",
    compliance: fem.PairCompliance | None = None,
    *,
    reference: str = "bore",
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Secant stiffness of one pair of teeth that carries the whole force, by any model.

    Parameters
    ----------
    pair : gears.GearPair
    force : float
        Normal force [N].
    rho1 : array_like
        Curvature radii of the pinion's flank at the contact [m]; nan stays nan.
    model : str
        ``"fem"``, ``"ishikawa"``, ``"weber-banaschek"`` or ``"potential-energy"``.
    compliance : fem.PairCompliance, optional
        For finite elements; computed unless given.
    reference, bore_inertia
        What the deflection by finite elements is measured against, as of `fem.single_pair_stiffness`: the bores unless
        given. Closed forms describe that against the teeth.

    Returns
    -------
    ndarray, of the shape of `rho1`
        [N/m]

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> k = single_pair_stiffness(pair, 17.7e3, [pair.points.A, pair.points.C], model="ishikawa")
    >>> [round(float(value) / 40e6, 1) for value in k]  # N/(mm um)
    [9.4, 16.6]
    """
    with Faults() as faults:
        faults.choice("model", model, tuple(MODELS))
    places = np.asarray(rho1, dtype=np.float64)
    known = np.isfinite(places)
    k = np.full_like(places, np.nan)
    if model == "fem":
        k[known] = fem.single_pair_stiffness(
            pair,
            force=force,
            rho1=places[known],
            compliance=compliance,
            reference=reference,
            bore_inertia=bore_inertia,
        )
    else:
        k[known] = closed_form(model, pair, pair.path_at(places[known]), force)
    return k


def single_pairs(
    pair: gears.GearPair,
    torque: float,
    compliance: fem.PairCompliance | None = None,
    points: int = STATIONS,
    *,
    reference: str = "body",
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> SinglePairs:
    """Stiffness of one pair along the path by all closed forms, beside finite elements where they are at hand.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    compliance : fem.PairCompliance, optional
        Finite elements are left out without it.
    points : int
        Of the path, A and E included.
    reference, bore_inertia
        What the deflection by finite elements is measured against, as of `fem.mesh_cycle`.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> found = single_pairs(pair, 600.0)
    >>> all(curve.shape == found.rho1.shape for curve in found.stiffness.values())
    True
    """
    from gears import closed_form as forms

    if compliance is not None:
        with unclocked():
            import fem  # noqa: F401 - its import is no cost of the result
    watch = Stopwatch()
    path, force = pair.path_of_contact(n=points), abs(pair.normal_force(torque))
    models = [*(["fem"] if compliance is not None else []), *CLOSED_FORMS]
    return SinglePairs(
        travel=path.position,
        rho1=path.rho1,
        stiffness={
            MODELS[model]: single_pair_stiffness(
                pair, force, path.rho1, model, compliance, reference=reference, bore_inertia=bore_inertia
            )
            for model in models
        },
        iso=forms.iso6336(pair, force=force),
        contact=forms.iso6336_2(pair, force),
        error=None if compliance is None else compliance.error,
        cost=Cost(watch.seconds),
        reference=reference,
    )
