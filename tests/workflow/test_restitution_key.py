"""The key ``bodies.restitution`` of a study: what was measured of each block, and the law of stacks."""

from pathlib import Path

import pytest

from rockfrag.errors import InputError
from rockfrag.study.loading import any_study
from rockfrag.system.contact import BY_MOMENTUM, ImpactLaw
from rockfrag.yaml_file import read_yaml

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


def study_with(restitution):
    content = read_yaml(SMOKE)
    return any_study(
        {**content, "bodies": {**content["bodies"], "restitution": restitution}}, SMOKE
    )


def test_each_block_brings_what_was_measured_of_it():
    study = study_with({"law": "ratio", "blocks": {"T1": 0.9, "P": [0.3, 0.35]}})
    found = {
        configuration.name: [under.law for under in configuration.contacts]
        for configuration in study.configurations
    }
    pedestal, tower = ImpactLaw("ratio", 0.3, 0.35), ImpactLaw("ratio", 0.9, 0.9)
    assert found["T1"] == [tower]
    assert found["P&T1"] == [pedestal, tower]
    assert found["T3"] == [BY_MOMENTUM]
    assert found["P&T3"] == [pedestal, BY_MOMENTUM]


def test_without_the_key_momentum_is_conserved():
    configurations = any_study(read_yaml(SMOKE), SMOKE).configurations
    laws = {under.law.name for configuration in configurations for under in configuration.contacts}
    assert laws == {"momentum"}


@pytest.mark.parametrize(
    ("restitution", "message"),
    [
        ({"blocks": {"X": 0.9}}, "blocks: expected names of the specimens T1, .*, found X"),
        ({"blocks": {"T1": 1.1}}, "1.1 would gain energy"),
        ({"law": "newton", "blocks": {"T1": 0.9}}, "expected one of position, couple, ratio"),
        ({"blocks": {"T1": "a"}}, "blocks.T1: expected a ratio"),
        ({}, "restitution"),
    ],
)
def test_what_cannot_be_is_refused_when_the_study_is_read(restitution, message):
    with pytest.raises(InputError, match=message):
        study_with(restitution)
