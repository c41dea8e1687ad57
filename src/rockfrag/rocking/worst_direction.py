"""The direction of a horizontal motion that overturns a body with the least shaking."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.keywords import named_keywords
from rockfrag.motions.rotation import common_time, rotate
from rockfrag.records.motion import Motion
from rockfrag.rocking.thresholds import find_thresholds
from rockfrag.short_repr import short_repr
from rockfrag.system.blocks import Body
from rockfrag.units import GRAVITY

DIRECTIONS_DEG = tuple(range(0, 360, 10))
"""Directions that are tried [degrees]: all around, for opposite ones are not alike to a body that leans."""

TOLERANCE, NARROWEST = 0.005, 0.05  # of thresholds, and narrowest resurrection found, in scale


@dataclass(frozen=True)
class WorstDirection:
    """How a body's first overturning depends on the direction of the motion."""

    # angle from the first component towards the second that overturns the body with the least scale; NaN if none
    # does
    angle_deg: float
    # the motion in that direction, unscaled; in the first component's direction if none overturns
    motion: Motion
    # a row per direction: ``angle_deg``, ``first_overturning`` (least scale, NaN if the body stands) and
    # ``peak_g`` of the unscaled motion
    table: pd.DataFrame

    __repr__ = short_repr


@named_keywords
def worst_direction(
    body: Body,
    first: Motion,
    second: Motion,
    highest: float,
    *,
    directions_deg: Sequence[float] = DIRECTIONS_DEG,
) -> WorstDirection:
    """Find the direction in which two components overturn a body that rocks in one plane.

    The record is scaled as a whole: its components keep their ratio. The answer is of a body in one plane that
    has the same width in every direction. It is no bound for a body in space, which meets both components at
    once, rocks on corners, rolls on a round edge and loses other amounts of energy in impacts.

    Parameters
    ----------
    body : the body; its plane is turned into each direction
    first, second : perpendicular components of one record; they are brought to common times
    highest : largest scale that is tried [-]
    directions_deg : angles from the first component towards the second [degrees]

    Returns
    -------
    The :class:`WorstDirection`: ``angle_deg``, the ``motion`` in it, and a ``table`` of a row per direction.
    """
    if not len(directions_deg):
        raise InputError("worst_direction: directions_deg is empty; give at least one angle.")
    common, other = common_time([first, second])
    motions = [rotate(common, other, angle) for angle in directions_deg]
    search = body, motions, None, highest
    found = find_thresholds(*search, tolerance=TOLERANCE, narrowest_resurrection=NARROWEST).table
    table = pd.DataFrame(
        {
            "angle_deg": [float(angle) for angle in directions_deg],
            "first_overturning": found.sort_values("motion")["first_overturning"].to_numpy(),
            "peak_g": [motion.pga / GRAVITY for motion in motions],
        }
    )
    scales = table["first_overturning"]
    if scales.isna().all():
        return WorstDirection(float("nan"), motions[0], table)
    worst = int(np.nanargmin(scales.to_numpy()))
    return WorstDirection(float(table["angle_deg"][worst]), motions[worst], table)
