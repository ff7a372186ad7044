"""Single records as datasets with the names of variables that a run has: what `record.plot()` draws from."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Quantity
from base.results import EXACT, Figure
from flankfilm.output import drawing_data as drawn
from flankfilm.output import drives, heat
from flankfilm.output.branches import branch_tables, diagram_tables
from flankfilm.output.geometry import pair_figures
from flankfilm.output.passages import passage
from flankfilm.output.variables import figure_of, of_list, of_models, of_quantities, of_record

if TYPE_CHECKING:
    import xarray as xr

    import dynamics
    import fem
    import gears
    from ehl import Film, FilmResponse, MixedFilm
    from flankfilm.coupling import MeshLosses, PairOscillator, RootStresses, Verification
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

Parts = Iterable["xr.Dataset"]

GEARS = ("pinion", "wheel")


def alone(prefix: str, record: object) -> Parts:
    """A record's own figures."""
    yield of_record(prefix, record)


def carrying(prefix: str, record: Any) -> Parts:
    """A record without figures of bearings or of shafts where it has none."""
    yield drives.carrying(prefix, record)


def comparison(prefix: str, verification: Verification) -> Parts:
    """Variables of a verification: its pair, every closed form, and finite elements."""
    import xarray as xr

    models = {model.label: model for model in verification.models if model.single_stiffness.size}
    like = {"units": "1", "long_name": "reference without what closed forms lack", "error_note": EXACT}
    yield pair_figures("pair", verification.pair)
    yield of_quantities("outline", drawn.outlines(verification.pair))
    yield of_quantities("path", drawn.points(verification.pair))
    yield of_record("path", verification, ("rho1",))
    yield of_record("mesh", verification, ("position",))
    references = {curves.label: curves for curves in verification.references}
    yield of_models("reference", references, "reference", "reference")
    yield of_models("model", models, "model")
    if verification.over_face is not None:
        yield of_record("face_models", verification.over_face)
    number = verification.references.index(verification.like_for_like)
    yield xr.Dataset({"like_for_like": ((), number, like)})


def series(prefix: str, record: Any) -> Parts:
    """Variables of a series of the stiffness; a given one may be over its mean."""
    variables = of_record(prefix, record)
    if record.kind == "given" and record.mean == 1.0:
        for name in (f"{prefix}_mean", f"{prefix}_amplitude"):
            variables[name].attrs["units"] = "1"
    yield variables


def pair(prefix: str, gear_pair: gears.GearPair) -> Parts:
    """Figures of a pair, both outlines, and the points of the path of contact."""
    yield pair_figures(prefix, gear_pair)
    yield of_quantities("outline", drawn.outlines(gear_pair))
    yield of_quantities("path", drawn.points(gear_pair))


def closed_form(prefix: str, form: gears.closed_form.ClosedForm) -> Parts:
    """Compliance of each part at each point."""
    count = np.atleast_1d(form.compliance).size
    figure = Figure("m/N", "part of the compliance", ("point",), no_error=form.no_error)
    parts = {name: np.broadcast_to(np.atleast_1d(part), count) for name, part in form.parts.items()}
    yield of_quantities(prefix, (Quantity("parts", figure, parts),))


def loaded(prefix: str, cycle: fem.MeshCycle) -> Parts:
    """A loaded contact by finite elements, with what its face bears where it has cells."""
    yield of_record(prefix, cycle)
    yield of_quantities("path", drawn.points(cycle.pair))
    if cycle.face is not None:
        yield of_record(f"{prefix}_face", cycle.face)
    if cycle.lines is not None:
        yield of_record(f"{prefix}_lines", cycle.lines)


def cycle(prefix: str, cycle: MeshCycle) -> Parts:
    """A mesh cycle; one with a film is the lubricated one."""
    yield of_record("lubricated" if hasattr(cycle, "film") else prefix, cycle)


def with_points(prefix: str, record: Any) -> Parts:
    """A record with the points of its pair's path."""
    yield of_record(prefix, record)
    yield of_quantities("path", drawn.points(record.pair))


def passages(prefix: str, roots: fem.RootStress) -> Parts:
    """Stress of a tooth of each gear that passes through the mesh."""
    for name in GEARS:
        yield of_quantities(f"{prefix}_{name}", passage(getattr(roots, name)))


def root_stresses(prefix: str, roots: RootStresses) -> Parts:
    """Stress of passing teeth, and the nominal one."""
    yield from passages(prefix, roots.stress)
    if roots.iso is not None:
        yield of_record("iso6336_3", roots.iso)
        yield of_list("iso6336_3", "gear", roots.iso.sections)


def contact_film(prefix: str, film: Film) -> Parts:
    """A film through its contact, and how wide that is."""
    yield of_record(prefix, film)
    yield of_record(prefix, film.contact, ("half_width",))


def mixed(prefix: str, film: MixedFilm) -> Parts:
    """The film that carries its share of the load."""
    yield from contact_film(prefix, film.film)


def response(prefix: str, response: FilmResponse) -> Parts:
    """Answers of a film by rising frequency."""
    order = np.argsort(response.frequency, axis=None)

    def along(name: str, unit: str, meaning: str) -> Quantity:
        return figure_of(name, unit, meaning, "load", np.ravel(getattr(response, name))[order])

    yield of_quantities(
        prefix,
        (
            along("frequency", "rad/s", "frequency of the load"),
            along("compliance", "m2/N", "yielding per load"),
            along("damping", "N s/m2", "damping"),
        ),
    )


def losses(prefix: str, mesh_losses: MeshLosses) -> Parts:
    """Means, their band by Eyring's stress, and what stands at each contact."""
    yield from heat.losses(mesh_losses)


def trajectory(prefix: str, motion: dynamics.Trajectory) -> Parts:
    """A motion over time."""
    yield of_record(prefix, motion, ("tau", "x", "v"))
    yield of_quantities(prefix, (_freedoms(motion.states),))


def orbit(prefix: str, motion: dynamics.Orbit) -> Parts:
    """One turn of a periodic motion."""
    from dynamics import trajectory as turn

    yield from trajectory(prefix, turn(motion.oscillator, motion.state, periods=motion.periods))


def _freedoms(states: Array) -> Quantity:
    return figure_of("freedoms", "1", "coordinates of the motion", "", np.shape(states)[-1] // 2)


def sweep(prefix: str, swept: dynamics.SweepResult) -> Parts:
    """States and labels of a sweep in one direction."""
    way, across = swept.direction, swept.parameter.replace("_", " ")
    yield of_quantities(
        prefix,
        (
            figure_of("frequency", "1", across, "frequency", swept.values),
            figure_of(way, "1", "states at tau = 0", "frequency kept coordinate", swept.states),
            figure_of(f"{way}_label", "", "motion n-p-q", "frequency", swept.labels),
        ),
    )


def attractors(prefix: str, sweeps: dynamics.MultiSweep) -> Parts:
    """Every state of every attractor that sweeps met."""
    met = [motion for motions in sweeps.motions for motion in motions]
    counts = [len(motion.states) for motion in met]
    heights = [np.empty(0), *(motion.states[:, 0] for motion in met)]
    columns = (
        ("value", sweeps.parameter.replace("_", " "), [motion.value for motion in met]),
        ("periods", "periods of the motion; 0 where it does not repeat", [motion.periods for motion in met]),
    )
    yield of_quantities(
        prefix,
        (
            *(figure_of(name, "1", text, "point", np.repeat(held, counts)) for name, text, held in columns),
            figure_of("displacement", "1", "displacement X", "point", np.concatenate(heights)),
        ),
    )


def basins(prefix: str, basin_map: dynamics.BasinResult) -> Parts:
    """A map of basins with its attractors."""
    yield of_record(prefix, basin_map)
    if basin_map.attractors:
        yield of_list(prefix, "attractor", basin_map.attractors)
        yield of_quantities(prefix, (_freedoms(basin_map.attractors[0].states),))


def locus(prefix: str, curve: Any) -> Parts:
    """A curve of special points."""
    yield of_record(prefix, curve, ("kind", "parameters", "values"))


def run_up(prefix: str, run: dynamics.RunUp) -> Parts:
    """Blocks of a run-up, or of a coast-down, by its direction."""
    names = ("frequency", "rms", "peak", "force_peak", "separated")
    renamed = {f"{prefix}_{name}": f"{prefix}_{name}_{run.direction}" for name in names}
    yield of_record(prefix, run, names).rename(renamed)


def diagram(prefix: str, whole: dynamics.Diagram) -> Parts:
    """Points of all branches, further points of orbits of several periods, and special points."""
    from dynamics.attraction.returns import returns  # which loads all of branches

    rows = (row[:5] for row in whole.table())
    return diagram_tables(whole.columns(), returns(whole), rows, across=whole.parameter.replace("_", " "))


def branch(prefix: str, curve: dynamics.Branch) -> Parts:
    """A branch is a diagram of this branch alone; one that was put together shows its states."""
    from dynamics import Diagram

    if curve.oscillator is not None:
        whole = Diagram(
            oscillator=curve.oscillator,
            parameter=curve.parameter,
            bounds=(float(curve.values.min()), float(curve.values.max())),
            branches=(curve,),
            origins=(),
            left_out=(),
            unsure=(),
            error=curve.error,
            cost=curve.cost,
            converged=curve.converged,
            message=curve.message,
        )
        return diagram(prefix, whole)
    points = np.column_stack([np.zeros(len(curve.values)), curve.values, curve.states[:, :2], curve.stable])
    rows = ((0, p.kind, p.parameter, p.label, float(p.state[0])) for p in curve.points)
    return diagram_tables(points, np.empty((0, 6)), rows, across=curve.parameter.replace("_", " "))


def speed_diagram(prefix: str, whole: Any) -> Parts:
    """All tables of a diagram over the speed."""
    yield from branch_tables(whole)


def series_of(prefix: str, oscillator: PairOscillator) -> Parts:
    """The stiffness that drives an oscillator."""
    yield from series(prefix, oscillator.series)
