"""The objects of an inventory after an earthquake: how probably each fell, and how probably it rocked and stands.

In goes the inventory that ``rockfrag assess`` reads, with coordinates or all at one place, and what shook the
ground (:mod:`rockfrag.aftermath.shaken_ground`). Each object is assessed at its level as ``rockfrag assess`` does,
over all that the level may have been; out comes a list, the most likely fallen first. Theory: ``docs/after.md``.
"""

import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.aftermath.sequence import in_either, one_after_the_other
from rockfrag.aftermath.shaken_ground import GroundShaking, level_of
from rockfrag.assess.answer import RECORDS, Assessment
from rockfrag.assess.core.estimates import INSIDE
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.inventory import assess_each, check_rows, read_inventory
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import Shaking
from rockfrag.assess.request import Request
from rockfrag.assess.risk import Estimate
from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.runtime.progress import Progress
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.words.catalogue import catalogue

Ground = Callable[[tuple[float, float] | None], GroundShaking | None]
"""What shook a place by its coordinates, which are None where all objects are in one place; None where nothing is
known."""

LOOK_FIRST = 0.5  # Probability of a fall from which an object is looked at first
LOOK_AT_FEET = 0.5  # Probability of having moved from which its feet are looked at
NOT_TOUCHED = 0.05  # Probability of having moved at all below which it can wait


@dataclass(frozen=True)
class WhereLeft:
    """Where a record left an object that stands: turned about the vertical [degrees], and moved [cm]."""

    turned_deg: float
    moved_cm: float


@dataclass(frozen=True, eq=False)
class ShakenObject:
    """An object after an earthquake.

    Attributes
    ----------
    found : its assessment at the level that shook its place
    ground : what shook its place
    under_record : id of the text that says what the record itself does to it; empty without one
    then : its assessment at the level of a second shock; None without one
    ground_then : what shook its place the second time; None where nothing is known of it
    left : where the record, or both, left an object in space that stands; None where that is not known
    """

    found: Assessment
    ground: GroundShaking
    under_record: str = ""
    then: Assessment | None = None
    ground_then: GroundShaking | None = None
    left: WhereLeft | None = None

    @property
    def request(self) -> Request:
        """What the object is, and where."""
        return self.found.request

    @cached_property
    def falls(self) -> tuple[float, float, float]:
        """Probability that it fell, with its limits for what is not known of object and model (90 %) [-]."""
        return _in_all(self.found.fraction, self.then.fraction if self.then else None)

    @property
    def fell(self) -> float:
        """Probability that it fell [-]."""
        return self.falls[0]

    @property
    def limits(self) -> tuple[float, float]:
        """Limits of the probability that it fell [-]."""
        return self.falls[1:]

    @cached_property
    def moved(self) -> float:
        """Probability that it rocked, or walked as it did, and still stands [-]."""
        rocked, *_ = _in_all(
            self.found.rocking, self.then.rocking if self.then else None
        )
        return max(rocked - self.fell, 0.0)

    @property
    def what_to_do(self) -> str:
        """Id of the text that says what to look at."""
        if self.fell >= LOOK_FIRST:
            return "after_look_first"
        if self.fell + self.moved >= LOOK_AT_FEET:
            return "after_look_at_feet"
        if self.fell + self.moved >= NOT_TOUCHED:
            return "after_look_later"
        return "after_can_wait"


def _in_all(
    first: Estimate | None, then: Estimate | None
) -> tuple[float, float, float]:
    """A probability in one shock, or in either of two, with its lower and upper limit [-]."""
    assert first is not None
    if then is None:
        return first.value, first.lower, first.upper
    draws = in_either(first.draws, then.draws)
    value = float(draws.mean())
    low, high = np.quantile(draws, [(1 - INSIDE) / 2, (1 + INSIDE) / 2]).tolist()
    return value, min(low, value), max(high, value)


@dataclass(frozen=True, eq=False)
class ShakenCollection:
    """Objects after an earthquake.

    Attributes
    ----------
    objects : the most likely fallen first, then the most likely moved
    motions : the ground motions by which they were assessed
    beyond : names of the objects in places of which the map says nothing
    then_beyond : names of those in places of which the map of the second shock says nothing
    faults : what is wrong with the rows that were left out, a sentence each
    """

    objects: Sequence[ShakenObject]
    motions: MotionSet
    beyond: Sequence[str] = ()
    then_beyond: Sequence[str] = ()
    faults: Sequence[str] = ()

    @property
    def expected_falls(self) -> float:
        """Mean number of objects that fell."""
        return sum(each.fell for each in self.objects)


def after_earthquake(
    path: str | os.PathLike[str],
    ground: Ground,
    shared: Mapping[str, Any] | None = None,
    records: str | Path = RECORDS,
    *,
    recorded: Sequence[Motion] = (),
    then: Ground | None = None,
    then_recorded: Sequence[Motion] = (),
    keep_going: bool = False,
    order: str = "",
    progress: Progress | None = None,
) -> ShakenCollection:
    """Say of each object of an inventory how probably an earthquake felled it, and rocked it.

    Parameters
    ----------
    path : table of objects as of ``rockfrag assess``; ``latitude`` and ``longitude`` say where each is
    ground : what shook a place
    shared : keys of ``statue.yaml`` that hold for all, such as ``floor``
    records : folder of fetched records
    recorded : components of the record of the place, if there is one: what it does to each is said too
    then, then_recorded : the same of a second shock; None and empty without one
    keep_going : list the rows that are right where others are not
    order : of lengths that a museum's table does not name, such as ``HWD``
    progress : called with the number of objects done and of all, those of a second shock counted again

    Returns
    -------
    The objects, the most likely fallen first.

    Raises
    ------
    InputError
        If a row is wrong, or nothing is known of the shaking of any object.
    """
    requests, faults = read_inventory(path, shared or {}, order=order)
    check_rows(requests, faults, keep_going)
    shaken, beyond = _shaken_by(ground, requests)
    if not shaken:
        raise InputError(
            f"{path}: nothing is known of the shaking of any object; the map does not reach their coordinates."
        )
    motions = motion_set(requests[0].records, requests[0].place, Path(records))
    again, beyond_then = _shaken_by(then, [request for request, _ in shaken])
    # both shocks at once: progress counts to the end
    every = [_asked(*each) for each in (*shaken, *again)]
    assessed_each = assess_each(every, motions, progress)
    found, found_then = assessed_each[: len(shaken)], assessed_each[len(shaken) :]
    second = {
        each.name: (assessed, here)
        for (each, here), assessed in zip(again, found_then, strict=True)
    }
    both = one_after_the_other(recorded, then_recorded) if then_recorded else ()
    objects = []
    for (request, here), assessed in zip(shaken, found, strict=True):
        later, there = second.get(request.name, (None, None))
        fate, left = _under_records(request, recorded, both)
        objects.append(ShakenObject(assessed, here, fate, later, there, left))
    objects.sort(key=lambda each: (each.fell, each.moved), reverse=True)
    return ShakenCollection(
        objects, motions, beyond, beyond_then if then else (), faults
    )


def _shaken_by(
    ground: Ground | None, requests: Sequence[Request]
) -> tuple[list[tuple[Request, GroundShaking]], list[str]]:
    """Objects with what shook their places, and the names of those in places of which nothing is known."""
    places = [(each, ground(each.coordinates) if ground else None) for each in requests]
    shaken = [(each, here) for each, here in places if here is not None]
    return shaken, [each.name for each, here in places if here is None]


FELL, FELL_THEN = "after_record_fell", "after_record_fell_then"
ROCKED, STOOD = "after_record_rocked", "after_record_stood"
"""Ids of the texts that say what a record does to an object; ``FELL_THEN``: not before the second shock."""


def _under_records(
    request: Request, first: Sequence[Motion], both: Sequence[Motion]
) -> tuple[str, WhereLeft | None]:
    """What the record of the place does to an object, and where it leaves one that rocked and still stands.

    Parameters
    ----------
    request : the object
    first : one or two horizontal components of the first shock; none without a record
    both : likewise of both shocks in a row; empty where there was one shock

    Returns
    -------
    Id of the text, empty without a record; where the object is left, None unless it rocked and stands.
    """
    fate = _under_record(request, first, both)
    if fate != ROCKED:
        return fate, None
    return fate, _where_left(request, both or first)


def _under_record(
    request: Request, recorded: Sequence[Motion], both: Sequence[Motion]
) -> str:
    """Id of the text that says what the record of the place does to an object; empty without one."""
    if not recorded:
        return ""
    alone = _fate(request, recorded)
    if not both or alone == FELL:
        return alone
    in_sequence = _fate(request, both)
    return FELL_THEN if in_sequence == FELL else in_sequence


def _fate(request: Request, recorded: Sequence[Motion]) -> str:
    """What a record does to an object, as the id of its text."""
    with warnings.catch_warnings():
        # the unit of a weak record has been read from its file
        warnings.simplefilter("ignore", UnitWarning)
        (found,) = _as_recorded(request, recorded).outcomes_of([request.objects])
    if found.overturned.any():
        return FELL
    return ROCKED if found.rocked.any() else STOOD


def _as_recorded(request: Request, recorded: Sequence[Motion]) -> Shaking:
    """A record as it is, at the place of an object."""
    pairs = ((0, 1),) if len(recorded) == 2 else ()
    motions = MotionSet(tuple(recorded), tuple(recorded), pairs, "")
    if request.objects.in_space and pairs:
        motions = motions.with_both_components()
    as_recorded = np.ones((len(recorded), 1))
    counted = np.ones(as_recorded.shape, dtype=np.bool_)
    shaking = Shaking(PGA, np.ones(1), as_recorded, counted, motions)
    return shaking.at(request.place)


def _where_left(request: Request, recorded: Sequence[Motion]) -> WhereLeft | None:
    """Where a record of two components leaves an object that is known in space; None of others."""
    shaking, objects = _as_recorded(request, recorded), request.objects
    solid = objects.solid(objects.body)
    if solid is None or not shaking.motions.both:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnitWarning)
        _, found = shaking.outcomes_of_system(objects.held(solid))
    turn, walk = found.turn[0, 0, 0, 0], found.walk[0, 0, 0, 0]
    return WhereLeft(abs(math.degrees(turn)), 100 * float(walk))


def _asked(request: Request, ground: GroundShaking) -> Request:
    """An object at the level that shook its place; where PGV is not known the earthquake says more of it."""
    records = request.records
    if math.isnan(ground.pgv) and math.isnan(records.magnitude):
        records = replace(
            records, magnitude=ground.magnitude, distance_km=ground.distance_km
        )
    return replace(request, level=level_of(ground), hazard=(), records=records)


def shaken_table(collection: ShakenCollection) -> pd.DataFrame:
    """Make a row an object, in the order in which they are looked at.

    Parameters
    ----------
    collection : the objects after the earthquake

    Returns
    -------
    Columns ``rank``, ``name``, ``place``, ``latitude``, ``longitude`` [degrees], ``pga_g``, ``pgv_cm_s``,
    ``probability_fell`` with its limits, ``probability_rocked_and_stands`` [-], ``look``; after a second shock
    ``probability_fell_in_the_first``, ``then_pga_g`` and ``then_pgv_cm_s``; and, where a record was given,
    ``under_the_record``, in space with ``turned_deg`` and ``moved_cm``.
    """
    texts = catalogue()
    rows = []
    for rank, each in enumerate(collection.objects, start=1):
        latitude, longitude = each.request.coordinates or (math.nan, math.nan)
        lower, upper = each.limits
        row: dict[str, Any] = {
            "rank": rank,
            "name": each.request.name,
            "place": texts.say(each.request.where),
            "latitude": latitude,
            "longitude": longitude,
            "pga_g": each.ground.pga,
            "pgv_cm_s": each.ground.pgv,
            "probability_fell": each.fell,
            "probability_fell_lower": lower,
            "probability_fell_upper": upper,
            "probability_rocked_and_stands": each.moved,
            "look": texts.text(each.what_to_do),
        }
        if each.then is not None and each.found.fraction is not None:
            row["probability_fell_in_the_first"] = each.found.fraction.value
        if each.ground_then is not None:
            row["then_pga_g"] = each.ground_then.pga
            row["then_pgv_cm_s"] = each.ground_then.pgv
        if each.under_record:
            row["under_the_record"] = texts.text(each.under_record)
        if each.left is not None:
            row["turned_deg"] = each.left.turned_deg
            row["moved_cm"] = each.left.moved_cm
        rows.append(row)
    return pd.DataFrame(rows).dropna(axis="columns", how="all")
