"""Sizes, densities and accelerations that things have, and sentences on those that look like a mistake of unit.

Bounds are generous: what lies beyond is no object, motion or building that anybody has met.
"""

import math

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY

DENSITIES = (20.0, 22_600.0)  # of a whole object [kg/m³]: from packaging foam to osmium
AIR = 1.2  # density of air [kg/m³]
STONE = 2500.0  # density of stone [kg/m³], where nobody says how heavy an object is
MEAN_DENSITIES = (100.0, DENSITIES[1])
"""Least and largest density where the volume is known and no depth is guessed: hollow wood, and osmium [kg/m³]."""

DEPTHS = (0.1, 3.0)
"""Least depth of an object over its width, largest over the longer of width and height: a panel rocking in its
strong direction, and a long shelf seen from its end."""

# radius of gyration of a body over the diagonal of width and height [-]
GYRATIONS = (1e-3, 30.0)
LARGEST_SIZE = 20.0  # free-standing objects are hardly taller [m]
# no accelerometer has recorded more [m/s²]; floors hardly feel more
LARGEST_PEAK = 50.0
# peaks of more than this many g are rare: a number above it is hardly one of g
LARGEST_IN_G = 2.0
# of a floor of a building [kg]: a wooden attic, more than any palace's
FLOOR_MASSES = (1e3, 1e9)
# of a storey [m]: a crawl space, and the nave of a cathedral
STOREY_HEIGHTS = (1.0, 30.0)
FIRST_PERIODS = (0.01, 20.0)  # shortest and longest first period of a building [s]
# sampling interval [s]; recorders take at most some thousand samples a second
SHORTEST_STEP = 1e-5
# sampling interval [s] of a record; slower channels are not of strong motion
LONGEST_STEP = 1.0
# largest acceleration of gravity that is no mistake of unit [m/s²]
LARGEST_GRAVITY = 100.0
LEAST_PEAK = 0.05  # a motion whose peak is below this [m/s²] moves nothing that stands


def check_density(width: float, height: float, mass: float) -> None:
    """Refuse a block [m, m, kg] that no solid can have at any depth within ``DEPTHS``, which is not known.

    Parameters
    ----------
    width, height : of the block [m]
    mass : of the block [kg]
    """
    thin, thick = DEPTHS[0] * width, DEPTHS[1] * max(width, height)

    def density(depth: float) -> float:
        """Density of the block if it is so deep [kg/m³]."""
        # the volume of a size of 1e-300 m is 0 in numbers
        volume = width * height * depth
        return mass / volume if volume else math.inf

    most, least = density(thin), density(thick)
    if most < DENSITIES[0]:
        wrong = (
            f"at most {most:.3g} kg/m³ at a depth of {thin:.3g} m, less than any solid"
        )
    elif least > DENSITIES[1]:
        wrong = f"at least {least:.3g} kg/m³ at a depth of {thick:.3g} m, more than any solid"
    else:
        return
    raise InputError(
        f"a block {width:g} m wide, {height:g} m high and of {mass:g} kg would have a density of "
        f"{wrong}; check the units."
    )


def block_warning(width: float, height: float, mass: float, inertia: float) -> str:
    """Say that a block is a giant lighter than air, or its inertia [kg m²] that of another body, or nothing.

    Parameters
    ----------
    width, height : of the block [m]
    mass : of the block [kg]
    inertia : about its centre of gravity [kg m²]

    Returns
    -------
    A sentence without a full stop, empty if nothing is odd.
    """
    # the depth is not known; the thinnest that is admitted
    densest = mass / width / width / height / DEPTHS[0]
    if max(width, height) > LARGEST_SIZE and densest < AIR:
        size = f"{width:g} m wide, {height:g} m high and of {mass:g} kg"
        return f"{size} it would be lighter than air; give metres and kilograms"
    gyration = math.sqrt(inertia) / math.sqrt(mass) / math.hypot(width, height)
    if GYRATIONS[0] <= gyration <= GYRATIONS[1]:
        return ""
    return (
        f"an inertia of {inertia:g} kg m² for {mass:g} kg has a radius of gyration of {gyration:.2g} times the "
        "diagonal, where a uniform block has 0.29; give kg m² about the centre of gravity"
    )


def size_warning(width: float, height: float) -> str:
    """Say that a block is unusually large, or return an empty text.

    Parameters
    ----------
    width, height : of the block [m]

    Returns
    -------
    A sentence without a full stop, empty if nothing is odd.
    """
    if max(width, height) <= LARGEST_SIZE:
        return ""
    return f"a block {width:g} m wide and {height:g} m high is unusually large; check the unit"


def peak_warning(peak: float, least_uplift: float | None = None) -> str:
    """Say that a peak acceleration [m/s²] looks like one in g or cm/s², or return an empty text.

    A motion that falls short of the least acceleration at which any of the bodies starts to rock, and would not
    if it were in g, is doubtful too.

    Parameters
    ----------
    peak : largest acceleration of the motion [m/s²]
    least_uplift : acceleration at which the first body starts to rock [m/s²]; None if it is not known

    Returns
    -------
    A sentence without a full stop, empty if nothing is odd.
    """
    if peak > LARGEST_PEAK:
        return (
            f"the peak acceleration is {peak:.3g} m/s², {peak / GRAVITY:.3g} g; if the motion "
            "is in cm/s², divide it by 100"
        )
    doubtful = (
        least_uplift is not None
        and peak <= LARGEST_IN_G
        and peak < least_uplift <= peak * GRAVITY
    )
    if 0 < peak < LEAST_PEAK or doubtful:
        short = (
            f", less than the {least_uplift:.3g} m/s² that start rocking"
            if doubtful
            else ""
        )
        found = f"the peak acceleration is {peak:.3g} m/s²{short}"
        return f"{found}; if the motion is in g, multiply it by {GRAVITY:g}"
    return ""
