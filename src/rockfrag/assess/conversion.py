"""Two measures: what is known of the ground velocity that comes with a level of PGA or Sa at a site.

P(topples | IM, PGV/IM) is fitted to the simulated motions (:mod:`rockfrag.assess.core.velocity`).  A motion whose
PGV/IM is larger by a factor r topples the object at levels of IM smaller by r^w, with w the effect of ln PGV/IM
over that of ln IM: fractions of motions are still counted.  The spread of ln PGV/IM at a site differs from one
earthquake to the next and belongs into the fractions; its mean is not known and belongs into the interval.

In: outcomes of motions, their PGV/IM [s] and what is known of the site. Out: weights and fractions at the site.
Theory: ``docs/assess.md``, "Two measures".
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.assess.core.velocity import (
    MEMORY,
    MOST_LEVELS,
    STATE,
    fill_moved,
    fill_wanted,
    fill_weight,
    shift_by_velocity,
    spread_of_mean,
)
from rockfrag.assess.hazard.curve import PGV, SA_1S, VELOCITY_PER_G, HazardCurve
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import ObjectOutcomes, earthquake_numbers
from rockfrag.assess.request import Level, Records
from rockfrag.base.arrays import Floats
from rockfrag.motions.conditional_velocity import MODELS, ConditionalModel
from rockfrag.motions.intensity import IntensityMeasure

UNKNOWN = {"magnitude": 0.75, "ln_distance": 0.7, "ln_vs30": 0.45}
"""Standard deviations of what is not known of the earthquakes and the ground of a site.

Estimates of ours: magnitudes of 5.5 to 8 alike (2.5 / √12), a factor of two in distance, which is about the
scatter of Joyner and Boore (1981), and a class of ground (EN 1998-1: 180, 360, 800 m/s).
"""

PRIOR = {"magnitude": 6.75, "ln_vs30": math.log(400.0)}
"""Middle of what is taken where nothing is given of the magnitude and the ground of a site: an estimate of ours.
The distance follows from the magnitude and the level (:func:`usual_distance`)."""

USUAL_LEVELS = (0.1, 0.5)
"""Levels of design [g] through which the line of the velocity goes where the distance is not given."""

OF_THE_SITE = 0.5
"""Part of the variance about the relation that all motions of a site share [-]: an estimate of ours."""

# From which three coefficients are fitted; of fewer all of their spread counts
FEWEST_RECORDS = 30

TOGETHER = 0.25
"""Relative standard deviation of the spread of ln PGV at a given level, which two hazard curves do not say: of
ours."""

_EQUAL = special.ndtri((np.arange(11) + 0.5) / 11)
NODES: Floats = np.round(_EQUAL / _EQUAL.std(), 12)
"""Values of equal probability that stand for a standard normal spread of ln PGV/IM."""


def usual_distance(level: float, magnitude: float) -> float:
    """Distance at which an earthquake of a magnitude has a PGA as its median, at least 1 km.

    W. B. Joyner, D. M. Boore (1981), Bulletin of the Seismological Society of America 71: 2011. A strong
    shaking is thus that of a near and large earthquake, and a weak one that of a distant or small one.

    Parameters
    ----------
    level : PGA [g]; SA(1 s) is about as large on ground of 400 m/s
    magnitude : moment magnitude

    Returns
    -------
    Distance to the rupture [km].
    """
    of_source = -1.02 + 0.249 * magnitude - math.log10(level)
    # log r + 0.00255 r = of_source by Lambert's function, W exp W = x
    rate = 0.00255 * math.log(10)
    slant = float(special.lambertw(rate * 10**of_source).real) / rate
    return math.sqrt(max(slant**2 - 7.3**2, 1.0))


@dataclass(frozen=True)
class PublishedVelocity:
    """PGV that comes with levels of PGA or SA(1 s) by Abrahamson and Bhasin (2020), for earthquakes of a site."""

    model: ConditionalModel
    magnitude: float
    distance_km: float  # NaN where it is the usual one of each level
    vs30: float
    farther: float = 1.0  # Factor on the usual distance [-]

    @classmethod
    def of(
        cls, measure: IntensityMeasure, given: Records
    ) -> "PublishedVelocity | None":
        """Return it for what is given of the earthquakes, the rest usual; None for other measures."""
        model = MODELS.get(measure.imt)
        if model is None:
            return None
        magnitude, ln_distance, ln_vs30 = _facts(given)
        return cls(
            model,
            magnitude=PRIOR["magnitude"] if math.isnan(magnitude) else magnitude,
            distance_km=math.exp(ln_distance),
            vs30=math.exp(PRIOR["ln_vs30"] if math.isnan(ln_vs30) else ln_vs30),
        )

    def distance(self, level: float) -> float:
        """Distance that is taken at a level of the measure [km]."""
        if math.isfinite(self.distance_km):
            return self.distance_km
        return usual_distance(level, self.magnitude) * self.farther

    @property
    def scatter(self) -> float:
        """Standard deviation of ln PGV about the median [-]."""
        return math.hypot(*self.model.spreads(self.magnitude))

    def lines(self, given: Records) -> Floats:
        """Lines in ln level: ln (PGV over the measure [s]), and by how much each fact may change it.

        The first row has the median, the others what one standard deviation of magnitude, distance and ground
        does where they are not given: intercepts at 1 g and slopes, shape (4, 2).
        """
        moved = {
            "magnitude": lambda by: replace(self, magnitude=self.magnitude + by),
            "ln_distance": lambda by: replace(self, farther=math.exp(by)),
            "ln_vs30": lambda by: replace(self, vs30=self.vs30 * math.exp(by)),
        }
        found = [self._line()]
        for (name, move), fact in zip(moved.items(), _facts(given), strict=True):
            sides = [move(sign * UNKNOWN[name])._line() for sign in (-1, 1)]
            half = (sides[1] - sides[0]) / 2
            found.append(half if math.isnan(fact) else np.zeros(2))
        return np.array(found)

    def _line(self) -> Floats:
        """Intercept at 1 g and slope of the straight line through the usual levels."""
        logs = np.log(USUAL_LEVELS)
        ratios = [self._log_ratio(level) for level in USUAL_LEVELS]
        slope = (ratios[1] - ratios[0]) / (logs[1] - logs[0])
        return np.array([ratios[0] - slope * logs[0], slope])

    def _log_ratio(self, level: float) -> float:
        """Ln (PGV over the measure [s]) at a level, from the relation itself."""
        (log,) = self.model.log_velocity(
            np.array([level]), self.magnitude, self.distance(level), self.vs30
        )
        return float(log) - math.log(level * VELOCITY_PER_G)

    @property
    def within(self) -> float:
        """Standard deviation of ln PGV from motion to motion of a site [-]."""
        return math.sqrt(1 - OF_THE_SITE) * self.scatter

    @property
    def of_site(self) -> float:
        """Standard deviation of what all motions of a site share about the median [-]."""
        return math.sqrt(OF_THE_SITE) * self.scatter


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
    # Published relation for the earthquakes of the site, and its line in ln level, shape (1, 2); None without one
    published: PublishedVelocity | None = None
    line: Floats | None = None

    @classmethod
    def from_level(cls, level: Level, between_earthquakes: float) -> "SiteVelocity":
        """Take the PGV that a level states, as it comes with the stated value of the measure.

        A level that is not known exactly has ln measure and ln PGV that are normal and correlated. At another
        level of the measure the mean of ln PGV is then moved in proportion to ln measure, and its standard
        deviation is √(1 - ρ²) of the stated one.

        Parameters
        ----------
        level : value of the measure [g], its PGV [cm/s], and how well both are known; without a spread both are
            exact
        between_earthquakes : standard deviation of ln PGV from one earthquake to the next [-]
        """
        ratio = math.log(level.pgv / level.value / VELOCITY_PER_G)
        about = level.spread
        if about is None:
            return cls(spread=between_earthquakes, constant=ratio)
        slope = 0.0
        if about.value > 0:
            # that of ln PGV on ln measure, less 1 as the ratio of both is sought
            slope = about.correlation * about.pgv / about.value - 1.0
        left = about.pgv * math.sqrt(1.0 - about.correlation**2)
        return cls(
            spread=math.hypot(between_earthquakes, left),
            constant=ratio,
            slope=slope,
            at=level.value,
        )

    def log_ratio(self, levels: Floats) -> Floats:
        """Mean of ln (PGV over the measure [s]) at levels of the measure, of their shape."""
        if self.line is not None:
            wanted = np.zeros(levels.size)
            fill_wanted(levels, self.line, wanted)
            return wanted
        if self.curves:
            return self._log_ratio_by_curves(levels)
        return self.constant + self.slope * np.log(levels / self.at)

    def _log_ratio_by_curves(self, levels: Floats) -> Floats:
        """Mean of ln (PGV over the measure [s]) with which both hazard curves agree.

        If ln PGV is normal with the standard deviation s at a given level of the measure, and the rate of PGV
        falls as PGV⁻ᵏ, the PGV of a rate lies k s²/2 above that mean, by logarithm (``docs/assess.md``, "Two
        measures").
        """
        first, velocity = self.curves
        rates = first.rate(levels)
        logs = [
            np.log([velocity.level(rate * factor) for rate in rates])
            for factor in (1.0, math.exp(-1), math.e)
        ]
        # k, from PGV at a rate e times smaller and e times larger
        exponent = 2.0 / (logs[1] - logs[2])
        mean = logs[0] - exponent * self.spread**2 / 2
        return np.asarray(mean - np.log(levels * VELOCITY_PER_G))


@dataclass(frozen=True)
class Conversion:
    """What is known of the velocity at a site whose shaking is given in another measure."""

    measure: IntensityMeasure  # The measure that is known
    # Of 1, ln measure and ln ratio in the probit of toppling
    coefficients: tuple[float, ...]
    # Effect of ln ratio over that of ln measure [-]: 0 if PGV says nothing, 1 if all, up to 2 for displacement
    weight: float
    # Its standard error by a jackknife over earthquakes [-]; 0 if not needed
    error: float
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
        """Outcomes with less and with more spread of velocities at a given level of the measure.

        It is open where hazard curves of both measures are known, which do not say it; None elsewhere.
        """
        known = self.known
        if known is None or not known.curves:
            return None
        less = replace(known, spread=known.spread * (1 - TOGETHER))
        more = replace(known, spread=known.spread * (1 + TOGETHER))
        return self._moved(outcomes, less), self._moved(outcomes, more)

    def _moved(self, outcomes: ObjectOutcomes, site: SiteVelocity) -> ObjectOutcomes:
        """Take each motion at the level at which it is as strong for the object as with the velocity of the site.

        A motion stands for several, one for each node of the spread of velocities about their mean.
        """
        intensity_levels = outcomes.intensity_levels
        levels = intensity_levels.levels
        nodes = site.spread * NODES if site.spread > 0 else np.zeros(1)
        shape = self.logs.size * nodes.size, levels.size
        places = np.zeros(shape, dtype=np.int64)
        allowed = np.zeros(shape, dtype=np.bool_)
        overturned, rocked = allowed.copy(), allowed.copy()
        fill_moved(
            levels,
            np.ascontiguousarray(intensity_levels.allowed),
            np.ascontiguousarray(outcomes.overturned),
            np.ascontiguousarray(outcomes.rocked),
            self.logs,
            site.log_ratio(levels),
            nodes,
            self.weight,
            self.by_statics,
            np.zeros(levels.size),
            places,
            allowed,
            overturned,
            rocked,
        )
        row = np.repeat(np.arange(self.logs.size), nodes.size)[:, np.newaxis]
        return replace(
            outcomes,
            intensity_levels=replace(
                intensity_levels,
                scales=intensity_levels.scales[row, places],
                allowed=allowed,
            ),
            overturned=overturned,
            rocked=rocked,
            others={
                name: cases[row, places] for name, cases in outcomes.others.items()
            },
            earthquakes=np.repeat(outcomes.earthquakes, nodes.size),
            lifting=np.repeat(outcomes.lifts_from(), nodes.size),
        )


@dataclass(frozen=True)
class Site:
    """What is known of the shaking of a site."""

    given: Records  # Of its earthquakes and ground
    level: Level  # Level of shaking
    curves: tuple[HazardCurve, ...]  # Hazard in the measure and, if known, in PGV


def find_conversion(
    outcomes: ObjectOutcomes, motions: MotionSet, site: Site, *, by_statics: bool
) -> Conversion | None:
    """Fit the fragility in two measures, and gather what is known of the velocity at the site.

    Parameters
    ----------
    outcomes, motions : of an object at levels of one measure, and the motions that shook it
    site : what is known of the earthquakes and of the ground there
    by_statics : whether statics say which motions lift the object

    Returns
    -------
    The :class:`Conversion`; None where levels are of PGV already, or the outcomes allow no fit.
    """
    measure = outcomes.intensity_levels.measure
    if measure == PGV:
        return None
    logs = motions.log_ratios(measure)
    known, spread = _site_velocity(motions, measure, site)
    weight, error, *coefficients = _fit_of_velocity(
        outcomes, logs, jackknifes=known is not None
    )
    if math.isnan(weight):
        return None
    shift = weight * spread
    if known is not None:
        wanted = known.log_ratio(outcomes.intensity_levels.levels)
        middle = float(np.median(logs))
        shift = shift_by_velocity(weight, spread, error, wanted, middle)
    return Conversion(
        measure=measure,
        coefficients=tuple(coefficients),
        weight=weight,
        error=error,
        logs=logs,
        known=known,
        spread=spread,
        shift=shift,
        by_statics=by_statics,
    )


def published_velocity(
    measure: IntensityMeasure, given: Records
) -> PublishedVelocity | None:
    """What is published of the velocity with a measure at a site; None for measures and motions that it is not of.

    Motions that a user chose have the velocity of the site, unless something else is said of it.
    """
    stated = any(map(math.isfinite, _facts(given)))
    if given.on_floor or (given.paths and not stated):
        return None
    return PublishedVelocity.of(measure, given)


def _site_velocity(
    motions: MotionSet, measure: IntensityMeasure, site: Site
) -> tuple[SiteVelocity | None, float]:
    """What is known of the velocity at the site, and the standard deviation of the mean of ln ratio [-].

    In this order: a hazard curve of PGV, PGV of the level, SA(1 s) of the level, a published relation, and how
    velocity follows the earthquakes of the set. None where nothing is known.
    """
    given, level, curves = site.given, site.level, site.curves
    logs = motions.log_ratios(measure, of_all=True)
    relation = VelocityRelation.of(motions.about, logs)
    own = math.sqrt(1 - OF_THE_SITE) * relation.scatter
    if len(curves) > 1:
        return SiteVelocity(relation.scatter, curves=curves), 0.0
    if math.isfinite(level.pgv):
        # of a hazard curve other levels count too, with velocities of their own
        return SiteVelocity.from_level(level, own if curves else 0.0), 0.0
    if math.isfinite(level.sa_1s):
        spectrum = VelocityBySpectrum.of(motions, measure)
        within = math.sqrt(1 - OF_THE_SITE) * spectrum.scatter
        mean = spectrum.mean(level.sa_1s / level.value)
        return SiteVelocity(within, mean), math.sqrt(OF_THE_SITE) * spectrum.scatter
    published = published_velocity(measure, given)
    if published is not None:
        lines = published.lines(given)
        spread = spread_of_mean(level.value, published.of_site, lines)
        known = SiteVelocity(
            published.within, published=published, line=lines[:1].copy()
        )
        return known, spread
    if not any(map(math.isfinite, _facts(given))):
        # what differs about the relation is in the motions, once
        return None, relation.unknown(given, of_site=False)
    return SiteVelocity(own, relation.mean(given)), relation.unknown(given)


def _fit_of_velocity(
    outcomes: ObjectOutcomes, logs: Floats, *, jackknifes: bool
) -> list[float]:
    """Weight of ln ratio, its standard error if ``jackknifes``, and three coefficients (``fill_weight``) [-].

    The weight is NaN where the outcomes allow no fit.
    """
    levels = outcomes.intensity_levels
    numbers = earthquake_numbers(outcomes.earthquakes).astype(np.int64)
    tests, found = np.zeros((logs.size * MOST_LEVELS, MEMORY)), np.zeros(5)
    fill_weight(
        levels.levels,
        np.ascontiguousarray(levels.allowed),
        np.ascontiguousarray(outcomes.overturned),
        logs,
        numbers,
        jackknifes,
        tests,
        np.zeros(STATE),
        found,
    )
    values: list[float] = found.tolist()
    return values


@dataclass(frozen=True)
class VelocityBySpectrum:
    """How ln (PGV over a measure) follows ln of SA(1 s) over it among the records of a set."""

    coefficients: tuple[float, float]  # Of 1 and ln SA(1 s) over the measure
    scatter: float  # Standard deviation about the relation [-]

    @classmethod
    def of(cls, motions: MotionSet, measure: IntensityMeasure) -> "VelocityBySpectrum":
        """Fit it to the motions among which those of a set were chosen."""
        spectral = motions.log_over(SA_1S, measure)
        logs = motions.log_ratios(measure, of_all=True)
        slope, start = (
            np.polyfit(spectral, logs, 1) if logs.size > 2 else (0.0, logs[0])
        )
        rest = logs - start - slope * spectral
        return cls((float(start), float(slope)), float(rest.std()))

    def mean(self, ratio: float) -> float:
        """Mean of ln (PGV over the measure [s]) where SA(1 s) over it is known."""
        start, slope = self.coefficients
        return start + slope * math.log(ratio)


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
        """Fit the relation to the records of a set, by least squares; motions of one record count as one.

        Parameters
        ----------
        about : of each motion, what is known of its record: ``earthquake``, ``station``, ``magnitude``,
            ``distance_km``, ``vs30_m_s``
        logs : its ln (PGV over the measure), shape (motions,)
        """
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
    """Magnitude, ln distance (distance in km) and ln Vs30 (in m/s) of a site; NaN where not known."""
    distance = math.log(max(given.distance_km, 1.0))
    return given.magnitude, distance, math.log(given.vs30)


def _number(about: Mapping[str, object], key: str) -> float:
    """A number that is known of a record and above 0, NaN where none is."""
    value = about.get(key)
    return float(value) if isinstance(value, int | float) and value > 0 else math.nan
