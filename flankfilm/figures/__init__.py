"""One plot function for each kind of result; each takes a dataset of results and returns a matplotlib figure.

The report and the documentation draw with the same functions. ``results.nc``, ``study.nc``, ``optimum.nc`` and
``verify.nc`` hold all that they need, so that any figure can be drawn again in a style of one's own.
"""

from flankfilm.figures.animation import Frame, animate_cycle, teeth_scene, tooth_picture, view_cycle
from flankfilm.figures.diagrams import diagram
from flankfilm.figures.film import (
    film_along_path,
    film_changes,
    film_families,
    film_profiles,
    film_shares,
    film_stiffness,
)
from flankfilm.figures.gear import gears_in_mesh, kinematics, tooth_stress
from flankfilm.figures.loads import over_torque, revolution, root_stress
from flankfilm.figures.motion import portraits, sweep
from flankfilm.figures.optima import optimum
from flankfilm.figures.stiffness import fourier, load_share, mesh_stiffness, single_pairs, transmission_error
from flankfilm.figures.studies import study
from flankfilm.figures.verified import verification

__all__ = [
    "Frame",
    "animate_cycle",
    "diagram",
    "film_along_path",
    "film_changes",
    "film_families",
    "film_profiles",
    "film_shares",
    "film_stiffness",
    "fourier",
    "gears_in_mesh",
    "kinematics",
    "load_share",
    "mesh_stiffness",
    "optimum",
    "over_torque",
    "portraits",
    "revolution",
    "root_stress",
    "single_pairs",
    "study",
    "sweep",
    "teeth_scene",
    "tooth_picture",
    "tooth_stress",
    "transmission_error",
    "verification",
    "view_cycle",
]
