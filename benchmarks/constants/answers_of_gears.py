"""Answers of gears for the study of constants: geometry, load sharing, arcs and closed forms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import gears
from gears import Bearing, Blank, Gear, GearPair, Heat, Shaft, ShaftSegment, closed_form, share_load
from gears.pair.beams import reduced
from gears.pair.shaft_face import shaft_over_face
from gears.sharing.both_flanks import share_between
from gears.sharing.events import Sampled, arcs_between_events
from gears.tooth.contour import contour

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), module=2e-3, face_width=40e-3)
PLAY = PAIR.with_backlash(50e-6)
FORCE, STEP, BACK, CUSP = 17736.3, 0.137, 0.62, 0.41
SHAFT = Shaft(
    (ShaftSegment(0.12, 0.03), ShaftSegment(0.08, 0.04)), (Bearing(0.0, 1e9), Bearing(0.2, 2e9)), 0.08, 0.0
)


class Hertz:
    """c F [ln(K / F) + 1], of a line contact."""

    def approach(self, force: Any) -> Any:
        """Deflection [m]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 1.6e-10 * safe * (np.log(1e9 / safe) + 1.0), 0.0)

    def slope(self, force: Any) -> Any:
        """Its derivative by the force [m/N]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 1.6e-10 * np.log(1e9 / safe), np.inf)


def _numbers(*values: Any) -> dict[str, Any]:
    return {str(k): (np.asarray(value, dtype=float), 0.0) for k, value in enumerate(values)}


def _bulk(pairs: int) -> Any:
    a = np.random.default_rng(3).normal(size=(pairs, pairs))
    return 1e-9 * (a @ a.T / pairs + 0.5 * np.eye(pairs))


def _share() -> dict[str, Any]:
    gaps = np.array([[0.0, 2e-6, 1e-5, 1e-3], [1e-6, 0.0, 3e-6, 2e-5]])
    share = share_load(np.array([1e3, 1e4]), _bulk(4), Hertz(), gaps)
    return _numbers(share.forces, share.transmission_error, share.stiffness)


def _both() -> dict[str, Any]:
    cases = ((0.0, -1e-5), (500.0, -1e-5), (-2e3, 1e-6))
    sides, shares = np.array([1.0, 1.0, -1.0, -1.0]), []
    for force, overlap in cases:
        gaps = np.array([0.0, 2e-6, overlap, overlap + 3e-6])
        shares.append(share_between(force, _bulk(4), Hertz(), gaps, sides))
    return _numbers(*(share.forces for share in shares), *(share.transmission_error for share in shares))


def _known(position: Any) -> Sampled:
    x = np.mod(position, 1.0)
    inside = np.minimum(x - STEP, BACK - x)
    step = np.where(inside >= 0, 2.0 + np.sin(3 * x), np.exp(x) / 2)
    cusp = np.where(x < CUSP, x**2, CUSP**2 * (1 - x) / (1 - CUSP))
    return Sampled(np.stack([step, cusp]), inside[:, None])


def _arcs() -> dict[str, Any]:
    arcs = arcs_between_events(_known, ("step", "cusp"), np.array([CUSP]), tolerance=1e-6).arcs
    answer: dict[str, Any] = {}
    for name in ("step", "cusp"):
        series, errors = arcs.harmonics(name, np.arange(1, 6))
        (least, low), (most, high) = arcs.extremes(name)
        answer |= {
            f"{name} mean": tuple(map(np.asarray, arcs.mean(name))),
            f"{name} harmonics": (series, float(np.max(errors))),
            f"{name} extremes": (np.array([least, most]), max(low, high)),
        }
    # a step lies within 1e-9 of where it is found, which no error of an arc knows of
    return {name: (value, float(error) + 5e-9) for name, (value, error) in answer.items()}


def _closed_forms() -> dict[str, Any]:
    path = PAIR.path_of_contact(9)
    forms = (
        closed_form.ishikawa(PAIR, path),
        closed_form.weber_banaschek(PAIR, path, FORCE),
        closed_form.potential_energy(PAIR, path, FORCE),
        closed_form.hertz(PAIR, path, FORCE),
    )
    iso, flank, root = (
        closed_form.iso6336(PAIR, 300.0 * 0.04e3),
        closed_form.iso6336_2(PAIR, FORCE),
        closed_form.iso6336_3(PAIR, FORCE),
    )
    dynamic = closed_form.iso6336_dynamic(PAIR, FORCE, 0.3, [100.0, 400.0, 2000.0], pitch_deviation=5e-6)
    return _numbers(
        *(np.sum(list(form.parts.values()), axis=0) for form in forms),
        [iso.c_th, iso.c_gamma, closed_form.iso6336(PAIR, 20.0 * 40).c_gamma],
        [*flank.stresses, *flank.single_pair_stresses],
        root.stresses,
        dynamic.K_v,
        closed_form.iso6336_face_load(PAIR, 600.0, 20e-6).K_Hbeta,
        closed_form.ohlendorf_loss_factor(PAIR),
        closed_form.schlenk_friction(PAIR, 600.0, 200.0, 0.01, 0.4e-6),
    )


def _geometry() -> dict[str, Any]:
    sizes, check = gears.dimensions(PLAY), gears.check_meshing(PLAY)
    contour = PAIR.teeth_profiles[0]
    under = GearPair(Gear(14), Gear(20, tip_alteration=-0.2), module=2e-3, face_width=20e-3)
    blank = GearPair(
        Gear(60, bore_radius=0.01, blank=Blank(4e-3, 6e-3)), Gear(60), module=2e-3, face_width=20e-3
    )
    return _numbers(
        [*sizes.span, *sizes.pin_diameter, *sizes.over_pins],
        check.angle_deviation + 1.0,
        [contour.tip_radius, contour.root_radius, *contour.flank_rho],
        [p.root_radius for p in (*under.teeth_profiles, *blank.teeth_profiles)],
        [under.contact_ratio, blank.contact_ratio, PLAY.working_centre_distance],
    )


def _shafts() -> dict[str, Any]:
    beam, face = reduced(SHAFT), shaft_over_face(SHAFT, ((np.arange(16) + 0.5) / 16 - 0.5) * 0.02, 0.02)
    return _numbers(beam.bending_stiffness, beam.bearing_shares, face.between)


def _warm() -> dict[str, Any]:
    warm = gears.warm_pair(PLAY, Heat(363.15, 353.15, 323.15))
    free = gears.warm_pair(PLAY, Heat(pinion_temperature=363.15))
    return _numbers(*([w.backlash, w.base_pitch_difference] for w in (warm, free)))


def _outline() -> dict[str, Any]:
    points, _ = contour(PAIR.teeth_profiles[0], None, 1e-6).polygon()
    area = 0.5 * np.sum(points[:-1, 0] * points[1:, 1] - points[1:, 0] * points[:-1, 1])
    return {"area": (np.asarray(area), 1e-6 * 0.25)}


GEARS: dict[str, Callable[[], dict[str, Any]]] = {
    "load sharing": _share,
    "both flanks": _both,
    "arcs": _arcs,
    "closed forms": _closed_forms,
    "geometry": _geometry,
    "shafts": _shafts,
    "heat": _warm,
    "outline": _outline,
}
