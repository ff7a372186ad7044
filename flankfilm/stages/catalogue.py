"""All stages, each from the scene to plain arguments, and which of them the wanted outputs ask for.

What a stage depends on stands with it: sections of the scene, other stages, decisions, packages.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import InputError, SolverError
from flankfilm import coupling
from flankfilm.build import deviations, gear_pair, pinion_speed, pinion_torque, supports, tip_roundings
from flankfilm.build_film import film_model, lubricant
from flankfilm.scene import Scene
from flankfilm.scene.ground import under_keys
from flankfilm.stages import film_choice
from flankfilm.stages.decide import Plan, decide
from flankfilm.stages.engine import Engine, Stage, stage
from flankfilm.stages.plain_gears import held_on_hubs, plain_flanks

if TYPE_CHECKING:
    import fem
    from flankfilm.coupling import (
        LoadedFields,
        LoadedTeeth,
        LubricatedCycle,
        MeshCycle,
        MeshSeries,
        PairOscillator,
        RootStresses,
        SinglePairs,
        SpeedDiagram,
        SpeedSweep,
        TorqueCurves,
        Verification,
    )
    from flankfilm.scene.dynamics import DynamicsSection
    from gears import GearPair


def _sections(*names: str) -> Callable[[Scene], Mapping[str, Any]]:
    """Sections of a scene, or single keys of them, as plain values."""

    def pick(scene: Scene) -> Mapping[str, Any]:
        found = {}
        for name in names:
            section, _, key = name.partition(".")
            value = getattr(scene, section)
            value = getattr(value, key) if key else value
            found[name] = value.model_dump() if hasattr(value, "model_dump") else value
        return found

    return pick


def _decided(what: Callable[[Plan], Mapping[str, Any]]) -> Callable[[Engine], Mapping[str, Any]]:
    """Settings from the plan; a scene with a given stiffness has none."""
    return lambda run: {} if run.scene.stiffness.model == "given" else what(run[PLAN])


_TEETH = _sections("stiffness.pairs", "stiffness.contact_beyond_path", "operating", "tolerance")
_TEETH_DECIDED = _decided(
    lambda plan: {"stiffness model": plan.stiffness.choice, "sampling": plan.resolution.sampling}
)


@stage("pair", "geometry", _sections("pair", "material"), packages=("gears",))
def PAIR(run: Engine) -> GearPair:
    """Geometry of the scene's pair."""
    return gear_pair(run.scene)


@stage(
    "film foreseen",
    "what the film will change",
    _sections("operating", "lubricant", "stiffness.pairs"),
    PAIR,
    packages=("gears", "ehl", "flankfilm"),
    kept=True,
)
def FILM_FORESEEN(run: Engine) -> film_choice.FilmChange | None:
    """What the cheapest models say that a film changes."""
    return film_choice.foreseen_change(run.scene)


@stage(
    "plan",
    "choice of models, split of the tolerance",
    _sections("stiffness", "film", "lubricant", "roughness", "operating", "dynamics", "wants", "tolerance"),
    PAIR,
    FILM_FORESEEN,
    packages=("flankfilm",),
)
def PLAN(run: Engine) -> Plan:
    """Models of the run and shares of its tolerance."""
    return decide(run.scene, run[PAIR], lambda: run[FILM_FORESEEN])


@stage(
    "bodies",
    "tooth compliance by finite elements",
    lambda scene: _sections("pair", "material", "stiffness.plane")(plain_flanks(scene)),
    packages=("gears", "meshes", "fem"),
    kept=True,
    settings=_decided(lambda plan: {"compliance": plan.resolution.compliance}),
)
def BODIES(run: Engine) -> fem.Compliance:
    """Compliance of the pair with plain flanks: no mesh shows relief, deviations or rounded edges."""
    import fem

    scene = run.scene
    pair, tolerance = gear_pair(plain_flanks(scene)), run[PLAN].resolution.compliance
    with under_keys(scene.pair, "pair"):
        found = fem.compliance(
            pair, tolerance=tolerance, plane=scene.stiffness.plane, supports=supports(scene)
        )
    if not found.converged:
        raise SolverError(f"tooth compliance: {found.message}")
    return found


@stage("compliance", "compliance with relief", _sections(), PAIR, BODIES, packages=("fem",))
def COMPLIANCE(run: Engine) -> fem.Compliance:
    """Everything about the teeth that does not depend on load, by finite elements."""
    return replace(run[BODIES], pair=run[PAIR])


def loaded_teeth(run: Engine, *, by_elements: bool = False, pitch: bool = False) -> LoadedTeeth:
    """Pair under the scene's torque with its model; with deviations of the pitches where every tooth counts."""
    scene, pair = run.scene, run[PAIR]
    model = "fem" if by_elements else run[PLAN].stiffness.choice
    flanks = coupling.Flanks(
        scene.stiffness.contact_beyond_path,
        deviations(scene, pair, pitch=pitch),
        tip_roundings(scene),
        scene.operating.friction if scene.operating else 0.0,
    )
    compliance = run[COMPLIANCE] if model == "fem" else None
    return coupling.LoadedTeeth(pair, pinion_torque(scene), model, scene.stiffness.pairs, compliance, flanks)


@stage(
    "closed forms",
    "closed forms",
    _sections("operating", "wants"),
    PAIR,
    COMPLIANCE,
    packages=("gears", "flankfilm"),
    settings=_TEETH_DECIDED,
)
def CLOSED_FORMS(run: Engine) -> SinglePairs:
    """Closed forms along the path, beside finite elements where the scene has them anyway."""
    beside = "stiffness" in run.scene.wants and run[PLAN].stiffness.choice == "fem"
    return coupling.single_pairs(run[PAIR], pinion_torque(run.scene), run[COMPLIANCE] if beside else None)


@stage(
    "verification",
    "closed forms against finite elements",
    _sections("operating", "stiffness.contact_beyond_path"),
    COMPLIANCE,
    packages=("gears", "flankfilm"),
)
def VERIFICATION(run: Engine) -> Verification:
    """Every closed form beside finite elements."""
    beyond = run.scene.stiffness.contact_beyond_path
    return coupling.verification_of(run[PAIR], pinion_torque(run.scene), run[COMPLIANCE], beyond)


@stage("dry cycle", "mesh cycle without film", _TEETH, COMPLIANCE, settings=_TEETH_DECIDED)
def DRY_CYCLE(run: Engine) -> MeshCycle:
    """Mesh stiffness without film, at as few positions as mean stiffness and transmission error need."""
    asked = run[PLAN].resolution
    return loaded_teeth(run).sampled(asked.sampling, asked.transmission_error)


@stage("torques", "mesh cycles over torque", _TEETH, COMPLIANCE, DRY_CYCLE)
def TORQUES(run: Engine) -> TorqueCurves:
    """Mesh cycles at the scene's torques from one compliance."""
    torques = run.scene.operating.torques_Nm if run.scene.operating else ()
    return coupling.torque_curves(loaded_teeth(run, by_elements=True), torques, run[DRY_CYCLE].position.size)


@stage("revolution", "mesh cycle tooth by tooth", _TEETH, COMPLIANCE)
def REVOLUTION(run: Engine) -> fem.MeshCycle:
    """Mesh cycle tooth by tooth, with pitch deviations."""
    operating = run.scene.operating
    assert operating is not None
    teeth = loaded_teeth(run, by_elements=True, pitch=True)
    return coupling.revolution(teeth, operating.pitches, operating.first_teeth)


@stage("other cycles", "mesh cycle by the other models", _TEETH, DRY_CYCLE, packages=("gears",))
def OTHER_CYCLES(run: Engine) -> tuple[MeshCycle, ...]:
    """Mesh cycles by the models that the scene did not choose: independent pairs added, without film."""
    return loaded_teeth(run).others(run[DRY_CYCLE].position.size)


@stage(
    "film",
    "oil film in series with the teeth",
    _sections("film", "lubricant", "roughness", "operating", "tolerance"),
    DRY_CYCLE,
    packages=("gears", "meshes", "fem", "ehl", "flankfilm"),
    kept=True,
    settings=_decided(lambda plan: {"model": plan.film.choice, "film": plan.film_tolerance}),
)
def FILM(run: Engine) -> LubricatedCycle:
    """Films and load share in agreement, and the mesh cycle with them."""
    scene, plan, teeth, dry = run.scene, run[PLAN], loaded_teeth(run), run[DRY_CYCLE]
    model = film_model(scene, plan.film.choice)
    oil, speed = lubricant(scene), pinion_speed(scene)
    with under_keys(scene.film, "film"):
        return coupling.lubricate(teeth, dry, speed, oil, plan.resolution, model)


@stage(
    "mesh",
    "mesh stiffness of the motion",
    _sections(),
    DRY_CYCLE,
    FILM,
    settings=_decided(lambda plan: {"model": plan.film.choice}),
)
def MESH(run: Engine) -> MeshCycle:
    """Mesh stiffness that the motion uses: with the film where there is one."""
    return run[DRY_CYCLE] if run[PLAN].film.choice == "none" else run[FILM]


@stage(
    "fillets",
    "root stress per load by finite elements",
    lambda scene: _sections("pair", "material", "stiffness.plane", "tolerance")(plain_flanks(scene)),
    packages=("gears", "meshes", "fem"),
    kept=True,
)
def FILLETS(run: Engine) -> fem.Fillets:
    """What loads anywhere on the flanks do to the fillets."""
    scene = run.scene
    return coupling.fillets_of(
        gear_pair(held_on_hubs(plain_flanks(scene))), scene.tolerance, scene.stiffness.plane
    )


@stage("root stress", "root stress over the mesh cycle", _sections(), MESH, FILLETS, PAIR)
def ROOT_STRESS(run: Engine) -> RootStresses:
    """Stress at the fillets with the forces of the mesh cycle, with the film where there is one."""
    return coupling.root_stresses(run[PAIR], loaded_contact(run), run[FILLETS])


@stage("fields", "stress and displacement fields", _TEETH, MESH)
def FIELDS(run: Engine) -> LoadedFields:
    """Fields with a pair at the pitch point."""
    return coupling.pitch_point_fields(run[PAIR], loaded_contact(run), run[COMPLIANCE])


def loaded_contact(run: Engine) -> fem.MeshCycle:
    """Loaded contact of the mesh cycle, with the film where there is one."""
    contact = run[MESH].contact
    assert contact is not None
    return contact


@stage(
    "fourier",
    "Fourier stiffness",
    _sections("stiffness", "dynamics"),
    MESH,
    packages=("dynamics",),
    settings=_decided(lambda plan: {"series": plan.series}),
)
def FOURIER(run: Engine) -> MeshSeries:
    """Series of the mesh stiffness, or the given one."""
    scene, given, section = run.scene, run.scene.stiffness, run.scene.dynamics
    if given.model == "given":
        kappa = given.amplitudes or ()
        phases = given.value("phases_deg") or (0.0,) * len(kappa)
        return coupling.given_series(given.mean_N_per_m or 1.0, kappa, phases)
    if section is None:
        return coupling.mesh_series(run[MESH], order=1)
    return coupling.mesh_series(
        run[MESH],
        section.stiffness,
        None if section.fourier_order == "auto" else section.fourier_order,
        run[PLAN].series or scene.tolerance,
        _frequency_range(run, section),
        section.damping_ratio,
    )


def _frequency_range(run: Engine, section: DynamicsSection) -> tuple[float, float] | None:
    """Range of the mesh frequency over the natural one that sweep and diagram cover; None without either."""
    asked = [ranged for ranged in (section.sweep, section.diagram) if ranged is not None]
    if not asked or not {"sweep", "diagram"} & set(run.scene.wants):
        return None
    ends = [end for ranged in asked for end in ranged.frequency or ()]
    if not section.dimensionless:
        mean = float(run[MESH].curve(section.stiffness).mean())
        scales = coupling.pair_scales(run[PAIR], pinion_torque(run.scene), mean, *_scaling_of(section))
        ends += [scales.frequency_from_rpm(end) for ranged in asked for end in ranged.speed_rpm or ()]
    return min(ends), max(ends)


def _scaling_of(section: DynamicsSection) -> tuple[tuple[float, float], float | None]:
    """Inertias that turn with the gears [kg m2], and the length scale [m]."""
    extra = section.extra_inertia_kg_m2
    return (extra.pinion, extra.wheel), section.value("length_scale_um")


@stage(
    "scaling",
    "physical to dimensionless",
    _sections("operating", "dynamics", "pair", "material"),
    FOURIER,
)
def SCALING(run: Engine) -> PairOscillator:
    """Oscillator of the scene at its speed, or at the start of the sweep."""
    section, series = _dynamics(run), run[FOURIER]
    ranged, phase = section.sweep or section.diagram, section.value("error_phase_deg")
    if section.dimensionless:
        from dynamics import GearOscillator

        assert section.error_amplitude is not None
        assert section.half_backlash is not None
        assert section.mean_force is not None
        oscillator = GearOscillator(
            stiffness=series.stiffness.normalised(),
            damping_ratio=section.damping_ratio,
            mean_force=section.mean_force,
            error_amplitude=section.error_amplitude,
            frequency=ranged.frequency[0] if ranged and ranged.frequency else 1.0,
            half_backlash=section.half_backlash,
            error_phase=phase,
            one_sided=section.one_sided,
        )
        return coupling.PairOscillator(oscillator, None, series)
    rpm = run.scene.operating.pinion_speed_rpm if run.scene.operating else None
    if rpm is None:
        rpm = ranged.speed_rpm[0] if ranged and ranged.speed_rpm else 60.0
    extra, scale = _scaling_of(section)
    return coupling.pair_oscillator(
        run[PAIR],
        series,
        pinion_torque(run.scene),
        rpm * math.pi / 30.0,
        damping_ratio=section.damping_ratio,
        error_amplitude=section.value("error_amplitude_um") or 0.0,
        error_phase=phase,
        extra_inertia=extra,
        length_scale=scale,
        one_sided=section.one_sided,
    )


def _dynamics(run: Engine) -> DynamicsSection:
    section = run.scene.dynamics
    if section is None:
        raise InputError.at("[dynamics]", "", "is required by the motion", "add the section")
    return section


@stage(
    "sweep",
    "sweep up and down",
    _sections("dynamics"),
    FOURIER,
    SCALING,
    packages=("dynamics", "flankfilm"),
    kept=True,
)
def SWEEP(run: Engine) -> SpeedSweep:
    """Sweep of the speed up and down over the scene's range."""
    section, motion = _dynamics(run), run[SCALING]
    asked = section.sweep
    if asked is None:
        raise InputError.at("dynamics.sweep", "", "is required by the sweep", "add the range")
    wanted = list(section.portraits_frequency)
    if motion.scales is not None:
        wanted += [motion.scales.frequency_from_rpm(rpm) for rpm in section.portraits_rpm]
    if asked.speed_rpm is not None:
        speed = np.linspace(*asked.speed_rpm, asked.points) * math.pi / 30.0
        return coupling.speed_sweep(motion, speed, portraits=wanted)
    assert asked.frequency is not None
    frequency = np.linspace(*asked.frequency, asked.points)
    return coupling.speed_sweep(motion, frequency=frequency, portraits=wanted)


@stage(
    "diagram",
    "every branch of motions",
    _sections("dynamics"),
    FOURIER,
    SCALING,
    packages=("dynamics", "flankfilm", "gears"),
    kept=True,
)
def DIAGRAM(run: Engine) -> SpeedDiagram:
    """Every branch of motions over the scene's range, with the jumps."""
    asked = _dynamics(run).diagram
    if asked is None:
        raise InputError.at("dynamics.diagram", "", "is required by the diagram", "add the range")
    speed = asked.speed_rpm and (asked.speed_rpm[0] * math.pi / 30.0, asked.speed_rpm[1] * math.pi / 30.0)
    return coupling.jump_speeds(
        run[SCALING], speed, frequency=asked.frequency, searches=asked.searches, max_period=asked.max_period
    )


STAGES: tuple[Stage[Any], ...] = (
    PAIR, FILM_FORESEEN, PLAN, BODIES, COMPLIANCE, CLOSED_FORMS, VERIFICATION, DRY_CYCLE, TORQUES, REVOLUTION,
    OTHER_CYCLES, FILM, MESH, FILLETS, ROOT_STRESS, FIELDS, FOURIER, SCALING, SWEEP, DIAGRAM,
)  # fmt: skip
"""All of them, in an order in which each comes after what it needs."""


def goals(scene: Scene) -> tuple[Stage[Any], ...]:
    """Stages that the scene's wants ask for; those that these need follow by themselves."""
    return tuple(dict.fromkeys(_goals(scene, set(scene.wants), scene.stiffness.model == "given")))


def _goals(scene: Scene, wants: set[str], given: bool) -> Iterator[Stage[Any]]:
    if "geometry" in wants:
        yield PAIR
    if "closed-forms" in wants or ({"report", "stiffness"} <= wants and not given):
        yield CLOSED_FORMS
    if wants & {"stiffness", "film"} and not given:
        yield from (PLAN, DRY_CYCLE)
        if wants & {"closed-forms", "report"}:
            yield OTHER_CYCLES
        if scene.film.model != "none" or "film" in wants:
            yield MESH
    yield from (wanted for wanted in (TORQUES, REVOLUTION) if wanted.name in wants)
    if "root-stress" in wants:
        yield ROOT_STRESS
    if wants & {"fourier", "sweep", "diagram"}:
        yield FOURIER
    for wanted in (SWEEP, DIAGRAM):
        if wanted.name in wants:
            yield from (SCALING, wanted)
    if "vtk" in wants:
        yield FIELDS
