"""Which film model a scene gets: the one it names, or the cheapest that its tolerance needs."""

from __future__ import annotations

from dataclasses import dataclass

from flankfilm.build import pinion_speed, pinion_torque
from flankfilm.build_film import lubricant
from flankfilm.stages.engine import Engine


@dataclass(frozen=True)
class FilmDecision:
    """Film model of a run.

    Attributes
    ----------
    model : str
        ``"ehl"``, ``"dowson"`` or ``"none"``.
    reason : str
        Why, with its numbers, for the report.
    """

    model: str
    reason: str


def film_model(engine: Engine) -> FilmDecision:
    """Decide the film model.

    For ``auto`` the film's share is estimated at the pitch point with one pair carrying all: a tooth
    stiffness k and a film stiffness 10 F/h_c (Dowson and Toyoda) in series lower k by about the
    quotient of the two.
    """
    scene = engine.scene
    asked = scene.film.model
    # a scene without [film] has "none", and may still want the film; one that says "none" may not
    if "film" in scene.wants and asked in ("auto", "none"):
        return FilmDecision("ehl", "the film itself is wanted")
    if asked != "auto":
        return FilmDecision(asked, f'the scene asks for film.model = "{asked}"')
    if scene.lubricant is None or scene.operating is None or scene.operating.pinion_speed_rpm is None:
        return FilmDecision("none", "the scene has no lubricant or no speed")
    if scene.film.starved or scene.roughness is not None:
        what = f'film.supply = "{scene.film.supply}"' if scene.film.starved else "[roughness]"
        return FilmDecision("ehl", f"the formula that would estimate its part does not know {what}")
    if scene.film.grid != "graded":
        return FilmDecision("ehl", "the scene names a grid")
    if scene.lubricant.constant_viscosity:
        return FilmDecision(
            "ehl", "the formula that would estimate its part does not know a constant viscosity"
        )
    from ehl import LineContact, dowson

    pair = engine["pair"]
    path = pair.path_at(pair.points.C)
    force = pair.normal_force(pinion_torque(scene))
    contact = LineContact(
        load=force / pair.face_width,
        entrainment=float(path.entrainment(pinion_speed(scene))[0]),
        radius=float(path.radius[0]),
        reduced_modulus=pair.reduced_modulus,
        lubricant=lubricant(scene),
    )
    film = pair.face_width * dowson(contact).stiffness("dowson-central")
    tooth = float(engine["dry cycle"].secant.mean())
    change = tooth / (tooth + film)
    if change < scene.tolerance:
        told = (
            f"it would lower the mean stiffness by about {change:.2%}, less than the tolerance of "
            f"{scene.tolerance:.2%}"
        )
        return FilmDecision("none", f"left out: {told}")
    return FilmDecision("ehl", f"it lowers the mean stiffness by about {change:.2%}, more than the tolerance")
