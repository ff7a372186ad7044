from __future__ import annotations

import pytest

from gears import Gear, GearPair


@pytest.fixture
def article_pair():
    return GearPair(
        Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), module=2e-3, face_width=40e-3
    )
