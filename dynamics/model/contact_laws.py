"""Restoring forces that depend on the deflection nonlinearly, on the angle, and on the speed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np

from base import Array, Faults, Limit
from dynamics.model.limits import OSCILLATOR, POSITIVE
from dynamics.model.naming import series_names, unknown, value_at, with_value
from dynamics.model.stiffness import FourierStiffness, check_stiffness

L = TypeVar("L", bound="ContactLaw")


class Law(Protocol):
    """What the stepwise flow asks of a restoring force f(theta, X, V).

    Attributes
    ----------
    names : tuple of str
        Parameters of the law, in the order of `values`.
    values : ndarray
        Their values.
    data : ndarray
        What else the compiled function reads.
    surfaces : ndarray, shape (s, 4)
        Rows n_X, n_V, sign, place: the surface n_X X + n_V V = sign values[place] (0 where place is -1), where the
        law is switched or crossings are counted. The first counts p, the second q.
    size : float
        Natural size of a displacement.
    compiled : object
        The numba function pointer, see `dynamics.kernels.stepwise`.
    """

    @property
    def names(self) -> tuple[str, ...]: ...  # noqa: D102

    @property
    def values(self) -> Array: ...  # noqa: D102

    @property
    def data(self) -> Array: ...  # noqa: D102

    @property
    def surfaces(self) -> Array: ...  # noqa: D102

    @property
    def size(self) -> float: ...  # noqa: D102

    @property
    def compiled(self) -> Any: ...  # noqa: D102

    def with_value(self, name: str, value: float) -> Law:
        """Return the law with one parameter changed."""
        ...


@dataclass(frozen=True)
class SqueezeFilm:
    r"""Force of the oil that two approaching flanks squeeze out.

    .. math:: c\,V \left(\frac{h}{h + g}\right)^{3/2}

    for each flank at clearance g, full in contact: the law of a rigid cylinder on a plane, finite at g = 0 by the
    thickness h that a loaded film keeps.

    Parameters
    ----------
    damping : float
        c, >= 0, in the scaling of :math:`2\zeta`.
    thickness : float
        h, > 0, in units of X.
    """

    damping: float = 0.0
    thickness: float = 1.0

    def __post_init__(self) -> None:
        """Check."""
        with Faults() as faults:
            faults.number("film.damping", self.damping, Limit(0.0, remedy="0 is no film"))
            faults.number("film.thickness", self.thickness, POSITIVE)


@dataclass(frozen=True, kw_only=True)
class ContactLaw(ABC):
    """What laws with contacts on one or two sides have in common.

    Attributes
    ----------
    half_backlash : float
        Half the backlash between the contacts, at least 0.
    film : SqueezeFilm
        Damping by the oil in the gap; none unless given.
    one_sided : bool
        Whether the contact at negative X is left out.
    """

    half_backlash: float
    film: SqueezeFilm = field(default_factory=SqueezeFilm)
    one_sided: bool = False

    def _check(self) -> Faults:
        faults = Faults()
        faults.number("half_backlash", self.half_backlash, OSCILLATOR["half_backlash"])
        if not isinstance(self.film, SqueezeFilm):
            faults.add("film", self.film, "must be a SqueezeFilm", "leave it out for none")
        faults.choice("one_sided", self.one_sided, (True, False), "True leaves the second flank out")
        return faults

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Parameters."""

    @property
    def data(self) -> Array:
        """Number of sides with backlash."""
        return np.array([1.0 if self.one_sided else 2.0])

    @property
    def values(self) -> Array:
        """Values of the parameters."""
        return np.array([value_at(self, name) for name in self.names])

    @property
    def surfaces(self) -> Array:
        """X = D and X = -D."""
        flanks = np.array([[1.0, 0.0, 1.0, 0.0], [1.0, 0.0, -1.0, 0.0]])
        return flanks[:1] if self.one_sided else flanks

    @property
    def size(self) -> float:
        """Half the backlash."""
        return self.half_backlash

    def with_value(self: L, name: str, value: float) -> L:
        """Return the law with one parameter changed.

        Raises
        ------
        InputError
            If there is no such parameter or the value is not allowed.
        """
        if name not in self.names:
            raise unknown(name, self.names)
        new: L = with_value(self, name, float(value))
        return new


@dataclass(frozen=True, kw_only=True)
class SmoothedBacklash(ContactLaw):
    r"""Piecewise-linear contact with rounded corners, to hold the exact flow against.

    .. math:: f = K(\theta)\, s \left[\ln(1 + e^{(X - D)/s}) - \ln(1 + e^{-(X + D)/s})\right]

    It differs from the backlash by :math:`K s \ln 2` at the corners and exponentially little elsewhere. Crossings of
    :math:`\pm D` are counted; nothing is switched.

    Parameters
    ----------
    stiffness : FourierStiffness
        :math:`K`.
    half_backlash : float
        :math:`D \ge 0`.
    width : float
        :math:`s > 0`.

    Raises
    ------
    InputError
        With every fault found.
    """

    stiffness: FourierStiffness
    width: float

    def __post_init__(self) -> None:
        """Check."""
        faults = self._check()
        faults.number("width", self.width, Limit(0.0, low_open=True, remedy="0 is the exact flow's law"))
        if self.one_sided or self.film != SqueezeFilm():
            faults.add(
                "film, one_sided", "given", "must be left out", "PowerContact with exponent 1 has both"
            )
        check_stiffness(faults, self.stiffness)
        faults.raise_if_any()

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters."""
        return ("half_backlash", "width", *series_names(self.stiffness.order))

    @property
    def compiled(self) -> Any:
        """Function pointer."""
        from dynamics.kernels.stepwise.laws import smoothed_backlash

        return smoothed_backlash


@dataclass(frozen=True, kw_only=True)
class PowerContact(ContactLaw):
    r"""Contact whose stiffness grows with the load, as a power of the depth.

    .. math:: f = K(\theta)\,\delta^n, \qquad \delta = X - D > 0 \text{ (in front)}, \quad -X - D > 0 \text{ (at the
        back, force negative)}

    and no force in the gap. n = 1 is the piecewise-linear law, 10/9 about a line contact, 3/2 a point contact.

    Parameters
    ----------
    stiffness : FourierStiffness
        :math:`K`, force over depth to the n.
    half_backlash : float
        :math:`D \ge 0`.
    exponent : float
        :math:`n \ge 1`.
    film : SqueezeFilm
        Squeezed film, if any.
    one_sided : bool
        No second flank.

    Raises
    ------
    InputError
        With every fault found.
    """

    stiffness: FourierStiffness
    exponent: float = 10.0 / 9.0

    def __post_init__(self) -> None:
        """Check."""
        faults = self._check()
        faults.number("exponent", self.exponent, Limit(1.0, remedy="10/9 for a line contact"))
        check_stiffness(faults, self.stiffness)
        faults.raise_if_any()

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters."""
        return (
            "half_backlash",
            "film.damping",
            "film.thickness",
            "exponent",
            *series_names(self.stiffness.order),
        )

    @property
    def compiled(self) -> Any:
        """Function pointer."""
        from dynamics.kernels.stepwise.laws import power_contact

        return power_contact
