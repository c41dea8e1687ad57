"""Walls and kerbs: closed forms of leaning, hitting and tripping, symmetry, and walls that are not met."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag import Block, Column, Motion, Stack, overturns, simulate
from rockfrag.base.errors import InputError
from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.engines.planar.integrate import IMPACT
from rockfrag.simulation.inputs import ground_motion
from rockfrag.simulation.options import system_of
from rockfrag.system import SlidingPendulum, Wall, as_system, hold
from rockfrag.system.body import Interval
from rockfrag.system.mounts import ROLLING, on_casters
from rockfrag.system.system import Start, corners, standing_centres

from ...oracle import witness
from ...oracle.cones import Touch, planar_rays, unexplained
from ...oracle.standing import turn
from ...simulation.reference_bodies import random_motion
from .cases import DT, G, random_column, run, with_contacts
from .violations import SHUT, impacts_of

B, H, M = 0.15, 0.6, 100.0  # half width, half height [m], mass [kg]
BLOCK = Block(2 * B, 2 * H, M)
STILL = np.zeros(200)
LEFT = math.pi


def walled(body, *walls):
    return hold(as_system(body), *walls)


def touching(theta: float) -> float:
    """Distance of the wall that the upper right corner of the block touches, turned on its right corner [m]."""
    return B + 2 * H * math.sin(theta)


def leaning(theta: float, mu: float):
    """Response of a block that leans against a smooth wall from the start."""
    start = system_of(walled(BLOCK, Wall(touching(theta))), mu, theta0=theta)
    return ContactRun(Case(start, ground_motion(STILL, DT), request=Request()))


@pytest.mark.parametrize("theta", [0.3, 0.5, 0.8])
def test_a_block_leans_where_friction_at_its_foot_reaches_its_arm_over_its_height(
    theta: float,
) -> None:
    """µ ≥ |r_x|/z and N_w = m g |r_x|/z."""
    arm = H * math.sin(theta) - B * math.cos(theta)
    needed = arm / (2 * H * math.cos(theta))
    holds, slides = leaning(theta, 1.0001 * needed), leaning(theta, 0.9999 * needed)
    assert holds.work["outcome"]["leaning"] == 1
    assert np.ptp(holds.history["q"][:, :3], axis=0) == pytest.approx(0.0, abs=1e-9)
    force = holds.response().constraints["largest_force_n"][0]
    assert force == pytest.approx(M * G * needed, rel=1e-9)
    assert slides.work["outcome"]["leaning"] == 0
    assert slides.response().overturned


def shaken_block(*walls, scale=2.0, seed=3, body=BLOCK):
    """Response of a block between walls under a random motion."""
    motion = scale * random_motion(np.random.default_rng(seed))
    return run(walled(body, *walls), motion, friction=0.6, closing=1e-4)


@pytest.mark.parametrize("body", [BLOCK, Stack(Block(0.6, 0.3, 200.0), BLOCK)])
@pytest.mark.parametrize("distance", [math.inf, 40.0])
def test_a_wall_that_is_not_met_leaves_every_bit(body, distance: float) -> None:
    free = shaken_block(body=body)
    walled_in = shaken_block(Wall(distance), Wall(distance, LEFT), body=body)
    assert len(free.contact_events) > 10
    assert np.array_equal(free.theta, walled_in.theta)
    assert np.array_equal(free.normal_force, walled_in.normal_force)


def test_the_mirror_image_of_a_walled_block_moves_as_its_mirror_image() -> None:
    wall = {"friction": 0.3, "restitution": 0.4}
    motion = 5.0 * np.sin(3 * np.pi * np.arange(0, 2, DT))
    right = run(walled(BLOCK, Wall(0.2, **wall)), motion, friction=0.6)
    left = run(walled(BLOCK, Wall(0.2, LEFT, **wall)), -motion, friction=0.6)
    assert right.constraints["hits"][0] > 3
    events = right.contact_events
    until = events["time"][events["kind"] == "impact"].iloc[8]
    early = right.time[: min(len(right.theta), len(left.theta))] < until
    assert right.theta[: early.size][early] == pytest.approx(
        -left.theta[: early.size][early], abs=1e-9
    )


def test_between_two_smooth_walls_at_no_distance_nothing_turns() -> None:
    found = shaken_block(Wall(B), Wall(B, LEFT), scale=4.0)
    assert np.abs(found.theta).max() < 1e-13
    assert found.constraints["largest_force_n"].min() > 0.1 * M * G


@pytest.mark.parametrize("aside", [0.25, -0.4])
def test_a_wall_stands_at_its_distance_from_the_origin_wherever_the_base_lies(
    aside: float,
) -> None:
    """A block whose frame begins beside its base leans at the angle of its corner."""
    (block,) = as_system(BLOCK).bodies
    x, y, z = block.centre
    moved = replace(
        block,
        centre=(x + aside, y, z),
        base=Interval(block.base.left + aside, block.base.right + aside),
        face=None,
    )
    system = hold(
        replace(as_system(BLOCK), bodies=(moved,)), Wall(touching(0.3) + aside)
    )
    start = system_of(system, 2.0, theta0=0.3)
    found = ContactRun(Case(start, ground_motion(STILL, DT), request=Request()))
    assert found.work["outcome"]["leaning"] == 1
    assert np.ptp(found.history["q"][:, 2]) < 1e-9
    assert found.response().constraints["largest_force_n"][0] > 0


@pytest.mark.parametrize("ratio", [0.0, 0.5])
def test_a_rocking_block_that_hits_a_smooth_wall_is_thrown_up_at_its_foot(
    ratio: float,
) -> None:
    """P = (1 + e) z ω/(1/m + ρ²/I_C), ρ = z - r_y; the foot leaves at -r_x P ρ/I_C."""
    system = walled(BLOCK, Wall(touching(0.1), restitution=ratio))
    start = system_of(system, 0.8, omega0=1.6)
    found = ContactRun(
        Case(start, ground_motion(np.zeros(8), DT), request=Request(g=G))
    )
    event = found.contact_events[found.contact_events["kind"] == 1][0]
    theta, omega = event["q"][2], event["v_before"][2]
    z = 2 * H * math.cos(theta)
    # the centre of gravity from the foot
    r_x = H * math.sin(theta) - B * math.cos(theta)
    r_y = H * math.cos(theta) + B * math.sin(theta)
    inertia, rho = BLOCK.centroidal_inertia, z - r_y
    impulse = (1 + ratio) * z * omega / (1 / M + rho**2 / inertia)
    _, v_y, after = event["v_after"][:3]
    assert theta == pytest.approx(0.1, abs=1e-9)
    told = found.work["outcome"]["largest_impulse"]
    assert told[0] == pytest.approx(impulse, rel=1e-9)
    assert after == pytest.approx(omega - impulse * rho / inertia, rel=1e-9)
    foot = v_y + after * r_x
    assert foot == pytest.approx(-r_x * impulse * rho / inertia, rel=1e-9)
    assert event["after"] == 4  # all open, nothing slides


def tripping(height: float, speed: float):
    """Response of a block that slides at a speed into a kerb that it cannot slide along."""
    # it ends by a ramp of one sample
    pulse = np.full(21, -speed / 0.205)
    motion = np.concatenate([pulse, np.zeros(20)])
    kerb = Wall(B + 0.5 * speed * 0.2 + 0.05 * speed, height=height, friction=math.inf)
    return run(walled(BLOCK, kerb), motion, friction=0.0, closing=1e-6)


@pytest.mark.parametrize("height", [0.02, 0.1, 0.3])
def test_a_block_that_slides_into_a_kerb_topples_from_the_critical_speed_on(
    height: float,
) -> None:
    """ω⁺ = m (h - z_k) V/I_K; it topples if V ≥ V_c (West's speed where z_k = 0)."""
    above = H - height
    radius = math.hypot(B, above)
    inertia = BLOCK.centroidal_inertia + M * radius**2
    critical = math.sqrt(2 * G * (radius - above) * inertia / M) / above
    stays, topples = (
        tripping(height, 0.999 * critical),
        tripping(height, 1.001 * critical),
    )
    event = stays.contact_events[stays.contact_events["kind"] == "impact"].iloc[0]
    assert event["omega_after"][0] == pytest.approx(
        M * above * 0.999 * critical / inertia, rel=1e-6
    )
    assert (stays.overturned, topples.overturned) == (False, True)


def walled_columns(rng: np.random.Generator, bodies: int):
    """Random column between two walls or kerbs, with friction and restitution, static above kinetic."""
    kinetic = rng.uniform(0.15, 0.8, bodies)
    static = kinetic * rng.choice([1.0, 1.4], bodies)
    frictions = list(zip(static.tolist(), kinetic.tolist(), strict=True))
    system = with_contacts(random_column(rng, bodies), frictions)
    reach = max(wall.width / 2 + abs(wall.ends[0].middle) for wall in system.bodies)
    low = rng.uniform(0.05, 0.9) * system.bodies[0].height
    walls = [
        Wall(
            reach * rng.uniform(1.1, 1.6) + 0.05,
            direction,
            float(rng.choice([math.inf, low])),
            friction=rng.uniform(0.0, 0.6),
            restitution=rng.choice([0.0, rng.uniform(0.1, 0.9)]),
        )
        for direction in (0.0, LEFT)
    ]
    return hold(system, *walls)


TOUCHES = 1e-7  # gap over the size below which a place touches after an impact [-]


def touched_walls(system, q, size: float) -> list[Touch]:
    """Places where bodies touch walls, or the edges of kerbs, from the corners of their sides."""
    found, near = [], TOUCHES * size
    standing = np.reshape(corners(system), (system.count, 2, 2, 2))
    centres = np.array(standing_centres(system))
    for wall in system.constraints:
        side, mu = wall.side, max(wall.friction or (0.0, 0.0))
        edge = np.array([side * wall.distance, wall.height])
        for k in range(system.count):
            arms = standing[k, (side + 1) // 2] - centres[k]
            low, high = (q[k, :2] + turn(q[k, 2]) @ arm for arm in arms)
            for x, y in (low, high):
                if abs(x - edge[0]) < near and y <= wall.height + near:
                    found.append(Touch(np.array([x, y]), np.array([-side, 0.0]), mu, k))
            along = (high - low) / np.linalg.norm(high - low)
            inwards = side * np.array([-along[1], along[0]])
            if (
                np.isfinite(wall.height)
                and abs((edge - low) @ inwards) < near
                and -near <= (edge - low) @ along <= np.linalg.norm(high - low) + near
            ):
                found.append(Touch(edge, inwards, mu, k))
    return found


def touched_faces(column: witness.Column, q) -> list[Touch]:
    """Places where bodies touch the ground or what is below them."""
    mus = np.maximum(column.static, column.kinetic)
    return [
        Touch(end.point, end.normal, mus[k], k, k - 1)
        for k in range(len(q))
        for end in witness.ends_of(column, q, k)
        if abs(end.gap) < TOUCHES * column.size
    ]


def examined(system, impact: witness.Impact) -> tuple[float, float]:
    """Momentum that no pushes within friction explain, and energy that is gained, of an impact [-]."""
    column = witness.Column.of(system, G)
    unit = column.mass * column.speed
    units = np.array([unit, unit, unit * column.size])
    masses = np.array([[body.mass, body.mass, body.inertia] for body in column.bodies])
    change = masses * (impact.after - impact.before) / units
    touches = touched_faces(column, impact.q)
    touches += touched_walls(system, impact.q, column.size)
    rays = [ray / units for touch in touches for ray in planar_rays(touch, impact.q)]
    energies = [
        witness.kinetic_energy(column, v) for v in (impact.before, impact.after)
    ]
    gained = (energies[1] - energies[0]) / (column.mass * column.speed**2)
    return unexplained(np.reshape(rays, (-1, change.size)), change.ravel()), gained


@pytest.mark.parametrize(
    ("hits", "most"), [(200, 2), pytest.param(10_000, 4, marks=pytest.mark.slow)]
)
def test_impacts_at_walls_and_kerbs_gain_nothing_and_push_within_friction(
    hits: int, most: int
) -> None:
    """Of random columns; an impact without an outcome is counted, and nothing else breaks a law."""
    rng, closing = np.random.default_rng(8), 1e-6
    seen = unlawful = counted = 0
    while seen < hits:
        system = walled_columns(rng, int(rng.integers(1, most)))
        motion = 2 * random_motion(rng)[:400]
        case = Case(system, ground_motion(motion, DT), request=Request(g=G))
        found = ContactRun(case, closing)
        struck = found.contact_events[found.contact_events["kind"] == IMPACT]
        struck = struck[struck["at_wall"] > 0][: hits // 10]
        seen += len(struck)
        counted += int(found.work["outcome"]["paradoxes"])
        for impact in impacts_of(system, struck):
            left, gained = examined(system, impact)
            assert gained < 1e-12
            # what shutting slow ends asks of each body
            unlawful += left > SHUT * closing * system.count
    assert unlawful <= counted <= 0.002 * seen


@pytest.mark.parametrize("seed", [147, 432, 1399])
def test_a_side_that_lies_on_a_kerb_does_so_until_the_block_has_fallen(
    seed: int,
) -> None:
    """A side that leans a little outwards is level before it, and its lower corner then above the kerb's edge."""
    rng = np.random.default_rng(seed)
    system = walled_columns(rng, 1)
    motion = ground_motion(2 * random_motion(rng)[:400], DT)
    found = ContactRun(Case(system, motion, request=Request(g=G)), 1e-6)
    assert found.work["outcome"]["overturned_body"] == 1
    assert found.work["outcome"]["paradoxes"] == 0
    state = found.work["q"].ravel()[:3]
    assert abs(state[2]) == pytest.approx(math.pi / 2, abs=1e-9)
    touches = touched_walls(system, state[None], size=1.0)
    edge = [touch for touch in touches if touch.point[1] > 0.0]
    assert len(edge) == 1
    assert abs(edge[0].normal[1]) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_balance_of_energy_closes_between_walls(seed: int) -> None:
    found = shaken_block(
        Wall(0.3, friction=0.3, restitution=0.5),
        Wall(0.25, LEFT, height=0.5),
        seed=seed,
    )
    energy = found.energy
    assert energy["lost_walls"].iloc[-1] > 0.0
    assert energy["residual"].abs().max() < 2e-8 * energy["potential"][0]


def flat_against_a_wall(ratio: float, speed: float):
    """Response of a block that slides flat into a wall under a push that lasts, and how fast it met the wall."""
    push = np.full(200, -1.0)
    gap = speed**2 / 2.0
    wall = Wall(B + gap, friction=0.3, restitution=ratio)
    return run(walled(BLOCK, wall), push, friction=0.0, closing=1e-4)


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.8])
def test_a_rattle_of_a_flat_side_ends_as_its_geometric_series_does(
    ratio: float,
) -> None:
    """Bounces of V eⁿ last 2 V eⁿ/a each: V/a + 2 V e/(a (1 - e)) in all, and they take all of m V²/2."""
    speed = 0.15
    found = flat_against_a_wall(ratio, speed)
    events = found.contact_events[found.contact_events["kind"] == "impact"]
    closing = 1e-4 * math.sqrt(G * B)
    bounces = math.ceil(math.log(closing / speed) / math.log(ratio))
    assert abs(len(events) - bounces) <= 1
    ends = speed + 2 * speed * ratio / (1 - ratio)
    left_out = 2 * closing / (1 - ratio)
    assert ends - left_out <= events["time"].iloc[-1] <= ends + 1e-9
    assert np.abs(found.theta).max() < 1e-13
    at_rest = found.time > ends
    assert at_rest.any()
    assert np.ptp(found.slip[at_rest & (found.time < 1.98)]) < 1e-13
    assert found.energy["lost_walls"].iloc[-1] == pytest.approx(
        0.5 * M * speed**2, rel=1e-9
    )


def test_the_third_body_of_a_column_that_leans_over_is_held_by_the_wall() -> None:
    column = Column((Block(0.5, 0.3, 100.0), Block(0.45, 0.3, 80.0), BLOCK))
    motion = 6.0 * np.sin(2 * np.pi * np.arange(0, 1, DT))
    free = run(column, motion, friction=0.7)
    held = run(walled(column, Wall(0.27), Wall(0.27, LEFT)), motion, friction=0.7)
    assert (free.overturned, held.overturned) == (True, False)


@pytest.mark.parametrize("gap", [0.05, 0.3])
def test_a_cart_meets_a_wall_at_the_speed_that_rolling_over_the_gap_gives(
    gap: float,
) -> None:
    """V² = 2 (a - µ_r g) s, all of which a flat side loses at a wall without restitution."""
    push = np.full(400, -2.0)
    cart = on_casters(as_system(BLOCK), "free")
    found = run(hold(cart, Wall(B + gap)), push)
    speed = math.sqrt(2 * (2.0 - ROLLING.kinetic * G) * gap)
    assert found.energy["lost_walls"].iloc[-1] == pytest.approx(
        0.5 * M * speed**2, rel=1e-6
    )
    assert found.constraints["largest_impulse_n_s"][0] == pytest.approx(
        M * speed, rel=1e-6
    )
    assert np.abs(found.theta).max() < 1e-15


def test_a_cart_on_free_casters_never_rocks_until_it_meets_the_kerb() -> None:
    motion = 2 * random_motion(np.random.default_rng(3))
    cart = on_casters(as_system(BLOCK), "free")
    rolls = run(cart, motion)
    gap = 0.5 * rolls.slip.max()
    held = hold(cart, Wall(B + gap, height=0.1, friction=0.5))
    meets = run(held, motion)
    hit = meets.contact_events["time"][meets.contact_events["kind"] == "impact"].iloc[0]
    assert np.abs(rolls.theta).max() == 0.0
    assert np.abs(meets.theta[meets.time < hit]).max() == 0.0
    assert np.abs(meets.theta[meets.time > hit]).max() > 0.0
    assert meets.constraints["hits"][0] > 0


def test_what_a_wall_bears_is_what_presses_on_it_whatever_was_shaken_before() -> None:
    """Forces of a bracket or impulses of a stop that were left in the memory were told as forces of a wall."""
    stopped = hold(as_system(BLOCK), support=SlidingPendulum(mass=10.0, stroke=0.02))
    free = walled(Block(0.3, 0.9, 60.0), Wall(0.17))
    motion = Motion(random_motion(np.random.default_rng(5)), DT)
    scales = np.array([[1.0, 2.0, 3.0]])
    beside = overturns([stopped, free], [motion], scales=scales, threads=1)
    alone = overturns([free], [motion], scales=scales, threads=1)
    assert beside.largest_impulse[1, ..., 0].max() > 0
    np.testing.assert_array_equal(beside.largest_force[1], alone.largest_force[0])


def between_rough_walls(seed: int, number: int):
    """A block that rocks and slides between two rough walls from which it bounces, drawn as one of a row."""
    rng = np.random.default_rng(seed)
    for _ in range(number + 1):
        width = rng.uniform(0.15, 0.6)
        block = Block(width, width * rng.uniform(1.5, 5), rng.uniform(20, 200))
        mu, at_wall = rng.uniform(0.2, 0.9), rng.uniform(0.0, 0.9)
        bounces = float(rng.choice([0.0, 0.3, 0.8]))
        gap = rng.uniform(0.01, 0.3) * width
        motion = rng.uniform(1, 5) * random_motion(rng)[:400]
    sides = [
        Wall(width / 2 + gap, way, friction=(at_wall, at_wall), restitution=bounces)
        for way in (0.0, LEFT)
    ]
    return run(walled(block, *sides), motion, friction=mu, closing=1e-4)


@pytest.mark.parametrize("number", [6, 16, 60, 99, 159])
def test_between_rough_walls_time_goes_on(number: int) -> None:
    """Two contacts hold a slip at once (6, 16), an end is shut and opened (60), pressed to a wall it bounces."""
    found = between_rough_walls(3, number)
    assert found.forced == 0
    assert np.isfinite(found.theta).all()
    assert found.energy["residual"].abs().max() < 1e-6 * found.energy["potential"][0]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    ("height", "inside"),
    [
        (math.inf, 0.4 / 2 + 1.2 * math.sin(0.15) - 0.25),  # its upper corner
        # its side passes the edge of the wall
        (0.6, 0.4 / 2 + 0.6 * math.tan(0.15) - 0.25),
        (0.3, None),
    ],
)
def test_a_start_inside_a_wall_is_refused(side, height, inside):
    block, direction = as_system(Block(0.4, 1.2, 100.0)), 0.0 if side > 0 else math.pi
    held = hold(block, Wall(0.25, direction, height=height))
    motion = np.zeros(20)

    def doors(angle):
        start = replace(held, start=Start((angle,), (0.0,)))
        yield lambda: simulate(held, motion, DT, theta0=angle, friction=0.5)
        yield lambda: overturns(held, motion, DT, theta0=[angle], friction=0.5)
        yield lambda: simulate(start, motion, DT, friction=0.5)

    for give in doors(0.15 * side):
        if inside is None:
            give()
            continue
        says = f"Start: the block begins {inside:.3g} m inside wall 1; turn it less"
        with pytest.raises(InputError, match=says):
            give()
    for give in (*doors(0.04 * side), *doors(-0.15 * side)):
        give()


def test_a_plate_that_starts_beyond_its_stop_is_refused():
    dish = SlidingPendulum(mass=50.0, radius=2.0, friction=0.1, stroke=0.1)
    held = hold(as_system(BLOCK), support=dish)
    for plate, is_refused in ((0.1, False), (0.11, True), (-0.11, True)):
        centre = ((plate, BLOCK.height / 2),)
        system = replace(held, start=Start((0.0,), (0.0,), centre, plate))
        if not is_refused:
            simulate(system, np.zeros(20), DT, friction=0.5)
            continue
        with pytest.raises(InputError, match=r"the plate begins 0\.01 m beyond the"):
            simulate(system, np.zeros(20), DT, friction=0.5)
