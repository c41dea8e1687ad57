"""The objects of an inventory after an earthquake: how probably each fell, and how probably it rocked and stands.

In goes the inventory that ``rockfrag assess`` reads, with coordinates or all at one place, and what shook the
ground (:mod:`rockfrag.aftermath.shaken_ground`). Each object is assessed at its level as ``rockfrag assess`` does,
over all that the level may have been; out comes a list, the most likely fallen first. Theory: ``docs/after.md``.
"""

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.aftermath.shaken_ground import GroundShaking, level_of
from rockfrag.assess.answer import RECORDS, Assessment, assessed, plan_for, shake_all
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.inventory import FaultyRows, read_inventory
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import Shaking
from rockfrag.assess.request import Request
from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.words.catalogue import catalogue

Ground = Callable[[tuple[float, float] | None], GroundShaking | None]
"""What shook a place by its coordinates, which are None where all objects are in one place; None where nothing is
known."""

LOOK_FIRST = 0.5  # Probability of a fall from which an object is looked at first
LOOK_AT_FEET = 0.5  # Probability of having moved from which its feet are looked at
NOT_TOUCHED = 0.05  # Probability of having moved at all below which it can wait


@dataclass(frozen=True, eq=False)
class ShakenObject:
    """An object after an earthquake.

    Attributes
    ----------
    found : its assessment at the level that shook its place
    ground : what shook its place
    under_record : id of the text that says what the record itself does to it; empty without one
    """

    found: Assessment
    ground: GroundShaking
    under_record: str = ""

    @property
    def request(self) -> Request:
        """What the object is, and where."""
        return self.found.request

    @property
    def fell(self) -> float:
        """Probability that it fell [-]."""
        assert self.found.fraction is not None
        return self.found.fraction.value

    @property
    def limits(self) -> tuple[float, float]:
        """Limits of that probability for what is not known of the object and of the model (90 %) [-]."""
        assert self.found.fraction is not None
        return self.found.fraction.lower, self.found.fraction.upper

    @property
    def moved(self) -> float:
        """Probability that it rocked, or walked as it did, and still stands [-]."""
        assert self.found.rocking is not None
        return max(self.found.rocking.value - self.fell, 0.0)

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


@dataclass(frozen=True, eq=False)
class ShakenCollection:
    """Objects after an earthquake.

    Attributes
    ----------
    objects : the most likely fallen first, then the most likely moved
    motions : the ground motions by which they were assessed
    beyond : names of the objects in places of which the map says nothing
    faults : what is wrong with the rows that were left out, a sentence each
    """

    objects: Sequence[ShakenObject]
    motions: MotionSet
    beyond: Sequence[str] = ()
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
    keep_going: bool = False,
) -> ShakenCollection:
    """Say of each object of an inventory how probably an earthquake felled it, and rocked it.

    Parameters
    ----------
    path : table of objects as of ``rockfrag assess``; ``latitude`` and ``longitude`` say where each is
    ground : what shook a place
    shared : keys of ``statue.yaml`` that hold for all, such as ``floor``
    records : folder of fetched records
    recorded : components of the record of the place, if there is one: what it does to each is said too
    keep_going : list the rows that are right where others are not

    Returns
    -------
    The objects, the most likely fallen first.

    Raises
    ------
    InputError
        If a row is wrong, or nothing is known of the shaking of any object.
    """
    requests, faults = read_inventory(path, shared or {})
    if faults and not (keep_going and requests):
        raise FaultyRows(faults)
    shaken, beyond = [], []
    for request in requests:
        here = ground(request.coordinates)
        if here is None:
            beyond.append(request.name)
        else:
            shaken.append((_asked(request, here), here))
    if not shaken:
        raise InputError(
            f"{path}: nothing is known of the shaking of any object; the map does not reach their coordinates."
        )
    motions = motion_set(requests[0].records, requests[0].place, Path(records))
    found = assess_each([request for request, _ in shaken], motions)
    objects = [
        ShakenObject(each, here, _under_record(each.request, recorded))
        for each, (_, here) in zip(found, shaken, strict=True)
    ]
    objects.sort(key=lambda each: (each.fell, each.moved), reverse=True)
    return ShakenCollection(objects, motions, beyond, faults)


def _under_record(request: Request, recorded: Sequence[Motion]) -> str:
    """Id of the text that says what the record of the place does to an object; empty without one."""
    if not recorded:
        return ""
    pairs = ((0, 1),) if len(recorded) == 2 else ()
    motions = MotionSet(tuple(recorded), tuple(recorded), pairs, "")
    if request.objects.in_space and pairs:
        motions = motions.with_both_components()
    as_recorded = np.ones((len(recorded), 1))
    counted = np.ones(as_recorded.shape, dtype=np.bool_)
    shaking = Shaking(PGA, np.ones(1), as_recorded, counted, motions)
    (found,) = shaking.at(request.place).outcomes_of([request.objects])
    if found.overturned.any():
        return "after_record_fell"
    return "after_record_rocked" if found.rocked.any() else "after_record_stood"


def _asked(request: Request, ground: GroundShaking) -> Request:
    """An object at the level that shook its place; where PGV is not known the earthquake says more of it."""
    records = request.records
    if math.isnan(ground.pgv) and math.isnan(records.magnitude):
        records = replace(
            records, magnitude=ground.magnitude, distance_km=ground.distance_km
        )
    return replace(request, level=level_of(ground), hazard=(), records=records)


def assess_each(requests: Sequence[Request], motions: MotionSet) -> list[Assessment]:
    """Assess objects, those on floors that move alike at once, each at its own level.

    Parameters
    ----------
    requests, motions : the objects at their levels, and the ground motions by which they are shaken

    Returns
    -------
    An assessment each, in their order.
    """
    groups: dict[object, list[int]] = {}
    for i, request in enumerate(requests):
        about, level = request.objects, request.level
        assert level is not None
        kind = (request.place.key, type(about), about.in_space, about.many)
        groups.setdefault((*kind, level.measure), []).append(i)
    found: dict[int, Assessment] = {}
    for rows in groups.values():
        same = [requests[i] for i in rows]
        plan = plan_for(same[0], motions.at(same[0].place), brief=True)
        for i, request, shaken in zip(rows, same, shake_all(same, plan), strict=True):
            # a level between those that were tried lies between their fractions
            own = replace(plan, level=request.level)
            found[i] = assessed(request, own, shaken)
    return [found[i] for i in range(len(requests))]


def shaken_table(collection: ShakenCollection) -> pd.DataFrame:
    """Make a row an object, in the order in which they are looked at.

    Parameters
    ----------
    collection : the objects after the earthquake

    Returns
    -------
    Columns ``rank``, ``name``, ``place``, ``latitude``, ``longitude`` [degrees], ``pga_g``, ``pgv_cm_s``,
    ``probability_fell`` with its limits, ``probability_rocked_and_stands`` [-], ``look`` and, where a record was
    given, ``under_the_record``.
    """
    texts = catalogue()
    rows = []
    for rank, each in enumerate(collection.objects, start=1):
        latitude, longitude = each.request.coordinates or (math.nan, math.nan)
        lower, upper = each.limits
        row: dict[str, Any] = {
            "rank": rank,
            "name": each.request.name,
            "place": texts.say(each.request.place.where),
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
        if each.under_record:
            row["under_the_record"] = texts.text(each.under_record)
        rows.append(row)
    return pd.DataFrame(rows).dropna(axis="columns", how="all")
