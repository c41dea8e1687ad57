"""Short analyses, alone and in ensembles, beside the plain integrator, which shares only the bodies with them.

They are short enough for kernels that run as plain Python. What begins a long chatter is cut off.
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockfrag import Block, GroundMotion, Motion, Stack, overturns, simulate
from rockfrag.base.units import GRAVITY
from rockfrag.engines.contract import Case, Cases, Request
from rockfrag.engines.pure_rocking import histories
from rockfrag.engines.pure_rocking.histories import SingleRun
from rockfrag.records.velocity_steps import VelocitySteps
from rockfrag.simulation.inputs import ground_motion
from rockfrag.system import as_system

from ...oracle.rocking_integrator import simulate_reference
from ..planar.cases import G

# bodies that the ground may lift off are held by pure rocking
pytestmark = pytest.mark.filterwarnings(
    "ignore::rockfrag.simulation.ensemble.LightBodies",
    "ignore::rockfrag.simulation.inputs.UnitWarning",
)

DT, TIMES = 0.02, 4
LONE = (
    (Block(0.5, 1.5, 700.0), None),
    # two pivots, a measured ratio
    (Block(0.4, 1.3, 300.0, cg_offset=0.02, lean=0.01), 0.8),
)
PILES = (
    (Stack(Block(0.6, 0.6, 800.0), Block(0.4, 1.2, 300.0)), None),
    # a slender pedestal falls with what stands on it
    (Stack(Block(0.3, 1.5, 360.0), Block(0.25, 0.4, 70.0, cg_offset=0.01)), None),
)


def motions():
    """A pulse that grows at once and dies down, and one upwards of another period."""
    time = np.arange(60) * DT
    fades = np.minimum(1, time / 0.1) * np.exp(-2.0 * np.maximum(0, time - 0.7))
    level, lift = (np.sin(2 * np.pi * time / period) * fades for period in (0.9, 0.31))
    level[-1] = lift[-1] = 0.0
    return level, 0.25 * lift


@cache
def exact(number, piles, scale, upward):
    """Response of the plain integrator, somewhat longer than the ground moves, at samples four times as dense."""
    body, restitution = (PILES if piles else LONE)[number]
    level, lift = motions()
    at = np.arange((level.size - 1) * TIMES + 1) / TIMES
    level, lift = (np.interp(at, np.arange(level.size), each) for each in (level, lift))
    return simulate_reference(
        body,
        scale * level,
        DT / TIMES,
        restitution=restitution,
        vertical=scale * lift if upward else None,
        duration=DT * 66,
    )


def distance(block, theta):
    """Closest approach of a response to balance, √(ψ² + ψ'²/p²) over the critical angle, as in the kernels."""
    side = np.where(theta < 0, -1, 1)
    angle = np.where(side > 0, block.critical_angle(1), block.critical_angle(-1))
    frequency = np.where(side > 0, block.frequency(1), block.frequency(-1))
    rate = np.gradient(theta, DT / TIMES)
    away = np.hypot(angle - np.abs(theta), rate / frequency) / angle
    return away[np.abs(theta) > 1e-9].min()


def certain_by(block, known, push):
    """Time by which energy carries a block over balance whatever the ground, over g, still does; inf if never.

    Against the largest push ahead, A, which is known to 16 samples: ψ'²/2p² ≥ √(1 + A²) - cos ψ + A sin ψ.
    """
    theta = known.theta[:, 0]
    rate = np.gradient(theta, DT / TIMES)
    for n, (at, speed) in enumerate(zip(theta[::TIMES], rate[::TIMES], strict=True)):
        side = 1 if at > 0 else -1
        psi = block.critical_angle(side) - abs(at)
        most = max(0.0, (side * push[max(0, n - 16) :]).max())
        barrier = np.hypot(1.0, most) - np.cos(psi) + most * np.sin(psi)
        if speed * side > 0 and (speed / block.frequency(side)) ** 2 / 2 >= barrier:
            return n * DT
    return np.inf


def critical(body):
    """Critical angle of each body about its right and its left pivot."""
    return [
        (each.critical_angle(1), each.critical_angle(-1))
        for each in ((body.lower, body.upper) if isinstance(body, Stack) else (body,))
    ]


@pytest.mark.parametrize(
    ("piles", "scale", "upward"),
    [
        (False, 4.0, True),
        (False, 5.5, True),
        (True, 5.5, True),
    ],
)
def test_one_analysis_is_that_of_the_plain_integrator(piles, scale, upward):
    body, restitution = (PILES if piles else LONE)[1]
    level, lift = motions()
    lift = scale * lift if upward else None
    found = simulate(
        body,
        scale * level,
        DT,
        restitution=restitution,
        vertical=lift,
    )
    known = exact(1, piles, scale, upward)
    assert found.overturned or not known.overturned
    assert found.time == pytest.approx(DT * np.arange(len(found.theta)))
    theta = known.theta[::TIMES]
    n = min(len(theta), len(found.theta))
    upright = np.abs(theta[:n]).max(axis=1) < 0.5
    assert np.abs(theta).max() > 0.01
    assert found.theta[:n][upright] == pytest.approx(theta[:n][upright], abs=1e-6)


def test_contacts_change_under_the_ground_and_the_gravity_of_that_instant():
    """Both are linear between samples."""
    level, lift = motions()
    ground = ground_motion(4.0 * level, DT, 4.0 * lift)
    case = Case(as_system(LONE[1][0]), ground, request=Request(g=G))
    events = SingleRun(case).contact_events
    time = np.arange(level.size) * DT
    events = events[events["time"] < time[-1]]
    assert len(events) > 1
    for at in ("before", "after"):
        assert events[at]["ground"] == pytest.approx(
            np.interp(events["time"], time, 4.0 * level), abs=1e-9
        )
        assert events[at]["gravity"] == pytest.approx(
            G + np.interp(events["time"], time, 4.0 * lift), abs=1e-9
        )


@pytest.mark.parametrize(
    ("piles", "scale", "upward", "expected"),
    [
        (False, 4.0, False, {"rocks"}),
        (False, 4.0, True, {"falls", "rocks"}),
        (False, 5.5, False, {"falls"}),
        (False, 7.0, True, {"falls", "rocks"}),
        (True, 4.0, False, {"rocks"}),
        (True, 4.0, True, {"rocks"}),
        (True, 5.5, True, {"falls"}),
    ],
)
def test_an_ensemble_has_the_outcomes_and_peaks_of_the_plain_integrator(
    piles, scale, upward, expected
):
    level, lift = motions()
    cases = PILES[:1] if piles else LONE
    found = overturns(
        [body for body, _ in cases],
        level,
        DT,
        [scale],
        restitution=[restitution for _, restitution in cases],
        vertical=lift if upward else None,
        threads=1,
    )
    told = set()
    for i, (body, _) in enumerate(cases):
        known, at = exact(i, piles, scale, upward), (i, 0, 0)
        if known.overturned:
            assert found.overturned[at]
            # when that is certain the body still has some way to go
            lasts = (len(known.time) - 1) * DT / TIMES
            assert lasts - 1.5 < found.certain_time[at] <= lasts + DT
        if found.overturned[at]:
            told.add("falls")
            if not (piles or upward):
                by = certain_by(body, known, scale * level / G)
                assert found.certain_time[at] <= by + DT
            continue
        if not piles:
            # it may come closer once the ground is still
            near = distance(body, known.theta[:, 0])
            assert found.unstable_distance[at] <= 1.02 * near
        for k, (right, left) in enumerate(critical(body)):
            # of the upper body beside the lower one
            theta = known.theta[:, k]
            peak = max(theta.max() / right, -theta.min() / left)
            frequency = (body.lower if piles else body).frequency()
            between = (frequency * DT) ** 2 / 4 + 1e-6
            # hops of less are closed unseen; later peaks are lower where that is not of the last swing
            if peak > 1e-3:
                told.add("rocks")
                assert found.peak_rotation[(*at, k)] >= peak - between
                if np.abs(theta).argmax() < 0.85 * len(theta):
                    assert found.peak_rotation[(*at, k)] <= peak + between
    assert told == expected


@pytest.mark.parametrize("side", [1, -1])
def test_a_block_under_a_record_and_jumps_goes_where_moments_and_momentum_take_it(side):
    """From one side to its fall there, beside SciPy: Δω = m (x Δw - z Δu)/I at each jump, and I θ'' the moment."""
    block, dt = Block(0.04, 0.18, 1.0), 0.02
    b, h, inertia = 0.02, 0.09, 4 / 3 * (0.02**2 + 0.09**2)
    level = side * np.array([0.5, -0.8, 0.4, 0.3, 0.0])
    lift = np.array([0.0, 0.6, -0.5, 0.3, 0.0])
    times, right, up = [0.045, 0.097], side * np.array([-0.09, -0.08]), (0.05, -0.03)
    ground = GroundMotion(
        Motion(level, dt),
        z=Motion(lift, dt),
        steps=VelocitySteps(times, right, up),
    )
    found = simulate(block, ground, theta0=side * 0.15)

    def arm(theta):
        s, c = np.sin(theta), np.cos(theta)
        return h * s - side * b * c, side * b * s + h * c

    def moment(t, y):
        x, z = arm(y[0])
        a, w = (
            np.interp(t, dt * np.arange(5), each, right=0) for each in (level, lift)
        )
        return y[1], (x * (GRAVITY + w) - z * a) / inertia

    def fallen(t, y):
        return side * y[0] - np.pi / 2

    fallen.terminal = True
    y, at, demand, energies = np.array([side * 0.15, 0.0]), 0.0, [], []
    compared = 0
    steps = found.contact_events[found.contact_events["kind"] == "velocity step"]
    assert steps["time"].to_numpy() == pytest.approx(times)
    for end, du, dw in zip([*times, 2.0], [*right, 0], [*up, 0], strict=True):
        path = solve_ivp(
            moment,
            (at, end),
            y,
            events=fallen,
            dense_output=True,
            rtol=1e-10,
            atol=1e-12,
            max_step=dt / 4,
        )
        # not the instants of the jumps themselves
        inside = (found.time > at + 1e-9) & (found.time < path.t[-1] - 1e-9)
        compared += inside.sum()
        theta, omega = path.sol(found.time[inside])
        assert found.theta[inside, 0] == pytest.approx(theta, abs=1e-7)
        assert found.omega[inside, 0] == pytest.approx(omega, abs=1e-5)
        at, y = end, path.y[:, -1]
        x, z = arm(y[0])
        change = (x * dw - z * du) / inertia
        y[1] += change
        if du:
            normal = dw - x * change
            demand.append(abs(du + z * change) / normal if normal > 0 else np.inf)
            energies.append(inertia * y[1] ** 2 / 2)
    assert found.overturned and compared > 8
    assert found.overturning_time == pytest.approx(path.t[-1], abs=2 * dt)
    assert steps["energy_after"].to_numpy() == pytest.approx(energies, rel=1e-6)
    assert found.friction_demand[0] >= max(demand) * (1 - 1e-6)
    assert found.energy["residual"].abs().max() < 1e-6 * found.energy["kinetic"].max()


def test_cases_one_by_one_are_told_as_their_histories_are(monkeypatch):
    """Two motions and two scales, of bodies with and without a pedestal, with the forces that are asked for."""
    shaking_of = histories.shaking_of

    def short_one(case, g):
        # what happens on the ground at rest takes longest
        return shaking_of(case, g)._replace(free_samples=0)

    monkeypatch.setattr(histories, "shaking_of", short_one)
    bodies = (LONE[0][0], PILES[0][0])
    level = 6.0 * np.sin(np.arange(12) * 0.9)
    level[-1] = 0.0
    motions = ground_motion(level, DT), ground_motion(-0.8 * level[:9], 0.03)
    systems = tuple(as_system(body) for body in bodies)
    grid = Cases(
        systems, motions, np.array([[0.7, 1.1], [0.9, 1.2]]), Request(forces=True)
    )
    found = histories.run(grid)
    for at in np.ndindex(*grid.shape):
        i, j, k = at
        case = Case(systems[i], motions[j], float(grid.scales[j, k]), grid.request)
        alone = histories.SingleRun(case).summary
        two = systems[i].count == 2
        assert found.impacts[at] == alone["impacts"]
        assert found.overturned[at] == (alone["fallen"] > 0)
        assert found.peak_velocity[at][int(two)] == alone["speed2"]
        assert np.isnan(found.peak_velocity[at][0]) == two
        for body, number in enumerate("12" if two else "2"):
            assert found.peak_rotation[at][body] == alone["ratio" + number]
            demand = alone["demand"]
            assert found.friction_demand[at][body] == demand["friction" + number]
            assert found.least_normal_force[at][body] == demand["normal" + number]
        assert found.lost_contact[at] == pytest.approx(
            alone["lost_contact"], nan_ok=True
        )
    assert found.peak_rotation[:, :, :, 0].max() > 0
