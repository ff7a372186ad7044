"""The seed of what tests choose at random: ``FLANKFILM_SEED``, or a new one, which the head of the session names."""

from __future__ import annotations

import os
import random

# in the environment, so that all workers of a session have the same one
SEED = int(os.environ.setdefault("FLANKFILM_SEED", str(random.SystemRandom().randrange(1, 10**9))))


def seed_header() -> str:
    """Line of the session's head."""
    return f"FLANKFILM_SEED={SEED}"
