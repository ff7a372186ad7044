"""The teeth of the drawing touch at the contacts that it shows, at any position, and cut into each other nowhere."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.path import Path as Polygon

from flankfilm.app.drawing import Drawing, drawing
from gears import Gear, GearPair


def turned(points: np.ndarray, centre: tuple[float, float], angle: float) -> np.ndarray:
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    away = points - centre
    return (
        np.stack([cosine * away[:, 0] - sine * away[:, 1], sine * away[:, 0] + cosine * away[:, 1]], -1)
        + centre
    )


def placed(drawn: Drawing, position: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Both outlines and the contacts, as the page places them."""
    pinion = turned(np.array(drawn.pinion), (0.0, 0.0), drawn.turn[0] * position)
    wheel = turned(np.array(drawn.wheel), drawn.centre, drawn.turn[1] * position)
    start, end = np.array(drawn.start), np.array(drawn.end)
    length = np.linalg.norm(end - start)
    runs = np.arange(position * drawn.pitch, length, drawn.pitch)
    return pinion, wheel, start + runs[:, None] * (end - start) / length


def away(points: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Distance of points from the sides of an outline."""
    first, side = outline[:-1], np.diff(outline, axis=0)
    along = np.einsum("pij,ij->pi", points[:, None] - first, side) / np.maximum(
        np.sum(side**2, axis=1), 1e-12
    )
    foot = first + np.clip(along, 0.0, 1.0)[..., None] * side
    return np.linalg.norm(points[:, None] - foot, axis=-1).min(axis=1)


@pytest.mark.parametrize("teeth", [(36, 40), (17, 60), (400, 23)])
@pytest.mark.parametrize("position", [0.0, 0.3, 0.77, 0.99])
def test_contacts_are_on_both_flanks(teeth, position):
    pair = GearPair(Gear(teeth[0]), Gear(teeth[1]), module=2e-3, face_width=20e-3).with_backlash(100e-6)
    drawn = drawing(pair)
    pinion, wheel, contacts = placed(drawn, position)
    assert len(contacts) in (1, 2)
    for outline in (pinion, wheel):
        np.testing.assert_allclose(away(contacts, outline), 0.0, atol=0.01)  # mm: sides are straight
    left, bottom, wide, tall = drawn.box
    seen = (wheel > [left, bottom]) & (wheel < [left + wide, bottom + tall])
    near = wheel[seen.all(axis=1)]
    inside = Polygon(pinion).contains_points(near)
    assert np.max(away(near[inside], pinion), initial=0.0) < 0.01


def test_no_end_of_an_outline_comes_into_view():
    drawn = drawing(GearPair(Gear(36), Gear(40), module=2e-3, face_width=20e-3))
    left, bottom, wide, tall = drawn.box
    for position in (0.0, 0.5, 1.0):
        for outline in placed(drawn, position)[:2]:
            for point in (outline[0], outline[-2]):
                assert not (left < point[0] < left + wide and bottom < point[1] < bottom + tall)
