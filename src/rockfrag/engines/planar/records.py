"""From a body and its friction to the records of numbers that the contact kernels read and write.

Bodies are numbered from below; contact k lies under body k.  Ends of a contact are 0 (left) and 1 (right).
Contacts of bodies with walls follow those of bodies with each other (``walls.py``).

In: a :class:`rockfrag.system.system.System`, SI units. Out: records ``BODY``, ``OUTCOME`` and the working memory.
Theory: ``docs/contact.md``, "Coordinates and contacts", equations 1 and 2.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import fields, whole, with_attributes
from rockfrag.engines.planar import _describe
from rockfrag.engines.planar.holding import fill_holding, with_plate
from rockfrag.engines.pure_rocking.ensembles import after_impact
from rockfrag.system.contact import ROUGHEST
from rockfrag.system.system import System

MOST = 12  # bodies of the longest column
MOST_WALLED = 12  # contacts of bodies with walls
ALL = MOST + MOST_WALLED  # contacts
MOST_TIES = 8
MOST_CONSTRAINTS = 16
TERMS = 18  # of the series of a plate and its load (``carried.py``)
TRIES = 1024  # modes that a search tries at most: more than three interfaces have
AT_EDGE = 1e-9
"""A corner counts as over the face until it is this fraction of the half width beyond the edge: bases as wide as
their face stand on it and not on its edges."""

BODY = np.dtype(
    [
        *whole("count"),  # bodies: 1 to MOST
        *fields("g"),
        *fields("mass inertia", MOST),
        *fields("inverse", 3 * MOST),  # 1/m, 1/m, 1/I of each body
        # [body, end] of its base from its centre, x and y [m]
        *fields("corner", MOST, 2, 2),
        # [interface] middle of the face below from the centre of the body below
        *fields("face", MOST, 2),
        # [interface] half width of the face below; infinite for the ground
        *fields("half", MOST),
        # [interface] tilt of face and base as all stand
        *fields("tilt_cos tilt_sin", MOST),
        # contacts: of bodies with each other, and with walls
        *whole("contacts"),
        # [contact] bodies above and below it, -1: the ground
        *whole("upper lower", ALL),
        # [contact] coefficients of friction
        *fields("static kinetic", ALL),
        # whether walls, ties, bonds or an isolator hold the bodies
        *whole("is_held"),
        # [contact with a wall] the wall and its side of the bodies; where it stands and ends, its ratio of
        # velocities; corners of the body that may meet it from its centre, in the order of their ends, and the
        # way between them
        *whole("wall side is_stop", ALL),
        *fields("wall_x wall_top bounce", ALL),
        *fields("edge", ALL, 2, 2),
        *fields("flank", ALL, 2),
        # ties: number, body, number among the constraints, whether it pushes too; points on body (from its centre)
        # and ground, natural length to pull and to push, stiffness, damping, strength
        *whole("ties"),
        *whole("tie_body tie_number is_bracket", MOST_TIES),
        *fields("tie_point tie_anchor", MOST_TIES, 2),
        *fields("tie_long tie_short tie_stiffness tie_damping tie_strength", MOST_TIES),
        # whether the lowest body is the plate of an isolator, its number among what holds the bodies, radius of
        # its dish; whether a bilinear spring pulls at it: after yielding, before it, and what yields
        *whole("is_supported support_number is_sprung"),
        *fields("dish_radius spring_stiffness spring_rise spring_strength"),
        # [interface] whether it is bonded; half the distance of its pads, capacity of each, and in shear
        *whole("is_bonded bond_number", MOST),
        *fields("bond_spread bond_tension bond_shear", MOST),
        # [interface, corner that comes down] law of the impact ...
        *whole("law", MOST, 2),
        *fields("number", MOST, 2),  # ... and its number
        # [body, side] its critical angle to the left, to the right [rad]
        *fields("critical", MOST, 2),
        *fields("standing", 3 * MOST),  # x, y, θ of each body as it stands
        # units: of forces the weight of everything [N], of lengths half the width of the uppermost body [m], of
        # speeds √(g size) [m/s]
        *fields("weight size speed"),
    ]
)

OUTCOME = np.dtype(
    [
        # of each body the largest |θ| over the critical angle of its sign, and |θ'| [rad/s]
        *fields("peak_rotation peak_velocity", MOST),
        # of each interface the largest |slip| and the last slip [m]; whether it ever reached its limit, in impacts
        # too; times that it opened at both ends
        *fields("peak_slip slip", MOST),
        *whole("slid flights", MOST),
        *whole("impacts paradoxes"),
        *whole("several_modes"),  # times that more than one mode was found consistent
        *whole("given_way"),  # impacts in which a law would have gained energy
        # from 1 below, 0 none: the body that fell first, and the interface that is open furthest as it falls
        *whole("overturned_body parted_contact"),
        *fields("overturning_time"),  # [s], NaN without a fall
        # whether what has not fallen rests against a wall or in a tie beyond its balance
        *whole("leaning"),
        # of each constraint
        *whole("hits", MOST_CONSTRAINTS),
        *fields("largest_impulse largest_force breaking_time stroke", MOST_CONSTRAINTS),
    ]
)
"""What became of a case."""

WORK = np.dtype(
    [
        # x, y, θ of each body relative to the ground, and their rates
        *fields("q v a", 3 * MOST),
        *whole("closed", ALL, 2),  # [contact, end] the mode: closed ends ...
        *whole("slides", ALL),  # ... and the sign of slip, 0 where a contact sticks
        # of closed ends: CORNER or FACE_EDGE (``solve.py``)
        *whole("kind", ALL, 2),
        *fields("normal", ALL, 2),  # forces, or impulses
        *fields("shear", ALL),
        *fields("out", 3 * MOST),  # accelerations, or velocities after an impact
        *fields("cos sin", MOST),  # of the configuration that was looked at last
        # equations of contact k: from 3 k on, as many as it has (``equations.py``); rows and columns are motion
        # and forces per coordinate of the body below (3) and of that above (3), each a force at an end, a shear or
        # a couple
        *whole("unknowns", ALL),
        *whole("what", 3 * ALL),
        *fields("row column", 3 * ALL, 6),
        *fields("right force", 3 * ALL),
        *fields("moved", 3 * MOST),  # change of motion by all forces
        # of each body and all that hangs on it: inertia, and what it asks of the contact at its base where it does
        # not move; its motion per motion of the body below, and with that at rest
        *fields("inertia follows", MOST, 3, 3),
        *fields("asks still", MOST, 3),
        # all equations at once, and which they are
        *fields("light", 6),
        *fields("matrix", 3 * ALL, 3 * ALL),
        *fields("joint largest", 3 * ALL),
        *whole("place", 3 * ALL),
        # a step: start, end, stages
        *fields("q0 v0 a0 q1 v1 a1", 3 * MOST),
        *fields("kv ka", 3 * MOST, 7),
        # speeds at which open ends part at the start of a step
        *fields("early", ALL, 2),
        *whole("fails", ALL, 7),  # [contact, channel] what has become negative
        # of each interface normal and tangent of its left and its right end, and a couple: motion per coordinate
        # of the bodies below and above, and motion without forces [interface, row]
        *fields("basis", ALL, 5, 6),
        *fields("free", ALL, 4),
        # modes of the contacts whose equations are listed, -1: none
        *whole("listed", ALL),
        # search for a mode
        *whole("touching", ALL, 2),
        *whole("moves", ALL),
        # of a contact that sticks: coefficients for a shear against its slip before an impact and for one
        # along it, and the sign of that slip
        *fields("against along", ALL),
        *whole("slid", ALL),
        *fields("old_v", 3 * MOST),
        *whole("old_closed", ALL, 2),
        *whole("old_slides", ALL),
        # contact, what and how: the change that mends the worst of a mode
        *whole("flip", 3),
        # by which rule a search mends, and where in the list the modes begin that this rule has tried
        *whole("mends first"),
        *whole("count"),  # of the modes that a search has tried ...
        # ... their numbers, of contacts of bodies with each other and with walls ...
        *whole("tried", TRIES, 2),
        *fields("wrong", TRIES),  # ... and how far each is from consistent
        # laws of an impact: fraction of an end's impulse that the other end gets too, end that leaves at a given
        # speed (-1: none), and that speed
        *fields("fraction", ALL, 2),
        *whole("drive", ALL),
        *fields("depart", ALL),
        # speeds at which ends that are pushed leave, those at which they came, and impulses that walls have given
        *fields("back came hit", ALL, 2),
        *fields("hit_shear", ALL),
        *fields("zero", 3 * MOST),
        # accelerations by ties, their states, which of them fail, and how fast they lengthen as a step begins
        *fields("drift", 3 * MOST),
        *whole("taut tie_fails", MOST_TIES),
        *fields("tie_early", MOST_TIES),
        *whole("whole", ALL),  # [contact] whether it is shut whatever its force
        *whole("row_of_rest"),  # which margin of rest fails first
        # of a bilinear spring the way in which it yields, 0: none, whether that changes, and where it is at rest
        *whole("yields spring_fails"),
        *fields("plastic"),
        # coefficients of the displacement of what an isolator carries, and their number
        *fields("series", TERMS),
        *whole("terms"),
        # end that comes down while the other is closed, -1: none
        *whole("falls", MOST),
        # speed at which the other end departs: without the law, with it
        *fields("goal", MOST, 2),
        # margins of rest, linear in the two accelerations
        *fields("rest", 4 * MOST, 3),
        # ledgers [J]: of the ground, lost to friction, lost in impacts, given to ties
        *fields("work friction_loss impact_loss tied"),
        *fields("outcome", of=OUTCOME),
        # forced, resting; contact events: met within the sample, noted in all
        *whole("forced resting met noted"),
        *fields("tau"),  # part of the interval between two samples that is done
        # whether ``a`` is of another state or mode, whether ``rest`` is of this one
        *whole("is_stale knows_rest"),
        # contact events, and impulses without an approach, since time last went on
        *whole("idle jolts"),
    ]
)


def fill_geometry(p: np.void, system: System) -> None:
    """Fill geometry and masses of a column, from the ground up, into its record.

    Parameters
    ----------
    p : record ``BODY`` with gravity
    system : planar bodies on each other; its lengths are from the origins of their bases [m]
    """
    shapes, faces = system.shapes, system.faces
    p["count"], p["weight"] = system.count, p["g"] * system.mass
    p["tilt_cos"][:] = 1.0
    body = with_attributes(p)
    foot = _describe.place_lowest(body, shapes[0])
    for k in range(1, system.count):
        pair = shapes[k - 1], shapes[k]
        foot = _describe.place_above(body, k, pair, faces[k - 1], foot)


def system_record(system: System, g: float) -> np.void:
    """Return the record ``BODY`` of a planar system; a contact without friction is as rough as can be.

    Parameters
    ----------
    system : planar bodies, with what holds them
    g : acceleration of gravity [m/s²]
    """
    p: np.void = np.zeros(1, BODY)[0]
    p["g"] = g
    whole_system, system = system, with_plate(system)
    fill_geometry(p, system)
    for k, (contact, shape) in enumerate(
        zip(system.contacts, system.carried, strict=True)
    ):
        p["static"][k], p["kinetic"][k] = contact.friction or (ROUGHEST, ROUGHEST)
        for end, pivot in enumerate((-1, 1)):
            p["law"][k, end], p["number"][k, end] = after_impact(
                contact.law, shape, pivot
            )
    fill_holding(p, whole_system)
    return p


def working_memory() -> np.void:
    """Return the record ``WORK`` that the integration of a case needs."""
    work: np.void = np.zeros(1, WORK)[0]
    return work


def posed(
    p: np.void, theta: Sequence[float], omega: Sequence[float]
) -> NDArray[np.float64]:
    """Coordinates and velocities of a column each of whose bodies is turned about a corner on the body below.

    Parameters
    ----------
    p : record ``BODY`` of the column
    theta, omega : rotation [rad] and angular velocity [rad/s] of each body, clockwise; their sign sets the corner

    Returns
    -------
    x, y [m] and θ [rad] of each body, and their rates, shape (2, 3 MOST).
    """
    start = np.zeros((2, 3 * MOST))
    _describe.fill_start(with_attributes(p), theta, omega, start)
    return start
