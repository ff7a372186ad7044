"""Numbers of docs/validation/losses.md: the article's pair, warmer gears, FZG type C, and friction beside Schlenk's.

Run from the root with ``PYTHONPATH=. python benchmarks/studies/mesh_losses.py article`` (or ``bulk``, ``share``,
``fzg``, ``cost``, ``friction``, ``rough``; the last two draw docs/images/mesh_friction.png and rough_friction.png).
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import flankfilm as ff
from base import RangeWarning, SolverError
from ehl import Lubricant, Roughness
from flankfilm.coupling import Flanks, LoadedTeeth, MeshLosses
from flankfilm.coupling.losses.mean_losses import Carried, means_of
from gears import BasicRack, Gear, GearPair, Material, TipRelief
from gears.closed_form import ohlendorf_loss_factor, schlenk_friction
from tests.validation.article import PAIR, TORQUE

IMAGES = Path(__file__).parents[2] / "docs" / "images"
IMAGE = IMAGES / "mesh_friction.png"
RPM = math.pi / 30.0
SPEED = 2000.0 * RPM
OIL = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, viscosity_slope=0.04, eyring_stress=5e6)
HELD = Flanks(beyond_path=False)
ROUGHNESS = 0.4e-6
RELIEF_LENGTHS = (2e-3, 3e-3, 4e-3, 5e-3)
FZG_TORQUES = (13.0, 61.0, 94.0, 135.0, 183.0, 239.0, 302.0)
ROUGH_TORQUES = (35.0, 61.0, 94.0, 135.0, 183.0, 239.0, 302.0)
RIG_SPEED = 1500.0 * RPM * 24 / 16  # of the pinion: 8.3 m/s at the pitch circle
RIG_OIL = replace(Lubricant.from_iso_vg(100, 363.15), eyring_stress=7e6)
SPEEDS = (250.0, 500.0, 1000.0, 2000.0, 3000.0, 4000.0, 6000.0)
TORQUES = (30.0, 60.0, 100.0, 150.0, 300.0, 600.0, 900.0)


def losses(stress: float, **options) -> MeshLosses:
    """The article's pair, its load held to the path, at an Eyring stress [Pa]."""
    return ff.mesh_losses(PAIR, TORQUE, SPEED, replace(OIL, eyring_stress=stress), flanks=HELD, **options)


def article() -> None:
    """Mean friction, losses and temperatures at both ends of the band."""
    for stress in (5e6, 10e6):
        found = losses(stress)
        path = found.path
        print(f"{1e-6 * stress:.0f} MPa: {found!r}")
        print(
            f"  mu {found.mean_friction:.4f}, sliding {found.sliding_loss:.0f} W, rolling {found.rolling_loss:.0f} W, "
            f"{100 * found.mesh_loss / found.input_power:.3f} %, H_V {found.loss_factor:.4f}, band "
            f"{found.band.mean_friction.round(4)} {found.band.mesh_loss.round(0)} within {found.band.error:.1e}"
        )
        middle = int(np.argmin(np.abs(path.rho1 - PAIR.points.C)))
        for name, at in (("A", 0), ("C", middle), ("E", -1)):
            print(
                f"  {name}: oil {path.oil_temperature_rise[at]:.1f} K, flanks "
                f"{path.surface_temperature_rise[:, at].round(1)} K, Blok {path.flash_temperature[at]:.1f} K, "
                f"least film {1e6 * path.minimum_thickness[at]:.3f} um, mu {path.friction_coefficient[at]:.4f}, "
                f"closure {100 * path.closure[at]:.1f} %"
            )


def bulk() -> None:
    """What warmer gears take of the least film, and what friction and losses do."""
    first = None
    for warmer in (0.0, 10.0, 20.0):
        found = losses(5e6, bulk_temperatures=(353.15 + warmer,) * 2, positions=10)
        first = first or found
        print(
            f"+{warmer:.0f} K: least film {1e6 * found.least_film:.3f} um "
            f"({100 * (found.least_film / first.least_film - 1):+.0f} %), mu {found.mean_friction:.4f}, "
            f"mesh loss {found.mesh_loss:.0f} W"
        )
    found = losses(5e6, heat_transfer=(10.0, 10.0), ambient_temperature=313.15, positions=10)
    print(
        f"10 W/K each from 40 degC: {found.bulk_temperatures - 273.15} degC, {found.heat} W, {found.rounds} rounds"
    )


def factor(teeth: LoadedTeeth, positions: int = 400) -> float:
    """Loss factor of a load share."""
    power = abs(teeth.torque)
    ends = np.array([0.0, teeth.pair.line_of_action])
    one = Carried(ends, np.ones(2), np.zeros(2), np.full(2, 0.5))
    return means_of(teeth.pair, teeth.cycle(positions), 1.0, power, one).loss_factor


def share() -> None:
    """Loss factor of the article's pair by every load share."""
    print(f"Ohlendorf {ohlendorf_loss_factor(PAIR):.4f}")
    meshed = LoadedTeeth(PAIR, TORQUE, flanks=HELD).meshed(1e-3)
    for name, flanks in (("held to the path", HELD), ("tip edges free", Flanks())):
        for friction in (0.0, 0.03):
            print(
                f"{name}, mu {friction}: {factor(replace(meshed, flanks=replace(flanks, friction=friction))):.4f}"
            )
    print(f"independent pairs: {factor(replace(meshed, pairs='independent')):.4f}")
    for model in ("ishikawa", "weber-banaschek", "potential-energy"):
        print(f"{model}: {factor(LoadedTeeth(PAIR, TORQUE, model)):.4f}")


def fzg_pair(relief: TipRelief | None) -> GearPair:
    """Type C of the FZG test rig, as in tests/validation/test_stplus_fzg_c.py, with the same relief on both gears."""
    module = 4.5e-3

    def gear(teeth: int, shift: float, cut: float, diameter: float) -> Gear:
        alteration = 0.5 * (diameter / module - teeth) - 1.0 - shift
        return Gear(teeth, shift, tip_alteration=alteration, generating_shift=cut, tip_relief=relief)

    return GearPair(
        gear(16, 0.1818, 0.1559, 82.45e-3),
        gear(24, 0.1714, 0.1454, 118.35e-3),
        module,
        14e-3,
        rack=BasicRack.of_tool(h_aP0=1.39, rho_aP0=0.25),
        material=Material(210e9, 0.3, 7850.0),
        centre_distance=91.5e-3,
    )


def fzg() -> None:
    """Loss factor of type C over torque and the length of a tip relief of 35 um."""
    print(f"Ohlendorf {ohlendorf_loss_factor(fzg_pair(None)):.4f}; torques {FZG_TORQUES} N m")
    for length in (None, *RELIEF_LENGTHS):
        pair = fzg_pair(None if length is None else TipRelief(35e-6, length))
        meshed = LoadedTeeth(pair, 100.0, flanks=HELD).meshed(1e-3)
        row = [f"{factor(replace(meshed, torque=torque)):.4f}" for torque in FZG_TORQUES]
        print("no relief" if length is None else f"{1e3 * length:.0f} mm", *row)


def cost() -> None:
    """Seconds of forty positions of the article's pair."""
    for _ in range(3):
        begun = time.process_time()
        found = losses(5e6)
        used = time.process_time() - begun
        print(f"{found.path.rho1.size} contacts, {found.cost.seconds:.2f} s, {used:.2f} s of processor time")


def point(torque: float, rpm: float) -> list[float]:
    """Mean friction at both ends of the band, smooth flanks; nan where a film has no solution."""
    try:
        found = ff.mesh_losses(PAIR, torque, rpm * RPM, OIL, flanks=HELD, positions=4, tolerance=0.02)
    except SolverError as fault:
        print(f"{torque:.0f} N m, {rpm:.0f} rpm: {fault}")
        return [math.nan, math.nan]
    return found.band.mean_friction.tolist()


def friction() -> None:
    """Draw friction over speed and over torque beside Schlenk's formula."""
    over_speed = [point(TORQUE, rpm) for rpm in SPEEDS]
    over_torque = [point(torque, 2000.0) for torque in TORQUES]
    formula = [
        [schlenk_friction(PAIR, TORQUE, rpm * RPM, OIL.viscosity, ROUGHNESS) for rpm in SPEEDS],
        [schlenk_friction(PAIR, torque, SPEED, OIL.viscosity, ROUGHNESS) for torque in TORQUES],
    ]
    for name, at, ours, theirs in zip(
        ("rpm", "N m"), (SPEEDS, TORQUES), (over_speed, over_torque), formula, strict=True
    ):
        for x, band, one in zip(at, ours, theirs, strict=True):
            print(f"{x:.0f} {name}: {band[0]:.4f} to {band[1]:.4f}, Schlenk {one:.4f}")
    draw((over_speed, over_torque), formula)


def rig_friction(torque: float, roughness: Roughness | None, **options) -> float:
    """Mean friction of type C of the FZG rig at 8.3 m/s and 90 degC, mineral oil ISO VG 100."""
    held = {"model": "potential-energy", "positions": 8, "tolerance": 0.02} | options
    return ff.mesh_losses(
        fzg_pair(None), torque, RIG_SPEED, RIG_OIL, roughness=roughness, **held
    ).mean_friction


def rough() -> None:
    """Draw friction of rough gears over torque beside Schlenk's formula, by the laws that share the load."""
    from flankfilm.figures.style import colours, sheet

    drawn = Roughness.from_drawing(mean=ROUGHNESS)
    flanks = {
        "film ratio (Zhou, Hoeprich)": drawn,
        "elastic asperities (Greenwood, Tripp)": replace(drawn, law="greenwood-tripp"),
        "smooth": None,
    }
    formula = [
        schlenk_friction(fzg_pair(None), torque, RIG_SPEED, RIG_OIL.viscosity, ROUGHNESS)
        for torque in ROUGH_TORQUES
    ]
    print("Schlenk", *(f"{one:.4f}" for one in formula))
    with sheet(None, 1, 1, height=3.2) as (figure, (axes,)):
        for colour, (name, roughness) in zip(colours(3), flanks.items(), strict=True):
            row = [rig_friction(torque, roughness) for torque in ROUGH_TORQUES]
            print(name, *(f"{one:.4f}" for one in row))
            axes.plot(ROUGH_TORQUES, row, color=colour, label=name)
        axes.plot(ROUGH_TORQUES, formula, color="black", linestyle="--", label="Schlenk, measured")
        axes.set(
            xlabel="torque of the pinion [N m]", ylabel="mean coefficient of friction [-]", ylim=(0.0, 0.07)
        )
    figure.savefig(IMAGES / "rough_friction.png", dpi=150)


def draw(ours: Sequence[list[list[float]]], theirs: list[list[float]]) -> None:
    """Write the picture."""
    from flankfilm.figures.style import colours, sheet

    with sheet(None, 1, 2, height=3.0, sharey=True) as (drawn, panels):
        for axes, x, band, formula, label in zip(
            panels,
            (SPEEDS, TORQUES),
            ours,
            theirs,
            ("pinion speed [rpm], 600 N m", "torque [N m], 2000 rpm"),
            strict=True,
        ):
            low, high = np.array(band).T
            axes.fill_between(
                x, low, high, color=colours(1)[0], alpha=0.3, label="films, 5 to 10 MPa, smooth"
            )
            axes.plot(x, formula, color=colours(2)[1], linestyle="--", label="Schlenk, Ra 0.4 µm, X_L = 1")
            axes.set(xlabel=label, ylim=(0.0, 0.09))
        panels[0].set_ylabel("mean coefficient of friction [-]")
    drawn.savefig(IMAGE, dpi=150)


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        {
            "article": article,
            "bulk": bulk,
            "share": share,
            "fzg": fzg,
            "cost": cost,
            "friction": friction,
            "rough": rough,
        }[sys.argv[1]]()
