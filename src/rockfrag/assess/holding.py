"""What holds an object, tried by itself: what it must bear, and what that buys.

Each holder (:mod:`rockfrag.assess.standing.holders`) is tried twice.  So strong that nothing breaks it, under the
motions at the level of the site, it shows what it must bear; as strong as ``PART`` of these motions ask, under all
levels, it is compared with the object as it stands.  A holder that no engine can simulate with the object in
space, or not soon enough, is tried in a plane, beside the object in that plane; what cannot be simulated there
either is not tried.

In: an object, holders and motions. Out: forces [N] and factors on the probability [-].
Theory: ``docs/holding.md``.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rockfrag.assess.core.demands import ask, count_held
from rockfrag.assess.outcomes import SECONDS, ObjectOutcomes, Shaking, scaled_to
from rockfrag.assess.request import Level
from rockfrag.assess.standing import Standing
from rockfrag.assess.standing.holders import Holder
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.engines.contract import Request, engines
from rockfrag.records.motion import GroundMotion
from rockfrag.runtime.progress import Meter
from rockfrag.system.system import System
from rockfrag.words.findings import Finding, finding


@dataclass(frozen=True, eq=False)
class Trial:
    """A way to hold an object that was tried.

    Attributes
    ----------
    change : what it is, what it bears, and in how many motions
    key : of its cost, where a user states costs
    before, after : outcomes without and with it, under the same motions
    """

    change: Finding
    key: str
    before: ObjectOutcomes
    after: ObjectOutcomes

    def turned(self, change: Callable[[ObjectOutcomes], ObjectOutcomes]) -> "Trial":
        """Return it with both outcomes changed."""
        return replace(self, before=change(self.before), after=change(self.after))


def try_holders(
    objects: Standing,
    shaking: Shaking,
    few: Shaking,
    level: Level | None,
    *,
    meter: Meter | None = None,
) -> list[Trial]:
    """Try what may hold an object, or what it may do without.

    Parameters
    ----------
    objects : the object as it stands
    shaking : all motions; at the level they, or every second one, say what a holder must bear
    few : motions at the levels by which it is compared
    level : of the site; without one nothing is tried, as nothing is asked of a holder
    meter : counts the holders that were tried

    Returns
    -------
    What was tried.
    """
    if level is None:
        return []
    at_level = {
        slow: scaled_to(
            np.array([level.value]),
            shaking.motions.thinned() if slow else shaking.motions,
            shaking.measure,
        )
        for slow in (False, True)
    }
    systems = [
        system
        for system in _systems(objects, shaking)
        if can_be_simulated(system, shaking)
    ]
    # outcomes without a holder, by the number of the system
    before: dict[int, ObjectOutcomes] = {}
    found = []
    for number, holder in enumerate(objects.holders_to_try()):
        if number and meter is not None:
            meter.add(seconds_of_a_holder(objects, shaking, few))
        k = _first_that_can_be_held(holder, systems, shaking)
        enough = None
        if k is not None:
            enough = _strong_enough(holder, systems[k], at_level[holder.slow], level)
        if k is None or enough is None:
            continue
        if k not in before:
            before[k] = few.outcomes_of_system(systems[k])[0]
        after = few.outcomes_of_system(enough.holder.on(systems[k]))[0]
        found.append(Trial(enough.change, holder.key, before[k], after))
    return found


def _first_that_can_be_held(
    holder: Holder, systems: Sequence[System], shaking: Shaking
) -> int | None:
    """Number of the first of some systems that an engine simulates, soon enough, with a holder; None of none."""
    for k, system in enumerate(systems):
        if holder.slow and not system.planar:
            continue
        if can_be_simulated(holder.on(system), shaking):
            return k
    return None


class _Enough(NamedTuple):
    """A holder that bears what is asked of it."""

    holder: Holder
    change: Finding  # what it is, what it bears, and in how many motions


def _strong_enough(
    holder: Holder, system: System, at_level: Shaking, level: Level
) -> _Enough | None:
    """Return a holder as strong as ``PART`` of the motions at the site's level ask; None if hardly any asks."""
    if not holder.demand:
        return _Enough(holder, holder.called())
    demands = demands_of(holder, system, at_level)
    asked = ask(demands, np.zeros(demands.size))
    if asked <= 0:
        return None
    enough = holder.bearing(asked)
    held = int(count_held(demands, enough.bears))
    counts = {"held": held, "total": demands.size}
    called = enough.called()
    change = finding(Text.HOLDS, change=called, level=level.amount, **counts)
    return _Enough(enough, change)


def seconds_of_a_holder(objects: Standing, shaking: Shaking, few: Shaking) -> float:
    """About how long a core takes to try one way to hold an object.

    Parameters
    ----------
    objects, shaking, few : as :func:`try_holders` takes them

    Returns
    -------
    The time [s].
    """
    histories = len(shaking.motions.base) + few.scales.size
    # what is held changes its contacts often, and all bodies below with it
    return histories * SECONDS["held"] * (1 + len(objects.pedestals)) ** 3


def demands_of(holder: Holder, system: System, at_level: Shaking) -> Floats:
    """Return what each motion at a level asks of a holder that nothing breaks.

    Parameters
    ----------
    holder : with a demand
    system : that it holds
    at_level : motions at one level

    Returns
    -------
    The demands of the motions that can be scaled so, shape (motions,) [N or m].
    """
    if not at_level.allowed.any():
        return np.zeros(0)
    _, outcomes = at_level.outcomes_of_system(holder.on(system))
    demands = getattr(outcomes, holder.demand)[0, :, 0]
    largest = holder.times * np.nanmax(demands, axis=-1)
    if len(largest) != len(at_level.allowed):
        largest = largest[at_level.motions.place_of_record()]
    return np.ascontiguousarray(largest[at_level.allowed[:, 0]], dtype=np.float64)


def _systems(objects: Standing, shaking: Shaking) -> Iterator[System]:
    """The object as it stands, in space where both components shake it, then in a plane."""
    body = objects.body
    solid = objects.solid(body) if shaking.motions.both else None
    if solid is not None:
        yield objects.held(solid)
    planar = objects.in_plane()
    yield planar.held(planar.system_of(body))


def can_be_simulated(system: System, shaking: Shaking) -> bool:
    """Whether an engine simulates a system under such motions.

    Parameters
    ----------
    system, shaking : what is shaken, and by what

    Returns
    -------
    Whether one does.
    """
    motion = GroundMotion(shaking.motions.base[0])
    if not system.planar:
        first = shaking.motions.components(shaking.motions.records[0])
        motion = GroundMotion(*first).with_second()
    return any(engine.supports(system, motion, Request()) for engine in engines())
