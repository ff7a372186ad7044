"""Films of one line contact: isothermal, heated, starved, mixed, over time, their response and slopes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

import ehl

from .case import Cases, take
from .pairs import COLD, COLD_OIL, HOT, OIL

case = Cases("ehl")
FILM = (
    "x pressure thickness inlet outlet central_thickness minimum_thickness minimum_position separation "
    "separation_slope central_slope flow central_moes minimum_moes error errors converged message"
)
HEAT = (
    "traction_coefficient oil_temperature_rise surface_temperature_rise dissipation losses temperature shear_stress "
    "traction_error temperature_error"
)
STIFFNESSES = "approach", "tangent", "nodal-sum", "dowson-central", "dowson-minimum"
ROUGH = ehl.Roughness.from_drawing(mean=0.4e-6)
MOES = ehl.LineContact.from_moes(M=20.0, L=10.0, roelands_z=0.68, pressure_viscosity=22e-9, compressible=True)


def meniscus(contact: ehl.LineContact, half_widths: float) -> ehl.Meniscus:
    """Inlet that is full from so many half-widths before the line of centres."""
    return ehl.Meniscus(-half_widths * contact.half_width)


def film_figures(film: Any) -> dict[str, Any]:
    """Fields, figures and every stiffness of a film."""
    return {
        **take(film, FILM),
        "stiffness": [film.stiffness(definition=definition) for definition in STIFFNESSES],
    }


@case(quick=True)
def isothermal() -> dict[str, Any]:
    """Flooded films by tolerance, nodes and domain, of oils of every law, light to heavy; formulas beside them."""
    contacts = {
        "cold": COLD,
        "light": replace(COLD, load=2e4),
        "heavy": replace(COLD, load=8e5, entrainment=4.0),
        "moes": MOES,
        "barus": replace(
            COLD, lubricant=ehl.Lubricant(0.06, 15e-9, 910.0, viscosity_law=ehl.Barus(15e-9)), load=3e4
        ),
        "incompressible": replace(COLD, lubricant=replace(COLD_OIL, compressible=False)),
    }
    films: dict[str, Any] = {
        name: film_figures(ehl.solve(contact, tolerance=0.005)) for name, contact in contacts.items()
    }
    films |= {f"{n} nodes": film_figures(ehl.solve(COLD, nodes=n)) for n in (129, 257)}
    films["domain"] = film_figures(ehl.solve(COLD, nodes=129, domain=(-15.0, 2.5)))
    films["fine"] = film_figures(ehl.solve(COLD, tolerance=0.003, spike=0.05))
    films["formulas"] = [
        ehl.dowson(COLD).central_thickness, ehl.dowson_toyoda_central(COLD), ehl.moes_central(COLD),
        ehl.pan_hamrock_central(COLD), ehl.pan_hamrock_minimum(COLD), ehl.dowson_higginson_minimum(COLD),
        ehl.nijenbanning_line_central(COLD), ehl.hertz_approach(COLD),
    ]  # fmt: skip
    return films


@case(quick=True)
def starved() -> dict[str, Any]:
    """Films with the meniscus or the layer of oil held, cold and heated."""
    films: dict[str, Any] = {}
    for name, half_widths in (("meniscus", 1.1), ("far meniscus", 3.0)):
        films[name] = film_figures(ehl.solve(COLD, tolerance=0.01, supply=meniscus(COLD, half_widths)))
        hot = ehl.solve_thermal(HOT, supply=meniscus(HOT, half_widths))
        films[f"{name}, heated"] = take(hot, f"{FILM} {HEAT}")
    for name, thickness in (("layer", 0.2e-6), ("thick layer", 20e-6)):
        layer = ehl.OilLayer(thickness)
        films[name] = film_figures(ehl.solve(COLD, tolerance=0.01, supply=layer))
        films[f"{name}, heated"] = take(ehl.solve_thermal(HOT, supply=layer), f"{FILM} {HEAT}")
    return films


@case(quick=True)
def heated() -> dict[str, Any]:
    """Heated films: slow and fast sliding, Newtonian and limited shear, bulk temperatures apart, load slopes."""
    solids = (ehl.Solid(46.0, 7850.0, 470.0), ehl.Solid(30.0, 7800.0, 460.0))
    newtonian = replace(OIL, eyring_stress=None)
    limited = replace(OIL, limiting_shear_ratio=0.06)
    films = {
        "eyring": ehl.solve_thermal(HOT),
        "rolling": ehl.solve_thermal(replace(HOT, sliding=0.0)),
        "apart": ehl.solve_thermal(HOT, solids, bulk_temperatures=(343.15, 363.15), tolerance=0.02),
        "newtonian": ehl.solve_thermal(replace(HOT, lubricant=newtonian)),
        "limited": ehl.solve_thermal(replace(HOT, lubricant=limited, sliding=3.0)),
        "nodes": ehl.solve_thermal(HOT, nodes=129),
    }
    figures: dict[str, Any] = {name: take(film, f"{FILM} {HEAT}") for name, film in films.items()}
    figures["slopes"] = film_figures(ehl.with_load_slopes(films["eyring"]))
    figures["flash"] = ehl.blok_flash_temperature(HOT, 0.05)
    curve = ehl.traction_curve(OIL, 1e9, 5.0, [0.0, 0.02, 0.1], radius=0.012, temperature=343.15)
    figures["traction"] = take(
        curve, "traction_coefficient central_thickness oil_temperature_rise traction_error"
    )
    return figures


@case(quick=True)
def rough() -> dict[str, Any]:
    """Mixed films, cold and heated, flooded and starved."""
    slow = replace(COLD, entrainment=0.05)
    figures = "asperity_share asperity_stiffness separation_slope film_ratio minimum_thickness central_thickness error"
    films: dict[str, Any] = {
        name: take(ehl.solve_mixed(contact, ROUGH, supply=supply), figures)
        for name, contact, supply in (
            ("slow", slow, None),
            ("fast", COLD, None),
            ("meniscus", slow, meniscus(slow, 1.2)),
            ("layer", slow, ehl.OilLayer(0.1e-6)),
        )
    }
    heated = ehl.solve_mixed_thermal(replace(HOT, entrainment=0.5, sliding=0.2), ROUGH)
    films["heated"] = take(heated, "asperity_share boundary_friction traction_coefficient film_ratio error")
    films["heated film"] = take(heated.film, f"{FILM} {HEAT}")
    return films


@case(quick=True)
def over_time() -> dict[str, Any]:
    """Loads that change, with steady and changing speed; held meniscus; response to small vibration."""
    unit = COLD.half_width / COLD.entrainment

    def load(t: float) -> float:
        return 1e5 * (1.0 + 0.3 * math.sin(0.5 * t / unit))

    time = np.linspace(0.0, 10.0, 21) * unit
    figures = "time load least central separation greatest_pressure pressure thickness lowest error balance"
    films = {
        "load": ehl.solve_transient(COLD, load, time, nodes=129),
        "speed": ehl.solve_transient(COLD, load, time, entrainment=lambda t: 1.0 + 0.02 * t / unit, nodes=65),
        "meniscus": ehl.solve_transient(COLD, load, time, nodes=65, supply=meniscus(COLD, 2.0)),
    }
    histories: dict[str, Any] = {name: take(film, figures) for name, film in films.items()}
    frequency = np.geomspace(1e2, 1e6, 13)
    for name, film in (
        ("flooded", ehl.solve(COLD)),
        ("starved", ehl.solve(COLD, supply=meniscus(COLD, 1.2))),
    ):
        answer = ehl.film_response(film, frequency)
        histories[f"response, {name}"] = take(
            answer, "compliance stiffness damping static_stiffness relative_error"
        )
    return histories


@case()
def along_a_path() -> dict[str, Any]:
    """Films one from another: loads and radii as along a path of contact; the table of stiffnesses."""
    contacts = [
        replace(COLD, load=1e5 * s, radius=0.01 * s, entrainment=0.8 + s) for s in (0.6, 0.8, 1.0, 1.2)
    ]
    films: dict[str, Any] = {
        f"{k}": film_figures(film) for k, film in enumerate(ehl.solve_path(contacts, tolerance=0.01))
    }
    rows = ehl.stiffness_table(ehl.solve(COLD), 0.04, bodies=4e8)
    return {**films, "table": [take(row, "definition stiffness error loss") for row in rows]}
