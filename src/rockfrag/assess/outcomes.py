"""Which motions topple a body at which level of shaking: fractions of motions, no curve assumed.

In: systems, motions and levels of a measure. Out: states by motion and level.
Docs: ``docs/assess.md``, "What is computed".
"""

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from rockfrag.assess.core.fractions import fill_counted, fill_uplifts
from rockfrag.assess.core.scales import fill_factors, fill_scales
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.place import Place
from rockfrag.assess.standing import Standing
from rockfrag.assess.statics import lifting_in_plane, lifting_in_space
from rockfrag.base.arrays import Flags, Floats
from rockfrag.engines.spatial.body import PERTURBATION
from rockfrag.fragility.empirical import wilson_interval
from rockfrag.fragility.observations import Observations
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS, limit_states
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.runtime.progress import Meter
from rockfrag.simulation.ensemble import LightBodies, overturns
from rockfrag.system.blocks import Body
from rockfrag.system.contact import Friction
from rockfrag.system.system import System

LEVELS = 80  # Levels of shaking that are tried, a constant factor apart
FEW_LEVELS = 28  # Levels for what is only compared, and for many objects
# Levels for what is only compared of many objects, and for what moves a property in space
FEWEST_LEVELS = 14
# Tests that are simulated at once, which bounds the memory of their results
MOST_TESTS = 400_000
# About how long a core takes for one history, by what moves: one body or two that only rock, contacts that open
# and slide (for each body), a body in space, a held one (for the cube of the bodies) [s]; what is said of time and
# progress rests on it
SECONDS = {"rocks": 2e-5, "contact": 4e-4, "space": 4e-4, "held": 3e-3}
# Work that is done at once where each history takes long, so that it can be said how far it is [s]
MOST_SECONDS = 3.0
# Lowest and highest level over the median of the motions as recorded
RANGE = (0.05, 8.0)

STEP_DEG = 15  # Angle between directions that are tried [degrees]

Key = TypeVar("Key")  # By which bodies are told apart


@dataclass(frozen=True, eq=False)
class IntensityLevels:
    """Levels of a measure to which motions are scaled."""

    measure: IntensityMeasure  # The intensity measure of the ground
    levels: Floats  # Levels in its unit, rising, shape (levels,)
    scales: Floats  # Factors on the motions, shape (motions, levels)
    # Whether a factor is within ``LARGEST_FACTOR`` and a floor may feel the motion, shape (motions, levels)
    allowed: NDArray[np.bool_]

    def place_of(self, level: float) -> int:
        """Place of the first level that is not below one that is given; of the last one where all are."""
        return min(int(self.levels.searchsorted(level)), self.levels.size - 1)


def make_intensity_levels(
    motions: MotionSet,
    measure: IntensityMeasure,
    asked: Sequence[float] = (),
    count: int = LEVELS,
) -> "Shaking":
    """Make levels for a set of motions, a constant factor apart, and those that are asked for exactly.

    Parameters
    ----------
    motions, measure : the set, and the measure of the levels
    asked : further levels, in the measure's unit
    count : number of levels

    Returns
    -------
    The motions at their levels.
    """
    middle = motions.median(measure)
    levels = np.geomspace(RANGE[0] * middle, RANGE[1] * middle, count)
    levels = np.unique(np.append(levels, list(asked)))
    return scaled_to(levels, motions, measure, peaks_of(motions.base))


def peaks_of(shaking: Sequence[Motion]) -> Floats:
    """Peak acceleration of each motion [m/s²], shape (motions,)."""
    return np.array([motion.pga for motion in shaking])


def scaled_to(
    levels: Floats,
    motions: MotionSet,
    measure: IntensityMeasure,
    peaks: Floats | None = None,
) -> "Shaking":
    """Levels in the measure's unit, shape (levels,), as far as motions may be scaled to them.

    ``peaks`` are those of what shakes an object, shape (motions,) [m/s²], if what it feels has to be believed.
    """
    values = motions.values(measure)
    scales = np.zeros((values.size, levels.size))
    allowed = np.zeros(scales.shape, dtype=np.bool_)
    fill_scales(
        levels,
        values,
        np.zeros(values.size) if peaks is None else peaks,
        scales,
        allowed,
    )
    return Shaking(measure, levels, scales, allowed, motions)


@dataclass(frozen=True, eq=False)
class ObjectOutcomes:
    """What happened to one body."""

    intensity_levels: IntensityLevels  # The levels
    # Outcomes, shape (motions, levels)
    overturned: NDArray[np.bool_]
    rocked: NDArray[np.bool_]
    earthquakes: NDArray[np.object_]  # Earthquake of each motion, shape (motions,)
    # Whether it may have left the ground, which the model holds shut
    light: bool = False
    # Which cases reached each other declared limit state, by its name, shape (motions, levels) each
    others: Mapping[str, NDArray[np.bool_]] = field(default_factory=dict)
    # Level at which each motion lifts the body, by statics, shape (motions,); None if only outcomes say
    lifting: Floats | None = None

    def lifts_from(self) -> Floats:
        """Level at which each motion lifts the body; infinite where none of the levels does, shape (motions,)."""
        lifting = self.lifting
        if lifting is None:
            lifting = np.full(len(self.overturned), np.inf)
        found = np.zeros(len(self.overturned))
        fill_uplifts(
            self.intensity_levels.levels,
            *map(np.ascontiguousarray, (self.rocked, self.overturned)),
            np.ascontiguousarray(self.intensity_levels.allowed),
            np.ascontiguousarray(lifting, dtype=np.float64),
            found,
        )
        return found

    def fractions(
        self, weights: Floats | None = None, *, state: str = OVERTURNS
    ) -> Floats:
        """Fraction of the motions that bring the body into a limit state at each level, shape (levels,).

        A motion that cannot be scaled so far is left out of a level; where none can, the fraction of the nearest
        level below is kept, and nothing happens below the lowest level. Weights of the motions have the shape
        (motions,); all alike if None.
        """
        w = np.ones(len(self.overturned)) if weights is None else weights
        reached = {OVERTURNS: self.overturned, ROCKS: self.rocked, **self.others}
        happened, found = reached[state], np.zeros(self.intensity_levels.levels.size)
        fill_counted(
            np.ascontiguousarray(happened),
            np.ascontiguousarray(self.intensity_levels.allowed),
            np.ascontiguousarray(w, dtype=np.float64),
            found,
        )
        return found

    def band(self) -> tuple[Floats, Floats]:
        """Limits of the fraction at each level that as few earthquakes leave open (90 %), shape (levels,) each.

        Wilson's interval (1927) of the fraction with the earthquakes as the number of trials, since motions of one
        earthquake are alike; it stays within 0 and 1.
        """
        p, n = self.fractions(), len(set(self.earthquakes))
        low, high = wilson_interval(p * n, np.full(p.size, n))
        # what does not rock cannot topple
        rocks = self.fractions(state=ROCKS) > 0
        return np.where(p > 0, low, 0.0), np.where(rocks, high, 0.0)

    def first(self) -> NDArray[np.intp]:
        """Place of the least level allowed at which each motion topples the body, or -1, shape (motions,)."""
        fell = self.overturned & self.intensity_levels.allowed
        return np.where(fell.any(axis=1), fell.argmax(axis=1), -1)

    def first_levels(self) -> Floats:
        """Least level at which each motion topples the body, infinite where none does, shape (motions,)."""
        first = self.first()
        return np.where(first >= 0, self.intensity_levels.levels[first], np.inf)

    def joined(self, other: "ObjectOutcomes") -> "ObjectOutcomes":
        """What happens in one of two answers about the same motions."""
        return replace(
            self,
            overturned=self.overturned | other.overturned,
            rocked=self.rocked | other.rocked,
            others={
                name: self._reached(name) | other._reached(name)
                for name in {**self.others, **other.others}
            },
            lifting=np.minimum(self.lifts_from(), other.lifts_from()),
        )

    def _reached(self, state: str) -> NDArray[np.bool_]:
        """Cases that reach a declared limit state; what no case reaches short of a fall only falls do."""
        return self.others.get(state, self.overturned)

    def outcomes(self) -> Observations:
        """All tests with their level, as :mod:`rockfrag.fragility` fits them."""
        motion, level = np.nonzero(self.intensity_levels.allowed)
        return Observations(
            im=self.intensity_levels.levels[level],
            overturned=self.overturned[motion, level].astype(np.float64),
            trials=np.ones(motion.size),
            motion=motion.astype(object),
            earthquake=self.earthquakes[motion],
            name=self.intensity_levels.measure.imt,
            unit=self.intensity_levels.measure.unit,
        )


@dataclass(frozen=True, eq=False)
class Shaking(IntensityLevels):
    """Motions at all their levels, by which objects are shaken."""

    motions: MotionSet

    def at(self, place: Place) -> "Shaking":
        """The same levels of the ground at another place."""
        return replace(self, motions=self.motions.at(place))

    def outcomes_of(
        self, objects: Sequence[Standing], meter: Meter | None = None
    ) -> list[ObjectOutcomes]:
        """Shake several objects as they stand by every motion at every level."""
        bodies = [{"": object_.body} for object_ in objects]
        return [found[""] for found in self.outcomes_of_each(objects, bodies, meter)]

    def seconds_of(self, objects: Standing) -> float:
        """About how long a core takes to shake one body of an object [s]."""
        kind = "rocks"
        if self.motions.both and objects.in_space:
            kind = "space"
        elif objects.many:
            kind = "contact"
        bodies = 1 + len(objects.pedestals) if objects.many else 1
        each = [holder.seconds for holder in objects.under.holders]
        return self.scales.size * bodies * max(SECONDS[kind], *each, 0.0)

    def outcomes_of_each(
        self,
        objects: Sequence[Standing],
        bodies: Sequence[Mapping[Key, Body]],
        meter: Meter | None = None,
    ) -> list[dict[Key, ObjectOutcomes]]:
        """Shake several bodies of each of several objects by every motion at every level.

        So many at once are shaken as memory and patience allow.

        Parameters
        ----------
        objects : as they stand
        bodies : of each object, by a key
        meter : is told the seconds that are done

        Returns
        -------
        Outcomes of each object by the keys of its bodies.
        """
        every = [
            (object_, body)
            for object_, named in zip(objects, bodies, strict=True)
            for body in named.values()
        ]
        most = MOST_TESTS // self.scales.size
        slowest = max(map(self.seconds_of, objects), default=0.0)
        if slowest > self.scales.size * SECONDS["rocks"]:
            most = min(most, int(MOST_SECONDS / slowest))
        most = max(1, most)
        shaken = []
        for start in range(0, len(every), most):
            part = every[start : start + most]
            shaken += self._shaken(part)
            if meter is not None:
                meter.add(sum(self.seconds_of(object_) for object_, _ in part))
        each = iter(shaken)
        return [{name: next(each) for name in named} for named in bodies]

    def _shaken(self, every: Sequence[tuple[Standing, Body]]) -> list[ObjectOutcomes]:
        """Outcomes in space where both components act and a body is known in space, in a plane elsewhere.

        On a pedestal that may lift both answers count: what falls in either falls. Planar answers of round bases
        are those of the worst direction of each record.
        """
        systems = [object_.held(object_.system_of(body)) for object_, body in every]
        if not self.motions.both:
            return self._in_plane(systems)
        solids = [
            solid and object_.held(solid)
            for object_, body in every
            for solid in [object_.solid(body)]
        ]
        planar = [
            i for i, solid in enumerate(solids) if solid is None or systems[i].count > 1
        ]
        found: dict[int, ObjectOutcomes] = {}
        for all_sides, shake in (
            (True, self._from_all_sides),
            (False, self._in_plane),
        ):
            some = [i for i in planar if every[i][0].from_all_sides is all_sides]
            found |= zip(some, shake([systems[i] for i in some]), strict=True)
        for i, body in enumerate(solids):
            if body is not None:
                solid = self.in_space(body, every[i][0].base_spread)
                found[i] = found[i].joined(solid) if i in found else solid
        return [found[i] for i in range(len(systems))]

    def _in_plane(self, systems: Sequence[System]) -> list[ObjectOutcomes]:
        """Outcomes of planar bodies, by components as recorded."""
        if not systems:
            return []
        base = self.motions.base
        lifting = [lifting_in_plane(system, base) for system in systems]
        result, light = simulated(systems, base, self._factors(base))
        return self._each_system(states_of(result), light, lifting=lifting)

    def _from_all_sides(self, systems: Sequence[System]) -> list[ObjectOutcomes]:
        """Outcomes by records, each in its worst direction of half a turn; both components get those."""
        if not systems:
            return []
        motions = self.motions
        records = [
            motions.turned(record, range(0, 180, STEP_DEG))
            for record in motions.records
        ]
        shaking = [motion for turned in records for motion in turned]
        of_row = np.repeat(np.arange(len(records)), [len(turned) for turned in records])
        first = [record[0] for record in motions.records]
        result, light = simulated(
            systems, shaking, self._factors(shaking, np.take(first, of_row))
        )
        # where the directions of each record begin; the easiest of them lifts the object
        starts = np.flatnonzero(np.diff(of_row, prepend=-1))
        lifting = [
            np.minimum.reduceat(lifting_in_plane(system, shaking), starts)
            for system in systems
        ]
        return self._each_system(states_of(result), light, of_row, lifting=lifting)

    def in_space(self, body: System, spread: float) -> ObjectOutcomes:
        """Outcomes of a body in space under both components of each record, where it has two.

        Corners of its base lie elsewhere by ``spread`` over its extent, and it is turned by up to as many radians.
        """
        shaking, scales = self._records()
        lifting = lifting_in_space(body, shaking)
        result = overturns([body], shaking, scales=scales, spread=spread)
        states = states_of(result)
        of_row = np.arange(len(scales))
        return self._each_system(states, of_row=of_row, lifting=[lifting])[0]

    def _records(self) -> tuple[list[GroundMotion], Floats]:
        """All components of each record, in the order of the records, and factors on them, (records, levels).

        A record is the numbers of its components among the motions; the first stands for it in levels and peaks.
        One without a second component gets one that is zero.
        """
        motions = self.motions
        shaking = [
            GroundMotion(*motions.components(record)).with_second()
            for record in motions.records
        ]
        first = [record[0] for record in motions.records]
        return shaking, self._factors([motions.base[i] for i in first], first)

    def outcomes_of_system(self, system: System) -> tuple[ObjectOutcomes, Outcomes]:
        """Outcomes of one system, and all that its simulation says.

        Parameters
        ----------
        system : shaken by both components where it is known in space, else by one

        Returns
        -------
        What becomes of it, and the outcomes of the system under motions, or records, at the levels.
        """
        if system.planar:
            base = self.motions.base
            result, light = simulated([system], base, self._factors(base))
            lifting = [lifting_in_plane(system, base)]
            found = self._each_system(states_of(result), light, lifting=lifting)
            return found[0], result
        shaking, scales = self._records()
        result = overturns([system], shaking, scales=scales)
        lifting = [lifting_in_space(system, shaking)]
        rows = np.arange(len(scales))
        found = self._each_system(states_of(result), of_row=rows, lifting=lifting)
        return found[0], result

    def on_pad(
        self, objects: Standing, friction: float
    ) -> tuple[ObjectOutcomes, Floats]:
        """Outcomes of the object on a pad on which it may slide, and how far it does.

        Parameters
        ----------
        objects : the object
        friction : coefficient of the pad [-]

        Returns
        -------
        The outcomes, and the largest slip [m], shape (motions, levels).
        """
        system = objects.system_of(objects.body)
        system = system.with_friction(Friction(friction, friction), at=-1)
        base = self.motions.base
        result = overturns(system, base, scales=self._factors(base))
        lifting = [lifting_in_plane(system, base)]
        (found,) = self._each_system(states_of(result), lifting=lifting)
        return found, result.peak_slip[0, ..., -1]

    def _factors(self, shaking: Sequence[Motion], rows: Any = slice(None)) -> Floats:
        """Factors on what shakes, shape (rows, levels); next to none where a case is not counted.

        ``shaking``: motions; ``rows``: numbers of the rows of the levels that they are of.
        """
        scales = np.ascontiguousarray(self.scales[rows])
        return _factors(scales, np.ascontiguousarray(self.allowed[rows]), shaking)

    def _each_system(
        self,
        states: Mapping[str, Flags],
        light: Sequence[bool] = (False,),
        of_row: NDArray[np.intp] | None = None,
        *,
        lifting: Sequence[Floats],
    ) -> list[ObjectOutcomes]:
        """Outcomes of each system, which cannot slide.

        What happens to a record in one of its directions happens.

        Parameters
        ----------
        states : whether each limit state was reached, shape (systems, motions, levels), by its name
        light : whether each system may have left the ground
        of_row : number of the record of each motion, where several may be of one; None for motions by themselves
        lifting : factors on motions, or on records, that lift each system
        """
        recorded = self.motions.values(self.measure)
        if of_row is not None:
            place = self.motions.place_of_record()
            lifting = [factors[place] for factors in lifting]
            starts = np.flatnonzero(np.diff(of_row, prepend=-1))
            states = {
                name: np.logical_or.reduceat(cases, starts, axis=1)[:, place]
                for name, cases in states.items()
            }
        found = []
        for i, may_fly in enumerate(light):
            own = {name: cases[i] for name, cases in states.items()}
            fell, rocked = own.pop(OVERTURNS), own.pop(ROCKS)
            earthquakes = self.motions.earthquakes
            found.append(
                ObjectOutcomes(
                    self,
                    fell,
                    rocked,
                    earthquakes,
                    may_fly,
                    own,
                    lifting=lifting[i] * recorded,
                )
            )
        return found

    def flip_rate(self, objects: Standing) -> float:
        """Fraction of the outcomes in space that a perturbation turns round [-]; NaN without any."""
        solid = objects.solid(objects.body)
        if solid is None or not self.allowed.any():
            return math.nan
        first = self.in_space(solid, objects.base_spread)
        other = self.in_space(solid, objects.base_spread + PERTURBATION)
        differs = first.overturned != other.overturned
        return float(differs[self.allowed].mean())

    def fraction_with_sliding(self, objects: Standing) -> float:
        """Fraction of the motions at the first level that topple the object if it may slide, which takes long."""
        motions, allowed = self.motions, self.allowed[:, 0]
        solid = objects.solid(objects.body) if motions.both else None
        if solid is not None and objects.friction is not None and not objects.pedestals:
            slides = solid.with_friction(Friction(objects.friction, objects.friction))
            return float(self.in_space(slides, objects.base_spread).fractions()[0])
        fallen = overturns(
            objects.system_of(objects.body),
            motions.base,
            scales=_believed(self.scales[:, :1], motions.base),
            friction=objects.friction,
        ).overturned[0, :, 0]
        return float(fallen[allowed].mean())


def _factors(scales: Floats, allowed: Flags, shaking: Sequence[Motion]) -> Floats:
    """Factors that scale each motion to each level, next to none where that case is not counted, (rows, levels).

    ``scales``, ``allowed``: shape (rows, levels); ``shaking``: a motion a row, whose peaks may be no larger than
    is believed.
    """
    factors = np.zeros(scales.shape)
    fill_factors(scales, allowed, peaks_of(shaking), factors)
    return factors


def _believed(scales: Floats, shaking: Sequence[Motion]) -> Floats:
    """Factors on what shakes, of which all count, at most those that are believed, shape (rows, levels)."""
    given = np.ascontiguousarray(scales)
    return _factors(given, np.ones(given.shape, dtype=np.bool_), shaking)


def earthquake_numbers(earthquakes: NDArray[np.object_]) -> NDArray[np.intp]:
    """Number of the earthquake of each motion, in the order in which they come, shape (motions,)."""
    names = list(dict.fromkeys(earthquakes))
    place = {name: number for number, name in enumerate(names)}
    return np.array([place[name] for name in earthquakes], dtype=np.intp)


def fraction_at(
    level: float, levels: Floats, fractions: Floats, shift: float = 0.0
) -> float:
    """Fraction of the motions at a level, between levels by the logarithm; all lie higher by ``shift`` in it.

    NaN where the level is.
    """
    if math.isnan(level):
        return math.nan
    # relative to the asked level: where it is one of the series its logarithm is 0 to the bit
    return float(np.interp(-shift, np.log(levels / level), fractions))


def states_of(result: Outcomes) -> dict[str, Flags]:
    """Which cases reached each limit state that needs no sliding, by its name, and which rocked :data:`FAR`.

    Those of what is held are left out where no case reaches them short of a fall.
    """
    found = {
        state.name: np.asarray(state.reached(result))
        for state in limit_states()
        if not state.slipping and (result.leaning.any() or not state.held)
    }
    with np.errstate(invalid="ignore"):
        found[STEPS] = np.asarray((result.peak_rotation > FAR).any(axis=-1))
    return found


def simulated(
    systems: Sequence[System], shaking: Sequence[Motion], scales: Floats
) -> tuple[Outcomes, list[bool]]:
    """Simulate systems, and say whether some may have left the ground.

    Parameters
    ----------
    systems, shaking : what is shaken, and by what
    scales : factors on the motions, shape (motions, levels)

    Returns
    -------
    The outcomes, and for each system whether pure rocking may be no answer: all of one and two bodies, if pure
    rocking warns of any, as it does not say of which.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", LightBodies)
        result = overturns(systems, shaking, scales=scales)
    light = False
    for warning in caught:
        if issubclass(warning.category, LightBodies):
            light = True
        else:
            warnings.warn_explicit(
                warning.message,
                warning.category,
                filename=warning.filename,
                lineno=warning.lineno,
            )
    # more than two bodies leave the ground where they have to
    return result, [light and system.count < 3 for system in systems]


FAR, STEPS = 1 / 3, "rocks_a_third_of_the_way"
"""Rotation over the critical angle beyond which edges chip and an object steps aside (after D'Angela et al., 2026,
whose limit states are rotations), and the name of that state.  In space it is told of the levels of the scan."""


@dataclass(frozen=True)
class Directions:
    """Fraction of the records that topple the object, by how it stands to them."""

    # Level that topples half of the records in their worst direction over that in any one [-]; NaN without
    factor: float
    # Of records in all directions, and in their worst one, that topple the object at the level; NaN without
    fraction: float
    worst_fraction: float
    records: int  # Number of records with two components


def find_directions(
    objects: Standing,
    motions: MotionSet,
    measure: IntensityMeasure,
    level: float | None,
) -> Directions | None:
    """Compare the directions from which records of two components may come; None where no record has two.

    Every record is turned by steps of ``STEP_DEG`` about the vertical; levels are of the geometric mean of its
    components, whatever the direction.

    Parameters
    ----------
    objects, motions : the object, and the records
    measure, level : of the shaking; the level in its unit, None without one
    """
    if not motions.pairs:
        return None
    asked = [] if level is None else [level]
    levels = make_intensity_levels(motions, measure, asked, FEW_LEVELS).levels
    system = objects.system_of(objects.body)
    # opposite directions are alike to a system that is alike on both sides
    upright = all(contact.tilt == contact.offset[0] == 0 for contact in system.contacts)
    symmetric = upright and all(shape.x == 0 for shape in system.shapes)
    angles = range(0, 180 if symmetric else 360, STEP_DEG)
    shaking = [
        motion for pair in motions.pairs for motion in motions.turned(pair, angles)
    ]
    first = np.repeat([pair[0] for pair in motions.pairs], len(angles))
    scales = scaled_to(levels, motions.with_both_components(), measure).scales[first]
    found, _ = simulated([system], shaking, _believed(scales, shaking))
    fallen = found.overturned[0]
    by_record = fallen.reshape(len(motions.pairs), len(angles), -1)
    # fractions that topple at each level: of all directions, and of records in their worst one
    anyhow, worst = by_record.mean(axis=(0, 1)), by_record.any(axis=1).mean(axis=0)
    x = np.log(levels)
    at = math.nan if level is None else level
    return Directions(
        factor=float(np.exp(_half(x, worst) - _half(x, anyhow))),
        fraction=fraction_at(at, levels, anyhow),
        worst_fraction=fraction_at(at, levels, worst),
        records=len(motions.pairs),
    )


def _half(x: np.ndarray, fraction: np.ndarray) -> float:
    """Where a rising fraction passes one half, in x, NaN where it does not; both of shape (n,), x rising."""
    reached = np.flatnonzero(fraction >= 0.5)
    if not reached.size or reached[0] == 0:
        return float("nan")
    i = int(reached[0])
    return float(np.interp(0.5, fraction[i - 1 : i + 1], x[i - 1 : i + 1]))
