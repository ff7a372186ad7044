from __future__ import annotations

import pytest

from gears import GearPair
from tests.processes import pytest_configure, pytest_sessionfinish
from tests.seeds import pytest_report_header
from tests.validation.article import PAIR

__all__ = ["article_pair", "pytest_configure", "pytest_report_header", "pytest_sessionfinish"]


@pytest.fixture(scope="session")
def article_pair() -> GearPair:
    """The article's pair, tests/validation/article.py."""
    return PAIR
