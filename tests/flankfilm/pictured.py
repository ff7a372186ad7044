"""Every record that draws itself, the runs that other pictures are drawn from, and what pictures have to keep to."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

import dynamics
import ehl
import fem
import flankfilm as ff
from flankfilm import coupling
from flankfilm.outcome.results import Results
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from gears import Alignment, Gear, GearPair, Lead, closed_form
from gears.rating import GearOil, LoadBin, RatedSteel, RatingData, ScuffingData, rate
from tests.flankfilm.scenes import ISHIKAWA

PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04).with_backlash(
    50e-6
)
OIL = ehl.Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
CONTACT = ehl.LineContact(2e5, 2.5, 6.5e-3, 2.26e11, OIL, sliding=1.0)
OSCILLATOR = dynamics.GearOscillator(
    stiffness=dynamics.FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
    damping_ratio=0.05,
    mean_force=0.1,
    error_amplitude=0.2,
    frequency=0.6,
    half_backlash=0.2,
)

TRAIN = """
[dynamics]
fourier_order = 2
error_amplitude_um = 4
run_up = { speed_rpm = [7000, 7100], periods = 128 }
sweep = { speed_rpm = [7000, 7400], points = 2 }
[shafts.pinion]
segments = [{ length_mm = 200, diameter_mm = 40 }]
bearings = [{ position_mm = 20, stiffness_N_per_m = 4e8 }, { position_mm = 180, stiffness_N_per_m = 4e8 }]
gear_position_mm = 60
inertia_kg_m2 = 0.02
[shafts.wheel]
inertia_kg_m2 = 0.05
coupling_stiffness_Nm_per_rad = 2e4
"""
"""Motion of a drive train."""

FACE = """
wants = ["film", "root-stress"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 20.0
pinion = { teeth = 20, bore_mm = 20, crowning_um = 3 }
wheel = { teeth = 30, bore_mm = 30 }
backlash_um = 100
[alignment]
in_plane_um = 40
cells = 8
face_model = "walls"
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 100
pinion_speed_rpm = 2000
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
[film]
model = "dowson"
"""
"""What a face bears, with a film and root stress."""

LOSSES = """
wants = ["film", "losses"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36 }
wheel = { teeth = 40 }
[material]
name = "steel 16MnCr5"
[operating]
pinion_torque_Nm = 300
pinion_speed_rpm = 2000
[stiffness]
model = "ishikawa"
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
density_kg_per_m3 = 860
temperature_C = 80
viscosity_slope_per_K = 0.04
eyring_stress_MPa = 5
[film]
model = "dowson"
"""
"""Friction, losses and temperatures."""

HELICAL = """
wants = ["geometry", "stiffness", "film", "bearing-forces"]
tolerance = 0.02
[pair]
module_mm = 1.0
face_width_mm = 6.0
helix_angle_deg = 20
pinion = { teeth = 18 }
wheel = { teeth = 23 }
backlash_um = 40
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 8
pinion_speed_rpm = 3000
[lubricant]
viscosity_Pa_s = 0.05
pressure_viscosity_per_GPa = 19
[film]
model = "dowson"
[dynamics]
bearing_forces = { speed_rpm = [2000, 20000], points = 40 }
[bearings]
pinion = [{ position_mm = -9, radial_N_per_m = 1e8, axial_N_per_m = 5e7 }, { position_mm = 12, radial_N_per_m = 1e8 }]
wheel = [{ position_mm = 0, radial_N_per_m = 2e8, axial_N_per_m = 5e7, tilting_Nm_per_rad = 1e4 }]
damping_s = 5e-6
"""
"""Lines of contact, with films by formula, and gears that move and tilt in space."""


@cache
def run(text: str) -> Results:
    """Run a scene once."""
    ran = run_scene(parse_scene(text), None, use_cache=False)
    assert ran.failures == ()
    return ran


def train() -> Results:
    """Run a drive train, and its sweep, spectrum, run-up and map."""
    wants = ", ".join(f'"{want}"' for want in ("sweep", "spectrum", "run-up", "dynamic-map"))
    speeds = "pinion_torque_Nm = 600\npinion_speed_rpm = 7200\ntorques_Nm = [300, 600]"
    scene = ISHIKAWA.replace("WANTS", wants).replace("pinion_torque_Nm = 600", speeds)
    return run(scene.replace("TITLE", "train") + TRAIN)


@cache
def cycle() -> coupling.MeshCycle:
    """Mesh cycle by a closed form."""
    return ff.mesh_cycle(PAIR, torque=60.0, model="ishikawa")


@cache
def orbit() -> dynamics.Orbit:
    """Orbit of one period."""
    return dynamics.find_orbit(OSCILLATOR, guess=(0.5, 0.2), periods=1)


@cache
def narrow_teeth() -> coupling.LoadedTeeth:
    """Teeth whose load varies over the face."""
    pinion = Gear(teeth=20, bore_radius=10e-3, lead=Lead(crowning=3e-6))
    pair = GearPair(pinion, Gear(teeth=30, bore_radius=15e-3), module=2e-3, face_width=20e-3).with_backlash(
        100e-6
    )
    bodies = fem.compliance(pair, tolerance=0.05)
    flanks = coupling.Flanks(alignment=Alignment(12e-6), cells=8, face_model="walls")
    return coupling.LoadedTeeth(pair, 100.0, compliance=bodies, flanks=flanks)


def eased(time: Any) -> Any:
    """Load that falls by a quarter and stays."""
    return 2e5 * (0.75 + 0.25 * np.cos(np.pi * np.minimum(time / 3e-4, 1.0)))


MOTION = """
[dynamics]
damping_ratio = 0.05
error_amplitude_um = 10
sweep = { speed_rpm = [12000, 20000], points = 9 }
diagram = { speed_rpm = [16000, 20000], searches = 2, max_period = 1 }
"""
"""Sweeps and a bifurcation diagram."""


def motion() -> Results:
    """Run closed forms with a film by formula, and their motion."""
    wants = ("geometry", "closed-forms", "stiffness", "film", "fourier", "sweep", "diagram")
    scene = ISHIKAWA.replace("WANTS", ", ".join(f'"{want}"' for want in wants)).replace("TITLE", "motion")
    scene = scene.replace("poisson_ratio = 0.3", "poisson_ratio = 0.3\ndensity_kg_per_m3 = 7850")
    scene = scene.replace("wheel = { teeth = 40 }", "wheel = { teeth = 40 }\nbacklash_um = 50")
    speeds = "pinion_torque_Nm = 200\npinion_speed_rpm = 2000"
    oil = "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\n"
    film = '[film]\nmodel = "dowson"\n'
    return run(scene.replace("pinion_torque_Nm = 600", speeds) + oil + film + MOTION)


def rating() -> Any:
    """Rating of a pair with a load spectrum."""
    steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    steps = (LoadBin(400.0, 150.0, 1e6), LoadBin(300.0, 209.44, 3e7), LoadBin(0.0, 50.0, 1e6))
    test = ScuffingData(GearOil(220e-6, 19e-6, 890.0, 353.15), 0.6e-6, 450.1)
    data = RatingData(6, steels, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6), 1.25, scuffing=test, spectrum=steps)
    return rate(PAIR, 300.0, 209.44, data)


def of_run(made: Callable[[], Results], stage: str) -> Callable[[], Any]:
    """Record of a stage of a run."""
    return lambda: made().values[stage]


def face() -> Results:
    """Run a crowned pair that is out of line."""
    return run(FACE)


def helical() -> Results:
    """Sizes of a helical pair, and load and films along its lines of contact."""
    return run(HELICAL)


def losses() -> Results:
    """Run the losses of a mesh."""
    return run(LOSSES)


def branch() -> dynamics.Branch:
    """Branch with an instability."""
    return dynamics.continue_branch(orbit(), parameter="frequency", bounds=(0.5, 1.0))


def locus() -> Any:
    """Curve of the branch's first special point over frequency and damping."""
    point = branch().points[0]
    bounds = ((0.4, 1.2), (0.04, 0.06))
    return dynamics.continue_locus(OSCILLATOR, point, ("frequency", "damping_ratio"), bounds)


def values(count: int) -> Any:
    """Frequencies below the resonance."""
    return np.linspace(0.5, 0.6, count)


def error_curve() -> coupling.ErrorSeries:
    """Series of an unloaded error."""
    turn = np.arange(64) / 64
    return coupling.error_series(1e-6 * np.abs(np.sin(np.pi * turn)), order=4)


def film() -> ehl.Film:
    """Film of one contact."""
    return ehl.solve(CONTACT, tolerance=0.05)


ROUGH = ehl.Roughness(0.3e-6, 1e11, 1e-6)

RECORDS: Mapping[str, Callable[[], Any]] = {
    "gears.pair.gear_pair:GearPair": lambda: PAIR,
    "gears.pair.path:PathOfContact": lambda: PAIR.path_of_contact(9),
    "gears.closed_form.record:ClosedForm": lambda: closed_form.ishikawa(PAIR, PAIR.path_of_contact(9)),
    "gears.rating.rating:Rating": rating,
    "gears.rating.spectrum_rating:SpectrumRating": lambda: rating().spectrum,
    "fem.cycle.result:MeshCycle": lambda: face().values["dry cycle"].contact,
    "fem.cycle.face_loads:FaceLoads": lambda: face().values["dry cycle"].contact.face,
    "fem.cycle.line_loads:LineLoads": lambda: helical().values["dry cycle"].contact.lines,
    "fem.stress.tooth_root:RootStress": lambda: face().values["root stress"].stress,
    "fem.stress.gear_root:FaceRootStress": lambda: face().values["root stress"].stress.pinion.face,
    "ehl.films.film:Film": film,
    "ehl.films.mixed_film:MixedFilm": lambda: ehl.solve_mixed(CONTACT, ROUGH, 0.05),
    "ehl.films.mixed_thermal:MixedThermalFilm": lambda: ehl.solve_mixed_thermal(
        CONTACT, ROUGH, tolerance=0.05
    ),
    "ehl.films.frequency:FilmResponse": lambda: ehl.film_response(film(), np.geomspace(1e3, 1e6, 7)),
    "ehl.films.transient_film:TransientFilm": lambda: ehl.solve_transient(
        CONTACT, eased, np.linspace(0.0, 5e-4, 6)
    ),
    "ehl.films.traction:TractionCurve": lambda: ehl.traction_curve(
        OIL, 0.6e9, 2.5, [0.05, 0.1, 0.3], radius=6.5e-3, tolerance=0.05
    ),
    "dynamics.flow.motions:Trajectory": lambda: dynamics.trajectory(OSCILLATOR, (0.5, 0.2)),
    "dynamics.orbits.shooting:Orbit": orbit,
    "dynamics.branches.branch:Branch": branch,
    "dynamics.attraction.diagrams:Diagram": lambda: dynamics.diagram(
        OSCILLATOR, bounds=(0.5, 1.0), searches=2, swept=5, max_period=2
    ),
    "dynamics.motion.sweeps:SweepResult": lambda: dynamics.sweep(
        OSCILLATOR, parameter="frequency", values=values(5), direction="up"
    ),
    "dynamics.attraction.multi_sweeps:MultiSweep": lambda: dynamics.multi_sweep(
        OSCILLATOR, parameter="frequency", values=values(5)
    ),
    "dynamics.attraction.basins:BasinResult": lambda: dynamics.basins(OSCILLATOR, x=(-1, 1, 6), v=(-1, 1, 6)),
    "dynamics.motion.exponents:LyapunovScan": lambda: dynamics.lyapunov_scan(
        OSCILLATOR, "frequency", values(3), 200
    ),
    "dynamics.branches.loci:Locus": locus,
    "dynamics.motion.spectra:Spectrum": lambda: dynamics.motion_spectrum(OSCILLATOR, orbit().state),
    "dynamics.motion.run_ups:RunUp": lambda: dynamics.run_up(OSCILLATOR, (0.5, 0.6), 160),
    "flankfilm.coupling.mesh.mesh_curves:MeshCycle": cycle,
    "flankfilm.coupling.films.face_films:FaceFilms": lambda: face().values["film"].over_face,
    "flankfilm.coupling.films.line_films:LineFilms": lambda: helical().values["film"].over_lines,
    "flankfilm.coupling.films.along_path:FilmAlongPath": lambda: motion().values["film"].film,
    "flankfilm.coupling.losses.losses_along_path:LossesAlongPath": lambda: losses().values["losses"].path,
    "flankfilm.coupling.losses.losses_record:MeshLosses": of_run(losses, "losses"),
    "flankfilm.coupling.mesh.torque_curves:TorqueCurves": lambda: coupling.torque_curves(
        narrow_teeth(), [60.0, 100.0], positions=8
    ),
    "flankfilm.coupling.mesh.face_models:FaceLoadModels": of_run(face, "load over the face"),
    "flankfilm.coupling.mesh.face_tolerance:FaceTolerance": lambda: coupling.face_load_tolerance(
        narrow_teeth(), 10e-6, positions=8
    ),
    "flankfilm.coupling.vibration.film_damping:FilmDamping": lambda: coupling.film_damping(
        cycle(), PAIR, 60.0, 209.44, OIL, tolerance=0.05
    ),
    "flankfilm.coupling.films.transient_film:PassageFilm": lambda: coupling.passage_film(
        ff.mesh_cycle(PAIR, 60.0, tolerance=0.05), PAIR, 209.44, OIL, tolerance=0.05
    ),
    "flankfilm.coupling.speeds.speed_sweep:SpeedSweep": of_run(motion, "sweep"),
    "flankfilm.coupling.speeds.jumps:SpeedDiagram": of_run(motion, "diagram"),
    "flankfilm.coupling.vibration.excitation:ErrorSeries": error_curve,
    "flankfilm.coupling.speeds.sidebands:MotionSpectrum": of_run(train, "spectrum"),
    "flankfilm.coupling.speeds.run_ups:SpeedRunUp": of_run(train, "run-up"),
    "flankfilm.coupling.speeds.dynamic_map:DynamicMap": of_run(train, "dynamic-map"),
    "flankfilm.coupling.drive.pair_drive:PairDrive": of_run(train, "drive"),
    "flankfilm.coupling.speeds.bearing_sweep:BearingSweep": of_run(helical, "bearing forces"),
    "flankfilm.coupling.speeds.drive_sweep:DriveSweep": of_run(train, "drive sweep"),
    "flankfilm.coupling.mesh.root_stress:RootStresses": of_run(face, "root stress"),
    "flankfilm.coupling.vibration.oscillator:PairOscillator": of_run(motion, "scaling"),
    "flankfilm.coupling.vibration.series:MeshSeries": of_run(motion, "fourier"),
    "flankfilm.coupling.mesh.verification:Verification": lambda: coupling.compare_closed_forms(
        PAIR, 300.0, tolerance=0.05
    ),
}
"""Class of a record to one of them."""


PURE = {"motion n-p-q", "evaluation", "point of the train"}
"""Titles of axes that have no unit to show."""

UNIT = re.compile(r"\[.+\]|\.\w+_(mm|Nm|rpm)$", re.DOTALL)


def overlapping(artists: Sequence[Artist], renderer: Any) -> bool:
    """Whether two texts overprint."""
    boxes = [artist.get_window_extent(renderer).shrunk(0.98, 0.9) for artist in artists]
    return any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


def faults_of(figure: Figure) -> list[str]:
    """What no picture may have: titles without units, legends over data, texts over texts, cut off, or scales apart."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    panels = [axes for axes in figure.axes if axes.axison and axes.get_visible()]
    legends = [*figure.legends, *(axes.get_legend() for axes in panels if axes.get_legend())]
    faults = [
        "a legend covers data"
        for legend, axes in itertools.product(legends, panels)
        if legend.get_window_extent(renderer).shrunk(0.98, 0.98).overlaps(axes.get_window_extent(renderer))
    ]
    for axes in panels:
        titles = [title for title in (axes.get_xlabel(), axes.get_ylabel()) if title]
        faults += [
            f"{title!r} has no unit" for title in titles if title not in PURE and not UNIT.search(title)
        ]
        across = axes.get_shared_x_axes().get_siblings(axes)
        if not (axes.get_ylabel() or axes.get_xlabel() or len(across) > 1):
            faults.append("a panel has no titles")
        for way in (axes.xaxis, axes.yaxis):
            low, high = sorted(way.get_view_interval())
            ticks = [tick for tick in way.get_major_ticks() if low <= tick.get_loc() <= high]
            shown = [tick.label1 for tick in ticks if tick.label1.get_visible() and tick.label1.get_text()]
            # turned words stand beside each other in boxes that overlap
            if not any(label.get_rotation() % 90.0 for label in shown) and overlapping(shown, renderer):
                faults.append(f"numbers of {titles} overprint")
            if apart := way.get_offset_text().get_text():
                faults.append(f"{apart} stands apart from the numbers of {titles}")
    names = [axes.yaxis.label for axes in panels if axes.get_ylabel()]
    names += [axes.xaxis.label for axes in panels if axes.get_xlabel() and axes.xaxis.label.get_visible()]
    if overlapping([*names, *legends], renderer):
        faults.append("titles of two panels, or a title and a legend, overprint")
    whole, paper = figure.get_tightbbox(renderer), Bbox([[0.0, 0.0], figure.get_size_inches()])
    if not (
        paper.padded(0.03).contains(whole.x0, whole.y0) and paper.padded(0.03).contains(whole.x1, whole.y1)
    ):
        faults.append(f"something is cut off: {whole} on {paper}")
    return faults
