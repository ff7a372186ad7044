"""Closed forms of stiffness along the path, nominal stress by ISO 6336-2, and both against finite elements."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Set
from dataclasses import replace
from functools import partial
from itertools import product
from operator import methodcaller
from typing import TYPE_CHECKING, Any

import gears
from base import Figure, RangeWarning
from base.results import figures
from flankfilm import coupling
from flankfilm.building.face import even_along_face
from flankfilm.building.pair import pinion_torque
from flankfilm.coupling.mesh.single_pairs import CLOSED_FORMS as FORMS
from flankfilm.figures.reading import PER_FACE
from flankfilm.output.variables import of_list, of_record
from flankfilm.products.output import Named, in_result, output_of
from flankfilm.products.product import CurveTable, Product, section_of, together, when
from flankfilm.report import standards_parts, stiffness_parts
from flankfilm.scene import Scene
from flankfilm.scene.sections.ground import under_keys
from flankfilm.stages.engine import Engine, Stage, stage
from flankfilm.stages.mesh import COMPLIANCE, PAIR, PLAN, TEETH_DECIDED
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling.mesh.verification import Verification


@stage(
    "closed forms",
    "closed forms",
    "operating wants reference bore_inertia",
    PAIR,
    COMPLIANCE,
    settings=TEETH_DECIDED,
)
def CLOSED_FORMS(run: Engine) -> coupling.SinglePairs:
    """Closed forms along the path, beside finite elements where the scene has them anyway."""
    beside = "stiffness" in run.scene.wants and run[PLAN].stiffness.choice == "fem"
    return coupling.single_pairs(
        run[PAIR],
        pinion_torque(run.scene),
        run[COMPLIANCE] if beside else None,
        reference=run.scene.reference or "body",
        bore_inertia=run.scene.bore_inertia,
    )


@stage("standards", "ISO 6336", "operating", PAIR)
def STANDARDS(run: Engine) -> coupling.Standards:
    """ISO 6336, which knows helical pairs."""
    with under_keys(run.scene.pair, "pair"):
        iso = coupling.standards(run[PAIR], pinion_torque(run.scene))
    if iso.root is None:
        warnings.warn(f"ISO 6336-3 gives no result: {iso.root_fault}", RangeWarning, stacklevel=2)
    return iso


@stage(
    "verification",
    "closed forms against finite elements",
    "tip_edges stiffness.moving_contact operating reference bore_inertia",
    COMPLIANCE,
)
def VERIFICATION(run: Engine) -> coupling.Verification:
    """Every closed form beside finite elements, of loads that are even along the face."""
    pair, asked = even_along_face(run[PAIR]), (run.scene.tip_edges, run.scene.stiffness.moving_contact)
    compliance = replace(run[COMPLIANCE], pair=pair)
    return coupling.verification_of(
        pair,
        pinion_torque(run.scene),
        compliance,
        *asked,
        reference=run.scene.reference or "body",
        bore_inertia=run.scene.bore_inertia,
    )


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """Closed forms where they are wanted, and beside a stiffness that is reported; of helical pairs the standard's."""
    beside = wants >= {"report", "stiffness"} and scene.stiffness.model != "given"
    if "closed-forms" in wants or beside:
        yield STANDARDS if scene.pair is not None and scene.pair.helical else CLOSED_FORMS


def _by_standards(iso: coupling.Standards) -> Iterator[xr.Dataset]:
    """Stiffness, contact and root stress by ISO 6336."""
    yield of_record("iso6336_1", iso.stiffness, ("c_th", "c_prime", "c_gamma", "c_gamma_beta", "C_R", "C_B"))
    yield of_record("iso6336_2", iso.contact)
    if iso.root is not None:
        yield of_record("iso6336_3", iso.root)
        yield of_list("iso6336_3", "gear", iso.root.sections)


def _differences() -> Iterator[Named]:
    """Differences of the closed forms' mean mesh stiffness from finite elements held to the path."""
    forms = {**{key.replace("-", "_"): label for key, label in FORMS.items()}, "iso6336": "ISO 6336-1"}
    ends = {"": "held to the path", "_like_for_like": "without hub wind-up and coupling"}
    for (end, reference), (name, model) in product(ends.items(), forms.items()):
        meaning = f"mean mesh stiffness by {model}, difference from finite elements {reference}"
        value = in_result(VERIFICATION, methodcaller("difference", model, reference))
        error = in_result(VERIFICATION, partial(_of_difference, model, reference))
        yield output_of(f"{name}{end}", Figure("1", meaning, shown="%"), "closed-forms", value, error=error)


def _of_difference(model: str, reference: str, verification: Verification) -> float | None:
    """Error of a difference from finite elements relative to itself, by theirs."""
    compared = verification.comparison(model, reference)
    away = compared.difference
    return None if away == 0.0 else (1.0 + away) * compared.reference_error / abs(away)


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (
        output_of(
            "iso_contact_stress",
            Figure("Pa", "nominal contact stress sigma_H0 by ISO 6336-2", shown="MPa", no_error=STANDARD),
            "closed-forms",
            lambda engine: gears.closed_form.iso6336_2(
                engine[PAIR], abs(engine[PAIR].normal_force(pinion_torque(engine.scene)))
            ).stresses[0],
        ),
        output_of(
            "iso_mesh_stiffness",
            Figure("N/m", "mesh stiffness c_gamma_alpha by ISO 6336-1", shown=PER_FACE, no_error=STANDARD),
            "closed-forms",
            lambda engine: (
                gears.closed_form.iso6336(
                    engine[PAIR], abs(engine[PAIR].normal_force(pinion_torque(engine.scene)))
                ).mesh_stiffness
                / engine[PAIR].face_width
            ),
        ),
        output_of(
            "iso_helix_factor",
            figures(gears.closed_form.Iso6336ContactStress)["Z_beta"],
            "closed-forms",
            lambda engine: gears.closed_form.iso6336_2(engine[PAIR], 1.0).Z_beta,
        ),
        *_differences(),
    )


PRODUCT = Product(
    name="closed-forms",
    goals=goals,
    variables=together(
        when(
            CLOSED_FORMS,
            lambda single: (of_record("single_pair", single), of_record("iso6336_2", single.contact)),
        ),
        when(STANDARDS, _by_standards),
    ),
    solved={"single_pair": CLOSED_FORMS, "iso6336_2": CLOSED_FORMS, "iso6336_1": STANDARDS},
    headlines=when(STANDARDS, standards_parts.headlines),
    sections=section_of(STANDARDS, lambda iso, _: standards_parts.section(iso)),
    tables={"single_pair_stiffness": CurveTable("single_pair", "rho1", axis="path")},
    pictures=stiffness_parts.SINGLE_PAIRS,
    outputs=outputs,
)
