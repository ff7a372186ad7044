"""Whether the wanted film is that with heat and shear thinning: where these change it by more than the tolerance.

What they change is seen by solving the one contact where most power slides, with heat and without. All films along
the path with heat cost some hundred times as much.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from base import SolverError
from flankfilm.plan.decisions import Decision, per_cent, said, signed, stands

if TYPE_CHECKING:
    from flankfilm.coupling.losses.hot_contacts import HeatScreen
    from flankfilm.scene import Scene

SUBJECT = "heat in the film"


def heat_choice(scene: Scene, solved: bool, screen: Callable[[float], HeatScreen]) -> Decision:
    """Decide whether the wanted film has heat.

    Parameters
    ----------
    scene : Scene
    solved : bool
        Whether there are solved films, whose change counts.
    screen : callable
        Solves the contact that heat changes most, to a tolerance; called where it decides.
    """
    asked = scene.film.asked_heat
    if asked != "auto":
        how = "with heat" if asked == "on" else "isothermal"
        reason = said(scene, "film", "heat" if scene.film.heat else "model")
        return Decision(SUBJECT, asked, stands(scene, "film", "heat"), f"{how}; {reason}")
    if why := _not_weighed(scene, solved):
        return Decision(SUBJECT, "off", False, f"not weighed; {why}")
    from flankfilm.coupling.losses.hot_contacts import COARSEST  # which loads all films

    try:
        contact = screen(max(0.5 * scene.tolerance, COARSEST))
    except SolverError as fault:
        return Decision(SUBJECT, "off", False, f"not weighed; the film with heat has no solution: {fault}")
    change, limit = contact.change, scene.tolerance
    effect = (
        f"{signed(change)} of the minimum film at rho1 = {1e3 * contact.rho1:.4g} mm, where most power slides"
    )
    if abs(change) > limit:
        why = f"{effect}, above the tolerance of {per_cent(limit)}: with heat"
        return Decision(SUBJECT, "on", False, why, abs(change), limit)
    why = f"{effect}, below the tolerance of {per_cent(limit)}: left out"
    return Decision(SUBJECT, "off", False, why, abs(change), limit)


def _not_weighed(scene: Scene, solved: bool) -> str:
    """Why heat cannot count; empty where it can."""
    if not solved:
        return "films by formula are isothermal"
    if scene.roughness is not None or scene.film.grid != "graded":
        return "heat is weighed for smooth films on a graded grid"
    warm = scene.heat is not None and scene.heat.given_keys("pinion_temperature_C", "wheel_temperature_C")
    if scene.lubricant is None or (scene.lubricant.temperature_C is None and not warm):
        return "the temperature of the oil, or of the gears, is not given"
    return ""
