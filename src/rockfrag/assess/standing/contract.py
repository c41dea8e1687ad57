"""What a kind of standing is: an object as it stands, the ways in which it could, and what is simulated of it.

A kind is a class of its own in a file of this folder. It says which settings it takes, makes itself of them, and
answers what is asked of every object: its arrangements, its variants with each property moved, the changes that
may help, and the systems that are simulated of a body. ``planar`` is the simplest one.

In: settings of a request. Out: systems to be shaken. Docs: ``docs/assess.md``, "What is computed".
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Self

from rockfrag.assess.assumed import Assumption, Moved, moved_to_both_sides
from rockfrag.assess.core import bodies
from rockfrag.assess.standing.changes import changed_block, row_of, usual_changes
from rockfrag.assess.standing.holders import Holder, holders_beside
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.fragility.model_error import CUT
from rockfrag.simulation.options import system_of
from rockfrag.system import geometry
from rockfrag.system.blocks import Block, Body, stacked
from rockfrag.system.system import System, uplift_ratios
from rockfrag.words.findings import Finding, Value

TOLERANCES = {"width": 0.02, "cg_height": 0.05, "restitution": 0.05, "mass": 0.2}
"""Relative standard deviations of what was measured or assumed, unless stated."""

OF_A_TILT_TEST = 0.01
"""Relative standard deviation of the width over the height of its centre of gravity that a tilt test gives [-]."""

ALONE = Text.ON_THE_FLOOR  # How an object stands without a pedestal


@dataclass(frozen=True)
class Foundation:
    """What is known of every object, whatever its kind."""

    # What it stands on, from below; empty if it stands on the floor
    pedestals: tuple[Block, ...] = ()
    # Ratio of velocities at impacts [-]; None conserves momentum
    restitution: float | None = None
    # Coefficient of friction of all contacts [-]; None if nothing slides
    friction: float | None = None
    # Coefficient of a pad to be tried [-]; None to try none
    pad_friction: float | None = None
    # Relative standard deviations of width, height of the centre of gravity, restitution and mass
    tolerances: Mapping[str, float] = field(default_factory=dict)
    # Whether a tilt test says how wide it stands for the height of its centre of gravity
    tilted: bool = False
    # What holds it beside what it stands on
    holders: tuple[Holder, ...] = ()
    assumed: tuple[Assumption, ...] = ()  # What was not given
    quality_flags: tuple[Value, ...] = ()  # What looks wrong


@dataclass(frozen=True)
class Standing(ABC):
    """An object as it stands.

    Attributes
    ----------
    block : the object itself in the plane in which it rocks
    plane : in which direction that is
    under : what it stands on, and what was said of it
    restitution_factor : factor on every restitution [-]; impacts never gain energy
    """

    block: Block
    plane: Finding
    under: Foundation = field(default_factory=Foundation)
    restitution_factor: float = 1.0

    # Word by which key ``stands`` and the page's form ask for it, and id of its text; empty where sizes say
    # of which kind an object is
    option: ClassVar[str] = ""
    # Kind of body whose model error counts; of kinds without a campaign that of a cut block
    measured_as: ClassVar[str] = CUT
    # What of it makes it move in space; empty where it rocks in one plane
    in_space_by: ClassVar[str] = ""
    # Text of how it moves in space
    in_space_text: ClassVar[Text] = Text.MOVES_IN_SPACE
    # Whether it is answered in the worst direction of each record where it rocks in a plane
    from_all_sides: ClassVar[bool] = False
    # Names of properties that change nothing where it rocks in a plane
    idle_in_plane: ClassVar[frozenset[str]] = frozenset()
    # By how much of its extent corners of the base lie elsewhere in space, and it is turned [rad], by record
    base_spread: float = 0.0

    @classmethod
    @abstractmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Whether checked keys of ``statue.yaml`` are of an object of this kind."""

    @classmethod
    @abstractmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Make the object of checked keys of ``statue.yaml``; paths in them are relative to a folder."""

    # ---- what it stands on

    @property
    def pedestals(self) -> tuple[Block, ...]:
        """What it stands on, from below."""
        return self.under.pedestals

    @property
    def friction(self) -> float | None:
        """Coefficient of friction of all contacts [-]; None if nothing slides."""
        return self.under.friction

    @property
    def body(self) -> Body:
        """The object as it stands."""
        return stacked((*self.pedestals, self.block))

    @property
    def many(self) -> bool:
        """Whether a simulation takes milliseconds: more than two bodies on each other, or something that holds."""
        return len(self.pedestals) > 1 or bool(self.under.holders)

    @property
    def least_uplift(self) -> float:
        """Least peak acceleration of what it stands on at which any contact opens [g]: b/h of a uniform block."""
        return min(uplift_ratios(self.body.system()))

    @property
    def matters_in_space(self) -> tuple[str, ...]:
        """Keys that were given and change nothing where it rocks in one plane."""
        return ("base_spread",) if self.base_spread else ()

    # ---- what is asked of every kind

    def arrangements(self) -> dict[str, Body]:
        """The ways in which it can stand, by the ids of their texts, as it stands now first."""
        body = self.body
        if not self.pedestals:
            return {ALONE: body}
        on, fixed = Text.ON_ITS_PEDESTAL, Text.FIXED_TO_ITS_PEDESTAL
        if len(self.pedestals) > 1:
            on, fixed = Text.ON_ITS_PEDESTALS, Text.FIXED_TO_ITS_PEDESTALS
        return {on: body, fixed: body.rigidly_joined(), ALONE: self.block}

    def variants(self) -> list[Moved[Self]]:
        """The object with each property smaller and larger by its standard deviation."""
        return moved_to_both_sides(self.moves(), self.under.tolerances)

    def changes(self) -> dict[Finding, Body]:
        """Bodies that result from each change that may help."""
        return usual_changes(self.block, self.pedestals)

    def moves(self) -> dict[str, Callable[[float], Self]]:
        """How each property that is not known exactly is moved by a factor."""
        found: dict[str, Callable[[float], Self]] = {
            "width": lambda factor: self.stretched(width=factor),
            # what a tilt test says goes with the height of the centre of gravity
            "cg_height": lambda factor: self.stretched(
                factor if self.under.tilted else 1.0, factor
            ),
            # of a body in space that of the planar answer
            "restitution": lambda factor: replace(
                self, restitution_factor=self.restitution_factor * factor
            ),
        }
        if self.pedestals:
            found["mass"] = lambda factor: self.stretched(mass=factor)
        return found

    def stretched(
        self, width: float = 1.0, height: float = 1.0, mass: float = 1.0
    ) -> Self:
        """Return it with lengths and mass multiplied by factors [-], all edges moved alike.

        What carries is as uncertain at the foot of a pedestal as at that of a statue, so that ``width`` is a
        factor on all of them; ``height`` and ``mass`` are of the object alone.
        """
        pedestals = tuple(stretched_block(block, width) for block in self.pedestals)
        return replace(
            self,
            block=stretched_block(self.block, width, height, mass),
            under=replace(self.under, pedestals=pedestals),
        )

    def holders_to_try(self) -> list[Holder]:
        """What may hold it, or what it may do without."""
        return holders_beside(self.under.holders)

    # ---- what is simulated

    def held(self, system: System) -> System:
        """A system of it with what holds it."""
        for holder in self.under.holders:
            system = holder.on(system)
        return system

    def system_of(self, body: Body) -> System:
        """Return what is shaken in a plane: a body whose impacts lose what was measured or assumed."""
        system = body.system()
        if self.under.restitution is None and self.restitution_factor == 1:
            return system
        shapes = system.carried
        each = [self._ratios(shape, self.under.restitution) for shape in shapes]
        return system_of(system, restitution=each if len(each) > 1 else each[0])

    def _ratios(
        self, shape: geometry.Shape, measured: float | None
    ) -> tuple[float, float]:
        """Ratios of velocities at the right and left pivot, none of which gains energy."""
        e = math.nan if measured is None else measured
        right = geometry.scaled_restitution(shape, 1, e, self.restitution_factor)
        return right, geometry.scaled_restitution(shape, -1, e, self.restitution_factor)

    @property
    def in_space(self) -> bool:
        """Whether it is simulated under both components of each record."""
        return False

    def solid(self, body: Body) -> System | None:
        """The object in space on a pedestal that stays, in an arrangement; None where it is not known in space."""
        return None

    def in_plane(self) -> "Standing":
        """The object as it rocks in one plane, on edges."""
        return self

    def is_whole(self, top: Block) -> bool:
        """Whether a block is the object with what it is fixed to."""
        return bodies.is_whole(row_of(top), row_of(self.block))

    def check_in_space(self) -> None:
        """Refuse what holds it and is simulated in one plane only, where it moves in space."""
        solid = self.solid(self.body)
        if solid is None:
            return
        for holder in self.under.holders:
            if not holder.holds_in_space(solid):
                raise InputError(
                    f"key {holder.key_in_plane(solid)}: it is simulated in one plane, and {self.in_space_by} "
                    "makes the object move in space; leave out one of them."
                )

    def check(self) -> None:
        """Refuse a restitution with which an impact would gain energy."""
        e = self.under.restitution
        if e is None:
            return
        shapes = self.body.system().carried
        most = min(
            geometry.largest_restitution(shape, pivot)
            for shape in shapes
            for pivot in (1, -1)
        )
        if e > most:
            raise InputError(
                f"key restitution: with {e:g} an impact of this object would gain energy, as its centre of "
                "gravity is not above the middle of its base; give at most "
                f"{math.floor(1000 * most) / 1000:g}."
            )


def stretched_block(
    block: Block, width: float = 1.0, height: float = 1.0, mass: float = 1.0
) -> Block:
    """A block with edges further apart, a higher centre of gravity and more mass, by factors."""
    return changed_block(block, bodies.stretch, width, height, mass)
