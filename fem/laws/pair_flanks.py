"""Flanks of a pair with where they touch in the section: found once, for all positions and torques."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from fem.laws.edges_of_lines import EdgesOfLines
from fem.laws.flank_forms import FlankForms
from fem.laws.relieved_flanks import ends_of_flanks, gentle, relieved_lines
from fem.laws.relieved_lines import RelievedLines
from fem.laws.tip_edges import edges_of_lines

__all__ = ["PairFlanks"]


class PairFlanks(FlankForms):
    """Flanks of a pair, and the tables of the places at which lines of contact touch them.

    Setups of the same gears at other positions share one of these (``MeshSetup``). Copies that were pickled find their
    tables again.
    """

    @cached_property
    def gentle(self) -> bool:
        """Whether relief and deviations leave single contacts; else flanks are taken to touch where involutes do."""
        return gentle(self)

    @cached_property
    def touching_ends(self) -> tuple[float, float]:
        """Places between which flanks touch beside their corners, under no load [m]: with relief beyond the path."""
        return ends_of_flanks(self, self.gentle)

    @cached_property
    def relieved_on_path(self) -> RelievedLines | None:
        """Where relieved flanks touch between the ends of the path; None where they do so as involutes."""
        return relieved_lines(self, self.ends) if self.gentle else None

    @cached_property
    def relieved_beyond_path(self) -> RelievedLines | None:
        """The same as far as flanks touch beside their corners."""
        return relieved_lines(self, self.touching_ends) if self.gentle else None

    def edges(self, reach: float) -> EdgesOfLines:
        """Tip edges of lines of contact; ``reach`` in base pitches beyond the ends of the flanks."""
        if reach not in self._edges:
            self._edges[reach] = edges_of_lines(self, self.touching_ends, reach)
        return self._edges[reach]

    @cached_property
    def _edges(self) -> dict[float, EdgesOfLines]:
        """Tables by their reach: few, which go with the torque alone."""
        return {}

    def __reduce__(self) -> tuple[Any, ...]:
        """Take what the flanks are given by, since what they lack are functions."""
        return PairFlanks, (self.pair, self.deviations, self.tip_rounding, self.options)
