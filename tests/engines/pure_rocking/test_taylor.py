"""Series written out in the kernels are those of the plain method; a contact closed at once keeps its momentum."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.pure_rocking.ensembles import body_record
from rockfrag.engines.pure_rocking.kernels import equations as eq
from rockfrag.engines.pure_rocking.kernels.chatter import Hop, closed
from rockfrag.engines.pure_rocking.kernels.impact import stuck
from rockfrag.engines.pure_rocking.kernels.lanes.series import rates_of_two
from rockfrag.engines.pure_rocking.kernels.lanes.stack_constants import (
    IMPACT,
    ONE,
    TWO,
    fill_constants,
)
from rockfrag.engines.pure_rocking.kernels.taylor import (
    ORDER,
    SERIES,
    Step,
    fill_series,
)

from .kernel_impact import state_record

BODY = body_record(
    Stack(Block(0.4, 0.3, 100.0), Block(0.3, 1.2, 200.0, cg_offset=0.01)).system()
)
H, GROUND, RISE = 0.01, 2.0, -1.5
GRAVITY, LIFT = 9.0, 3.0  # of a ground that moves vertically too


def product(u, v, k):
    return sum(u[j] * v[k - j] for j in range(k + 1))


def series_by_recurrence(mass, moments, gravity, angles, rates, ground):
    """Both angles over a step: M(Δ) θ'' + D(Δ) (θ2'², -θ1'²) + f = 0, every coefficient from those before it.

    ``mass``: M11, M22, E, F; ``gravity``, ``ground``: accelerations, and what they grow by; time in steps.
    """
    (m11, m22, e, f), a, g = mass, [*ground, *[0.0] * ORDER], [*gravity, *[0.0] * ORDER]
    theta = [[angles[i], rates[i]] for i in (0, 1)]
    turned = (*angles, angles[1] - angles[0])
    s, c = ([[of(x)] for x in turned] for of in (math.sin, math.cos))
    for k in range(ORDER - 1):
        turn = [*theta, [q - p for p, q in zip(*theta, strict=True)]]
        rate = [[(j + 1) * t[j + 1] for j in range(k + 1)] for t in turn]
        coupled = [e * c[2][j] + f * s[2][j] for j in range(k + 1)]
        d = [f * c[2][j] - e * s[2][j] for j in range(k + 1)]
        right = []
        for i, (vx, vy) in enumerate(moments):
            push = product(
                a, [vy * y - vx * x for x, y in zip(s[i], c[i], strict=True)], k
            )
            weight = product(
                g, [vx * x + vy * y for x, y in zip(c[i], s[i], strict=True)], k
            )
            square = [product(rate[1 - i], rate[1 - i], j) for j in range(k + 1)]
            bend = [(j + 1) * (j + 2) * theta[1 - i][j + 2] for j in range(k)] + [0.0]
            right.append(
                weight
                - push
                - (1 - 2 * i) * product(d, square, k)
                - product(coupled, bend, k)
            )
        q = np.linalg.solve([[m11, coupled[0]], [coupled[0], m22]], right)
        for i in (0, 1):
            theta[i].append(q[i] / ((k + 1) * (k + 2)))
        for i in range(3):
            s[i].append(product(c[i], rate[i], k) / (k + 1))
            c[i].append(-product(s[i][:-1], rate[i], k) / (k + 1))
    return np.array(theta)


@entry_kernel
def constants_of(body):
    e, f = eq.coupling(body, 1.0, -1.0)
    mass = eq.inertia1(body, 1.0, -1.0), eq.inertia2(body, -1.0), e, f
    return mass, eq.first_moment1(body, 1.0, -1.0), eq.first_moment2(body, -1.0)


@entry_kernel
def fill(body, state, step, series):
    fill_series(body, state, step, series)


@entry_kernel
def written_out(mass, weight1, weight2, rates, ground, gravity):
    return rates_of_two(mass, weight1, weight2, rates, ground, gravity)


def step_of(theta, omega):
    mass, moment1, moment2 = constants_of(BODY)
    scaled = [(H * H * x, H * H * y) for x, y in (moment1, moment2)]
    rates = [H * w for w in omega]
    return mass, scaled, (GRAVITY, LIFT), theta, rates, (GROUND, RISE)


CASES = [
    ((0.10, -0.05), (0.4, -0.9)),
    ((0.02, 0.0), (-1.0, 2.0)),
    ((0.3, 0.05), (0.0, 0.0)),
]


@pytest.mark.parametrize(("theta", "omega"), CASES)
def test_the_series_of_histories_and_of_lanes_are_those_of_the_recurrence(theta, omega):
    mass, moments, gravity, _, rates, ground = step_of(theta, omega)
    plain = series_by_recurrence(*step_of(theta, omega))
    state = state_record((1, -1), theta, omega, (0.0, GRAVITY))
    series = np.zeros(1, SERIES)[0]
    fill(BODY, state, Step(H, GROUND, RISE, GRAVITY, LIFT), series)
    for name, angle in zip(("one", "two"), plain, strict=True):
        np.testing.assert_allclose(series[name]["angle"], angle, rtol=1e-9, atol=1e-18)
    m11, m22, e, f = mass
    c, s = math.cos(theta[1] - theta[0]), math.sin(theta[1] - theta[0])
    weights = [
        (vy * math.cos(t) - vx * math.sin(t), vx * math.cos(t) + vy * math.sin(t))
        for t, (vx, vy) in zip(theta, moments, strict=True)
    ]
    coupled = m11, m22, e * c + f * s, f * c - e * s
    found = written_out(coupled, *weights, tuple(rates), ground, (*gravity, True))
    for item, angle in zip(found, plain, strict=True):
        np.testing.assert_allclose(
            item, angle[1:] * np.arange(1, ORDER + 1), rtol=1e-9, atol=1e-17
        )


@entry_kernel
def closed_both_ways(body, hop, state, constants, scratch):
    """Velocities of a contact that stays closed, as it is closed at once and as an impact would close it."""
    ones, twos, impacts = constants
    fill_constants(body, 1.0, ones, twos, impacts, scratch)
    at_once = closed(hop, twos[eq.number_of(state.c1, state.c2)])
    c1, c2 = (0, state.c2) if hop.ground else (state.c1, 0)
    return at_once, stuck(body, state, c1, c2)


@pytest.mark.parametrize(("ground", "theta"), [(True, (0.0, 0.2)), (False, (0.2, 0.2))])
@pytest.mark.parametrize("side", [1, -1])
def test_closing_at_once_is_an_impact_that_sticks(ground, theta, side):
    state, scratch = np.zeros(2, eq.STATE)
    state["theta1"], state["theta2"] = theta
    state["c1"], state["c2"] = (side, 1) if ground else (1, side)
    state["omega1"], state["omega2"] = (
        (side * 0.03, 0.4) if ground else (0.4, 0.4 + side * 0.03)
    )
    w1, w2 = float(state["omega1"]), float(state["omega2"])
    old = -0.1 * side
    hop = Hop(ground, side, old, math.cos(theta[1]), math.sin(theta[1]), w1, w2)
    constants = np.zeros(9, ONE), np.zeros(9, TWO), np.zeros(9, IMPACT)
    at_once, by_impact = closed_both_ways(BODY, hop, state, constants, scratch)
    np.testing.assert_allclose(at_once, by_impact, rtol=1e-12)
