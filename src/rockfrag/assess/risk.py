"""From fractions of motions and a hazard curve to a probability with an interval.

The rate of toppling is λ = ∫ P(x) |dH(x)|, with P the fraction of motions that topple the object at level x,
linear in ln x between levels, and H the annual rate at which x is exceeded, a power law: all in closed form.

An interval is taken on ln λ, or on the logit of a fraction: the variances of its sources are added, and
Student's t has the degrees of freedom of Welch and Satterthwaite. ``docs/assess.md`` has the sources.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats

from rockfrag.assess.hazard.curve import HazardCurve, rate_weights
from rockfrag.assess.outcomes import ObjectOutcomes, fraction_at
from rockfrag.base.arrays import Floats
from rockfrag.fragility.intervals import jackknife_error
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS

LEVEL = 0.90  # Confidence of the intervals

# Part of an earthquake added on either side of fractions (Haldane, Anscombe 1956)
HALF = 0.5

_Z = float(stats.norm.ppf(0.5 + LEVEL / 2))


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
    """A probability with its interval, or a bound where no motion toppled the object."""

    value: float  # Probability [-]
    # Limits of the interval [-]
    lower: float
    upper: float
    # Standard deviation on the scale of the interval by source [-]
    sources: Mapping[str, float]


@dataclass(frozen=True)
class Target:
    """What is estimated from fractions of motions: the probability in some years, or the fraction at a level."""

    # Turns levels, fractions and a shift of the levels into the number that is estimated
    of: Callable[[Floats, Floats, float], float]
    # To the scale on which intervals are symmetric and back
    forward: Callable[[float], float]
    back: Callable[[float], float]
    state: str = OVERTURNS  # Name of the limit state whose fractions they are
    # Earthquakes added for the widths of sources, see :meth:`on_scale`
    added: float = 0.0
    # The number where it always happens; infinite for a level never reached
    certain: float = 1.0

    def on_scale(
        self,
        outcomes: ObjectOutcomes,
        weights: Floats | None = None,
        shift: float = 0.0,
        *,
        added: float = 0.0,
    ) -> float:
        """Value on the scale of the interval; -∞ where nothing topples.

        Weights of the motions have the shape (motions,); ``shift`` is the logarithm of a factor on all levels. Of
        earthquakes that are added, a part ``added`` of one topples the object wherever it rocks, and as much does
        not.
        """
        fractions = outcomes.fractions(weights, state=self.state)
        if added:
            count = len(set(outcomes.earthquakes)) - (weights is not None)
            could = outcomes.fractions(weights, state=ROCKS) > 0
            fractions = (count * fractions + added * could) / (count + 2 * added)
        return self.forward(self.of(outcomes.intensity_levels.levels, fractions, shift))

    def value(self, outcomes: ObjectOutcomes, weights: Floats | None = None) -> float:
        """What is estimated."""
        return self.back(self.on_scale(outcomes, weights))

    def without_each(self, outcomes: ObjectOutcomes) -> Floats:
        """Values on the scale without one earthquake each; ``HALF`` is added to all where one decides alone."""
        weights = earthquake_weights(outcomes.earthquakes)
        found = np.array(
            [self.on_scale(outcomes, w, added=self.added) for w in weights]
        )
        if np.isfinite(found).all():
            return found
        return np.array([self.on_scale(outcomes, w, added=HALF) for w in weights])


def _log(value: float) -> float:
    return math.log(value) if value > 0 else -math.inf


def _exp(value: float) -> float:
    with np.errstate(over="ignore"):
        return float(np.exp(value))


def risk_target(hazard: HazardCurve, years: float) -> Target:
    """The probability of toppling in some years."""
    return Target(
        of=lambda levels, fractions, shift: toppling_rate(
            levels, fractions, hazard, shift
        ),
        forward=_log,
        back=lambda value: probability_in(_exp(value), years),
    )


def fraction_target(level: float, *, state: str = OVERTURNS) -> Target:
    """The fraction of motions that bring the object into a limit state at a level."""
    return Target(
        of=partial(fraction_at, level),
        forward=lambda fraction: float(special.logit(fraction)),
        back=lambda value: float(special.expit(value)),
        state=state,
        added=HALF,
    )


def amplitude_target(fraction: float) -> Target:
    """The level at which a fraction of the motions topples the object."""

    def level(levels: Floats, fractions: Floats, shift: float) -> float:
        reached = np.flatnonzero(fractions >= fraction)
        if not reached.size:
            return math.inf
        i = int(reached[0])
        if i == 0:
            return float(levels[0])
        part = (fraction - fractions[i - 1]) / (fractions[i] - fractions[i - 1])
        x = np.log(levels)
        return float(np.exp(x[i - 1] + part * (x[i] - x[i - 1]) + shift))

    return Target(of=level, forward=_log, back=_exp, certain=math.inf)


def earthquake_weights(earthquakes: NDArray[np.object_]) -> Floats:
    """Weights that leave out one earthquake at a time, shape (earthquakes, motions)."""
    names = list(dict.fromkeys(earthquakes))
    return np.array([(earthquakes != name).astype(np.float64) for name in names])


@dataclass(frozen=True)
class Evidence:
    """What estimates rest on."""

    outcomes: ObjectOutcomes  # Outcomes of the object
    # Outcomes with each property moved to both sides by its standard deviation
    moved: Mapping[str, tuple[ObjectOutcomes, ObjectOutcomes]] = field(
        default_factory=dict
    )
    # Standard deviations of ln level by source, such as of the model
    shifts: Mapping[str, float] = field(default_factory=dict)

    def estimate(
        self, target: Target, fixed: Mapping[str, float] | None = None
    ) -> Estimate:
        """Estimate with an interval; ``fixed`` are further standard deviations on its scale, as of the hazard."""
        middle = target.on_scale(self.outcomes)
        if not math.isfinite(middle):
            return self._bounded(target, middle)

        def near(changed: ObjectOutcomes, shift: float = 0.0) -> float:
            return target.on_scale(changed, shift=shift, added=target.added)

        here, left_out = near(self.outcomes), target.without_each(self.outcomes)
        # where nothing rocks without one of them, what others would say is open
        known = len(left_out) > 1 and np.isfinite(left_out).all()
        sources = {"motions": float(jackknife_error(left_out)) if known else math.inf}
        for name, (lower, upper) in self.moved.items():
            sources[name] = _half_width(near(lower), near(upper), here)
        for name, spread in self.shifts.items():
            low, high = (near(self.outcomes, sign * spread) for sign in (-1, 1))
            sources[name] = _half_width(low, high, here)
        sources |= fixed or {}
        total = math.sqrt(sum(value**2 for value in sources.values()))
        quantile = _Z
        if math.isfinite(total) and sources["motions"] != 0:
            # Student's t for the sum of one estimated and several known variances
            freedom = (len(left_out) - 1) * (total / sources["motions"]) ** 4
            quantile = float(stats.t.ppf(0.5 + LEVEL / 2, freedom))
        # what was added must not make an interval narrower than that of motions which all agree
        low, high = sorted((middle, here))
        # with all levels shifted to the ends of the interval the fraction that topples may fall to nothing, which
        # no multiple of its slope says
        shift = quantile * math.hypot(*self.shifts.values())
        ends = sorted(
            target.on_scale(self.outcomes, shift=sign * shift) for sign in (-1, 1)
        )
        down, up = max(0.0, middle - ends[0]), max(0.0, ends[1] - middle)
        others = [sources[name] for name in sources if name not in self.shifts]
        half = quantile * math.hypot(*others)
        return Estimate(
            target.back(middle),
            target.back(low - math.hypot(half, down)),
            target.back(high + math.hypot(half, up)),
            sources,
        )

    def _bounded(self, target: Target, middle: float) -> Estimate:
        """Where every motion agrees: as many others could disagree as these earthquakes cannot exclude."""
        hidden = _hidden(self.outcomes)
        shift = _Z * math.sqrt(sum(spread**2 for spread in self.shifts.values()))
        happens = middle > 0 and not math.isinf(target.certain)
        sign = -1 if happens else 1

        def bound(changed: ObjectOutcomes, shift: float = 0.0) -> float:
            fractions = changed.fractions(state=target.state)
            if happens:
                fractions = np.minimum(fractions, 1 - hidden)
            else:
                could = changed.fractions(state=ROCKS) > 0
                fractions = np.where(could, np.maximum(fractions, hidden), 0.0)
            return target.of(changed.intensity_levels.levels, fractions, -sign * shift)

        if math.isinf(target.certain):
            # never reached: hidden motions could be enough at some level, or it lies above the last one
            last = float(self.outcomes.intensity_levels.levels[-1])
            return Estimate(
                math.inf, min(bound(self.outcomes, shift), last), math.inf, {}
            )
        limit, plain = (target.forward(bound(self.outcomes, by)) for by in (shift, 0.0))
        both_sides = self.moved.values()
        ends = [
            max(sign * target.forward(bound(side)) for side in both)
            for both in both_sides
        ]
        if math.isfinite(plain):
            further = [max(0.0, end - sign * plain) for end in ends]
            limit += sign * _Z * math.sqrt(sum(term**2 for term in further))
        else:
            # at rest as it is: what could move it decides
            limit = sign * max([sign * limit, *ends])
        if happens:
            return Estimate(1.0, target.back(limit), 1.0, {})
        return Estimate(0.0, 0.0, target.back(limit), {})

    def rocking(self, level: float, *, exact: bool) -> Estimate:
        """Estimate the fraction of motions at a level that make the object rock, which is statics and no model.

        Where the level alone decides (``exact``), as peak acceleration does, other earthquakes say the same.
        """
        target = fraction_target(level, state=ROCKS)
        found = replace(self, shifts={}).estimate(target)
        if 0 < found.value < 1:
            return found
        sides = [target.value(side) for both in self.moved.values() for side in both]
        hidden = 0.0 if exact else _hidden(self.outcomes)
        if found.value == 0:
            return Estimate(0.0, 0.0, max([hidden, *sides]), {})
        return Estimate(1.0, min([1 - hidden, *sides]), 1.0, {})


def _hidden(outcomes: ObjectOutcomes) -> float:
    """Fraction of earthquakes that could disagree where all of so many agree, which they cannot exclude."""
    return float(1 - (1 - LEVEL) ** (1 / len(set(outcomes.earthquakes))))


def _half_width(low: float, high: float, middle: float) -> float:
    """Half the distance of two values; the distance to the middle where one is no number."""
    ends = [value for value in (low, high) if math.isfinite(value)]
    if len(ends) == 2:
        return abs(high - low) / 2
    return abs(ends[0] - middle) if ends else 0.0


REFERENCE_YEARS = 50.0  # Time for which the steps hold [year]


@dataclass(frozen=True)
class Step:
    """A step of the scale."""

    name: str  # What it is called
    below: float  # Probability in 50 years below which it holds [-]
    advice: str  # What to do, in a sentence


STEPS = (
    Step("low", 1e-3, "Nothing is urgent; keep it as it is."),
    Step(
        "moderate",
        1e-2,
        "Have it looked at when it is next moved, and plan what helps.",
    ),
    Step("high", 1e-1, "Have it measured, and secure it."),
    Step("very high", math.inf, "Secure it now."),
)
"""Steps of the scale, rising."""


def step_of(probability: float, years: float) -> Step:
    """Step of a probability in some years, by the rate that it stands for."""
    rate = -math.log1p(-min(probability, 1 - 1e-15)) / years
    in_fifty = probability_in(rate, REFERENCE_YEARS)
    return next(step for step in STEPS if in_fifty < step.below)
