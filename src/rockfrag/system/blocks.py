"""Rigid blocks and stacks of two: what every integrator, fast or plain, starts from.

Conventions (``docs/derivation.md``): a rotation θ > 0 is clockwise and its pivot is the right corner, s = +1; an
acceleration a > 0 of the ground pushes blocks towards θ < 0.  Lengths are read in the standing block's frame, x to
the right and y up, and R(θ)(x, y) = (x cos θ + y sin θ, -x sin θ + y cos θ) turns a vector clockwise.
"""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeGuard

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_number, shown
from rockfrag.base.keywords import named_fields
from rockfrag.base.plausible import block_warning
from rockfrag.base.units import GRAVITY
from rockfrag.system import geometry
from rockfrag.system import system as systems
from rockfrag.system.body import Interval, RigidBody, Tensor, checked_tensor
from rockfrag.system.contact import Contact
from rockfrag.system.system import System

LARGEST = 1e6
"""Width and height of a block are no larger: one of 1e12 m falls for days, which takes minutes to compute [m]."""


class UnlikelyBlock(UserWarning):
    """A block whose sizes or inertia are probably given in other units."""


@named_fields
@dataclass(frozen=True)
class Block:
    """A rigid body that stands on two edges.

    A warning, ``UnlikelyBlock``, tells of one that is larger than 20 m and lighter than air, or has the inertia of
    a body of another size.

    Parameters
    ----------
    width : between the two edges it stands and rocks on, 2b [m]
    height : of the block, 2h [m]
    mass : [kg]
    inertia : about the centre of gravity [kg m²]; if not given that of a uniform rectangle, m (b² + h²) / 3
    cg_height : of the centre of gravity above the base [m]; half the height if not given
    cg_offset : of the centre of gravity to the right of the middle of the base [m]
    lean : angle by which an uneven base makes the block lean clockwise as it stands [rad]
    depth : across the plane of motion [m]
        It makes the block a body in space with a rectangular base; its inertia, where given, is then the tensor,
        shape (3, 3) [kg m²].
    round : whether base and block are round, of the diameter ``width``; a body in space as well

    Examples
    --------
    >>> from rockfrag import Block
    >>> upper = Block(width=0.35, height=1.2, mass=180.0)
    >>> round(upper.alpha, 3), round(upper.frequency(), 2)
    (0.284, 3.43)
    """

    width: float
    height: float
    mass: float
    inertia: float | Tensor | None = None
    cg_height: float | None = None
    cg_offset: float = 0.0
    lean: float = 0.0
    depth: float | None = None
    round: bool = False

    def __post_init__(self) -> None:
        for name, unit in (
            ("width", "metres"),
            ("height", "metres"),
            ("mass", "kilograms"),
        ):
            self._check_number(name, unit, positive_number)
        if max(self.width, self.height) > LARGEST:
            raise InputError(
                f"Block: {self.width:g} m × {self.height:g} m: no block is larger than {LARGEST:g} m; give its "
                "width and height in metres."
            )
        self._check_space()
        if self.cg_height is not None:
            self._check_number("cg_height", "metres", positive_number)
        self._check_number("cg_offset", "metres", real_number)
        self._check_number("lean", "radians", real_number)
        if self.cg_height is not None and self.cg_height > self.height:
            raise InputError(
                f"Block: cg_height {self.cg_height} m is above the top, which is at height {self.height} m."
            )
        if flag := block_warning(
            self.width, self.height, self.mass, self.centroidal_inertia
        ):
            warnings.warn(f"Block: {flag}", UnlikelyBlock, stacklevel=4)
        if not geometry.can_stand(self.shape):
            raise InputError(
                f"Block: with cg_offset {self.cg_offset} m and lean {self.lean} rad its centre of "
                f"gravity is not above its base of {self.width} m, so it cannot stand."
            )

    def _check_number(
        self, name: str, unit: str, check: Callable[[str, object, str], float]
    ) -> None:
        """Refuse what is no number, and keep numpy's float32, a fraction and their like as a float."""
        number = check(f"Block: {name}", getattr(self, name), unit)
        if not isinstance(getattr(self, name), float | int):
            object.__setattr__(self, name, number)

    def _check_space(self) -> None:
        """Refuse an inertia, depth or roundness that do not fit together."""
        if not isinstance(self.round, bool):
            raise InputError(
                f"Block: round: expected True or False, got {shown(self.round)}."
            )
        if self.depth is not None:
            self._check_number("depth", "metres", positive_number)
            if self.round:
                raise InputError(
                    "Block: a round block has its width as depth; leave depth out."
                )
        if self.inertia is not None and self.in_space:
            object.__setattr__(self, "inertia", checked_tensor(self.inertia))
        elif self.inertia is not None:
            self._check_number("inertia", "kg m²", positive_number)

    @classmethod
    def from_edges(cls, left: float, right: float, **more: Any) -> "Block":
        """Make a block of the distances of its edges to the left and the right of the centre of gravity [m]."""
        return cls(width=left + right, cg_offset=(left - right) / 2, **more)

    @property
    def in_space(self) -> bool:
        """Whether the block is known in all directions, not in one plane only."""
        return self.round or self.depth is not None

    @property
    def blocks(self) -> "tuple[Block, ...]":
        """The blocks from below: this one."""
        return (self,)

    def rigidly_joined(self) -> "Block":
        """Return all blocks as one: this one."""
        return self

    def narrowed(self, retreat: float) -> "Block":
        """Return the block with both edges by ``retreat`` [m] further in."""
        return replace(self, width=self.width - 2 * retreat)

    @cached_property
    def body(self) -> RigidBody:
        """The block as a body of a system."""
        centre = (self.cg_offset, 0.0, self.h)
        if self.round:
            return systems.cylinder(
                self.width, self.height, self.mass, self.inertia, centre, name="block"
            )
        if self.depth is not None:
            sides = self.width, self.depth, self.height
            return systems.box(sides, self.mass, self.inertia, centre, "block")
        ends = Interval(-self.width / 2, self.width / 2)
        return RigidBody(
            self.mass, self.shape.inertia, centre, ends, self.height, ends, "block"
        )

    def system(self) -> System:
        """Return the block as a system: it rocks, never slides, and conserves momentum in impacts."""
        return System((self.body,), (Contact(tilt=self.lean),))

    @cached_property
    def shape(self) -> geometry.Shape:
        """The block as the kernels know it, in the plane of its width."""
        inertia = (
            self.inertia[1][1] if isinstance(self.inertia, tuple) else self.inertia
        )
        if inertia is None:
            inertia = math.nan
            if self.round:
                inertia = systems.round_inertia(self.width, self.height, self.mass)
        cg_height = math.nan if self.cg_height is None else self.cg_height
        return geometry.shape_of(
            self.width,
            self.height,
            self.mass,
            inertia,
            cg_height,
            self.cg_offset,
            self.lean,
        )

    @property
    def b(self) -> float:
        """Half the width [m]."""
        return self.shape.b

    @property
    def h(self) -> float:
        """Height of the centre of gravity above the base, before any lean [m]."""
        return self.height / 2 if self.cg_height is None else self.cg_height

    @property
    def centroidal_inertia(self) -> float:
        """Moment of inertia about the centre of gravity [kg m²]."""
        return self.shape.inertia

    @property
    def slenderness(self) -> float:
        """Height over width, H/B [-]."""
        return self.height / self.width

    def critical_angle(self, pivot: int) -> float:
        """Rotation about ``pivot`` (+1 right, -1 left) at which the block balances, positive [rad]."""
        return geometry.critical_angle(self.shape, pivot)

    @property
    def alpha(self) -> float:
        """The smaller of the two critical angles, θc = atan(b/h) of a symmetric block [rad]."""
        return min(self.critical_angle(+1), self.critical_angle(-1))

    def radius(self, pivot: int = 1) -> float:
        """Distance R from the pivot to the centre of gravity [m]."""
        return geometry.radius(self.shape, pivot)

    def pivot_inertia(self, pivot: int = 1) -> float:
        """Moment of inertia about the pivot, I_O = I_C + m R² [kg m²]."""
        return geometry.pivot_inertia(self.shape, pivot)

    def frequency(self, pivot: int = 1, g: float = GRAVITY) -> float:
        """Frequency parameter p = √(m g R / I_O) [1/s] (Housner, 1963)."""
        return geometry.frequency(self.shape, pivot, g)

    def momentum_restitution(self, pivot_before: int = 1) -> float:
        """Ratio of rates after and before an impact that conserves momentum, on the other pivot [-] (Housner)."""
        return geometry.momentum_restitution(self.shape, -pivot_before)


@named_fields
@dataclass(frozen=True)
class Stack:
    """A statue standing on a pedestal, both free to rock.

    The two touch where the statue's base and the pedestal's top overlap.  A statue that reaches beyond its
    pedestal rocks on the pedestal's upper edge, a point of both bodies as long as neither slides; so the ends
    of the overlap are the pivots, and all equations are those of a statue whose base is as wide as the overlap.

    Parameters
    ----------
    lower, upper : the blocks 1 and 2
    offset : of the middle of the statue's base to the right of the pedestal's middle [m]

    Examples
    --------
    >>> from rockfrag import Block, Stack
    >>> Stack(lower=Block(0.6, 0.4, 300.0), upper=Block(0.35, 1.2, 180.0)).mass
    480.0
    """

    lower: Block
    upper: Block
    offset: float = 0.0

    def __post_init__(self) -> None:
        for name, block in (("lower", self.lower), ("upper", self.upper)):
            if not isinstance(block, Block):
                raise InputError(f"Stack: {name} must be a Block, got {shown(block)}.")
        real_number("Stack: offset", self.offset, "metres")
        if self._is_upside_down:
            warnings.warn(
                f"Stack: a block of {self.upper.width:g} m × {self.upper.height:g} m on one of "
                f"{self.lower.width:g} m × {self.lower.height:g} m seems to stand upside down; the lower block "
                "comes first.",
                UnlikelyBlock,
                stacklevel=4,
            )
        pile, failed = self.pile, geometry.failed_stability_check(self.pile)
        if failed == geometry.STANDS:
            return
        overhang, pivot = max(
            (geometry.overhang(pile, pivot), pivot) for pivot in (1, -1)
        )
        wrong = {
            geometry.BESIDE: f"the statue's base (width {self.upper.width} m, offset {self.offset} m) "
            f"does not lie on the pedestal (width {self.lower.width} m).",
            geometry.OFF_CONTACT: "the statue's centre of gravity is not above the part of its base that lies "
            "on the pedestal, so the stack cannot stand.",
            geometry.TILTED_OFF: "a centre of gravity is not above its base once the pedestal's lean "
            "is counted, so the stack cannot stand.",
            geometry.REACHES_GROUND: f"the statue reaches {overhang:.4g} m beyond its pedestal, whose upper edge "
            f"can come as low as {geometry.lowest_edge(pile, pivot):.4g} m, so it could touch the ground; such "
            "contacts are not modelled.",
        }
        raise InputError(f"Stack: {wrong[failed]}")

    @property
    def _is_upside_down(self) -> bool:
        """Whether a squat, wider and heavier block stands on a slender one, as no statue does on its pedestal."""
        lower, upper = self.lower, self.upper
        wider, heavier = upper.width > lower.width, upper.mass > lower.mass
        return wider and heavier and lower.slenderness > 2 > upper.slenderness

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The blocks from below."""
        return self.lower, self.upper

    def system(self) -> System:
        """Return the stack as a system: it rocks, never slides, and conserves momentum in impacts."""
        return piled(self.blocks, (0.0, self.offset), ("lower body", "upper body"))

    @cached_property
    def pile(self) -> geometry.Pile:
        """The stack as the kernels know it."""
        lower, upper = self.lower, self.upper
        below = lower.shape
        face = geometry.Face(below.b, lower.height, lower.lean, 0.0, self.offset)
        return geometry.pile_of(below, upper.shape, face)

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return self.lower.mass + self.upper.mass

    def rigidly_joined(self) -> Block:
        """Return the two as one rigid body, which is what rocks in pattern 3."""
        whole = geometry.joined(self.pile)
        height = self.lower.height + self.upper.height
        return Block(
            self.lower.width, height, whole.mass, whole.inertia, whole.y, whole.x
        )


@named_fields
@dataclass(frozen=True)
class Column:
    """Any number of blocks on top of each other, all free to rock.

    Parameters
    ----------
    blocks : from below, 1 to 12
    offsets : of the middle of each base but the lowest to the right of that of the block below [m]; else zero
    """

    blocks: tuple[Block, ...]
    offsets: tuple[float, ...] | None = None

    if TYPE_CHECKING:
        # a list is taken as well, and kept as a tuple
        def __init__(
            self, blocks: Sequence[Block], offsets: Sequence[float] | None = None
        ) -> None: ...

    def __post_init__(self) -> None:
        if not isinstance(self.blocks, Sequence):
            raise InputError(
                "Column: expected a list of blocks from below, such as Column([base, statue]), got "
                f"{shown(self.blocks)}."
            )
        object.__setattr__(self, "blocks", tuple(self.blocks))
        for block in self.blocks:
            if not isinstance(block, Block):
                raise InputError(
                    f"Column: expected blocks from below, got {shown(block)}."
                )
        if not 1 <= len(self.blocks) <= systems.MOST_BODIES:
            raise InputError(
                f"Column: expected 1 to {systems.MOST_BODIES} blocks, got {len(self.blocks)}."
            )
        offsets = (
            (0.0,) * (len(self.blocks) - 1)
            if self.offsets is None
            else tuple(self.offsets)
        )
        if len(offsets) != len(self.blocks) - 1:
            raise InputError(
                f"Column: expected {len(self.blocks) - 1} offset(s), one for each block but the lowest, got "
                f"{len(offsets)}."
            )
        for offset in offsets:
            real_number("Column: offsets", offset, "metres")
        object.__setattr__(self, "offsets", offsets)
        if not systems.stands(self.system()):
            raise InputError(
                "Column: the blocks above one contact have their common centre of gravity beside it, so the "
                "column cannot stand."
            )

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return sum(block.mass for block in self.blocks)

    def rigidly_joined(self) -> Block:
        """Return all blocks as one rigid body on the lowest base."""
        x, y = systems.common_centre(self.system())
        inertia = 0.0
        for block, at in zip(
            self.blocks, systems.standing_centres(self.system()), strict=True
        ):
            apart = (at[0] - x) ** 2 + (at[1] - y) ** 2
            inertia += block.centroidal_inertia + block.mass * apart
        height = sum(block.height for block in self.blocks)
        return Block(self.blocks[0].width, height, self.mass, inertia, y, cg_offset=x)

    def narrowed(self, retreat: float) -> "Column":
        """Return the column with both edges of every block by ``retreat`` [m] further in."""
        return replace(
            self, blocks=tuple(block.narrowed(retreat) for block in self.blocks)
        )

    def system(self) -> System:
        """Return the column as a system: it rocks, never slides, and conserves momentum in impacts."""
        names = [f"body {k + 1}" for k in range(len(self.blocks))]
        return piled(self.blocks, (0.0, *(self.offsets or ())), names)


def piled(
    blocks: Sequence[Block], offsets: Sequence[float], names: Sequence[str]
) -> System:
    """Return the system of blocks on each other, from below, each with its offset [m] and name."""
    contacts = (
        Contact(tilt=block.lean, offset=(offset, 0.0))
        for block, offset in zip(blocks, offsets, strict=True)
    )
    bodies = [
        replace(block.body, name=name)
        for block, name in zip(blocks, names, strict=True)
    ]
    # one body that is known in a plane leaves all of them known there only
    if any(body.planar for body in bodies):
        bodies = [body.seen_along() for body in bodies]
    return System(tuple(bodies), tuple(contacts))


Body = Block | Stack | Column

SystemLike = Body | System  # what stands, as it may be written


def is_system(thing: object) -> TypeGuard[SystemLike]:
    """Whether a thing is a system, or writes one.

    Parameters
    ----------
    thing : anything

    Returns
    -------
    Whether every door takes it.
    """
    return isinstance(thing, (System, Block, Stack, Column))


def as_system(thing: SystemLike) -> System:
    """Take a system as it is, and make one of a block, a stack or a column.

    Parameters
    ----------
    thing : what is shaken; InputError if it is none of these

    Returns
    -------
    The system.
    """
    if not is_system(thing):
        raise InputError(
            f"body: expected a Block, a Stack, a Column or a System, got {shown(thing)}."
        )
    return thing if isinstance(thing, System) else thing.system()


def stacked(blocks: Sequence[Block]) -> Body:
    """Return blocks that stand on each other, from below, as a block, a stack or a column.

    Parameters
    ----------
    blocks : from below, at least one

    Returns
    -------
    A block, a stack of two, or a column of more.
    """
    if len(blocks) == 1:
        return blocks[0]
    return Stack(blocks[0], blocks[1]) if len(blocks) == 2 else Column(tuple(blocks))
