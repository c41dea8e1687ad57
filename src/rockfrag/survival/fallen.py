"""What fell and what stands after an earthquake, as ``fallen.csv`` lists it, and what it says of the shaking.

A row is an object or a group of like ones: its sizes as in an inventory of ``rockfrag assess``, and ``fell``,
which is yes or no, or how many of how many (``31 of 60``). Azimuths of falls may stand beside it. Each group is
shaken by the motions of ``rockfrag assess``; :mod:`rockfrag.survival.shaking_posterior` does the rest.

In: the text of a table. Out: groups of objects with what fell of them. Docs: ``docs/constrain-shaking.md``.
"""

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.assess.inventory import NO, YES, FaultyRows, read_inventory
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import FEW_LEVELS, ObjectOutcomes, make_intensity_levels
from rockfrag.assess.request import Request
from rockfrag.assess.risk import shift_of
from rockfrag.assess.sources import SPACE
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.runtime.progress import Progress
from rockfrag.survival.directions_of_falls import FallDirection, fall_direction
from rockfrag.survival.shaking_axis import (
    ShakingAxis,
    fall_density,
    predicted_falls,
    shaking_axis,
)
from rockfrag.survival.shaking_posterior import (
    Falls,
    Prior,
    ShakingPosterior,
    shaking_posterior,
)

RECORDS = "resources/records"  # Folder of fetched records

FROM_ONE_TO_THE_NEXT = 0.2
"""Standard deviation of ln level that fells one of like objects and the next, beyond what their sizes differ by
[-]: how each sits on its base. An estimate of ours."""

_COUNT = re.compile(r"(\d{1,9})\s*(?:of|/|von|sur|su|de)\s*(\d{1,9})")


@dataclass(frozen=True)
class Observed:
    """A group of like objects after an earthquake.

    Attributes
    ----------
    request : one of them, and the floor on which they stand
    fallen, count : how many fell, of how many
    azimuths : of falls that were measured, clockwise from north [degrees]
    """

    request: Request
    fallen: int
    count: int
    azimuths: tuple[float, ...] = ()


@dataclass(frozen=True)
class Knowledge:
    """What is known beside the falls.

    Attributes
    ----------
    prior : of the shaking
    own_spread : standard deviation of ln level from one of like objects to the next, beyond their sizes [-]
    slenderness_spread : relative standard deviation of the slenderness that all objects share [-]
    shared_spread : standard deviation of ln level that all share; None for that of the model
    """

    prior: Prior = field(default_factory=Prior)
    own_spread: float = FROM_ONE_TO_THE_NEXT
    slenderness_spread: float = 0.0
    shared_spread: float | None = None


@dataclass(frozen=True, eq=False)
class FallenPlace:
    """A place after an earthquake, with what its objects say of the shaking.

    Attributes
    ----------
    groups : what fell and what stands
    knowledge : what is known beside it
    posterior : of the shaking, by all groups
    alone : median of PGV and its limits by each group alone [cm/s]
    own : standard deviation of ln level from one object of each group to the next [-]
    shared : that of what all share [-], by what it comes from
    motions : the ground motions of which one is taken to be like that of the earthquake
    direction : where falls point; None where too few were measured
    axis : along which the ground shook most; None where falls point nowhere, or no record has both components
    """

    groups: Sequence[Observed]
    knowledge: Knowledge
    posterior: ShakingPosterior
    alone: Sequence[tuple[float, float, float]]
    own: Sequence[float]
    shared: Mapping[str, float]
    motions: MotionSet
    direction: FallDirection | None = None
    axis: ShakingAxis | None = None

    @property
    def fallen(self) -> int:
        """How many fell."""
        return sum(group.fallen for group in self.groups)

    @property
    def count(self) -> int:
        """How many there are."""
        return sum(group.count for group in self.groups)


def read_fallen(
    path: str | os.PathLike[str], shared: Mapping[str, Any] | None = None
) -> list[Observed]:
    """Read what fell and what stands.

    Parameters
    ----------
    path : table with a row an object or group: ``name``, ``width``, ``height``, ``fell`` and what else an
        inventory has; ``azimuths`` of falls with bars between them [degrees]
    shared : keys of ``statue.yaml`` that hold for all

    Returns
    -------
    The groups.

    Raises
    ------
    InputError
        If a row cannot be read.
    """
    extra: dict[str, Mapping[str, str]] = {}
    requests, faults = read_inventory(
        path, shared or {}, also=("fell", "azimuths"), cells=extra
    )
    found = []
    for request in requests:
        about = extra[request.name]
        try:
            fallen, count = _counts(about.get("fell", ""))
            azimuths = _azimuths(about.get("azimuths", ""))
        except InputError as error:
            faults.append(f"{path}, {request.name}: {error}")
            continue
        if len(azimuths) > fallen:
            faults.append(
                f"{path}, {request.name}: {len(azimuths)} azimuths are given, but {fallen} fell."
            )
        found.append(Observed(request, fallen, count, azimuths))
    if faults:
        raise FaultyRows(faults)
    return found


def _counts(said: str) -> tuple[int, int]:
    """How many fell of how many, from ``yes``, ``no`` or ``31 of 60``."""
    words = said.strip().lower()
    if words in YES:
        return 1, 1
    if words in NO:
        return 0, 1
    found = _COUNT.fullmatch(words)
    if not found or int(found[2]) < 1 or int(found[1]) > int(found[2]):
        raise InputError(
            "column fell: expected yes, no, or how many of how many such as 31 of 60, found "
            f"{said[:40] or 'nothing'}."
        )
    return int(found[1]), int(found[2])


def _azimuths(said: str) -> tuple[float, ...]:
    """Azimuths of falls of a cell [degrees]."""
    try:
        found = tuple(float(part) % 360.0 for part in said.split("|") if part.strip())
    except ValueError:
        found = (math.nan,)
    if not all(map(math.isfinite, found)):
        raise InputError(
            f"column azimuths: expected degrees with bars between them such as 30|45|20, found {said[:40]}."
        )
    return found


def constrain_shaking(
    groups: Sequence[Observed],
    knowledge: Knowledge | None = None,
    records: str | Path = RECORDS,
    progress: Progress | None = None,
) -> FallenPlace:
    """Say how strongly the ground shook, by what fell and what stands.

    Parameters
    ----------
    groups : what fell and what stands, all at one place
    knowledge : what is known beside it
    records : folder of fetched records
    progress : called with the number of groups that were shaken and of all

    Returns
    -------
    The :class:`FallenPlace`.

    Raises
    ------
    InputError
        If nothing is given, or no shaking explains it.
    """
    if not groups:
        raise InputError("falls: give one object or more.")
    known = knowledge or Knowledge()
    first = groups[0].request
    motions = motion_set(first.records, first.place, Path(records))
    shaken = []
    for group in groups:
        shaken.append(_shaken(group, motions, known))
        if progress is not None:
            progress(len(shaken), len(groups))
    falls = [each.falls for each in shaken]
    shared = _shared(groups, shaken, known)
    about = shaken[0]

    def by(part: Sequence[Falls]) -> ShakingPosterior:
        """Posterior by some of the groups."""
        return shaking_posterior(
            about.levels,
            about.accelerations,
            part,
            shared_spread=math.hypot(*shared.values()),
            prior=known.prior,
            allowed=about.allowed,
        )

    posterior = by(falls)
    azimuths = [azimuth for group in groups for azimuth in group.azimuths]
    direction = fall_direction(azimuths)
    axis = None
    if direction is not None and direction.points_somewhere:
        axis = _axis(groups, shaken, motions, posterior)
    return FallenPlace(
        groups=groups,
        knowledge=known,
        posterior=posterior,
        alone=[by([each]).pgv() for each in falls],
        own=[each.spread for each in falls],
        shared=shared,
        motions=motions,
        direction=direction,
        axis=axis,
    )


def _axis(
    groups: Sequence[Observed],
    shaken: Sequence["_Shaken"],
    motions: MotionSet,
    posterior: ShakingPosterior,
) -> ShakingAxis | None:
    """Axis along which the ground shook most; None where no group has azimuths and records with both components.

    Where motions let stones fall, at levels that count by the ``posterior``, is compared with the azimuths of
    falls.
    """
    measured, levels = [], None
    for group, each in zip(groups, shaken, strict=True):
        here = motions.at(group.request.place)
        if not group.azimuths or not here.pairs:
            continue
        predicted = predicted_falls(group.request.objects.block, here)
        density = fall_density(predicted, each.falls.spread)
        measured.append((group.azimuths, density))
        levels = predicted.levels
    if levels is None:
        return None
    # all records alike at a level; a level stands for what lies about it
    x = np.log(posterior.levels)
    by_level = np.interp(np.log(levels), x, posterior.probability, left=0, right=0)
    _, density = measured[0]
    weights = np.broadcast_to(by_level, density.shape[1:])
    return shaking_axis(measured, weights / weights.sum())


@dataclass(frozen=True, eq=False)
class _Shaken:
    """A group under the motions of a set, at levels of PGV of the ground."""

    falls: Falls
    levels: Floats  # of PGV, rising [cm/s], shape (levels,)
    accelerations: (
        Floats  # PGA of each motion at each level [g], shape (motions, levels)
    )
    allowed: (
        Floats  # 1 where a motion can be scaled to the level, else 0, of that shape
    )
    slenderness: float  # Change of ln level with ln slenderness [-]


def _shaken(group: Observed, motions: MotionSet, known: Knowledge) -> _Shaken:
    """Simulate a group's object under the motions of its place, and its variants under fewer of them."""
    objects = group.request.objects
    here = motions.at(group.request.place)
    if objects.in_space and here.pairs:
        here = here.with_both_components()
    shaking = make_intensity_levels(here, PGV)
    (found,) = shaking.outcomes_of([objects])
    few = make_intensity_levels(here.thinned(), PGV, count=FEW_LEVELS)
    # in space there is no restitution to vary
    idle = {"restitution"} if here.both else set()
    variants = [each for each in objects.variants() if each.name not in idle]
    sides = few.outcomes_of([side for each in variants for side in each.sides])
    pairs = zip(sides[::2], sides[1::2], strict=True)
    moved = [shift_of(*pair).topples for pair in pairs]
    own = math.hypot(known.own_spread, *moved)
    slenderness = 1.0
    for variant, shift in zip(variants, moved, strict=True):
        if variant.name == "width":
            slenderness = abs(shift) / variant.spread
    ratios = here.values(PGA) / here.values(PGV)
    return _Shaken(
        Falls(group.fallen, group.count, toppled_everywhere(found), own),
        shaking.levels,
        ratios[:, np.newaxis] * shaking.levels,
        shaking.allowed.astype(np.float64),
        slenderness,
    )


def toppled_everywhere(found: ObjectOutcomes) -> Floats:
    """Say whether each motion topples the object at each level, also where it cannot be scaled so far.

    There it does as at the nearest level to which it can.

    Parameters
    ----------
    found : outcomes of the object

    Returns
    -------
    0 or 1 at each level, shape (motions, levels).
    """
    toppled, allowed = found.overturned, found.intensity_levels.allowed
    # numbers of the levels, and of the first and last one that each motion can be scaled to
    place = np.arange(allowed.shape[1])
    first = allowed.argmax(axis=1)[:, np.newaxis]
    last = place[-1] - allowed[:, ::-1].argmax(axis=1)[:, np.newaxis]
    nearest = np.clip(place, first, np.maximum(last, first))
    return np.take_along_axis(toppled, nearest, axis=1).astype(np.float64)


def _shared(
    groups: Sequence[Observed], shaken: Sequence[_Shaken], known: Knowledge
) -> dict[str, float]:
    """Standard deviation of ln level that all objects share, by what it comes from [-].

    The model's is that of the kind of body that it errs most in, unless it is stated.
    """
    objects = [group.request.objects for group in groups]
    model = max(MODEL_ERRORS[each.measured_as].beyond for each in objects)
    found = {"model": known.shared_spread}
    if known.shared_spread is None:
        found = {"model": model}
        if not all(each.in_space for each in objects):
            found["second component"] = SPACE
    if known.slenderness_spread > 0:
        most = max(each.slenderness for each in shaken)
        found["slenderness"] = most * known.slenderness_spread
    return {name: float(value or 0.0) for name, value in found.items()}
