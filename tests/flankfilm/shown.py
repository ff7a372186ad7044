"""What the report shows of single stages of a run."""

from __future__ import annotations

from flankfilm.outcome.results import Results
from flankfilm.products.catalogue import PRODUCTS
from flankfilm.report.page import Part
from flankfilm.stages.computed import Computed


def part_of(run: Results, stage: str) -> Part:
    """The section of one stage."""
    alone = Computed(run.scene, {stage: run.values[stage]})
    (part,) = (part for product in PRODUCTS for part in product.sections(alone, run.dataset))
    return part
