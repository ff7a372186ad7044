"""Every number that the article prints in its section 6, and what it is there."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Event:
    """A printed special point.

    Attributes
    ----------
    section : str
        "6.1" to "6.4".
    name : str
        As printed, or what the text calls it.
    kind : str
        "grazing", "saddle-node", "period-doubling" or "crisis".
    labels : tuple of str
        Labels that the orbit may have at the point; the touch of a grazing is not counted.
    printed : str
        The value as printed.
    tracked : str
        Said about the value's origin.
    """

    section: str
    name: str
    kind: str
    labels: tuple[str, ...]
    printed: str
    tracked: str = ""

    @property
    def value(self) -> float:
        """As a number."""
        return float(self.printed)

    @property
    def digits(self) -> int:
        """Decimals printed."""
        return len(self.printed.partition(".")[2])

    @property
    def unit(self) -> float:
        """One unit of the last printed digit."""
        return 10.0**-self.digits


EVENTS = (
    Event("6.1", "grazing of 1-0-0", "grazing", ("1-0-0",), "0.6335", "kappa was fitted to this one"),
    Event("6.1", "saddle node of 1-1-0", "saddle-node", ("1-1-0",), "0.6556"),
    Event("6.1", "saddle node of 1-1-1", "saddle-node", ("1-1-1",), "0.5694"),
    Event("6.1", "period doubling beside the grazing", "period-doubling", ("1-1-0", "1-1-1"), "0.8873"),
    Event("6.1", "4-3-0 regained", "period-doubling", ("4-3-0",), "1.637"),
    Event("6.2", "GR1, 1-0-0", "grazing", ("1-0-0",), "0.43701486", "the value lies on the fold SN1"),
    Event("6.2", "SN1, 1-1-0", "saddle-node", ("1-1-0",), "0.43701658"),
    Event("6.2", "PD1, 1-2-0", "period-doubling", ("1-2-0",), "0.43647824"),
    Event("6.2", "SN3, 1-1-0", "saddle-node", ("1-1-0",), "0.53528214"),
    Event("6.2", "PD5, 1-1-0", "period-doubling", ("1-1-0",), "0.53961873"),
    Event("6.2", "PD7, 2-1-0", "period-doubling", ("2-1-0",), "0.78450762"),
    Event("6.2", "BC1", "crisis", (), "0.85", "no attractor ends there; those that do are listed below"),
    Event("6.2", "PD16, 3-1-1", "period-doubling", ("3-1-1",), "1.53394281"),
    Event("6.2", "SN12, 3-1-1", "saddle-node", ("3-1-1",), "2.47857060"),
    Event("6.2", "1-1-0 regained", "period-doubling", ("1-1-0",), "1.691"),
    Event("6.3", "grazing of 1-0-0", "grazing", ("1-0-0",), "0.5594"),
    Event("6.3", "saddle node of 1-1-0", "saddle-node", ("1-1-0",), "0.5897"),
    Event("6.3", "saddle node of 1-2-0", "saddle-node", ("1-2-0",), "0.5234"),
    Event("6.3", "period doubling to 2-4-0", "period-doubling", ("1-2-0",), "0.6343"),
    Event("6.3", "boundary crisis", "crisis", (), "0.68",
          "the chaos that begins at 0.6784 ends here, at the saddle U1-1-0; one digit differs"),
    Event("6.3", "pair with 2-3-1 and 2-3-2", "period-doubling", ("2-3-1", "2-3-2"), "1.076",
          "a period doubling of 1-2-0 at 1.0761550 has the value, not the motion"),
    Event("6.4", "GR1, 1-0-0", "grazing", ("1-0-0",), "0.78525136"),
    Event("6.4", "PD1, 1-1-0", "period-doubling", ("1-1-0",), "1.14019254"),
    Event("6.4", "SN1", "saddle-node", (), "1.13142473"),
    Event("6.4", "SN2", "saddle-node", (), "1.14975623"),
    Event("6.4", "PD3, to 2-1-1", "period-doubling", (), "1.54060732"),
    Event("6.4", "PD4", "period-doubling", (), "1.16635417"),
    Event("6.4", "GR2", "grazing", (), "1.00729515"),
    Event("6.4", "SN5", "saddle-node", (), "0.97765517"),
)  # fmt: skip

WINDOWS = {
    "6.1": (("2-1-0", "0.8873"), ("2-1-1", "0.9 to 1.25"), ("2-2-1", "0.9 to 1.25"), ("3-3-2", "0.9 to 1.25"),
            ("2-1-1", "near 1.5"), ("6-4-4", ""), ("4-3-0", "1.637")),
    "6.2": (("1-0-0", "0.3166"), ("1-1-1", "0.3166"), ("4-2-2", "1.0012"), ("3-1-1", "to 2.479"), ("2-2-0", "")),
    "6.3": (("1-0-0", "first"), ("1-2-0", "0.52 to 0.59"), ("2-4-0", "from 0.6343"), ("2-3-1", "1.076"),
            ("2-3-2", "1.076"), ("1-1-2", "last")),
}  # fmt: skip
"""Motions that the text names as stable, and where."""
