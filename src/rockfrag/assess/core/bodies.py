"""Blocks with a wider foot, another centre of gravity, ballast or a plate: the numbers of each, row by row.

Plain functions of arrays, which the page's module is made of too. A block is a row of seven numbers; NaN stands
for what is not given: an inertia is then that of a uniform rectangle, a centre at half the height.

In: blocks [m, kg]. Out: blocks with a change. Docs: ``docs/assess.md``, "What helps".
"""

import math

from rockfrag.base.arrays import Floats
from rockfrag.base.plausible import STONE
from rockfrag.system.geometry import Face, Shape, joined, pile_of, shape_of

WIDTH, HEIGHT, MASS, INERTIA, CG_HEIGHT, CG_OFFSET, DEPTH = range(7)
"""Places in the row of a block; the depth is that of a rectangular base in space."""

WIDER = 1.25  # Width of a foot plate over that of the base
# Thickness of a foot plate [m], square and of steel [kg/m³]
PLATE, STEEL = 0.02, 7850.0
LOWER = 0.8  # Factor of a lower centre of gravity

BALLAST, BALLAST_AT = 0.25, 0.05  # Its mass and its height over those of the object

PEDESTAL_HEIGHT = 0.5  # Height of another pedestal over that of the one that is there

HIGHER = 1.0 + 1e-9
"""Height of a body that is another one than the object, over that of the object."""


def shape_as_it_stands(block: Floats) -> Shape:
    """The block, a row of seven numbers, as the shape that rocks (:class:`rockfrag.system.geometry.Shape`)."""
    inertia, centre = block[INERTIA], block[CG_HEIGHT]
    return shape_of(
        block[WIDTH], block[HEIGHT], block[MASS], inertia, centre, block[CG_OFFSET], 0.0
    )  # fmt: skip


def _copy(block: Floats, found: Floats) -> None:
    """Copy the numbers of a block into ``found``, as many as that has."""
    for i in range(found.size):
        found[i] = block[i]


def solid_mass(width: float, depth: float, height: float, is_round: bool) -> float:
    """Mass of a box, or of a cylinder, of solid stone [kg], of sides or diameters and height [m]."""
    return STONE * width * depth * height * (math.pi / 4 if is_round else 1.0)


def stretch(
    block: Floats, width: float, height: float, mass: float, found: Floats
) -> None:
    """Fill ``found`` with a block whose edges are moved apart and whose centre of gravity and mass are changed.

    ``width``, ``height``, ``mass``: factors on the width, the height of the centre and the mass [-].
    """
    shape = shape_as_it_stands(block)
    found[WIDTH] = block[WIDTH] * width
    found[HEIGHT] = block[HEIGHT]
    found[MASS] = block[MASS] * mass
    found[INERTIA] = shape.inertia * mass
    found[CG_HEIGHT] = min(shape.y * height, block[HEIGHT])
    found[CG_OFFSET] = block[CG_OFFSET]
    found[DEPTH] = block[DEPTH] * width


def add_ballast(block: Floats, part: float, found: Floats) -> None:
    """Fill ``found`` with a block that has a ``part`` of its mass added near the foot, in the middle of the base.

    Centre and inertia follow from both masses by Steiner's rule.
    """
    shape = shape_as_it_stands(block)
    added = part * shape.mass
    mass = shape.mass + added
    at = BALLAST_AT * block[HEIGHT]
    centre = (shape.mass * shape.y + added * at) / mass
    aside = shape.mass * shape.x / mass
    apart, beside = shape.y - centre, shape.x - aside
    own = shape.mass * (apart * apart + beside * beside)
    away = at - centre
    _copy(block, found)
    found[MASS] = mass
    found[INERTIA] = shape.inertia + own + added * (away * away + aside * aside)
    found[CG_HEIGHT] = centre
    found[CG_OFFSET] = aside


def make_plate(block: Floats, found: Floats) -> None:
    """Fill ``found`` with a square plate of steel under a block, wider than its base; NaN: as it follows."""
    for place in (INERTIA, CG_HEIGHT, DEPTH):
        found[place] = math.nan
    found[WIDTH] = WIDER * block[WIDTH]
    found[HEIGHT] = PLATE
    found[MASS] = STEEL * PLATE * (found[WIDTH] * found[WIDTH])
    found[CG_OFFSET] = 0.0


def make_lower(block: Floats, found: Floats) -> None:
    """Fill ``found`` with a block of another height, of the same section and stone, in place of a pedestal."""
    _copy(block, found)
    found[HEIGHT] = PEDESTAL_HEIGHT * block[HEIGHT]
    found[MASS] = PEDESTAL_HEIGHT * block[MASS]


def join(lower: Floats, upper: Floats, found: Floats) -> None:
    """Fill ``found`` with both blocks as one rigid block, the upper one on the middle of the lower one."""
    whole = joined(
        pile_of(
            shape_as_it_stands(lower),
            shape_as_it_stands(upper),
            Face(lower[WIDTH] / 2, lower[HEIGHT], 0.0, 0.0, 0.0),
        )
    )
    found[WIDTH] = lower[WIDTH]
    found[HEIGHT] = lower[HEIGHT] + upper[HEIGHT]
    found[MASS] = whole.mass
    found[INERTIA] = whole.inertia
    found[CG_HEIGHT] = whole.y
    found[CG_OFFSET] = whole.x
    found[DEPTH] = math.nan


def carries_plate(block: Floats, below: Floats) -> bool:
    """Whether a plate under a block reaches no further than what is below, and so may carry it further out."""
    return bool(WIDER * block[WIDTH] <= below[WIDTH])


# ---- in space


def is_whole(top: Floats, own: Floats) -> bool:
    """Whether a block is the object, of its own sizes, with what it is fixed to."""
    return bool(top[HEIGHT] > own[HEIGHT] * HIGHER)


def tell_box(top: Floats, own: Floats, moments: Floats) -> None:
    """Moments of inertia of an object on a rectangular base, alone or with what it is fixed to, and the depth.

    ``top`` is what moves, ``own`` the object with its depth; moments about x, y and z [kg m²] and the depth of the
    base [m], shape (4,). What it is fixed to has a square base, or one as deep as the object.
    """
    width, depth, mass = own[WIDTH], own[DEPTH], own[MASS]
    across = shape_as_it_stands(top).inertia
    # moments of uniform boxes about x and y differ by what their sides do
    aside = mass * (depth * depth - width * width) / 12
    along = mass * (width * width + depth * depth) / 12
    if is_whole(top, own):
        along += (top[MASS] - mass) * top[WIDTH] * top[WIDTH] / 6
        depth = max(depth, top[WIDTH])
    moments[0], moments[1] = across + aside, across
    moments[2], moments[3] = along, depth


def tell_round(top: Floats, moments: Floats) -> None:
    """Moments of inertia of an object on a round base about x, y, z [kg m²], and its diameter [m], shape (4,)."""
    across = shape_as_it_stands(top).inertia
    moments[0], moments[1] = across, across
    moments[2] = top[MASS] * top[WIDTH] * top[WIDTH] / 8
    moments[3] = top[WIDTH]


# ---- what they stand in


def usual_period(factor: float, height: float) -> float:
    """First period of a building of a height [m], T = C_t H^(3/4) [s] (EN 1998-1:2004, 4.3.3.2.2(3))."""
    root = math.sqrt(height)
    return factor * (root * math.sqrt(root))
