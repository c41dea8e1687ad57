from pathlib import Path

import pytest

from rockfrag.errors import InputError
from rockfrag.shaketable.instruments import Accelerometer, ForceOverMass
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.settings import make_protocol, make_shaker, read_shaker
from rockfrag.shaketable.shaker import Shaker
from rockfrag.shaketable.steps import ForceSteps, GeometricSteps, LinearSteps

SHAKER = Path(__file__).resolve().parents[2] / "config" / "experiment" / "shaker.yaml"

GEOMETRIC = {"kind": "geometric", "start_g": 0.05, "growth": 0.05}


def test_the_shaker_of_the_thesis_is_what_the_configuration_holds():
    assert read_shaker(SHAKER) == Shaker()


def test_protocols_are_made_from_mappings():
    assert make_protocol({"steps": GEOMETRIC}) == Protocol(GeometricSteps(0.05, 0.05))
    linear = {"kind": "linear", "start_g": 0.05, "step_g": 0.02}
    force = {"kind": "force", "start_n": 5, "step_n": 5, "moved_mass_kg": 12.172}
    assert make_protocol({"steps": linear}).steps == LinearSteps(0.05, 0.02)
    assert make_protocol({"steps": force}).steps == ForceSteps(5.0, 5.0, 12.172)
    whole = make_protocol(
        {
            "steps": GEOMETRIC,
            "limit_g": 1,
            "repetitions": 3,
            "reading": "at",
            "measurement": {"kind": "accelerometer", "clip_g": 2},
        }
    )
    assert whole == Protocol(GeometricSteps(0.05, 0.05), 1.0, 3, "at", Accelerometer(2.0))
    mass = {"kind": "force_over_mass", "believed_mass_kg": {"T1": 7}, "unaccounted_mass_kg": 10}
    found = make_protocol({"steps": GEOMETRIC, "measurement": mass}).measurement
    assert found == ForceOverMass({"T1": 7.0}, 10.0)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({}, "steps are missing"),
        ({"steps": {"kind": "wild"}}, "steps: kind must be one of linear, geometric, force"),
        ({"steps": {"kind": "linear", "start_g": 0.1}}, "steps: step_g is missing"),
        ({"steps": GEOMETRIC | {"step_g": 1}}, "unknown key 'step_g'"),
        ({"steps": GEOMETRIC, "reading": "after"}, "'before' or 'at'"),
        ({"steps": GEOMETRIC, "repetitions": 2.5}, "whole number from 1"),
        ({"steps": GEOMETRIC, "measurement": {"kind": "accelerometer"}}, "clip_g must be a number"),
        ({"steps": GEOMETRIC, "measurement": {"kind": "force_over_mass"}}, "believed_mass_kg"),
        ({"steps": GEOMETRIC, "limit": 1}, "unknown key 'limit'"),
    ],
)
def test_wrong_protocols_are_refused_in_one_sentence(settings, message):
    with pytest.raises(InputError, match=message) as refused:
        make_protocol(settings, "thesis.yaml: protocol")
    assert str(refused.value).startswith("thesis.yaml: protocol: ")
    assert str(refused.value).endswith(".")


def test_wrong_shakers_are_refused(tmp_path):
    with pytest.raises(InputError, match="unknown key 'stroke'"):
        make_shaker({"stroke": 0.29})
    with pytest.raises(InputError, match="force_n must be a number"):
        make_shaker({"force_n": "500 N"})
    with pytest.raises(InputError, match="shaker: stroke must be a positive"):
        make_shaker({"stroke_m": -1})
    with pytest.raises(InputError, match="cannot be read"):
        read_shaker(tmp_path / "absent.yaml")
