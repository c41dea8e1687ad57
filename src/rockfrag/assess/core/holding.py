"""What holds an object, as numbers: sizes that nobody stated, stiffness, damping, and strengths as one buys them.

Plain functions, which the page's module is made of too, so that what is tried there and by ``rockfrag assess`` is
the same to the bit.

In: blocks [m, kg], forces [N]. Out: what walls, ties, bonds and isolators are made of, SI units.
Docs: ``docs/holding.md``.
"""

import math

from rockfrag.assess.core.bodies import HEIGHT, MASS, WIDTH, shape_as_it_stands
from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.system.support import YIELDS_AT

UNBROKEN = 1e9  # Strength of what is tried before it is known what it must bear [N]
PADS_AT = 0.8
"""Distance of pads from the middle of the base, over that of its edge [-]."""
FASTENED_AT = 0.8  # Height of a bracket or cord over that of the object [-]
# Length of a bracket or cord, from the object's middle beyond its edge [m]
REACH = 0.1
# What a bracket and a cord give under a force as large as the object's weight [m]
BRACKET_GIVES, CORD_GIVES = 0.001, 0.01
DAMPED = 0.05  # Part of critical damping of a bracket, as it swings with the object [-]
RADIUS, SLIDES_AT = 1.0, 0.05
"""Of a sliding pendulum [m], and its friction [-]; a bilinear isolator has its period, and yields at that part of
the weight."""
PLATE = 0.1  # Mass of its plate over that of what stands on it [-]
LOCKED_AT = 0.5  # Coefficient of friction of casters that are locked [-]


def tie_stiffness(mass: float, gives: float) -> float:
    """Stiffness of a tie that gives so much [m] under the weight of a mass [N/m]."""
    return mass * GRAVITY / gives


def bracket_damping(
    mass: float, inertia: float, centre: float, height: float, stiffness: float
) -> float:
    """Damping of a bracket at a height [m] that swings with a body about its base [N s/m].

    ``inertia`` is about the body's centre of gravity, which is at the height ``centre``.
    """
    swinging = (inertia + mass * (centre * centre)) / (height * height)
    return 2 * DAMPED * math.sqrt(stiffness * swinging)


def tell_fastener(block: Floats, is_bracket: bool, found: Floats) -> None:
    """What fastens a planar block: height and reach [m], stiffness [N/m] and damping [N s/m], shape (4,)."""
    shape = shape_as_it_stands(block)
    gives = BRACKET_GIVES if is_bracket else CORD_GIVES
    found[0] = FASTENED_AT * block[HEIGHT]
    found[1] = block[WIDTH] / 2 + REACH
    found[2] = tie_stiffness(block[MASS], gives)
    found[3] = 0.0
    if is_bracket:
        found[3] = bracket_damping(
            block[MASS], shape.inertia, shape.y, found[0], found[2]
        )


def tell_springs(mass: float, found: Floats) -> None:
    """What springs of a bilinear isolator are under a mass, its plate's among it.

    Parameters
    ----------
    mass : that they carry [kg]
    found : gets their stiffness after yielding [N/m], strength [N] and displacement at yield [m], shape (3,)
    """
    weight = mass * GRAVITY
    found[0], found[1], found[2] = weight / RADIUS, SLIDES_AT * weight, YIELDS_AT


def pads_across(width: float) -> float:
    """Half the distance of pads under a base of a width [m]."""
    return PADS_AT * width / 2


def rounded_up(value: float) -> float:
    """Return a positive number rounded up to two digits; what is not finite stays."""
    if not 0.0 < value < math.inf:
        return value
    # whole powers of ten are exact, so that a quotient or a product with one is the number of two digits itself
    tens = 1.0
    if value < 10.0:
        while value * tens < 10.0:
            tens *= 10.0
        return math.ceil(value * tens - 1e-9) / tens
    while value / tens >= 100.0:
        tens *= 10.0
    return math.ceil(value / tens - 1e-9) * tens
