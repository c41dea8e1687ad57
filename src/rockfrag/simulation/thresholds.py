"""Overturning thresholds to a tolerance, without a fine grid of amplitudes.

More shaking does not always mean overturning: above the first overturning amplitude there can be windows
in which the body survives again (``docs/derivation.md``).  A coarse grid finds every window that is at
least as wide as its spacing, and bisection puts both ends of what it finds to a tolerance.

In: bodies, motions, the highest scale. Out: a table of scales and of peaks [g]. Theory: ``docs/definitions.md``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Unpack

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number
from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.base.units import GRAVITY
from rockfrag.motions.rotation import common_time, rotate
from rockfrag.records.motion import Motion
from rockfrag.simulation.ensemble import Options, overturned_cases, prepared, shaken
from rockfrag.simulation.inputs import MotionLike, SystemsInput
from rockfrag.system.blocks import Body

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_GRID_CASES = 5_000_000


@dataclass(frozen=True)
class Thresholds:
    """Overturning thresholds of bodies under motions.

    Attributes
    ----------
    table : a row per body and motion
        ``body``, ``motion`` (positions in the lists given), ``body_name``, ``motion_name`` (empty where they have
        none), ``first_overturning`` (least scale found that
        overturns), ``always_overturning`` (from here to the highest scale every outcome found is overturning),
        both also as peak accelerations ``first_overturning_pga_g`` and ``always_overturning_pga_g``, and
        ``resurrections``, the number of structural resurrections above the first overturning.  NaN if the body
        survives all scales, or for ``always_overturning`` if it survives the highest.
    resurrections : a row per structural resurrection: ``body``, ``motion``, ``lower``, ``upper``
        The outermost scales found to survive; ``upper`` is the highest scale for a window still open there.
    narrowest_resurrection : spacing of the grid
        A window of survival or of overturning at least this wide contains a point of the grid and has been found;
        a narrower one can be missed.
    tolerance : within which the outcome changes
        Below ``first_overturning`` and ``always_overturning``, and outside each window.
    """

    table: pd.DataFrame
    resurrections: pd.DataFrame
    narrowest_resurrection: float
    tolerance: float
    highest: float = math.nan  # largest scale that was looked at

    __repr__ = short_repr

    def plot(self, title: str = "") -> Figure:
        """Draw from which peak on each motion overturns each body, and where the body is survived again.

        Parameters
        ----------
        title : heading of the figure

        Returns
        -------
        matplotlib.figure.Figure
            A row a motion and body: a bar from the first overturning on, gaps where stronger shaking is survived
            [g]; rows without a bar survive all scales.
        """
        # matplotlib is loaded only by those who draw
        from rockfrag.simulation.figures import thresholds_figure

        return thresholds_figure(self, title)


@named_keywords
def find_thresholds(
    bodies: SystemsInput,
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None = None,
    *,
    highest: float,
    tolerance: float,
    narrowest_resurrection: float,
    **options: Unpack[Options],
) -> Thresholds:
    """Find first overturning, structural resurrections and always-overturning amplitude of body × motion.

    Parameters
    ----------
    bodies, motions, dt : as in :func:`overturns`
    highest : largest scale on the accelerations to look at; motions with a peak of 1 g make scales PGAs in g
    tolerance : width to which every change of outcome is bracketed, in scale
    narrowest_resurrection
        Width of the narrowest window that must not be missed, in scale: the spacing of the grid that is
        looked at first.
    **options : as in :func:`rockfrag.simulation.overturns`, but for ``forces``

    Returns
    -------
    The :class:`Thresholds`: a table with a row per body and motion, and one of the structural resurrections.

    Examples
    --------
    A motion with a peak of 1 m/s² makes scales accelerations:

    >>> from rockfrag import Block, find_thresholds
    >>> from rockfrag.motions import one_sine
    >>> motion = one_sine(1.0, period=1.0)
    >>> upper = Block(width=0.3, height=1.2, mass=180.0)
    >>> found = find_thresholds(upper, motion, highest=8.0, tolerance=0.01, narrowest_resurrection=0.1)
    >>> found.table["first_overturning"].round(2).tolist()
    [2.95]
    """
    positive_number("tolerance", tolerance)
    intervals = _intervals(highest, narrowest_resurrection)
    cases = prepared(bodies, motions, dt, (highest,), **options)
    if len(cases.systems) * len(cases.motions) * intervals > MOST_GRID_CASES:
        raise InputError(
            f"narrowest_resurrection: {narrowest_resurrection} needs a grid of more than {MOST_GRID_CASES} cases; "
            "give a wider one, a lower highest scale, or fewer bodies at a time."
        )
    grid = np.linspace(0.0, highest, intervals + 1)
    # a copy of the broadcast grid would run in columns, for which kernels are compiled anew
    factors = np.tile(grid, (len(cases.motions), 1))
    fallen = shaken(replace(cases, scales=factors)).overturned
    # each change of outcome between neighbours of the grid, bisected
    body, motion, left = np.nonzero(fallen[..., 1:] != fallen[..., :-1])
    low, high = grid[left], grid[left + 1]
    falls = fallen[body, motion, left + 1]
    halvings = math.ceil(math.log2(highest / intervals / tolerance) - 1e-9)
    for _ in range(max(0, halvings)):
        middle = 0.5 * (low + high)
        above = overturned_cases(cases, body, motion, middle) == falls
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    table, resurrections = [], []
    for i in range(len(cases.systems)):
        for j, shaking in enumerate(cases.motions):
            mine = (body == i) & (motion == j)
            row, survived = _read(low[mine], high[mine], falls[mine], highest)
            peak = shaking.x.pga / cases.request.g
            names = cases.systems[i].name, shaking.name
            table.append(
                (i, j, *names, *row, *(peak * scale for scale in row), len(survived))
            )
            resurrections += [(i, j, lower, upper) for lower, upper in survived]
    return Thresholds(
        table=pd.DataFrame(
            table,
            columns=[
                "body", "motion", "body_name", "motion_name", "first_overturning", "always_overturning",
                "first_overturning_pga_g", "always_overturning_pga_g", "resurrections",
            ],
        ),
        resurrections=pd.DataFrame(resurrections, columns=["body", "motion", "lower", "upper"]).astype(
            {"body": np.int64, "motion": np.int64, "lower": np.float64, "upper": np.float64}
        ),
        narrowest_resurrection=highest / intervals,
        tolerance=tolerance,
        highest=highest,
    )  # fmt: skip


def _intervals(highest: float, narrowest: float) -> int:
    """Number of intervals of a grid up to the highest scale that are no wider than the narrowest resurrection."""
    positive_number("highest", highest)
    positive_number("narrowest_resurrection", narrowest)
    if narrowest > highest:
        raise InputError(
            f"narrowest_resurrection: {narrowest} is more than the highest scale, {highest}."
        )
    return math.ceil(highest / narrowest - 1e-9)


def _read(
    low: Floats, high: Floats, falls: NDArray[np.bool_], highest: float
) -> tuple[tuple[float, float], list[tuple[float, float]]]:
    """Read thresholds and resurrections off changes between falling and standing; the first one is a fall.

    Parameters
    ----------
    low, high : scales between which each change lies, rising, shape (changes,)
    falls : whether the body falls beyond it, and stood below
    highest : scale up to which it was tried

    Returns
    -------
    First and always-overturning scale, NaN where there is none; ends of the ranges that it survives in between.
    """
    if not falls.size:
        return (math.nan, math.nan), []
    starts, ends = high[~falls], low[falls][1:]
    always = float(high[-1]) if falls[-1] else math.nan
    if not falls[-1]:
        ends = np.append(ends, highest)
    resurrections = list(zip(starts.tolist(), ends.tolist(), strict=True))
    return (float(high[0]), always), resurrections


# --------------------------------------------------------------------------- directions

DIRECTIONS_DEG = tuple(range(0, 360, 10))
"""Directions that are tried [degrees]: all around, for opposite ones are not alike to a body that leans."""

# of thresholds, and narrowest resurrection found, in scale
TOLERANCE, NARROWEST = 0.005, 0.05


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
        raise InputError(
            "worst_direction: directions_deg is empty; give at least one angle."
        )
    common, other = common_time([first, second])
    motions = [rotate(common, other, angle) for angle in directions_deg]
    found = find_thresholds(
        body,
        motions,
        highest=highest,
        tolerance=TOLERANCE,
        narrowest_resurrection=NARROWEST,
    ).table
    table = pd.DataFrame(
        {
            "angle_deg": [float(angle) for angle in directions_deg],
            "first_overturning": found["first_overturning"],
            "peak_g": [motion.pga / GRAVITY for motion in motions],
        }
    )
    scales = table["first_overturning"]
    if scales.isna().all():
        return WorstDirection(math.nan, motions[0], table)
    worst = int(np.nanargmin(scales.to_numpy()))
    return WorstDirection(float(table["angle_deg"][worst]), motions[worst], table)
