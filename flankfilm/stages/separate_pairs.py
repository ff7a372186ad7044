"""Mesh cycles from single-pair stiffnesses, without the coupling through the gear body."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.build import pinion_torque
from flankfilm.film_law import FilmLaw, PlacedFilm
from flankfilm.mesh_stiffness import MeshStiffness
from flankfilm.stages.closed_forms import CLOSED_FORMS, closed_form

if TYPE_CHECKING:
    from flankfilm.stages.engine import Engine
    from gears import GearPair

Array = NDArray[np.float64]


def contacts_of(pair: GearPair, positions: int) -> tuple[Array, Array]:
    """Place the pairs of teeth on the path.

    Parameters
    ----------
    pair : GearPair
        The pair.
    positions : int
        Number of equal intervals of one base pitch.

    Returns
    -------
    phase : ndarray, shape (positions,)
        Travel after a pair is at A, in base pitches, at the intervals' midpoints.
    rho1 : ndarray, shape (positions, pairs)
        Curvature radius of the pinion's flank [m]; NaN beyond E.
    """
    phase = (np.arange(positions) + 0.5) / positions
    pairs = int(np.ceil(pair.contact_ratio))
    rho1 = pair.points.A + pair.base_pitch * (phase[:, None] + np.arange(pairs))
    return phase, np.where(rho1 <= pair.points.E, rho1, np.nan)


def single_pair_stiffness(engine: Engine, model: str, rho1: Array) -> Array:
    """Secant stiffness of one pair by a model at given points, NaN staying NaN [N/m]."""
    pair = engine["pair"]
    force = pair.normal_force(pinion_torque(engine.scene))
    known = np.isfinite(rho1)
    k = np.full_like(rho1, np.nan)
    if model == "fem":
        import fem

        k[known] = fem.single_pair_stiffness(
            pair, force=force, rho1=rho1[known], compliance=engine["compliance"]
        )
    else:
        k[known] = np.asarray(closed_form(model, pair, pair.path_at(rho1[known]), force))
    return k


def other_cycles(engine: Engine) -> tuple[MeshStiffness, ...]:
    """Mesh cycles by the models that the scene did not choose: independent pairs added, without film."""
    scene, positions = engine.scene, engine["dry cycle"].phase.size
    model = engine["plan"].stiffness.choice
    chosen = (model, scene.stiffness.pairs)
    models = [*CLOSED_FORMS, *(["fem"] if model == "fem" else [])]
    return tuple(
        separate_pairs_cycle(engine, model, "independent", positions)
        for model in models
        if (model, "independent") != chosen
    )


def separate_pairs_cycle(
    engine: Engine, model: str, pairs: str, positions: int, film: FilmLaw | None = None
) -> MeshStiffness:
    """Mesh cycle of pairs that know each other only through the force they share.

    ``independent``: each pair's secant stiffness, in series with its film's, and the force in
    proportion. ``coupled``: one approach for all loaded pairs, with the gaps that tip relief leaves
    and the film's separation as a function of its force; the gear body couples them in finite elements alone.
    """
    from gears import independent_pairs, share_load

    start = time.perf_counter()
    pair = engine["pair"]
    force = pair.normal_force(pinion_torque(engine.scene))
    phase, rho1 = contacts_of(pair, positions)
    touching = np.isfinite(rho1)
    k = np.where(touching, single_pair_stiffness(engine, model, rho1), 0.0)
    if pairs == "independent":
        series = None if film is None else film.stiffness(rho1)
        share = independent_pairs(force, k, series)
        secant = tangent = np.asarray(share.stiffness)
    else:
        compliance = 1.0 / np.where(touching, k, 1.0)
        bulk = compliance[..., None] * np.eye(k.shape[1])
        gaps = np.where(touching, _relief(pair, rho1), np.inf)
        share = share_load(force, bulk, _NoHertz(), gaps, None if film is None else PlacedFilm(film, rho1))
        secant, tangent = force / np.asarray(share.transmission_error), np.asarray(share.stiffness)
    return MeshStiffness(
        label=f"{_LABELS[model]}, {pairs} pairs",
        phase=phase,
        rho1=rho1,
        forces=share.forces,
        load_share=share.forces / force,
        secant=secant,
        tangent=tangent,
        transmission_error=np.asarray(share.transmission_error),
        error=engine["compliance"].error if model == "fem" else None,
        seconds=time.perf_counter() - start,
    )


_LABELS = {**CLOSED_FORMS, "fem": "finite elements"}


class _NoHertz:
    """Local deflection of closed forms: already in the single pair's stiffness at the full force."""

    def approach(self, force: Array) -> Array:
        return np.zeros_like(force)

    def slope(self, force: Array) -> Array:
        return np.zeros_like(force)


def _relief(pair: GearPair, rho1: Array) -> Array:
    """Clearance that tip relief of both gears leaves [m], NaN staying NaN, least zero at each position."""
    pinion, wheel = pair.teeth_profiles
    gap = pinion.relief(rho1) + wheel.relief(pair.line_of_action - rho1)
    return np.asarray(gap - np.nanmin(gap, axis=1, keepdims=True))
