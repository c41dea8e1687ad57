"""Every option at every door: it works, or two wishes that cannot be met together are named in one sentence."""

import itertools

import numpy as np
import pandas as pd
import pytest

from rockfrag import (
    Block,
    Column,
    MeasuredRestitution,
    Stack,
    find_step_size_sensitive,
    find_thresholds,
    outcome_robustness,
    overturns,
    rocking_spectrum,
    simulate,
)
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.rocking.parquet import stream_histories, stream_overturns

DT = 0.01
TIME = np.arange(0.0, 1.5, DT)
SHAKE = 4.0 * np.sin(2 * np.pi * 1.5 * TIME)
UP = 0.3 * np.sin(2 * np.pi * 3 * TIME)
UPPER = Block(0.3, 1.2, 180.0)
BODIES = {
    "block": UPPER,
    "stack": Stack(Block(0.6, 0.4, 300.0), UPPER),
    "column": Column((Block(0.6, 0.4, 300.0), Block(0.45, 0.3, 120.0), UPPER)),
}
OPTIONS = {
    "restitution": lambda body: MeasuredRestitution(
        0.9 if body is UPPER else {"ground": None, "interface": 0.9}
    ),
    "friction": lambda body: 0.4,
    "vertical": lambda body: UP,
    "theta0": lambda body: 0.01 if body is UPPER else (0.0,) * (len(body.blocks) - 1) + (0.01,),
    "linear": lambda body: True,
    "forces": lambda body: True,
}
EACH_BODY = ("restitution", "theta0")


def stream(body, folder, **options):
    stream_overturns(body, SHAKE, DT, [0.5, 1.0], folder / "outcomes.parquet", **options)
    return pd.read_parquet(folder / "outcomes.parquet")["overturned"]


def histories(body, folder, **options):
    stream_histories(body, SHAKE, DT, [0.5], folder / "histories.parquet", **options)
    return pd.read_parquet(folder / "histories.parquet")["theta_rad"]


def thresholds(body, folder, **options):
    wanted = {"tolerance": 0.2, "narrowest_resurrection": 0.5}
    return find_thresholds(body, SHAKE, DT, 1.0, **wanted, **options).table[["body"]]


def robustness(body, folder, **options):
    return outcome_robustness(body, SHAKE, DT, [0.5], perturbation=1e-6, copies=1, **options)


DOORS = {
    "single": lambda body, _, **more: simulate(body, SHAKE, DT, **more).theta,
    "many": lambda body, _, **more: overturns(body, SHAKE, DT, [0.5, 1.0], **more).overturned,
    "thresholds": thresholds,
    "stream": stream,
    "histories": histories,
    "robustness": robustness,
    "step": lambda body, _, **more: (
        find_step_size_sensitive(body, SHAKE, DT, [0.5, 1.0], sample=2, **more).cases
    ),
}
FORCES = ("many", "stream")
"""Doors that tell forces."""

CONFLICTS = ("cannot be had together with", "is beyond every engine")
CASES = [(), *((option,) for option in OPTIONS), *itertools.combinations(OPTIONS, 2)]


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize("kind", list(BODIES))
@pytest.mark.parametrize("door", DOORS)
def test_every_pair_of_options_works_or_is_refused_in_one_sentence(door, kind, tmp_path):
    body, worked = BODIES[kind], 0
    for names in CASES:
        options = {k: OPTIONS[k](body) for k in names if k != "forces" or door in FORCES}
        if door != "single":
            options |= {k: [options[k]] for k in EACH_BODY if k in options}
        try:
            answer = np.asarray(DOORS[door](body, tmp_path, **options))
        except InputError as error:
            said = str(error)
            assert any(words in said for words in CONFLICTS), (names, said)
            assert said.count(". ") == 0
        else:
            assert np.isfinite(answer.astype(float)).all()
            worked += 1
    assert worked >= 6


def test_what_a_spectrum_takes_works():
    for names in ((), ("restitution",), ("friction",), ("vertical",), ("friction", "vertical")):
        options = {name: OPTIONS[name](UPPER) for name in names}
        if "restitution" in options:
            options["restitution"] = 0.8
        found = rocking_spectrum(Motion(SHAKE, DT), [2.0], 0.25, **options)
        assert found.rotation.shape == (1, 1)
