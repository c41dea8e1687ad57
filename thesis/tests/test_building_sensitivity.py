"""The building's part: variants of it, each with the tests that its floors give."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.study.configurations import configuration_of, each_alone
from rockfrag.system.blocks import Block
from rockfrag_thesis.building_sensitivity import building_sensitivity, building_variants

BUILDING = Path(__file__).resolve().parents[2] / "config" / "building.yaml"
TOWERS = {"T1": Block(0.124, 0.372, 2.172), "T2": Block(0.124, 0.496, 2.790)}
BLOCKS = {**TOWERS, "P": Block(0.184, 0.208, 2.300)}


@pytest.fixture
def settings():
    return yaml.safe_load(BUILDING.read_text(encoding="utf-8"))


def wave(frequency, name):
    t = np.arange(300) * 0.01
    shaken = np.sin(2 * np.pi * frequency * t) * np.sin(np.pi * t / t[-1])
    return Motion(2 * shaken, 0.01, name, {"earthquake": name})


def test_a_variant_equal_to_the_reference_gives_the_same_tests(settings):
    alone, steps = each_alone(TOWERS), GeometricSteps(0.2, 0.05)
    stacks = [configuration_of(f"P&{name}", ("P", name), BLOCKS) for name in TOWERS]
    tests = building_sensitivity(
        building_variants(settings, {"first_period_s": [0.35, 0.9]}),
        [wave(1.5, "one"), wave(3.0, "two")],
        [alone[0], stacks[0], alone[1], stacks[1]],
        steps.amplitudes(1.2),
        Protocol(steps, limit_g=1.2),
    )
    by_label = {
        label: rows.drop(columns=["axis", "value", "credible", "label"]).reset_index(
            drop=True
        )
        for label, rows in tests.groupby("label")
    }
    pd.testing.assert_frame_equal(
        by_label["reference"], by_label["first period 0.35 s"]
    )
    assert not by_label["reference"].equals(by_label["first period 0.9 s"])
    # the ground floor does not know the building
    ground = [
        table[table["floor"] == "GF"].reset_index(drop=True)
        for table in by_label.values()
    ]
    pd.testing.assert_frame_equal(ground[0], ground[1])
    assert tests["credible"].groupby(tests["label"]).nunique().eq(1).all()


def test_each_axis_changes_what_it_names(settings):
    values = {"damping_ratio": 0.08, "base_shear": 0.15, "ground_scale": 0.25}
    values["floors"] = {"F3": 2, "F5": 4}
    variants = building_variants(
        settings, {name: [value] for name, value in values.items()}
    )
    reference, damped, strong, weak_motion, other_levels = variants
    assert damped.building == replace(
        reference.building, damping=damped.building.damping
    )
    assert damped.building.damping.ratio == 0.08
    assert (strong.building.model, strong.building.masonry.base_shear) == (
        "hysteretic",
        0.15,
    )
    assert (weak_motion.building.model, weak_motion.ground_scale) == (
        "hysteretic",
        0.25,
    )
    assert dict(other_levels.building.floors) == {"GF": 0, "F3": 2, "F5": 4}
    with pytest.raises(InputError, match="axis 'colour' of the sensitivity is unknown"):
        building_variants(settings, {"colour": ["red"]})
    with pytest.raises(InputError, match="level 9"):
        building_variants(settings, {"floors": [{"F5": 9}]})
