"""Walls, cords, brackets and putty lie where the bodies that they hold stand."""

import math
from dataclasses import replace

import pytest

from rockfrag import Block, Column, InputError, Stack
from rockfrag.assess.standing.holders import Putty
from rockfrag.system import System, as_system, hold, mounts
from rockfrag.system.body import Circle, Polygon, interval_of
from rockfrag.system.system import cylinder, standing_points, with_bodies

BLOCK = Block(0.3, 1.2, 100.0)
STANDING = {
    "alone": BLOCK,
    "on a wide pedestal": Stack(Block(0.6, 0.4, 300.0), BLOCK, offset=0.05),
    "beyond a narrow pedestal": Stack(Block(0.28, 0.4, 300.0), BLOCK, offset=-0.02),
    "uppermost of three": Column(
        (Block(0.8, 0.2, 300.0), Block(0.5, 0.3, 90.0), BLOCK), (0.04, -0.03)
    ),
}
"""Blocks with level bases."""


def edges(system: System) -> list[tuple[float, float]]:
    """Left and right edge of each upright body from below [m]."""
    middle, found = 0.0, []
    for body, contact in zip(system.bodies, system.contacts, strict=True):
        middle += contact.offset[0]
        found.append((middle - body.width / 2, middle + body.width / 2))
    return found


@pytest.mark.parametrize("name", STANDING)
def test_what_holds_an_object_meets_its_upper_corners_and_ends_beside_all_that_stands(
    name,
):
    system = as_system(STANDING[name])
    found = edges(system)
    beyond = {-1: -min(left for left, _ in found), 1: max(right for _, right in found)}
    top = sum(block.height for block in STANDING[name].blocks)
    cords = mounts.cords_at_top(system, 1e4, 0.01, 500.0)
    bracket = mounts.bracket_at_top(system, 2e4, length=0.3)
    for tie, side, away in [
        (cords[0], -1, None),
        (cords[1], 1, None),
        (bracket, 1, 0.3),
    ]:
        ((x, z),) = standing_points(system, -1, [(tie.point[0], tie.point[2])])
        # from the corner on that side, level
        assert x == pytest.approx(found[-1][side > 0])
        # in the plane of the bodies
        assert tie.point[1] == tie.anchor[1] == 0.0
        assert z == tie.anchor[2] == pytest.approx(top)
        if away is None:
            # a cord ends its own length away from the corner or from what reaches beyond it
            assert side * tie.anchor[0] >= beyond[side] + mounts.CORD - 1e-12
            assert abs(tie.anchor[0] - x) >= mounts.CORD - 1e-12
            corner = side * tie.point[0]
            assert side * tie.anchor[0] - mounts.CORD == pytest.approx(
                max(corner, beyond[side])
            )
        else:
            assert tie.anchor[0] - beyond[1] == pytest.approx(away)
    assert [(tie.stiffness, tie.slack, tie.strength) for tie in cords] == [
        (1e4, 0.01, 500.0)
    ] * 2
    assert bracket.bracket and not cords[0].bracket
    assert (bracket.slack, bracket.strength) == (0.0, math.inf)
    plain = mounts.cords_at_top(system, 1e4)
    assert [(tie.slack, tie.strength) for tie in plain] == [(0.0, math.inf)] * 2
    for side in (-1, 1):
        wall = mounts.wall_beside(system, 0.07, side, restitution=0.3)
        assert (wall.side, wall.distance) == (side, pytest.approx(beyond[side] + 0.07))
        assert hold(system, wall).holding == ("wall 1",)
        # it stops what hits it, at any height
        assert mounts.wall_beside(system, 0.07, side) == replace(wall, restitution=0.0)
        assert (wall.height, wall.friction) == (math.inf, None)
    putty = mounts.putty_under(system, 80.0)
    assert (putty.tension, putty.shear) == (80.0, 80.0)
    ends = edges(system)[-2:]
    rests = min(right for _, right in ends) - max(left for left, _ in ends)
    assert putty.spread == pytest.approx((rests / 2, rests / 2))
    assert mounts.putty_under(system, 80.0, 30.0, 0.1).spread == (0.1, 0.1)
    assert mounts.putty_under(system, 80.0, 30.0, 0.1).shear == 30.0


def test_putty_lies_where_a_base_rests_on_what_is_under_it():
    """Pads beyond the edge of a narrower pedestal had arms that were too long."""
    wide, pedestal = Block(0.6, 1.0, 80.0), Block(0.3, 0.5, 60.0)
    system = as_system(Stack(pedestal, wide, offset=0.04))
    # its middle is 4 cm aside, but it is wider than the pedestal on both sides
    assert mounts.putty_under(system, 80.0).pads == pytest.approx((0.15, 0.15))
    assert Putty().on(system).contacts[1].bond.pads[0] == pytest.approx(0.12)
    with pytest.raises(InputError, match=r"pads lie outside.*give 0.15 m at most"):
        hold(system, bonds=mounts.putty_under(system, 80.0, spread=0.2))
    held = hold(system, bonds=mounts.putty_under(system, 80.0))
    narrower = with_bodies(held, as_system(Stack(Block(0.26, 0.5, 60.0), wide)).bodies)
    assert narrower.contacts[1].bond.pads[0] == pytest.approx(0.13)


def test_putty_of_a_body_in_space_lies_under_its_base_both_ways():
    """Half of the width was taken across it too, where a base is less deep."""
    box = as_system(Block(0.4, 1.2, 100.0, depth=0.1))
    assert mounts.putty_under(box, 80.0).spread == pytest.approx((0.2, 0.05))
    # as far as is stated, and not beyond its edge across that
    stated = mounts.putty_under(box, 80.0, spread=0.15)
    assert stated.spread == pytest.approx((0.15, 0.05))
    assert mounts.putty_under(box, 80.0, spread=0.03).spread == (0.03, 0.03)
    for base in (
        Circle(0.2),
        Polygon(((-0.3, -0.2), (0.25, -0.25), (0.35, 0.1), (-0.2, 0.25))),
    ):
        wide, deep = mounts.pads_under(base, 1.0)
        for x, y in ((wide, deep), (-wide, deep), (-wide, -deep), (wide, -deep)):
            for angle in (0.0, 0.7, 1.9, 2.6, 3.4, 5.0):
                along = math.cos(angle), math.sin(angle)
                end = interval_of(base, along).right
                assert x * along[0] + y * along[1] <= end + 1e-12


def test_putty_in_space_lies_at_the_corners_or_on_the_rim():
    deep = Block(0.6, 1.2, 100.0, depth=0.2).system()
    assert mounts.putty_under(deep, 80.0).pads == pytest.approx((0.3, 0.1))
    round_one = cylinder(0.6, 1.2, 100.0, None, (0.0, 0.0, 0.6))
    system = System((round_one,), deep.contacts)
    pads = mounts.putty_under(system, 80.0).pads
    assert math.hypot(*pads) == pytest.approx(0.3)
    assert hold(system, bonds=mounts.putty_under(system, 80.0)).holding == ("bond 1",)


def test_a_bracket_reaches_to_the_wall_that_is_near_and_is_short_where_none_is():
    system = as_system(BLOCK)
    near, none = (mounts.bracket_at_top(system, 1e4, length=gap) for gap in (0.02, 0.0))
    wall = mounts.wall_beside(system, 0.02)
    assert near.anchor[0] == pytest.approx(wall.distance)
    assert none == mounts.bracket_at_top(system, 1e4)
    assert none.anchor[0] == pytest.approx(0.15 + mounts.BRACKET)
    with pytest.raises(InputError, match="bracket: length"):
        mounts.bracket_at_top(system, 1e4, length=-0.1)


def test_free_casters_change_the_friction_under_the_lowest_body_alone():
    system = as_system(STANDING["on a wide pedestal"])
    assert mounts.on_casters(system, "locked") == system
    rolls = mounts.on_casters(system, "free")
    assert [each.friction for each in rolls.contacts] == [mounts.ROLLING, None]
    # the geometric middle of .01 to .1
    middle = (0.01 * 0.1) ** 0.5
    assert tuple(mounts.ROLLING) == pytest.approx((middle, middle), rel=0.06)
    with pytest.raises(InputError, match="expected locked or free"):
        mounts.on_casters(system, "loose")
