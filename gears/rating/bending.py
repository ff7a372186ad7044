"""Safety against breakage of the tooth root after ISO 6336-3."""

from __future__ import annotations

import math

from base import Faults, Limit, described, part, quantity, record
from gears.closed_form.record import STANDARD
from gears.closed_form.root_stress import Iso6336RootStress, iso6336_3
from gears.pair.gear_pair import GearPair
from gears.rating.life import BENDING
from gears.rating.load_factors import LoadFactors
from gears.rating.pitting import load_cycles
from gears.rating.steels import NITRIDED, UNHARDENED, RatedSteel, Steels, check_steels
from gears.tooth.errors import GeometryError

Y_ST = 2.0
"""Stress correction factor of the standard reference test gears."""

_SLIP = {
    "St": ((300.0, 400.0), (0.0833, 0.0445)),
    "V": ((500.0, 600.0, 800.0, 1000.0), (0.0281, 0.0194, 0.0064, 0.0014)),
}
_LIMITS = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque, without factors"),
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "life": Limit.above(0.0, 3.6e10, "s", "give the life in seconds"),
}
ROUGHNESS = Limit(1e-8, 40e-6, "m", "give Rz of the root's fillet in metres; the standard has it up to 40 um")
"""Rz of a fillet."""


@record
class BendingSafety:
    """Safety of both gears against breakage, with every factor of ISO 6336-3."""

    sigma_F: tuple[float, float] = quantity("Pa", "tooth-root stress", "gear", shown="MPa")
    sigma_FG: tuple[float, float] = quantity("Pa", "tooth-root stress limit", "gear", shown="MPa")
    S_F: tuple[float, float] = quantity("1", "safety against breakage", "gear")
    Y_drelT: tuple[float, float] = quantity("1", "relative notch sensitivity factors", "gear")
    Y_RrelT: tuple[float, float] = quantity("1", "relative surface factors", "gear")
    Y_X: tuple[float, float] = quantity("1", "size factors", "gear")
    Y_NT: tuple[float, float] = quantity("1", "life factors", "gear")
    nominal: Iso6336RootStress = part("nominal stress with its factors")

    no_error = STANDARD

    def __repr__(self) -> str:
        """One line: stress, limit and safety of each gear."""
        gears = (
            f"S_F {safety:.4g} of {1e-6 * limit:.5g} MPa over {1e-6 * stress:.5g} MPa"
            for safety, limit, stress in zip(self.S_F, self.sigma_FG, self.sigma_F, strict=True)
        )
        return f"BendingSafety({', '.join(gears)})"

    @described("1")
    def safety(self) -> float:
        """Smaller one of both gears' safeties."""
        return min(self.S_F)

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def bending_safety(
    pair: GearPair,
    torque: float,
    speed: float,
    factors: LoadFactors,
    steels: Steels,
    *,
    root_roughness: tuple[float, float],
    life: float,
) -> BendingSafety:
    """Safety against breakage S_F = sigma_FG/sigma_F of both gears, method B.

    sigma_F = sigma_F0 K_A K_v K_Fbeta K_Falpha, sigma_FG = sigma_Flim Y_ST Y_NT Y_drelT Y_RrelT Y_X, Y_ST = 2. With
    the notch parameter q_s of the root section and the slip-layer thickness rho' of the steel,

        Y_drelT = [1 + sqrt(0.2 rho' (1 + 2 q_s))]/[1 + sqrt(1.2 rho')]

    Y_RrelT is that of `surface_factor`, Y_X of `size_factor`, Y_NT of `BENDING`.

    Parameters
    ----------
    pair : GearPair
    torque : float
        Nominal torque of the pinion [N m]; it loads one flank, and roots in one direction.
    speed : float
        Of the pinion [rad/s].
    factors : LoadFactors
    steels : tuple of RatedSteel
    root_roughness : tuple of float
        Rz of the fillets of both gears [m].
    life : float
        Time under load [s].

    Returns
    -------
    BendingSafety

    Raises
    ------
    GeometryError
        With every fault of the numbers and steels; without a proof stress of steels St and V.

    Notes
    -----
    A published listing confirms Y_drelT (rho' 0.003 mm), Y_X, Y_NT and Y_ST of case-hardened steels, and Y_RrelT 0.957
    of fillets of Rz 20 um, a roughness that it does not print. Other steels are those of one open program. Left out:
    roots under reversed bending (Y_M), load sharing by a contact ratio above 2 (Y_DT).

    References
    ----------
    ISO 6336-3:2006, clauses 10 to 14.

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel, load_factors, run_in, tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> effective = run_in(pair, steels, 209.44, tolerances(pair, 6))
    >>> loads = load_factors(
    ...     pair, 600.0, 209.44, application_factor=1.0, effective=effective, relief=2e-6, face_load_factor=1.15
    ... )
    >>> bending_safety(pair, 600.0, 209.44, loads, steels, root_roughness=(20e-6, 20e-6), life=3.6e7).safety
    1.11...
    """
    with Faults(GeometryError) as faults:
        faults.numbers(_LIMITS, (torque, speed, life))
        check_roots(faults, steels, root_roughness)
        check_steels(faults, pair, steels)
    nominal = iso6336_3(pair, pair.normal_force(torque))
    cycles = load_cycles(pair, speed, life)
    rows = []
    for steel, section, n, rough, stress in zip(
        steels, nominal.sections, cycles, root_roughness, nominal.stresses, strict=True
    ):
        slip = slip_layer(steel)
        notch = (1.0 + math.sqrt(0.2 * slip * (1.0 + 2.0 * section.q_s))) / (1.0 + math.sqrt(1.2 * slip))
        surface, size = surface_factor(steel.kind, rough), size_factor(steel.kind, pair.module)
        cycle = BENDING[steel.kind].factor(n)
        limit = steel.bending_strength * Y_ST * cycle * notch * surface * size
        loaded = stress * factors.bending
        rows.append((loaded, limit, limit / loaded, notch, surface, size, cycle))
    stresses, limits, safeties, notches, surfaces, sizes, lives = zip(*rows, strict=True)
    return BendingSafety(stresses, limits, safeties, notches, surfaces, sizes, lives, nominal)


def check_roots(faults: Faults, steels: Steels, root_roughness: tuple[float, float]) -> None:
    """Note what is wrong with the fillets, and steels whose notch sensitivity needs a proof stress."""
    for name, steel, rough in zip(("pinion", "wheel"), steels, root_roughness, strict=True):
        faults.number(f"{name}.root_roughness", rough, ROUGHNESS)
        if steel.kind in UNHARDENED and steel.proof_stress is None:
            allowed = "is required by the notch sensitivity of steels St and V"
            faults.add(f"{name}.steel.proof_stress", "", allowed, "give yield strength or proof stress")


def slip_layer(steel: RatedSteel) -> float:
    """Slip-layer thickness rho' [mm]: 0.003 of Eh and IF, 0.1005 of nitrided steels, St and V by their proof stress.

    Between tabulated proof stresses the logarithm of rho' is linear; beyond them their ends count.

    References
    ----------
    ISO 6336-3:2006, table 2.

    Examples
    --------
    >>> slip_layer(RatedSteel("Eh", 1500e6, 430e6)), slip_layer(RatedSteel("V", 640e6, 250e6, 600e6))
    (0.003, 0.0194)
    """
    if steel.kind in NITRIDED:
        return 0.1005
    if steel.kind not in _SLIP or steel.proof_stress is None:
        return 0.003
    stresses, layers = _SLIP[steel.kind]
    proof = min(max(1e-6 * steel.proof_stress, stresses[0]), stresses[-1])
    for place in range(1, len(stresses)):
        if proof <= stresses[place]:
            share = (proof - stresses[place - 1]) / (stresses[place] - stresses[place - 1])
            return float(layers[place - 1] ** (1.0 - share) * layers[place] ** share)
    return layers[-1]


def surface_factor(kind: str, roughness: float) -> float:
    """Y_RrelT of a fillet of roughness Rz [m].

    V, Eh and IF: 1.674 - 0.529 (Rz + 1)^0.1; St: 5.306 - 4.203 (Rz + 1)^0.01; nitrided: 4.299 - 3.259 (Rz + 1)^0.0058,
    Rz in um; below 1 um 1.12, 1.07 and 1.025.

    References
    ----------
    ISO 6336-3:2006, clause 13.3.

    Examples
    --------
    >>> round(surface_factor("Eh", 20e-6), 3), round(surface_factor("Eh", 10e-6), 2)
    (0.957, 1.0)
    """
    rz = 1e6 * roughness
    if kind == "St":
        return 1.07 if rz < 1.0 else 5.306 - 4.203 * (rz + 1.0) ** 0.01
    if kind in NITRIDED:
        return 1.025 if rz < 1.0 else 4.299 - 3.259 * (rz + 1.0) ** 0.0058
    return 1.12 if rz < 1.0 else 1.674 - 0.529 * (rz + 1.0) ** 0.1


def size_factor(kind: str, module: float) -> float:
    """Y_X of a normal module [m].

    St and V: 1.03 - 0.006 m_n, within 0.85 and 1; hardened steels: 1.05 - 0.01 m_n, within 0.8 and 1; m_n in mm.

    References
    ----------
    ISO 6336-3:2006, clause 14.

    Examples
    --------
    >>> round(size_factor("Eh", 14e-3), 3), size_factor("V", 5e-3), size_factor("V", 0.05)
    (0.91, 1.0, 0.85)
    """
    m = 1e3 * module
    wanted, low = (1.03 - 0.006 * m, 0.85) if kind in UNHARDENED else (1.05 - 0.01 * m, 0.8)
    return min(max(wanted, low), 1.0)
