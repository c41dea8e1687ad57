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
    stream_histories,
    stream_overturns,
)
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

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


def single(body, options, folder):
    options = {k: v for k, v in options.items() if k != "forces"}
    return simulate(body, SHAKE, DT, **options).theta


def many(body, options, folder):
    return overturns(body, SHAKE, DT, [0.5, 1.0], **listed(options)).overturned


def thresholds(body, options, folder):
    options = listed({k: v for k, v in options.items() if k != "forces"})
    found = find_thresholds(
        body, SHAKE, DT, 1.0, tolerance=0.2, narrowest_resurrection=0.5, **options
    )
    return found.table[["body"]]


def stream(body, options, folder):
    path = folder / "outcomes.parquet"
    stream_overturns(body, SHAKE, DT, [0.5, 1.0], path, **listed(options))
    return pd.read_parquet(path)["overturned"]


def histories(body, options, folder):
    options = listed({k: v for k, v in options.items() if k != "forces"})
    stream_histories(body, SHAKE, DT, [0.5], folder / "histories.parquet", **options)
    return pd.read_parquet(folder / "histories.parquet")["theta_rad"]


def robustness(body, options, folder):
    options = listed({k: v for k, v in options.items() if k != "forces"})
    return outcome_robustness(body, SHAKE, DT, [0.5], perturbation=1e-6, copies=1, **options)


def step_sensitivity(body, options, folder):
    options = listed({k: v for k, v in options.items() if k != "forces"})
    return find_step_size_sensitive(body, SHAKE, DT, [0.5, 1.0], sample=2, **options).cases


def spectrum(body, options, folder):
    if body is not UPPER or set(options) & {"theta0", "linear", "forces"}:
        pytest.skip("a rocking spectrum is of uniform blocks that start at rest")
    return rocking_spectrum(Motion(SHAKE, DT), [2.0], 0.25, **options).rotation


DOORS = (single, many, thresholds, stream, histories, robustness, step_sensitivity, spectrum)


def listed(options):
    return {k: [v] if k in EACH_BODY else v for k, v in options.items()}


CONFLICTS = ("cannot be had together with", "is beyond every engine")
CASES = [(), *((option,) for option in OPTIONS), *itertools.combinations(OPTIONS, 2)]


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize("kind", list(BODIES))
@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
def test_every_pair_of_options_works_or_is_refused_in_one_sentence(door, kind, tmp_path):
    body, worked = BODIES[kind], 0
    for names in CASES:
        options = {name: OPTIONS[name](body) for name in names}
        try:
            answer = np.asarray(door(body, options, tmp_path))
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
