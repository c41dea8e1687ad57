"""Fixtures that every folder of tests may use."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rockfrag.records.motion import Motion

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """Folder of reference material beside the repository; tests that need it skip without it."""
    if not SHARED.is_dir():
        pytest.skip("the folder of reference material beside the repository is absent")
    return SHARED


@pytest.fixture(scope="session")
def noise() -> Callable[..., Motion]:
    """Maker of motions of white noise [m/s²], the same for the same seed."""

    def make(
        seed: int = 0, count: int = 500, dt: float = 0.01, *, tapered: bool = False, **about: Any
    ) -> Motion:
        samples = np.random.default_rng(seed).standard_normal(count)
        if tapered:
            samples *= np.hanning(count)
        return Motion(samples, dt, **{"name": f"noise {seed}", **about})

    return make
