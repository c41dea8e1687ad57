"""A synthetic laboratory: a block of known edges on a table that made noise of known strength."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import yaml

from rockfrag import Block, overturns

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
        wave = (
            np.sin(2 * np.pi * base.uniform(0.5, 3) * time + base.uniform(0, 6))
            * window
        )
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


ROOT = Path(__file__).parents[2]

BY_HAND = {
    "left_m": BLOCK.b + BLOCK.cg_offset,
    "right_m": BLOCK.b - BLOCK.cg_offset,
    "cg_height_m": 0.3,
    "height_m": 0.6,
    "mass_kg": 60.0,
    "inertia_kg_m2": BLOCK.centroidal_inertia,
}


PEDESTAL = [
    {
        "left_m": width / 2,
        "right_m": width / 2,
        "cg_height_m": height / 2,
        "height_m": height,
        "mass_kg": mass,
        "inertia_kg_m2": mass * (width**2 + height**2) / 12,
    }
    for width, height, mass in ((0.12, 0.3, 40.0), (0.2, 0.6, 100.0))
]
"""A base and a plinth, from above."""


def configured(folder, laboratory, **changes):
    """Write the study of the synthetic laboratory, with keys of the campaign changed."""
    content = {
        "study": "synthetic",
        "title": "A synthetic laboratory",
        "seed": 1,
        "campaign": {
            "tests": str(laboratory.folder / "synthetic_tests.csv"),
            "columns": {name: name for name in ("test", "motion", "overturned")}
            | {"group": "input"},
            "motions": str(laboratory.folder / "synthetic_motions.npz"),
            "unit": "m/s2",
            "dt_s": DT,
            "measures": {"pga_g": ["pga_g"]},
        },
        "object": BY_HAND,
        "unknowns": {"edge_retreat_mm": [0, 10], "restitution": [0.8, 1.0]},
        "trials": 64,
        "repeats": 4,
    }
    for key, value in changes.items():
        part, _, name = key.partition("__")
        content[part] = {**content[part], name: value} if name else value
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def granite(folder, shared, **changes):
    """Write the configuration of the granite rock for the place where its data are."""
    data = (shared / "measured").resolve()
    content = yaml.safe_load((ROOT / "config" / "granite.yaml").read_text())
    content["campaign"] |= {
        "tests": str(data / "granite_rock_1.csv"),
        "motions": str(data / "granite" / "table_accelerations.npz"),
        "other_codes": str(data / "granite" / "rock_1_discrete_element.csv"),
    }
    content["object"]["mesh"] = str(data / "granite" / "rock_1.ply")
    path = folder / "granite.yaml"
    path.write_text(yaml.safe_dump({**content, **changes}))
    return path
