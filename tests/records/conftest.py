"""Fixture of the built records."""

import pytest

from .built_records import KINDS, Built, build


@pytest.fixture(scope="session", params=KINDS)
def built(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Built:
    """Each built record in turn."""
    return build(request.param, tmp_path_factory.mktemp(request.param))
