"""All that is not known of an object drawn at once: fractions of motions at each level under each draw."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rockfrag.assess.core.draws import MEMBERS, Draws, make_draws
from rockfrag.assess.core.fractions import Counts, draw_fractions
from rockfrag.assess.core.parts import (
    means_by_source,
    part_of_earthquakes,
    part_of_source,
)
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
    sources : standard normal values of each source in the draws, shape (draws,) each
    draws : the draws, with the weights of earthquakes
    toppling, rocking : fraction of motions that topple and that rock it, shape (draws, levels)
    """

    levels: Floats
    sources: Mapping[str, Floats]
    draws: Draws
    toppling: Floats
    rocking: Floats

    def parts(self, values: Floats) -> dict[str, float]:
        """Part of each source and of the motions in the variance of values of the draws [-], shape (draws,)."""
        if not np.isfinite(values).all() or not values.var() > 0:
            return {}
        found = {MOTIONS: part_of_earthquakes(values, self.draws)}
        return found | {
            name: part_of_source(values, normals)
            for name, normals in self.sources.items()
        }

    def effect(self, values: Floats, source: str) -> tuple[float, float]:
        """Mean of values of the draws with a source one standard deviation low and high."""
        means = means_by_source(values, self.sources[source])
        low, high = (means[at - 1 : at + 2].mean() for at in _ONE_AWAY)
        return float(low), float(high)


# Bins about one standard deviation to both sides: 16 and 84 % of 32
_ONE_AWAY = (5, 26)


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
    moved = np.array(list(shifts.values())).reshape(len(shifts), 2)
    lifts, topples = np.ascontiguousarray((draws.sources @ moved).T)
    toppling, rocking = draw_fractions(counts, draws.weights, lifts, topples)
    sources = dict(zip(shifts, draws.sources.T, strict=True))
    return Prediction(levels, sources, draws, toppling, rocking)
