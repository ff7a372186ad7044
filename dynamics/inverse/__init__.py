"""The inverse problem: which parameters have special points where somebody reports them."""

from dynamics.inverse.events import Event, OneOf, Ranged
from dynamics.inverse.identifying import identify
from dynamics.inverse.report import Candidate, Identification

__all__ = ["Candidate", "Event", "Identification", "OneOf", "Ranged", "identify"]
