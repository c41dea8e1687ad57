"""Blocks and stacks as numbers, beside matrices, sums over masses and momenta about points."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.system import geometry

G = 9.81


def drawn(rng: np.random.Generator) -> geometry.Shape:
    """A block off the middle of its base."""
    b, y = rng.uniform(0.1, 0.4), rng.uniform(0.2, 1.0)
    return geometry.Shape(
        b, rng.uniform(5, 80), rng.uniform(0.5, 9), rng.uniform(-0.3, 0.3) * b, y
    )


def angular_momentum(
    shape: geometry.Shape, pivot: int, about: tuple[float, float]
) -> float:
    """Of a unit of clockwise rate about a pivot, about a point, both on the base; clockwise."""
    x, y = shape.x - pivot * shape.b, shape.y
    # clockwise velocity of the centre
    u, v = y, -x
    dx, dy = shape.x - about[0], shape.y - about[1]
    return shape.inertia + shape.mass * (u * dy - v * dx)


def test_turns_are_those_of_rotation_matrices():
    rng = np.random.default_rng(1)
    for _ in range(5):
        a, (x, y) = rng.uniform(-2, 2), rng.normal(size=2)
        c, s = math.cos(a), math.sin(a)
        rotation = np.array([[c, -s], [s, c]])
        assert geometry.turned(x, y, a) == pytest.approx(rotation.T @ (x, y))
        assert geometry.turned_in_plan(x, y, s, c) == pytest.approx(rotation @ (x, y))
        xx, xy, yy = rng.normal(size=3)
        tensor = rotation @ [[xx, xy], [xy, yy]] @ rotation.T
        found = geometry.turned_moments(xx, xy, yy, s, c)
        assert found == pytest.approx((tensor[0, 0], tensor[0, 1], tensor[1, 1]))


@pytest.mark.parametrize("pivot", [1, -1])
def test_a_block_about_a_corner_is_as_heavy_as_steiner_says(pivot):
    rng = np.random.default_rng(2)
    for _ in range(5):
        shape = drawn(rng)
        to_centre = np.array([shape.x - pivot * shape.b, shape.y])
        size = np.linalg.norm(to_centre)
        inertia = shape.inertia + shape.mass * size**2
        assert geometry.radius(shape, pivot) == pytest.approx(size)
        assert geometry.pivot_inertia(shape, pivot) == pytest.approx(inertia)
        p = math.sqrt(shape.mass * G * size / inertia)
        assert geometry.frequency(shape, pivot, G) == pytest.approx(p)
        # turned so far the centre is right above the corner
        angle = geometry.critical_angle(shape, pivot)
        x, y = geometry.turned(*to_centre, pivot * angle)
        assert (x, y) == pytest.approx((0.0, size), abs=1e-12)


@pytest.mark.parametrize("pivot", [1, -1])
def test_impacts_keep_the_momentum_about_the_point_at_which_they_act(pivot):
    rng = np.random.default_rng(3)
    for _ in range(5):
        shape, old = drawn(rng), -pivot

        def left(place, shape=shape, old=old):
            """Ratio of the rates after and before an impulse there."""
            about = (place * pivot * shape.b, 0.0)
            return angular_momentum(shape, old, about) / angular_momentum(
                shape, pivot, about
            )

        assert geometry.momentum_restitution(shape, pivot) == pytest.approx(left(1.0))
        for place in (0.3, 0.8):
            found = geometry.impulse_position(shape, left(place), pivot)
            assert found == pytest.approx(place)
        largest = geometry.largest_restitution(shape, pivot)
        about = [geometry.pivot_inertia(shape, each) for each in (old, pivot)]
        assert about[1] * largest**2 == pytest.approx(about[0])
        of_momentum = max(left(1.0), 0.0)
        scaled = geometry.scaled_restitution(shape, pivot, math.nan, 0.9)
        assert scaled == pytest.approx(min(0.9 * of_momentum, largest))
        assert geometry.scaled_restitution(shape, pivot, 0.5, 1.2) == pytest.approx(
            min(0.6, largest)
        )
        assert geometry.scaled_restitution(shape, pivot, 0.5, 99.0) == largest
        assert geometry.scaled_restitution(shape, pivot, -0.5, 1.0) == 0.0


def test_a_jump_of_the_base_keeps_the_momentum_about_the_pivot_and_turns_the_block_over_it():
    rng, seen = np.random.default_rng(4), set()
    for _ in range(60):
        shape = drawn(rng)
        jump = tuple(rng.normal(0, 0.5, 2))
        for pivot in (1, -1):
            theta, omega = pivot * rng.uniform(0.01, 0.3), rng.normal()
            x, y = geometry.turned(shape.x - pivot * shape.b, shape.y, theta)
            # in the moving frame the centre jumps the other way
            gained = shape.mass * (-jump[0] * y + jump[1] * x)
            expected = omega + gained / geometry.pivot_inertia(shape, pivot)
            found = geometry.kicked(shape, pivot, theta, omega, jump)
            assert found == pytest.approx(expected)
            assert geometry.jumped(shape, theta, omega, jump) == (pivot, found)
        rates = {
            pivot: geometry.kicked(shape, pivot, 0.0, 0.0, jump) for pivot in (1, -1)
        }
        opens = [pivot for pivot, rate in rates.items() if pivot * rate > 0]
        pivot, rate = geometry.jumped(shape, 0.0, 0.0, jump)
        seen.add(pivot)
        if not opens:
            assert (pivot, rate) == (0, 0.0)
        else:
            assert pivot == max(opens, key=lambda each: each * rates[each])
            assert rate == rates[pivot]
    assert seen == {-1, 0, 1}


def test_a_jump_that_stops_a_block_at_its_impact_takes_it_over_to_the_other_pivot():
    shape = geometry.Shape(0.1, 10.0, 1.0, 0.0, 0.4)
    # it comes down turning clockwise, and the base jumps that way too
    for speed in (0.01, 0.5):
        jump = (speed, 0.0)
        pivot, rate = geometry.jumped(shape, 0.0, 1e-3, jump)
        left = geometry.momentum_restitution(shape, -1) * 1e-3
        assert (pivot, rate) == (-1, geometry.kicked(shape, -1, 0.0, left, jump))
    assert geometry.jumped(shape, 0.0, 1.0, (1e-3, 0.0)) == (
        1,
        geometry.kicked(shape, 1, 0.0, 1.0, (1e-3, 0.0)),
    )


@pytest.mark.parametrize("side", [1, -1])
def test_the_mirror_image_of_a_jump_turns_the_mirror_image_of_a_block(side):
    shape = geometry.Shape(0.1, 10.0, 1.0, side * 0.02, 0.4)
    pivot, rate = geometry.jumped(shape, 0.0, side * 1.0, (side * 0.2, 0.1))
    plain = geometry.Shape(0.1, 10.0, 1.0, 0.02, 0.4)
    expected = geometry.jumped(plain, 0.0, 1.0, (0.2, 0.1))
    assert (side * pivot, side * rate) == pytest.approx(expected)


def test_a_tensor_of_inertia_turns_a_block_in_its_plane_about_y():
    block = Block(
        0.4, 1.0, 50.0, ((7.0, 0.0, 0.0), (0.0, 5.0, 0.0), (0.0, 0.0, 2.0)), depth=0.3
    )
    assert block.centroidal_inertia == 5.0


@pytest.mark.parametrize("pivot", [1, -1])
def test_the_lowest_edge_is_where_the_later_of_both_balances(pivot):
    rng = np.random.default_rng(6)
    for tall in (0.2, 2.0):
        lower = Block(0.6, 0.5, 90.0, cg_offset=0.02)
        pile = Stack(
            lower, Block(0.3, tall, 40.0), offset=rng.uniform(-0.05, 0.05)
        ).pile
        whole = geometry.joined(pile)
        furthest = max(
            geometry.critical_angle(each, pivot) for each in (lower.shape, whole)
        )
        # the pivot of the statue on that side, from the pedestal's
        across = pivot * (pivot * pile.offset + 0.15 - 0.3)
        heights = [geometry.turned(across, 0.5, pivot * a)[1] for a in (0.0, furthest)]
        assert geometry.lowest_edge(pile, pivot) == pytest.approx(min(heights))


def test_two_blocks_as_one_have_the_centre_and_the_inertia_of_both():
    rng = np.random.default_rng(5)
    for _ in range(5):
        lower = Block(
            0.6, rng.uniform(0.3, 0.8), 90.0, cg_offset=rng.uniform(-0.05, 0.05)
        )
        upper = Block(
            0.3, rng.uniform(0.5, 1.2), 40.0, cg_offset=rng.uniform(-0.03, 0.03)
        )
        offset = rng.uniform(-0.08, 0.08)
        pile = Stack(lower, upper, offset=offset).pile
        whole = geometry.joined(pile)
        masses = np.array([90.0, 40.0])
        centres = np.array(
            [
                (lower.shape.x, lower.shape.y),
                (offset + upper.shape.x, lower.height + upper.shape.y),
            ]
        )
        centre = masses @ centres / 130.0
        assert (whole.x, whole.y) == pytest.approx(centre)
        spread = masses @ np.square(centres - centre).sum(axis=1)
        inertia = lower.shape.inertia + upper.shape.inertia + spread
        assert (whole.mass, whole.inertia) == pytest.approx((130.0, inertia))
        for pivot in (1, -1):
            arm = geometry.common_arm(pile, pivot)
            assert arm == pytest.approx((centre[0] - pivot * 0.3, centre[1]))
            assert geometry.overhang(pile, pivot) == pytest.approx(0.0, abs=1e-15)
        assert geometry.failed_stability_check(pile) == geometry.STANDS


@pytest.mark.parametrize(
    ("offset", "aside", "why"),
    [
        (0.0, 0.0, geometry.STANDS),
        (0.46, 0.0, geometry.BESIDE),
        (0.35, 0.0, geometry.OFF_CONTACT),
        (-0.35, 0.0, geometry.OFF_CONTACT),
        (0.2, 0.14, geometry.OFF_CONTACT),
    ],
)
def test_a_statue_stands_where_its_centre_is_over_what_it_touches(offset, aside, why):
    """A base of 0.3 m, whose centre of gravity may be aside, on a pedestal of 0.6 m."""
    lower = Block(0.6, 0.5, 300.0).shape
    upper = Block(0.3, 0.6, 20.0, cg_offset=aside).shape
    pile = geometry.pile_of(lower, upper, geometry.Face(0.3, 0.5, 0.0, 0.0, offset))
    assert geometry.failed_stability_check(pile) == why
    # what reaches beyond the pedestal's top
    for pivot in (1, -1):
        beyond = max(0.0, pivot * offset + 0.15 - 0.3)
        if why != geometry.BESIDE:
            assert geometry.overhang(pile, pivot) == pytest.approx(beyond, abs=1e-15)


@pytest.mark.parametrize("pivot", [1, -1])
def test_what_lanes_know_of_a_pivot_is_its_critical_angle_and_frequency(pivot):
    shape = geometry.Shape(0.3, 50.0, 4.0, 0.05, 0.8)
    # from the corner to the centre of gravity
    aside, up = 0.3 - pivot * 0.05, 0.8
    length = math.hypot(aside, up)
    swing = 50.0 * 9.81 * length / (4.0 + 50.0 * length**2)
    alpha = math.atan2(aside, up)
    expected = (
        alpha,
        aside / up,
        aside / length,
        up / length,
        swing,
        0.9,
        1 / alpha,
        1 / (swing * alpha**2),
    )
    assert geometry.pivot_constants(shape, pivot, 0.9, 9.81) == pytest.approx(expected)


def test_kernels_know_the_contact_of_a_stack_and_where_its_blocks_are_from_it():
    lower, upper = Block(0.6, 0.5, 90.0, lean=0.02), Block(0.3, 1.0, 40.0, lean=-0.01)
    pile, body = Stack(lower, upper, offset=0.03).pile, SimpleNamespace()
    geometry.fill_pile(body, pile)
    middle, along = np.array([body.tx, body.ty]), np.array([body.ex, body.ey])
    assert along @ along == pytest.approx(1.0)
    for pivot, end in ((1, pile.right), (-1, pile.left)):
        # from the middle to an end, and from there to the statue's centre of gravity
        assert middle + pivot * body.b2 * along == pytest.approx(end)
        centre = pivot * body.b2 * along + geometry.upper_arm(pile, pivot)
        assert centre == pytest.approx((body.c2x, body.c2y))
        below = geometry.arm(pile.lower, pivot)
        assert (body.c1x - pivot * body.b1, body.c1y) == pytest.approx(below)
    assert (body.m1, body.m2, body.fixed) == (90.0, 40.0, False)
    assert body.i1 == lower.centroidal_inertia and body.i2 == upper.centroidal_inertia
