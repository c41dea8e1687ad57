"""The search for a mode beside the trial of all modes."""

from collections import Counter

import numpy as np
import pytest

from rockfrag.engines.planar.records import MOST, posed, system_record, working_memory

from .columns import G, random_column, with_contacts
from .full_search import consistent, modes_of, search_quickly, try_all


def situation(rng: np.random.Generator, bodies: int, impact: bool) -> tuple[np.void, np.void]:
    """Draw a column some of whose ends touch, how it moves, and the mode that the search starts from."""
    mus = list(rng.uniform(0.1, 1.5, bodies)) if rng.uniform() < 0.8 else [1e6] * bodies
    p = system_record(with_contacts(random_column(rng, bodies), mus), G)
    theta, touching = np.zeros(bodies), np.zeros((bodies, 2), int)
    for k in range(bodies):
        below = theta[k - 1] if k else 0.0
        ends = rng.choice(4, p=[0.1, 0.25, 0.25, 0.4])
        theta[k] = below + (0.0 if ends == 3 else rng.choice([-1, 1]) * rng.uniform(0.001, 0.2))
        if ends == 3:
            touching[k] = 1
        elif ends:
            touching[k, int(theta[k] > below)] = 1
    w = working_memory()
    w["drive"][:], w["kind"][:] = -1, 1
    w["q"], _ = posed(p, theta.tolist(), [0.0] * bodies)
    w["touching"][:bodies], w["limit"][:bodies] = touching, mus
    v = np.zeros(3 * MOST)
    if impact:
        v[: 3 * bodies] = rng.normal(0, 1, 3 * bodies) * np.tile([0.3, 0.3, 1.0], bodies)
    else:
        w["moves"][:bodies] = rng.choice([0, 1, -1], bodies, p=[0.5, 0.25, 0.25])
        w["moves"][:bodies] *= touching.any(axis=1)
        v[2 : 3 * bodies : 3] = rng.normal(0, 0.5)
    w["v"] = v
    w["closed"][:bodies] = touching * (rng.uniform(size=(bodies, 2)) < 0.7)
    closed = w["closed"][:bodies].any(axis=1)
    w["slides"][:bodies] = np.where(closed, rng.choice([0, 1, -1], bodies), 0)
    return p, w


def closed_ends(mode: int) -> int:
    """Number of closed ends of a numbered mode."""
    return sum(bin((mode >> (4 * k)) & 3).count("1") for k in range(MOST))


def compare_searches(number: int, seed: int) -> Counter:
    """Count how the mode found differs from the first consistent one."""
    rng, counts = np.random.default_rng(seed), Counter()
    while counts.total() < number:
        bodies, impact = int(rng.integers(1, 4)), bool(rng.integers(2))
        p, w = situation(rng, bodies, impact)
        if not w["touching"].any():
            continue
        loads, speed = rng.normal(0, [4.0, 2.0]), float(np.abs(w["v"]).max())
        units = (float(p["mass"].sum()) * speed, speed) if impact else (float(p["weight"]), G)
        start = w["closed"].copy(), w["slides"].copy()
        modes = modes_of(w["touching"][:bodies], w["moves"], impact)
        margins = np.zeros(modes.size)
        try_all(p, w, *loads, impact, *units, modes, margins)
        w["closed"], w["slides"] = start
        found = search_quickly(p, w, *loads, impact, *units)
        good = consistent(margins)
        if not good.any():
            # without a consistent mode the least violated one is taken
            least = bool(margins[modes == found][0] >= margins.max() - 1e-6)
            counts["none, least violated" if least else "none, another"] += 1
        elif found == modes[good][0]:
            counts["same"] += 1
        elif good[modes == found].any():
            more = closed_ends(found) - closed_ends(int(modes[good][0]))
            counts[
                "consistent too, as many closed" if more == 0 else "consistent too, more closed"
            ] += 1
        else:
            counts["not consistent"] += 1
    return counts


@pytest.mark.parametrize(
    ("number", "seed"), [(3000, 1), pytest.param(100_000, 2, marks=pytest.mark.slow)]
)
def test_the_search_finds_a_consistent_mode_wherever_there_is_one(number: int, seed: int) -> None:
    """And the first one nearly always."""
    counts = compare_searches(number, seed)
    print(dict(counts))
    assert counts["not consistent"] == 0
    assert counts["same"] > 0.85 * number
    assert counts["consistent too, as many closed"] < 0.015 * number
    assert counts["consistent too, more closed"] < 0.004 * number
