"""Every remedy is applied as it is worded, and the fault is gone; bounds are accepted as they are printed.

What a case does to the scene is taken from the words of the fault, so that a remedy which asks for what no key may be,
or for a number that was rounded to the wrong side, fails here.
"""

from __future__ import annotations

import ast
import copy
import itertools
import math
import re
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import Fault, InputError
from flankfilm.building.preflight import refuse
from flankfilm.scene.reader import validated

BASE = {
    "wants": ["stiffness"],
    "pair": {
        "module_mm": 2.0,
        "face_width_mm": 40.0,
        "pinion": {"teeth": 36},
        "wheel": {"teeth": 40},
    },
    "material": {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3},
    "operating": {"pinion_torque_Nm": 600.0, "pinion_speed_rpm": 2000.0},
    "lubricant": {"viscosity_Pa_s": 0.075, "pressure_viscosity_per_GPa": 19.6},
}
NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
BOUND = re.compile(rf"(at most|at least|less than|more than|or more|to)(?: [a-z' ,]+)? {NUMBER}")


def changed(raw, changes):
    """A scene with some dotted keys given; None takes a key out."""
    raw = copy.deepcopy(raw)
    for key, value in changes.items():
        *above, last = key.split(".")
        table = raw
        for name in above:
            table = table.setdefault(name, {})
        if value is None:
            table.pop(last, None)
        else:
            table[last] = value
    return raw


def value_of(raw, key):
    for name in key.split("."):
        raw = raw.get(name) if isinstance(raw, dict) else None
    return raw


def faults(raw) -> list[Fault]:
    try:
        refuse(validated(raw))
    except InputError as error:
        return list(error.faults)
    return []


def same(fault, others):
    """Whether a fault is still there: of the same key, for the same reason, whatever its numbers."""
    words = [re.sub(NUMBER, "#", one.allowed) for one in (fault, *others)]
    return any(one.where == fault.where and w == words[0] for one, w in zip(others, words[1:], strict=True))


def cured(raw, fault, changes):
    assert not same(fault, faults(changed(raw, changes))), f"{fault}\nis still there with {changes}"


def bounds(fault):
    """Numbers that the fault says are allowed, moved inside by a hair where the bound itself is not."""
    text = fault.allowed.replace(" to ", " and at most ").replace("must be -", "must be at least -")
    text = re.sub(rf"must be {NUMBER}", r"must be at least \1", text)
    found = re.findall(rf"(at most|at least|less than|more than)(?: [a-z',]+)* {NUMBER}", text)
    for word, number in found:
        value, hair = float(number), 1e-7 * max(abs(float(number)), 1e-3)
        yield {"less than": value - hair, "more than": value + hair}.get(word, value)


TEETH = {"pair.pinion.profile_shift": (0.05, 1.5), "pair.wheel.profile_shift": (0.05, 1.5)}


def searched(raw, fault, key, values):
    """Some value in the direction that the remedy names cures the fault."""
    assert any(not same(fault, faults(changed(raw, {key: v}))) for v in values), f"{fault}\nno {key} helps"


def raised(raw, key, low=0.0):
    begin = value_of(raw, key)
    begin = low if begin is None else begin
    if key.endswith("teeth"):
        return [begin + step for step in (1, 2, 4, 8, 16, 32, 64, 128)]
    end = {"profile_shift": 1.5, "tip_alteration": 1.0}.get(key.rpartition(".")[2], 10 * begin + 100)
    return [begin + (end - begin) * share for share in (0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0)]


def apply_words(raw, fault):
    """Do what a fault of the geometry says; give the number of things that were done."""
    done = 0
    if value_of(raw, fault.where) is not None and not isinstance(value_of(raw, fault.where), dict):
        for number in bounds(fault):
            cured(raw, fault, {fault.where: number})
            done += 1
    gear_in_where = re.search(r"pair\.(pinion|wheel)", fault.where)
    for word, key, number in re.findall(rf"(lower|raise) ([\w.]+) by {NUMBER}", fault.remedy):
        full = f"pair.{key}"
        begin = value_of(raw, full) or 0.0
        cured(raw, fault, {full: begin + float(number) * (1 if word == "raise" else -1)})
        done += 1
    if found := re.search(rf"add {NUMBER} mm of thickness_allowance", fault.remedy):
        at = "pair.pinion.thickness_allowance_um"
        cured(raw, fault, {at: (value_of(raw, at) or 0.0) + 1e3 * float(found[1])})
        done += 1
    if "tight = true" in fault.remedy:
        done += 1
        assert not same(fault, faults(changed(raw, {"pair.tight": True})))
    for match in re.finditer(r"raise ((?:pinion|wheel)\.)?profile_shift", fault.remedy):
        gear = (match[1] or f"{gear_in_where[1]}.") if gear_in_where or match[1] else "pinion."
        key = f"pair.{gear}profile_shift"
        either = [*raised(raw, key)]
        more = [{key: v} for v in either] + [
            {f"pair.{gear}teeth": t} for t in raised(raw, f"pair.{gear}teeth")
        ]
        assert any(not same(fault, faults(changed(raw, one))) for one in more), f"{fault}\nnothing helps"
        done += 1
    if "raise a profile shift, or give centre_distance" in fault.remedy:
        searched(raw, fault, "pair.pinion.profile_shift", raised(raw, "pair.pinion.profile_shift"))
        cured(raw, fault, {"pair.centre_distance_mm": 76.0})
        done += 1
    if "lengthen the teeth by tip_alteration" in fault.remedy:
        both = [f"pair.{gear}.tip_alteration" for gear in ("pinion", "wheel")]
        longer = [dict.fromkeys(both, value) for value in raised(raw, both[0])]
        assert any(not same(fault, faults(changed(raw, one))) for one in longer), str(fault)
        done += 1
    for words, key in (("thin the tooth less", "thickness_allowance_um"), ("chamfer less", "tip_chamfer_mm")):
        if words in fault.remedy:
            cured(raw, fault, {f"{fault.where.rpartition('.')[0]}.{key}": 0.0})
            done += 1
    if "above the bore: give a smaller one" in fault.remedy:
        cured(raw, fault, {"pair.pinion.bore_mm": 0.5 * raw["pair"]["pinion"]["bore_mm"]})
        done += 1
    if "reduce profile_shift" in fault.remedy:
        key = f"{fault.where.rpartition('.')[0]}.profile_shift"
        begin = value_of(raw, key) or 0.0
        searched(
            raw, fault, key, [begin - step for step in (0.05, 0.2, 0.5, 1.0, 1.5) if begin - step >= -0.8]
        )
        done += 1
    return done


GEOMETRY = {
    "bore": {"pair.pinion.bore_mm": 70.0},
    "bore, thin rim": {"pair.wheel.bore_mm": 74.9},
    "pointed": {"pair.pinion.profile_shift": 1.4},
    "pointed by tip": {
        "pair.pinion.teeth": 12, "pair.pinion.profile_shift": 0.6, "pair.pinion.tip_alteration": 0.4
    },
    "thinned to a point": {"pair.pinion.thickness_allowance_um": 3000.0},
    "chamfer": {"pair.wheel.tip_chamfer_mm": 4.6},
    "no flank": {"pair.pinion.teeth": 5, "pair.pinion.profile_shift": -0.5},
    "axis": {
        "pair.pinion": {"teeth": 5, "profile_shift": -0.8}, "pair.rack": {"h_aP": 1.0, "h_fP": 1.8, "rho_fP": 0.1}
    },
    "involute cut away": {
        "pair.pinion.teeth": 8, "pair.pinion.profile_shift": -0.8, "pair.pinion.tip_alteration": -0.95
    },
    "neck": {"pair.pinion.teeth": 6, "pair.pinion.profile_shift": -0.8},
    "neck that no thinning made": {
        "pair.pinion": {"teeth": 5, "profile_shift": -0.6, "thickness_allowance_um": 500.0}
    },
    "neck by thinning undercut teeth": {
        "pair.pinion": {"teeth": 8, "profile_shift": -0.6, "thickness_allowance_um": 1500.0}
    },
    "neck by thinning": {"pair.pinion.teeth": 9, "pair.pinion.thickness_allowance_um": 2500.0},
    "no working angle": {
        "pair.pinion.profile_shift": -0.8, "pair.wheel.profile_shift": -0.8, "pair.wheel.teeth": 30
    },
    "contact ratio": {"pair.pinion.tip_alteration": -0.8, "pair.wheel.tip_alteration": -0.8},
    "no room for a rim": {
        "pair.pinion.bore_mm": 65.5, "pair.pinion.blank": {"rim_thickness_mm": 4.0, "web_thickness_mm": 12.0}
    },
    "relief too long": {"pair.pinion.tip_relief": {"amount_um": 20.0, "length_mm": 40.0}},
    "relief too deep": {"pair.pinion.tip_relief": {"amount_um": 1100.0, "length_mm": 2.0}},
    "rim": {"pair.pinion.blank": {"rim_thickness_mm": 0.2, "web_thickness_mm": 12.0}},
    "hub of the blank": {
        "pair.pinion.blank": {"rim_thickness_mm": 4.0, "web_thickness_mm": 12.0, "hub_mm": 66.9}
    },
    "web": {"pair.pinion.blank": {"rim_thickness_mm": 4.0, "web_thickness_mm": 41.0}},
    "web off the middle": {
        "pair.pinion.blank": {"rim_thickness_mm": 4.0, "web_thickness_mm": 12.0, "web_offset_mm": 1.0}
    },
    "jam": {"pair.centre_distance_mm": 75.9},
    "shifts that jam": {"pair.centre_distance_mm": 76.0, "pair.pinion.profile_shift": 0.2},
    "axes": {"pair.centre_distance_mm": 70.0},
    "interference": {"pair.pinion.teeth": 10, "pair.wheel.teeth": 80},
    "interference beyond tip_alteration": {
        "pair.pinion.teeth": 7, "pair.wheel.teeth": 100, "pair.wheel.tip_alteration": 0.3
    },
    "tip in the root circle": {"pair.centre_distance_mm": 76.0, "pair.wheel.tip_alteration": 0.3},
    "heat": {"pair.backlash_um": 20.0, "heat": {"pinion_temperature_C": 150.0}},
    "cold housing": {
        "pair.backlash_um": 20.0, "heat": {"pinion_temperature_C": 60.0, "housing_temperature_C": -60.0}
    },
    "hub outside": {"pair.pinion.hub": {"hub_mm": 70.0}},
    "hub inside": {"pair.pinion.bore_mm": 30.0, "pair.pinion.hub": {"hub_mm": 20.0}},
    "tip edge": {"pair.pinion.tip_rounding_um": 5000.0},
}  # fmt: skip


@pytest.mark.parametrize("name", GEOMETRY)
def test_remedies_of_geometry(name):
    raw = changed(BASE, GEOMETRY[name])
    found = faults(raw)
    assert found, "the case provokes no fault"
    assert sum(apply_words(raw, fault) for fault in found) > 0, [str(fault) for fault in found]


GEAR = st.fixed_dictionaries(
    {
        "teeth": st.integers(5, 40),
        "profile_shift": st.floats(-0.8, 1.5),
        "tip_alteration": st.one_of(st.just(0.0), st.floats(-1, 1)),
        "thickness_allowance_um": st.one_of(st.just(0.0), st.floats(0, 3000)),
        "bore_mm": st.one_of(st.just(5.0), st.floats(1, 60)),
        "tip_chamfer_mm": st.one_of(st.just(0.0), st.floats(0, 5)),
    }
)


SEVERAL = st.tuples(GEAR, GEAR, st.one_of(st.none(), st.floats(-1.0, 1.0)))


@settings(max_examples=20, deadline=None)
@given(SEVERAL)
def test_bounds_and_numbers_of_random_pairs_are_accepted_as_worded(drawn):
    judged(*drawn)


@pytest.mark.slow
@settings(max_examples=1500, deadline=None)
@given(SEVERAL)
def test_bounds_and_numbers_of_many_random_pairs(drawn):
    judged(*drawn)


def judged(pinion, wheel, apart):
    raw = changed(BASE, {"pair.pinion": pinion, "pair.wheel": wheel})
    if apart is not None:
        shifts = pinion["profile_shift"] + wheel["profile_shift"]
        distance = pinion["teeth"] + wheel["teeth"] + 2 * shifts + 2 * apart
        raw = changed(raw, {"pair.centre_distance_mm": max(distance, 1.0)})
    for fault in faults(raw):
        numbers = re.search(rf"by {NUMBER}|add {NUMBER} mm", fault.remedy)
        if numbers or value_of(raw, fault.where) is not None:
            apply_words(raw, replace_directions(fault))


def replace_directions(fault):
    """A fault with its numbers alone: which way to go is looked at in the table."""
    remedy = re.sub(r"raise (?:pinion\.|wheel\.)?profile_shift(?! by)|reduce profile_shift", "", fault.remedy)
    return Fault(fault.where, fault.value, fault.allowed, remedy)


TURNING = {"wants": ["fourier", "sweep"], "dynamics": {"sweep": {"speed_rpm": [500, 30000]}}}
OWN = {
    **dict.fromkeys(("pair", "material", "operating", "lubricant")),
    "wants": ["diagram"],
    "stiffness": {"model": "given", "amplitudes": [0.2]},
}
FORM = {"mean_force": 0.1, "error_amplitude": 0.2, "half_backlash": 0.2}
DAMPED = {"wants": ["sweep"], "dynamics": {"damping_ratio": "film", "sweep": {"speed_rpm": [500, 3000]}}}
CROWNED = {"pair.pinion.crowning_um": 10.0}
HELD = [{"position_mm": 0.0, "radial_N_per_m": 3e8, "axial_N_per_m": 1e8, "tilting_Nm_per_rad": 1e6}]
IN_SPACE = {
    "wants": ["bearing-forces"],
    "pair.helix_angle_deg": 20.0,
    "bearings": {"pinion": HELD, "wheel": HELD},
    "dynamics": {"damping_ratio": 0.05, "bearing_forces": {"speed_rpm": [500, 6000]}},
}
WORDED = [
    # what is changed, where the fault is, words with the numbers of the remedy, what they say
    ({**TURNING, "dynamics.sweep.speed_rpm": [0.01, 0.02]}, "dynamics.sweep.speed_rpm",
     rf"Begin at {NUMBER} rpm, and end above", lambda n: {"dynamics.sweep.speed_rpm": [float(n), 2 * float(n)]}),
    ({**TURNING, "dynamics.sweep.speed_rpm": [0.01, 3000]}, "dynamics.sweep.speed_rpm",
     rf"Begin at {NUMBER} rpm$", lambda n: {"dynamics.sweep.speed_rpm": [float(n), 3000]}),
    ({**OWN, "dynamics": {**FORM, "diagram": {"frequency": [1e-6, 0.5]}}}, "dynamics.diagram.frequency",
     rf"Begin at {NUMBER}$", lambda n: {"dynamics.diagram.frequency": [float(n), 0.5]}),
    ({**OWN, "dynamics": {**FORM, "mean_force": 0.0, "error_amplitude": 0.0, "diagram": {"frequency": [0.4, 0.5]}}},
     "dynamics.mean_force", rf"Give mean_force, {NUMBER} is usual", lambda n: {"dynamics.mean_force": float(n)}),
    ({**TURNING, "pair.centre_distance_mm": 75.95, "pair.tight": True}, "pair.centre_distance_mm",
     rf"Take pair.centre_distance_mm = {NUMBER} or more", lambda n: {"pair.centre_distance_mm": float(n)}),
    ({"wants": ["film"], "film": {"supply": "meniscus", "meniscus_mm": 0.01}}, "film.meniscus_mm",
     rf"move it out to {NUMBER} mm", lambda n: {"film.meniscus_mm": float(n)}),
    ({"wants": ["film"], "film": {"supply": "meniscus", "meniscus_mm": 0.01}}, "film.meniscus_mm",
     r"or give (meniscus_half_widths)", lambda n: {"film.meniscus_mm": None, f"film.{n}": 1.5}),
    ({"wants": ["film"], "film": {"model": "none"}}, "film.model", r'Take film.model = "(\w+)"',
     lambda n: {"film.model": n}),
    ({"wants": ["film"], "film": {"model": "dowson"}, "roughness": {"deviation_um": 0.4, "density_per_mm2": 1000.0,
      "tip_radius_um": 20.0}}, "film.model", r'Take film.model = "(\w+)"', lambda n: {"film.model": n}),
    ({"wants": ["film"], "film": {"model": "dowson"}, "lubricant.viscosity_law": "constant"}, "film.model",
     r'Take film.model = "(\w+)"', lambda n: {"film.model": n}),
    ({"wants": ["film"], "film": {"grid": "article"}, "roughness": {"deviation_um": 0.4, "density_per_mm2": 1000.0,
      "tip_radius_um": 20.0}}, "film.grid", r'Take grid = "(\w+)"', lambda n: {"film.grid": n}),
    ({"wants": ["film"], "stiffness": {"model": "given", "amplitudes": [0.2]}}, "stiffness.model",
     r'Take "(\w+)" or a closed form', lambda n: {"stiffness": {"model": n}}),
    ({"wants": ["vtk"], "stiffness": {"model": "ishikawa"}}, "stiffness.model", r'must be "(\w+)"',
     lambda n: {"stiffness.model": n}),
    ({"wants": ["vtk"], "stiffness": {"pairs": "independent"}}, "stiffness.pairs", r'must be "(\w+)"',
     lambda n: {"stiffness.pairs": n}),
    ({"pair.centre_distance_mm": 76.2, "pair.backlash_um": 50.0}, "pair.backlash_um", r"(Give one) of them",
     lambda n: {"pair.backlash_um": None}),
    ({"material": None}, "[material]", r"Add the section \[(\w+)\]", lambda n: {n: BASE[n]}),
    ({"wants": ["film"], "lubricant": None}, "[lubricant]", r"Add the section \[(\w+)\]", lambda n: {n: BASE[n]}),
    ({"wants": ["torques"]}, "operating.torques_Nm", r"such as (torques_Nm) = \[100, 300, 600\]",
     lambda n: {f"operating.{n}": [100, 300, 600]}),
    ({"wants": ["film"], "operating.pinion_speed_rpm": None}, "operating.pinion_speed_rpm", r"(Give) the pinion",
     lambda n: {"operating.pinion_speed_rpm": 2000.0}),
    ({"wants": ["sweep"], "dynamics": {"damping_ratio": 0.05}}, "dynamics.sweep",
     r"Add sweep = \{ (speed_rpm) = \[500, 30000\] \}", lambda n: {"dynamics.sweep": {n: [500, 30000]}}),
    ({"stiffness": {"model": "given"}}, "stiffness", r"Each over the mean, such as \[(0.18)\]",
     lambda n: {"stiffness.amplitudes": [float(n)]}),
    ({"tolerance": "2%%"}, "tolerance", rf"Such as {NUMBER}%", lambda n: {"tolerance": f"{n}%"}),
    ({"pair.pinion.deviations": {"single_pitch_um": [1.0, 2.0]}}, "pair.pinion.deviations.single_pitch_um",
     rf"one value for each of {NUMBER} teeth", lambda n: {"pair.pinion.deviations.single_pitch_um": [1.0] * int(n)}),
    ({"pair.modul_mm": 2.0}, "pair.modul_mm", r"Did you mean (module_mm)", lambda n: {"pair.modul_mm": None}),
    ({"wants": ["losses"]}, "lubricant.temperature_C", r"Give the oil's (temperature)",
     lambda n: {"lubricant.temperature_C": 80.0}),
    ({**OWN, "dynamics": {**FORM, "damping_ratio": "film", "sweep": {"frequency": [0.4, 0.5]}}},
     "dynamics.damping_ratio", r"Give a (number)", lambda n: {"dynamics.damping_ratio": 0.05}),
    ({**DAMPED, "stiffness": {"model": "given", "amplitudes": [0.2]}}, "stiffness.model",
     r'Take "(\w+)" or a closed form', lambda n: {"stiffness": {"model": n}}),
    ({**DAMPED, "film": {"model": "dowson"}}, "film.model", r'Take "(ehl)"', lambda n: {"film.model": n}),
    ({"alignment": {"in_plane_um": 20.0, "cells": 33}}, "alignment.cells", rf"Take {NUMBER}",
     lambda n: {"alignment.cells": int(n)}),
    ({"pair.pinion.end_relief_um": 8.0}, "pair.pinion.end_relief_length_mm", r"(Give its length)",
     lambda n: {"pair.pinion.end_relief_length_mm": 5.0}),
    ({"pair.wheel.end_relief_um": 8.0, "pair.wheel.end_relief_length_mm": 25.0}, "pair.wheel.end_relief_length_mm",
     rf"must be at most {NUMBER} mm", lambda n: {"pair.wheel.end_relief_length_mm": float(n)}),
    ({"pair.pinion.face_width_mm": 43.0, "pair.pinion.face_offset_mm": 2.0}, "pair.pinion.face_width_mm",
     rf"must be at least {NUMBER} mm", lambda n: {"pair.pinion.face_width_mm": float(n)}),
    ({"pair.pinion.face_width_mm": 45.0, "pair.wheel.face_width_mm": 46.0}, "pair.face_width_mm",
     rf"must be {NUMBER} mm", lambda n: {"pair.face_width_mm": float(n)}),
    ({**CROWNED, "stiffness": {"model": "ishikawa"}}, "stiffness.model", r'must be "(\w+)" for pair.pinion.crowning_um',
     lambda n: {"stiffness.model": n}),
    ({**CROWNED, "wants": ["film"], "film": {"supply": "meniscus", "meniscus_half_widths": 1.5}},
     "film.meniscus_half_widths", r"Give (meniscus_mm) instead",
     lambda n: {"film": {"supply": "meniscus", n: 0.8}}),
    ({**CROWNED, "wants": ["film"], "film": {"supply": "meniscus", "meniscus_half_widths": 1.5}},
     "film.meniscus_half_widths", r"or drop pair.pinion.(crowning_um)", lambda n: {f"pair.pinion.{n}": None}),
    ({**CROWNED, "wants": ["film"], "film": {"model": "ehl", "stiffness": "tangent"}}, "film.stiffness",
     r"(Leave it out)", lambda n: {"film.stiffness": None}),
    ({**CROWNED, **DAMPED}, "dynamics.damping_ratio", r"Give a (number), or drop pair.pinion.crowning_um",
     lambda n: {"dynamics.damping_ratio": 0.05}),
    ({**CROWNED, **DAMPED}, "dynamics.damping_ratio", r"Give a (number)",
     lambda n: {"dynamics.damping_ratio": 0.05}),
    ({"alignment": {}, "stiffness.plane": "stress"}, "stiffness.plane", r'Take stiffness.plane = "(strain)"',
     lambda n: {"stiffness.plane": n}),
    ({"stiffness.reference": "bore", "dynamics.stiffness_reference": "teeth"}, "dynamics.stiffness_reference",
     r"(Leave it out)", lambda n: {"dynamics.stiffness_reference": None}),
    ({**IN_SPACE, "pair.helix_angle_deg": 0.0}, "pair.helix_angle_deg", r"(Give the angle)",
     lambda n: {"pair.helix_angle_deg": 20.0}),
    ({**IN_SPACE, "operating.pinion_torque_Nm": -600.0}, "operating.pinion_torque_Nm", r"a value (above 0)",
     lambda n: {"operating.pinion_torque_Nm": 600.0}),
    ({**IN_SPACE, "shafts": {}}, "[shafts]", r"(Leave it out)", lambda n: {"shafts": None}),
    ({**IN_SPACE, "dynamics.mean_force": 0.1}, "dynamics.mean_force", r"(physical units)",
     lambda n: {"dynamics.mean_force": None}),
    ({"lubricant.viscosity_index": 95.0}, "lubricant", r"(not both ways at once)",
     lambda n: {"lubricant.viscosity_index": None}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "where", "words", "edit"), WORDED, ids=[f"{at} {one[1]}" for at, one in enumerate(WORDED)]
)
def test_remedies_between_keys(changes, where, words, edit):
    raw = changed(BASE, changes)
    fault = next((one for one in faults(raw) if one.where == where), None)
    assert fault is not None, [str(one) for one in faults(raw)]
    said = re.search(words, str(fault))
    assert said, str(fault)
    after = changed(raw, edit(said[1]))
    assert not [str(one) for one in faults(after) if one.where == where]


def numbers_of(model, path=""):
    """Keys of a scene that are bounded numbers, with their bounds."""
    from typing import get_origin

    from flankfilm.scene.explain import model_in
    from flankfilm.scene.sections.key import key_of

    for name, field in model.model_fields.items():
        inner, about = model_in(field.annotation), key_of(field)
        if inner is not None and get_origin(field.annotation) is tuple:
            continue  # tables in a list: tests/flankfilm/test_shafts_keys.py
        if inner is not None and name not in ("file", "teeth"):
            yield from numbers_of(inner, f"{path}{name}.")
        elif about.bounds is not None and "tuple" not in str(field.annotation):
            yield f"{path}{name}", about.bounds


def bounded_keys():
    from flankfilm.scene import Scene

    return [(key, limit) for key, limit in numbers_of(Scene) if not key.startswith("pair.wheel")]


@pytest.mark.parametrize(
    ("key", "limit"), bounded_keys(), ids=lambda one: one if isinstance(one, str) else ""
)
def test_bounds_of_keys_are_accepted_as_they_are_printed(key, limit):
    """A value outside is refused with its bounds, and the printed bound itself, or a hair inside, is not."""
    ends = [end for end in (limit.low, limit.high) if math.isfinite(end)]
    for end, side in itertools.zip_longest(ends, (-1, 1) if len(ends) == 2 else (-1,)):
        outside = end + side * max(1.0, abs(end))
        raw = changed(BASE, {key: int(outside) if limit.whole else float(outside)})
        fault = next((one for one in faults(raw) if one.where == key), None)
        assert fault is not None, (key, outside)
        for number in bounds(fault):
            cured(raw, fault, {key: int(number) if limit.whole else number})


ROOMS = (
    "gears/pair/mesh_checks.py",
    "gears/tooth/blank.py",
    "gears/pair/thermal_expansion.py",
    "flankfilm/building/preflight.py",
    "flankfilm/building/face.py",
    "flankfilm/building/followed_speeds.py",
    "flankfilm/scene/needs.py",
)
MAKERS = {"add", "Fault", "at"}
ROOT = Path(__file__).parents[2]


def places():
    """Every place of these rooms where a fault is made, by its file and first line."""
    for room in ROOMS:
        for node in ast.walk(ast.parse((ROOT / room).read_text(encoding="utf-8"))):
            name = (
                getattr(node.func, "attr", getattr(node.func, "id", "")) if isinstance(node, ast.Call) else ""
            )
            if name in MAKERS and len(node.args) >= 3:
                yield room, range(node.lineno, node.end_lineno + 1)


def test_every_fault_of_these_rooms_is_provoked_above(monkeypatch):
    made = set()

    def noted(self, *arguments, **keywords):
        frame = sys._getframe(1)
        while frame is not None:
            made.add((frame.f_code.co_filename, frame.f_lineno))
            frame = frame.f_back
        begin(self, *arguments, **keywords)

    begin = Fault.__init__
    monkeypatch.setattr(Fault, "__init__", noted)
    for changes in (*GEOMETRY.values(), *(case[0] for case in WORDED)):
        faults(changed(BASE, changes))
    missing = [
        f"{room}:{lines[0]}"
        for room, lines in places()
        if not any((str(ROOT / room), line) in made for line in lines)
    ]
    assert not missing, "\n".join(missing)
