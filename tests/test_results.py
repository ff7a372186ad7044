"""Every public record describes each of its fields where it stands, and shows itself in one short line."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import re
import warnings

import numpy as np
import pytest

import dynamics
import ehl
import fem
import flankfilm
import gears
import meshes
from base import RangeWarning
from base.results import meaning_of
from tests.validation.article import FORCE, OIL, PAIR, PITCH, TORQUE
from tests.validation.article_motion import lubricated

PACKAGES = (
    "base",
    "gears",
    "gears.closed_form",
    "ehl",
    "fem",
    "meshes",
    "dynamics",
    "dynamics.inverse",
    "flankfilm",
    "flankfilm.coupling",
)
CLASSES = {
    value
    for package in map(importlib.import_module, PACKAGES)
    for name in package.__all__
    if inspect.isclass(value := getattr(package, name)) and dataclasses.is_dataclass(value)
}


def written(cls: type) -> set[str]:
    """Names that the docstrings of a class and of those it stands on list as attributes or parameters."""
    docs = [inspect.cleandoc(base.__doc__ or "") for base in cls.__mro__]
    listed = [names for doc in docs for names in re.findall(r"^(\w+(?:, \w+)*) ?: ", doc, re.MULTILINE)]
    return {name for names in listed for name in names.split(", ")}


@pytest.mark.parametrize("cls", sorted(CLASSES, key=str), ids=lambda cls: f"{cls.__module__}.{cls.__name__}")
def test_each_field_is_described(cls: type):
    fields = [field for field in dataclasses.fields(cls) if not field.name.startswith("_")]
    known = written(cls)
    assert [field.name for field in fields if not meaning_of(field) and field.name not in known] == []


@pytest.mark.parametrize("cls", sorted(CLASSES, key=str), ids=lambda cls: f"{cls.__module__}.{cls.__name__}")
def test_each_property_is_described(cls: type):
    properties = [(name, value) for name, value in vars(cls).items() if hasattr(value, "__get__")]
    public = [(name, value) for name, value in properties if not name.startswith("_")]
    assert [name for name, value in public if not inspect.getdoc(value)] == []


# ---------------------------------------------------------------- one line


def oscillator() -> dynamics.GearOscillator:
    return lubricated(0.64)


def orbit() -> dynamics.Orbit:
    return dynamics.find_orbit(oscillator(), (0.35, 0.0))


def film() -> ehl.Film:
    return ehl.solve(PITCH, tolerance=0.05)


def cycle() -> fem.MeshCycle:
    return fem.mesh_cycle(PAIR, TORQUE, 8, fem.compliance(PAIR, tolerance=0.05))


RESULTS = {
    "pair": lambda: PAIR,
    "gear": lambda: PAIR.pinion,
    "profile": lambda: PAIR.teeth_profiles[0],
    "path of contact": lambda: PAIR.path_of_contact(n=99),
    "meshing": lambda: gears.check_meshing(PAIR, positions=3),
    "Ishikawa": lambda: gears.closed_form.ishikawa(PAIR, PAIR.path_of_contact(n=99)),
    "potential energy": lambda: gears.closed_form.potential_energy(PAIR, PAIR.path_of_contact(n=99)),
    "Weber-Banaschek": lambda: gears.closed_form.weber_banaschek(PAIR, PAIR.path_of_contact(n=99), FORCE),
    "ISO 6336-1": lambda: gears.closed_form.iso6336(PAIR, FORCE),
    "ISO 6336-2": lambda: gears.closed_form.iso6336_2(PAIR, FORCE),
    "ISO 6336-3": lambda: gears.closed_form.iso6336_3(PAIR, FORCE),
    "oil": lambda: OIL,
    "film": film,
    "film by formula": lambda: ehl.dowson(PITCH),
    "film stiffness": lambda: ehl.stiffness_table(film(), 0.04, 5e8)[0],
    "sector": lambda: meshes.mesh_sector(PAIR.teeth_profiles[0]),
    "compliance": lambda: fem.compliance(PAIR, tolerance=0.05),
    "mesh cycle": cycle,
    "orbit": orbit,
    "orbits": lambda: dynamics.find_orbits(oscillator(), (1,)),
    "branch": lambda: dynamics.continue_branch(orbit(), "frequency", (0.62, 0.67)),
    "sweep": lambda: dynamics.sweep(oscillator(), "frequency", np.array([0.62, 0.64]), "up"),
    "exponents": lambda: dynamics.lyapunov_exponents(oscillator(), periods=200),
    "basins": lambda: dynamics.basins(oscillator(), (-1.0, 1.0, 4), (-1.0, 1.0, 4)),
    "lubricated cycle": lambda: flankfilm.lubricated_cycle(
        PAIR, TORQUE, speed=209.4, lubricant=OIL, tolerance=0.05
    ),
}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_shows_itself_in_one_line_that_one_can_read(name: str):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        line = repr(RESULTS[name]())
    assert len(line) <= 200, line
    assert "\n" not in line
    assert not line.startswith("<"), line
