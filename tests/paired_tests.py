"""Synthetic tables of paired tests, in which effects of the pedestal are there or not by construction."""

import itertools
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

EARTHQUAKES = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
FLOORS = ("GF", "F3", "F5")
TOWERS = {"T1": 0.50, "T2": 0.40, "T3": 0.30}
STEP = 0.05  # growth of the series of levels from one level to the next [-]

Effect = Callable[[str, str, str], float]


def nothing(object_name: str, earthquake: str, floor: str) -> float:
    return 0.0


def build(
    effect: Effect = nothing,
    level: Effect = nothing,
    *,
    noise: float = 0.01,
    seed: int = 0,
    objects: dict[str, float] = TOWERS,
    earthquakes: Sequence[str] = EARTHQUAKES,
    motions: int = 1,
    of_motion: float = 0.0,
    step: float | None = None,
) -> pd.DataFrame:
    """Synthetic tests with ln(P/NP) = effect(object, earthquake, floor) and ln a = ln(object's) + level.

    Parameters
    ----------
    noise, of_motion
        Scatter of ln a: of each test, and of each motion, which both sides share [-].
    earthquakes, motions
        Earthquakes, and motions of each on every floor.
    step
        Growth of a series of levels on which each test is climbed; without it amplitudes are exact to 2 %.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for earthquake, floor, k in itertools.product(earthquakes, FLOORS, range(motions)):
        motion = f"{earthquake}-{floor}" + (f"-{k}" if motions > 1 else "")
        shared = rng.normal(0, of_motion)
        for object_name, amplitude in objects.items():
            base = np.log(amplitude) + level(object_name, earthquake, floor) + shared
            gain = {"NP": 0.0, "P": effect(object_name, earthquake, floor)}
            for pedestal in gain:
                ln_a = base + rng.normal(0, noise) + gain[pedestal]
                rows.append(
                    (object_name, pedestal, earthquake, floor, motion, np.exp(ln_a))
                )
    names = ["object", "pedestal", "earthquake", "floor", "motion", "amplitude_g"]
    table = pd.DataFrame(rows, columns=names)
    upper = table["amplitude_g"]
    if step is not None:
        step_number = np.ceil(np.log(upper / 0.01) / np.log1p(step))
        table["amplitude_g"] = upper = 0.01 * (1 + step) ** step_number
    return table.assign(
        censored="none", lower_g=upper / (1 + (step or 0.02)), upper_g=upper
    )
