"""For every variable: its error, the variable that holds its errors, or why it has none; and whether it converged.

A record's own figures bring their errors along (`flankfilm.output.variables`); here stands what they do not say of
themselves. A variable that no rule knows has no attribute, which a test over all examples finds.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

T = TypeVar("T")

STAGES: Mapping[str, str] = {
    "single_pair": "closed forms",
    "dry": "dry cycle",
    "reference": "references",
    "torque": "torques",
    "revolution": "revolution",
    "other": "other cycles",
    **dict.fromkeys(("lubricated", "film", "held"), "film"),
    **dict.fromkeys(("root", "fillet", "iso6336_3"), "root stress"),
    "iso6336_2": "closed forms",
    "oscillator": "scaling",
    "fourier": "fourier",
    **dict.fromkeys(("sweep", "portrait"), "sweep"),
    **dict.fromkeys(("diagram", "special", "jump", "missed", "stable", "force"), "diagram"),
    "field": "fields",
}
"""Stage that the variables of each prefix are of; those of the geometry alone are of none."""

GIVEN = "exact: it follows from the scene and the geometry"
CLOSED = "unknown: a closed form, until flankfilm verify compares it with finite elements"
NEIGHBOURS = "not estimated; the amplitudes have fourier_harmonic_error"
FORMULA = "unknown: Dowson's formula"
STANDARD = "unknown: a standard's formula"
ITSELF = "it is an error, or the measure of one, itself"
SHARED = "not estimated in single positions; the mean stiffness and the greatest share have errors"
OTHERS = "unknown: closed forms, or pairs without a common body; other_mean_error and other_range_error are numerical"
LONGER = "not estimated: of the longer series that the truncation of jumps is measured with"
HERTZ = "not estimated: Hertz's law of the contact's force, whose error is not known in single positions"

REPLACED: Mapping[str, str] = {
    r"reference_iso_mesh_stiffness": STANDARD,
    r"fourier_(remainder|order)": ITSELF,
    r"sweep_half_backlash": "not estimated: the backlash over the length scale, which follows from the mean stiffness",
    r"film_(hertz_pressure|greatest_pressure)": HERTZ,
    r"revolution_torque|torque": GIVEN,
}
"""Variables of which the error of their record is none, and why."""

NOTES: Mapping[str, str] = {
    r".*_(error|mismatch|remainder)|jump_error_by_\w+|sweep_(force|spread)_change_\w+": ITSELF,
    r"(pair|dimensions|heat|outline|path|flank_pinion|flank_wheel)_.*|field_(point|triangles|centre|reach)": GIVEN,
    r"single_pair_(travel|rho1)|.*_(rounds|order|friction|bore_inertia|pair_offset|edge|tooth|branch|stable)": GIVEN,
    r"revolution_(force|flank_rho|gaps|loaded_position|back_gap)": GIVEN,
    r"portrait_of_\w+|.*_unloaded_transmission_error|(root|fillet)_\w+_(travel|arc|instant)": GIVEN,
    r"fillet_(pinion|wheel)_tangent|.*_specific_sliding|.*_sliding": GIVEN,
    r"single_pair_contact_\w+": STANDARD,
    r"single_pair_.*": CLOSED,
    r"other_.*": OTHERS,
    r"(dry|lubricated|held|revolution)_(forces|load_share|pair_stiffness|.*_force|wheel_torque|efficiency)": SHARED,
    r"(dry|revolution)_(hertz_pressure|half_width)|film_profile_\w+_half_width|film_load": HERTZ,
    r"(dry|lubricated|held)_event_position": "not estimated",
    r"reference_deflection_\w+": "not estimated in parts; the whole has the error of reference_mean_secant_stiffness",
    r"torque_harmonic_1": "not estimated over torque; dry_secant_stiffness_harmonics_error is that of the scene's own",
    r"held_thinnest_film": "not estimated with one of the two held; lubricated_thinnest_film has one",
    r"(lubricated|held)_least_film": "not estimated in single positions; lubricated_thinnest_film has one",
    r"(lubricated|held)_(secant_)?stiffness_change": "not estimated: the difference of two means that have errors",
    r"film_(?!profile)\w+": "not estimated; the films themselves have the error of film_central_thickness",
    r"film_profile_\w+": "not estimated in single places; the central and the least film have one",
    r"root_\w+_tangent": "not estimated: where the stress is greatest it is flat",
    r"iso6336_[23]_\w+": STANDARD,
    r"oscillator_(force|error_amplitude|backlash|inertias|equivalent_mass)": GIVEN,
    r"oscillator_\w+": "unknown: it follows from the mean stiffness, whose error is not known",
    r"sweep_separated_\w+": "not estimated: crossings between samples of a period are taken as straight",
    r"sweep_(force_factor|spread)_\w+": "unknown",
    r"fourier_(phase|harmonics|other_\w+)": NEIGHBOURS,
    r"sweep_checked|diagram_longer_order": GIVEN,
    r"sweep_(force|spread)_change\w*": ITSELF,
    r"sweep_(separated|force_factor|spread)\w*": "not estimated; sweep_force_change is what a longer series changes",
    r"missed_\w+": "unknown: a jump of the longer series alone",
    r"sweep_grazings": "rounding of the exact flow, for the stiffness as given",
    r"(special|diagram|stable|force)_\w+": "rounding of the exact flow; those of the stiffness stand with the jumps",
    r"(jump_longer|missed)_(frequency|speed|width)": LONGER,
    r"jump_(from_|to_)?(displacement|velocity)": "rounding of the exact flow",
    r"field_von_mises": "not estimated; cells next to a contact are marked indicative in the files for ParaView",
}
"""Variables without an error, and why; the first pattern that fits counts."""

PARTNERS: tuple[tuple[str, str], ...] = (
    (r"(\w+_(?:stiffness|transmission_error)_harmonics)", r"\1_error"),
    (r"torque_transmission_error_harmonic_\d+", "torque_harmonics_error"),
    (r"reference_mean_(?:secant_)?stiffness", "reference_mean_error"),
    (r"other_mean_secant_stiffness", "other_mean_error"),
    (r"other_transmission_error_range", "other_range_error"),
    (r"fourier_amplitude", "fourier_harmonic_error"),
    (r"jump_(?:frequency|speed)", "jump_error"),
    (r"sweep_grazings", "sweep_grazing_error"),
    (r"diagram_greatest_force", "diagram_greatest_force_error"),
)
"""Variables whose errors stand in another one."""

SAME: tuple[tuple[str, str], ...] = (
    (r"(\w+)_dense_(\w+)", r"\1_\2"),
    (r"fourier_samples", "dry_secant_stiffness"),
)
"""Variables with the error of another one."""


def _of(stage: str) -> Callable[[Mapping[str, Any]], float | None]:
    return lambda values: getattr(values.get(stage), "error", None)


def _mean_of_series(values: Mapping[str, Any]) -> float | None:
    series = values["fourier"]
    return None if series.cycle is None else series.cycle.mean_error


OWN: Mapping[str, Callable[[Mapping[str, Any]], float | None]] = {
    r"(root|fillet)_(pinion|wheel)_(tension|compression|(loaded|other)_side\w*)": _of("root stress"),
    r"sweep_(up|down)|portrait_(displacement|velocity|section)": _of("sweep"),
    r"single_pair_stiffness_finite_elements": _of("closed forms"),
    r"fourier_mean": _mean_of_series,
}
"""Variables with the error of a stage's result."""


def explain(data: xr.Dataset, values: Mapping[str, Any]) -> xr.Dataset:
    """Give every variable ``error``, ``error_variable`` or ``error_note``, and ``converged`` where a solver found it.

    Parameters
    ----------
    data : xarray.Dataset
        All variables of a run.
    values : mapping
        Stage name to result.
    """
    for name in map(str, data.variables):
        about = data[name].attrs
        for attribute, said in _said(data, name, values).items():
            about[attribute] = said
            if attribute != "error":
                about.pop("error", None)
        about |= _converged(name, values)
    return data


def _said(data: xr.Dataset, name: str, values: Mapping[str, Any]) -> dict[str, float | str]:
    """What is to be said of a variable's error; nothing where its record said it, or no rule knows it."""
    if data[name].attrs["units"] == "":
        return {"error_note": "a name"}
    if why := _first(REPLACED, name) or _given_or_formula(name, values):
        return {"error_note": why}
    if (found := _first(OWN, name)) is not None:
        error = found(values)
        known = error is not None and np.isfinite(error)
        return {"error": float(error)} if error is not None and known else {"error_note": "unknown"}
    for pattern, partner in PARTNERS:
        if (match := re.fullmatch(pattern, name)) is not None and match.expand(partner) in data.variables:
            return {"error_variable": match.expand(partner)}
    for pattern, other in SAME:
        if (match := re.fullmatch(pattern, name)) is not None:
            same = (
                data[match.expand(other)].attrs.get("error")
                if match.expand(other) in data.variables
                else None
            )
            return {"error_note": "unknown"} if same is None else {"error": same}
    if "error" in data[name].attrs:
        return {}
    if name in data.coords:
        return {"error_note": "a place"}
    if (note := _first(NOTES, name)) is not None:
        return {"error_note": note}
    return {"error_note": CLOSED} if _by_closed_form(name, values) else {}


def _given_or_formula(name: str, values: Mapping[str, Any]) -> str:
    """Why a figure of a given series, or of a film by formula, has no error; empty for all others."""
    series, film = values.get("fourier"), values.get("film")
    if name.startswith("fourier_") and series is not None and series.cycle is None:
        return GIVEN
    if re.match(r"film_|(lubricated|held)_(thinnest|least)_film", name) and film is not None:
        return FORMULA if film.film.error is None else ""
    return ""


def _by_closed_form(name: str, values: Mapping[str, Any]) -> bool:
    """Whether a figure is of a mesh cycle by closed forms, or a series of one."""
    cycle = values.get("dry cycle")
    return (
        bool(re.match(r"(dry|lubricated|held|fourier)_", name)) and cycle is not None and cycle.error is None
    )


def _converged(name: str, values: Mapping[str, Any]) -> dict[str, int | str]:
    """Whether the solver believes a variable, and what it says where not."""
    prefix = next((one for one in STAGES if f"{name}_".startswith(f"{one}_")), None)
    found = None if prefix is None else values.get(STAGES[prefix])
    every = found if isinstance(found, tuple) else (found,)
    if any(getattr(one, "converged", None) is None for one in every):
        return {}
    message = "; ".join(one.message for one in every if not one.converged)
    return {"converged": int(not message), **({"message": message} if message else {})}


def _first(rules: Mapping[str, T], name: str) -> T | None:
    return next((said for pattern, said in rules.items() if re.fullmatch(pattern, name)), None)
