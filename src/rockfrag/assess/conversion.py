"""Two measures: what is known of the ground velocity that comes with a level of PGA or Sa at a site.

P(topples | IM, PGV/IM) is fitted to the simulated motions (:func:`rockfrag.fragility.fit_vector`).  A motion whose
PGV/IM is larger by a factor r topples the object at levels of IM smaller by r^w, with w the effect of ln PGV/IM
over that of ln IM: fractions of motions are still counted.  The spread of ln PGV/IM at a site differs from one
earthquake to the next and belongs into the fractions; its mean is not known and belongs into the interval.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.assess.hazard.curve import PGV, VELOCITY_PER_G, HazardCurve
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.request import Level, Records
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.fragility.intervals import jackknife_error
from rockfrag.fragility.vector import VectorFragility, fit_vector
from rockfrag.motions.conditional_velocity import MODELS, ConditionalModel
from rockfrag.motions.intensity import IntensityMeasure

UNKNOWN = {"magnitude": 0.5, "ln_distance": 0.7, "ln_vs30": 0.45}
"""Standard deviations of what is not known of the earthquakes and the ground of a site: estimates of ours, half a
magnitude, a factor of two in distance, and a class of ground (EN 1998-1: 180, 360, 800 m/s)."""

PRIOR = {"magnitude": 6.5, "ln_distance": math.log(15.0), "ln_vs30": math.log(400.0)}
"""What is taken where only a part is given of the earthquakes and the ground of a site: estimates of ours."""

OF_THE_SITE = 0.5
"""Part of the variance about the relation that all motions of a site share [-]: an estimate of ours."""

# From which three coefficients are fitted; of fewer all of their spread counts
FEWEST_RECORDS = 30

TOGETHER = 0.25
"""Relative standard deviation of the spread of ln PGV at a given level, which two hazard curves do not say: of
ours."""

NODES = 11  # Values of equal probability that stand for the spread of ln PGV/IM

OF_DISPLACEMENT = 2.0
"""Largest weight of ln PGV/IM [-]: a motion stretched in time by r at a given PGA has a PGV larger by r and a
displacement larger by r²."""

# Levels of a motion that are fitted; tests under one motion depend on each other
MOST_LEVELS = 8


@dataclass(frozen=True)
class PublishedVelocity:
    """PGV that comes with levels of PGA or SA(1 s) by Abrahamson and Bhasin (2020), for earthquakes of a site."""

    model: ConditionalModel
    magnitude: float
    distance_km: float
    vs30: float

    @classmethod
    def of(
        cls, measure: IntensityMeasure, given: Records
    ) -> "PublishedVelocity | None":
        """Return it for what is given of the earthquakes, the rest as in ``PRIOR``; None for other measures."""
        model = MODELS.get(measure.imt)
        facts = zip(_facts(given), PRIOR.values(), strict=True)
        magnitude, ln_distance, ln_vs30 = (
            prior if math.isnan(fact) else fact for fact, prior in facts
        )
        if model is None:
            return None
        return cls(model, magnitude, math.exp(ln_distance), math.exp(ln_vs30))

    @property
    def scatter(self) -> float:
        """Standard deviation of ln PGV about the median [-]."""
        return math.hypot(*self.model.spreads(self.magnitude))

    def log_ratio(self, levels: Floats) -> Floats:
        """Median of ln (PGV over the measure [s]) at levels of the measure [g], of their shape."""
        about = self.magnitude, self.distance_km, self.vs30
        return self.model.log_velocity(levels, *about) - np.log(levels * VELOCITY_PER_G)

    def unknown(self, given: Records, level: float) -> float:
        """Standard deviation of that median at a level, for what is not known of the site and its earthquakes."""
        moved = {
            "magnitude": lambda by: replace(self, magnitude=self.magnitude + by),
            "ln_distance": lambda by: replace(
                self, distance_km=self.distance_km * math.exp(by)
            ),
            "ln_vs30": lambda by: replace(self, vs30=self.vs30 * math.exp(by)),
        }
        at, parts = np.array(level), [OF_THE_SITE * self.scatter**2]
        for (name, move), fact in zip(moved.items(), _facts(given), strict=True):
            if math.isnan(fact):
                low, high = (
                    float(move(sign * UNKNOWN[name]).log_ratio(at)) for sign in (-1, 1)
                )
                parts.append(((high - low) / 2) ** 2)
        return math.sqrt(sum(parts))


@dataclass(frozen=True)
class SiteVelocity:
    """PGV that comes with levels of another measure at a site: ln of their ratio [s] is normal."""

    spread: float  # Its standard deviation from one earthquake to the next [-]
    # Its mean, the same at all levels, where no curves are known
    constant: float = math.nan
    # By how much it grows with ln of the measure [-], and the level at which it is ``constant``
    slope: float = 0.0
    at: float = 1.0
    # Hazard curves of the measure and of PGV, with which it agrees; the spread at a given level is then not known
    curves: tuple[HazardCurve, ...] = ()
    # Published relation for the earthquakes of the site, at levels of the measure
    published: "PublishedVelocity | None" = None

    @classmethod
    def given(cls, level: Level, between_earthquakes: float) -> "SiteVelocity":
        """PGV that is given with a level; of levels that are not known exactly that which comes with each.

        Of two normal logarithms the one has, where the other is known, a mean that is linear in it and a smaller
        spread.
        """
        ratio = math.log(level.pgv / level.value / VELOCITY_PER_G)
        about = level.spread
        if about is None:
            return cls(between_earthquakes, ratio)
        slope = 0.0
        if about.value > 0:
            slope = about.correlation * about.pgv / about.value - 1.0
        left = about.pgv * math.sqrt(1.0 - about.correlation**2)
        return cls(math.hypot(between_earthquakes, left), ratio, slope, level.value)

    def log_ratio(self, levels: Floats) -> Floats:
        """Mean of ln ratio at levels of the measure, of their shape.

        If ln PGV is normal about a line in ln measure with the standard deviation s, and the rate of PGV falls
        with the exponent k, the level of PGV at a rate lies k s²/2 above the mean of ln PGV at the measure's level
        of that rate.
        """
        if self.published is not None:
            return self.published.log_ratio(levels)
        if not self.curves:
            return self.constant + self.slope * np.log(levels / self.at)
        first, velocity = self.curves
        rates = first.rate(levels)
        logs = [
            np.log([velocity.level(rate * factor) for rate in rates])
            for factor in (1.0, math.exp(-1), math.e)
        ]
        slope = 2.0 / (logs[1] - logs[2])
        return np.asarray(
            logs[0] - slope * self.spread**2 / 2 - np.log(levels * VELOCITY_PER_G)
        )


@dataclass(frozen=True)
class Conversion:
    """What is known of the velocity at a site whose shaking is given in another measure."""

    measure: IntensityMeasure  # The measure that is known
    # P(topples | ``im``, ``ratio_s``): the measure, and PGV over it
    fragility: VectorFragility
    # Effect of ln ratio over that of ln measure [-]: 0 if PGV says nothing, 1 if all, up to 2 for displacement
    weight: float
    logs: Floats  # ln (PGV over the measure [s]) of each motion, shape (motions,)
    known: SiteVelocity | None  # What is known of the site; None if nothing is
    spread: float  # Standard deviation of the mean of ln ratio at the site [-]
    # Standard deviation of ln level that follows, with the error of the weight [-]
    shift: float
    # Whether the level alone decides what rocks, as PGA does on the ground
    by_statics: bool

    def of(self, motions: MotionSet) -> "Conversion":
        """The same for other motions of the set."""
        return replace(self, logs=motions.log_ratios(self.measure))

    @property
    def of_set(self) -> float:
        """Median of PGV over the measure of the motions [cm/s per unit]."""
        return VELOCITY_PER_G * math.exp(float(np.median(self.logs)))

    @property
    def ends(self) -> list[float]:
        """Least and largest PGV over the measure of the motions [cm/s per unit]."""
        return [
            VELOCITY_PER_G * math.exp(log) for log in (self.logs.min(), self.logs.max())
        ]

    def site_log(self, level: Level) -> float:
        """Mean of ln (PGV over the measure [s]) at the site's level, where something is known of it."""
        assert self.known is not None
        return float(self.known.log_ratio(np.array([level.value]))[0])

    def at_level(self, level: Level) -> float:
        """The same as PGV over the measure [cm/s per unit]."""
        return VELOCITY_PER_G * math.exp(self.site_log(level))

    def at_site(self, outcomes: ObjectOutcomes) -> ObjectOutcomes:
        """Outcomes under motions with the velocity of the site; as they are where nothing is known of it."""
        return outcomes if self.known is None else self._moved(outcomes, self.known)

    def sides(
        self, outcomes: ObjectOutcomes
    ) -> tuple[ObjectOutcomes, ObjectOutcomes] | None:
        """The same with less and more spread of velocities at a given level; None where that is not open."""
        known = self.known
        if known is None or not known.curves:
            return None
        lower, upper = (
            self._moved(outcomes, replace(known, spread=known.spread * factor))
            for factor in (1 - TOGETHER, 1 + TOGETHER)
        )
        return lower, upper

    def _moved(self, outcomes: ObjectOutcomes, site: SiteVelocity) -> ObjectOutcomes:
        """Each motion at the level at which it is as strong for the object as with the velocity of the site."""
        intensity_levels = outcomes.intensity_levels
        x = np.log(intensity_levels.levels)
        count = NODES if site.spread > 0 else 1
        nodes = special.ndtri((np.arange(count) + 0.5) / count)
        nodes *= site.spread / nodes.std() if count > 1 else 0.0
        wanted = site.log_ratio(intensity_levels.levels) + nodes[:, np.newaxis]
        # (motions, nodes, levels), then a row for each motion at each node
        moved = x + self.weight * (wanted - self.logs[:, np.newaxis, np.newaxis])
        moved = moved.reshape(-1, x.size)
        row = np.repeat(np.arange(self.logs.size), count)[:, np.newaxis]
        place = np.rint(np.interp(moved, x, np.arange(x.size))).astype(np.intp)
        inside = (moved >= x[0]) & (moved <= x[-1])
        overturned = outcomes.overturned[row, place]
        rocked = np.repeat(outcomes.rocked, count, axis=0)
        if self.by_statics:
            overturned &= rocked
            # at a level where it does not rock a motion says nothing of one that makes it rock
            inside &= outcomes.rocked[row, place] | ~rocked
        return replace(
            outcomes,
            intensity_levels=replace(
                intensity_levels,
                scales=intensity_levels.scales[row, place],
                allowed=intensity_levels.allowed[row, place] & inside,
            ),
            overturned=overturned,
            rocked=rocked | overturned,
            others={name: cases[row, place] for name, cases in outcomes.others.items()},
            earthquakes=np.repeat(outcomes.earthquakes, count),
            lifting=np.repeat(outcomes.lifts_from(), count),
        )


def find_conversion(
    outcomes: ObjectOutcomes,
    motions: MotionSet,
    given: Records,
    level: Level,
    curves: tuple[HazardCurve, ...],
    *,
    by_statics: bool,
    brief: bool,
) -> Conversion | None:
    """Fit the fragility in two measures, and gather what is known of the site's velocity; None in PGV or unfitted.

    ``curves`` are the hazard in the measure and, if known, in PGV; ``brief`` fits without an interaction.
    """
    measure = outcomes.intensity_levels.measure
    if measure == PGV:
        return None
    logs = motions.log_ratios(measure)
    fit = _fitted(outcomes, logs, brief)
    if fit is None:
        return None
    middle = float(np.median(logs))
    weight, error = _weight(fit, middle)
    if not math.isfinite(weight):
        return None
    # what is known of the velocity at the site, and the standard deviation of the mean of ln ratio
    relation = VelocityRelation.of(
        motions.about, motions.log_ratios(measure, of_all=True)
    )
    own = math.sqrt(1 - OF_THE_SITE) * relation.scatter
    known, spread, away = None, 0.0, 0.0
    if len(curves) > 1:
        known = SiteVelocity(relation.scatter, curves=curves)
    elif math.isfinite(level.pgv):
        # of a hazard curve other levels count too, with velocities of their own
        known = SiteVelocity.given(level, own if curves else 0.0)
    elif math.isnan(given.magnitude) and math.isnan(given.distance_km):
        # what differs about the relation is in the motions, once
        spread = relation.unknown(given, of_site=False)
    elif (published := PublishedVelocity.of(measure, given)) is not None:
        spread = published.unknown(given, level.value)
        within = math.sqrt(1 - OF_THE_SITE) * published.scatter
        known = SiteVelocity(within, published=published)
    else:
        spread = relation.unknown(given)
        known = SiteVelocity(own, relation.mean(given))
    if known is not None:
        away = float(
            np.abs(known.log_ratio(outcomes.intensity_levels.levels) - middle).mean()
        )
    shift = math.hypot(weight * spread, error * away)
    return Conversion(measure, fit, weight, logs, known, spread, shift, by_statics)


def _fitted(
    outcomes: ObjectOutcomes, logs: Floats, brief: bool
) -> VectorFragility | None:
    intensity_levels = outcomes.intensity_levels
    step = -(-intensity_levels.levels.size // MOST_LEVELS)
    motion, level = np.nonzero(intensity_levels.allowed[:, ::step])
    level *= step
    table = pd.DataFrame(
        {
            "im": intensity_levels.levels[level],
            "ratio_s": np.exp(logs[motion]),
            "overturned": outcomes.overturned[motion, level].astype(np.float64),
            "earthquake": outcomes.earthquakes[motion],
        }
    )
    try:
        return fit_vector(table, ("im", "ratio_s"), try_interaction=not brief)
    except InputError:
        return None


def _weight(fit: VectorFragility, log_ratio: float) -> tuple[float, float]:
    """Effect of ln ratio over that of ln measure at half toppling, within its bounds, and its standard error."""
    middle, *_ = fit.contour(0.5, math.exp(log_ratio))
    log_level = float(np.log(middle[0]))
    # of the fit and of those without an earthquake each
    c = np.vstack([fit.coefficients, fit.replicates])
    more = c[:, 3] if c.shape[1] > 3 else 0.0
    own, *left_out = (c[:, 2] + more * log_level) / (c[:, 1] + more * log_ratio)
    error = float(jackknife_error(np.array(left_out))) if len(left_out) > 1 else 0.0
    return float(np.clip(own, 0.0, OF_DISPLACEMENT)), error if math.isfinite(
        error
    ) else 0.0


@dataclass(frozen=True)
class VelocityRelation:
    """How ln (PGV over a measure) follows magnitude, ln distance and ln Vs30 among the records of a set."""

    # Of 1 and the three; only the mean where fewer than ``FEWEST_RECORDS`` records are known so well
    coefficients: tuple[float, ...]
    middle: tuple[float, ...]  # Mean of the three in the set
    scatter: float  # Standard deviation about the relation [-]

    @classmethod
    def of(
        cls, about: Sequence[Mapping[str, object]], logs: Floats
    ) -> "VelocityRelation":
        """Fit it to what is known of the record of each motion, and to its ln ratio, shape (motions,)."""
        table = pd.DataFrame(
            {
                "record": [
                    f"{a.get('earthquake')} {a.get('station', i)}"
                    for i, a in enumerate(about)
                ],
                "magnitude": [_number(a, "magnitude") for a in about],
                "ln_distance": [math.log(_number(a, "distance_km")) for a in about],
                "ln_vs30": [math.log(_number(a, "vs30_m_s")) for a in about],
                "log": logs,
            }
        )
        records = table.groupby("record").mean()
        known = records.dropna()
        if len(known) < FEWEST_RECORDS:
            spread = float(records["log"].std(ddof=1)) if len(records) > 1 else 0.0
            return cls((float(records["log"].mean()),), (), spread)
        facts = known[list(UNKNOWN)].to_numpy()
        x = np.column_stack([np.ones(len(known)), facts])
        fit, *_ = np.linalg.lstsq(x, known["log"].to_numpy(), rcond=None)
        rest = known["log"].to_numpy() - x @ fit
        scatter = math.sqrt(float(rest @ rest) / (len(known) - x.shape[1]))
        return cls(
            tuple(map(float, fit)), tuple(map(float, facts.mean(axis=0))), scatter
        )

    def mean(self, given: Records) -> float:
        """Mean of ln ratio for what is known of the earthquakes; the rest as in the set."""
        slopes = zip(self.coefficients[1:], self.middle, _facts(given), strict=False)
        return self.coefficients[0] + sum(
            slope * (middle if math.isnan(fact) else fact)
            for slope, middle, fact in slopes
        )

    def unknown(self, given: Records, *, of_site: bool = True) -> float:
        """Standard deviation of the mean at a site, for what is not known of its earthquakes and ground.

        ``of_site`` counts what all motions of a site share beyond that; it always counts where facts of too few
        records are known to say how the mean follows them.
        """
        slopes = zip(
            self.coefficients[1:], UNKNOWN.values(), _facts(given), strict=False
        )
        parts = [
            (slope * spread) ** 2 for slope, spread, fact in slopes if math.isnan(fact)
        ]
        if of_site or not self.middle:
            parts.append(OF_THE_SITE * self.scatter**2)
        return math.sqrt(sum(parts))


def _facts(given: Records) -> tuple[float, float, float]:
    """Magnitude, ln distance and ln Vs30 of a site; NaN where not known."""
    return given.magnitude, math.log(max(given.distance_km, 1.0)), math.nan


def _number(about: Mapping[str, object], key: str) -> float:
    """A number that is known of a record and above 0, NaN where none is."""
    value = about.get(key)
    return float(value) if isinstance(value, int | float) and value > 0 else math.nan
