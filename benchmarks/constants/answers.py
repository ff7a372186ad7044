"""Cheap answers that together run most of the packages, each figure with the error that its record reports."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

import ehl
import fem
from base.results import figures
from benchmarks.constants import answers_of_dynamics, answers_of_gears
from gears import Alignment, Bearing, Gear, GearPair, Lead, Material, Shaft, ShaftSegment, TipRelief

Array = npt.NDArray[Any]
Figures = dict[str, tuple[Array, float]]
"""Value, and its error in the same unit; 0 where none is reported."""


class RefusedError(Exception):
    """The solver says that it has no answer."""


def of(record: Any, *names: str) -> Figures:
    """Figures of a record with the errors that it names for them."""
    if not getattr(record, "converged", True):
        raise RefusedError(record.message)
    about, answer = figures(type(record)), {}
    for name in names:
        value = np.asarray(getattr(record, name))
        error = getattr(record, about[name].error) if about[name].error else 0.0
        error = error[name] if isinstance(error, Mapping) else error
        size = np.abs(value)
        per_place = np.size(error) > 1
        answer[name] = value, float(np.max(np.nan_to_num(error) * (size if per_place else np.max(size))))
    return answer


def apart(*values: Any) -> Figures:
    """Figures without an error, each of its own size."""
    return {str(k): (np.asarray(float(value)), 0.0) for k, value in enumerate(values)}


PAIR = GearPair(Gear(teeth=20), Gear(teeth=20), module=2e-3, face_width=20e-3).with_backlash(100e-6)
RELIEVED = replace(PAIR, wheel=Gear(teeth=20, tip_relief=TipRelief(15e-6, 0.6e-3)))
TIGHT = replace(PAIR, centre_distance=PAIR.centre_distance_of_backlash(-5e-6), tight=True)
STEEL, POM = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.36, 1410.0)
PLASTIC = replace(PAIR, material=(STEEL, POM)).with_backlash(600e-6)
SHAFT = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.0, 1e9), Bearing(0.2, 1e9)), 0.08, 0.0)
CURVES = ("stiffness", "secant_stiffness", "transmission_error")
MEANS = ("mean_stiffness", "mean_secant_stiffness", "greatest_stiffness", "transmission_error_range")


def _compliance() -> Figures:
    bodies = fem.compliance(PAIR, 0.01)
    value = bodies.own(np.linspace(PAIR.points.A, PAIR.points.E, 9))
    error = bodies.error * float(value.max())
    return {"own": (value[1:-1], error), "own at A and E": (value[[0, -1]], error)} | of(
        bodies, "turning", "hub_windup", "step_windup"
    )


def _cycle(
    pair: GearPair = PAIR, torque: float = 50.0, names: tuple[str, ...] = MEANS, **more: Any
) -> Figures:
    bodies = fem.compliance(pair, 0.02)
    return of(fem.mesh_cycle(pair, torque, 3, bodies, **more), *CURVES, *names)


def _face(pair: GearPair = PAIR, torque: float = 100.0, alignment: float = 10e-6, **more: Any) -> Figures:
    bodies = fem.compliance(pair, 0.05)
    options: dict[str, Any] = {"cells": 8, "face_model": "walls"} | more
    cycle = fem.mesh_cycle(pair, torque, 2, bodies, alignment=Alignment(alignment), **options)
    return of(cycle, *CURVES) | of(cycle.face, "face_load_factor", "greatest_line_load")


def _root(**more: Any) -> Figures:
    cycle = fem.mesh_cycle(PAIR, 50.0, 3, fem.compliance(PAIR, 0.05), beyond_path=False, **more)
    return of(fem.root_stress(PAIR, cycle, tolerance=0.05), "pinion_tension_Pa", "wheel_tension_Pa")


def _fields() -> Figures:
    bodies = fem.compliance(PAIR, 0.05)
    block = fem.field_blocks(PAIR, fem.mesh_cycle(PAIR, 50.0, 3, bodies), 1, bodies)["pinion"]
    greatest = float(block["von_mises_Pa"].max())
    return {"pressed": (np.asarray(greatest), 0.02 * greatest)}  # of a picture, which tells no error


FEM: dict[str, Callable[[], Figures]] = {
    "compliance": _compliance,
    "tips free": _cycle,
    "path only": lambda: _cycle(beyond_path=False),
    "tip relief": lambda: _cycle(RELIEVED, names=()),
    "rounded tips": lambda: _cycle(tip_rounding=50e-6, names=()),
    "both flanks": lambda: _cycle(TIGHT, 20.0, names=()),
    "steel on POM": lambda: _cycle(PLASTIC, 10.0, names=()),
    "roots": _root,
    "fields": _fields,
    "face": lambda: _face(beyond_path=False),
    "face, tips free": _face,
    "face on shafts": lambda: _face(beyond_path=False, shafts=(SHAFT, None)),
    "face, crowned, contact ends": lambda: _face(
        replace(PAIR, wheel=Gear(20, lead=Lead(crowning=30e-6))), 5.0, 30e-6, beyond_path=False
    ),
}

OIL = ehl.Lubricant(0.02, 17e-9, 860.0, temperature=363.15, eyring_stress=5e6)
LIMITED = ehl.LineContact(
    2e5, 2.5, 6e-3, 2.26e11, replace(OIL, eyring_stress=None, limiting_shear_ratio=0.06), sliding=1.0
)
SLIDING = ehl.LineContact(2e5, 2.5, 6e-3, 2.26e11, OIL, sliding=1.0)
PLAIN = ehl.LineContact(1e5, 1.0, 0.015, 2.2e11, ehl.Lubricant(0.06, 22.6e-9, 910.0))
GROUND = ehl.Roughness(deviation=0.3e-6, density=0.04 / (150 * 0.3e-6**2), tip_radius=150 * 0.3e-6)
LAYER, MENISCUS = ehl.OilLayer(2e-7), ehl.Meniscus(-1.3 * SLIDING.half_width)
FILM = ("central_thickness", "minimum_thickness")
HEAT = (*FILM, "traction_coefficient", "oil_temperature_rise", "surface_temperature_rise")
RATES = PLAIN.entrainment / PLAIN.half_width * np.array([0.0, 0.3, 1.0])


def _film(contact: ehl.LineContact = PLAIN, tolerance: float = 0.01, **more: Any) -> Figures:
    film = ehl.solve(contact, tolerance=tolerance, **more)
    answer = of(film, *FILM) | {
        "separation": (np.asarray(film.separation), abs(film.separation) * film.errors.separation)
    }
    if film.spike is not None and "spike" in more:
        answer |= of(film.spike, "pressure")
    return answer


def _table() -> Figures:
    rows = ehl.stiffness_table(ehl.solve(PLAIN, tolerance=0.01))
    return {
        r.definition: (np.asarray(r.stiffness), abs(r.stiffness) * float(np.nan_to_num(r.error)))
        for r in rows
    }


def _warm(**more: Any) -> Figures:
    return of(ehl.solve_thermal(SLIDING, tolerance=0.02, **more), *HEAT)


def _response(film: Any) -> Figures:
    return of(ehl.film_response(film, RATES), "compliance", "stiffness", "damping")


def _over_time() -> Figures:
    unit = PLAIN.half_width / PLAIN.entrainment
    film = ehl.solve_transient(
        PLAIN, lambda t: 1e5 * (1 + 0.2 * min(t / unit, 1)), [0.0, unit, 2 * unit], tolerance=0.05
    )
    return of(film, "least", "central", "separation", "greatest_pressure")


def _oils() -> Figures:
    oil = ehl.Lubricant.from_iso_vg(220.0, temperature=353.15)
    values = (
        oil.viscosity,
        oil.pressure_viscosity,
        oil.density,
        oil.log_viscosity(1e9)[0],
        oil.density_ratio(1e9)[0],
    )
    rows = (0.1, 0.02), (20.0, 1.5), (900.0, 40.0)
    table = ehl.MeasuredViscosity((0.0, 5e8, 1e9), (313.15, 353.15), rows, at=353.15)
    return apart(*values, table.viscosity_at(4e8, 343.15), oil.at_temperature(330.0).viscosity)


def _formulas() -> Figures:
    rough = GROUND.pressure(0.5e-6, 2.2e11)
    drawn = ehl.Roughness.from_drawing(peaks=3e-6)
    limit = ehl.LineContact.from_moes(M=20.0, L=0.0)
    films = ehl.moes_central(PLAIN), ehl.pan_hamrock_central(PLAIN), ehl.nijenbanning_line_central(PLAIN)
    flash = ehl.blok_flash_temperature(SLIDING, 0.05)
    sizes = drawn.deviation, drawn.density, drawn.tip_radius, limit.entrainment
    return apart(*films, *rough, *sizes, np.max(flash), len(ehl.regime(1.5)))


EHL: dict[str, Callable[[], Figures]] = {
    "film": _film,
    "spike": lambda: _film(spike=0.05),
    "meniscus": lambda: _film(SLIDING, supply=MENISCUS),
    "layer": lambda: _film(SLIDING, supply=LAYER),
    "stiffness": _table,
    "heat": _warm,
    "heat and layer": lambda: _warm(supply=LAYER),
    "heat and meniscus": lambda: _warm(supply=MENISCUS),
    "rough": lambda: of(ehl.solve_mixed(SLIDING, GROUND, 0.01), *FILM, "film_ratio"),
    "rough and layer": lambda: of(ehl.solve_mixed(SLIDING, GROUND, 0.01, supply=LAYER), *FILM, "film_ratio"),
    "rough and heat": lambda: of(
        ehl.solve_mixed_thermal(SLIDING, GROUND, tolerance=0.02), "central_thickness"
    ),
    "rough as drawn": lambda: of(
        ehl.solve_mixed(SLIDING, ehl.Roughness.from_drawing(mean=0.4e-6), 0.01), *FILM, "asperity_share"
    ),
    "limiting shear": lambda: of(ehl.solve_thermal(LIMITED, tolerance=0.02), *HEAT),
    "response": lambda: _response(ehl.solve(PLAIN, tolerance=0.01)),
    "response with heat": lambda: _response(ehl.solve_thermal(SLIDING, tolerance=0.02)),
    "response, rough": lambda: _response(ehl.solve_mixed(SLIDING, GROUND, 0.01)),
    "over time": _over_time,
    "traction": lambda: of(
        ehl.traction_curve(OIL, 0.9e9, 5.0, [0.0, 0.02], radius=0.02, tolerance=0.02), "traction_coefficient"
    ),
    "oils": _oils,
    "formulas": _formulas,
}


@cache
def answers() -> dict[str, Callable[[], Figures]]:
    """All of them, by package and name."""
    packages = {
        "gears": answers_of_gears.GEARS,
        "fem": FEM,
        "ehl": EHL,
        "dynamics": answers_of_dynamics.DYNAMICS,
    }
    return {
        f"{package}: {name}": answer for package, those in packages.items() for name, answer in those.items()
    }
