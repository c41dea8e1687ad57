"""The contract of engines: what one is asked, what it answers, and what it may refuse.

1. **Units and signs.**  SI throughout.  x is horizontal, z upwards; a rotation of a planar body is clockwise
   positive, of a body in space a vector; a ground acceleration moves the ground, not the body.  Motions are linear
   between samples and zero one sample after the last.
2. **What an engine says of itself.**  ``meets`` is the set of wishes (:class:`Wish`) that it can meet, in any
   combination.  ``supports`` answers for one system, one motion and one request; an engine that cannot meet a wish
   says so there, and never answers as if the wish had not been made.
3. **Who answers.**  The first engine in the registry that supports a system, its motion and the request.  Its name
   stands in ``Outcomes.engine``.  If none does, :func:`refusal` says in one sentence which wish cannot be met
   together with which.
4. **The instant of a fall** (``overturning_time``): the first sample at which a body lies on its side, turned by a
   quarter turn or more from the vertical or from the body that it stood on, or has left the edge of what it
   stood on.  An engine that stops before that leaves NaN there and writes ``certain_time``, the instant from which
   the fall was certain whatever followed.  The two are never mixed in one column.
5. **Peaks** are taken over the continuous response, between samples too, until the outcome is known.  The peak
   rotation of a body that fell is infinite.  Rotations count over the critical angle of their side.
6. **Free rocking** after the motion is followed until the bodies rest, one has fallen, or what is left of the
   energy cannot overturn them.
7. **Equal to the bit.**  Outcomes do not depend on the number of threads, on the order of systems, motions or
   scales, on what else is in the grid, or on the machine.
8. **Refusals** are made before the first case is integrated, as :class:`rockfrag.base.errors.InputError` with one
   sentence.  A case that cannot be finished (no consistent mode of contact) is finished nevertheless by a stated
   rule and counted (``paradoxes``); an engine does not raise in the middle of a grid.
9. **What is not told** is NaN, never zero.  What cannot happen (a slip where nothing slides) is zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from itertools import combinations
from typing import Any, Protocol

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.engines.steps import STEP
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes, merge_outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.system import System


class Wish(Enum):
    """What may be wished of an engine; the value is what a message calls it."""

    TWO_BODIES = "two bodies"
    MANY_BODIES = "three and more bodies"
    SPACE = "a second horizontal component"
    VERTICAL = "a vertical component"
    FRICTION = "friction"
    RESTITUTION = "a measured restitution"
    START = "a start of its own"
    LINEAR = "the linearised equations"
    FORCES = "forces"
    HISTORY = "the history"
    TILT = "an uneven base in space"
    WALL = "a wall"
    TIE = "a tie"
    BOND = "a bond"
    SUPPORT = "an isolator"
    PLACE = "bodies where an earlier response left them"
    STEPS = "jumps of the velocity"
    SPREAD = "a base that is spread"


@dataclass(frozen=True)
class Request:
    """What is asked of every case beside its outcome."""

    history: bool = False  # the whole history
    forces: bool = False  # friction demand, least normal force and the loss of contact
    linear: bool = False  # the linearised equations of motion
    g: float = GRAVITY  # acceleration of gravity [m/s²]
    # largest product of frequency parameter and step [-], of engines that take one
    step: float = STEP
    # largest displacement of each vertex of the base over its extent [-], and largest angle by which the body is
    # turned about the vertical [rad], drawn from ``seed`` anew for each system and motion
    spread: float = 0.0
    seed: int = 0


@dataclass(frozen=True)
class Case:
    """One system, one motion, one scale."""

    system: System
    motion: GroundMotion
    scale: float = 1.0
    request: Request = field(default_factory=Request)


@dataclass(frozen=True)
class Cases:
    """Systems × motions × scales, and what is asked of each."""

    # systems, motions: what is shaken, and by what
    systems: tuple[System, ...]
    motions: tuple[GroundMotion, ...]
    scales: Floats  # factors on the motions, shape (motions, scales)
    request: Request = field(default_factory=Request)  # what is asked
    threads: int = 1  # threads to use; outcomes do not depend on it

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of systems, motions and scales."""
        return len(self.systems), self.scales.shape[0], self.scales.shape[1]

    @cached_property
    def answering(self) -> list["Engine"]:
        """Engine of each system under all motions: one for what any of them has."""
        richest = with_all_components(self.motions)
        return [engine_for(system, richest, self.request) for system in self.systems]

    @cached_property
    def names(self) -> list[tuple[str, ...]]:
        """Names of the bodies of each system."""
        return [system.names for system in self.systems]

    @cached_property
    def holding(self) -> list[tuple[str, ...]]:
        """Names of what holds the bodies of each system."""
        return [system.holding for system in self.systems]


def with_all_components(motions: Sequence[GroundMotion]) -> GroundMotion:
    """A still ground with all that any of the motions has, to ask engines with: which of them support all motions.

    That is its components, and the jumps of the velocity of the first that has some.
    """
    still = Motion(np.zeros(1), 1.0)
    return GroundMotion(
        still,
        y=still if any(motion.y is not None for motion in motions) else None,
        z=still if any(motion.z is not None for motion in motions) else None,
        steps=next((motion.steps for motion in motions if motion.steps), None),
    )


@dataclass(frozen=True)
class Support:
    """Whether an engine supports what is wanted; if not, why."""

    missing: frozenset[Wish] = frozenset()  # wishes that the engine cannot meet
    reason: str = ""  # why, in words, where it is none of the wishes

    def __bool__(self) -> bool:
        """Whether it does."""
        return not self.missing and not self.reason


class Engine(Protocol):
    """Whoever computes outcomes; the rules stand at the top of this module."""

    name: str  # that stands in outcomes
    meets: frozenset[Wish]  # wishes that it can meet, in any combination

    def supports(
        self, system: System, motion: GroundMotion, request: Request
    ) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        return Support(wishes(system, motion, request) - self.meets)

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases whose systems and motions it supports."""

    def history(self, case: Case) -> Any:
        """Return the :class:`rockfrag.outcomes.response.Response` of a case that it supports."""


def wishes(system: System, motion: GroundMotion, request: Request) -> frozenset[Wish]:
    """Return what is wished for with a system, a motion and a request.

    Parameters
    ----------
    system, motion, request : of a case

    Returns
    -------
    The wishes.
    """
    start = system.start
    made = {
        Wish.TWO_BODIES: system.count == 2,
        Wish.MANY_BODIES: system.count > 2,
        Wish.SPACE: motion.y is not None,
        Wish.VERTICAL: motion.z is not None,
        Wish.FRICTION: system.loose,
        Wish.RESTITUTION: any(
            contact.law.name != "momentum" for contact in system.contacts
        ),
        Wish.START: start is not None and np.any([*start.rotation, *start.velocity]),
        Wish.LINEAR: request.linear,
        Wish.FORCES: request.forces,
        Wish.HISTORY: request.history,
        Wish.TILT: motion.y is not None
        and any(contact.tilt for contact in system.contacts),
        Wish.WALL: any(isinstance(each, Wall) for each in system.constraints),
        Wish.TIE: any(isinstance(each, Tie) for each in system.constraints),
        Wish.BOND: len(system.bonds) > 0,
        Wish.SUPPORT: system.support is not None,
        Wish.PLACE: start is not None and start.position is not None,
        Wish.STEPS: motion.steps is not None,
        Wish.SPREAD: request.spread > 0,
    }
    return frozenset(wish for wish, there in made.items() if there)


_ENGINES: list[Engine] = []


def register_engine(engine: Engine, before: str | None = None) -> Engine:
    """Add an engine to the registry, behind all others or before the one of a name; its name must not be taken."""
    names = [other.name for other in engines()]
    if engine.name in names:
        raise InputError(
            f"engine {engine.name!r} is registered already; give it another name."
        )
    if before is not None and before not in names:
        raise InputError(
            f"engine {before!r} is not known; choose one of {', '.join(names)}."
        )
    _ENGINES.insert(len(names) if before is None else names.index(before), engine)
    return engine


def engines() -> tuple[Engine, ...]:
    """Return the engines in the order in which they are asked.

    Returns
    -------
    Those that are registered.
    """
    if not _ENGINES:
        # these know the contract, and are loaded when one is first wanted
        from rockfrag.engines.built_in import BUILT_IN

        _ENGINES[:] = BUILT_IN
    return tuple(_ENGINES)


def engine_for(system: System, motion: GroundMotion, request: Request) -> Engine:
    """Return the first engine that supports what is wanted; refuse with the wishes that clash.

    Parameters
    ----------
    system : to be integrated
    motion : of the ground, one to three components [m/s²]
    request : what else is wanted

    Returns
    -------
    The engine.
    """
    for engine in engines():
        if engine.supports(system, motion, request):
            return engine
    raise InputError(refusal(system, motion, request))


def refusal(system: System, motion: GroundMotion, request: Request) -> str:
    """Say in one sentence which wishes cannot be met together."""
    wanted = wishes(system, motion, request)
    for many in range(1, len(wanted) + 1):
        for some in combinations(sorted(wanted, key=lambda wish: wish.name), many):
            if not any(set(some) <= engine.meets for engine in engines()):
                first, *others = (wish.value for wish in some)
                if not others:
                    return f"{first} is beyond every engine; leave it out."
                return f"{first} cannot be had together with {' and '.join(others)}; leave one of them out."
    reasons = [
        str(engine.supports(system, motion, request).reason) for engine in engines()
    ]
    said = next((reason for reason in reasons if reason), "there is no engine for it")
    return f"this system cannot be computed: {said}."


def run_cases(cases: Cases) -> Outcomes:
    """Let the engines answer, each for the systems and motions that it is the first to support.

    Parameters
    ----------
    cases : systems × motions × scales

    Returns
    -------
    The outcomes of all, shape (systems, motions, scales).
    """
    if not cases.motions or not cases.systems or not cases.scales.size:
        return empty_outcomes(cases.names, cases.scales, holding=cases.holding)
    chosen = cases.answering
    if all(engine is chosen[0] for engine in chosen):
        return chosen[0].run(cases)
    parts = []
    for engine in dict.fromkeys(chosen):
        rows = [i for i, choice in enumerate(chosen) if choice is engine]
        some = replace(cases, systems=tuple(cases.systems[i] for i in rows))
        parts.append((rows, engine.run(some)))
    # an engine may have asked others
    used = dict.fromkeys(name for _, found in parts for name in found.engines)
    result = empty_outcomes(
        cases.names, cases.scales, tuple(used), holding=cases.holding
    )
    for rows, found in parts:
        merge_outcomes(result, rows, found)
    return result
