"""Lubricated cycles, films along the path, losses, motion of a pair and of its drive train."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import ehl
import fem
import flankfilm as ff
import gears

from .case import Cases, public, take
from .cases_fem import CURVES, FIGURES
from .pairs import COLD_OIL, OIL, PAIR, RELIEVED, SHAFTS, SMALL, SPEED, TORQUE

case = Cases("coupling")
CYCLE = CURVES.replace(" half_width hertz_pressure", "")
WHOLE = FIGURES.replace("error errors", "mean_error range_error")
ALONG = (
    "rho1 load central_thickness minimum_thickness hertz_pressure stiffness inlet oil_layer starvation film_ratio "
    "asperity_share error converged message"
)
LOSSES = (
    "input_power mean_friction sliding_loss rolling_loss edge_loss loss_factor ohlendorf_loss_factor efficiency "
    "bulk_temperatures band boundary least_film greatest_contact_temperature error converged message"
)


def cycle_figures(cycle: Any, more: str = "") -> dict[str, Any]:
    """Curves and figures of a mesh cycle of any model."""
    return take(cycle, f"{CYCLE} {WHOLE} {more}")


@cache
def article() -> Any:
    """Bodies of the pair of several cases."""
    return fem.compliance(PAIR, tolerance=0.005)


@case(quick=True)
def models() -> dict[str, Any]:
    """Mesh cycles and single pairs by every model, pairs coupled and independent."""
    by_model: dict[str, Any] = {}
    rho1 = PAIR.path_of_contact(n=21).rho1
    for model in ("fem", "ishikawa", "weber-banaschek", "potential-energy"):
        bodies = {"compliance": article()} if model == "fem" else {}
        for pairs in ("coupled", "independent"):
            cycle = ff.mesh_cycle(PAIR, TORQUE, positions=24, model=model, pairs=pairs, **bodies)
            by_model[f"{model}, {pairs}"] = cycle_figures(cycle)
        by_model[f"{model}, one pair"] = ff.single_pair_stiffness(PAIR, 17736.3, rho1, model, article())
    return by_model


LUBRICATED = "least_film thinnest_film stiffness_change secant_stiffness_change mismatch rounds"


def lubricated_figures(**options: Any) -> dict[str, Any]:
    """A cycle with films, the cycle without and the films themselves."""
    bodies = {} if "model" in options else {"compliance": article()}
    cycle = ff.lubricated_cycle(PAIR, TORQUE, SPEED, COLD_OIL, tolerance=0.02, **options, **bodies)
    dry, film = cycle_figures(cycle.dry), take(cycle.film, ALONG)
    return {**cycle_figures(cycle, LUBRICATED), "dry": dry, "film": film}


@case(quick=True)
def lubricated() -> dict[str, Any]:
    """Cycles with flooded films: solved and by formula, coupled and independent."""
    model = public("flankfilm.FilmModel")
    return {
        "solved": lubricated_figures(),
        "tangent": lubricated_figures(film=model("ehl", "tangent")),
        "formula": lubricated_figures(film=model("dowson")),
        "independent": lubricated_figures(model="ishikawa", pairs="independent"),
    }


@case()
def lubricated_starved() -> dict[str, Any]:
    """Cycles with a layer of oil, a meniscus and rough flanks; a relieved pair."""
    model = public("flankfilm.FilmModel")
    placed = public("flankfilm.PlacedMeniscus", "flankfilm.coupling.PlacedMeniscus")
    relieved = ff.lubricated_cycle(RELIEVED, 200.0, SPEED, COLD_OIL, tolerance=0.02)
    return {
        "layer": lubricated_figures(film=model(supply=ehl.OilLayer(0.15e-6))),
        "meniscus": lubricated_figures(film=model(supply=placed(1.2))),
        "rough": lubricated_figures(film=model(roughness=ehl.Roughness.from_drawing(mean=0.4e-6))),
        "relieved": cycle_figures(relieved, LUBRICATED),
    }


@case()
def lubricated_over_the_face() -> dict[str, Any]:
    """A film under every cell."""
    flanks = public("flankfilm.Flanks", "flankfilm.coupling.Flanks")
    askew = flanks(alignment=gears.Alignment(10e-6), cells=6)
    cycle = ff.lubricated_cycle(SMALL, 100.0, SPEED, COLD_OIL, tolerance=0.02, flanks=askew)
    return {"cycle": cycle_figures(cycle, "least_film thinnest_film")}


@case()
def film_along_path() -> dict[str, Any]:
    """Films along the path of contact."""
    bodies = article()
    film = ff.film_along_path(PAIR, TORQUE, SPEED, COLD_OIL, tolerance=0.01, compliance=bodies)
    slow = ff.film_along_path(
        PAIR, 100.0, 0.1 * SPEED, COLD_OIL, tolerance=0.02, compliance=bodies,
        film=public("flankfilm.FilmModel")(roughness=ehl.Roughness.from_drawing(mean=0.4e-6)),
    )  # fmt: skip
    return {"smooth": take(film, ALONG), "rough": take(slow, ALONG)}


@case()
def losses() -> dict[str, Any]:
    """Losses with given bulk temperatures and with those that follow, smooth and rough."""
    bodies = fem.compliance(PAIR, tolerance=0.005)
    free = ff.mesh_losses(
        PAIR, TORQUE, SPEED, OIL, tolerance=0.02, compliance=bodies,
        heat_transfer=(20.0, 20.0), ambient_temperature=343.15,
    )  # fmt: skip
    rough = ff.mesh_losses(
        PAIR, 300.0, 0.2 * SPEED, OIL, tolerance=0.02, roughness=ehl.Roughness.from_drawing(mean=0.4e-6),
        compliance=bodies,
    )  # fmt: skip
    closed_form = ff.mesh_losses(PAIR, TORQUE, SPEED, OIL, tolerance=0.02, model="potential-energy")
    return {
        name: take(loss, LOSSES)
        for name, loss in (("free", free), ("rough", rough), ("closed form", closed_form))
    }


@case(quick=True)
def motion() -> dict[str, Any]:
    """Oscillator of a pair: scales, sweep, run-up, spectrum, jumps."""
    cycle = ff.mesh_cycle(PAIR, 300.0, positions=40, compliance=article())
    pair = ff.pair_oscillator(PAIR.with_backlash(50e-6), cycle, 300.0, SPEED, error_amplitude=(4e-6, 1e-6))
    sweep = ff.speed_sweep(pair, np.linspace(400.0, 2400.0, 40), portraits=(1200.0,))
    run_up = ff.speed_run_up(pair, (400.0, 2400.0), periods=1500)
    spectrum = ff.mesh_spectrum(pair)
    figures = (
        "natural_frequency mean_stiffness mean_force half_backlash equivalent_mass frequency error_amplitude"
    )
    return {
        "oscillator": take(pair, figures),
        "series": take(pair.oscillator.stiffness, "mean amplitudes phases"),
        "sweep": take(sweep, "frequency states labels grazings force_factor separated spread sampling_error"),
        "run-up": take(run_up, "frequency peak force_factor force_rms separated order rms_error peak_error"),
        "spectrum": take(spectrum, "order displacement force"),
    }


@case()
def jumps_and_map() -> dict[str, Any]:
    """Speeds of jumps, and forces over speed and torque."""

    def at(torque: float) -> Any:
        cycle = ff.mesh_cycle(PAIR, torque, positions=40, compliance=article())
        return ff.pair_oscillator(PAIR.with_backlash(50e-6), cycle, torque, SPEED, error_amplitude=6e-6)

    jumps = ff.jump_speeds(at(300.0), (600.0, 2000.0), searches=3, max_period=2)
    forces = ff.dynamic_map(at, (200.0, 400.0), np.linspace(500.0, 2000.0, 12))
    return {
        "jumps": take(
            jumps, "jump_frequency jump_speed jump_error force_factor force_frequency stable separated"
        ),
        "map": take(forces, "speed torque factor factor_up factor_down separated resonance iso"),
    }


@case()
def drive() -> dict[str, Any]:
    """Drive train of a pair: modes, sweep, run-up."""
    build = public("flankfilm.pair_drive", "flankfilm.coupling.pair_drive")
    cycle = ff.mesh_cycle(SMALL, 60.0, positions=40, model="potential-energy")
    train = build(SMALL, cycle, 60.0, SPEED, shafts=SHAFTS, end_inertias=(0.01, 0.05), error_amplitude=3e-6)
    sweep = public("flankfilm.drive_sweep", "flankfilm.coupling.drive_sweep")(
        train, np.linspace(200.0, 1500.0, 16)
    )
    run_up = ff.speed_run_up(train, (200.0, 1500.0), periods=600)
    bearings = "bearing_force bearing_force_swing shaft_torque shaft_torque_swing"
    return {
        "drive": take(
            train,
            "natural_frequencies mode_shapes mesh_share lowest_frequency mesh_frequency resonance_speeds mean_force",
        ),
        "oscillator": take(train.oscillator, "mass damping stiffness direction mean_force"),
        "sweep": take(
            sweep, f"frequency force_factor separated force_peak force_peak_error labels {bearings}"
        ),
        "run-up": take(run_up, f"frequency peak force_factor force_rms {bearings}"),
    }


@case()
def errors_of_manufacture() -> dict[str, Any]:
    """Series of unloaded errors, of a curve, of relief and of a revolution; closed forms against finite elements."""
    angle = 2 * np.pi * np.arange(64) / 64
    deviations = (
        gears.GearDeviations(pitch=gears.PitchDeviations(tuple(1e-6 * np.cos(0.5 * np.arange(36.0))))),
        None,
    )
    figures = "amplitude phase range remainder all_amplitudes error"
    curves = "label single_stiffness secant_stiffness transmission_error figures error left_out"
    comparison = ff.compare_closed_forms(PAIR, TORQUE, 0.01, article())
    return {
        "curve": take(ff.error_series(5e-6 * np.sin(angle) + 1e-6 * np.cos(3 * angle), order=4), figures),
        "relief": take(ff.unloaded_error(RELIEVED, positions=256, order=4), figures),
        "revolution": take(ff.revolution_error(PAIR, deviations, order=3), figures),
        "verify": {
            "differences": comparison.differences,
            **{
                f"{k}": take(curve, curves)
                for k, curve in enumerate((*comparison.references, *comparison.models))
            },
        },
    }
