"""Modes that are solved by formulas beside the elimination that solves them all."""

import numpy as np
import pytest

from rockfrag.engines.kernels.jit import entry_kernel
from rockfrag.engines.planar.records import posed, system_record, working_memory
from rockfrag.engines.planar.solve import look_at, solve, solve_generally
from rockfrag.rocking.options import system_of

from .cases import random_block, random_stack


@entry_kernel
def by_formulas(p, w, ah, av):
    look_at(p, w, w.q)
    solve(p, w, w.q, w.v, ah, av, False)


@entry_kernel
def by_elimination(p, w, ah, av):
    look_at(p, w, w.q)
    solve_generally(p, w, w.q, w.v, ah, av, False, True, 0)


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
            forces = np.concatenate([w["normal"][: top + 1].ravel(), w["shear"][: top + 1]])
            found.append(np.concatenate([w["out"][: 3 * top + 3], forces / p["weight"]]))
        np.testing.assert_allclose(found[0], found[1], rtol=1e-9, atol=1e-10)
