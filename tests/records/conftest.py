"""Fixtures of the built records."""

from collections.abc import Callable
from pathlib import Path

import pytest

from .built_records import BUILDERS, Built


@pytest.fixture(scope="session", params=sorted(BUILDERS))
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Each built record in turn."""
    return BUILDERS[request.param](tmp_path_factory.mktemp(request.param))


@pytest.fixture(scope="session")
def builders() -> dict[str, Callable[[Path], Built]]:
    """The builders by name."""
    return BUILDERS
