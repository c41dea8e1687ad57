"""Impacts in space obey Coulomb's law, with the coefficient that Routh's path through the impact asks for."""

import math

import numpy as np
import pytest

from rockfrag import Block, simulate
from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial.engine import run_case
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.options import Friction
from rockfrag.system.body import Polygon

from .checks import turned_by
from .samples import DT, box, cylinder, solid, synthetic_motion

BRIEF = 1e-7  # in which an impact is over, and next to nothing else happens [s]


def landing(body, before, tilt=0.01):
    """Velocities (x, z, about y) after an impact on the edge at +x, from those before."""
    start, attitude = turned_by([0.0, tilt, 0.0])
    edge = attitude @ body["points"][1]
    start[0], start[2] = -edge[0], 1e-9 - edge[2]
    start[7], start[9], start[11] = before
    _, history = run_case(body, np.zeros((4, 3)), BRIEF, start=start, samples=4)
    after = history[1]
    assert after[14] == 2 or after[14] == 0
    return after[[7, 9, 11]], edge


def routh(inertia, edge, before, static, kinetic):
    """Velocities after a plastic impact of one contact in a plane, along Routh's path (1905)."""
    x, z = edge[0], edge[2]
    # velocities at the edge after unit impulses along and across the ground: u_x = v_x + ω z, u_z = v_z - ω x
    tt, tn, nn = 1 + z * z / inertia, -x * z / inertia, 1 + x * x / inertia
    slip, falls = before[0] + before[2] * z, before[1] - before[2] * x
    along = across = 0.0
    side = math.copysign(1.0, slip)
    # while it slips, by the impulse across the ground
    brakes, lifts = tn - side * kinetic * tt, nn - side * kinetic * tn
    if side * brakes < 0:
        part = min(-slip / brakes, -falls / lifts)
        across, along = part, -side * kinetic * part
        falls += lifts * part
    if falls < -1e-15:
        if side * brakes < 0 and abs(tn) <= static * tt:
            holds = -tn / tt
        else:
            # it never stops, or slides back
            side = side if side * brakes >= 0 else math.copysign(1.0, tn)
            holds = -side * kinetic
        part = -falls / (nn + holds * tn)
        across, along = across + part, along + holds * part
    turned = (along * z - across * x) / inertia
    return before + np.array([along, across, turned])


def stopping(inertia, edge, before):
    """Impulse along and across the ground that stops the edge of a plane body outright."""
    x, z = edge[0], edge[2]
    coupled = -x * z / inertia
    effects = [[1 + z * z / inertia, coupled], [coupled, 1 + x * x / inertia]]
    speeds = before[0] + before[2] * z, before[1] - before[2] * x
    return np.linalg.solve(effects, -np.array(speeds))


@pytest.mark.parametrize(
    ("impacts", "least"), [(40, 5), pytest.param(400, 60, marks=pytest.mark.slow)]
)
def test_what_slips_into_an_impact_takes_the_coefficient_of_rouths_path(impacts, least):
    rng = np.random.default_rng(6)
    stops = slides = back = 0
    for _ in range(impacts):
        width, kinetic = rng.uniform(0.2, 0.6), rng.uniform(0.02, 0.6)
        height = width * rng.uniform(1.0, 4.0)
        body = box(width, rng.uniform(0.2, 0.6), height)
        static = kinetic * rng.uniform(1.0, 4.0)
        body["static"], body["kinetic"] = static, kinetic
        before = np.array([0.0, rng.uniform(-1, -0.1), rng.uniform(-0.5, 0.5)])
        before[1] += min(before[2], 0.0) * width / 2
        edge = body["points"][1]
        slip = rng.choice([-1, 1]) * 10 ** rng.uniform(-3, 0)
        before[0] = slip - before[2] * edge[2]
        found, at = landing(body, before, 1e-3)
        expected = routh(body["inertia"][1, 1], at, before, static, kinetic)
        after = expected[0] + expected[2] * at[2]
        if 1e-9 < abs(after) < 2e-4:
            # slip so slow counts as none
            continue
        if slip * after < 0 and abs(after) > 1e-9:
            # the whole impulse obeys the law, of the slip that is left; Routh's parts add up to less
            push = found - before
            needed = stopping(body["inertia"][1, 1], at, before)
            if abs(needed[0]) <= kinetic * needed[1]:
                np.testing.assert_allclose(push[:2], needed, atol=2e-5)
                continue
            assert push[0] == pytest.approx(
                -kinetic * push[1] * np.sign(after), rel=1e-4
            )
            assert (found[0] + found[2] * at[2]) * after > 0
            back += 1
            continue
        np.testing.assert_allclose(found, expected, atol=2e-5)
        stops += abs(after) < 1e-9
        slides += abs(after) > 1e-3
    assert min(stops, slides) > least and back > least / 4


@pytest.mark.filterwarnings("ignore:the peak")
def test_along_an_axis_static_above_kinetic_friction_is_that_of_the_planar_engine():
    rng = np.random.default_rng(1)
    time = np.arange(0, 4, 0.002)
    slid = 0
    for _ in range(6):
        width = rng.uniform(0.2, 0.4)
        height = width * rng.uniform(2.6, 3.2)
        body = Block(width, height, 100.0, depth=width * rng.uniform(0.7, 1.5))
        static = width / height * rng.uniform(1.05, 1.25)
        friction = Friction(static, rng.uniform(0.1, 0.18))
        peak = GRAVITY * width / height * rng.uniform(2.0, 2.6)
        swing = np.sin(2 * np.pi * rng.uniform(0.8, 1.3) * time)
        motion = Motion(peak * swing, 0.002)
        still = Motion(0 * motion.acceleration, 0.002)
        plane = simulate(body, motion, friction=friction)
        space = simulate(body, GroundMotion(motion, still), friction=friction)
        impacts = plane.contact_events.query("kind == 'impact'")
        slid += sum("slides" in mode[0] for mode in impacts["modes"])
        # later impacts multiply differences
        until = impacts["time"].iloc[6] if len(impacts) > 6 else math.inf
        tilt, theta = space.history.tilt_rad.to_numpy(), np.abs(plane.theta[:, 0])
        n = int(min(until / 0.002, len(tilt), len(theta)))
        assert np.abs(tilt[:n] - theta[:n]).max() < 1e-5
        assert space.overturned == plane.overturned
    assert slid > 5


def test_ends_of_an_edge_share_its_friction_by_what_each_can_bear():
    """With the centre of mass nearer to one end, that end bears more; friction that is just enough holds both."""
    base = Polygon(((-0.15, -0.15), (0.15, -0.15), (0.15, 0.45), (-0.15, 0.45)))
    inertia = np.diag([1.0 + 0.36, 1.0 + 0.09, 0.09 + 0.36]) / 12
    # tips over the edge at +x while the ground moves along the edge too: shear over weight is .35 at both ends
    body = solid(base, inertia, 0.5, 0.36)
    ramp = np.minimum(np.arange(40) * DT / 0.2, 1.0)
    ground = -GRAVITY * np.column_stack([0.33 * ramp, 0.15 * ramp, 0 * ramp])
    outcome, history = run_case(body, ground, DT, samples=40)
    on_edge = history[:40, 14] == 2
    assert on_edge.sum() > 10
    assert outcome.slidings == 0 and outcome.paradoxes == 0


@pytest.mark.parametrize(
    ("cases", "least"),
    [(40, 1000), pytest.param(2500, 100_000, marks=pytest.mark.slow)],
)
def test_every_impact_obeys_its_friction_and_none_gains(cases, least):
    """From the whole change of momentum: no shear beyond friction but for slow slip that is stopped."""
    rng = np.random.default_rng(8)
    impacts = 0
    for case in range(cases):
        width, slenderness = rng.uniform(0.2, 0.6), rng.uniform(1.5, 5.0)
        static = rng.uniform(0.2, 1.2)
        if case % 4:
            body = box(
                width, width * rng.uniform(0.5, 1.5), slenderness * width, static
            )
        else:
            sides = int(rng.integers(5, 12))
            body = cylinder(width / 2, slenderness * width, static, sides)
        body["kinetic"] = static * rng.uniform(0.3, 1.0)
        level = rng.uniform(0.8, 3.0) / slenderness
        motion = synthetic_motion(rng, 3, 8.0) * level
        outcome, _ = run_case(body, motion, DT)
        impacts += outcome.impacts
        if outcome.paradoxes == 0:
            assert outcome.beyond_friction < 1e-3
        assert outcome.gained < 1e-5
    assert impacts > least


def test_an_edge_of_which_one_end_begins_to_slip_never_jams():
    """Friction of 20 holds nearly all; where one end of an edge hardly presses, it slips."""
    body = box(0.35, 0.35, 1.2)
    slidings = 0
    for seed in range(6):
        motion = synthetic_motion(np.random.default_rng(seed), 3) * 0.6
        outcome, _ = run_case(body, motion, DT)
        slidings += outcome.slidings
        assert outcome.paradoxes == 0
    assert slidings > 6
