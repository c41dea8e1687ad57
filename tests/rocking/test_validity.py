"""Was the model allowed? What a response asked of friction, and whether its contacts pushed."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.rocking.ensemble import LightBodies

from .reference_bodies import T2, P, polyline

G = 9.81
SHAKING = polyline(0, 3000)


@pytest.mark.parametrize("body", [T2, Stack(P, T2)])
@pytest.mark.parametrize("peak", [2.0, 3.0])
def test_what_is_asked_does_not_hang_on_the_samples(body, peak):
    coarse = simulate(body, peak * SHAKING, 0.01)
    # the same straight lines, looked at twenty times as often
    fine_motion = np.interp(np.arange(60_000) * 0.0005, np.arange(3000) * 0.01, peak * SHAKING)
    fine = simulate(body, fine_motion, 0.0005)
    assert coarse.impacts > 0 and coarse.overturned
    assert coarse.friction_demand == pytest.approx(fine.friction_demand, rel=2e-3)
    assert coarse.least_normal_force == pytest.approx(fine.least_normal_force, rel=2e-3)


def test_a_fall_itself_asks_nothing():
    response = simulate(T2, np.zeros(300), 0.01, theta0=1.02 * T2.alpha, omega0=0.05)
    standing = simulate(T2, np.zeros(50), 0.01, theta0=0.3 * T2.alpha)
    assert response.overturned and response.friction_force.size > 20
    lying = np.abs(response.friction_force[-1, 0]) / abs(response.normal_force[-1, 0])
    assert response.friction_demand[0] < 0.3 < lying
    assert math.isnan(response.lost_contact)
    assert 0.1 < standing.friction_demand[0] < 0.4


def test_a_block_that_comes_back_from_beyond_its_balance_had_not_fallen():
    # beyond balance at first, and pushed back: what was asked there counts
    back = simulate(T2, np.full(12, 6.0), 0.01, theta0=1.05 * T2.alpha)
    beyond = back.theta[:12, 0] > T2.alpha
    assert beyond[0] and not beyond[-1]
    asked = np.abs(back.friction_force[:12, 0]) / back.normal_force[:12, 0]
    assert back.friction_demand[0] >= asked[beyond].max() > 0.15


@pytest.mark.parametrize("block", [T2, Block(0.3, 0.5, 40.0)])
def test_an_impact_asks_what_housner_s_impulse_does(block):
    response = simulate(block, np.zeros(100), 0.01, theta0=0.02 * block.alpha)
    e = block.momentum_restitution()
    impulse = (1 - e) / (1 + e) * block.h / block.b
    # forces of so small a rotation ask less
    assert response.friction_demand[0] == pytest.approx(impulse, rel=1e-9)
    assert impulse > (np.abs(response.friction_force) / response.normal_force).max()


def test_friction_of_the_interface_is_along_the_face_that_carries():
    leaning = Stack(Block(0.6, 1.2, 50.0), Block(0.5, 0.3, 10.0))
    response = simulate(leaning, np.zeros(10), 0.001, theta0=(0.2, 0.2))
    asked = abs(response.friction_force[0, 1] / response.normal_force[0, 1])
    assert asked == pytest.approx(0.480, abs=1e-3)
    sloping = Stack(Block(0.6, 0.6, 50.0, lean=np.radians(2)), Block(0.3, 0.3, 10.0))
    at_rest = simulate(sloping, np.zeros(10), 0.01)
    assert at_rest.friction_demand[1] == pytest.approx(math.tan(np.radians(2)), rel=1e-9)
    assert at_rest.friction_demand[0] == pytest.approx(0, abs=1e-12)


def test_losing_contact_is_an_contact_event():
    # the ground falls away faster than the block
    up = np.interp(np.arange(100) * 0.01, [0.0, 0.2, 0.4, 0.6], [0.0, -2 * G, 0.0, 0.0])
    with pytest.warns(LightBodies, match="at 0.100 s the body would have left"):
        response = simulate(T2, np.zeros(100), 0.01, vertical=up)
    assert response.lost_contact == pytest.approx(0.1, abs=1e-9)
    lifted = response.contact_events.query("kind == 'lift-off'")
    assert lifted["time"].tolist() == [response.lost_contact]
    assert math.isinf(response.friction_demand[0]) and response.least_normal_force[0] < 0
    found = overturns(T2, np.zeros(100), 0.01, vertical=[up], forces=True)
    assert found.lost_contact.item() == pytest.approx(0.1, abs=1e-9)
    kept = simulate(T2, np.zeros(100), 0.01, vertical=0.45 * up)
    assert math.isnan(kept.lost_contact) and kept.least_normal_force[0] > 0


def test_an_ensemble_asks_what_its_histories_do():
    motion, bodies = 2.0 * SHAKING, [T2, Stack(P, T2)]
    found = overturns(bodies, motion, 0.01, [0.5, 1.0, 1.4], forces=True)
    for i, body in enumerate(bodies):
        for k, scale in enumerate(found.scales[0]):
            item = simulate(body, scale * motion, 0.01)
            n = item.friction_demand.size
            for name in ("friction_demand", "least_normal_force"):
                expected = pytest.approx(getattr(item, name), rel=1e-12)
                assert getattr(found, name)[i, 0, k, :n] == expected
    assert np.isnan(found.friction_demand[0, ..., 1]).all()
    contacts = found.table("contacts")
    assert contacts["friction_demand"].notna().all()
    assert overturns(T2, motion, 0.01).table("contacts")["friction_demand"].isna().all()
