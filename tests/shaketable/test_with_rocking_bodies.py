from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.shaketable.definitions import tests_from_ida as read_ida
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.shaketable.shaker import Shaker, shaker_table
from rockfrag.study.configurations import configuration_of, each_alone
from rockfrag.system.blocks import Block
from rockfrag_thesis.building_sensitivity import building_sensitivity, building_variants

from .conftest import ida_table

BUILDING = Path(__file__).resolve().parents[2] / "config" / "building.yaml"
TOWERS = {
    "T1": Block(0.124, 0.372, 2.172),
    "T2": Block(0.124, 0.496, 2.790),
    "T3": Block(0.124, 0.620, 3.456),
}
PEDESTAL = Block(0.184, 0.208, 2.300)
BLOCKS = {**TOWERS, "P": PEDESTAL}
SPECIMENS = each_alone(TOWERS)


def amplitudes(lowest, highest, step):
    return lowest * (1 + step) ** np.arange(int(np.log(highest / lowest) / np.log(1 + step)) + 1)


def ida(motions, values):
    result = overturns(
        list(TOWERS.values()),
        [motion.acceleration for motion in motions],
        [motion.dt for motion in motions],
        [values * 9.81 / motion.pga for motion in motions],
    )
    curves = product(enumerate(TOWERS), enumerate(motions))
    return pd.concat(
        ida_table(result.overturned[i, j], values, name, earthquake=motion.name)
        for (i, name), (j, motion) in curves
    )


def test_the_full_stroke_censors_loma_prieta_with_t1_and_nothing_else(records):
    motions = list(records.values())
    table = shaker_table(Shaker(), motions).set_index("motion")
    limits = {f"{name}_ground": limit for name, limit in table["limit_g"].items()}
    tests = read_ida(
        ida(motions, amplitudes(0.2, 0.7, 0.01)),
        Protocol(GeometricSteps(0.2, 0.01)),
        definitions=["step_protocol"],
        limits_g=limits,
    )
    censored = tests[tests["censored"] == "right"]
    assert censored[["object", "motion"]].to_numpy().tolist() == [["T1", "Loma_Prieta_ground"]]
    assert censored["lower_g"].iloc[0] == pytest.approx(0.40, abs=0.005)


@pytest.fixture
def settings():
    return yaml.safe_load(BUILDING.read_text(encoding="utf-8"))


def wave(frequency, name):
    t = np.arange(300) * 0.01
    shaken = np.sin(2 * np.pi * frequency * t) * np.sin(np.pi * t / t[-1])
    return Motion(2 * shaken, 0.01, name, {"earthquake": name})


def test_a_variant_equal_to_the_reference_gives_the_same_tests(settings):
    stacks = [configuration_of(f"P&{name}", ("P", name), BLOCKS) for name in TOWERS]
    tests = building_sensitivity(
        building_variants(settings, {"first_period_s": [0.35, 0.9]}),
        [wave(1.5, "one"), wave(3.0, "two")],
        SPECIMENS[:1] + stacks[:1] + SPECIMENS[1:2] + stacks[1:2],
        amplitudes(0.2, 1.2, 0.05),
        Protocol(GeometricSteps(0.2, 0.05), limit_g=1.2),
    )
    same = tests.drop(columns=["axis", "value", "credible"])
    by_label = {
        label: table.drop(columns="label").reset_index(drop=True)
        for label, table in same.groupby("label")
    }
    pd.testing.assert_frame_equal(by_label["reference"], by_label["first period 0.35 s"])
    assert not by_label["reference"].equals(by_label["first period 0.9 s"])
    # the ground floor does not know the building
    ground = [table[table["floor"] == "GF"].reset_index(drop=True) for table in by_label.values()]
    pd.testing.assert_frame_equal(ground[0], ground[1])
    assert tests["credible"].groupby(tests["label"]).nunique().eq(1).all()


def test_each_axis_changes_what_it_names(settings):
    variants = building_variants(
        settings,
        {
            "damping_ratio": [0.08],
            "base_shear": [0.15],
            "ground_scale": [0.25],
            "floors": [{"F3": 2, "F5": 4}],
        },
    )
    reference, damped, strong, weak_motion, other_levels = variants
    assert damped.building == replace(reference.building, damping=damped.building.damping)
    assert damped.building.damping.ratio == 0.08
    assert (strong.building.model, strong.building.masonry.base_shear) == ("hysteretic", 0.15)
    assert (weak_motion.building.model, weak_motion.ground_scale) == ("hysteretic", 0.25)
    assert dict(other_levels.building.floors) == {"GF": 0, "F3": 2, "F5": 4}
    with pytest.raises(InputError, match="axis 'colour' of the sensitivity is unknown"):
        building_variants(settings, {"colour": ["red"]})
    with pytest.raises(InputError, match="level 9"):
        building_variants(settings, {"floors": [{"F5": 9}]})
