"""The IDA curve: every amplitude of every motion, the same whatever the threads."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockfrag.records.motion import Motion
from rockfrag.stages.ida import as_recorded, ida_table
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag.study.study import Amplitudes
from rockfrag.system.blocks import Block, Stack

TOWER = Block(0.124, 0.372, 2.172)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
PILLAR, SQUAT = Block(0.2725, 0.9899, 62.6), Block(0.6, 1.2, 372.0)
AMPLITUDES = Amplitudes(0.2, 1.0, 10)


def ida(*about, **options) -> pd.DataFrame:
    """Return the table of an IDA curve as its file has it: texts as texts."""
    table = ida_table(*about, **options).to_pandas()
    texts = [name for name in table if isinstance(table[name].dtype, pd.CategoricalDtype)]
    return table.astype(dict.fromkeys(texts, "str"))


def motions() -> list[Motion]:
    time, about = np.arange(300) * 0.01, {"earthquake": "E", "floor": "ground"}
    return [
        Motion(np.sin(2 * np.pi * f * time) * (time < 1.5), 0.01, f"{f} Hz", about)
        for f in (1.0, 2.0)
    ]


def test_amplitudes_grow_by_the_step_up_to_the_highest():
    values = Amplitudes(0.5, 2.0, 100).values_g
    assert values == pytest.approx([0.5, 1.0, 2.0])
    ratios = AMPLITUDES.values_g[1:] / AMPLITUDES.values_g[:-1]
    assert ratios == pytest.approx(1.1)


@pytest.mark.parametrize("body", [TOWER, STACK])
def test_a_ida_does_not_depend_on_threads_or_on_the_batch(body: Block | Stack):
    configuration = replace(body.system(), name="X")
    whole = ida(configuration, motions(), AMPLITUDES.values_g, threads=2)
    parts = [ida(configuration, [motion], AMPLITUDES.values_g, threads=1) for motion in motions()]
    pd.testing.assert_frame_equal(whole, pd.concat(parts, ignore_index=True), check_exact=True)


def test_below_its_threshold_a_block_never_moves():
    table = ida(TOWER.system(), motions(), AMPLITUDES.values_g)
    low = table["amplitude_g"] < 1 / 3
    assert (table.loc[low, "peak_rotation_body_1"] == 0).all()
    assert table.loc[~low, "peak_rotation_body_1"].iloc[-1] > 0
    assert set(table["overturned_body"]) <= {"", "statue"}


def test_a_statue_that_its_pedestal_carries_along_rocks_and_does_not_stay():
    table = as_recorded(
        Stack(PILLAR, SQUAT).system(),
        [replace(motion, acceleration=6 * motion.acceleration) for motion in motions()],
    )
    assert set(table["overturned_body"]) == {"pedestal"}
    assert (table["peak_rotation"] == 0).all()
    assert table["rocked"].all()


def pairs(earthquakes: str, step: float = 0.01) -> pd.DataFrame:
    rows = []
    for number, earthquake in enumerate(earthquakes):
        for side, amplitude in (("NP", 0.5), ("P", 0.5 + step * number)):
            rows.append((side, earthquake, f"motion {number}", *[amplitude] * 3))
    names = ["pedestal", "earthquake", "motion", "amplitude_g", "lower_g", "upper_g"]
    about = {"object": "T1", "floor": "GF", "definition": "step_protocol", "censored": "none"}
    return pd.DataFrame(rows, columns=names).assign(**about)


def test_the_pedestal_effect_of_a_study_with_one_floor_is_estimated():
    # variances of earthquakes and of motions cannot be told apart there
    found = pedestal_tables(pairs("AABBCD"), seed=1, slenderness={"T1": 3.0})
    whole = found["effects"].set_index("scope").loc["whole"]
    assert whole["ratio"] == pytest.approx(1.05, abs=0.01)
    assert len(found["pairs"]) == 6


def test_a_reading_without_any_pair_leaves_the_numbers_of_the_others_numbers():
    # one motion: neither limits nor p values; a table that follows no motion: no effect at all
    known, other = pairs("A", 0.0), pairs("A", 0.0).assign(definition="step_protocol_shaker")
    other = other.assign(censored="right", upper_g=np.inf)
    found = pedestal_tables(pd.concat([known, other]), seed=1, slenderness={"T1": 3.0})
    assert found["effects"]["lower"].dtype == float
