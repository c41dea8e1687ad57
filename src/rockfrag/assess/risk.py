"""From fractions of motions and a hazard curve to a probability with an interval.

The rate of toppling is λ = ∫ P(x) |dH(x)|, with P the fraction of motions that topple the object at level x,
linear in ln x between levels, and H the annual rate at which x is exceeded, a power law: all in closed form.

All that is not known is drawn at once (:mod:`rockfrag.assess.core`). A fraction, or a probability, is the mean
over the draws; its interval holds the middle 90 % of them and the mean. ``docs/assess.md`` has the sources.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from rockfrag.assess.core.draws import MEMBERS
from rockfrag.assess.core.fractions import count_motions
from rockfrag.assess.core.prediction import Prediction, Shift, predict
from rockfrag.assess.hazard.curve import HazardCurve, rate_weights
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.base.arrays import Floats
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS

LEVEL = 0.90  # Confidence of the intervals
NONE_BELOW = 1e-3  # Fraction of motions that is none where it is a limit


def toppling_rate(
    levels: Floats, fractions: Floats, hazard: HazardCurve, shift: float = 0.0
) -> float:
    """Annual rate of toppling [1/year], of the fraction of motions at each of rising levels, shape (n,) both.

    Nothing topples below the first level, and above the last one the last fraction stays. ``shift`` is the
    logarithm of a factor on all levels: the object bears so much more.
    """
    return float(fractions @ _rate_weights(levels.tobytes(), hazard, shift))


@lru_cache(maxsize=512)
def _rate_weights(levels: bytes, hazard: HazardCurve, shift: float) -> Floats:
    """The rate of toppling where one level alone topples all, shape (levels,): rates are linear in fractions."""
    x = np.log(np.frombuffer(levels)) + shift
    # pieces end at levels of the series of levels and at points of the hazard curve, where its slope changes
    knots = np.log(hazard.levels)
    inside = knots[(knots > x[0]) & (knots < x[-1])]
    ends = np.union1d(x, inside)
    fraction = np.array([np.interp(ends, x, unit) for unit in np.eye(x.size)])
    return np.asarray(fraction @ rate_weights(hazard, np.exp(ends)))


def probability_in(rate: float, years: float) -> float:
    """Probability of one earthquake or more in some years, 1 - exp(-rate × years), in a Poisson process."""
    return float(-np.expm1(-years * rate))


@dataclass(frozen=True)
class Estimate:
    """A number with its interval."""

    value: float  # Mean over what is not known; of a level the median
    # Limits of the interval
    lower: float
    upper: float
    # Standard deviation that each source alone gives it, on the scale of :attr:`Target.scale`
    sources: Mapping[str, float]
    # The number in each draw, shape (draws,); empty where there are none
    draws: Floats = field(
        default_factory=lambda: np.zeros(0), repr=False, compare=False
    )


@dataclass(frozen=True)
class Target:
    """What is estimated from fractions of motions: a probability in some years, a fraction at a level, a level."""

    # Turns levels and fractions, shape (..., levels), into numbers, shape (...,)
    of: Callable[[Floats, Floats], Floats]
    state: str = OVERTURNS  # Name of the limit state whose fractions they are
    # Number that is shown, such as a probability of a rate
    shown: Callable[[Floats], Floats] = np.asarray
    # Scale on which sources have their parts
    scale: Callable[[Floats], Floats] = np.asarray
    is_level: bool = False  # Whether it is a level, of which more is better
    is_rate: bool = False  # Whether errors of the hazard are in it
    none_below: float = -math.inf  # Limit that is taken for 0, and 1 less it for 1

    def value(self, outcomes: ObjectOutcomes, weights: Floats | None = None) -> float:
        """The number, of fractions as counted; weights of the motions have the shape (motions,)."""
        fractions = outcomes.fractions(weights, state=self.state)
        return float(self.shown(self.of(outcomes.intensity_levels.levels, fractions)))


def risk_target(hazard: HazardCurve, years: float) -> Target:
    """The probability of toppling in some years."""

    def rate(levels: Floats, fractions: Floats) -> Floats:
        return np.asarray(fractions @ _rate_weights(levels.tobytes(), hazard, 0.0))

    return Target(
        of=rate,
        shown=lambda rates: np.asarray(-np.expm1(-years * rates)),
        scale=_log_of_rates,
        is_rate=True,
    )


def _log_of_rates(rates: Floats) -> Floats:
    """Logarithms, of no less than a thousandth of the mean: what hardly adds to it counts alike."""
    return np.log(np.maximum(rates, max(1e-3 * float(rates.mean()), 1e-300)))


def fraction_target(level: float, *, state: str = OVERTURNS) -> Target:
    """The fraction of motions that bring the object into a limit state at a level."""

    def fraction(levels: Floats, fractions: Floats) -> Floats:
        # relative to the level: where it is one of the series its logarithm is 0 to the bit
        x = np.log(levels / level)
        at = min(max(int(np.searchsorted(x, 0.0, side="right")) - 1, 0), x.size - 2)
        along = min(max(-x[at] / (x[at + 1] - x[at]), 0.0), 1.0)
        low, high = fractions[..., at], fractions[..., at + 1]
        return np.asarray(np.where(along == 0, low, low + along * (high - low)))

    return Target(of=fraction, state=state, none_below=NONE_BELOW)


def mean_fraction_target(
    level: float, spread: float, *, state: str = OVERTURNS
) -> Target:
    """The fraction of motions that bring the object into a limit state, over levels that are lognormal.

    ``spread`` is the standard deviation of ln level about that of ``level``. The fraction is linear in ln level
    between levels, and that of the nearest one beyond them, so that its mean is exact.
    """

    def fraction(levels: Floats, fractions: Floats) -> Floats:
        weights = _weights_of_normal(np.log(levels / level), spread)
        return np.asarray(fractions @ weights)

    return Target(of=fraction, state=state, none_below=NONE_BELOW)


def _weights_of_normal(x: Floats, spread: float) -> Floats:
    """Weights of rising points in the mean of what is linear between them, over a normal value about 0."""
    z = x / spread
    below = special.ndtr(z)
    # integral of the value times its density up to each point
    moment = -spread * np.exp(-0.5 * z**2) / math.sqrt(2 * math.pi)
    part, first, step = np.diff(below), np.diff(moment), np.diff(x)
    weights = np.zeros(x.size)
    weights[:-1] += (x[1:] * part - first) / step
    weights[1:] += (first - x[:-1] * part) / step
    weights[0] += below[0]
    weights[-1] += 1.0 - below[-1]
    return weights


def amplitude_target(fraction: float) -> Target:
    """The level at which a fraction of the motions topples the object; infinite where none does."""

    def level(levels: Floats, fractions: Floats) -> Floats:
        reached = fractions >= fraction
        first = reached.argmax(axis=-1)
        before = np.maximum(first - 1, 0)
        low, high = (
            np.take_along_axis(fractions, at[..., np.newaxis], -1)[..., 0]
            for at in (before, first)
        )
        x = np.log(levels)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.where(first > 0, (fraction - low) / (high - low), 0.0)
        found = np.exp(x[before] + part * (x[first] - x[before]))
        return np.where(reached.any(axis=-1), found, np.inf)

    return Target(of=level, scale=np.log, is_level=True)


def earthquake_numbers(earthquakes: NDArray[np.object_]) -> NDArray[np.intp]:
    """Number of the earthquake of each motion, in the order in which they come, shape (motions,)."""
    names = list(dict.fromkeys(earthquakes))
    place = {name: number for number, name in enumerate(names)}
    return np.array([place[name] for name in earthquakes], dtype=np.intp)


_ONE_SPREAD = (0.16, 0.84)  # Fractions one standard deviation from the median


@dataclass(frozen=True, eq=False)
class PredictedCurve:
    """A fragility in which all that is not known is."""

    levels: Floats  # Levels, rising, shape (levels,)
    fractions: Floats  # Probability of toppling, shape (levels,)
    median: float  # Level that topples half of the motions; infinite where none does
    # Standard deviations of ln capacity from record to record, and of ln median for what is not known; NaN where
    # levels do not reach so far
    of_records: float
    of_unknown: float


@dataclass(frozen=True)
class Evidence:
    """What estimates rest on."""

    outcomes: ObjectOutcomes  # Outcomes of the object
    # What each source moves at its standard deviation
    shifts: Mapping[str, Shift] = field(default_factory=dict)
    # Standard deviations of ln rate by source, such as of the hazard
    rates: Mapping[str, float] = field(default_factory=dict)
    members: int = MEMBERS  # Draws under each set of weights of the earthquakes

    @cached_property
    def prediction(self) -> Prediction:
        """Fractions of motions under each draw."""
        return self.of(self.outcomes)

    def of(self, outcomes: ObjectOutcomes) -> Prediction:
        """The same of other outcomes, of which as much is not known."""
        levels = outcomes.intensity_levels
        counts = count_motions(
            levels.levels,
            outcomes.overturned,
            levels.allowed,
            outcomes.lifts_from(),
            earthquake_numbers(outcomes.earthquakes),
        )
        unknown = {**self.shifts, **{name: Shift(0.0, 0.0) for name in self.rates}}
        return predict(levels.levels, counts, unknown, members=self.members)

    def drawn(self, target: Target, prediction: Prediction | None = None) -> Floats:
        """What is estimated, in each draw, before it is shown, shape (draws,)."""
        found = self.prediction if prediction is None else prediction
        fractions = found.rocking if target.state == ROCKS else found.toppling
        values = target.of(found.levels, fractions)
        if target.is_rate:
            for name, spread in self.rates.items():
                # a curve is a mean, and stays it
                values = values * np.exp(spread * found.sources[name] - spread**2 / 2)
        return values

    def mean(self, target: Target, outcomes: ObjectOutcomes) -> float:
        """The number for other outcomes, the mean over what is not known; of a level the median."""
        return _middle(target, self.of(outcomes))

    def curve(self) -> "PredictedCurve":
        """The fraction at each level, the mean over what is not known, with its median and spreads."""
        levels = self.prediction.levels
        half = self.estimate(amplitude_target(0.5))
        known = np.log(half.draws[np.isfinite(half.draws)])
        ends = [amplitude_target(part).value(self.outcomes) for part in _ONE_SPREAD]
        return PredictedCurve(
            levels=levels,
            fractions=self.prediction.toppling.mean(axis=0),
            median=half.value,
            of_records=math.log(ends[1] / ends[0]) / 2
            if math.isfinite(ends[1])
            else math.nan,
            of_unknown=float(known.std())
            if known.size > half.draws.size / 2
            else math.nan,
        )

    def estimate(self, target: Target) -> Estimate:
        """Estimate with an interval, which holds the middle of the draws and the number itself."""
        values = self.drawn(target)
        shown = target.shown(values)
        value = _middle(target, self.prediction)
        ordered = np.sort(shown)
        aside = int((1 - LEVEL) / 2 * ordered.size)
        lower, upper = float(ordered[aside]), float(ordered[-1 - aside])
        if self.prediction.draws.weights.shape[1] < 3 and not target.is_level:
            # one earthquake says nothing of others
            lower, upper = 0.0, 1.0
        # of fractions less than one in a thousand is none
        lower = 0.0 if lower < target.none_below else lower
        upper = 1.0 if upper > 1 - target.none_below else upper
        limits = min(lower, value), max(upper, value)
        return Estimate(value, *limits, self._sources(target, values), shown)

    def _sources(self, target: Target, values: Floats) -> dict[str, float]:
        last = float(self.prediction.levels[-1])
        scaled = target.scale(np.minimum(values, last) if target.is_level else values)
        spread = float(scaled.std())
        parts = self.prediction.parts(scaled)
        return {name: spread * math.sqrt(part) for name, part in parts.items()}


def _middle(target: Target, prediction: Prediction) -> float:
    """Mean over the draws; of a level the median."""
    fractions = prediction.rocking if target.state == ROCKS else prediction.toppling
    if target.is_level:
        values = target.of(prediction.levels, fractions)
        return float(np.quantile(values, 0.5, method="lower"))
    # fractions and rates are linear in fractions
    return float(target.shown(target.of(prediction.levels, fractions.mean(axis=0))))


def after_uplift(spread: float) -> Shift:
    """What a source moves that acts on what was lifted, by its standard deviation of ln level [-]."""
    return Shift(0.0, spread)


LEAST_SPAN = (
    0.05  # Of fractions of motions over all levels, below which they say nothing
)


def shift_of(lower: ObjectOutcomes, upper: ObjectOutcomes) -> Shift:
    """What a property moves at its standard deviation, by outcomes with it on both sides.

    Levels of uplift move by the mean over the motions; those of toppling by the area between both fractions over
    ln level, which of a curve that is moved is the move times its height.
    """
    sides = lower, upper
    lifts = (_mean_log(upper.lifts_from()) - _mean_log(lower.lifts_from())) / 2
    low, high = (side.fractions() for side in sides)
    middle = (low + high) / 2
    span = float(middle.max() - middle[0])
    if span < LEAST_SPAN:
        return Shift(lifts, lifts)
    x = np.log(lower.intensity_levels.levels)
    return Shift(lifts, float(np.trapezoid(low - high, x)) / 2 / span)


def _mean_log(levels: Floats) -> float:
    known = levels[np.isfinite(levels)]
    return float(np.log(known).mean()) if known.size else 0.0
