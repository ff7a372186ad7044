"""Units of all figures: coherent SI where they are declared, and values that scale with the units of what is given.

A result whose inputs are told in other units of length, mass and time must follow with all its figures, each by the
dimension that it declares. What has constants in pascals and pascal seconds (oils) leaves one such change: length
and mass by one factor.
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

import ehl
import fem
import flankfilm as ff
import gears
from base.results import ITSELF, figures, quantities, why_no_error
from base.units import factor
from flankfilm import coupling
from gears import Alignment, Bearing, Gear, GearPair, Heat, Material, Shaft, ShaftSegment, closed_form

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")
UNITS = {
    "1": (0, 0, 0, 0), "rad": (0, 0, 0, 0), "m": (1, 0, 0, 0), "kg": (0, 1, 0, 0), "s": (0, 0, 1, 0),
    "K": (0, 0, 0, 1), "Hz": (0, 0, -1, 0), "N": (1, 1, -2, 0), "Pa": (-1, 1, -2, 0), "W": (2, 1, -3, 0),
    "J": (2, 1, -2, 0), "%": (0, 0, 0, 0), "deg": (0, 0, 0, 0), "rpm": (0, 0, -1, 0), "h": (0, 0, 1, 0),
    "mm": (1, 0, 0, 0), "um": (1, 0, 0, 0), "kW": (2, 1, -3, 0), "MPa": (-1, 1, -2, 0), "GPa": (-1, 1, -2, 0),
}  # fmt: skip
"""Powers of length, mass, time and temperature."""
SI = {"1", "rad", "m", "kg", "s", "K", "Hz", "N", "Pa", "W", "J"}
OF_STANDARDS = {"N/(mm um)", "mm2/s"}
"""Units of ISO 6336-1 and ISO 3448, in which their closed forms are read."""
OWN_UNITS = {
    "gears.closed_form.face_load.Iso6336FaceLoad",
    "gears.closed_form.tooth_stiffness.Iso6336Stiffness",
    "ehl.oil.oil_grades.GradedOil",
}


def parts(unit: str) -> Iterator[tuple[str, float]]:
    """Units and their powers: ``N s/m2``, ``W/(m K)``, ``Pa^0.5``."""
    for side, sign in zip(unit.replace("(", "").replace(")", "").split("/"), (1.0, -1.0), strict=False):
        for one in side.split():
            found = re.fullmatch(r"([A-Za-z%]+|1)(?:\^?([\d.]+))?", one)
            assert found is not None, unit
            yield found[1], sign * float(found[2] or 1.0)


def dimension(unit: str) -> tuple[float, ...]:
    """Powers of length, mass, time and temperature of a unit."""
    return tuple(sum(power * UNITS[one][k] for one, power in parts(unit)) for k in range(4))


@cache
def records() -> dict[str, type]:
    """All classes of the packages that have figures."""
    found = {}
    for top in PACKAGES:
        package = importlib.import_module(top)
        for module in pkgutil.walk_packages(package.__path__, f"{top}."):
            if "__main__" in module.name or "peer_scripts" in module.name:
                continue
            for name, one in vars(importlib.import_module(module.name)).items():
                if inspect.isclass(one) and dataclasses.is_dataclass(one) and one.__module__ == module.name:
                    found[f"{module.name}.{name}"] = one
    return {name: one for name, one in found.items() if figures(one)}


def test_every_figure_is_declared_in_coherent_units_of_si():
    """And the unit that people read it in has the same dimension, and a factor."""
    assert len(records()) > 100
    for name, one in records().items():
        for figure, about in figures(one).items():
            where = f"{name}.{figure} [{about.unit}, {about.shown}]"
            assert about.meaning, where
            assert len(about.dims) <= 4, where
            if about.unit == "" or (about.unit in OF_STANDARDS and name in OWN_UNITS):
                continue
            assert {unit for unit, _ in parts(about.unit)} <= SI, where
            if about.shown:
                assert dimension(about.shown) == dimension(about.unit), where
                assert factor(about.shown) > 0.0, where


# ---------------------------------------------------------------- values in other units


@dataclasses.dataclass(frozen=True)
class Units:
    """By what the numbers of length, mass and time grow."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def __call__(self, value: Any, unit: str) -> Any:
        powers = dimension(unit)
        return value * self.length ** powers[0] * self.mass ** powers[1] * self.time ** powers[2]


OURS = Units()
OTHERS = Units(2.0, 1.5, 0.5)
OTHERS_FOR_OIL = Units(2.0, 2.0, 1.0)


def pair_in(u: Units, backlash: float = 50e-6) -> GearPair:
    steel = Material(u(206e9, "Pa"), 0.3, u(7850.0, "kg/m3"))
    first, second = (Gear(teeth=z, bore_radius=u(r, "m")) for z, r in ((20, 0.008), (30, 0.01)))
    pair = GearPair(first, second, module=u(2e-3, "m"), face_width=u(20e-3, "m"), material=steel)
    return pair.with_backlash(u(backlash, "m"))


def oil_in(u: Units) -> ehl.Lubricant:
    return ehl.Lubricant(
        u(0.05, "Pa s"), u(19e-9, "1/Pa"), u(870.0, "kg/m3"), temperature=353.15, eyring_stress=u(5e6, "Pa"),
        conductivity=u(0.14, "W/(m K)"), heat_capacity=u(2000.0, "J/(kg K)"),
    )  # fmt: skip


def contact_in(u: Units) -> ehl.LineContact:
    return ehl.LineContact(
        u(2e5, "N/m"), u(3.0, "m/s"), u(6e-3, "m"), u(2.26e11, "Pa"), oil_in(u), sliding=u(1.0, "m/s")
    )


def body_in(u: Units) -> ehl.Solid:
    return ehl.Solid(u(46.0, "W/(m K)"), u(7850.0, "kg/m3"), u(470.0, "J/(kg K)"))


def shaft_in(u: Units) -> Shaft:
    bearings = [Bearing(u(at, "m"), u(4e8, "N/m")) for at in (0.02, 0.18)]
    steel = (u(206e9, "Pa"), 0.3, u(7850.0, "kg/m3"))
    return Shaft(
        (ShaftSegment(u(0.2, "m"), u(0.04, "m")),),
        tuple(bearings),
        u(0.1, "m"),
        0.0,
        material=Material(*steel),
    )


def geometry(u: Units) -> list[object]:
    pair = pair_in(u)
    warm = gears.warm_pair(pair, Heat(343.15, 333.15, 313.15))
    path, force = pair.path_of_contact(n=9), u(5000.0, "N")
    closed = [closed_form.ishikawa(pair, path), closed_form.potential_energy(pair, path)]
    closed.append(closed_form.weber_banaschek(pair, path, force))
    sizes = gears.dimensions(pair, (u(3.5e-3, "m"),) * 2)
    return [pair, path, gears.check_meshing(pair), warm, sizes, closed_form.iso6336_3(pair, force), *closed]


def dry_mesh(u: Units) -> list[object]:
    pair, torque = pair_in(u), u(100.0, "N m")
    bodies = fem.compliance(pair, tolerance=0.05)
    slope = Alignment(u(10e-6, "m"))
    cycle = fem.mesh_cycle(pair, torque, 8, bodies)
    face = fem.mesh_cycle(pair, torque, 4, bodies, alignment=slope, cells=8, face_model="walls")
    return [bodies, cycle, face, fem.root_stress(pair, cycle, tolerance=0.05)]


def coupled(u: Units) -> list[object]:
    """Lubricated and moving meshes by a closed form: what is special to them does not ask how the teeth yield."""
    pair, torque, speed = pair_in(u), u(100.0, "N m"), u(300.0, "rad/s")
    cycle = coupling.mesh_cycle(pair, torque, model="potential-energy", positions=8)
    series = coupling.mesh_series(cycle, order=2)
    error = {"error_amplitude": u(4e-6, "m")}
    moving = coupling.pair_oscillator(pair, series, torque, speed, **error)
    travel = coupling.LoadTravel([u(2e-4, "m"), u(1e-5j, "m")], u(1e-6, "m"))
    shafts = shaft_in(u), shaft_in(u)
    train = coupling.pair_drive(pair, series, torque, speed, shafts=shafts, travel=travel, **error)
    speeds = np.linspace(0.9, 1.1, 3) * speed
    return [
        cycle,
        series,
        coupling.mesh_table(pair, cycle),
        moving,
        coupling.speed_sweep(moving, speeds),
        train,
        coupling.drive_sweep(train, speeds[:2]),
        ff.speed_run_up(moving, (speed, 1.05 * speed), periods=64),
    ]


def lubricated(u: Units) -> list[object]:
    pair, torque, speed, oil = pair_in(u, 200e-6), u(100.0, "N m"), u(300.0, "rad/s"), oil_in(u)
    teeth = {"model": "potential-energy", "positions": 4}
    dry = coupling.mesh_cycle(pair, torque, **teeth)
    return [
        coupling.lubricated_cycle(pair, torque, speed, oil, tolerance=0.02, model="potential-energy"),
        coupling.film_damping(dry, pair, torque, speed, oil, tolerance=0.02),
        coupling.mesh_losses(
            pair, torque, speed, oil, solids=(body_in(u), body_in(u)), tolerance=0.05,
            heat_transfer=(u(8.0, "W/K"), u(9.0, "W/K")), ambient_temperature=333.15, **teeth,
        ),
    ]  # fmt: skip


def films(u: Units) -> list[object]:
    contact, oil = contact_in(u), oil_in(u)
    film = ehl.solve(contact, nodes=129)
    heated = ehl.solve_thermal(contact, (body_in(u), body_in(u)), nodes=129)
    answer = ehl.film_response(film, [0.0, u(1e4, "Hz")])
    rough = ehl.Roughness(u(0.3e-6, "m"), u(3.3e9, "1/m2"), u(4e-5, "m"))
    mixed = ehl.solve_mixed_thermal(contact, rough, (body_in(u), body_in(u)), tolerance=0.02)
    return [
        contact,
        oil,
        film,
        heated,
        answer,
        mixed,
        ehl.dowson(contact),
        *ehl.stiffness_table(film, u(0.02, "m"), u(4e8, "N/m")),
    ]


@pytest.mark.parametrize(
    ("made", "others"),
    [
        (geometry, OTHERS),
        (dry_mesh, OTHERS),
        (coupled, OTHERS),
        (films, OTHERS_FOR_OIL),
        (lubricated, OTHERS_FOR_OIL),
    ],
    ids=lambda one: getattr(one, "__name__", ""),
)
@pytest.mark.filterwarnings("ignore")
def test_values_follow_the_units_of_what_is_given(made: Callable[[Units], list[object]], others: Units):
    for ours, theirs in zip(made(OURS), made(others), strict=True):
        compare(ours, theirs, others, type(ours).__name__)


def compare(ours: Any, theirs: Any, units: Units, where: str) -> None:
    if dataclasses.is_dataclass(ours) and not isinstance(ours, type) and figures(type(ours)):
        known, other = quantities(ours), quantities(theirs)
        assert known.keys() == other.keys(), where
        for name, one in known.items():
            value, unit = other[name].value, one.figure.unit
            if name == "dense_stiffness" or why_no_error(type(ours), name) == ITSELF:
                continue  # one of its places is at a jump
            if unit in ("", "1", "rad") or np.asarray(value).dtype.kind not in "fc":
                continue
            wanted = units(np.asarray(one.value), unit)
            size = float(np.nanmax(np.abs(wanted), initial=0.0))
            told = f"{where}.{name} [{unit}]"
            assert np.ndim(value) == len(one.figure.dims), told
            np.testing.assert_allclose(value, wanted, rtol=1e-4, atol=1e-5 * size, err_msg=told)
        for field in dataclasses.fields(ours):
            compare(getattr(ours, field.name), getattr(theirs, field.name), units, f"{where}.{field.name}")
