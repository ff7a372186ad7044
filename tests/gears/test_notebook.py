"""Notebook views: well-formed, complete, escaped, small."""

from __future__ import annotations

import warnings
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from gears import Gear, GearPair, closed_form
from gears.closed_form.record import ClosedForm
from gears.notebook import table


def parsed(html):
    """The view as a tree: it is well-formed."""
    return ET.fromstring(f"<div>{html}</div>")


@pytest.mark.parametrize("teeth", [(36, 40), (17, 18), (36, 400), (5000, 36)])
def test_a_pair_shows_its_data_and_its_teeth(teeth):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pair = GearPair(pinion=Gear(teeth=teeth[0]), wheel=Gear(teeth=teeth[1]), module=2e-3, face_width=0.04)
    html = pair._repr_html_()
    assert len(html) < 20_000
    tree = parsed(html)
    text = " ".join(tree.itertext())
    for shown in (
        f"{teeth[0]}",
        f"{teeth[1]}",
        f"{pair.contact_ratio:.4f}",
        f"{1e3 * pair.working_centre_distance:.4f} mm",
    ):
        assert shown in text
    paths = [element.get("d") for element in tree.iter("path")]
    assert len(paths) == 2
    points = [np.array([p.split(",") for p in d[1:-1].split(" ")], dtype=float) for d in paths]
    # the teeth touch at the pitch point, the middle of the picture
    assert all(np.min(np.hypot(*shape.T)) < 0.15 for shape in points)


def test_a_closed_form_shows_stiffness_and_parts():
    pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)
    result = closed_form.ishikawa(pair, pair.path_of_contact(5))
    text = " ".join(parsed(result._repr_html_()).itertext())
    assert f"{result.stiffness[2]:.4g}" in text
    assert all(part in text for part in result.parts)
    assert "unknown" in text


def test_texts_are_escaped():
    odd = ClosedForm("<script>a</script>", {"<b>&": np.array([1e-9])})
    html = odd._repr_html_()
    assert "<script" not in html
    assert "<b>" not in html
    parsed(html)
    parsed(table(("<", '"'), [("&", "<i>")]))
