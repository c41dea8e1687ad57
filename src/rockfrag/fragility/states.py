"""Three states of a free-standing body: no rocking, safe rocking, overturned."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from rockfrag.errors import InputError
from rockfrag.fragility.censored import Brackets
from rockfrag.fragility.estimators import Fragility, fragility_of, fragility_of_brackets
from rockfrag.fragility.observations import (
    labels,
    name_and_unit,
    numbers,
    observations_from_table,
    positive,
    read_observations,
)
from rockfrag.short_repr import short_repr


def fit_uplift(
    motions: pd.DataFrame,
    im: str,
    *,
    motion: str = "motion",
    earthquake: str | None = "earthquake",
    level: float = 0.90,
) -> Fragility:
    """Curve of P(rock | IM) from motions scaled to the peak acceleration at which rocking starts.

    That peak is exact, so each motion gives its measure at uplift exactly; in the peak acceleration
    itself the curve is a step, given as a β of next to nothing.

    Parameters
    ----------
    motions
        One row per motion, scaled to the threshold.
    im
        Column of the measure at that scale.
    motion, earthquake, level
        As of :func:`rockfrag.fragility.estimators.fit_step_tests`.
    """
    at = positive(motions, im)
    names = labels(motions, motion, "table")
    earthquakes = names if earthquake is None else labels(motions, earthquake, "table")
    return fragility_of_brackets(Brackets(at, at, names, earthquakes, *name_and_unit(im)), level)


@dataclass(frozen=True)
class ThreeStates:
    """P(rock | IM) and P(overturn | rock, IM).

    Attributes
    ----------
    threshold_g
        Peak acceleration above which the body rocks [g], exact (Kirkpatrick, 1927: a > (b/h) g).
    rock
        Curve of P(rock | IM); None where the measure is the peak acceleration itself, for which
        P(rock) steps from 0 to 1 at the threshold.
    overturn
        Curve of P(overturn | rock, IM), fitted to the tests that rocked.
    n, n_rocked, n_overturned
        Numbers of tests.
    """

    threshold_g: float
    rock: Fragility | None
    overturn: Fragility
    n: int
    n_rocked: int
    n_overturned: int

    __repr__ = short_repr

    def probabilities(self, im: ArrayLike) -> pd.DataFrame:
        """Return ``im``, ``no_rocking``, ``safe_rocking`` and ``overturned``, which sum to one."""
        values = np.atleast_1d(np.asarray(im, dtype=np.float64))
        if self.rock is None:
            rocks = (values > self.threshold_g).astype(np.float64)
        else:
            rocks = self.rock.fit.probability(values)
        falls = np.where(rocks > 0, rocks * self.overturn.fit.probability(values), 0.0)
        return pd.DataFrame(
            {
                "im": values,
                "no_rocking": 1.0 - rocks,
                "safe_rocking": rocks - falls,
                "overturned": falls,
            }
        )


def fit_three_states(
    table: pd.DataFrame,
    threshold_g: float,
    im: str = "amplitude_g",
    *,
    acceleration: str = "amplitude_g",
    motion: str | None = "motion",
    earthquake: str | None = None,
    level: float = 0.90,
) -> ThreeStates:
    """Fit the three states to tests with known peak acceleration and outcome.

    Parameters
    ----------
    table
        One row per test.
    threshold_g
        Peak acceleration at which rocking starts [g]; (b/h) for a block.
    im
        Column of the intensity measure of the curves.
    acceleration
        Column of the peak acceleration of the test [g].
    motion, earthquake, level
        As of :func:`rockfrag.fragility.fit_cloud`.

    Returns
    -------
    The :class:`ThreeStates`.

    Raises
    ------
    InputError
        If a test overturned without passing the threshold, or none passed it.
    """
    peak = positive(table, acceleration)
    if not threshold_g > 0:
        raise InputError(f"threshold_g: must be above zero, got {threshold_g:g}.")
    rocked = peak > threshold_g
    fell = read_observations(table, "overturned") == 1
    bad = np.flatnonzero(fell & ~rocked)
    if bad.size:
        raise InputError(
            f"table, row {bad[0] + 1}, column {acceleration!r}: overturned at {peak[bad[0]]:g} g, "
            f"below the {threshold_g:g} g at which rocking starts; correct the threshold or the "
            "row."
        )
    if not rocked.any():
        raise InputError(
            f"table, column {acceleration!r}: no test passed {threshold_g:g} g, so nothing "
            "rocked; give stronger tests."
        )
    overturn = fragility_of(
        observations_from_table(table[rocked], im, motion=motion, earthquake=earthquake),
        level=level,
    )
    rock = None
    if not np.array_equal(numbers(table, im), peak):
        with_rock = table.assign(overturned=rocked)
        rock = fragility_of(
            observations_from_table(with_rock, im, motion=motion, earthquake=earthquake),
            level=level,
        )
    return ThreeStates(
        float(threshold_g), rock, overturn, len(table), int(rocked.sum()), int(fell.sum())
    )
