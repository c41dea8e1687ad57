"""A synthetic laboratory: a block of known edges on a table that made noise of known strength."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag.rocking import Block, overturns

BLOCK = Block(0.1, 0.6, 60.0, cg_offset=0.01)
DT = 0.01
GROUPS, TESTS = 40, 160


@pytest.fixture(scope="session")
def laboratory(tmp_path_factory):
    """Tests of a block, forty waves at four strengths each, and the folder that a laboratory would hand over."""
    folder = tmp_path_factory.mktemp("synthetic")
    rng = np.random.default_rng(3)
    time = np.arange(0, 6, DT)
    window = np.hanning(len(time))
    motions, rows = {}, []
    for number in range(TESTS):
        group = number % GROUPS
        base = np.random.default_rng(group)
        wave = np.sin(2 * np.pi * base.uniform(0.5, 3) * time + base.uniform(0, 6)) * window
        peak = rng.uniform(1.0, 5.0)
        name = f"run{number}"
        motions[name] = peak * (wave + 0.1 * rng.standard_normal(len(time)) * window)
        rows.append((f"S{number}", name, f"wave {group}", peak / 9.81))
    result = overturns([BLOCK], list(motions.values()), DT, [1.0])
    table = pd.DataFrame(rows, columns=["test", "motion", "input", "pga_g"]).assign(
        overturned=result.overturned[0, :, 0].astype(int),
        rocked=(result.peak_rotation[0, :, 0] > 0).astype(int),
    )
    assert 0.2 < table["overturned"].mean() < 0.8
    table.to_csv(folder / "synthetic_tests.csv", index=False)
    np.savez(folder / "synthetic_motions.npz", **motions)
    return SimpleNamespace(folder=folder, table=table, motions=motions)
