"""Newton's, Euler's and Coulomb's laws in each sample of short histories, by differences of what they tell.

A column is statically determinate: the bodies above a contact are pushed by it and by nothing else.  Nothing here
knows how modes are found; histories are so short that kernels may run as plain Python (``tests/mutants``).
"""

import math
from collections import Counter

import numpy as np
import pytest

from rockfrag.engines.planar import engine
from rockfrag.engines.planar.integrate import IMPACT

from ...oracle import witness
from ..sample_balance import STEP, check_contact, pushes_of
from .cases import G, random_column, run, with_contacts
from .violations import history_of, worst_violations


@pytest.fixture(autouse=True)
def nothing_after_the_motion(monkeypatch):
    """A history ends with its motion here, so that it is short."""
    whole = engine.shaking_of
    monkeypatch.setattr(
        engine,
        "shaking_of",
        lambda case, scale: whole(case, scale)._replace(free_samples=0),
    )


def shaken(rng, bodies):
    """A column on rough or smooth contacts, and a ground that starts with a jerk and changes linearly [m/s²]."""
    kinetic = rng.uniform(0.1, 0.6, bodies)
    frictions = [(float(mu * rng.uniform(1.0, 1.5)), float(mu)) for mu in kinetic]
    system = with_contacts(random_column(rng, bodies), frictions)
    start, rate = rng.uniform(-8, 8, 2), rng.uniform(-60, 60, 2)
    # up and down less than what lifts off
    ground = (start + rate * STEP * np.arange(30)[:, None]) * (1.0, 0.8)
    return system, ground


@pytest.mark.parametrize(("bodies", "columns"), [(1, 16), (2, 8), (4, 4)])
def test_what_a_contact_pushes_moves_all_above_it_and_friction_allows_it(
    bodies, columns
):
    rng, seen = np.random.default_rng(bodies), Counter()
    for _ in range(columns):
        system, ground = shaken(rng, bodies)
        column = witness.Column.of(system, G)
        found = run(system, ground[:, 0], STEP, vertical=ground[:, 1])
        times = found.contact_events["time"].to_numpy()
        for k in range(2, min(len(ground), len(found.time)) - 2, 3):
            if (np.abs(times - k * STEP) < 1.5 * STEP).any():
                continue
            forces, moments = pushes_of(column, found, ground, k)
            for number in range(bodies):
                force, moment = forces[number], float(moments[number])
                seen[check_contact(column, found, k, number, force, moment)] += 1
    assert {"stands", "rocks", "slides"} <= set(seen)
    assert seen["between"] < 0.2 * seen.total()


def test_the_first_impacts_of_shaken_columns_obey_their_laws():
    """Feet that come down, corners that land after a flight; static above kinetic friction."""
    rng, seen = np.random.default_rng(8), 0
    time = 0.01 * np.arange(50)
    for bodies in (1, 1, 1, 1, 2, 2, 3):
        system, _ = shaken(rng, bodies)
        motion = rng.uniform(5, 9) * np.sin(2 * math.pi * rng.uniform(2, 4) * time)
        up = rng.uniform(5, 15) * np.sin(2 * math.pi * rng.uniform(3, 5) * time)
        found = history_of(system, motion, up, 1e-6)
        struck = found.contact_events
        struck = struck[struck["kind"] == IMPACT]
        assert found.work["outcome"]["paradoxes"] == 0
        assert max(worst_violations(system, struck, 1e-6).values(), default=0) < 1
        seen += len(struck)
    assert seen > 20
