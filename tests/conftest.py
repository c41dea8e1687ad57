"""Fixtures that every folder of tests may use."""

from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """Folder of reference material beside the repository; tests that need it skip without it."""
    if not SHARED.is_dir():
        pytest.skip("the folder of reference material beside the repository is absent")
    return SHARED
