"""Which records show themselves how: names alone, so that nothing is loaded before a record is shown."""

from __future__ import annotations

from collections.abc import Mapping

from base import show_with
from base.views import ANY

PICTURES: Mapping[str, str] = {
    "gears.pair.gear_pair:GearPair": "pair",
    "gears.pair.path:PathOfContact": "curves",
    "gears.closed_form.record:ClosedForm": "closed_form",
    "fem.cycle.result:MeshCycle": "loaded_contact",
    "fem.cycle.face_loads:FaceLoads": "face_loads",
    "fem.stress.tooth_root:RootStress": "root_stress",
    "fem.stress.gear_root:FaceRootStress": "face_root_stress",
    "ehl.films.film:Film": "curves",
    "ehl.films.mixed_film:MixedFilm": "mixed_film",
    "ehl.films.mixed_thermal:MixedThermalFilm": "mixed_film",
    "ehl.films.frequency:FilmResponse": "film_response",
    "ehl.films.transient_film:TransientFilm": "curves",
    "ehl.films.traction:TractionCurve": "curves",
    "dynamics.flow.motions:Trajectory": "portrait",
    "dynamics.orbits.shooting:Orbit": "orbit",
    "dynamics.branches.branch:Branch": "branch",
    "dynamics.attraction.diagrams:Diagram": "branches",
    "dynamics.motion.sweeps:SweepResult": "sweep",
    "dynamics.attraction.multi_sweeps:MultiSweep": "multi_sweep",
    "dynamics.attraction.basins:BasinResult": "basins",
    "dynamics.motion.exponents:LyapunovScan": "exponents",
    "dynamics.branches.loci:Locus": "locus",
    "dynamics.motion.spectra:Spectrum": "spectrum",
    "dynamics.motion.run_ups:RunUp": "run_up",
    "flankfilm.coupling.mesh.mesh_curves:MeshCycle": "curves",
    "flankfilm.coupling.films.face_films:FaceFilms": "face_films",
    "flankfilm.coupling.films.along_path:FilmAlongPath": "curves",
    "flankfilm.coupling.losses.losses_along_path:LossesAlongPath": "losses_along_path",
    "flankfilm.coupling.losses.losses_record:MeshLosses": "mesh_losses",
    "flankfilm.coupling.mesh.torque_curves:TorqueCurves": "curves",
    "flankfilm.coupling.mesh.face_models:FaceLoadModels": "face_models",
    "flankfilm.coupling.mesh.face_tolerance:FaceTolerance": "curves",
    "flankfilm.coupling.vibration.film_damping:FilmDamping": "curves",
    "flankfilm.coupling.films.transient_film:PassageFilm": "curves",
    "flankfilm.coupling.speeds.speed_sweep:SpeedSweep": "speed_sweep",
    "flankfilm.coupling.speeds.jumps:SpeedDiagram": "speed_diagram",
    "flankfilm.coupling.vibration.excitation:ErrorSeries": "error_series",
    "flankfilm.coupling.speeds.sidebands:MotionSpectrum": "motion_spectrum",
    "flankfilm.coupling.speeds.run_ups:SpeedRunUp": "speed_run_up",
    "flankfilm.coupling.speeds.dynamic_map:DynamicMap": "dynamic_map",
    "flankfilm.coupling.drive.pair_drive:PairDrive": "pair_drive",
    "flankfilm.coupling.speeds.drive_sweep:DriveSweep": "drive_sweep",
    "flankfilm.coupling.mesh.root_stress:RootStresses": "root_stresses",
    "flankfilm.coupling.vibration.oscillator:PairOscillator": "series_of",
    "flankfilm.coupling.vibration.series:MeshSeries": "series",
    "flankfilm.coupling.mesh.verification:Verification": "verification",
}
"""Record to the function of `flankfilm.figures` that draws it."""

OUTCOMES: Mapping[str, str] = {
    "flankfilm.outcome.results:Results": "flankfilm.outcome.pictures:results",
    "flankfilm.studies.run:StudyResults": "flankfilm.studies.pictures:study",
    "flankfilm.optimisation.optimum:Optimum": "flankfilm.optimisation.pictures:optimum",
}
"""The same of runs, studies and optimisations, whose pictures stand beside them."""

MODULES: Mapping[str, tuple[str, ...]] = {
    "of_speeds": ("error_series", "spectrum", "motion_spectrum", "run_up", "speed_run_up", "dynamic_map"),
    "of_motions": (
        *("portrait", "orbit", "branch", "branches", "sweep", "multi_sweep", "basins", "exponents", "locus"),
        *("speed_sweep", "speed_diagram"),
    ),
    "of_drives": ("pair_drive", "drive_sweep"),
    "face": ("loaded_contact", "face_loads", "face_films", "face_models"),
    "face_roots": ("face_root_stress",),
}
"""Module of `flankfilm.figures` to the functions in it; all others are in `of_records`."""

VIEWS: Mapping[str, str] = {
    "flankfilm.outcome.results:Results": "flankfilm.notebook:results_html",
    "flankfilm.studies.run:StudyResults": "flankfilm.notebook:study_html",
    "flankfilm.optimisation.optimum:Optimum": "flankfilm.notebook:optimum_html",
    "gears.closed_form.record:ClosedForm": "flankfilm.notebook:closed_form_html",
    ANY: "flankfilm.notebook:record_html",
}
"""Record to the function that gives its HTML; a pair's is the gears' own."""


def register() -> None:
    """Register views and pictures; the entry point ``base.views`` of the distribution."""
    module = {name: module for module, names in MODULES.items() for name in names}
    pictures = {
        place: f"flankfilm.figures.{module.get(name, 'of_records')}:{name}"
        for place, name in PICTURES.items()
    }
    show_with(VIEWS, {**pictures, **OUTCOMES})
