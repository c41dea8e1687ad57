"""Forces of a sample of tests: those that each simulated by itself has, evenly among all."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockfrag import Block, simulate
from rockfrag.motions.scaling import scale_to_pga
from rockfrag.records.motion import Motion
from rockfrag.stages import validity

BODY = Block(0.2, 0.8, 50.0)


def motions(count: int) -> dict[str, Motion]:
    rng = np.random.default_rng(3)
    window = np.hanning(300)
    return {f"m{k}": Motion(window * rng.normal(size=300), 0.02, f"m{k}") for k in range(count)}


def readings_of(names: list[str]) -> pd.DataFrame:
    about = {"configuration": "T", "object": "T", "pedestal": "NP", "earthquake": "e", "floor": "g"}
    table = pd.DataFrame({"motion": names, **about, "amplitude_g": 0.4})
    return table.assign(test=table["motion"])


def test_forces_are_those_of_one_history():
    known = motions(3)
    configuration = replace(BODY.system(), name="T")
    table = validity.validity_table(readings_of([*known]), [configuration], known)
    for row in table.to_dict("records"):
        response = simulate(BODY, scale_to_pga(known[row["motion"]], 0.4))
        assert row["friction_demand"] == response.friction_demand.max()
        assert row["least_normal_force_n"] == response.least_normal_force.min()
        assert row["unstable_distance"] == response.unstable_distance


def test_of_many_tests_some_evenly_among_them_are_looked_at(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(validity, "MOST_TESTED", 4)
    known = motions(10)
    configuration = replace(BODY.system(), name="T")
    table = validity.validity_table(readings_of([*known]), [configuration], known)
    assert list(table["motion"]) == ["m0", "m2", "m5", "m7"]
