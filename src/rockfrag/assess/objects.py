"""The object and its pedestal as blocks, what was assumed of them, and what is not known to the digit."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from rockfrag.assess.moved import Moved, moved_to_both_sides
from rockfrag.errors import InputError
from rockfrag.plausibility import DENSITIES, STONE, check_density, size_warning
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag.system.mesh import read_shape

COMMON = (150.0, 9000.0)
"""Densities of the box around an object that are usual, from hollow wood to solid bronze [kg/m³]."""

CONTACT_TOLERANCE = 0.002
"""Height above its lowest point up to which a scanned statue carries, unless stated [m]."""

TOLERANCES = {"width": 0.02, "cg_height": 0.05, "restitution": 0.05, "mass": 0.2}
"""Relative standard deviations of what was measured or assumed, unless stated."""

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
    tolerances
        Relative standard deviations of width, height of the centre of gravity, restitution and mass.
    plane
        In words, in which direction it rocks.
    assumed
        Sentences, one for each thing that was not given.
    doubts
        Sentences, one for each thing that looks wrong.
    """

    statue: Block
    pedestal: Block | None
    restitution: float | None
    friction: float | None
    tolerances: Mapping[str, float]
    plane: str
    assumed: tuple[str, ...] = ()
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

    def restitution_of(self, body: Body) -> float | tuple[float, float] | None:
        """Restitution of a body as the simulations take it: a pair for a stack."""
        e = self.restitution
        return (e, e) if e is not None and isinstance(body, Stack) else e

    def variants(self) -> list[Moved["Objects"]]:
        """The object with each property smaller and larger by its standard deviation."""
        moves: dict[str, Callable[[float], Objects]] = {
            "width": partial(_wider, self),
            "cg_height": partial(_higher, self),
            "restitution": partial(_livelier, self),
        }
        if self.pedestal is not None:
            moves["mass"] = partial(_heavier, self)
        return moved_to_both_sides(moves, self.tolerances)


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
    """Measured restitution, or what the momentum of the statue leaves, times a factor but at most 1."""
    e = objects.restitution
    if e is None:
        e = min(objects.statue.momentum_restitution(pole) for pole in (1, -1))
        if objects.pedestal is not None:
            joined = Stack(objects.pedestal, objects.statue).rigidly_joined()
            e = min(e, joined.momentum_restitution(1))
    return replace(objects, restitution=min(max(e, 0.0) * factor, 1.0))


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
    assumed: list[str] = []
    doubts: list[str] = []
    if "mesh" in settings:
        statue, plane = _from_mesh(settings, folder, assumed)
    else:
        statue, plane = _from_dimensions(settings, assumed, doubts)
    pedestal = None
    if "pedestal" in settings:
        pedestal = _pedestal(settings["pedestal"], settings, assumed)
        try:
            Stack(pedestal, statue)
        except InputError as error:
            raise InputError(f"pedestal: {error}") from None
    for block in (statue, pedestal):
        if block is not None and (doubt := size_warning(block.width, block.height)):
            doubts.append(doubt + ".")
    if "restitution" not in settings:
        assumed.append(
            "Impacts lose what conservation of momentum takes (Housner), the restitution was not measured."
        )
    tolerances = TOLERANCES | {
        key: float(value)
        for key, value in settings.get("tolerances", {}).items()
        if key in TOLERANCES
    }
    return Objects(
        statue=statue,
        pedestal=pedestal,
        restitution=settings.get("restitution"),
        friction=settings.get("friction"),
        tolerances=tolerances,
        plane=plane,
        assumed=tuple(assumed),
        doubts=tuple(doubts),
    )


def _from_dimensions(
    settings: Mapping[str, Any], assumed: list[str], doubts: list[str]
) -> tuple[Block, str]:
    missing = [name for name in ("width", "height") if f"{name}_m" not in settings]
    if missing:
        raise InputError(f"{missing[0]} is missing; give at least width and height, such as 35 cm.")
    width, height = float(settings["width_m"]), float(settings["height_m"])
    depth = float(settings.get("depth_m", width))
    plane = f"across its {100 * width:.4g} cm"
    if depth < width:
        plane = f"across its {100 * depth:.4g} cm, the narrower side"
        width, depth = depth, width
    elif "depth_m" not in settings:
        assumed.append(f"Depth {100 * depth:.4g} cm, as its width.")
    mass = settings.get("mass_kg")
    if mass is None:
        mass = STONE * width * depth * height
        assumed.append(f"Mass {mass:.3g} kg, a box of {STONE:g} kg/m³.")
    check_density(width, height, float(mass))
    if "depth_m" in settings:
        doubts += _density_doubts(float(mass), width * depth * height)
    if "cg_height_m" not in settings:
        assumed.append("Centre of gravity at half the height.")
    cg_height = settings.get("cg_height_m")
    if cg_height is not None and cg_height >= height:
        raise InputError(
            f"cg_height: {cg_height:g} m is not below the top, at {height:g} m; check the unit."
        )
    block = Block(
        width=width,
        height=height,
        mass=float(mass),
        inertia=settings.get("inertia_kg_m2"),
        cg_height=cg_height,
        cg_offset=float(settings.get("cg_offset_m", 0.0)),
    )
    return block, plane


def _density_doubts(mass: float, volume: float) -> list[str]:
    """Say that the density of the box around the object is unusual; refuse one that no solid has."""
    density = mass / volume
    words = f"{mass:g} kg in a box of {volume:.3g} m³ are {density:.3g} kg/m³"
    if not DENSITIES[0] <= density <= DENSITIES[1]:
        raise InputError(f"mass: {words}, a density that no solid has; check the units.")
    if not COMMON[0] <= density <= COMMON[1]:
        return [f"{words}, which is unusual; check the units."]
    return []


def _from_mesh(settings: Mapping[str, Any], folder: Path, assumed: list[str]) -> tuple[Block, str]:
    """The planar block of a scanned statue, in the direction towards which it leans over at the least angle."""
    mesh = settings["mesh"]
    needless = [key for key in ("width_m", "height_m", "depth_m", "cg_height_m") if key in settings]
    if needless:
        raise InputError(f"{needless[0].rpartition('_')[0]} follows from the mesh; leave it out.")
    mass = settings.get("mass_kg")
    if mass is None:
        assumed.append(f"Solid stone of {STONE:g} kg/m³.")
    shape = read_shape(
        folder / mesh["file"],
        mass=mass,
        density=STONE if mass is None else None,
        metres_per_unit=float(mesh.get("metres_per_unit", 1.0)),
    )
    tolerance = mesh.get("contact_tolerance_m")
    if tolerance is None:
        tolerance = CONTACT_TOLERANCE
        assumed.append(f"Points within {1000 * tolerance:g} mm of the lowest carry.")
    direction, angle = shape.worst_direction(tolerance)
    block = shape.block(direction, tolerance, float(mesh.get("edge_retreat_m", 0.0)))
    plane = f"towards {direction:.0f}° of the mesh, where it balances at {math.degrees(angle):.1f}°"
    return block, plane


def _pedestal(given: Mapping[str, Any], settings: Mapping[str, Any], assumed: list[str]) -> Block:
    """The pedestal in the plane in which the statue rocks."""
    width, height = float(given["width_m"]), float(given["height_m"])
    depth = float(given.get("depth_m", width))
    across = settings.get("depth_m", math.inf) < settings.get("width_m", math.inf)
    if across:
        width, depth = depth, width
    mass = given.get("mass_kg")
    if mass is None:
        mass = STONE * width * depth * height
        assumed.append(f"Pedestal of {mass:.3g} kg, a box of {STONE:g} kg/m³.")
    try:
        check_density(width, height, float(mass))
    except InputError as error:
        raise InputError(f"pedestal: {error}") from None
    return Block(width, height, float(mass))
