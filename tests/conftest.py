from __future__ import annotations

import pytest

from gears import GearPair
from tests.validation.article import PAIR


@pytest.fixture(scope="session")
def article_pair() -> GearPair:
    """The article's pair, tests/validation/article.py."""
    return PAIR
