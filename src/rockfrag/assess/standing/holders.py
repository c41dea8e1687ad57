"""What may hold an object, a class each: what it adds to the system that is shaken, and what it must bear.

A holder is part of how an object stands, or is tried by itself as a mitigation (:mod:`rockfrag.assess.holding`):
first so strong that nothing breaks it, which says what it must bear, then as strong as that.  What each does is
derived in ``docs/holding.md``; sizes that nobody stated are those of :mod:`rockfrag.assess.core.holding`, and are
said.

In: settings of a holder. Out: walls, ties, bonds or supports of a system, SI units.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from rockfrag.assess.core.holding import (
    BRACKET_GIVES,
    CORD_GIVES,
    FASTENED_AT,
    LOCKED_AT,
    PADS_AT,
    PLATE,
    RADIUS,
    REACH,
    SLIDES_AT,
    UNBROKEN,
    bracket_damping,
    rounded_up,
    tell_springs,
    tie_stiffness,
)
from rockfrag.assess.texts import Text
from rockfrag.base.elementary import atan2
from rockfrag.base.units import GRAVITY
from rockfrag.system import footprint
from rockfrag.system.body import Circle, Interval, Outline, Polygon
from rockfrag.system.bond import Bond
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.contact import Friction
from rockfrag.system.mounts import ROLLING, pads_under
from rockfrag.system.support import (
    YIELDS_AT,
    BilinearIsolator,
    SlidingPendulum,
    Support,
)
from rockfrag.system.system import System, bearing, hold
from rockfrag.words.findings import Finding, Value, finding, three, two


@dataclass(frozen=True)
class Holder(ABC):
    """Something that holds an object."""

    # Its key in ``statue.yaml``, and in what a user states costs of
    key: ClassVar[str]
    # Column of outcomes that says what it must bear, and how often that is to be taken; empty where nothing
    demand: ClassVar[str] = ""
    times: ClassVar[float] = 1.0
    # Whether a simulation of it takes long: it is tried in one plane then, also of an object that is shaken in
    # space, where one of stiff ties takes a second, and asked by every second motion what it must bear
    slow: ClassVar[bool] = False
    # About how long a core takes for one history of what it holds as it stands [s]
    seconds: ClassVar[float] = 3e-3

    @abstractmethod
    def on(self, system: System) -> System:
        """Return a system with it."""

    @abstractmethod
    def called(self) -> Finding:
        """What it is called, with what it bears."""

    @property
    @abstractmethod
    def short(self) -> Finding:
        """Its name, without what it bears."""

    def key_in_plane(self, solid: System) -> str:
        """Key that is to be left out of an object in space, which it does not hold there."""
        return self.key

    def holds_in_space(self, solid: System) -> bool:
        """Whether it is simulated of an object in space."""
        return True

    @property
    def bears(self) -> float:
        """Demand at which it fails [N], or at which it meets its stop [m]; infinite where neither is asked."""
        return math.inf

    def bearing(self, demand: float) -> Self:
        """Return it made to bear a demand [N or m], rounded up to two digits."""
        return self


@dataclass(frozen=True)
class Putty(Holder):
    """Wax or putty under the object, in pads near the corners of its base.

    Attributes
    ----------
    tension : that all pads hold together [N], and as much in shear
    """

    tension: float = UNBROKEN
    key: ClassVar[str] = "putty"
    short = finding(Text.HELD_BY_PUTTY)
    demand: ClassVar[str] = "largest_force"
    times: ClassVar[float] = 2.0  # of each of two sides

    def on(self, system: System) -> System:
        """Bond the uppermost body to what it stands on."""
        spread = pads_of(bearing(system, system.count - 1))
        return hold(system, bonds=Bond(self.tension, self.tension, spread))

    def called(self) -> Finding:
        """Such as putty that holds 120 N."""
        return finding(Text.HOLD_PUTTY, force=three(self.tension))

    @property
    def bears(self) -> float:
        """Pull on all pads at which it fails [N]."""
        return self.tension

    def bearing(self, demand: float) -> Self:
        """Return putty that holds a pull on all pads [N]."""
        return replace(self, tension=rounded_up(demand))


@dataclass(frozen=True)
class Fastener(Holder):
    """What is fastened to the object and to what stands like the ground, and breaks at a strength.

    Attributes
    ----------
    strength : at which each breaks [N]
    slack : by which it gives before it holds [m]
    """

    strength: float = UNBROKEN
    slack: float = 0.0
    demand: ClassVar[str] = "largest_force"
    slow: ClassVar[bool] = True

    @property
    def bears(self) -> float:
        """Force at which one of its kind breaks [N]."""
        return self.strength

    def bearing(self, demand: float) -> Self:
        """Return fasteners that bear a force each [N]."""
        return replace(self, strength=rounded_up(demand))

    def _words(self) -> dict[str, Value]:
        """What its text names: force, slack and height."""
        slack = finding(Text.NO_SLACK)
        if self.slack > 0:
            slack = finding(Text.SLACK, size=three(1000 * self.slack))
        height = finding("whole_percent", value=two(100 * FASTENED_AT))
        return {"force": three(self.strength), "slack": slack, "height": height}


@dataclass(frozen=True)
class Bracket(Fastener):
    """A bracket between the object and a wall that stands like the ground: it holds both ways."""

    key: ClassVar[str] = "bracket"
    short = finding(Text.HELD_BY_BRACKET)

    def on(self, system: System) -> System:
        """Fasten the uppermost body in the direction of its narrower side."""
        made = fastened(system, BRACKET_GIVES, self)
        bracket = replace(made[0], bracket=True, damping=_damping(system, made[0]))
        return hold(system, bracket)

    def called(self) -> Finding:
        """Such as a bracket that bears 300 N."""
        return finding(Text.HOLD_BRACKET, **self._words())


@dataclass(frozen=True)
class Cords(Fastener):
    """Cords to both sides of the object."""

    key: ClassVar[str] = "cord"
    short = finding(Text.HELD_BY_CORD)

    def on(self, system: System) -> System:
        """Fasten the uppermost body to both sides in the direction of its narrower side."""
        return hold(system, *fastened(system, CORD_GIVES, self))

    def called(self) -> Finding:
        """Such as cords that bear 300 N each."""
        return finding(Text.HOLD_CORDS, **self._words())


@dataclass(frozen=True)
class Isolator(Holder):
    """An isolator under all that stands there, on a plate of its own.

    Attributes
    ----------
    stroke : at which it meets its stop [m]
    """

    stroke: float = math.inf
    key: ClassVar[str] = "isolator"
    demand: ClassVar[str] = "stroke"
    slow: ClassVar[bool] = True
    seconds: ClassVar[float] = 5e-3

    def holds_in_space(self, solid: System) -> bool:
        """In one plane only."""
        return False

    def on(self, system: System) -> System:
        """Put a plate under the lowest body."""
        return hold(system, support=self._support(PLATE * system.mass, system.mass))

    @abstractmethod
    def _support(self, plate: float, carried: float) -> Support:
        """Return what is under the lowest body, of a plate and of all that it carries [kg]."""

    @property
    def bears(self) -> float:
        """Displacement at which it meets its stop [m]."""
        return self.stroke

    def bearing(self, demand: float) -> Self:
        """Return an isolator whose stop is beyond a displacement [m]."""
        return replace(self, stroke=rounded_up(demand))


@dataclass(frozen=True)
class Pendulum(Isolator):
    """A sliding pendulum.

    Attributes
    ----------
    radius : of its dish [m]
    friction : of its plate in the dish [-]
    """

    radius: float = RADIUS
    friction: float = SLIDES_AT
    short = finding(Text.HELD_BY_ISOLATOR)

    def _support(self, plate: float, carried: float) -> Support:
        """Return the dish, in which friction and fall go with the weight."""
        friction = Friction(self.friction, self.friction)
        return SlidingPendulum(
            mass=plate, stroke=self.stroke, radius=self.radius, friction=friction
        )

    def called(self) -> Finding:
        """Such as an isolator with 18 cm to both sides."""
        return finding(
            Text.HOLD_ISOLATOR,
            stroke=three(100 * self.stroke),
            radius=three(self.radius),
            friction=three(self.friction),
        )


@dataclass(frozen=True)
class Springs(Isolator):
    """A bilinear isolator, of the period of a usual pendulum where its springs are not stated.

    Attributes
    ----------
    stiffness : after yielding [N/m]; None: that of the usual period
    strength : of the part that yields [N]; None: the usual part of the weight
    yields_at : displacement at which it does [m]
    """

    stiffness: float | None = None
    strength: float | None = None
    yields_at: float = YIELDS_AT
    short = finding(Text.HELD_BY_SPRINGS)
    seconds: ClassVar[float] = 1e-2

    def _support(self, plate: float, carried: float) -> Support:
        """Return the springs."""
        usual = np.zeros(3)
        tell_springs(plate + carried, usual)
        return BilinearIsolator(
            mass=plate,
            stroke=self.stroke,
            stiffness=usual[0] if self.stiffness is None else self.stiffness,
            strength=usual[1] if self.strength is None else self.strength,
            yield_displacement=self.yields_at,
        )

    def called(self) -> Finding:
        """Such as an isolator with 18 cm to both sides."""
        stroke = three(100 * self.stroke)
        if self.stiffness is not None and self.strength is not None:
            springs = {
                "stiffness": three(self.stiffness),
                "strength": three(self.strength),
            }
            return finding(Text.HOLD_SPRINGS_STATED, stroke=stroke, **springs)
        part = finding("whole_percent", value=two(100 * SLIDES_AT))
        period = two(2 * math.pi * math.sqrt(RADIUS / GRAVITY))
        return finding(Text.HOLD_SPRINGS, stroke=stroke, period=period, part=part)


@dataclass(frozen=True)
class Beside(Holder):
    """A wall behind the object; a low one is a kerb.

    Attributes
    ----------
    distance : from its base [m]
    height : of its upper edge over the floor [m]
    """

    distance: float = math.inf
    height: float = math.inf
    key: ClassVar[str] = "wall"

    @property
    def short(self) -> Finding:
        """A wall, with its height if that was given."""
        if self.height < math.inf:
            return finding(Text.HELD_BY_LOW_WALL, height=three(100 * self.height))
        return finding(Text.HELD_BY_WALL)

    def key_in_plane(self, solid: System) -> str:
        """The height of a low wall beside what has corners, which is simulated in space beside a high one."""
        high = replace(self, height=math.inf)
        return "wall_height" if high.holds_in_space(solid) else self.key

    def holds_in_space(self, solid: System) -> bool:
        """As a wall of any height, beside what has corners."""
        return self.height == math.inf and not isinstance(solid.bodies[0].base, Circle)

    def on(self, system: System) -> System:
        """Set a wall beside the lowest body, in the direction of its narrower side."""
        base = system.bodies[0].base
        east, north = narrow_direction(base)
        at = reach_of(base) + self.distance
        wall = Wall(at, atan2(north, east), height=self.height)
        return hold(system, wall)

    def called(self) -> Finding:
        """Such as a wall 5 cm behind it."""
        distance = three(100 * self.distance)
        if self.height < math.inf:
            high = three(100 * self.height)
            return finding(Text.HOLD_LOW_WALL, distance=distance, height=high)
        return finding(Text.HOLD_WALL, distance=distance)


@dataclass(frozen=True)
class Casters(Holder):
    """Casters under all that stands there.

    Attributes
    ----------
    locked : whether they are
    """

    locked: bool = False
    key: ClassVar[str] = "casters"

    @property
    def short(self) -> Finding:
        """Casters that are locked, or roll."""
        return finding(Text.HELD_BY_LOCKED if self.locked else Text.HELD_BY_ROLLING)

    def on(self, system: System) -> System:
        """Let the ground's contact roll, or slide on what is locked."""
        locked = Friction(LOCKED_AT, LOCKED_AT)
        return system.with_friction(locked if self.locked else ROLLING)

    def called(self) -> Finding:
        """Casters that are locked, or free."""
        if self.locked:
            return finding(Text.HOLD_CASTERS_LOCKED, friction=two(LOCKED_AT))
        return finding(Text.HOLD_CASTERS_FREE, friction=two(ROLLING.kinetic))


@dataclass(frozen=True)
class WithoutWall(Holder):
    """The object moved away from the wall that it stands at."""

    key: ClassVar[str] = "wall"
    short = finding(Text.HELD_BY_OFF_WALL)

    def on(self, system: System) -> System:
        """Take all walls away."""
        ties = [each for each in system.constraints if isinstance(each, Tie)]
        return replace(system, constraints=tuple(ties))

    def called(self) -> Finding:
        """Away from the wall."""
        return finding(Text.HOLD_OFF_WALL)


def _bracket(given: Mapping[str, Any]) -> Holder:
    return Bracket(given["bracket_n"], given.get("bracket_slack_m", 0.0))


def _cords(given: Mapping[str, Any]) -> Holder:
    return Cords(given["cord_n"], given.get("cord_slack_m", 0.0))


def _wall(given: Mapping[str, Any]) -> Holder:
    return Beside(given["wall_m"], given.get("wall_height_m", math.inf))


def _isolator(given: Mapping[str, Any]) -> Holder:
    """Make springs where their stiffness is stated, a pendulum otherwise."""
    stroke = given["isolator_m"]
    if "isolator_stiffness_n_m" in given:
        return Springs(
            stroke,
            given["isolator_stiffness_n_m"],
            given["isolator_strength_n"],
            given.get("isolator_yield_m", YIELDS_AT),
        )
    radius = given.get("isolator_radius_m", RADIUS)
    return Pendulum(stroke, radius, given.get("isolator_friction", SLIDES_AT))


GIVEN: Mapping[str, Callable[[Mapping[str, Any]], Holder]] = {
    "putty_n": lambda given: Putty(given["putty_n"]),
    "bracket_n": _bracket,
    "cord_n": _cords,
    "isolator_m": _isolator,
    "wall_m": _wall,
    "casters": lambda given: Casters(given["casters"] == "locked"),
}
"""Keys of ``statue.yaml`` that say what holds an object as it stands, and its holder, made of all keys."""


def holders_of(settings: Mapping[str, Any]) -> tuple[Holder, ...]:
    """Make what holds an object of checked keys of ``statue.yaml``.

    Parameters
    ----------
    settings : checked keys

    Returns
    -------
    The holders, in the order of ``GIVEN``.
    """
    return tuple(make(settings) for key, make in GIVEN.items() if key in settings)


def holders_beside(there: Sequence[Holder]) -> list[Holder]:
    """Holders that may be tried beside those that are there.

    Parameters
    ----------
    there : what holds the object as it stands

    Returns
    -------
    Those of other kinds, and what may be done about a wall and about casters that roll.
    """
    kinds = {holder.key for holder in there}
    usual: list[Holder] = [Putty(), Bracket(), Cords(), Pendulum(), Springs()]
    useless = set(kinds)
    # what is fastened to a wall or to the floor holds an isolator fast too
    if "isolator" in kinds:
        useless |= {Bracket.key, Cords.key}
    if kinds & {Bracket.key, Cords.key}:
        useless.add(Isolator.key)
    # between wheels and the floor there is no face for pads
    if Casters.key in kinds:
        useless.add(Putty.key)
    found = [holder for holder in usual if holder.key not in useless]
    if "wall" in kinds:
        found.append(WithoutWall())
    if any(isinstance(holder, Casters) and not holder.locked for holder in there):
        found.append(Casters(locked=True))
    return found


def pads_of(base: Outline) -> tuple[float, float]:
    """Half the distances of four pads under a base along its axes [m]."""
    return pads_under(base, PADS_AT)


def nearest_edge(base: Polygon) -> tuple[float, tuple[float, float]]:
    """Distance of a polygon's nearest edge from its origin [m], and the direction across it, outwards."""
    distance, east, north = footprint.nearest_edge(base.vertices, len(base.vertices))
    return distance, (east, north)


def narrow_direction(base: Outline) -> tuple[float, float]:
    """Direction in the plan across the narrower side of a base; along x of a planar or round one."""
    return nearest_edge(base)[1] if isinstance(base, Polygon) else (1.0, 0.0)


def reach_of(base: Outline) -> float:
    """How far a base reaches from its origin in its narrow direction [m]."""
    if isinstance(base, Interval):
        return base.right
    if isinstance(base, Circle):
        return base.radius + base.centre[0]
    east, north = narrow_direction(base)
    return footprint.reach(base.vertices, len(base.vertices), east, north)


def fastened(system: System, gives: float, fastener: Fastener) -> tuple[Tie, Tie]:
    """Ties of the uppermost body to both sides, along its narrower side, a given way up.

    Parameters
    ----------
    system : whose uppermost body is held
    gives : what a tie gives under a force as large as that body's weight [m]
    fastener : whose strength and slack each has

    Returns
    -------
    The tie towards the narrow direction, and that against it.
    """
    top = system.bodies[-1]
    below = sum(body.height for body in system.bodies[:-1])
    east, north = narrow_direction(top.base)
    height, far = FASTENED_AT * top.height, reach_of(top.base) + REACH
    aside = sum(contact.offset[0] for contact in system.contacts[1:])
    x, y, _ = top.centre
    found = []
    for way in (1.0, -1.0):
        ends = (
            x + aside + way * far * east,
            y + way * far * north,
            below + height,
        )
        found.append(
            Tie(
                (x, y, height),
                ends,
                tie_stiffness(top.mass, gives),
                slack=fastener.slack,
                strength=fastener.strength,
            )
        )
    return found[0], found[1]


def _damping(system: System, tie: Tie) -> float:
    """Damping of a bracket that swings with the uppermost body about its base [N s/m]."""
    top = system.bodies[-1]
    inertia = top.inertia
    across = (
        inertia
        if isinstance(inertia, int | float)
        else max(inertia[0][0], inertia[1][1])
    )
    height = tie.point[2]
    return bracket_damping(top.mass, across, top.centre[2], height, tie.stiffness)
