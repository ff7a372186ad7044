"""Section of the report about friction, losses and temperatures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ehl.discrete.regimes import MEASURED, regime
from flankfilm.building.heat import shearing_oil, warmth
from flankfilm.figures.reading import Pictures, read_figure
from flankfilm.output.uncertainty import Uncertainty, uncertainty
from flankfilm.report.film_parts import LEAST_WITH_HEAT, regime_said
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent, plain
from flankfilm.scene.sections.key import ZERO_CELSIUS

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import MeshLosses
    from flankfilm.scene import Scene

PICTURES: Pictures = {
    "losses_along_path": "losses_path_friction_coefficient",
    "temperatures_along_path": "losses_path_surface_temperature_rise",
    "temperature_field": "hot_contact_temperature",
}


def losses(mesh_losses: MeshLosses, results: xr.Dataset, scene: Scene) -> Part:
    """Losses with their band, temperatures along the path and in the hottest contact."""
    film = " beside the isothermal one" if "film_rho1" in results else ""
    rho1 = mesh_losses.path.rho1[int(np.argmax(mesh_losses.path.oil_temperature_rise))]
    drawn = pictures(results, PICTURES, beside=film, rho1=number(1e3 * rho1))
    return Part(
        "losses",
        "Friction, losses and temperatures",
        (
            _lost(mesh_losses),
            *((said("losses_on_lines"),) if mesh_losses.over_lines is not None else ()),
            _by_stress(mesh_losses, scene),
            *_rubbing(mesh_losses, scene),
            _warm(mesh_losses, scene),
        ),
        drawn,
        (_band(mesh_losses), *_boundary(mesh_losses), _greatest(mesh_losses)),
        (said("losses_model", supply="starved" if scene.film.starved else "flooded"),),
    )


def headlines(mesh_losses: MeshLosses) -> list[Headline]:
    """Numbers for the page's head."""
    band = " to ".join(number(loss, 3) for loss in np.sort(mesh_losses.band.mesh_loss))
    least, ratio = read_figure(mesh_losses.path, "least_film"), mesh_losses.path.least_film_ratio
    bands = f"{band} W {_BAND}"
    if mesh_losses.boundary is not None:
        low, high = (f"{number(loss, 3)}" for loss in np.sort(mesh_losses.boundary.mesh_loss))
        ends = " to ".join(f"{friction:g}" for friction in mesh_losses.boundary.boundary_friction)
        bands += f", {low} to {high} W for a boundary friction of {ends}"
    hottest = mesh_losses.greatest_contact_temperature - ZERO_CELSIUS
    shown = [
        Headline(
            "power lost in the mesh",
            number(mesh_losses.mesh_loss),
            bands,
            "W",
            uncertainty(mesh_losses, "mesh_loss"),
        ),
        Headline(
            "efficiency of the mesh",
            f"{100 * mesh_losses.efficiency:.3f}",
            unit="%",
            uncertainty=uncertainty(mesh_losses, "efficiency"),
        ),
        Headline(
            "mean coefficient of friction",
            f"{mesh_losses.mean_friction:.4f}",
            uncertainty=uncertainty(mesh_losses, "mean_friction"),
        ),
        Headline(
            "maximum temperature of the flanks",
            f"{hottest:.1f}",
            _bulk(mesh_losses),
            "°C",
            in_kelvin(mesh_losses, "greatest_contact_temperature"),
        ),
        Headline(
            LEAST_WITH_HEAT,
            f"{float(least.values):.3g}",
            "" if ratio is None else regime_said(ratio, with_ratio=True),
            least.unit,
            uncertainty=uncertainty(mesh_losses.path, "least_film"),
        ),
    ]
    if ratio is not None:
        off = uncertainty(mesh_losses.path, "least_film_ratio")
        shown.append(
            Headline(
                "minimum film ratio Lambda with heat", f"{ratio:.3g}", regime_said(ratio), uncertainty=off
            )
        )
    return shown


def in_kelvin(record: object, name: str) -> Uncertainty:
    """Uncertainty of a temperature of a record, or of a rise, shown in K."""
    return replace(uncertainty(record, name), size=float(getattr(record, name)), unit="K")


_BAND = "for Eyring stresses of 5 to 10 MPa"


def _lost(mesh_losses: MeshLosses) -> str:
    parts = [
        f"{number(mesh_losses.sliding_loss, 3)} W by sliding",
        f"{number(mesh_losses.rolling_loss, 3)} W by rolling",
    ]
    if mesh_losses.edge_loss:
        parts.append(f"{number(mesh_losses.edge_loss, 3)} W by tip edges outside the path")
    return said(
        "losses",
        loss=number(mesh_losses.mesh_loss),
        power=number(1e-3 * mesh_losses.input_power),
        part=percent(mesh_losses.mesh_loss / mesh_losses.input_power, 3),
        parts=", ".join(parts),
    )


def _by_stress(mesh_losses: MeshLosses, scene: Scene) -> str:
    """Losses over the range of the Eyring stress."""
    stress = shearing_oil(scene).eyring_stress
    assert stress is not None
    low, high = np.sort(mesh_losses.band.mesh_loss)
    unsaid = scene.lubricant is not None and scene.lubricant.eyring_stress_MPa is None
    source = "the scene gives none" if unsaid else "as the scene gives it"
    return said(
        "losses_band", stress=number(1e-6 * stress), given=source, low=number(low, 3), high=number(high, 3)
    )


def _rubbing(mesh_losses: MeshLosses, scene: Scene) -> Iterator[str]:
    """Losses over the range of the boundary friction, and the regime; nothing for smooth flanks."""
    band, ratio = mesh_losses.boundary, mesh_losses.path.least_film_ratio
    if band is None or ratio is None or scene.roughness is None:
        return
    low, high = np.sort(band.mesh_loss)
    yield said(
        "losses_boundary",
        ratio=number(ratio, 3),
        regime=regime(ratio),
        measured=MEASURED,
        friction=f"{scene.roughness.boundary_friction:g}",
        part=percent(band.loss_part),
        first=f"{band.boundary_friction[0]:g}",
        second=f"{band.boundary_friction[1]:g}",
        low=number(low, 3),
        high=number(high, 3),
    )


def _warm(mesh_losses: MeshLosses, scene: Scene) -> str:
    """Temperatures of the flanks and where they come from."""
    known = warmth(scene)
    if known.transfer is None:
        stated = scene.heat is not None and scene.heat.given_keys(
            "pinion_temperature_C", "wheel_temperature_C"
        )
        source = "as [heat] gives them" if stated else "as warm as the oil"
    else:
        first, second = (number(flow, 3) for flow in mesh_losses.heat)
        source = f"at which they give off the losses, {first} and {second} W"
    return said("losses_warm", bulk=_bulk(mesh_losses), source=source, rise=_rise(mesh_losses))


def _bulk(mesh_losses: MeshLosses) -> str:
    first, second = mesh_losses.bulk_temperatures - ZERO_CELSIUS
    return f"bulk {first:.1f} and {second:.1f} °C"


def _rise(mesh_losses: MeshLosses) -> str:
    path = mesh_losses.path
    gear = int(np.argmax(path.greatest_flank_rise))
    flank = float(path.greatest_flank_rise[gear])
    oil_off = float(path.greatest_oil_rise * path.greatest_oil_rise_error)
    flank_off = float(flank * path.greatest_flank_rise_error[gear])
    return (
        f"{path.greatest_oil_rise:.1f} K in the oil (± {plain(oil_off)} K) and {flank:.1f} K on the flanks "
        f"(± {plain(flank_off)} K)"
    )


def _band(mesh_losses: MeshLosses) -> Table:
    """Means at the ends of the band."""
    band = mesh_losses.band
    rows = tuple(
        (
            number(1e-6 * band.eyring_stress[k]),
            f"{band.mean_friction[k]:.4f}",
            number(band.sliding_loss[k]),
            number(band.rolling_loss[k]),
            number(band.mesh_loss[k]),
            f"{100 * band.efficiency[k]:.3f}",
            percent(float(band.end_error[k])),
        )
        for k in range(band.eyring_stress.size)
    )
    heads = (
        "Eyring stress [MPa]",
        "mean friction [-]",
        "sliding [W]",
        "rolling [W]",
        "total [W]",
        "efficiency [%]",
        "numerical error of the losses",
    )
    return Table(heads, rows, "Means over the path.")


def _boundary(mesh_losses: MeshLosses) -> list[Table]:
    """Means at the ends of the band of the boundary friction; none for smooth flanks."""
    band = mesh_losses.boundary
    if band is None:
        return []
    heads = ("boundary friction [-]", "mean friction [-]", "sliding [W]", "total [W]", "efficiency [%]")
    columns = (
        [f"{friction:g}" for friction in band.boundary_friction],
        [f"{friction:.4f}" for friction in band.mean_friction],
        list(map(number, band.sliding_loss)),
        list(map(number, band.mesh_loss)),
        [f"{100 * efficiency:.3f}" for efficiency in band.efficiency],
    )
    caption = "Means over the path; films, load share and temperatures are unchanged."
    return [Table(heads, tuple(zip(*columns, strict=True)), caption)]


def _greatest(mesh_losses: MeshLosses) -> Table:
    """Maximum values along the path, and the loss factor."""
    return Table(("along the path", "value"), tuple(_rows(mesh_losses)))


def _rows(mesh_losses: MeshLosses) -> Iterator[tuple[str, str]]:
    path = mesh_losses.path
    yield "maximum oil temperature above the flanks' bulk", f"{path.oil_temperature_rise.max():.1f} K"
    for gear, rise in zip(("pinion", "wheel"), path.surface_temperature_rise, strict=True):
        yield f"maximum rise of the {gear}'s flank", f"{rise.max():.1f} K"
    yield (
        "maximum flash temperature after Blok, with the same friction",
        f"{path.flash_temperature.max():.1f} K",
    )
    slides = 1e-9 * mesh_losses.path.greatest_pressure_times_sliding
    yield "maximum Hertz pressure times sliding speed", f"{slides:.3g} GPa m/s"
    if path.film_ratio is not None:
        yield "minimum film ratio Lambda with heat", f"{path.film_ratio.min():.3g}"
    yield "tooth loss factor H_V of the forces", f"{mesh_losses.loss_factor:.4f}"
    if mesh_losses.ohlendorf_loss_factor is not None:
        yield "H_V after Ohlendorf, equal load of both pairs", f"{mesh_losses.ohlendorf_loss_factor:.4f}"
    yield "residual of the energy balance, maximum", percent(float(np.max(np.abs(path.closure))))
