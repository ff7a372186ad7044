"""Which records show themselves how: names alone, so that nothing is loaded before a record is shown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from base import show_with
from base.views import ANY

OF_PRODUCT = ""
"""How a record is drawn that a product has: by the first picture of that."""


class Picture(NamedTuple):
    """How a record is drawn: from its own dataset, by the function that draws it of a run.

    Attributes
    ----------
    draw : str
        Module and function of `flankfilm.figures`, of a dataset; or `OF_PRODUCT`.
    prefix : str
        What the record's variables begin with: that of a run, where a run has such a record.
    data : str
        Function of `flankfilm.output.records` that gives the parts of the dataset.
    """

    draw: str
    prefix: str
    data: str = "alone"

    @property
    def by(self) -> str:
        """Module and function that draw the record: the products' are loaded for theirs alone."""
        return "flankfilm.figures.records:picture" if self.draw else "flankfilm.runs.pictures:record"


_DYNAMICS = {
    "flow.motions:Trajectory": Picture("orbits.trajectory", "motion", "trajectory"),
    "orbits.shooting:Orbit": Picture("orbits.trajectory", "motion", "orbit"),
    "branches.branch:Branch": Picture("motion.diagram", "diagram", "branch"),
    "attraction.diagrams:Diagram": Picture("motion.diagram", "diagram", "diagram"),
    "motion.sweeps:SweepResult": Picture("motion.sweep", "sweep", "sweep"),
    "attraction.multi_sweeps:MultiSweep": Picture("orbits.attractors", "met", "attractors"),
    "attraction.basins:BasinResult": Picture("orbits.basins", "basins", "basins"),
    "motion.exponents:LyapunovScan": Picture("orbits.exponents", "lyapunov"),
    "branches.loci:Locus": Picture("orbits.locus", "locus", "locus"),
    "motion.spectra:Spectrum": Picture("excitation.spectrum", "spectrum"),
    "motion.run_ups:RunUp": Picture("speeds.run_up", "run_up", "run_up"),
}

_COUPLING = {
    "mesh.mesh_curves:MeshCycle": Picture("stiffness.mesh_cycle", "dry", "cycle"),
    "films.face_films:FaceFilms": Picture(OF_PRODUCT, "film_face", "with_points"),
    "films.line_films:LineFilms": Picture(OF_PRODUCT, "film_lines", "with_points"),
    "films.along_path:FilmAlongPath": Picture(OF_PRODUCT, "film"),
    "losses.losses_along_path:LossesAlongPath": Picture("heat.heat_along_path", "losses_path"),
    "losses.losses_record:MeshLosses": Picture("heat.heat_along_path", "losses", "losses"),
    "mesh.torque_curves:TorqueCurves": Picture(OF_PRODUCT, "torque"),
    "mesh.face_models:FaceLoadModels": Picture(OF_PRODUCT, "face_models"),
    "mesh.face_tolerance:FaceTolerance": Picture("curves.curves", "face_tolerance"),
    "vibration.film_damping:FilmDamping": Picture("curves.curves", "damping"),
    "films.transient_film:PassageFilm": Picture("curves.curves", "passage"),
    "speeds.speed_sweep:SpeedSweep": Picture(OF_PRODUCT, "sweep"),
    "speeds.jumps:SpeedDiagram": Picture(OF_PRODUCT, "diagram", "speed_diagram"),
    "vibration.excitation:ErrorSeries": Picture(OF_PRODUCT, "excitation"),
    "speeds.sidebands:MotionSpectrum": Picture(OF_PRODUCT, "spectrum", "carrying"),
    "speeds.run_ups:SpeedRunUp": Picture(OF_PRODUCT, "run_up", "carrying"),
    "speeds.dynamic_map:DynamicMap": Picture(OF_PRODUCT, "dynamic_map", "carrying"),
    "drive.pair_drive:PairDrive": Picture(OF_PRODUCT, "drive"),
    "speeds.bearing_sweep:BearingSweep": Picture(OF_PRODUCT, "in_space"),
    "speeds.drive_sweep:DriveSweep": Picture(OF_PRODUCT, "drive_sweep", "carrying"),
    "mesh.root_stress:RootStresses": Picture(OF_PRODUCT, "root", "root_stresses"),
    "vibration.oscillator:PairOscillator": Picture("stiffness.fourier", "fourier", "series_of"),
    "vibration.series:MeshSeries": Picture("stiffness.fourier", "fourier", "series"),
    "mesh.verification:Verification": Picture("closed_forms.verification", "verify", "comparison"),
}

PICTURES: Mapping[str, Picture] = {
    "gears.pair.gear_pair:GearPair": Picture("gear.gears_in_mesh", "pair", "pair"),
    "gears.pair.path:PathOfContact": Picture("gear.kinematics", "path"),
    "gears.closed_form.record:ClosedForm": Picture("closed_forms.closed_form", "closed_form", "closed_form"),
    "gears.rating.rating:Rating": Picture("rating.safeties", "rating"),
    "gears.rating.spectrum_rating:SpectrumRating": Picture("rating.spectrum_damage", "rating_spectrum"),
    "fem.cycle.result:MeshCycle": Picture("stiffness.mesh_cycle", "dry", "loaded"),
    "fem.cycle.face_loads:FaceLoads": Picture("face.flank_map", "dry_face", "with_points"),
    "fem.cycle.line_loads:LineLoads": Picture("plane_of_action.load_centre", "dry_lines", "with_points"),
    "fem.stress.tooth_root:RootStress": Picture("gear.root_stress", "root", "passages"),
    "fem.stress.gear_root:FaceRootStress": Picture("face.root_face_map", "root_face"),
    "ehl.films.film:Film": Picture("curves.curves", "contact_film", "contact_film"),
    "ehl.films.mixed_film:MixedFilm": Picture("curves.curves", "contact_film", "mixed"),
    "ehl.films.mixed_thermal:MixedThermalFilm": Picture("curves.curves", "contact_film", "mixed"),
    "ehl.films.frequency:FilmResponse": Picture("curves.film_response", "response", "response"),
    "ehl.films.transient_film:TransientFilm": Picture("curves.curves", "transient"),
    "ehl.films.traction:TractionCurve": Picture("curves.curves", "traction"),
    **{f"dynamics.{place}": how for place, how in _DYNAMICS.items()},
    **{f"flankfilm.coupling.{place}": how for place, how in _COUPLING.items()},
}
"""Record to its picture."""

OUTCOMES: Mapping[str, str] = {
    "flankfilm.outcome.results:Results": "flankfilm.runs.pictures:results",
    "flankfilm.studies.run:StudyResults": "flankfilm.studies.pictures:study",
    "flankfilm.optimisation.optimum:Optimum": "flankfilm.optimisation.pictures:optimum",
}
"""Runs, studies and optimisations to the functions that draw them."""

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
    show_with(VIEWS, {**{place: how.by for place, how in PICTURES.items()}, **OUTCOMES})
