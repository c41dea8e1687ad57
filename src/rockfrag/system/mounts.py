"""Usual ways to hold an object: a wall beside it, putty under it, cords and brackets at its top, casters.

In: a system and what people state of a mount.  Out: the walls, ties and bonds of ``docs/holding.md``.
"""

import math

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import number_from_zero, positive_number
from rockfrag.system import footprint
from rockfrag.system.body import Circle, Interval, Outline
from rockfrag.system.bond import Bond
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.contact import Friction
from rockfrag.system.system import System, bearing, corners

CORD = 1.0  # length of a cord, whose end is level with the top of the object [m]
BRACKET = 0.1  # length of a bracket where no wall is near [m]
ROLLING = Friction(0.03, 0.03)
"""Rolling resistance of free casters: the geometric middle of .01 to .1 (Nikfar and Konstantinidis, 2017)."""
CASTERS = ("locked", "free")


def reach(system: System, side: int) -> float:
    """Distance to which planar bodies reach on a side, from the origin of the lowest base.

    Parameters
    ----------
    system, side : the system, and +1 (right) or -1 (left)

    Returns
    -------
    The distance [m].
    """
    return max(side * x for x, _ in corners(system))


def wall_beside(
    system: System,
    gap: float,
    side: int = 1,
    *,
    height: float = math.inf,
    friction: Friction | None = None,
    restitution: float = 0.0,
) -> Wall:
    """Wall, or kerb, at a distance from the side of what stands there.

    Parameters
    ----------
    system, gap, side : the system, the distance [m], and the side: +1 (right) or -1 (left)
    height, friction, restitution : as of :class:`rockfrag.system.Wall`

    Returns
    -------
    The wall.
    """
    number_from_zero("wall: distance from the side", gap, "metres")
    return Wall(
        reach(system, side) + gap,
        0.0 if side > 0 else math.pi,
        height=height,
        friction=friction,
        restitution=restitution,
    )


def cords_at_top(
    system: System, stiffness: float, slack: float = 0.0, strength: float = math.inf
) -> tuple[Tie, Tie]:
    """Two cords from the upper corners of the object, level, to both sides.

    Parameters
    ----------
    system, stiffness : the system, and the stiffness of each [N/m]
    slack, strength : as of :class:`rockfrag.system.Tie` [m, N]

    Returns
    -------
    The cords to the left and to the right.
    """
    body = system.in_plane().bodies[-1]
    left, right = body.ends[1]
    found = [
        Tie(
            (end, 0.0, body.height),
            (side * (max(reach(system, side), side * end) + CORD), 0.0, system.height),
            stiffness,
            slack=slack,
            strength=strength,
        )
        for side, end in ((-1, left), (1, right))
    ]
    return found[0], found[1]


def bracket_at_top(
    system: System,
    stiffness: float,
    slack: float = 0.0,
    strength: float = math.inf,
    *,
    length: float = BRACKET,
) -> Tie:
    """Bracket from the upper right corner of the object to a wall on its right.

    Parameters
    ----------
    system, stiffness, slack, strength : as of :func:`cords_at_top`
    length : from the side of what stands there to the wall [m]

    Returns
    -------
    The tie, which pulls and pushes.
    """
    body = system.in_plane().bodies[-1]
    length = positive_number("bracket: length", length or BRACKET, "metres")
    return Tie(
        (body.ends[1].right, 0.0, body.height),
        (reach(system, 1) + length, 0.0, system.height),
        stiffness,
        slack=slack,
        strength=strength,
        bracket=True,
    )


def putty_under(
    system: System,
    tension: float,
    shear: float | None = None,
    spread: float | None = None,
) -> Bond:
    """Putty or wax under the uppermost body.

    Parameters
    ----------
    system, tension : the system, and the tensile capacity of all pads [N]
    shear : their capacity in shear [N]; None: the same
    spread
        Half the distance of the pads [m]; None: they lie at the ends of what of the base lies on what is under it,
        in space at its corners or within it (:func:`pads_under`). Across the plane of x they lie no further out.

    Returns
    -------
    The bond.
    """
    along, across = pads_under(bearing(system, system.count - 1), 1.0)
    if spread is not None:
        along, across = spread, spread if system.planar else min(spread, across)
    return Bond(tension, tension if shear is None else shear, (along, across))


def pads_under(base: Outline, part: float) -> tuple[float, float]:
    """Half the distances of four pads under a base along its axes [m].

    Parameters
    ----------
    base : that they lie under
    part : distance of the pads from its middle over that of its edge [-]

    Returns
    -------
    Both half distances [m]; of a planar base the same.
    """
    if isinstance(base, Interval):
        half = part * (base.right - base.left) / 2
        return half, half
    if isinstance(base, Circle):
        # all four lie on it, whichever side its centre is on
        return footprint.pads_in_circle(base.radius - math.hypot(*base.centre), part)
    return footprint.pads_in_polygon(base.vertices, len(base.vertices), part)


def on_casters(system: System, word: str) -> System:
    """System whose lowest body stands on casters.

    Parameters
    ----------
    system : whose friction on the ground is that of locked casters
    word : ``"locked"`` or ``"free"``, which roll against :data:`ROLLING`

    Returns
    -------
    The system.
    """
    if word not in CASTERS:
        raise InputError(f"casters: expected locked or free, got {word!r}.")
    if word == "locked":
        return system
    return system.with_friction(ROLLING)
