"""Figures of each closed form beside those of finite elements, with the numerical error of the latter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import hypot

import numpy as np

import fem
import gears
from base import Array, Cost, Stopwatch, part, quantity, record
from base.later import known
from flankfilm.coupling.mesh.face_models import FaceLoadModels
from flankfilm.coupling.mesh.flanks import Flanks
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from flankfilm.coupling.mesh.mesh_cycles import resolved
from flankfilm.coupling.mesh.sharing_pairs import contact_places
from flankfilm.coupling.mesh.single_pairs import CLOSED_FORMS, MODELS, single_pair_stiffness
from gears.closed_form.record import UNKNOWN
from gears.pair.spur_only import require_spur
from gears.sharing.mesh_arcs import Estimate, MeshArcs

POSITIONS = 360
"""Positions of a base pitch in curves; figures follow from arcs, whatever the positions."""

POINTS = 81
"""Equally spaced points of the path A to E, both ends included; the pitch point C is added to them."""

REFERENCES: Mapping[str, tuple[bool, tuple[str, ...]]] = {
    "finite elements": (True, ()),
    "held to the path": (False, ()),
    "without hub wind-up": (False, ("hub_windup",)),
    "without coupling": (False, ("coupling",)),
    "without hub wind-up and coupling": (False, ("hub_windup", "coupling")),
}
"""Label to: whether tip edges may touch outside the path, and the parts of the compliance left out."""

UNITS: Mapping[str, str] = {
    "one pair, at C": "N/(mm um)",
    "one pair, largest": "N/(mm um)",
    "one pair, mean A to E": "N/(mm um)",
    "mesh, two pairs, mean": "N/(mm um)",
    "mesh, mean": "N/(mm um)",
    "harmonic 1 over mean": "1",
    "harmonic 2 over mean": "1",
    "harmonic 3 over mean": "1",
    "transmission error, peak to peak": "um",
}
"""The figures compared and their units; stiffness is secant, per face width."""


@record
class Curves:
    """Stiffness by one model, of one pair at `stations` and of the mesh; ISO 6336-1 has some figures alone.

    ``error`` is the estimated relative numerical error of the single pair, None for closed forms, whose error is what
    is asked for; ``cost`` is without what several models share; ``left_out`` names the parts of the compliance by
    finite elements that are left out.
    """

    no_error = "not estimated in single positions; the figures have errors where they are known"
    headline = ("label",)

    label: str = quantity("", "model")
    single_stiffness: Array = quantity(
        "N/m", "secant stiffness of one pair: under the whole force", "path", error="error", no_error=UNKNOWN
    )
    secant_stiffness: Array = quantity(
        "N/m", "secant stiffness of the mesh: force over deflection", "position"
    )
    transmission_error: Array = quantity("m", "deflection along the line of action", "position", shown="um")
    figures: Mapping[str, Estimate] = part(
        "figures by their names, in the units of `UNITS`, with their errors"
    )
    cost: Cost
    error: float | None = quantity("1", "relative numerical error", default=None)
    left_out: tuple[str, ...] = ()
    deflection_reference: str = quantity(
        "",
        "what the deflection is measured against; without coupling, that of each pair alone",
        default="teeth",
    )


@dataclass(frozen=True)
class Difference:
    """One figure of one closed form against one reference.

    Attributes
    ----------
    figure, unit, reference, model : str
    reference_value : float
        By finite elements, in `unit`.
    reference_error : float
        Its estimated numerical error, relative.
    value : float
        By the closed form.
    """

    figure: str
    unit: str
    reference: str
    model: str
    reference_value: float
    reference_error: float
    value: float

    @property
    def difference(self) -> float:
        """(value - reference)/reference."""
        return self.value / self.reference_value - 1.0


@record
class Verification:
    """Closed forms against finite elements.

    ``error`` and ``cost`` are of the compliance that the references share.
    """

    headline = ("torque",)

    pair: gears.GearPair = part("the gears")
    torque: float = quantity("N m", "torque of the pinion")
    rho1: Array = quantity("m", "curvature radius of the pinion's flank", "path", shown="mm")
    position: Array = quantity("1", "position, base pitches from A", "position")
    references: tuple[Curves, ...] = part("finite elements with all and with fewer parts")
    models: tuple[Curves, ...] = part("closed forms")
    differences: tuple[Difference, ...] = part("every figure of every model against every reference")
    error: float
    cost: Cost
    converged: bool = True
    message: str = ""
    over_face: FaceLoadModels | None = part(
        "load over the face by walls, slices and ISO 6336-1 beside finite elements; None where it is even",
        default=None,
    )

    @property
    def like_for_like(self) -> Curves:
        """Finite elements without what closed forms lack."""
        return max(self.references, key=lambda reference: len(reference.left_out))

    def difference(self, model: str, reference: str, figure: str = "mesh, mean") -> float:
        """Relative difference of one figure of a model from a reference, each by its label.

        Raises
        ------
        LookupError
            Where there is no such comparison.
        """
        return self.comparison(model, reference, figure).difference

    def comparison(self, model: str, reference: str, figure: str = "mesh, mean") -> Difference:
        """One figure of a model beside that of a reference; arguments and errors as of `difference`."""
        for comparison in self.differences:
            if (comparison.model, comparison.reference, comparison.figure) == (model, reference, figure):
                return comparison
        raise LookupError(f"no comparison of {model} with {reference} in {figure}")


def compare_closed_forms(
    pair: gears.GearPair,
    torque: float,
    tolerance: float = 0.005,
    compliance: fem.PairCompliance | None = None,
    beyond_path: bool = True,
    moving_contact: bool | None = None,
    *,
    reference: str = "body",
) -> Verification:
    """Compare every closed form of tooth stiffness with finite elements on a pair under a torque.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    tolerance : float
        Relative, of the finite elements.
    compliance : fem.PairCompliance, optional
        Computed unless given.
    beyond_path : bool
        Whether tip edges may touch outside the path in the first of the references.
    moving_contact : bool, optional
        Whether contacts move in references with all parts, as of `fem.mesh_cycle`. In the others they stay where
        undeformed teeth touch, as closed forms have it.
    reference : {"body", "bore", "teeth"}
        What deflections are measured against in references with all parts, as of `fem.mesh_cycle`. Without hub wind-up
        it is the teeth, and without coupling each pair's own turn of the bores.

    Raises
    ------
    SolverError
        Where the compliance misses its share of the tolerance.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> found = compare_closed_forms(pair, 600.0)
    >>> round(found.difference("potential energy, Sainsot body", "without hub wind-up and coupling"), 2)
    -0.17
    """
    require_spur(pair, "closed forms beside finite elements")
    teeth, _ = resolved(LoadedTeeth(pair, torque, compliance=compliance), tolerance)
    assert teeth.compliance is not None
    return verification_of(pair, torque, teeth.compliance, beyond_path, moving_contact, reference=reference)


def verification_of(
    pair: gears.GearPair,
    torque: float,
    compliance: fem.PairCompliance,
    beyond_path: bool = True,
    moving_contact: bool | None = None,
    *,
    reference: str = "body",
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> Verification:
    """Compare from a compliance; arguments as of `compare_closed_forms`, `bore_inertia` as of `LoadedTeeth`.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> import fem
    >>> bodies = fem.compliance(pair)
    >>> verification_of(pair, 600.0, bodies).like_for_like.label
    'without hub wind-up and coupling'
    """
    teeth = LoadedTeeth(pair, torque, reference=reference, bore_inertia=bore_inertia)
    references = tuple(_reference_curves(teeth, compliance, beyond_path, moving_contact))
    models = tuple(_closed_form_curves(pair, torque))
    return Verification(
        pair=pair,
        torque=torque,
        rho1=stations(pair),
        position=contact_places(pair, POSITIONS)[0],
        references=references,
        models=models,
        differences=tuple(_differences(references, models)),
        error=compliance.error,
        cost=compliance.cost,
    )


def stations(pair: gears.GearPair) -> Array:
    """Curvature radii of the pinion's flank from A to E, with C among them, (POINTS + 1,) [m]."""
    points = pair.points
    return np.sort(np.append(np.linspace(points.A, points.E, POINTS), points.C))


def _closed_form_curves(pair: gears.GearPair, torque: float) -> Iterator[Curves]:
    """Evaluate every closed form, its pairs independent as closed forms have them."""
    from gears import closed_form as forms

    for model in CLOSED_FORMS:
        yield _curves(MODELS[model], LoadedTeeth(pair, torque, model, "independent"))
    watch = Stopwatch()
    iso = forms.iso6336(pair, force=abs(pair.normal_force(torque)))
    stiffness = {"one pair, largest": iso.single_stiffness, "mesh, mean": iso.mesh_stiffness}
    figures = {
        name: Estimate(1e-9 / pair.face_width * value, known(None)) for name, value in stiffness.items()
    }
    nothing = np.zeros(0)
    yield Curves("ISO 6336-1", nothing, nothing, nothing, figures, Cost(watch.seconds))


def _reference_curves(
    measured: LoadedTeeth, compliance: fem.PairCompliance, beyond_path: bool, moving_contact: bool | None
) -> Iterator[Curves]:
    """Evaluate finite elements with all parts, and with the parts left out that closed forms lack."""
    for label, (whole, left_out) in REFERENCES.items():
        if whole and not beyond_path:
            continue  # the next one is the same
        parts = compliance.without(*left_out)
        # those of gears without parts stay, as closed forms have them
        flanks = Flanks(beyond_path=whole, moving_contact=False if left_out else moving_contact)
        reference = (
            None if left_out else measured.reference
        )  # without parts a compliance measures its own way
        teeth = replace(measured, compliance=parts, flanks=flanks, reference=reference)
        curves = _curves(label, teeth, compliance.error)
        # without coupling each pair has a separate rotation, with the hubs' wind-up or without
        own = "teeth" if "hub_windup" in left_out else "bore"
        yield replace(curves, left_out=left_out, deflection_reference=curves.deflection_reference or own)


def _curves(label: str, teeth: LoadedTeeth, error: float | None = None) -> Curves:
    """Stiffness of a single pair, of which the error is given, and of the mesh by one model."""
    watch, pair = Stopwatch(), teeth.pair
    cycle = teeth.cycle(POSITIONS)
    single = single_pair_stiffness(
        pair,
        teeth.force,
        stations(pair),
        teeth.model,
        teeth.compliance,
        reference=teeth.reference or "bore",
        bore_inertia=teeth.bore_inertia,
    )
    assert cycle.arcs is not None
    figures = single_figures(pair, single, error) | mesh_figures(pair, cycle.arcs)
    curves = single, cycle.secant_stiffness, cycle.transmission_error
    return Curves(label, *curves, figures, Cost(watch.seconds), error, deflection_reference=cycle.reference)


def single_figures(pair: gears.GearPair, single: Array, error: float | None) -> dict[str, Estimate]:
    """Figures of a single pair's stiffness at `stations` [N/m] in the units of `UNITS`.

    To its own error each adds what lies between the stations: the parabola's top over the largest of them, and for
    the mean a third of what half the stations change.
    """
    rho1, scale = stations(pair), 1e-9 / pair.face_width
    even = rho1 != pair.points.C
    mean, half = (
        float(np.trapezoid(single[even][::step], rho1[even][::step]) / np.ptp(rho1)) for step in (1, 2)
    )
    most, top = int(np.argmax(single[even])), 0.0
    if 0 < most < np.count_nonzero(even) - 1:
        before, here, after = single[even][most - 1 : most + 2].tolist()
        top = (after - before) ** 2 / (8 * max(2 * here - before - after, 1e-12 * here))
    values = {
        "one pair, at C": (float(np.interp(pair.points.C, rho1, single)), 0.0),
        "one pair, largest": (float(single.max()), top),
        "one pair, mean A to E": (mean, abs(mean - half) / 3),
    }
    return {
        name: Estimate(scale * value, known(None if error is None else scale * hypot(error * value, off)))
        for name, (value, off) in values.items()
    }


def mesh_figures(pair: gears.GearPair, arcs: MeshArcs) -> dict[str, Estimate]:
    """Figures of the mesh in the units of `UNITS`, from curves on smooth arcs."""
    scale, name, orders = 1e-9 / pair.face_width, "secant_stiffness", np.array([1, 2, 3])
    figures = {"mesh, mean": _times(scale, arcs.mean(name))}
    low, high = max(pair.contact_ratio - 2.0, 0.0), min(pair.contact_ratio - 1.0, 1.0)
    if low < high:
        figures["mesh, two pairs, mean"] = _times(scale, arcs.mean(name, (low, high)))
    figures["transmission error, peak to peak"] = _times(1e6, arcs.range("transmission_error"))
    sizes, errors = arcs.amplitudes(name, orders, over_mean=True)
    for place, order in enumerate(orders):
        error = None if errors is None else float(errors[place])
        figures[f"harmonic {order} over mean"] = Estimate(float(sizes[place]), known(error))
    return figures


def _times(scale: float, estimate: Estimate) -> Estimate:
    return Estimate(scale * estimate.value, known(None if estimate.error is None else scale * estimate.error))


def _differences(references: tuple[Curves, ...], models: tuple[Curves, ...]) -> Iterator[Difference]:
    """Every figure that both a model and a reference have."""
    for reference in references:
        for model in models:
            for name, unit in UNITS.items():
                known, estimate = reference.figures.get(name), model.figures.get(name)
                if known is None or known.relative is None or estimate is None:
                    continue
                labels = reference.label, model.label
                yield Difference(name, unit, *labels, known.value, known.relative, estimate.value)
