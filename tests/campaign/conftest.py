"""A synthetic laboratory: a block of known edges on a table that made noise of known strength."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.rocking import Block, overturns

BLOCK = Block(0.1, 0.6, 60.0, cg_offset=0.01)
DT = 0.01
GROUPS, TESTS = 40, 160


@dataclass(frozen=True)
class Laboratory:
    """Synthetic tests, and the folder that holds what the laboratory would have handed over."""

    folder: Path
    table: pd.DataFrame
    motions: dict[str, np.ndarray]


@pytest.fixture(scope="session")
def laboratory(tmp_path_factory: pytest.TempPathFactory) -> Laboratory:
    """Synthetic tests of a block: forty waves at four strengths each."""
    folder = tmp_path_factory.mktemp("synthetic")
    rng = np.random.default_rng(3)
    time = np.arange(0, 6, DT)
    motions, rows = {}, []
    for number in range(TESTS):
        group = number % GROUPS
        base = np.random.default_rng(group)
        wave = np.sin(2 * np.pi * base.uniform(0.5, 3) * time + base.uniform(0, 6)) * np.hanning(
            len(time)
        )
        peak = rng.uniform(1.0, 5.0)
        motions[f"run{number}"] = peak * (
            wave + 0.1 * rng.standard_normal(len(time)) * np.hanning(len(time))
        )
        rows.append(
            {
                "test": f"S{number}",
                "motion": f"run{number}",
                "input": f"wave {group}",
                "pga_g": peak / 9.81,
            }
        )
    result = overturns([BLOCK], list(motions.values()), DT, [1.0])
    table = pd.DataFrame(rows).assign(
        overturned=result.overturned[0, :, 0].astype(int),
        rocked=(result.peak_rotation[0, :, 0] > 0).astype(int),
    )
    assert 0.2 < table["overturned"].mean() < 0.8
    table.to_csv(folder / "synthetic_tests.csv", index=False)
    np.savez(folder / "synthetic_motions.npz", **motions)
    return Laboratory(folder, table, motions)
