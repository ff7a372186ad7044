"""What a run writes as data: one netCDF file with everything, one CSV for each curve."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from base.units import factor
from flankfilm.build import pinion_speed
from flankfilm.dataset import Quantity, provenance, to_dataset, write_csv, write_netcdf
from flankfilm.diagram_outputs import diagram_quantities, diagram_tables
from flankfilm.load_outputs import load_outputs
from flankfilm.picture_outputs import picture_quantities
from flankfilm.stages.decisions import decisions

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import FilmAlongPath, MeshCycle, MeshSeries, SinglePairs, SpeedSweep
    from flankfilm.scene import Scene

Array = NDArray[np.float64]


def cycle_quantities(cycle: MeshCycle, prefix: str) -> dict[str, Quantity]:
    """Variables of a mesh cycle; `prefix` tells dry from lubricated."""
    along, each = (f"{prefix}_position",), (f"{prefix}_position", f"{prefix}_pair")
    said = "with the oil film" if prefix == "lubricated" else "without film"
    return {
        f"{prefix}_phase": Quantity(
            along, cycle.position, "1", "travel after a pair is at A, over the base pitch"
        ),
        f"{prefix}_secant_stiffness": Quantity(
            along, cycle.secant_stiffness, "N/m", f"force over deflection, {said}"
        ),
        f"{prefix}_tangent_stiffness": Quantity(
            along, cycle.stiffness, "N/m", f"slope of force over deflection, {said}"
        ),
        f"{prefix}_transmission_error": Quantity(along, cycle.transmission_error, "m", f"deflection, {said}"),
        f"{prefix}_rho1": Quantity(
            each, cycle.rho1, "m", "curvature radius of the pinion's flank at the contact"
        ),
        f"{prefix}_force": Quantity(each, cycle.forces, "N", f"normal force of each pair, {said}"),
        f"{prefix}_load_share": Quantity(each, cycle.load_share, "1", f"share of the force, {said}"),
    }


def single_pair_quantities(single: SinglePairs) -> dict[str, Quantity]:
    """Variables of the closed forms."""
    curves = {
        f"single_pair_{name}": Quantity(("path",), k, "N/m", f"stiffness of one pair: {label}")
        for (label, k), name in zip(single.curves.items(), _identifiers(single.curves), strict=True)
    }
    return {
        "path_rho1": Quantity(("path",), single.rho1, "m", "curvature radius of the pinion's flank"),
        **curves,
    }


def film_quantities(film: FilmAlongPath) -> dict[str, Quantity]:
    """Variables of the film along the path."""
    along = ("film_point",)
    stiffness = {
        f"film_stiffness_{name.replace('-', '_')}": Quantity(
            along, k, "N/m", f"film stiffness by {name}, whole face"
        )
        for name, k in film.stiffness.items()
    }
    return {
        "film_rho1": Quantity(along, film.rho1, "m", "curvature radius of the pinion's flank at the film"),
        "film_load": Quantity(along, film.load, "N/m", "force per length of face"),
        "film_central_thickness": Quantity(along, film.central_thickness, "m", "film on the line of centres"),
        "film_minimum_thickness": Quantity(along, film.minimum_thickness, "m", "least film"),
        "film_hertz_pressure": Quantity(along, film.hertz_pressure, "Pa", "peak pressure of the dry contact"),
        **stiffness,
        **{name: Quantity(along, values, unit, told) for name, values, unit, told in _held(film)},
    }


def _held(film: FilmAlongPath) -> list[tuple[str, Array, str, str]]:
    """Name, values, unit and meaning of what only solved, starved or mixed films have."""
    share = "share of the load that the asperities carry"
    every = (
        ("film_inlet", film.inlet, "1", "where oil fills the gap, in half-widths ahead of the middle"),
        ("film_oil_layer", film.flow, "m", "layer of oil at ambient pressure that passes the contact"),
        ("film_starvation", film.starvation, "1", "central film over that of the smooth, flooded contact"),
        ("film_ratio", film.film_ratio, "1", "Lambda, least distance of the mean planes over sigma"),
        ("film_asperity_share", film.asperity_share, "1", share),
    )
    return [(name, values, unit, told) for name, values, unit, told in every if values is not None]


def sweep_quantities(sweep: SpeedSweep) -> dict[str, Quantity]:
    """Variables of the sweeps; labels are text."""
    found = {"sweep_frequency": Quantity(("sweep",), sweep.frequency, "1", "mesh over natural frequency")}
    found["contact_grazing_frequency"] = Quantity(
        ("grazing",), sweep.grazings, "1", "where the orbit that never leaves contact touches the backlash"
    )
    if sweep.speed is not None:
        found["sweep_speed_rpm"] = Quantity(("sweep",), sweep.speed / factor("rpm"), "rpm", "pinion speed")
    for direction, states in sweep.states.items():
        dims = ("sweep", "kept", "state")
        found[f"sweep_{direction}"] = Quantity(
            dims, states, "1", f"displacement and velocity at tau = 0, {direction}"
        )
        labels = np.asarray(sweep.labels[direction], dtype="U24")
        found[f"sweep_{direction}_label"] = Quantity(("sweep",), labels, "1", f"motion n-p-q, {direction}")
    return found


def fourier_quantities(fourier: MeshSeries) -> dict[str, Quantity]:
    """Variables of the Fourier series."""
    series = fourier.stiffness
    along = ("harmonic",)
    unit = "1" if fourier.kind == "given" and series.mean == 1.0 else "N/m"
    return {
        "fourier_mean": Quantity((), series.mean, unit, f"mean of the {fourier.kind} stiffness"),
        "fourier_amplitude": Quantity(
            along, series.amplitudes, unit, "amplitude of cos(j omega tau + phase)"
        ),
        "fourier_phase": Quantity(along, series.phases, "rad", "phase; tau = 0 when a pair is at A"),
    }


def results_dataset(scene: Scene, values: Mapping[str, Any]) -> xr.Dataset:
    """Give everything that a run found as one dataset: what ``results.nc`` holds and figures are drawn from.

    Parameters
    ----------
    scene : Scene
        What was asked for.
    values : mapping
        Stage name to result.
    """
    quantities: dict[str, Quantity] = {}
    if (single := values.get("closed forms")) is not None:
        quantities |= single_pair_quantities(single)
    if (dry := values.get("dry cycle")) is not None:
        quantities |= cycle_quantities(dry, "dry")
    if (film := values.get("film")) is not None:
        quantities |= cycle_quantities(film, "lubricated") | film_quantities(film.film)
    for found, _ in load_outputs(values, speed=_speed(scene)):
        quantities |= found
    if (fourier := values.get("fourier")) is not None:
        quantities |= fourier_quantities(fourier)
    if (sweep := values.get("sweep")) is not None:
        quantities |= sweep_quantities(sweep)
    if (diagram := values.get("diagram")) is not None:
        quantities |= diagram_quantities(diagram)
    quantities |= picture_quantities(values, _speed(scene))
    decided = {"decisions_json": json.dumps([decision.plain() for decision in decisions(values)])}
    return to_dataset(quantities, {"title": scene.title, **decided, **provenance(scene.model_dump_json())})


def results_tables(scene: Scene, values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Columns of the CSV files by name: one table for each curve."""
    tables: dict[str, dict[str, Any]] = {}
    if (single := values.get("closed forms")) is not None:
        tables["single_pair_stiffness"] = {"travel_from_A_mm": 1e3 * single.travel} | {
            f"{name}_N_per_m": k
            for name, k in zip(_identifiers(single.curves), single.curves.values(), strict=True)
        }
    if (dry := values.get("dry cycle")) is not None:
        tables["mesh_cycle_dry"] = _cycle_columns(dry)
    for _, more in load_outputs(values, speed=_speed(scene)):
        tables |= more
    if (film := values.get("film")) is not None:
        tables["mesh_cycle_lubricated"] = _cycle_columns(film)
        tables["film_along_path"] = _film_columns(film.film)
    if (sweep := values.get("sweep")) is not None:
        for direction, states in sweep.states.items():
            tables[f"sweep_{direction}"] = _sweep_columns(sweep, direction, states)
    if (diagram := values.get("diagram")) is not None:
        tables |= diagram_tables(diagram)
    return tables


def write_data(folder: Path, dataset: xr.Dataset, tables: Mapping[str, Mapping[str, Any]]) -> list[Path]:
    """Write ``results.nc`` and the CSV files; return what was written."""
    write_netcdf(folder / "results.nc", dataset)
    for name, columns in tables.items():
        write_csv(folder / "csv" / f"{name}.csv", columns)
    return [folder / "results.nc", *(folder / "csv" / f"{name}.csv" for name in tables)]


def _film_columns(film: FilmAlongPath) -> dict[str, Any]:
    return {
        "rho1_mm": 1e3 * film.rho1,
        "load_N_per_mm": 1e-3 * film.load,
        "central_film_um": 1e6 * film.central_thickness,
        "minimum_film_um": 1e6 * film.minimum_thickness,
        "hertz_pressure_GPa": 1e-9 * film.hertz_pressure,
        **{f"stiffness_{n.replace('-', '_')}_N_per_m": k for n, k in film.stiffness.items()},
        **{_column(name, unit): values for name, values, unit, _ in _held(film)},
    }


def _column(name: str, unit: str) -> str:
    """Name of a CSV column from that of a variable, with its unit."""
    return name if unit == "1" else f"{name}_{unit}"


def _speed(scene: Scene) -> float | None:
    """Pinion speed [rad/s], where the scene has one."""
    operating = scene.operating
    if operating is None or operating.pinion_speed_rpm is None:
        return None
    return pinion_speed(scene)


def _cycle_columns(cycle: MeshCycle) -> dict[str, Any]:
    shares = {f"load_share_pair_{j + 1}": cycle.load_share[:, j] for j in range(cycle.forces.shape[1])}
    return {
        "phase": cycle.position,
        "secant_stiffness_N_per_m": cycle.secant_stiffness,
        "tangent_stiffness_N_per_m": cycle.stiffness,
        "transmission_error_um": 1e6 * cycle.transmission_error,
        **shares,
    }


def _sweep_columns(sweep: SpeedSweep, direction: str, states: Any) -> dict[str, Any]:
    kept = states.shape[1]
    speed = {} if sweep.speed is None else {"speed_rpm": np.repeat(sweep.speed / factor("rpm"), kept)}
    return {
        **speed,
        "frequency": np.repeat(sweep.frequency, kept),
        "displacement": states[:, :, 0].ravel(),
        "velocity": states[:, :, 1].ravel(),
        "motion": np.repeat(np.asarray(sweep.labels[direction]), kept),
    }


def _identifiers(labels: Mapping[str, Any]) -> list[str]:
    return ["".join(c if c.isalnum() else "_" for c in label.lower()).replace("__", "_") for label in labels]
