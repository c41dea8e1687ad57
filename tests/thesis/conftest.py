"""Tables of tests in which statements are true or false by construction."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

EVENTS = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
FLOORS = ("GF", "F3", "F5")
TOWERS = {"T1": 0.50, "T2": 0.40, "T3": 0.30}

Effect = Callable[[str, str, str], float]


def nothing(object_name: str, event: str, floor: str) -> float:
    return 0.0


def build(
    effect: Effect = nothing,
    level: Effect = nothing,
    *,
    noise: float = 0.01,
    seed: int = 0,
    objects: dict[str, float] = TOWERS,
) -> pd.DataFrame:
    """Tests with ln(P/NP) = effect(tower, event, floor) and ln a = ln(tower's) + level."""
    rng = np.random.default_rng(seed)
    rows = []
    for event in EVENTS:
        for floor in FLOORS:
            for object_name, amplitude in objects.items():
                base = np.log(amplitude) + level(object_name, event, floor)
                for pedestal in ("NP", "P"):
                    ln_a = base + rng.normal(0, noise)
                    ln_a += effect(object_name, event, floor) * (pedestal == "P")
                    rows.append(
                        (object_name, pedestal, event, floor, f"{event}-{floor}", np.exp(ln_a))
                    )
    names = ["object", "pedestal", "event", "floor", "motion", "amplitude_g"]
    table = pd.DataFrame(rows, columns=names)
    return table.assign(
        censored="none", lower_g=table["amplitude_g"] / 1.02, upper_g=table["amplitude_g"]
    )


@pytest.fixture
def made() -> Callable[..., pd.DataFrame]:
    return build
