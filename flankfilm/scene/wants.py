"""What a scene may want: every output with its meaning and with what it needs of the scene.

The rules between sections, the list that a scene is checked against and the documentation's table follow from here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

__all__ = [
    "BY_FINITE_ELEMENTS",
    "FILMS",
    "GEARED",
    "MESHED",
    "MOTIONS",
    "RATED",
    "UNLOADED",
    "WANTS",
    "NeededKey",
    "WantTraits",
    "ranges",
]


@dataclass(frozen=True)
class NeededKey:
    """Key without which a want cannot be computed: its dotted path, and what to do where it is left out."""

    path: str
    remedy: str


@dataclass(frozen=True)
class WantTraits:
    """What a wanted output is, and what it needs.

    Attributes
    ----------
    meaning : str
        For the documentation.
    finite_elements : bool
        Whether it needs the loaded contact by finite elements, which no closed form and no given stiffness replaces.
    gears : bool
        Whether it needs [pair] whatever the stiffness is.
    mesh : bool
        Whether it needs the mesh stiffness, and with it [pair] unless the stiffness is given.
    unloaded : bool
        Whether it is known without material and load.
    films : bool
        Whether it needs films on loaded flanks: oil, speed and the load share.
    heat : bool
        Whether these films have heat in any case.
    motion : bool
        Whether it needs the oscillator.
    series : bool
        Whether the tolerance leaves a share to the Fourier series of the stiffness.
    range_key : str
        Key of [dynamics] with the range that it is computed over; empty for none.
    keys : tuple of NeededKey
        Further keys that it needs.
    rated : bool
        Whether it needs [rating].
    file : bool
        Whether it is of files alone, and no figure.
    """

    meaning: str
    finite_elements: bool = False
    gears: bool = False
    mesh: bool = False
    unloaded: bool = False
    films: bool = False
    heat: bool = False
    motion: bool = False
    series: bool = False
    range_key: str = ""
    keys: tuple[NeededKey, ...] = ()
    rated: bool = False
    file: bool = False


def _motion(
    meaning: str,
    *keys: NeededKey,
    series: bool = False,
    range_key: str = "",
    finite_elements: bool = False,
) -> WantTraits:
    """A motion, over a range where it has a key for one."""
    if range_key:
        remedy = f"Add {range_key} = {{ speed_rpm = [500, 30000] }}"
        keys = (NeededKey(f"dynamics.{range_key}", remedy), *keys)
    return WantTraits(
        meaning,
        finite_elements=finite_elements,
        mesh=True,
        motion=True,
        series=series,
        range_key=range_key,
        keys=keys,
    )


def _elements(meaning: str, *keys: NeededKey, file: bool = False) -> WantTraits:
    """What finite elements alone give."""
    return WantTraits(meaning, finite_elements=True, gears=True, keys=keys, file=file)


_TORQUES = NeededKey("operating.torques_Nm", "Give a list, such as torques_Nm = [100, 300, 600]")
_SPEED = NeededKey("operating.pinion_speed_rpm", "Give the pinion's speed")
_SPEEDS = NeededKey("dynamics.sweep.speed_rpm", "Add sweep = { speed_rpm = [500, 30000], points = 60 }")

WANTS: Mapping[str, WantTraits] = {
    "geometry": WantTraits("sizes of the pair, also for inspection", gears=True, unloaded=True),
    "closed-forms": WantTraits("tooth stiffness by the closed forms", gears=True),
    "rating": WantTraits(
        "safeties by ISO 6336 and against scuffing; beside them safeties by load factors that are computed",
        gears=True,
        rated=True,
        keys=(_SPEED,),
    ),
    "stiffness": WantTraits("mesh stiffness, transmission error and load share over a mesh cycle", mesh=True),
    "torques": _elements("the mesh cycle at several torques", _TORQUES),
    "revolution": _elements("the mesh cycle tooth by tooth, with the deviations of each tooth"),
    "root-stress": _elements("stress in the tooth roots over a mesh cycle"),
    "film": WantTraits("thickness and pressure of the oil films along the path", gears=True, films=True),
    "losses": WantTraits("friction, losses and temperatures", gears=True, films=True, heat=True),
    "fourier": WantTraits("Fourier series of the mesh stiffness", mesh=True, series=True),
    "sweep": _motion("motion over the speed, up and down", series=True, range_key="sweep"),
    "diagram": _motion("every branch of periodic motions, stable or not", series=True, range_key="diagram"),
    "spectrum": _motion("orders of the motion at the speed"),
    "run-up": _motion("run-up and coast-down", range_key="run_up"),
    "bearing-forces": _motion(
        "bearing forces, axial motion and tilt of a helical pair over the speed",
        range_key="bearing_forces",
        finite_elements=True,
    ),
    "dynamic-map": _motion("dynamic factor K_v over speed and torque", _TORQUES, _SPEEDS),
    "vtk": _elements("fields for ParaView", file=True),
    "report": WantTraits("report of all that is wanted, one page", unloaded=True, file=True),
}
"""Every output that a scene may want, by its name."""

BY_FINITE_ELEMENTS = frozenset(name for name, want in WANTS.items() if want.finite_elements)
"""Wants that need the loaded contact by finite elements."""

GEARED = frozenset(name for name, want in WANTS.items() if want.gears)
"""Wants that need gears whatever the stiffness is."""

MESHED = frozenset(name for name, want in WANTS.items() if want.mesh)
"""Wants that need the mesh stiffness."""

UNLOADED = frozenset(name for name, want in WANTS.items() if want.unloaded)
"""Wants that are known without material and load."""

RATED = frozenset(name for name, want in WANTS.items() if want.rated)
"""Wants that need [rating]."""

FILMS = tuple(name for name, want in WANTS.items() if want.films)
"""Wants that need films."""

MOTIONS = tuple(name for name, want in WANTS.items() if want.motion)
"""Wants that need the oscillator."""


def ranges(wants: Iterable[str]) -> list[str]:
    """Keys of [dynamics] that hold the ranges of what is wanted, in the order of the wants that there are.

    Examples
    --------
    >>> ranges(["run-up", "sweep", "film"])
    ['sweep', 'run_up']
    """
    listed = set(wants)
    return [want.range_key for name, want in WANTS.items() if want.range_key and name in listed]
