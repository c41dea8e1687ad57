"""Which law carries a measured restitution over to a stack? Asked of contacts that know no law.

The interface is a row of independent dashpots across the base, which push and never pull and act for an
instant; the base does not slip, and the pedestal turns about its corner of the ground.  More weight at the ends of
the row makes the base hollow, an even one flat.  The restitution is measured on the same row under the lone
statue.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockfrag import Block, Stack
from rockfrag.rocking import MeasuredRestitution

from ..oracle.rocking_model import Model

G = 9.81


def struck(stack, old, omega, hollow, moves):
    """Rates of pedestal and statue after the dashpots of the interface have stopped all approach [rad/s].

    ``old``: pivots of ground and interface before; ``hollow``: power of the distance from the middle that the
    dashpots grow with; ``moves``: whether the pedestal does.
    """
    below, above = stack.lower, stack.upper
    centre = np.array([-old[0] * below.b, below.height + above.h])
    places = np.linspace(-1, 1, 401)
    weight = np.abs(places) ** hollow
    weight = weight / weight.sum()
    # velocities: of the pedestal's turn, and of the statue's centre and turn
    inverse = np.diag(
        [
            moves / (below.pivot_inertia() if moves else 1.0),
            1 / above.mass,
            1 / above.mass,
            1 / above.centroidal_inertia,
        ]
    )
    x = -old[0] * below.b + places * above.b
    normal = np.column_stack(
        [x, np.zeros_like(x), np.ones_like(x), -(x - centre[0])]
    )  # of the base less of the top
    slip = np.array([-below.height, 1.0, 0.0, -above.h])
    along = inverse @ slip
    inverse = inverse - np.outer(along, along) / (slip @ along)
    # before: the statue turns about its old pivot, which the pedestal carries along
    pivot = np.array([-old[0] * below.b + old[1] * above.b, below.height])
    arm = centre - pivot
    before = np.array(
        [
            omega[0],
            omega[0] * pivot[1] + omega[1] * arm[1],
            -omega[0] * pivot[0] - omega[1] * arm[0],
            omega[1],
        ]
    )

    def rate(_, v):
        return inverse @ (normal.T @ (weight * np.maximum(0.0, -(normal @ v))))

    time = 1e4 * above.mass  # the approach decays as exp(-time / mass)
    after = solve_ivp(rate, (0.0, time), before, method="LSODA", rtol=1e-9, atol=1e-12).y[:, -1]
    return after[0], after[3]


def random_case(rng):
    base, slenderness = rng.uniform(0.1, 0.5), rng.uniform(2.5, 6)
    below, squatness = base * rng.uniform(1, 1.6), rng.uniform(1.0, 2.5)
    upper = Block(base, base * slenderness, 1000 * base**2 * slenderness)
    lower = Block(below, below * squatness, 1000 * below**2 * squatness * rng.uniform(0.5, 3))
    old = (int(rng.choice([1, -1])), int(rng.choice([1, -1])))
    omega1 = rng.normal()
    return Stack(lower, upper), old, (omega1, omega1 - 2 * old[1] * abs(rng.normal()))


def errors_of_laws(count, hollow):
    """Error of each law's rate of the interface over the rate before, (cases, laws), momentum last."""
    rng = np.random.default_rng(4)
    found = []
    for _ in range(count):
        stack, old, omega = random_case(rng)
        _, lone = struck(stack, old, (0.0, -float(old[1])), hollow, moves=0)
        e = -old[1] * lone
        first, two = struck(stack, old, omega, hollow, moves=1)
        here = []
        for law in ("position", "couple", "ratio", None):
            measured = None if law is None else MeasuredRestitution((None, e), law)
            _, after, _ = Model(stack, G, measured).impact(old, (0, old[1]), (0.0, 0.0), omega)
            here.append((after[1] - after[0] - (two - first)) / abs(omega[1] - omega[0]))
        found.append(here)
    return np.abs(found)


def test_a_hollow_base_conserves_momentum_about_its_corner():
    rng = np.random.default_rng(1)
    stack, old, _ = random_case(rng)
    _, lone = struck(stack, old, (0.0, -float(old[1])), 2000, moves=0)
    assert -old[1] * lone == pytest.approx(stack.upper.momentum_restitution(), abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("hollow", [0, 2, 8])
def test_the_law_of_position_is_nearest_to_a_row_of_dashpots(hollow):
    position, couple, ratio, momentum = np.median(errors_of_laws(60, hollow), axis=0)
    assert position < 0.1 * min(couple, ratio, momentum)
