"""Rules between sections: what the wanted outputs need, and which models give them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import reduce
from typing import Any

from base import Fault, shorten
from flankfilm.scene.needs_of_helix import faults_of_helix
from flankfilm.scene.needs_of_shafts import faults_of_shafts
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.gears import GEARS, faults_of_leads
from flankfilm.scene.traits import given_keys, named
from flankfilm.scene.wants import BY_FINITE_ELEMENTS, FILMS, GEARED, MESHED, MOTIONS, RATED, UNLOADED, WANTS

__all__ = ["MOTIONS", "faults_between_sections", "needs_of_finite_elements"]

Raw = Mapping[str, Any]

IN_SPACE = "bearing-forces"
"""Want of gears that move and tilt in space."""


def faults_between_sections(raw: Raw) -> list[Fault]:
    """Faults for what the wants of `raw` need and is not there, or exclude and is there.

    Works on the unchecked file, so that missing sections are listed beside faulty keys.
    """
    wants = raw.get("wants")
    listed = {w for w in wants if isinstance(w, str)} if isinstance(wants, list) else set()
    needed: dict[str, str] = {}
    for section, reason in _needed_sections(raw, listed):
        needed.setdefault(section, reason)
    missing = [
        Fault(f"[{section}]", "", f"is required by {reason}", f"Add the section [{section}]")
        for section, reason in needed.items()
        if section not in raw
    ]
    return [
        *missing,
        *_missing_keys(raw, listed),
        *_models_that_do_not_fit(raw, listed),
        *faults_of_shafts(raw, listed),
        *_in_space(raw, listed),
        *faults_of_helix(raw, listed),
        *faults_of_leads(raw),
    ]


def needs_of_finite_elements(raw: Raw, listed: set[str]) -> list[str]:
    """Name the outputs and keys of a scene that only the coupled finite elements know."""
    asked = [f"the wanted {want}" for want in sorted(listed & BY_FINITE_ELEMENTS)]
    return asked + [
        named(path)
        for path, about, value in given_keys(raw, Scene)
        if about.traits.finite_elements and (value or "." not in path)  # a section counts by being there
    ]


def _needed_sections(raw: Raw, listed: set[str]) -> Iterator[tuple[str, str]]:
    """Sections that must be there, each with what needs it; the first reason counts."""
    stiffness, film = _table(raw, "stiffness"), _table(raw, "film")
    moving = listed & set(MOTIONS)
    physical = bool(moving) and "mean_force" not in _table(raw, "dynamics")
    geared = listed & GEARED
    meshed = listed & MESHED and stiffness.get("model") != "given"
    if IN_SPACE in listed:
        yield "bearings", f'wants = ["{IN_SPACE}"]'
    if geared:
        yield "pair", f"wants = [{_quoted(geared)}]"
    if meshed:
        yield "pair", f"stiffness.model = {shorten(stiffness.get('model', 'fem'))}"
    if moving:
        yield "dynamics", f"wants = [{_quoted(moving)}]"
    if physical:
        yield from ((name, "a [dynamics] in physical units") for name in ("pair", "material", "operating"))
    if (geared or meshed) and not listed <= UNLOADED:
        yield from ((name, f"wants = [{_quoted(listed)}]") for name in ("material", "operating"))
    if rated := listed & RATED:
        yield "rating", f"wants = [{_quoted(rated)}]"
    model = film.get("model", "auto")
    if moving and _table(raw, "dynamics").get("damping_ratio") == "film":
        yield "lubricant", "the damping of films"
    if listed & set(FILMS):
        yield "lubricant", "the film" if "film" in listed else "the wanted losses"
    elif film and model not in ("none", "auto"):
        yield "lubricant", f"film.model = {shorten(model)}"
    elif "film" in raw and model == "auto":
        if film.get("supply", "flooded") != "flooded":
            yield "lubricant", f"film.supply = {shorten(film['supply'])}"
        if "roughness" in raw:
            yield "lubricant", "[roughness]"


def _missing_keys(raw: Raw, listed: set[str]) -> Iterator[Fault]:
    """Keys of sections that are there, needed by the wants."""
    operating, dynamics, stiffness = (_table(raw, n) for n in ("operating", "dynamics", "stiffness"))
    chosen = "film" in raw and _table(raw, "film").get("model", "auto") != "none"
    damped = bool(listed & set(MOTIONS)) and dynamics.get("damping_ratio") == "film"
    lubricated = listed & set(FILMS) or damped or ("lubricant" in raw and chosen)
    if lubricated and "operating" in raw and "pinion_speed_rpm" not in operating:
        yield _required("operating.pinion_speed_rpm", "the film", "Give the pinion's speed")
    if (hot := _heated(raw, listed)) and "lubricant" in raw and not _known_temperature(raw):
        remedy = "Give the oil's temperature, or those of the gears in [heat]"
        yield _required("lubricant.temperature_C", hot, remedy)
    for want, traits in WANTS.items():
        if want in listed:
            for needed in traits.keys:
                if _lacks(raw, needed.path):
                    yield _required(needed.path, f"the wanted {want}", needed.remedy)
    without_mean = stiffness.get("model") == "given" and "mean_N_per_m" not in stiffness
    if listed & set(MOTIONS) and without_mean and "mean_force" not in dynamics:
        yield _required("stiffness.mean_N_per_m", "a [dynamics] in physical units", "Give the mean")


def _models_that_do_not_fit(raw: Raw, listed: set[str]) -> Iterator[Fault]:
    """Models that cannot give what is wanted, or do not know a key that is there."""
    film, stiffness, oil, pair = (_table(raw, n) for n in ("film", "stiffness", "lubricant", "pair"))
    solved = 'Take film.model = "ehl"'
    if "film" in listed and film.get("model") == "none":
        yield Fault("film.model", "'none'", "excludes the wanted film", solved)
    if film.get("model") == "dowson" and "roughness" in raw:
        yield Fault("film.model", "'dowson'", "knows no [roughness]", f"{solved}, or drop [roughness]")
    if film.get("grid") == "article" and "roughness" in raw:
        remedy = 'Take grid = "graded", or drop [roughness]'
        yield Fault("film.grid", "'article'", "requires smooth flanks", remedy)
    constant = oil.get("viscosity_law") == "constant" or oil.get("pressure_viscosity_per_GPa") == 0
    if film.get("model") == "dowson" and constant:
        allowed = "does not know a viscosity that pressure leaves as it is"
        yield Fault("film.model", "'dowson'", allowed, solved)
    for want in FILMS:
        if want in listed and stiffness.get("model") == "given":
            allowed = f"has no load share, which the wanted {want} needs"
            yield Fault("stiffness.model", "'given'", allowed, f'Take "fem" or a closed form, or drop {want}')
    if listed & set(MOTIONS) and _table(raw, "dynamics").get("damping_ratio") == "film":
        yield from _without_damping(raw)
    old = _table(raw, "dynamics").get("stiffness_reference")
    if old is not None and stiffness.get("reference", old) != old:
        allowed = f"must be that of stiffness.reference, {shorten(stiffness['reference'])}: a scene has one reference"
        yield Fault("dynamics.stiffness_reference", shorten(old), allowed, "Leave it out")
    if "centre_distance_mm" in pair and "backlash_um" in pair:
        value = shorten(pair["backlash_um"])
        yield Fault("pair.backlash_um", value, "follows from centre_distance_mm", "Give one of them")
    if asked := " and ".join(needs_of_finite_elements(raw, listed)):
        model, pairs = stiffness.get("model", "fem"), stiffness.get("pairs", "coupled")
        if model not in ("fem", "auto"):
            remedy = "Closed forms and given stiffnesses do not know it; or drop it"
            yield Fault("stiffness.model", shorten(model), f'must be "fem" for {asked}', remedy)
        elif pairs != "coupled":
            remedy = "Independent pairs have no common field, nor one contact; or drop it"
            yield Fault("stiffness.pairs", shorten(pairs), f'must be "coupled" for {asked}', remedy)


def _in_space(raw: Raw, listed: set[str]) -> Iterator[Fault]:
    """What gears that move and tilt in space cannot be: of a spur pair, or on shafts of a drive train."""
    if IN_SPACE not in listed:
        return
    pair = _table(raw, "pair")
    if pair and not pair.get("helix_angle_deg"):
        allowed = f"must be other than 0 for the wanted {IN_SPACE}, of lines of contact that cross the face"
        remedy = (
            'Give the angle, or take [shafts] and wants = ["sweep"], which give bearing forces of spur pairs'
        )
        yield Fault("pair.helix_angle_deg", "0", allowed, remedy)
    for name in ("pinion_torque_Nm", "power_kW"):
        value = _table(raw, "operating").get(name)
        if isinstance(value, int | float) and value < 0:
            allowed = f"must be above 0 for the wanted {IN_SPACE}: of a pinion that drives"
            remedy = "Take the other hand, helix_angle_deg of the other sign, and a value above 0"
            yield Fault(f"operating.{name}", f"{value:g}", allowed, remedy)
    if "shafts" in raw:
        allowed = f"must be left out for the wanted {IN_SPACE}: shafts are rigid there, on [bearings]"
        yield Fault("[shafts]", "", allowed, f"Leave it out, or drop {IN_SPACE}")
    if "mean_force" in _table(raw, "dynamics"):
        allowed = f"must be left out for the wanted {IN_SPACE}, which has no dimensionless form"
        yield Fault("dynamics.mean_force", "", allowed, "Give [dynamics] in physical units")


def _without_damping(raw: Raw) -> Iterator[Fault]:
    """Models whose films have no damping, where the motion is damped by them."""
    film = _table(raw, "film")
    number = "or give damping_ratio a number"
    if "mean_force" in _table(raw, "dynamics"):
        allowed = "is of a pair's films, which the dimensionless form does not have"
        yield Fault("dynamics.damping_ratio", "'film'", allowed, "Give a number")
    elif _table(raw, "stiffness").get("model") == "given":
        allowed = "has no load share, which the damping of films needs"
        yield Fault("stiffness.model", "'given'", allowed, f'Take "fem" or a closed form, {number}')
    if film.get("model") in ("none", "dowson"):
        allowed = "gives no films that answer an oscillation, which damping_ratio asks for"
        yield Fault("film.model", shorten(film["model"]), allowed, f'Take "ehl" or "auto", {number}')


def _heated(raw: Raw, listed: set[str]) -> str:
    """What asks for films with heat in any case; empty where nothing does."""
    for want, traits in WANTS.items():
        if traits.heat and want in listed:
            return f"the wanted {want}"
    return 'film.heat = "on"' if _table(raw, "film").get("heat") == "on" and "film" in listed else ""


def _known_temperature(raw: Raw) -> bool:
    """Whether the temperature of the flanks, or that of the oil, is known."""
    heat = _table(raw, "heat")
    return "temperature_C" in _table(raw, "lubricant") or any(f"{g}_temperature_C" in heat for g in GEARS)


def _lacks(raw: Raw, path: str) -> bool:
    """Whether a section that is there has not a key, or an empty list there."""
    *tables, key = path.split(".")
    return tables[0] in raw and reduce(_table, tables, raw).get(key) in (None, [])


def _required(key: str, by: str, remedy: str) -> Fault:
    return Fault(key, "", f"is required by {by}", remedy)


def _table(raw: Raw, name: str) -> Raw:
    section = raw.get(name)
    return section if isinstance(section, dict) else {}


def _quoted(words: set[str]) -> str:
    return ", ".join(f'"{w}"' for w in sorted(words))
