"""Which sections the wanted outputs need."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from base import Fault, shorten

BY_FINITE_ELEMENTS = {"vtk", "root-stress", "torques", "revolution"}
"""Wants that need the loaded contact by finite elements."""


def missing_sections(raw: Mapping[str, Any]) -> list[Fault]:
    """Faults for sections that the wants of `raw` need and that are not there.

    Works on the unchecked file, so that missing sections are listed beside faulty keys.
    """
    wants = raw.get("wants")
    listed = {w for w in wants if isinstance(w, str)} if isinstance(wants, list) else set()
    needed: dict[str, str] = {}

    def need(section: str, reason: str) -> None:
        needed.setdefault(section, reason)

    stiffness, film, dynamics = (_table(raw, n) for n in ("stiffness", "film", "dynamics"))
    given = stiffness.get("model") == "given"
    own_units = "mean_force" in dynamics
    if geared := listed & {"geometry", "closed-forms", "film", *BY_FINITE_ELEMENTS}:
        need("pair", f"wants = [{_quoted(geared)}]")
    moving = listed & {"sweep", "diagram"}
    if listed & {"stiffness", "fourier", *moving} and not given:
        need("pair", f"stiffness.model = {shorten(stiffness.get('model', 'fem'))}")
    if moving:
        need("dynamics", f"wants = [{_quoted(moving)}]")
        if not own_units:
            need("pair", "a [dynamics] in physical units")
            need("material", "a [dynamics] in physical units")
            need("operating", "a [dynamics] in physical units")
    if "film" in listed or (film and film.get("model", "auto") not in ("none", "auto")):
        need("lubricant", "the film" if "film" in listed else f"film.model = {shorten(film['model'])}")
    if "film" in raw and film.get("model", "auto") == "auto":
        if film.get("supply", "flooded") != "flooded":
            need("lubricant", f"film.supply = {shorten(film['supply'])}")
        if "roughness" in raw:
            need("lubricant", "[roughness]")
    if "pair" in needed and listed != {"geometry"}:
        need("material", f"wants = [{_quoted(listed)}]")
        need("operating", f"wants = [{_quoted(listed)}]")
    faults = [
        Fault(f"[{section}]", "", f"is required by {reason}", f"Add the section [{section}]")
        for section, reason in needed.items()
        if section not in raw
    ]
    return faults + _deeper(raw, listed, stiffness, film)


def _deeper(
    raw: Mapping[str, Any], listed: set[str], stiffness: Mapping[str, Any], film: Mapping[str, Any]
) -> list[Fault]:
    faults = []
    operating = _table(raw, "operating")
    chosen = "film" in raw and film.get("model", "auto") != "none"
    lubricated = "film" in listed or ("lubricant" in raw and chosen)
    if lubricated and "operating" in raw and "pinion_speed_rpm" not in operating:
        faults.append(
            Fault("operating.pinion_speed_rpm", "", "is required by the film", "Give the pinion's speed")
        )
    if "film" in listed and film.get("model") == "none":
        faults.append(Fault("film.model", "'none'", "excludes the wanted film", 'Take film.model = "ehl"'))
    faults += _without_film_solver(raw, film)
    faults += _by_finite_elements(raw, listed, stiffness)
    if "torques" in listed and "operating" in raw and not operating.get("torques_Nm"):
        remedy = "Give a list, such as torques_Nm = [100, 300, 600]"
        faults.append(Fault("operating.torques_Nm", "", "is required by the wanted torques", remedy))
    if "film" in listed and stiffness.get("model") == "given":
        allowed = "has no load share, which the wanted film needs"
        faults.append(
            Fault("stiffness.model", "'given'", allowed, 'Take "fem" or a closed form, or drop film')
        )
    dynamics = _table(raw, "dynamics")
    faults += [
        Fault(
            f"dynamics.{want}",
            "",
            f"is required by the wanted {want}",
            f"Add {want} = {{ speed_rpm = [500, 30000] }}",
        )
        for want in ("sweep", "diagram")
        if want in listed and "dynamics" in raw and want not in dynamics
    ]
    given = stiffness.get("model") == "given"
    moving = listed & {"sweep", "diagram"}
    if moving and given and "mean_force" not in dynamics and "mean_N_per_m" not in stiffness:
        faults.append(
            Fault(
                "stiffness.mean_N_per_m", "", "is required by a [dynamics] in physical units", "Give the mean"
            )
        )
    pair = _table(raw, "pair")
    if "centre_distance_mm" in pair and "backlash_um" in pair:
        faults.append(
            Fault(
                "pair.backlash_um",
                shorten(pair["backlash_um"]),
                "follows from centre_distance_mm",
                "Give one of them",
            )
        )
    return faults


def _without_film_solver(raw: Mapping[str, Any], film: Mapping[str, Any]) -> list[Fault]:
    """Faults of keys that only the film's solver knows."""
    faults = []
    if film.get("model") == "dowson" and "roughness" in raw:
        remedy = 'Take film.model = "ehl", or drop [roughness]'
        faults.append(Fault("film.model", "'dowson'", "knows no [roughness]", remedy))
    if film.get("grid") == "article" and "roughness" in raw:
        remedy = 'Take grid = "graded", or drop [roughness]'
        faults.append(Fault("film.grid", "'article'", "is of smooth flanks", remedy))
    oil = _table(raw, "lubricant")
    if film.get("model") == "dowson" and (
        oil.get("viscosity_law") == "constant" or oil.get("pressure_viscosity_per_GPa") == 0
    ):
        told = "does not know a viscosity that pressure leaves as it is"
        faults.append(Fault("film.model", "'dowson'", told, 'Take film.model = "ehl"'))
    return faults


def _by_finite_elements(
    raw: Mapping[str, Any], listed: set[str], stiffness: Mapping[str, Any]
) -> list[Fault]:
    """Faults of outputs and keys that only the coupled finite elements know."""
    asked = needs_of_finite_elements(raw, listed)
    if not asked:
        return []
    model, pairs = stiffness.get("model", "fem"), stiffness.get("pairs", "coupled")
    told = " and ".join(asked)
    if model not in ("fem", "auto"):
        remedy = "Closed forms and given stiffnesses do not know it; or drop it"
        return [Fault("stiffness.model", shorten(model), f'must be "fem" for {told}', remedy)]
    if pairs != "coupled":
        remedy = "Independent pairs have no common field, nor one contact; or drop it"
        return [Fault("stiffness.pairs", shorten(pairs), f'must be "coupled" for {told}', remedy)]
    return []


def needs_of_finite_elements(raw: Mapping[str, Any], listed: set[str]) -> list[str]:
    """Name the outputs and keys of a scene that only the coupled finite elements know."""
    operating, pair = _table(raw, "operating"), _table(raw, "pair")
    asked = [f"the wanted {want}" for want in sorted(listed & BY_FINITE_ELEMENTS)]
    asked += ["operating.friction"] if operating.get("friction") else []
    for gear in ("pinion", "wheel"):
        keys = _table(pair, gear)
        asked += [f"pair.{gear}.{key}" for key in ("tip_rounding_um", "deviations", "hub") if keys.get(key)]
    return asked


def _table(raw: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    section = raw.get(name)
    return section if isinstance(section, dict) else {}


def _quoted(words: set[str]) -> str:
    return ", ".join(f'"{w}"' for w in sorted(words))
