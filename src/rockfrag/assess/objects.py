"""The object and its pedestal as blocks, what was assumed of them, and what is not known to the digit."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from rockfrag.assess.assumed import Assumption
from rockfrag.assess.moved import Moved, moved_to_both_sides
from rockfrag.errors import InputError
from rockfrag.plausibility import DENSITIES, STONE, check_density, size_warning
from rockfrag.rocking.measured_restitution import Measured, largest_restitution
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag.system.mesh import Shape, read_shape
from rockfrag.system.system import diagonal, round_inertia

COMMON = (150.0, 9000.0)
"""Densities of the box around an object that are usual, from hollow wood to solid bronze [kg/m³]."""

CONTACT_TOLERANCE = 0.002
"""Height above its lowest point up to which a scanned statue carries, unless stated [m]."""

TOLERANCES = {"width": 0.02, "cg_height": 0.05, "restitution": 0.05, "mass": 0.2}
"""Relative standard deviations of what was measured or assumed, unless stated."""

CONTACT_SPREAD, KNOWN_CONTACT_SPREAD = 0.6, 0.2
"""Relative standard deviation of the contact tolerance of a scan that was assumed, and of one that was given:
of ours; for a granite rock on a shaking table 0.5 to 1.9 mm were plausible."""

_RETREATS = (1.0, 0.75, 0.5, 0.25)
"""Parts of a step towards a contact tolerance that are tried until the object stands."""

ROLLING = 1.0
"""Restitution of a round base: its rim rolls from edge to edge and loses nothing."""

ALONE, ON_PEDESTAL, JOINED = "on the floor", "on its pedestal", "fixed to its pedestal"
"""Ways in which an object can stand."""


@dataclass(frozen=True)
class Objects:
    """The object in the plane in which it rocks, and what it stands on.

    Attributes
    ----------
    statue
        The object.
    pedestal
        Its pedestal; None if it stands on the floor.
    restitution
        Measured ratio of angular velocities at an impact [-]; None conserves momentum.
    friction
        Coefficient of friction of all contacts [-]; None if nothing slides.
    round
        Whether the base of the object is round: it then rolls on its rim in space and loses nothing.
    scan
        The scan as it stands on points within some tolerance; None where dimensions were given.
    livelier
        Factor on every restitution, measured or not [-]; impacts never gain energy.
    tolerances
        Relative standard deviations of width, height of the centre of gravity, restitution and mass.
    plane
        In words, in which direction it rocks.
    assumed
        What was not given.
    doubts
        Sentences, one for each thing that looks wrong.
    """

    statue: Block
    pedestal: Block | None
    restitution: float | None
    friction: float | None
    tolerances: Mapping[str, float]
    plane: str
    round: bool = False
    scan: "Scan | None" = None
    livelier: float = 1.0
    assumed: tuple[Assumption, ...] = ()
    doubts: tuple[str, ...] = ()

    @property
    def body(self) -> Body:
        """The object as it stands."""
        return self.statue if self.pedestal is None else Stack(self.pedestal, self.statue)

    @property
    def arrangements(self) -> dict[str, Body]:
        """The ways in which it can stand, as it stands now first."""
        if self.pedestal is None:
            return {ALONE: self.statue}
        stack = Stack(self.pedestal, self.statue)
        return {ON_PEDESTAL: stack, JOINED: stack.rigidly_joined(), ALONE: self.statue}

    @property
    def least_uplift(self) -> float:
        """Least peak acceleration of what it stands on at which any contact opens [g]: b/h of a uniform block."""
        body = self.body
        arms = [body.common_arm, body.statue_arm] if isinstance(body, Stack) else [body.arm]
        return min(abs(arm(pole).x) / arm(pole).y for arm in arms for pole in (1, -1))

    def restitution_of(self, body: Body) -> Sequence[Measured] | None:
        """Restitution of a body as the simulations take it: of a block (right, left), of a stack a pair of them.

        Parameters
        ----------
        body
            An arrangement of the object, with or without changes; no impact of it gains energy.
        """
        if self.restitution is None and self.livelier == 1 and not self.round:
            return None
        if isinstance(body, Stack):
            return [
                self._ratios(body.pedestal, rolls=False),
                self._ratios(body.contact_statue, self.round),
            ]
        # on the floor it stands on its own base, fixed to its pedestal on that of the pedestal
        return self._ratios(body, self.round and body.height == self.statue.height)

    def _ratios(self, block: Block, rolls: bool) -> tuple[float, float]:
        right, left = (self._ratio(block, pole, rolls) for pole in (1, -1))
        return right, left

    def _ratio(self, block: Block, pole: int, rolls: bool) -> float:
        measured = ROLLING if rolls else self.restitution
        e = block.momentum_restitution(pole) if measured is None else measured
        return min(max(e, 0.0) * self.livelier, largest_restitution(block, pole))

    def rolling(self, body: Body) -> Block | None:
        """The round object in space where it is free to roll in an arrangement; None where there is none.

        Parameters
        ----------
        body
            An arrangement of the object, with or without changes; under it a pedestal stays where it is.
        """
        top = body.statue if isinstance(body, Stack) else body
        if not self.round or top.height != self.statue.height:
            return None
        across = top.centroidal_inertia
        along = top.mass * top.width**2 / 8
        return replace(top, round=True, inertia=diagonal(across, across, along))

    def variants(self) -> list[Moved["Objects"]]:
        """The object with each property smaller and larger by its standard deviation."""
        moves: dict[str, Callable[[float], Objects]] = {
            "width": partial(_wider, self),
            "cg_height": partial(_higher, self),
        }
        if not self.round:
            moves["restitution"] = partial(_livelier, self)
        if self.pedestal is not None:
            moves["mass"] = partial(_heavier, self)
        if self.scan is not None:
            moves["contact"] = partial(_carried_by, self, self.scan)
        spreads = dict(self.tolerances)
        if self.scan is not None:
            spreads.setdefault("contact", self.scan.spread)
        return moved_to_both_sides(moves, spreads)


@dataclass(frozen=True)
class Scan:
    """A scan that stands on all points within some height above the lowest one.

    Attributes
    ----------
    shape
        The scan.
    tolerance
        That height [m].
    retreat
        Distance by which edges carry further in [m].
    spread
        Relative standard deviation of the height [-].
    """

    shape: Shape
    tolerance: float
    retreat: float
    spread: float

    def block(self, factor: float = 1.0) -> tuple[Block, float, float]:
        """Return the block where it balances at the least angle, its direction [degrees] and angle [rad].

        Parameters
        ----------
        factor
            On the height up to which points carry.
        """
        direction, angle = self.shape.worst_direction(self.tolerance * factor)
        return self.shape.block(direction, self.tolerance * factor, self.retreat), direction, angle


def _carried_by(objects: Objects, scan: Scan, factor: float) -> Objects:
    """Let points carry up to another height; as near to it as the object still stands."""
    for part in _RETREATS:
        try:
            statue, *_ = scan.block(1 + part * (factor - 1))
            moved = replace(objects, statue=statue)
            _ = moved.body
        except InputError:
            continue
        return moved
    return objects


def _wider(objects: Objects, factor: float) -> Objects:
    """Move all edges: what carries is uncertain at the foot of a pedestal as at that of a statue."""
    return replace(
        objects,
        statue=wider(objects.statue, factor),
        pedestal=None if objects.pedestal is None else wider(objects.pedestal, factor),
    )


def wider(block: Block, factor: float) -> Block:
    """A block whose edges are further apart; mass, centre of gravity and inertia stay."""
    return replace(block, width=block.width * factor, inertia=block.centroidal_inertia)


def _higher(objects: Objects, factor: float) -> Objects:
    return replace(objects, statue=higher(objects.statue, factor))


def higher(block: Block, factor: float) -> Block:
    """A block whose centre of gravity is higher; its inertia about it stays."""
    return replace(
        block,
        cg_height=min(block.h * factor, block.height),
        inertia=block.centroidal_inertia,
    )


def _livelier(objects: Objects, factor: float) -> Objects:
    return replace(objects, livelier=objects.livelier * factor)


def _heavier(objects: Objects, factor: float) -> Objects:
    statue = objects.statue
    heavier = replace(statue, mass=statue.mass * factor, inertia=statue.centroidal_inertia * factor)
    return replace(objects, statue=heavier)


def make_objects(settings: Mapping[str, Any], folder: Path) -> Objects:
    """Make the object and its pedestal of checked settings.

    Parameters
    ----------
    settings
        Checked keys of ``statue.yaml``.
    folder
        Folder from which the path of a mesh is read.

    Raises
    ------
    InputError
        If they could be of no solid, cannot stand, or a dimension is missing.
    """
    assumed: list[Assumption] = []
    doubts: list[str] = []
    is_round = bool(settings.get("round", False))
    scan = None
    if "mesh" in settings:
        scan, statue, plane = _from_mesh(settings, folder, assumed)
    else:
        statue, plane = _from_dimensions(settings, assumed, doubts)
    pedestal = None
    if "pedestal" in settings:
        pedestal = _pedestal(settings["pedestal"], settings, assumed)
        try:
            Stack(pedestal, statue)
        except InputError as error:
            raise InputError(f"key pedestal: {error}") from None
    for block in (statue, pedestal):
        if block is not None and (doubt := size_warning(block.width, block.height)):
            doubts.append(doubt + ".")
    first = [_of_the_base(is_round, "mesh" in settings)]
    if not is_round and "restitution" not in settings:
        first.append(_RESTITUTION)
    objects = Objects(
        statue=statue,
        pedestal=pedestal,
        restitution=settings.get("restitution"),
        friction=settings.get("friction"),
        tolerances=_tolerances(settings),
        plane=plane,
        round=is_round,
        scan=scan,
        assumed=(*first, *assumed),
        doubts=tuple(doubts),
    )
    _check_restitution(objects)
    return objects


_RESTITUTION = Assumption(
    "impacts lose what conservation of momentum takes",
    "Each impact takes as much energy as conservation of momentum does (Housner 1963); the restitution was not "
    "measured.",
    ("restitution",),
)


def _of_the_base(is_round: bool, is_mesh: bool) -> Assumption:
    if is_round:
        return Assumption(
            "the round base rolls on its rim in space and loses no energy",
            "The base is round: it is simulated in space under both components of each record, where it rolls on "
            "its rim, which takes no energy; planar impacts that conserve momentum would overstate by a factor of "
            "about two the shaking that a round object survives.",
        )
    if is_mesh:
        return Assumption(
            "it rocks in one plane",
            "It rocks in the plane in which it balances at the least angle.",
        )
    return Assumption(
        "the base is rectangular",
        "The base is taken as rectangular; a round one (round) falls at about half the shaking.",
    )


def _tolerances(settings: Mapping[str, Any]) -> Mapping[str, float]:
    given = settings.get("tolerances", {})
    if "mass" in given and "pedestal" not in settings:
        raise InputError(
            "key tolerances.mass: has no effect on an object without a pedestal; leave it out."
        )
    if "restitution" in given and settings.get("round"):
        raise InputError("key tolerances.restitution: a round base loses nothing; leave it out.")
    if "contact" in given and "mesh" not in settings:
        raise InputError("key tolerances.contact: is that of a scan; leave it out.")
    return TOLERANCES | {
        key: float(given[key]) for key in given if key in TOLERANCES or key == "contact"
    }


def _check_restitution(objects: Objects) -> None:
    """Refuse a restitution that goes with nothing else, or with which an impact would gain energy."""
    e = objects.restitution
    if objects.friction is not None and (e is not None or objects.round):
        other = "a round base" if objects.round else "a measured restitution"
        raise InputError(
            f"key friction: sliding is not simulated together with {other}; leave one out."
        )
    if e is None:
        return
    if objects.round:
        raise InputError(
            "key restitution: a round base rolls on its rim and is taken to lose nothing; leave it out."
        )
    body = objects.body
    blocks = [body.pedestal, body.contact_statue] if isinstance(body, Stack) else [body]
    most = min(largest_restitution(block) for block in blocks)
    if e > most:
        raise InputError(
            f"key restitution: with {e:g} an impact of this object would gain energy, as its centre of gravity "
            f"is not above the middle of its base; give at most {math.floor(1000 * most) / 1000:g}."
        )


def _from_dimensions(
    settings: Mapping[str, Any], assumed: list[Assumption], doubts: list[str]
) -> tuple[Block, str]:
    missing = [name for name in ("width", "height") if f"{name}_m" not in settings]
    if missing:
        raise InputError(
            f"key {missing[0]} is missing; give at least width and height, such as 35 cm and 1.2 m."
        )
    width, height = float(settings["width_m"]), float(settings["height_m"])
    is_round = settings.get("round", False)
    if is_round and settings.get("depth_m", width) != width:
        raise InputError(
            "key depth: a round base has one width, its diameter; leave the depth out, or round."
        )
    depth = float(settings.get("depth_m", width))
    plane = f"across its {100 * width:.4g} cm"
    if depth < width:
        plane = f"across its {100 * depth:.4g} cm, the narrower side"
        width, depth = depth, width
    elif "depth_m" not in settings and not is_round:
        # the mass that follows counts only on a pedestal
        assumed.append(
            Assumption(
                f"its depth is {100 * depth:.4g} cm",
                f"Its depth is {100 * depth:.4g} cm, as its width.",
            )
        )
    mass = settings.get("mass_kg")
    if mass is None:
        mass = STONE * width * depth * height * (math.pi / 4 if is_round else 1.0)
        solid = "cylinder" if is_round else "box"
        assumed.append(
            Assumption(
                f"its mass is {mass:.3g} kg",
                f"Its mass is {mass:.3g} kg, that of a {solid} of stone ({STONE:g} kg/m³).",
                ("mass",),
            )
        )
    check_density(width, height, float(mass))
    if "depth_m" in settings:
        doubts += _density_doubts(float(mass), width * depth * height)
    if "cg_height_m" not in settings:
        assumed.append(
            Assumption(
                "its centre of gravity is at half the height",
                "Its centre of gravity is at half the height.",
                ("cg_height",),
            )
        )
    cg_height = settings.get("cg_height_m")
    if cg_height is not None and cg_height >= height:
        raise InputError(
            f"key cg_height: {cg_height:g} m is not below the top, at {height:g} m; check the unit."
        )
    block = Block(
        width=width,
        height=height,
        mass=float(mass),
        inertia=settings.get("inertia_kg_m2", round_inertia(width, height, float(mass)))
        if is_round
        else settings.get("inertia_kg_m2"),
        cg_height=cg_height,
        cg_offset=float(settings.get("cg_offset_m", 0.0)),
    )
    return block, plane


def _density_doubts(mass: float, volume: float) -> list[str]:
    """Say that the density of the box around the object is unusual; refuse one that no solid has."""
    density = mass / volume
    words = f"{mass:g} kg in a box of {volume:.3g} m³ are {density:.3g} kg/m³"
    if not DENSITIES[0] <= density <= DENSITIES[1]:
        raise InputError(f"key mass: {words}, a density that no solid has; check the units.")
    if not COMMON[0] <= density <= COMMON[1]:
        return [f"{words}, which is unusual; check the units."]
    return []


_FROM_MESH = ("width_m", "height_m", "depth_m", "cg_height_m", "cg_offset_m", "inertia_kg_m2")


def _from_mesh(
    settings: Mapping[str, Any], folder: Path, assumed: list[Assumption]
) -> tuple[Scan, Block, str]:
    """The planar block of a scanned statue, in the direction towards which it leans over at the least angle."""
    mesh = settings["mesh"]
    needless = [key for key in _FROM_MESH if key in settings]
    if needless:
        raise InputError(f"key {needless[0]} follows from the mesh; leave it out.")
    mass = settings.get("mass_kg")
    if mass is None:
        assumed.append(
            Assumption("it is solid stone", f"It is solid stone of {STONE:g} kg/m³.", ("mass",))
        )
    if mesh.get("hull"):
        assumed.append(
            Assumption(
                "its convex hull stands for it",
                "Its convex hull stands for it, which fills hollows and undercuts; the centre of gravity moves "
                "with "
                "them.",
                ("cg_height",),
            )
        )
    tolerance = mesh.get("contact_tolerance_m")
    if tolerance is None:
        tolerance = CONTACT_TOLERANCE
        assumed.append(
            Assumption(
                f"points within {1000 * tolerance:g} mm of the lowest one carry",
                f"Points of the scan within {1000 * tolerance:g} mm of the lowest one carry; the answer depends "
                "much "
                "on that where the foot is uneven.",
                ("contact",),
            )
        )
    spread = KNOWN_CONTACT_SPREAD if "contact_tolerance_m" in mesh else CONTACT_SPREAD
    try:
        shape = _shape(mesh, folder, mass)
        scan = Scan(shape, tolerance, float(mesh.get("edge_retreat_m", 0.0)), spread)
        block, direction, angle = scan.block()
    except InputError as error:
        raise InputError(_in_keys(str(error))) from None
    plane = f"towards {direction:.0f}° of the mesh, where it balances at {math.degrees(angle):.1f}°"
    return scan, block, plane


def _shape(mesh: Mapping[str, Any], folder: Path, mass: float | None) -> Shape:
    return read_shape(
        folder / mesh["file"],
        mass=mass,
        density=STONE if mass is None else None,
        metres_per_unit=float(mesh.get("metres_per_unit", 1.0)),
        up=mesh.get("up"),
        hull=bool(mesh.get("hull", False)),
    )


def _in_keys(words: str) -> str:
    """Name the keys of a file instead of the parameters of the library."""
    for parameter, key in (
        ("hull=True", "key mesh.hull: true"),
        ("give up='", "give key mesh.up: "),
        ("metres_per_unit", "key mesh.metres_per_unit"),
        ("contact_tolerance", "key mesh.contact_tolerance"),
    ):
        words = words.replace(parameter, key)
    return words.replace("'.", ".") if "mesh.up" in words else words


def _pedestal(
    given: Mapping[str, Any], settings: Mapping[str, Any], assumed: list[Assumption]
) -> Block:
    """The pedestal in the plane in which the statue rocks."""
    width, height = float(given["width_m"]), float(given["height_m"])
    depth = float(given.get("depth_m", width))
    across = settings.get("depth_m", math.inf) < settings.get("width_m", math.inf)
    if across:
        width, depth = depth, width
    mass = given.get("mass_kg")
    if mass is None:
        mass = STONE * width * depth * height
        assumed.append(
            Assumption(
                f"the pedestal weighs {mass:.3g} kg",
                f"The pedestal weighs {mass:.3g} kg, as a box of stone ({STONE:g} kg/m³).",
                ("mass",),
            )
        )
    try:
        check_density(width, height, float(mass))
    except InputError as error:
        raise InputError(f"key pedestal: {error}") from None
    return Block(width, height, float(mass))
