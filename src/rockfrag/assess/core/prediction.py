"""All that is not known of an object drawn at once: fractions of motions at each level under each draw.

In: outcomes of an object and its sources of error. Out: fractions, (draws, levels) [-].
Theory: ``docs/assess.md``, "How sure".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rockfrag.assess.core.draws import MEMBERS, Draws, make_draws
from rockfrag.assess.core.fractions import Counts, draw_fractions
from rockfrag.base.arrays import Floats

MOTIONS = "motions"  # The source that the earthquakes are


class Shift(NamedTuple):
    """What a source moves at its standard deviation, as shifts of ln level [-].

    Attributes
    ----------
    lifts : the level at which motions lift the object
    topples : the level at which they topple it
    """

    lifts: float
    topples: float


@dataclass(frozen=True, eq=False)
class Prediction:
    """Fractions of motions under each draw.

    Attributes
    ----------
    levels : of shaking, rising, shape (levels,)
    sources : names of the sources, in the order of the draws
    draws : the draws, with the weights of earthquakes
    toppling, rocking : fraction of motions that topple and that rock it, shape (draws, levels)
    """

    levels: Floats
    sources: tuple[str, ...]
    draws: Draws
    toppling: Floats
    rocking: Floats


def predict(
    levels: Floats,
    counts: Counts,
    shifts: Mapping[str, Shift],
    *,
    members: int = MEMBERS,
) -> Prediction:
    """Draw all that is not known.

    Parameters
    ----------
    levels : of shaking, rising, shape (levels,)
    counts : what motions do to the object there
    shifts : what each source moves
    members : draws of the sources under each set of weights of the earthquakes

    Returns
    -------
    Fractions of motions under each draw. Shifts of sources add up.
    """
    draws = make_draws(len(shifts), counts.motions.size, members)
    moved = np.array(list(shifts.values()), dtype=np.float64).reshape(len(shifts), 2)
    found = draw_fractions(counts, draws.weights, draws.sources, moved)
    return Prediction(levels, tuple(shifts), draws, *found)
