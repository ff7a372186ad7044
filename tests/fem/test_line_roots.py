"""Root stress of helical pairs over a mesh cycle."""

from __future__ import annotations

import pytest

from base import InputError
from fem import line_fillets
from gears import Gear, GearPair

GEAR = Gear(teeth=18, profile_shift=0.2, bore_radius=8e-3)
SPUR = GearPair(GEAR, GEAR, module=2e-3, face_width=12e-3)


def test_spur_pairs_have_no_fillets_of_lines():
    with pytest.raises(InputError, match="must be helical"):
        line_fillets(SPUR)
