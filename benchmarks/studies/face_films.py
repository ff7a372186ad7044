"""Films and losses over the face: against films solved by themselves, an even load against the plane, and cost.

``PYTHONPATH=. python benchmarks/studies/face_films.py table`` (or ``even``, ``slopes``, ``losses``).
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np

import ehl
import fem
import flankfilm as ff
from base import RangeWarning
from flankfilm.coupling import Flanks, LoadedTeeth, LubricatedCycle, lubricate
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Alignment, Gear, GearPair

PAIR = GearPair(
    Gear(teeth=36, bore_radius=16.75e-3),
    Gear(teeth=40, bore_radius=18.75e-3),
    module=2e-3,
    face_width=40e-3,
).with_backlash(300e-6)
OIL = ehl.Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
SPEED, POSITIONS = 209.44, 40
EVEN = Alignment()


def teeth_with(
    bodies: fem.PairCompliance, torque: float, alignment: Alignment | None, cells: int = 64
) -> LoadedTeeth:
    """Article's pair between walls, or plane without an alignment."""
    flanks = Flanks() if alignment is None else Flanks(alignment=alignment, cells=cells, face_model="walls")
    return LoadedTeeth(PAIR, torque, compliance=bodies, flanks=flanks)


def filmed(teeth: LoadedTeeth) -> tuple[LubricatedCycle, float]:
    """Its films at forty positions, and the seconds that they took beyond the dry cycle."""
    dry = teeth.cycle(POSITIONS)
    start = time.perf_counter()
    found = lubricate(teeth, dry, SPEED, OIL, resolution_of(0.005), profiles=False)
    return found, time.perf_counter() - start


def of_table(bodies: fem.PairCompliance) -> None:
    """Films of cells picked at random, solved by themselves to 0.1 %, against the table and its error."""
    print("torque  slope   films  error told: least, central  largest off: least, central   of told error on")
    chance = np.random.default_rng(7)
    for torque, slope in ((600.0, 20e-6), (600.0, 100e-6), (60.0, 20e-6), (60.0, 60e-6), (20.0, 60e-6)):
        cycle, _ = filmed(teeth_with(bodies, torque, Alignment(slope), 32))
        over, off = cycle.over_face, []
        assert over is not None
        known = np.argwhere(np.isfinite(over.minimum_thickness))
        for at in chance.permutation(known)[:30]:
            place, cell = tuple(at[:2]), tuple(at)
            path = PAIR.path_at(cycle.rho1[place][None])
            film = ehl.solve(
                ehl.LineContact(
                    float(over.line_load[cell]),
                    float(path.entrainment(SPEED)[0]),
                    float(path.radius[0]),
                    PAIR.reduced_modulus,
                    OIL,
                ),
                1e-3,
            )
            thick = over.minimum_thickness[cell], over.central_thickness[cell]
            off.append([thick[0] / film.minimum_thickness - 1.0, thick[1] / film.central_thickness - 1.0])
        largest = np.abs(off).max(axis=0)
        held = np.mean(np.all(np.abs(off) <= [over.error, over.central_error], axis=1))
        print(
            f"{torque:6.0f} {1e6 * slope:5.0f} um {over.films:5d}  {over.error:.4f} {over.central_error:.4f}"
            f"          {largest[0]:.4f} {largest[1]:.4f}   {held:.0%}"
        )


def of_even_load(bodies: fem.PairCompliance) -> None:
    """An even load over 16 cells against the plane pair."""
    for torque in (600.0, 60.0):
        (plane, _), (even, _) = (filmed(teeth_with(bodies, torque, one, 16)) for one in (None, EVEN))
        for name, one in (("plane", plane), ("cells", even)):
            changes = (
                np.mean(one.secant_stiffness / one.dry.secant_stiffness) - 1.0,
                np.mean(one.stiffness / one.dry.stiffness) - 1.0,
            )
            print(
                f"{torque:5.0f} N m {name}: secant {100 * changes[0]:+.4f} %, tangent {100 * changes[1]:+.4f} %, "
                f"least film {1e6 * np.nanmin(one.least_film):.4f} um, D {1e6 * one.transmission_error.mean():.4f} um"
            )


def of_slopes(bodies: fem.PairCompliance) -> None:
    """What slopes do to the least film, and what films over the face take."""
    print(
        "torque  slope  least film, place  factor dry, film  secant, tangent changed  touched dry, film  side flow  s"
    )
    for torque, slope in (
        (600.0, 0.0),
        (600.0, 20e-6),
        (600.0, 60e-6),
        (60.0, 0.0),
        (60.0, 20e-6),
        (60.0, 60e-6),
    ):
        cycle, seconds = filmed(teeth_with(bodies, torque, Alignment(slope)))
        over, before, after = cycle.over_face, cycle.dry.contact.face, cycle.contact.face
        changes = (
            100 * (np.mean(getattr(cycle, kind) / getattr(cycle.dry, kind)) - 1.0)
            for kind in ("secant_stiffness", "stiffness")
        )
        print(
            f"{torque:6.0f} {1e6 * slope:4.0f} um  {1e6 * over.least_film:.3f} um "
            f"{1e3 * over.least_film_place:+.1f} mm  "
            f"{before.greatest_face_load_factor:.3f} {after.greatest_face_load_factor:.3f}  "
            + " ".join(f"{one:+.2f} %" for one in changes)
            + f"  {before.contact_pattern:.2f} {after.contact_pattern:.2f}  {over.side_flow:.4f}  {seconds:.1f}"
        )


def of_losses(bodies: fem.PairCompliance) -> None:
    """Losses of the plane pair, of an even load over cells, and with a slope."""
    for name, alignment in (
        ("plane", None),
        ("even", EVEN),
        ("20 um", Alignment(20e-6)),
        ("60 um", Alignment(60e-6)),
    ):
        flanks = teeth_with(bodies, 600.0, alignment, 32).flanks
        start = time.perf_counter()
        found = ff.mesh_losses(PAIR, 600.0, SPEED, OIL, compliance=bodies, flanks=flanks)
        carried = (
            "" if found.over_face is None else f" (of this interpolated {found.over_face.table_error:.4f})"
        )
        print(
            f"{name}: friction {found.mean_friction:.5f}, sliding {found.sliding_loss:.1f} W, rolling "
            f"{found.rolling_loss:.1f} W, mesh {found.mesh_loss:.1f} W, error told {found.error:.4f}{carried}, "
            f"least film {1e6 * found.least_film:.3f} um, "
            f"flanks {found.greatest_contact_temperature - 273.15:.1f} degC, {time.perf_counter() - start:.1f} s"
        )


if __name__ == "__main__":
    warnings.simplefilter("ignore", RangeWarning)
    CASES = {"table": of_table, "even": of_even_load, "slopes": of_slopes, "losses": of_losses}
    for asked in sys.argv[1:]:
        CASES[asked](fem.compliance(PAIR, tolerance=5e-4))
