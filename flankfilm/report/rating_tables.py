"""Tables of a rating: load factors beside our own, factors of the strengths, deviations, scuffing, spectrum."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.report.page import Table
from flankfilm.report.text import number, percent
from flankfilm.scene.sections.key import ZERO_CELSIUS

if TYPE_CHECKING:
    from flankfilm.coupling import OwnContact, OwnRating
    from gears.rating import Rating, SpectrumRating

GIVEN = "given"

Row = tuple[str, ...]


def factor(value: float) -> str:
    """Factor with a digit more than ratings print."""
    return f"{value:.4f}"


def load_factors(rating: Rating, own: OwnRating | None) -> Table:
    """Load factors by ISO 6336-1 with their sources, and our own with their errors and why they differ."""
    factors, lead = rating.factors, rating.misalignment
    face = GIVEN if lead is None else "ISO 6336-1, method C"
    rows: list[Row] = [
        ("application factor K_A", factor(factors.K_A), GIVEN, "", "", ""),
        ("dynamic factor K_v", factor(factors.K_v), "ISO 6336-1, method B", *_of_motion(own)),
        ("face-load factor K_Hbeta", factor(factors.K_Hbeta), face, *_of_face(own)),
        ("face-load factor K_Fbeta", factor(factors.K_Fbeta), "K_Hbeta^N_F", "", "", ""),
        (
            "transverse load factor K_Halpha",
            factor(factors.K_Halpha),
            "ISO 6336-1, method B",
            *_of_share(own),
        ),
        ("transverse load factor K_Falpha", factor(factors.K_Falpha), "ISO 6336-1, method B", "", "", ""),
        (
            "K_Hbeta K_Halpha",
            factor(factors.K_Hbeta * factors.K_Halpha),
            "product",
            *_of_both(own),
        ),
    ]
    heads = ("load factor", "ISO 6336", "source", "our own", "its numerical error", "how ours is found")
    return Table(heads, tuple(rows)).filled


Ours = tuple[str, str, str]
"""Our own factor, its error, and how it is found or why there is none."""


def _of_motion(own: OwnRating | None) -> Ours:
    if own is None or own.motion is None:
        return "", "", "" if own is None else "none: no wanted motion"
    motion = own.motion
    pitch = f"f_pb = {number(1e6 * motion.deviation, 3)} µm"
    by = (
        "in the loaded contact"
        if motion.by_contact
        else "of unloaded teeth in the excitation: an upper estimate"
    )
    how = f"settled motion at the speed with {pitch} {by}; {motion.even:.4f} without"
    return factor(motion.K_v), f"± {percent(motion.error)}", how


def _of_face(own: OwnRating | None) -> Ours:
    if own is None or own.loaded is None:
        return "", "", "" if own is None else "none: no wanted mesh cycle"
    loaded = own.loaded
    if loaded.K_Hbeta is None:
        return "", "", f"none: {loaded.no_face}"
    how = "loaded contact at the nominal torque: alignment, leads and shafts of the scene, no tolerances"
    return factor(loaded.K_Hbeta), f"± {percent(loaded.error)}", how


def _of_share(own: OwnRating | None) -> Ours:
    if own is None or own.loaded is None:
        return "", "", "" if own is None else "none: no wanted mesh cycle"
    loaded = own.loaded
    if loaded.K_Halpha is None:
        return "", "", f"none: {loaded.no_share}"
    how = "largest share of a pair of teeth over the mesh cycle, whose contacts may reach beyond A to E"
    if (worst := loaded.worst_share) is not None:
        side = "too short" if worst.early else "too long"
        pitch, place = number(1e6 * loaded.deviation, 3), number(1e3 * worst.place, 2)
        most = f"a pair carries {number(worst.ratio, 3)} times its share {place} mm after A"
        how = f"square of the maximum pressure with f_pb = {pitch} µm over that without; {most}, pinion's pitch {side}"
    return factor(loaded.K_Halpha), f"± {percent(loaded.share_error)}", how


def _of_both(own: OwnRating | None) -> Ours:
    if own is None or own.loaded is None or own.loaded.K_H is None:
        return "", "", ""
    how = "product of those of ours that there are, and of the standard's"
    if own.loaded.helical:
        how = "maximum line load on all lines of contact over the mean one, at the nominal torque"
        if own.loaded.K_H_unequal is not None:
            how += f"; {factor(own.loaded.K_H_unequal)} with f_pb at a corner of the face, in no safety"
    return factor(own.K_H), f"± {percent(own.K_H_error)}", how


def strength_factors(rating: Rating) -> Table:
    """Factors of the permissible stresses of both gears with their sources."""
    pitting, bending = rating.pitting, rating.bending
    rows: list[Row] = [
        ("lubricant factor Z_L", *_same(pitting.Z_L), "ISO 6336-2, method B"),
        ("velocity factor Z_V", *_same(pitting.Z_V), "ISO 6336-2, method B"),
        ("roughness factor Z_R", *_same(pitting.Z_R), "ISO 6336-2, method B"),
        ("life factor Z_NT", *map(factor, pitting.Z_NT), "ISO 6336-2, table 2"),
        ("work hardening factor Z_W", *map(factor, pitting.Z_W), GIVEN),
        ("size factor Z_X", *_same(pitting.Z_X), GIVEN),
    ]
    if bending is not None:
        rows += [
            ("stress correction factor Y_ST", *_same(2.0), "ISO 6336-3"),
            ("life factor Y_NT", *map(factor, bending.Y_NT), "ISO 6336-3, table 1"),
            (
                "relative notch sensitivity factor Y_drelT",
                *map(factor, bending.Y_drelT),
                "ISO 6336-3, method B",
            ),
            ("relative surface factor Y_RrelT", *map(factor, bending.Y_RrelT), "ISO 6336-3, method B"),
            ("size factor Y_X", *map(factor, bending.Y_X), "ISO 6336-3"),
        ]
    rows.append(("load cycles N_L", *(f"{cycles:.3e}" for cycles in pitting.cycles), "life and speed"))
    return Table(("factor of the strengths", "pinion", "wheel", "source"), tuple(rows))


def _same(value: float) -> tuple[str, str]:
    """One factor of both gears."""
    return factor(value), factor(value)


def deviations(rating: Rating) -> Table:
    """Tolerances of the grade, and what running in leaves of them."""
    grade, effective, lead = rating.tolerances, rating.factors.effective, rating.misalignment
    rows: list[Row] = [
        (f"{name} {symbol}", *(number(1e6 * value, 3) for value in getattr(grade, symbol)))
        for name, symbol in (
            ("single pitch deviation", "f_pt"),
            ("base pitch deviation", "f_pb"),
            ("profile form deviation", "f_falpha"),
            ("helix slope deviation", "f_Hbeta"),
        )
    ]
    of_pair = [
        ("base pitch deviation after running in", effective.f_pb_eff),
        ("profile form deviation after running in", effective.f_falpha_eff),
        ("tip relief C_a", rating.relief),
    ]
    if lead is not None:
        of_pair += [
            ("misalignment by the pinion's shaft f_sh", lead.f_sh),
            ("misalignment by the teeth f_ma", lead.f_ma),
            ("effective misalignment F_by", lead.F_by),
        ]
    rows += [(name, *(number(1e6 * value, 3),) * 2) for name, value in of_pair]
    return Table((f"ISO 1328-1:1995, grade {grade.grade} [µm]", "pinion", "wheel"), tuple(rows))


def scuffing(rating: Rating) -> Table | None:
    """Factors of the integral temperature; None where scuffing is not rated."""
    thermal = rating.scuffing
    if thermal is None:
        return None
    temperatures = (
        ("bulk temperature theta_M [°C]", thermal.theta_M),
        ("integral temperature theta_int [°C]", thermal.theta_int),
        ("integral temperature that scuffs theta_Sint [°C]", thermal.theta_Sint),
    )
    rows = (
        ("mean coefficient of friction mu", factor(thermal.mu)),
        ("line load with factors w_Bt [N/mm]", f"{1e-3 * thermal.w_Bt:.2f}"),
        ("helical load factor K_Bgamma", factor(thermal.K_Bgamma)),
        ("thermal flash factor X_M", f"{thermal.X_M:.3f}"),
        ("pressure angle factor X_alphabeta", factor(thermal.X_alphabeta)),
        ("roughness factor X_R", factor(thermal.X_R)),
        ("geometry factor X_BE", factor(thermal.X_BE)),
        ("contact ratio factor X_eps", factor(thermal.X_eps)),
        ("tip relief factor X_Ca", factor(thermal.X_Ca)),
        ("mean flash temperature theta_flaint [K]", f"{thermal.theta_flaint:.2f}"),
        *((name, f"{kelvin - ZERO_CELSIUS:.2f}") for name, kelvin in temperatures),
    )
    return Table(("scuffing, ISO/TR 13989-2", "value"), rows)


def flanks(rating: Rating, own: OwnContact) -> Table:
    """Temperature, friction and film of the flanks: by the scuffing method of the standard and by our own films."""
    thermal = rating.scuffing
    bulk = own.bulk_temperatures
    ours = "" if bulk is None else " and ".join(dict.fromkeys(_celsius(kelvin) for kelvin in bulk))
    film = None if own.least_film is None else 1e6 * own.least_film
    rows: list[Row] = [
        (
            "bulk temperature [°C]",
            _celsius(None if thermal is None else thermal.theta_M),
            ours,
            _off(own.bulk_error),
        ),
        (
            "maximum flash temperature [K]",
            "" if thermal is None or own.theta_B is None else f"{own.theta_B - thermal.theta_M:.2f}",
            "" if own.flash is None else f"{own.flash:.2f}",
            _off(own.flash_error),
        ),
        (
            "maximum contact temperature theta_B [°C]",
            _celsius(own.theta_B),
            _celsius(own.contact_temperature),
            _off(own.temperature_error),
        ),
        (
            "mean coefficient of friction",
            "" if thermal is None else factor(thermal.mu),
            "" if own.friction is None else factor(own.friction),
            _off(own.friction_error),
        ),
        ("minimum film [µm]", "left out", "" if film is None else f"{film:.3f}", _off(own.film_error)),
        (
            f"minimum film over Ra = {number(1e6 * own.roughness, 3)} µm",
            "left out",
            "" if own.film_ratio is None else f"{own.film_ratio:.3f}",
            _off(own.film_error),
        ),
    ]
    heads = ("flanks", "ISO/TR 13989", "our own films", "its numerical error")
    return Table(heads, tuple(rows)).filled


def _celsius(kelvin: float | None) -> str:
    return "" if kelvin is None else f"{kelvin - ZERO_CELSIUS:.2f}"


def _off(error: float | None) -> str:
    return "" if error is None else f"± {percent(error)}"


def spectrum(steps: SpectrumRating) -> Table:
    """Damage of every step of a load spectrum."""
    heads = (
        "step",
        "torque [N m]",
        "speed [rpm]",
        "load cycles",
        "K_v",
        "K_Hbeta",
        "damage of flanks, pinion",
        "wheel",
        "damage of roots, pinion",
        "wheel",
    )
    return Table(heads, tuple(_steps(steps)), "Damage at the required safeties; 1 is failure.")


def _steps(steps: SpectrumRating) -> Iterator[Row]:
    roots = np.full(steps.parts_H.shape, np.nan) if steps.parts_F is None else steps.parts_F
    for place, torque in enumerate(steps.torque.tolist()):
        yield (
            str(place + 1),
            number(torque, 5),
            number(30.0 / np.pi * float(steps.speed[place]), 5),
            f"{steps.cycles[place]:.3e}",
            *(
                number(value) if np.isnan(value) else f"{value:.3f}"
                for value in (steps.K_v[place], steps.K_Hbeta[place])
            ),
            *(number(float(part), 3) for part in (*steps.parts_H[:, place], *roots[:, place])),
        )
