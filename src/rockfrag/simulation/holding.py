"""What holds a block, in closed form: what a bond, a bracket, a cord, a kerb and a wall must bear.

A block of mass m stands on two edges, its centre of gravity at the height h over its base and x_c to the right of
its middle.  The ground accelerates by a to the right and by a_v upwards.  All of it is about one instant, at rest
or as the block turns by a small angle; what follows is simulated.  Derived in ``docs/holding.md``, whose equations
are named at each function.

In: a block, accelerations [m/s²], and places of what holds it [m]. Out: forces [N] and speeds [m/s].
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import number_from_zero, positive_number, real_number
from rockfrag.base.units import GRAVITY
from rockfrag.system.blocks import Block


def bond_breaks_at(
    block: Block, tension: float, half_spacing: float, *, g: float = GRAVITY
) -> float:
    """Least acceleration of the ground that opens a bond of two pads [m/s²].

    ``docs/holding.md`` (4); each pad holds half of the tension, and both lie as far from the middle of the base.

    Parameters
    ----------
    block : what is bonded to the ground
    tension : that both pads hold together [N]
    half_spacing : from the middle of the base to each pad [m]
    g : acceleration of gravity, with that of the ground upwards [m/s²]

    Returns
    -------
    The acceleration, to the side that opens first [m/s²].
    """
    number_from_zero("tension", tension, "newtons")
    positive_number("half_spacing", half_spacing, "metres")
    reach = half_spacing - abs(block.cg_offset)
    return (g * reach + half_spacing * tension / block.mass) / block.h


def bond_slides_at(
    block: Block, shear: float, friction: float = 0.0, *, g: float = GRAVITY
) -> float:
    """Least acceleration of the ground that shears a bond off [m/s²]; ``docs/holding.md`` (5).

    Parameters
    ----------
    block : what is bonded to the ground
    shear : that the bond holds in all without any weight on it [N]
    friction : coefficient of friction under the weight [-]
    g : acceleration of gravity, with that of the ground upwards [m/s²]

    Returns
    -------
    The acceleration [m/s²].
    """
    number_from_zero("shear", shear, "newtons")
    number_from_zero("friction", friction)
    return friction * g + shear / block.mass


def layer_cracks_at(
    block: Block, depth: float, strength: float, *, g: float = GRAVITY
) -> float:
    """Least acceleration of the ground at which a layer under the whole base cracks at its edge [m/s²].

    ``docs/holding.md`` (6).  The stress is linear across the layer; of a brittle one (mortar, hard wax) the
    crack runs through.  A layer of less strength than twice the mean pressure is of no use.

    Parameters
    ----------
    block : what stands on the layer, with its centre of gravity over the middle
    depth : of the layer across the plane of motion [m]
    strength : in tension [Pa]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The acceleration [m/s²].
    """
    positive_number("depth", depth, "metres")
    number_from_zero("strength", strength, "pascals")
    if block.cg_offset:
        raise InputError(
            "layer_cracks_at: the centre of gravity lies aside; give a block without cg_offset."
        )
    area = block.width * depth
    return block.width / (6 * block.h) * (g + strength * area / block.mass)


def bond_tension_needed(
    block: Block,
    acceleration: ArrayLike,
    half_spacing: float,
    vertical: ArrayLike = 0.0,
    *,
    g: float = GRAVITY,
) -> float:
    """Tension that two pads together must hold for a block to move with the ground [N]; ``docs/holding.md`` (3).

    The force is linear in the accelerations, which are linear between samples, so that samples suffice: exact.

    Parameters
    ----------
    block : what is bonded to the ground
    acceleration, vertical : of the ground at its samples, of one shape [m/s²]
    half_spacing : from the middle of the base to each pad [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The tension, twice that of the pad that is pulled most; 0 where none is [N].
    """
    positive_number("half_spacing", half_spacing, "metres")
    a, weight = _accelerations(acceleration, vertical, g)
    # pushed to the left (a > 0) a block pulls at its right pad
    reach = half_spacing + np.sign(a) * block.cg_offset
    pulled = block.mass * (np.abs(a) * block.h - weight * reach) / half_spacing
    return max(float(pulled.max()), 0.0)


def bond_shear_needed(
    block: Block,
    acceleration: ArrayLike,
    friction: float = 0.0,
    vertical: ArrayLike = 0.0,
    *,
    g: float = GRAVITY,
) -> float:
    """Shear that a bond must hold beside friction for a block to move with the ground [N].

    ``docs/holding.md`` (3).

    Parameters
    ----------
    block : what is bonded to the ground
    acceleration, vertical : of the ground at its samples, of one shape [m/s²]
    friction : coefficient of friction under the weight [-]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The shear, 0 where friction suffices [N].
    """
    number_from_zero("friction", friction)
    a, weight = _accelerations(acceleration, vertical, g)
    return max(float(block.mass * (np.abs(a) - friction * weight).max()), 0.0)


def bracket_force_needed(
    block: Block,
    acceleration: ArrayLike,
    height: float,
    vertical: ArrayLike = 0.0,
    *,
    g: float = GRAVITY,
) -> float:
    """Horizontal force that a bracket without slack must bear both ways for a block to stay [N].

    ``docs/holding.md`` (8): balance about the edge over which the block would rise; its foot must not slide.

    Parameters
    ----------
    block : what is fixed to a wall that moves with the ground
    acceleration, vertical : of the ground at its samples, of one shape [m/s²]
    height : of the bracket over the base [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The force, 0 where the block would not rise without the bracket [N].
    """
    positive_number("height", height, "metres")
    a, weight = _accelerations(acceleration, vertical, g)
    # pushed to the left (a > 0) a block rises over its left edge
    reach = block.width / 2 + np.sign(a) * block.cg_offset
    moment = block.mass * (np.abs(a) * block.h - weight * reach)
    return max(float(moment.max()), 0.0) / height


def cord_peak_force(
    block: Block,
    stiffness: float,
    height: float,
    rate: float,
    acceleration: float = 0.0,
    *,
    g: float = GRAVITY,
) -> float:
    """Largest force of a horizontal cord that gets taut as a block turns [N]; ``docs/holding.md`` (9).

    Angles are small, and the ground accelerates evenly while the cord is taut.

    Parameters
    ----------
    block : what turns about an edge of its base, with its centre of gravity over the middle of that
    stiffness : of the cord [N/m]
    height : of the cord over the base [m]
    rate : angular velocity of the block when the cord gets taut [rad/s]
    acceleration : of the ground, which turns the block on where it is positive [m/s²]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The force [N].
    """
    positive_number("stiffness", stiffness, "N/m")
    positive_number("height", height, "metres")
    number_from_zero("rate", rate, "rad/s")
    real_number("acceleration", acceleration, "m/s²")
    reach = block.width / 2
    steady = block.mass * (acceleration * block.h - g * reach) / height
    inertia = block.centroidal_inertia + block.mass * (reach**2 + block.h**2)
    return steady + math.sqrt(steady**2 + stiffness * inertia * rate**2)


def kerb_topples_from(block: Block, height: float, *, g: float = GRAVITY) -> float:
    """Speed at which a sliding or rolling block trips over a kerb and just topples [m/s]; ``docs/holding.md`` (7).

    The impact is plastic and the angular momentum about the kerb's edge is kept; at the height 0 it is that of a
    block whose foot is stopped.

    Parameters
    ----------
    block : what arrives, with its centre of gravity over the middle of its base
    height : of the kerb, below the centre of gravity [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The speed [m/s].
    """
    number_from_zero("height", height, "metres")
    above = block.h - height
    if above <= 0:
        raise InputError(
            f"kerb: {height:g} m reach up to the centre of gravity at {block.h:g} m; "
            "a block does not trip over it."
        )
    reach = block.width / 2
    radius = math.hypot(reach, above)
    inertia = block.centroidal_inertia + block.mass * radius**2
    return math.sqrt(2 * g * (radius - above) * inertia / block.mass) / above


def wall_impulse(
    block: Block, height: float, rate: float, restitution: float = 0.0
) -> float:
    """Impulse with which an upright block that turns about its edge meets a smooth wall [N s].

    ``docs/holding.md`` (2).  The block is free in its impact: a foot that stayed would have to be pulled down.

    Parameters
    ----------
    block : what turns about an edge of its base, next to upright
    height : at which it meets the wall [m]
    rate : angular velocity before [rad/s]
    restitution : speed away from the wall after the impact over that towards it before [-]

    Returns
    -------
    The impulse [N s].
    """
    positive_number("height", height, "metres")
    number_from_zero("rate", rate, "rad/s")
    number_from_zero("restitution", restitution)
    arm = height - block.h
    compliance = 1 / block.mass + arm**2 / block.centroidal_inertia
    return (1 + restitution) * height * rate / compliance


def leaning_friction(block: Block, height: float, gap: float) -> float:
    """Least friction under the foot of a block that leans at rest against a smooth wall [-].

    ``docs/holding.md`` (1).

    Parameters
    ----------
    block : what has turned about an edge of its base, with its centre of gravity over the middle
    height : of its upper edge, over the base as it stands [m]
    gap : between that edge and the wall as it stands [m]

    Returns
    -------
    The coefficient; 0 where it would fall back from the wall, as its weight is still over the base.
    """
    positive_number("height", height, "metres")
    number_from_zero("gap", gap, "metres")
    reach = block.width / 2
    angle = leaning_angle(block, height, gap)
    sine, cosine = math.sin(angle), math.cos(angle)
    beyond = block.h * sine - reach * cosine
    return max(beyond, 0.0) / (height * cosine)


def leaning_angle(block: Block, height: float, gap: float) -> float:
    """Angle by which a block has turned about its foot when its upper edge touches a wall [rad].

    Parameters
    ----------
    block : what turns about the edge of its base on the side of the wall
    height : of its upper edge, straight over that of the base [m]
    gap : between both edges and the wall as it stands [m]

    Returns
    -------
    The angle.
    """
    if gap >= height:
        raise InputError(
            f"wall: at {gap:g} m it is out of reach of an edge {height:g} m high; the block falls flat."
        )
    return math.asin(gap / height)


def isolator_transmits(radius: float, friction: float, stroke: float) -> float:
    """Largest acceleration that a sliding pendulum hands on to what stands on it, over gravity [-].

    ``docs/holding.md`` (10).  Below b/h of what stands on it nothing rocks, whatever the vertical, until the stop
    is met.

    Parameters
    ----------
    radius : of the pendulum [m]
    friction : coefficient of its slider [-]
    stroke : largest displacement from its middle [m]

    Returns
    -------
    The acceleration over gravity.
    """
    positive_number("radius", radius, "metres")
    number_from_zero("friction", friction)
    number_from_zero("stroke", stroke, "metres")
    return friction + stroke / radius


def isolator_period(radius: float, *, g: float = GRAVITY) -> float:
    """Period of a sliding pendulum, whatever it carries [s]; ``docs/holding.md`` (10).

    Parameters
    ----------
    radius : of the pendulum [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The period [s].
    """
    positive_number("radius", radius, "metres")
    return 2 * math.pi * math.sqrt(radius / g)


def _accelerations(
    acceleration: ArrayLike, vertical: ArrayLike, g: float
) -> tuple[Floats, Floats]:
    """Horizontal accelerations of the ground, and effective gravity, of one shape [m/s²]."""
    a, up = np.broadcast_arrays(
        np.asarray(acceleration, dtype=np.float64), np.asarray(vertical, np.float64)
    )
    return a, g + up
