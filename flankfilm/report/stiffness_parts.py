"""Sections of the report about stiffness, load share, transmission error, and the reference of the deflection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.coupling.mesh.references import MEANINGS, PARTS, RELATIVE, relative_to
from flankfilm.figures.reading import PER_FACE, Pictures, read_figure, unit_text
from flankfilm.output.uncertainty import uncertainty
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import SMALLEST, alike, number, of_both, percent

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import xarray as xr

    import fem
    from flankfilm.coupling import MeshCycle, SinglePairs, StiffnessReferences
    from gears.closed_form import Iso6336ContactStress

EXPLAINED = {"body": "reference_body", "bore": "reference_bore", "teeth": "reference_teeth"}
"""Texts that explain the reference of deflections."""

LISTED = 6
"""Harmonics in the table of a mesh cycle."""

PICTURES: Pictures = {
    "mesh_stiffness": "dry_secant_stiffness",
    "load_share": "dry_load_share",
    "transmission_error": "dry_transmission_error",
}

SINGLE_PAIRS: Pictures = {"single_pairs": "single_pair_rho1"}


def stiffness(
    single: SinglePairs | None,
    loaded: fem.MeshCycle | None,
    cycles: Sequence[MeshCycle],
    changes: Sequence[str],
    face_width: float,
    results: xr.Dataset,
) -> Part:
    """Stiffness of all models on one axis, load share and transmission error.

    Parameters
    ----------
    single : SinglePairs or None
    loaded : fem.MeshCycle or None
        Loaded contact without film, whose Hertz pressure stands beside ISO's; as in the head of the page.
    cycles : sequence of MeshCycle
        Of all models; the first one gives the figures of the report.
    changes : sequence of str
        Notes about decisions and about the changes by the film.
    face_width : float
        [m]
    results : xarray.Dataset
    """
    tables = [_cycles(cycles, face_width), _harmonics(cycles[0])]
    if single is not None:
        tables += [iso_table(single.iso), contact_table(single.contact, loaded)]
    drawn = pictures(results, {**PICTURES, **SINGLE_PAIRS}, model=cycles[0].label)
    notes = (said(EXPLAINED[cycles[0].reference]), *changes, said("closed_forms"))
    return Part("stiffness", "Mesh stiffness", figures=drawn, tables=tuple(tables), notes=notes)


def _cycles(cycles: Sequence[MeshCycle], face_width: float) -> Table:
    """Means, range and error of each model's mesh cycle."""

    def shown(name: str, width: float | None = None) -> dict[str, Callable[[MeshCycle], str]]:
        head = read_figure(cycles[0], name, width).label

        def cell(cycle: MeshCycle) -> str:
            value, error = float(read_figure(cycle, name, width).values), cycle.errors[name]
            return number(value, 5) if error is None else f"{number(value, 5)} ± {percent(error)}"

        return {head: cell}

    def ends(cycle: MeshCycle) -> str:
        least, most = (
            float(read_figure(cycle, f"{which}_secant_stiffness", face_width).values)
            for which in ("least", "greatest")
        )
        return f"{least:.4g} to {most:.4g}"

    return Table.of(
        cycles,
        {
            "model": lambda cycle: f"{cycle.label}, {RELATIVE[cycle.reference]}",
            **shown("mean_secant_stiffness", face_width),
            f"secant from, to [{unit_text(PER_FACE)}]": ends,
            **shown("mean_stiffness", face_width),
            **shown("transmission_error_range"),
            "model error of secant, tangent, transmission error": _models,
        },
        "± is the numerical error, where it is known.",
    )


def _models(cycle: MeshCycle) -> str:
    """Model errors of the means and of the transmission error, as the page's head shows them."""
    names = ("mean_secant_stiffness", "mean_stiffness", "transmission_error_range")
    known = [uncertainty(cycle, name).model for name in names]
    return "not estimated" if None in known else ", ".join(map(percent, known))


def references(by_reference: StiffnessReferences, face_width: float) -> Part:
    """Mean stiffness for each reference of the deflection, beside ISO 6336-1, and parts of the deflection."""
    tangent, secant, iso = (
        read_figure(by_reference, name, face_width)
        for name in ("mean_stiffness", "mean_secant_stiffness", "iso_mesh_stiffness")
    )
    means = [
        (f"{name}: {MEANINGS[name]}", number(s, 5), number(k, 5), percent(error))
        for name, k, s, error in zip(
            by_reference.reference, tangent.values, secant.values, by_reference.mean_error, strict=True
        )
    ]
    means.append(("c_gamma of ISO 6336-1", "", number(float(iso.values), 5), "unknown"))
    of_hubs = by_reference.deflection["hub_windup"]
    whole = sum(by_reference.deflection.values()) - of_hubs
    parts = [
        # what rounding leaves of a part is none
        (
            PARTS[name],
            *(
                ("0", "0 %")
                if abs(part) < SMALLEST * whole
                else (number(1e6 * part, 4), percent(part / whole))
            ),
        )
        for name, part in by_reference.deflection.items()
    ]
    parts.insert(-1, ("total, relative to the bodies", number(1e6 * whole, 4), percent(1.0)))
    parts.append(
        ("total, relative to the bores", number(1e6 * (whole + of_hubs), 4), percent(1.0 + of_hubs / whole))
    )
    heads = ("deflection relative to", f"secant [{secant.unit}]", f"tangent [{tangent.unit}]", "error")
    tables = (
        Table(heads, tuple(means)),
        Table(("mean deflection, without film", "µm", "of that relative to the bodies"), tuple(parts)),
    )
    title = "Reference of the deflection"
    return Part("references", title, tables=tables, notes=(said("references"),))


def _harmonics(cycle: MeshCycle) -> Table:
    """First harmonics of the cycle of the report, with their errors in the unit of each."""
    names = ("secant_stiffness_harmonics", "stiffness_harmonics", "transmission_error_harmonics")
    heads, columns = ["harmonic"], [[str(order) for order in range(1, LISTED + 1)]]
    for name in names:
        values, errors = read_figure(cycle, name), getattr(cycle, f"{name}_error")
        heads += [values.label, "±"]
        columns.append([number(amplitude, 4) for amplitude in values.values[:LISTED].tolist()])
        scale = values.values[0] / getattr(cycle, name)[0]
        columns.append(["unknown"] * LISTED if errors is None else alike(scale * errors[:LISTED]))
    return Table(tuple(heads), tuple(zip(*columns, strict=True)), f"Harmonics of the mesh: {cycle.label}.")


def iso_table(iso: Any, *, along_face: bool = False) -> Table:
    """Mean stiffnesses by ISO 6336-1, with that along the face where it is asked for."""
    rows = (
        ("theoretical single stiffness c'th", number(iso.c_th, 5)),
        ("single stiffness c'", number(iso.c_prime, 5)),
        ("mesh stiffness c_gamma", number(iso.c_gamma, 5)),
        *(
            (("mesh stiffness along the face c_gamma_beta", number(iso.c_gamma_beta, 5)),)
            if along_face
            else ()
        ),
    )
    return Table(("ISO 6336-1", "N/(mm µm)"), rows)


def contact_table(contact: Iso6336ContactStress, loaded: fem.MeshCycle | None) -> Table:
    """Nominal contact stress of both gears by ISO 6336-2, and the maximum Hertz pressure by finite elements."""
    common = ("Z_H", "Z_E", "Z_eps", *(("Z_beta",) if contact.Z_beta != 1.0 else ()))
    rows: list[tuple[str, ...]] = []
    for name in common:
        figure = read_figure(contact, name)
        rows.append((figure.label, *(number(float(figure.values), 5),) * 2))
    factors = (contact.Z_B, contact.Z_D)
    rows.append(
        (
            "single pair tooth contact factors Z_B and Z_D",
            *(number(coefficient, 5) for coefficient in factors),
        )
    )
    for name in ("stresses", "single_pair_stresses"):
        figure = read_figure(contact, name)
        rows.append((figure.label, *(number(stress, 5) for stress in figure.values.tolist())))
    heads = ("ISO 6336-2, whole force, all factors K = 1", "pinion", "wheel")
    if loaded is None:
        return Table(heads, tuple(rows))
    pressure = read_figure(loaded, "hertz_pressure")
    greatest = number(float(np.nanmax(pressure.values)), 4)
    rows.append((pressure.named("finite elements, maximum Hertz pressure"), greatest, greatest))
    caption = "Contact stress. Finite elements: at the positions computed, without tip edges, error unknown."
    return Table(heads, tuple(rows), caption)


def headlines(cycle: MeshCycle, face_width: float) -> list[Headline]:
    """Numbers for the page's head."""
    secant, tangent = (read_figure(cycle, n, face_width) for n in ("mean_secant_stiffness", "mean_stiffness"))
    error = read_figure(cycle, "transmission_error_range")
    figures = ((secant, ".4g", cycle.label), (tangent, ".4g", "for small vibration"))
    shown = [
        (
            relative_to(reading.meaning, cycle.reference),
            format(float(reading.values), digits),
            note,
            reading.unit,
        )
        for reading, digits, note in figures
    ]
    lag = relative_to("loaded transmission error", cycle.reference)
    shown.append((lag, f"{float(error.values):.3g}", "peak to peak", error.unit))
    names = ("mean_secant_stiffness", "mean_stiffness", "transmission_error_range")
    return [Headline(*cells, uncertainty(cycle, name)) for cells, name in zip(shown, names, strict=True)]


def pressure_headlines(loaded: fem.MeshCycle, single: SinglePairs | None) -> list[Headline]:
    """Maximum Hertz pressure of two flanks beside the nominal contact stresses of ISO 6336-2."""
    pressure = read_figure(loaded, "hertz_pressure")
    if not np.isfinite(pressure.values).any():
        return []
    # near the base circle of a pinion pressures are far above that at the pitch point, which ISO has
    place = float(loaded.rho1.flat[int(np.nanargmax(loaded.hertz_pressure))] - loaded.pair.points.A)
    note = f"{1e3 * place:.3g} mm after A, at the positions computed, without tip edges, error unknown"
    if single is not None:
        note += f"; ISO 6336-2 nominal {of_both(single.contact.stresses)}"
    greatest = number(float(np.nanmax(pressure.values)), 4)
    return [Headline("maximum Hertz pressure", greatest, note, pressure.unit)]
