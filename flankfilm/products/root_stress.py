"""Root stress of both gears over the mesh cycle and along the face, beside ISO 6336-3."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from operator import attrgetter
from typing import TYPE_CHECKING

import fem
from base import Figure
from base.results import figures
from fem.pair.face_setting import FREE_ENDS
from flankfilm import coupling
from flankfilm.building.face import face, varies_by
from flankfilm.building.pair import gear_pair
from flankfilm.figures.reading import GEARS, Pictures, read_figure
from flankfilm.output.model_errors import entry
from flankfilm.output.passages import fillet_stress, passage
from flankfilm.output.uncertainty import Uncertainty, uncertainty
from flankfilm.output.variables import joined, of_list, of_quantities, of_record
from flankfilm.products.output import (
    Named,
    Of,
    Take,
    figure_of_kind,
    in_result,
    model_error_of,
    output_of,
)
from flankfilm.products.product import CurveTable, Product, ranked, section_of, wanting, when
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.run_parts import Work
from flankfilm.report.standards_parts import root_table
from flankfilm.report.text import counted, number, of_both, percent, plus_minus
from flankfilm.scene.plain_gears import held_on_hubs, plain_flanks
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import MESH, PAIR, loaded_contact

if TYPE_CHECKING:
    import xarray as xr

    from fem.stress.root_peaks import RootPeak
    from flankfilm.scene.schema import Scene

EVEN = "{}; nan where the load is even along the face"

WHERE = "not estimated: stresses are flat at their maximum, which has an error"
"""Why the place of a maximum has no error."""

PICTURES: Pictures = {"root_stress": "root_pinion_tension", "root_face_map": "root_face_pinion_tension"}


@stage(
    "fillets",
    "root stress per load by finite elements",
    "pair material heat stiffness.plane tolerance",
    kept="gears meshes fem",
    by_parts=True,
    of=plain_flanks,
)
def FILLETS(run: Engine) -> fem.Fillets | fem.LineFillets:
    """What loads anywhere on the flanks do to the fillets."""
    scene = run.scene
    return coupling.fillets_of(
        gear_pair(held_on_hubs(plain_flanks(scene))), scene.tolerance, scene.stiffness.plane, run.parts
    )


@stage(
    "fillets along the face",
    "root stress per load along the face",
    "alignment",
    FILLETS,
    PAIR,
    kept="gears meshes fem",
    by_parts=True,
)
def FACE_FILLETS(run: Engine) -> fem.FaceFillets:
    """What loads that vary along the face do to the fillets."""
    model, fillets = face(run.scene).get("face_model", FREE_ENDS), run[FILLETS]
    assert isinstance(fillets, fem.Fillets)  # those of a helical pair know the face
    return coupling.fillets_over_face(fillets, run[PAIR], model, run.parts)


@stage("root stress", "root stress over the mesh cycle", "", MESH, FILLETS, PAIR, FACE_FILLETS)
def ROOT_STRESS(run: Engine) -> coupling.RootStresses:
    """Stress at the fillets with the forces of the mesh cycle, with the film where there is one."""
    if varies_by(run.scene) and not _across(run.scene):
        _ = run[FACE_FILLETS]  # root stresses find them in the process
    return coupling.root_stresses(run[PAIR], loaded_contact(run), run[FILLETS])


def _across(scene: Scene) -> bool:
    """Whether lines of contact cross the face."""
    return scene.pair is not None and scene.pair.helical


def variables(roots: coupling.RootStresses) -> Iterator[xr.Dataset]:
    """Root stress of a passing tooth and along the fillets of both gears, and nominal stress."""
    for name in GEARS:
        gear = getattr(roots.stress, name)
        for prefix, quantities in ((f"root_{name}", passage(gear)), (f"fillet_{name}", fillet_stress(gear))):
            stresses = [quantity.name for quantity in quantities if quantity.figure.unit == "Pa"]
            data = of_quantities(prefix, quantities, dict.fromkeys(stresses, roots.stress.error))
            known = entry(gear, "greatest_tension_Pa")
            error = None if known is None else known.of(gear)
            if known is not None and error is not None:
                for name_of in stresses:
                    about = {"model_error": error, "model_error_source": known.source}
                    data[joined(prefix, name_of)].attrs.update(about)
            yield data
        if gear.face is not None:
            yield of_record(f"root_face_{name}", gear.face)
    if roots.iso_face is not None:
        yield of_record("iso6336_face", roots.iso_face)
    if roots.iso is not None:
        yield of_record("iso6336_3", roots.iso)
        yield of_list("iso6336_3", "gear", roots.iso.sections)


def section(stage: coupling.RootStresses, results: xr.Dataset) -> Part:
    """Stress at the roots by finite elements, beside ISO 6336-3."""
    peaks = [
        (f"{name}, maximum {kind}", getattr(gear, f"greatest_{kind}"), gear.errors[f"greatest_{kind}_Pa"])
        for name, gear in (("pinion", stage.stress.pinion), ("wheel", stage.stress.wheel))
        for kind in ("tension", "compression")
    ]
    columns: dict[str, Callable[[tuple[str, RootPeak, float]], str]] = {
        "": lambda row: row[0],
        "principal [MPa]": lambda row: number(1e-6 * row[1].stress_Pa),
        "numerical error": lambda row: percent(row[2]),
        "von Mises [MPa]": lambda row: number(1e-6 * row[1].von_mises_Pa),
        "at [base pitches after A]": lambda row: f"{row[1].position:.3f}",
        "tangent of the fillet [deg]": lambda row: f"{math.degrees(row[1].tangent_angle):.1f}",
    }
    over_face = stage.stress.pinion.face is not None
    if over_face:
        columns["place on the face [mm]"] = lambda row: number(1e3 * row[1].face_position, 3)
    tables = [Table.of(peaks, columns)]
    if over_face:
        tables.append(_over_face(stage))
    note = f"ISO 6336-3 gives no result: {stage.iso_fault}"
    if stage.iso is not None:
        tables.append(root_table(stage.iso))
        places = "at D for the pinion and at B for the wheel"
        note = said("iso6336_3", where="at the tip" if stage.iso.load_at == "tip" else places)
    drawn = pictures(results, PICTURES)
    notes = (note, *_notes(stage))
    return Part("roots", "Root stress", figures=drawn, tables=tuple(tables), notes=notes)


def _notes(stage: coupling.RootStresses) -> tuple[str, ...]:
    """What is said about the face."""
    if stage.stress.pinion.helical:
        return (said("root_of_lines"),)
    if stage.stress.pinion.face is not None:
        return (said("root_over_face", left_out=stage.iso_left_out),)
    return ()


def _over_face(stage: coupling.RootStresses) -> Table:
    """Stress face-load factors of both gears, beside those of the load by ISO 6336-1."""
    rows = []
    for name, gear in (("pinion", stage.stress.pinion), ("wheel", stage.stress.wheel)):
        if gear.face is not None:
            factor = f"{number(gear.face.face_factor)} {plus_minus(gear.face.tension_error)}"
            rows.append((f"{name}: maximum tension over its mean along the face", factor))
            even = f"{number(gear.face.over_even)} {plus_minus(gear.face.tension_error)}"
            rows.append((f"{name}: maximum tension over that of the same forces spread evenly", even))
    if stage.iso_face is not None:
        iso = stage.iso_face
        rows.append(("ISO 6336-1, method C: K_Hbeta of the load", number(iso.K_Hbeta)))
        rows.append((f"K_Fbeta = K_Hbeta^N_F of the root, N_F = {number(iso.N_F, 3)}", number(iso.K_Fbeta)))
    return Table(("root stress over the face", "value"), tuple(rows))


def headlines(stage: coupling.RootStresses) -> list[Headline]:
    """Maximum stresses of both gears."""
    largest = [read_figure(stage.stress, f"{gear}_tension_Pa") for gear in ("pinion", "wheel")]
    values = " and ".join(f"{float(tension.values):.4g}" for tension in largest)
    note = ""
    if stage.iso is not None:
        note = f"ISO 6336-3 nominal {of_both(stage.iso.stresses)}"
    name = "maximum root stress, pinion and wheel"
    model = [uncertainty(stage.stress, f"{gear}_tension_Pa").model for gear in ("pinion", "wheel")]
    known = max((error for error in model if error is not None), default=None)
    return [Headline(name, values, note, largest[0].unit, Uncertainty(stage.error, known))]


def _of_fillets(value: fem.Fillets | fem.LineFillets, computed: Computed) -> Work:
    unknowns = counted(value.cost.unknowns, "unknown")
    return Work("maximum root stress per load", computed.scene.tolerance, value.error, unknowns)


def _roots() -> Iterator[Named]:
    """Maximum stresses along the fillets."""
    for gear, kind in product(GEARS, ("tension", "compression")):
        meaning = f"maximum {kind} along the fillets of the {gear}"
        about = Figure("Pa", meaning, shown="MPa")
        stress = attrgetter(f"stress.{gear}.greatest_{kind}.stress_Pa")
        yield output_of(
            f"root_{kind}_{gear}",
            about,
            "root-stress",
            in_result(ROOT_STRESS, stress),
            error_output="root_stress_error",
            model_output=f"root_stress_model_error_{gear}",
        )


def _of_root(name: str, about: Figure, value: Take, said: str = EVEN, error: Take | None = None) -> Named:
    """Figure of the root stress over the face."""

    def over_face(take: Take) -> Of:
        return lambda engine: (
            take(engine[ROOT_STRESS]) if varies_by(engine.scene) or _across(engine.scene) else None
        )

    known = None if error is None else over_face(error)
    return output_of(name, about, "root-stress", over_face(value), said, known)


def _of_roots() -> Iterator[Named]:
    """Place of the maximum tension along the face, and the stress face-load factor, of both gears."""
    from fem.stress.root_peaks import RootPeak
    from gears.closed_form import Iso6336FaceLoad

    for gear in GEARS:
        yield _of_root(
            f"root_face_position_{gear}",
            replace(figures(RootPeak)["face_position"], no_error=WHERE),
            attrgetter(f"stress.{gear}.greatest_tension.face_position"),
            f"place along the face of the maximum tension at the root of the {gear}; nan where even",
        )
        yield _of_root(
            f"root_face_factor_{gear}",
            figures(fem.FaceRootStress)["face_factor"],
            attrgetter(f"stress.{gear}.face.face_factor"),
            f"maximum tension at the root of the {gear} over its mean over the face; nan where even",
            partial(_error_of_face, gear, "face_factor"),
        )
        yield _of_root(
            f"root_over_even_{gear}",
            figures(fem.FaceRootStress)["over_even"],
            attrgetter(f"stress.{gear}.face.over_even"),
            f"maximum tension at the root of the {gear} over that of the same forces spread evenly; nan where even",
            partial(_error_of_face, gear, "over_even"),
        )
    about = figure_of_kind(Iso6336FaceLoad, "K_Fbeta")
    yield _of_root(
        "iso_root_face_factor",
        about,
        lambda root_stress: root_stress.iso_face and root_stress.iso_face.K_Fbeta,
    )


def _error_of_face(gear: str, figure: str, roots: coupling.RootStresses) -> float | None:
    """Error of a figure of the root stress over the face of a gear."""
    return uncertainty(getattr(roots.stress, gear).face, figure).numerical


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (
        *_roots(),
        output_of(
            "root_stress_error",
            Figure("1", "largest estimated relative error of the stresses along the fillets"),
            "root-stress",
            in_result(ROOT_STRESS, attrgetter("stress.error")),
        ),
        *_of_roots(),
        *(
            model_error_of(
                f"root_stress_model_error_{gear}",
                f"the stresses along the fillets of the {gear}",
                "root-stress",
                lambda engine: engine[ROOT_STRESS].stress,
                f"{gear}_tension_Pa",
            )
            for gear in GEARS
        ),
    )


PRODUCT = Product(
    name="root-stress",
    goals=wanting("root-stress", ROOT_STRESS),
    variables=when(ROOT_STRESS, variables),
    solved=dict.fromkeys(("root", "fillet", "iso6336_3", "iso6336_face"), ROOT_STRESS),
    tables={
        **{
            f"root_face_{gear}": CurveTable(
                f"root_face_{gear}",
                "cycle_tension",
                ("face_position", "cycle_tension", "cycle_compression"),
            )
            for gear in GEARS
        },
        **{f"root_stress_{gear}": CurveTable(f"root_{gear}", "travel", axis="instant") for gear in GEARS},
        **{f"fillet_stress_{gear}": CurveTable(f"fillet_{gear}", "arc", axis="arc") for gear in GEARS},
    },
    headlines=when(ROOT_STRESS, lambda stage: ranked(headlines(stage), 1)),
    pictures=PICTURES,
    sections=section_of(ROOT_STRESS, section),
    work={FILLETS.name: _of_fillets},
    outputs=outputs,
)
