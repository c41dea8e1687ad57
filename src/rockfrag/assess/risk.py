"""From fractions of motions and a hazard curve to a probability with an interval.

The rate of toppling is λ = ∫ P(x) |dH(x)|, with P the fraction of motions that topple the object at level x,
linear in ln x between levels, and H the annual rate at which x is exceeded, a power law: all in closed form.

All that is not known is drawn at once (:mod:`rockfrag.assess.core`, which computes; this module holds it in
records). A fraction, or a probability, is the mean over the draws; its interval holds the middle 90 % of them and
the mean. ``docs/assess.md`` has the sources.

In: fractions, (draws, levels), and a hazard curve. Out: rates [1/a] and probabilities [-] with limits.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from scipy import special

from rockfrag.assess.core import estimates
from rockfrag.assess.core.draws import MEMBERS
from rockfrag.assess.core.fractions import count_motions, fill_shift
from rockfrag.assess.core.hazards import fill_rate_weights
from rockfrag.assess.core.prediction import MOTIONS, Prediction, Shift, predict
from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.outcomes import ObjectOutcomes, earthquake_numbers
from rockfrag.base.arrays import Floats
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS


def toppling_rate(
    levels: Floats, fractions: Floats, hazard: HazardCurve, shift: float = 0.0
) -> float:
    """Annual rate of toppling of fractions of motions at levels.

    Parameters
    ----------
    levels : of shaking, rising, shape (n,)
    fractions : of the motions that topple the object there, shape (n,)
    hazard : hazard curve of the site
    shift : logarithm of a factor on all levels: the object bears so much more

    Returns
    -------
    The rate [1/year]. Nothing topples below the first level, and above the last one the last fraction stays.
    """
    weights, found = _rate_weights(levels.tobytes(), hazard, shift), np.zeros(1)
    rows = np.ascontiguousarray(fractions, dtype=np.float64)[np.newaxis]
    return float(estimates.fill_sums(rows, weights, found))


@lru_cache(maxsize=512)
def _rate_weights(levels: bytes, hazard: HazardCurve, shift: float = 0.0) -> Floats:
    """The rate of toppling where one level alone topples all, shape (levels,)."""
    x = np.frombuffer(levels).copy()
    weights = np.zeros(x.size)
    fill_rate_weights(x, shift, hazard.levels, hazard.rates, weights)
    return weights


def probability_in(rate: float, years: float) -> float:
    """Probability of one earthquake or more in some years, in a Poisson process.

    Parameters
    ----------
    rate : mean annual rate [1/year]
    years : time [year]

    Returns
    -------
    1 - exp(-rate × years) [-].
    """
    return float(-np.expm1(-years * rate))


@dataclass(frozen=True)
class Estimate:
    """A number with its interval."""

    value: float  # Mean over what is not known; of a level the median
    # Limits of the interval
    lower: float
    upper: float
    # Standard deviation that each source alone gives it; of levels and rates that of the logarithm
    sources: Mapping[str, float]
    # The number in each draw, shape (draws,); empty where there are none
    draws: Floats = field(
        default_factory=lambda: np.zeros(0), repr=False, compare=False
    )


@dataclass(frozen=True)
class Target:
    """What is estimated from fractions of motions: a probability in some years, a fraction at a level, a level."""

    kind: int  # ``FRACTION``, ``RATE`` or ``LEVEL`` of :mod:`rockfrag.assess.core.estimates`
    state: str = OVERTURNS  # Name of the limit state whose fractions they are
    level: float = math.nan  # Level of a fraction
    spread: float = 0.0  # Standard deviation of its logarithm [-]
    part: float = math.nan  # Fraction of the motions that a level topples
    hazard: HazardCurve | None = None  # Hazard curve of a probability
    years: float = 1.0  # Time of a probability [year]

    @property
    def is_level(self) -> bool:
        """Whether it is a level, of which more is better."""
        return self.kind == estimates.LEVEL

    @property
    def is_rate(self) -> bool:
        """Whether errors of the hazard are in it."""
        return self.kind == estimates.RATE

    def of(self, levels: Floats, fractions: Floats) -> Floats:
        """The numbers of rows of fractions at levels, before they are shown: rates, of probabilities.

        Parameters
        ----------
        levels : rising, shape (levels,)
        fractions : shape (…, levels)

        Returns
        -------
        The numbers, shape (…).
        """
        return self.with_mean(levels, fractions)[0]

    def with_mean(self, levels: Floats, fractions: Floats) -> tuple[Floats, float]:
        """The numbers as of :meth:`of`, and the mean of all rows; of levels NaN."""
        rows = np.atleast_2d(np.ascontiguousarray(fractions, dtype=np.float64))
        values, middle = np.zeros(len(rows)), math.nan
        if self.is_level:
            estimates.fill_crossings(rows, levels, self.part, values)
        else:
            middle = estimates.fill_sums(rows, self._weights(levels), values)
        return values.reshape(np.shape(fractions)[:-1]), float(middle)

    def _weights(self, levels: Floats) -> Floats:
        """Weights with which fractions at the levels add up to the number, shape (levels,)."""
        if self.hazard is not None:
            return _rate_weights(levels.tobytes(), self.hazard)
        if self.spread > 0:
            return _weights_of_normal(np.log(levels / self.level), self.spread)
        weights = np.zeros(levels.size)
        estimates.fill_place(levels, self.level, weights)
        return weights

    def shown(self, values: Floats) -> Floats:
        """Numbers as they are shown: probabilities, of rates."""
        found = np.zeros(np.size(values))
        given = np.ascontiguousarray(values, dtype=np.float64).reshape(-1)
        estimates.fill_shown(self.kind, self.years, given, found)
        return found.reshape(np.shape(values))

    def value(self, outcomes: ObjectOutcomes, weights: Floats | None = None) -> float:
        """The number, of fractions as counted; weights of the motions have the shape (motions,)."""
        fractions = outcomes.fractions(weights, state=self.state)
        return float(self.shown(self.of(outcomes.intensity_levels.levels, fractions)))


def risk_target(hazard: HazardCurve, years: float) -> Target:
    """The probability of toppling in some years."""
    return Target(estimates.RATE, hazard=hazard, years=float(years))


def fraction_target(
    level: float, *, state: str = OVERTURNS, spread: float = 0.0
) -> Target:
    """The fraction of motions that bring the object into a limit state at a level.

    ``spread`` is the standard deviation of ln level where it is lognormal; the fraction is then the mean over it,
    exactly, as it is linear in ln level between levels and that of the nearest one beyond them.
    """
    level, spread = float(level), float(spread)
    return Target(estimates.FRACTION, state=state, level=level, spread=spread)


def _weights_of_normal(x: Floats, spread: float) -> Floats:
    """Weights of rising points in the mean of what is linear between them, over a normal value about 0.

    Parameters
    ----------
    x : the points, shape (n,); beyond them the value of the nearest one stays
    spread : standard deviation of the normal value

    Returns
    -------
    The weights, of sum 1, shape (n,).
    """
    z = x / spread
    # probability up to each point
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
    return Target(estimates.LEVEL, part=fraction)


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
class Drawn:
    """What is estimated, in each draw."""

    target: Target
    prediction: Prediction
    middle: float  # Mean without errors of the rate
    values: Floats  # Before it is shown, shape (draws,)

    @property
    def shown(self) -> Floats:
        """The numbers as they are shown, shape (draws,): of an annual rate the probability in the years [-]."""
        return self.target.shown(self.values)

    @property
    def value(self) -> float:
        """Mean over the draws, as it is shown; of a level the median."""
        if self.target.is_level:
            return self.estimate().value
        return float(self.target.shown(np.array(self.middle)))

    def estimate(self) -> Estimate:
        """Estimate with an interval, which holds the middle of the draws and the number itself."""
        target, prediction, values = self.target, self.prediction, self.values
        draws = prediction.draws
        shown, work = np.zeros(values.size), np.zeros(values.size)
        found = np.zeros(estimates.MOTIONS + 1 + len(prediction.sources))
        last, sets = float(prediction.levels[-1]), len(draws.weights)
        earthquakes = draws.weights.shape[1] - 1
        estimates.fill_estimate(
            target.kind,
            target.years,
            self.middle,
            last,
            values,
            shown,
            work,
            draws.bins,
            sets,
            earthquakes,
            found,
        )
        value, lower, upper, *sources = found.tolist()
        parts = dict(zip((MOTIONS, *prediction.sources), sources, strict=True))
        known = parts if any(sources) else {}
        return Estimate(value, lower, upper, known, shown)


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
        """Fractions of motions under each draw by other outcomes, of which as much is not known."""
        levels = outcomes.intensity_levels
        counts = count_motions(
            levels.levels,
            outcomes.overturned,
            levels.allowed,
            outcomes.lifts_from(),
            earthquake_numbers(outcomes.earthquakes),
        )
        # what moves rates moves no fraction, but is drawn with the rest
        unknown = {**self.shifts, **{name: Shift(0.0, 0.0) for name in self.rates}}
        return predict(levels.levels, counts, unknown, members=self.members)

    def drawn(self, target: Target, prediction: Prediction | None = None) -> Drawn:
        """What is estimated, in each draw."""
        found = self.prediction if prediction is None else prediction
        fractions = found.rocking if target.state == ROCKS else found.toppling
        values, middle = target.with_mean(found.levels, fractions)
        if target.is_rate and self.rates:
            spreads = np.array([self.rates.get(name, 0.0) for name in found.sources])
            estimates.fill_errors(values, found.draws.sources, spreads)
        return Drawn(target, found, middle, values)

    def mean(self, target: Target, outcomes: ObjectOutcomes) -> float:
        """The number for other outcomes, the mean over what is not known; of a level the median."""
        return self.drawn(target, self.of(outcomes)).value

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
        return self.drawn(target).estimate()


def after_uplift(spread: float) -> Shift:
    """What a source moves that acts on what was lifted, by its standard deviation of ln level [-]."""
    return Shift(0.0, spread)


def shift_of(lower: ObjectOutcomes, upper: ObjectOutcomes) -> Shift:
    """What a property moves at its standard deviation, by outcomes with it on both sides.

    Parameters
    ----------
    lower, upper : outcomes with the property a standard deviation smaller and larger

    Returns
    -------
    Shifts of ln level [-].
    """
    found = np.zeros(2)
    levels = lower.intensity_levels.levels
    fill_shift(
        levels,
        lower.fractions(),
        upper.fractions(),
        lower.lifts_from(),
        upper.lifts_from(),
        found,
    )
    return Shift(*found.tolist())
