"""A measured restitution holds in stacks: admissible, continuous, dissipative, and the lone block's own.

Which law carries it over to a stack is asked of contacts that know no law, too. The interface is then a row of
independent dashpots across the base, which push and never pull and act for an instant; the base does not slip, and
the pedestal turns about its corner of the ground.  More weight at the ends of the row makes the base hollow, an
even one flat.  The restitution is measured on the same row under the lone statue.
"""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.base.errors import InputError
from rockfrag.engines.pure_rocking.ensembles import body_record
from rockfrag.laws import law_names
from rockfrag.simulation import MeasuredRestitution
from rockfrag.simulation.options import system_of
from rockfrag.system import geometry

from ...conftest import printed_alone
from ...oracle.rocking_model import Model
from ...oracle.standing import upper_on_contact
from ...simulation.reference_bodies import T3, P, measured, polyline
from .kernel_impact import kernel_impact, state_record

G = 9.81
STILL = np.zeros(300)
IMPACTS = [  # old contacts, and which of them close
    *(((0, 1), (False, True)), ((1, 0), (True, False))),
    *product(((1, 1), (1, -1)), ((False, True), (True, False))),
]
EVERY_IMPACT = [*IMPACTS, ((1, 1), (True, True)), ((1, -1), (True, True))]


def random_stack(rng, crooked=True):
    """A statue on a pedestal, every other one crooked."""
    base, slenderness = rng.uniform(0.1, 0.5), rng.uniform(1.6, 6)
    below, squatness = base * rng.uniform(1, 1.8), rng.uniform(0.9, 2.5)
    off, off_below = (
        rng.normal(0, [0.05 * base, 0.03 * below]) * rng.integers(2) * crooked
    ).tolist()
    mass = 1000 * below**2 * squatness * rng.uniform(0.3, 3)
    upper = Block(base, base * slenderness, 1000 * base**2 * slenderness, cg_offset=off)
    return Stack(Block(below, below * squatness, mass, cg_offset=off_below), upper)  # fmt: skip


def random_impact(rng, kind):
    """Contacts, closing ones, rotations and velocities before an impact of a stack."""
    (c1, c2), closes = EVERY_IMPACT[kind]
    side = int(rng.choice([1, -1]))
    c1, c2 = side * c1, side * c2
    omega1 = c1 * abs(rng.normal()) * (-1 if closes[0] else rng.choice([1, -1]))
    relative = c2 * abs(rng.normal()) * (-1 if closes[1] else rng.choice([1, -1]))
    theta1 = 0.0 if closes[0] or c1 == 0 else c1 * rng.uniform(0, 0.1)
    theta2 = theta1 if closes[1] or c2 == 0 else theta1 + c2 * rng.uniform(0, 0.1)
    theta = float(theta1), float(theta2)
    return (c1, c2), closes, theta, (float(omega1), float(omega1 + relative))


def compiled(body, restitution, old, closes, theta, omega):
    """What the kernels say comes of an impact."""
    record = body_record(system_of(body, restitution=restitution))
    n1, n2, w1, w2, gave_way = kernel_impact(
        record, state_record(old, theta, omega), *closes
    )
    return (n1, n2), (w1, w2), gave_way


def rates(omega):
    return np.array([omega[0], omega[1] - omega[0]])


@pytest.mark.parametrize("law", law_names())
def test_kernels_and_reference_agree_on_every_impact(law):
    rng = np.random.default_rng(1)
    for number in range(300):
        stack = random_stack(rng)
        restitution = measured(stack, rng.uniform(0.5, 1.4), law)
        old, closes, theta, omega = case = random_impact(
            rng, number % len(EVERY_IMPACT)
        )
        closing = tuple(
            pivot if shut else 0 for pivot, shut in zip(old, closes, strict=True)
        )
        fast = compiled(stack, restitution, *case)
        slow = Model(stack, G, restitution).impact(old, closing, theta, omega)
        assert fast[0] == slow[0] and fast[2] == slow[2]
        assert fast[1] == pytest.approx(slow[1], abs=1e-9)
        energy = Model(stack, G).kinetic_energy
        assert energy(fast[0], theta, fast[1]) <= energy(old, theta, omega) * (1 + 1e-8)


@pytest.mark.parametrize("law", law_names())
@pytest.mark.parametrize("stacks", [200, pytest.param(10_000, marks=pytest.mark.slow)])
def test_no_dead_stop_no_jump_between_neighbouring_values_and_no_gain_of_energy(
    law, stacks
):
    rng = np.random.default_rng(3)
    for number in range(stacks):
        stack, case = random_stack(rng), random_impact(rng, number % len(IMPACTS))
        old, closes, theta, omega = case
        model = Model(stack, G)
        before = model.kinetic_energy(old, theta, omega)
        _, of_momentum, gave_way = compiled(stack, None, *case)
        assert gave_way == 0
        closing = 1 if closes[1] else 0
        last = None
        for factor in np.linspace(0.7, 1.0, 13):
            new, after, _ = compiled(stack, measured(stack, factor, law), *case)
            assert model.kinetic_energy(new, theta, after) <= before * (1 + 2e-9)
            rate = rates(after)
            # open contacts separate, and what met does not come back
            assert new[0] * rate[0] >= 0 or (old[0] != 0 and not closes[0])
            assert new[1] * rate[1] >= 0 or (old[1] != 0 and not closes[1])
            assert rate[closing] * old[closing] <= 0
            if abs(rates(of_momentum)[closing]) > 0:
                assert abs(rate[closing]) > 0
            if last is not None:
                assert np.abs(rate - last).max() <= 0.2 * np.abs(rates(omega)).max()
            last = rate
        # the last value is what momentum gives the lone blocks
        blocks = stack.lower, upper_on_contact(stack)
        if (
            law != "ratio"
            and min(b.momentum_restitution(s) for b in blocks for s in (1, -1)) > 0.05
        ):
            assert after == pytest.approx(of_momentum, abs=1e-9)  # fmt: skip


@pytest.mark.parametrize("law", law_names())
@pytest.mark.parametrize("factor", [0.5, 0.9, 1.05])
def test_on_a_support_that_does_not_move_every_law_is_the_lone_block(law, factor):
    upper = Block(0.124, 0.496, 2.79, cg_offset=0.004)
    heavy = Stack(Block(5.0, 1.0, 1e9), upper)
    values = tuple(factor * upper.momentum_restitution(-pivot) for pivot in (1, -1))
    for side in (1, -1):
        restitution = MeasuredRestitution((None, values), law)
        response = simulate(
            heavy, STILL, 0.002, theta0=(0.0, side * 0.05), restitution=restitution
        )
        first = response.contact_events.query("kind == 'impact'").iloc[0]
        ratio = first["omega_after"][1] / first["omega_before"][1]
        assert ratio == pytest.approx(values[(1 + side) // 2], abs=1e-6)


def test_a_lone_block_has_a_value_for_each_direction():
    crooked = Block(0.3, 1.0, 100.0, cg_offset=0.1)
    values = tuple(crooked.momentum_restitution(-pivot) for pivot in (1, -1))
    assert abs(values[0] - values[1]) > 0.04
    assert max(values) > geometry.largest_restitution(crooked.shape, -1)
    free, named = (
        simulate(crooked, STILL, 0.002, theta0=0.05, restitution=given)
        for given in (None, values)
    )
    assert named.theta == pytest.approx(free.theta, abs=1e-12)
    free, named = (
        overturns(
            crooked, polyline(0, 2000), 0.01, [0.4, 0.6, 1.0], restitution=[given]
        )
        for given in (None, values)
    )
    assert named.peak_rotation == pytest.approx(free.peak_rotation, abs=1e-9)
    assert (free.impacts > 3).any()
    with pytest.raises(InputError, match="would gain energy"):
        simulate(crooked, STILL, 0.002, restitution=max(values))


@pytest.mark.parametrize("law", law_names())
def test_what_gives_way_is_counted(law):
    restitution, motion = MeasuredRestitution((0.9, None), law), 3 * polyline(0, 960)
    response = simulate(Stack(P, T3), motion, 0.006, restitution=restitution)
    impacts = response.contact_events.query("kind == 'impact'")
    assert response.given_way > 10
    # where a law gives way, no energy is lost
    without_loss = impacts["energy_after"] > impacts["energy_before"] * (1 - 1e-9)
    assert without_loss.sum() >= 0.9 * response.given_way
    # and none is won: what a rattle gains by rounding in each impact would add up
    gains = impacts["energy_after"] / impacts["energy_before"] - 1
    assert gains.max() < 2e-12
    found = overturns(Stack(P, T3), motion, 0.006, restitution=[restitution])
    assert found.given_way[0, 0, 0] > 10


SCRIPT = """
import numpy as np
from rockfrag import laws

def rate(value, by_momentum, before, moved):
    return value * (0.25 * by_momentum + 0.5 * before)

laws.declare("between", lambda shape, ratio, pivot: (4, ratio), rate)

from rockfrag import Block, MeasuredRestitution, Stack, simulate

body = Stack(Block(0.6, 0.4, 300.0), Block(0.3, 1.2, 110.0))
shake = 5.0 * np.sin(2 * np.pi * 1.1 * np.arange(0, 1, 0.01))

def first(restitution):
    impact = simulate(body, shake, 0.01, restitution=restitution).contact_events.query("kind == 'impact'").iloc[0]
    return [omega[1] - omega[0] for omega in (impact["omega_before"], impact["omega_after"])]

before, plain = first(None)
own, ratio = (first(MeasuredRestitution((None, 0.8), law))[1] for law in ("between", "ratio"))
wanted = 0.8 * (0.25 * plain + 0.5 * before)
assert np.isclose(own, wanted, rtol=1e-12), (own, wanted)
assert not np.isclose(ratio, wanted, rtol=1e-3)
"""


@pytest.mark.slow
def test_a_law_with_a_rate_of_its_own_is_inlined_by_the_kernels(tmp_path: Path) -> None:
    # kept code is that of the laws it was compiled with
    printed_alone("-c", SCRIPT, NUMBA_CACHE_DIR=str(tmp_path))


def struck(stack, old, omega, hollow, moves):
    """Rates of pedestal and statue after the dashpots of the interface have stopped all approach [rad/s].

    ``old``: pivots of ground and interface before; ``hollow``: power of the distance from the middle that the
    dashpots grow with; ``moves``: whether the pedestal does.
    """
    below, above = stack.lower, stack.upper
    centre = np.array([-old[0] * below.b, below.height + above.h])
    places = np.linspace(-1, 1, 401)
    weight = np.abs(places) ** hollow / (np.abs(places) ** hollow).sum()
    # velocities: of the pedestal's turn, and of the statue's centre and turn
    turning = moves / below.pivot_inertia()
    inverse = np.diag(
        [turning, 1 / above.mass, 1 / above.mass, 1 / above.centroidal_inertia]
    )
    x = -old[0] * below.b + places * above.b
    # of the base less of the top
    normal = np.column_stack([x, np.zeros_like(x), np.ones_like(x), -(x - centre[0])])
    slip = np.array([-below.height, 1.0, 0.0, -above.h])
    along = inverse @ slip
    inverse = inverse - np.outer(along, along) / (slip @ along)
    # before: the statue turns about its old pivot, which the pedestal carries along
    pivot = np.array([-old[0] * below.b + old[1] * above.b, below.height])
    arm, (first, second) = centre - pivot, omega
    moving = first * pivot[1] + second * arm[1], -first * pivot[0] - second * arm[0]
    before = np.array([first, *moving, second])

    def rate(_, v):
        return inverse @ (normal.T @ (weight * np.maximum(0.0, -(normal @ v))))

    time = 1e4 * above.mass  # the approach decays as exp(-time / mass)
    after = solve_ivp(
        rate, (0.0, time), before, method="LSODA", rtol=1e-9, atol=1e-12
    ).y[:, -1]
    return after[0], after[3]


def errors_of_laws(count, hollow):
    """Error of each law's rate of the interface over the rate before, (cases, laws), momentum last."""
    rng = np.random.default_rng(4)
    found = []
    for _ in range(count):
        stack, old = (
            random_stack(rng, crooked=False),
            tuple(rng.choice([1, -1], 2).tolist()),
        )
        omega1 = rng.normal()
        omega = omega1, omega1 - 2 * old[1] * abs(rng.normal())
        # of the statue alone, on a pedestal that does not move
        e = -old[1] * struck(stack, old, (0.0, -float(old[1])), hollow, moves=0)[1]
        first, two = struck(stack, old, omega, hollow, moves=1)
        here = []
        for law in ("position", "couple", "ratio", None):
            given = None if law is None else MeasuredRestitution((None, e), law)
            _, after, _ = Model(stack, G, given).impact(
                old, (0, old[1]), (0.0, 0.0), omega
            )
            here.append(
                (after[1] - after[0] - (two - first)) / abs(omega[1] - omega[0])
            )
        found.append(here)
    return np.abs(found)


@pytest.mark.slow
@pytest.mark.parametrize("hollow", [0, 2, 8])
def test_the_law_of_position_is_nearest_to_a_row_of_dashpots(hollow):
    position, couple, ratio, momentum = np.median(errors_of_laws(60, hollow), axis=0)
    assert position < 0.1 * min(couple, ratio, momentum)
