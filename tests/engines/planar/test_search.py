"""The search for a mode beside the trial of all modes, and formulas of modes beside the elimination."""

import itertools
from collections import Counter

import numpy as np
import pytest

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.planar.impact import VANISHING
from rockfrag.engines.planar.records import MOST, posed, system_record, working_memory
from rockfrag.engines.planar.search import (
    CONSISTENT,
    NONE,
    Trial,
    mode_number,
    prepare,
    search,
    take_mode,
    try_mode,
)
from rockfrag.engines.planar.solve import (
    Sought,
    look_at,
    solve_generally,
    solve_motion,
)
from rockfrag.engines.planar.support import GUIDED
from rockfrag.engines.planar.walls import wall_end
from rockfrag.simulation.options import system_of
from rockfrag.system import BilinearIsolator, Wall, hold

from .cases import G, random_block, random_column, random_stack, with_contacts


def situation(
    rng: np.random.Generator, bodies: int, impact: bool
) -> tuple[np.void, np.void]:
    """Draw a column some of whose ends touch, how it moves, and the mode that the search starts from."""
    mus = list(rng.uniform(0.1, 1.5, bodies)) if rng.uniform() < 0.8 else [1e6] * bodies
    p = system_record(with_contacts(random_column(rng, bodies), mus), G)
    theta, touching = np.zeros(bodies), np.zeros((bodies, 2), int)
    for k in range(bodies):
        below = theta[k - 1] if k else 0.0
        ends = rng.choice(4, p=[0.1, 0.25, 0.25, 0.4])
        theta[k] = below + (
            0.0 if ends == 3 else rng.choice([-1, 1]) * rng.uniform(0.001, 0.2)
        )
        if ends == 3:
            touching[k] = 1
        elif ends:
            touching[k, int(theta[k] > below)] = 1
    w = working_memory()
    w["drive"][:], w["kind"][:] = -1, 1
    w["q"], _ = posed(p, theta.tolist(), [0.0] * bodies)
    w["touching"][:bodies] = touching
    w["along"][:bodies] = w["against"][:bodies] = mus
    v = np.zeros(3 * MOST)
    if impact:
        v[: 3 * bodies] = rng.normal(0, 1, 3 * bodies) * np.tile(
            [0.3, 0.3, 1.0], bodies
        )
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
        units = (
            (float(p["mass"].sum()) * speed, speed)
            if impact
            else (float(p["weight"]), G)
        )
        trial = Trial(*loads.tolist(), impact, *units)
        start = w["closed"].copy(), w["slides"].copy()
        modes = modes_of(w["touching"][:bodies], w["moves"], impact)
        margins = np.zeros(modes.size)
        try_all(p, w, trial, modes, margins)
        w["closed"], w["slides"] = start
        found = search_quickly(p, w, trial)
        good = margins >= -CONSISTENT
        if not good.any():
            # the one that violates least is taken, or another
            counts["none"] += 1
        elif found == modes[good][0]:
            counts["same"] += 1
        elif not good[modes == found].any():
            counts["not consistent"] += 1
        else:
            more = closed_ends(found) > closed_ends(int(modes[good][0]))
            counts["more closed" if more else "as many closed"] += 1
    return counts


@pytest.mark.parametrize(
    ("number", "seed"), [(1000, 1), pytest.param(100_000, 2, marks=pytest.mark.slow)]
)
def test_the_search_finds_a_consistent_mode_wherever_there_is_one(
    number: int, seed: int
) -> None:
    """And the first one nearly always."""
    counts = compare_searches(number, seed)
    assert counts["not consistent"] == 0
    assert counts["same"] > 0.85 * number
    assert counts["as many closed"] < 0.015 * number
    assert counts["more closed"] < 0.004 * number


@pytest.mark.parametrize("bodies", [4, 6, 8])
def test_every_impact_of_a_column_has_a_consistent_mode(bodies: int) -> None:
    """Coulomb's law on velocities has an outcome for any speeds (Stewart and Trinkle, 1996)."""
    rng = np.random.default_rng(1)
    for _ in range(300):
        p, w = situation(rng, bodies, True)
        speed = float(np.abs(w["v"]).max())
        trial = Trial(0.0, 0.0, True, float(p["mass"].sum()) * speed, speed)
        assert violation_found(p, w, trial) <= CONSISTENT


def modes_of(touching: np.ndarray, moves: np.ndarray, impact: bool) -> np.ndarray:
    """Numbers of all modes of touching ends, fewer closed ends first."""
    choices = []
    for k, (left, right) in enumerate(touching.tolist()):
        ways = [int(moves[k])] if moves[k] and not impact else [0, 1, -1]
        closed = [code for code in (1, 2, 3) if code & ~(left + 2 * right) == 0]
        own = [(0, 0), *itertools.product(closed, ways)]
        choices.append([(code + 4 * (way + 1)) << (4 * k) for code, way in own])
    return np.array(sorted(map(sum, itertools.product(*choices)), key=closed_ends))


def stopped_at_its_foot(rng: np.random.Generator, bodies: int, kind: str, mus):
    """Flat column whose foot meets a wall, or whose plate meets its stop, at 1 m/s.

    As ``kind`` is "jam" its plate has been stopped, and the column sinks on it as where no mode is consistent.
    """
    system = with_contacts(random_column(rng, bodies), mus)
    if kind == "wall":
        column = [body.width / 2 + abs(body.ends[0].middle) for body in system.bodies]
        wall = Wall(max(column) + 0.05, 0.0, friction=rng.uniform(0.0, 0.6))
        system = hold(system, wall)
    else:
        plate = BilinearIsolator(mass=100.0, stiffness=100.0, strength=2.0, stroke=0.2)
        system = hold(system, support=plate)
    p, w = system_record(system, G), working_memory()
    count, contacts = int(p["count"]), int(p["contacts"])
    w["q"], _ = posed(p, [0.0] * count, [0.0] * count)
    w["drive"][:], w["kind"][:] = -1, 1
    w["closed"][:count] = w["touching"][:count] = 1
    w["along"][:contacts] = w["against"][:contacts] = p["static"][:contacts]
    w["slides"][0] = 1
    w["whole"][0] = 0 if kind == "wall" else GUIDED
    # as near as the first of its corners lets it come
    at_walls = [k for k in range(count, contacts) if p["side"][k] > 0]
    gaps = {(k, end): gap_of(p, w, k, end) for k in at_walls for end in (0, 1)}
    w["q"][0 : 3 * count : 3] += min(gaps.values())
    w["v"][0 : 3 * count : 3] = 1.0
    if kind == "jam":
        w["v"][0] = 0.0
        w["v"][1 : 3 * count : 3] = -VANISHING * p["speed"]
    for place, gap in gaps.items():
        w["touching"][place] = gap <= min(gaps.values()) + 1e-12
    return p, w


@pytest.mark.parametrize("kind", ["wall", "stop", "jam"])
@pytest.mark.parametrize("bodies", [1, 3, 5])
@pytest.mark.parametrize("sticks", [False, True], ids=["slips", "sticks"])
def test_a_flat_column_that_is_stopped_at_its_foot_has_a_consistent_impact(
    kind: str, bodies: int, sticks: bool
) -> None:
    """A wall asks for what the base holds already, so that many modes say one thing twice."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        mus = [1e6] * bodies if sticks else list(rng.uniform(0.2, 1.0, bodies))
        p, w = stopped_at_its_foot(rng, bodies, kind, mus)
        trial = Trial(0.0, 0.0, True, float(p["mass"].sum()), 1.0)
        assert violation_found(p, w, trial) <= CONSISTENT


@entry_kernel
def gap_of(p, w, k, end):
    """Gap of an end at a wall [m]."""
    look_at(p, w, w.q)
    return wall_end(p, w, w.q, k, end, -1)[4]


@entry_kernel
def violation_found(p, w, trial):
    """How far the mode that the package takes is from consistent."""
    look_at(p, w, w.q)
    return search(p, w, trial, NONE)


@entry_kernel
def try_all(p, w, trial, numbers, margins):
    """Least margin of every mode."""
    look_at(p, w, w.q)
    prepare(p, w, trial)
    for i in range(numbers.size):
        take_mode(p, w, (numbers[i], 0))
        margins[i] = try_mode(p, w, trial)


@entry_kernel
def search_quickly(p, w, trial):
    """Number of the mode that the package takes."""
    look_at(p, w, w.q)
    search(p, w, trial, NONE)
    return mode_number(p, w.closed, w.slides)


@entry_kernel
def by_formulas(p, w, ah, av):
    look_at(p, w, w.q)
    solve_motion(p, w, w.q, w.v, ah, av)


@entry_kernel
def by_elimination(p, w, ah, av):
    look_at(p, w, w.q)
    solve_generally(p, w, w.q, w.v, Sought(ah, av, False, True), 0)


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
@pytest.mark.parametrize("flat", [False, True], ids=["rocks", "flat"])
def test_formulas_give_what_elimination_gives(stacks: bool, flat: bool) -> None:
    rng = np.random.default_rng(3)
    for _ in range(75):
        body = random_stack(rng) if stacks else random_block(rng)
        p = system_record(system_of(body, 0.5), 9.81)
        top = int(p["count"]) - 1
        theta, omega = np.zeros(top + 1), np.zeros(top + 1)
        if not flat:
            theta[top] = rng.uniform(-0.3, 0.3)
            omega[top] = np.sign(theta[top]) * rng.uniform(0, 1)
        w = working_memory()
        w["drive"][:] = -1
        w["q"], w["v"] = posed(p, theta.tolist(), omega.tolist())
        if stacks:
            w["closed"][0] = 1
        w["closed"][top] = 1 if flat else ((0, 1) if theta[top] > 0 else (1, 0))
        w["kind"][:] = 1
        w["slides"][top] = way = rng.integers(-1, 2)
        along = np.array([p["tilt_cos"][top], -p["tilt_sin"][top]])
        w["v"][3 * top : 3 * top + 2] += 0.3 * way * along
        loads = rng.normal(0, 3, 2)
        found = []
        for kernel in (by_formulas, by_elimination):
            kernel(p, w, *loads)
            forces = np.concatenate(
                [w["normal"][: top + 1].ravel(), w["shear"][: top + 1]]
            )
            found.append(
                np.concatenate([w["out"][: 3 * top + 3], forces / p["weight"]])
            )
        np.testing.assert_allclose(found[0], found[1], rtol=1e-9, atol=1e-10)
