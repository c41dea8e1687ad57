"""Short histories and short ensembles: Newton's and Euler's laws, and the same impacts both ways.

So short that kernels may run as plain Python (``tests/mutants``).
"""

import math
from collections import Counter

import numpy as np
import pytest

from rockfrag.engines.contract import Case, Cases, Request
from rockfrag.engines.pure_rocking import ensembles, histories
from rockfrag.simulation.inputs import ground_motion
from rockfrag.system import as_system, geometry

from ...oracle import witness
from ..planar.cases import G, random_block, random_stack
from ..sample_balance import STEP, check_contact, pushes_of

DT = 0.01


@pytest.fixture(autouse=True)
def nothing_after_the_motion(monkeypatch):
    """Free rocking is not followed here."""
    for module in (histories, ensembles):
        monkeypatch.setattr(
            module, "free_samples", lambda system, dt, g: np.zeros_like(dt, np.int64)
        )


def drawn(rng, bodies):
    """A block or a stack on contacts that never slide."""
    return as_system(random_block(rng) if bodies == 1 else random_stack(rng))


@pytest.mark.parametrize(("bodies", "cases"), [(1, 12), (2, 12)])
def test_what_a_pivot_pushes_moves_all_above_it(bodies, cases):
    rng, seen = np.random.default_rng(bodies), Counter()
    for _ in range(cases):
        system = drawn(rng, bodies)
        column = witness.Column.of(system, G)
        start, rate = rng.uniform(-8, 8, 2), rng.uniform(-60, 60, 2)
        # up and down less than what lets pivots pull
        ground = (start + rate * STEP * np.arange(24)[:, None]) * (1.0, 0.5)
        motion = ground_motion(ground[:, 0], STEP, ground[:, 1])
        found = histories.history(Case(system, motion, request=Request(g=G)))
        times = found.contact_events["time"].to_numpy()
        for k in range(2, min(len(ground), len(found.time)) - 2, 3):
            if (np.abs(times - k * STEP) < 1.5 * STEP).any():
                continue
            forces, moments = pushes_of(column, found, ground, k)
            for number in range(bodies):
                pushed = forces[number], float(moments[number])
                seen[check_contact(column, found, k, number, *pushed)] += 1
    assert set(seen) == {"stands", "rocks"}


def largest_rotation(system, theta):
    """Largest rotation of each body over its critical angle to that side, and in which sample."""
    ratios = np.zeros_like(theta)
    for k, shape in enumerate(system.carried):
        right, left = (geometry.critical_angle(shape, pivot) for pivot in (1, -1))
        ratios[:, k] = np.where(
            theta[:, k] > 0, theta[:, k] / right, -theta[:, k] / left
        )
    return ratios.max(axis=0), ratios.argmax(axis=0)


@pytest.mark.parametrize(("bodies", "cases", "least"), [(1, 3, 4), (2, 3, 2)])
def test_an_ensemble_has_the_peaks_of_single_histories(bodies, cases, least):
    rng, compared = np.random.default_rng(10 + bodies), 0
    run = ensembles.run_blocks if bodies == 1 else ensembles.run_stacks
    for _ in range(cases):
        system = drawn(rng, bodies)
        time = DT * np.arange(70)
        # one push: what comes long after it is smaller
        lasts = rng.uniform(0.1, 0.25)
        push = np.where(time < lasts, np.sin(math.pi * time / lasts), 0.0)
        up = 2.0 * np.sin(2 * math.pi * rng.uniform(3.0, 6.0) * time)
        motion = ground_motion(rng.choice([-G, G]) * push, DT, up)
        scales = np.array([[0.4, 0.6, 0.8]])
        many = run(Cases((system,), (motion,), scales, Request(g=G)))
        for k, scale in enumerate(scales[0]):
            one = histories.history(Case(system, motion, scale, Request(g=G)))
            fell = bool(many.overturned[0, 0, k])
            assert fell or not one.overturned
            peaks, at = largest_rotation(system, one.theta)
            if not fell and at.max() < 40 and peaks.max() > 1e-2:
                found = many.peak_rotation[0, 0, k]
                np.testing.assert_allclose(found, peaks, rtol=0.02, atol=2e-3)
                compared += 1
    assert compared >= least
