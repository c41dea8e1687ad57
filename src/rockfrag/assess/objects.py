"""The object and what it stands on as blocks, what was assumed of them, and what is not known to the digit."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.assess.assumed import (
    Assumption,
    Moved,
    assume,
    moved_to_both_sides,
    tolerances_in,
)
from rockfrag.assess.scan import Scan, make_scan
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.plausible import DENSITIES, STONE, check_density, size_warning
from rockfrag.fragility.model_error import CUT, SCAN
from rockfrag.simulation.options import system_of
from rockfrag.system import geometry
from rockfrag.system.blocks import Block, Body, stacked
from rockfrag.system.body import Polygon, RigidBody, checked_tensor
from rockfrag.system.contact import Contact
from rockfrag.system.mesh import read_shape
from rockfrag.system.system import (
    System,
    round_inertia,
    turned_about_vertical,
    uplift_ratios,
)

# Usual densities of the box around an object, from wood to bronze [kg/m³]
COMMON = (150.0, 9000.0)

TOLERANCES = {"width": 0.02, "cg_height": 0.05, "restitution": 0.05, "mass": 0.2}
"""Relative standard deviations of what was measured or assumed, unless stated."""

ON_POINTS = {"livelier": 0.85, "restitution": 0.1}
"""Middle and relative standard deviation of the restitution of a scanned body over that of momentum, which is
uniform from 0.7 to 1 (:mod:`rockfrag.campaign.standing`)."""

# Restitution of a round base: its rim rolls from edge to edge and loses nothing
ROLLING = 1.0
# Height of a body that is another one than the object, over that of the object
HIGHER = 1.0 + 1e-9

# To both sides of how it faces the shaking, where nobody said it [degrees]
ASIDE = 45.0

ALONE = "on the floor"  # How an object stands without a pedestal


@dataclass(frozen=True)
class Objects:
    """The object in the plane in which it rocks, and what it stands on."""

    block: Block  # The object itself
    # What it stands on, from below; empty if it stands on the floor
    pedestals: tuple[Block, ...]
    # Ratio of velocities at impacts [-]; None conserves momentum
    restitution: float | None
    # Coefficient of friction of all contacts [-]; None if nothing slides
    friction: float | None
    # Relative standard deviations of width, height of the centre of gravity, restitution and mass
    tolerances: Mapping[str, float]
    plane: str  # In words, in which direction it rocks
    # Whether its base is round: it rolls on its rim in space and loses nothing
    round: bool = False
    # Side of a rectangular base across that plane [m]; None if not used
    depth: float | None = None
    # Of that plane, from first to second component of records [degrees]
    facing_deg: float = 0.0
    # Whether nobody said how it faces the shaking, which counts
    faces_anywhere: bool = False
    # By how much of its extent corners of the base lie elsewhere in space, and it is turned [rad], by record
    base_spread: float = 0.0
    # The scan as it may stand; None where dimensions were given
    scan: Scan | None = None
    # The scan in space as it stands; None if there is none
    scanned: RigidBody | None = None
    livelier: float = 1.0  # Factor on every restitution [-]; impacts never gain energy
    assumed: tuple[Assumption, ...] = ()  # What was not given
    # Sentences, one for each thing that looks wrong
    quality_flags: tuple[str, ...] = ()
    # Coefficient of a pad to be tried [-]; None to try none
    pad_friction: float | None = None

    @property
    def body(self) -> Body:
        """The object as it stands."""
        return stacked((*self.pedestals, self.block))

    @property
    def kind(self) -> str:
        """Kind of body whose model error counts: of a round base that of a cut block, as no campaign has one."""
        return SCAN if self.scan else CUT

    @property
    def many(self) -> bool:
        """Whether more than two bodies stand on each other, each of whose simulations takes milliseconds."""
        return len(self.pedestals) > 1

    @property
    def stand(self) -> str:
        """What it stands on in a word."""
        return "pedestals" if self.many else "pedestal"

    @property
    def arrangements(self) -> dict[str, Body]:
        """The ways in which it can stand, as it stands now first."""
        body, under = self.body, f"its {self.stand}"
        if not self.pedestals:
            return {ALONE: body}
        joined = body.rigidly_joined()
        return {f"on {under}": body, f"fixed to {under}": joined, ALONE: self.block}

    @property
    def least_uplift(self) -> float:
        """Least peak acceleration of what it stands on at which any contact opens [g]: b/h of a uniform block."""
        return min(uplift_ratios(self.body.system()))

    def system_of(self, body: Body) -> System:
        """Return what is shaken: a body whose impacts lose what was measured or assumed, and gain no energy."""
        system = body.system()
        if self.restitution is None and self.livelier == 1 and not self.round:
            return system
        # on the floor it stands on its own base, fixed to its pedestal on that of the pedestal
        rolls = self.round and body.blocks[-1].height == self.block.height
        *below, top = system.carried
        each = [
            *(self._ratios(shape, rolls=False) for shape in below),
            self._ratios(top, rolls),
        ]
        return system_of(system, restitution=each if below else each[0])

    def _ratios(self, shape: geometry.Shape, rolls: bool) -> tuple[float, float]:
        measured = ROLLING if rolls else self.restitution
        e = math.nan if measured is None else measured
        right, left = (
            geometry.scaled_restitution(shape, pivot, e, self.livelier)
            for pivot in (1, -1)
        )
        return right, left

    @property
    def in_space(self) -> bool:
        """Whether it is simulated under both components of each record.

        A rectangular base is if its depth is known, and a scan on the polygon of the points that carry, unless its
        restitution was measured.
        """
        usual = 1.0 if self.scan is None else ON_POINTS["livelier"]
        known = self.depth is not None or self.scanned is not None
        plain = known and self.restitution is None and self.livelier == usual
        return self.round or (plain and self.pad_friction is None)

    def in_plane(self) -> "Objects":
        """The object as it rocks in one plane, on edges."""
        return replace(self, round=False, depth=None, scanned=None)

    def solid(self, body: Body) -> System | None:
        """The object in space on a pedestal that stays, in an arrangement; None where it is not known in space."""
        top = body.blocks[-1]
        whole = top.height > self.block.height * HIGHER
        if not self.in_space or (whole and self.depth is None):
            return None
        if self.scanned is not None:
            return System((self._changed(self.scanned, top),), (Contact(),))
        if self.round:
            across = top.centroidal_inertia
            along = top.mass * top.width * top.width / 8
            tensor = checked_tensor(np.diag((across, across, along)))
            return replace(top, round=True, inertia=tensor).system()
        return turned_about_vertical(
            self._box(top, whole=whole).system(), self.facing_deg
        )

    def _changed(self, scanned: RigidBody, top: Block) -> RigidBody:
        """The scan in space with what another block differs by from the object's."""
        added = top.centroidal_inertia - self.block.centroidal_inertia
        factors = (
            top.width / self.block.width,
            top.h / self.block.h,
            top.mass / scanned.mass,
        )
        about = checked_tensor(scanned.tensor + np.diag([added, added, 0.0]))
        return replace(stretched(scanned, *factors), inertia=about)

    def _box(self, top: Block, *, whole: bool) -> Block:
        """The object on a rectangular base, or one with what it is fixed to, whose base is square or as deep."""
        assert self.depth is not None
        width, depth, mass = self.block.width, self.depth, self.block.mass
        across = top.centroidal_inertia
        # moments of uniform boxes about x and y differ by what their sides do
        aside = mass * (depth * depth - width * width) / 12
        along = mass * (width * width + depth * depth) / 12
        if whole:
            along += (top.mass - mass) * top.width * top.width / 6
            depth = max(depth, top.width)
        tensor = checked_tensor(np.diag((across + aside, across, along)))
        return replace(top, depth=depth, inertia=tensor)

    def variants(self) -> list[Moved["Objects"]]:
        """The object with each property smaller and larger by its standard deviation."""
        moves: dict[str, Callable[[float], Objects]] = {
            "width": lambda factor: self._stretched(width=factor),
            "cg_height": lambda factor: self._stretched(height=factor),
        }
        if not self.round:  # of a body in space that of the planar answer
            moves["restitution"] = lambda factor: replace(
                self, livelier=self.livelier * factor
            )
        if self.pedestals:
            moves["mass"] = lambda factor: self._stretched(mass=factor)
        found = moved_to_both_sides(moves, self.tolerances)
        if self.scan is not None:
            found += _standing(self, self.scan)
        elif self.depth is not None and self.faces_anywhere:
            turned = (
                replace(self, facing_deg=self.facing_deg + by) for by in (-ASIDE, ASIDE)
            )
            found.append(Moved("facing", 0.0, *turned))
        return found

    def _stretched(
        self, width: float = 1.0, height: float = 1.0, mass: float = 1.0
    ) -> "Objects":
        """Move all edges: what carries is uncertain at the foot of a pedestal as at that of a statue."""
        return replace(
            self,
            depth=self.depth and self.depth * width,
            block=stretched_block(self.block, width, height, mass),
            scanned=self.scanned and stretched(self.scanned, width, height, mass),
            pedestals=tuple(stretched_block(block, width) for block in self.pedestals),
        )


def _standing(objects: Objects, scan: Scan) -> list[Moved[Objects]]:
    """The object in the ways to stand that are one standard deviation of each source away, planar and in space."""
    planar, space = scan.sides(), {}
    bodies: dict[str, tuple[RigidBody | None, ...]] = {}
    if scan.space is not None and objects.scanned is not None:
        space = scan.space.sides()
        bodies = {
            name: tuple(map(scan.space.body, side[:2])) for name, side in space.items()
        }
        if objects.faces_anywhere:
            bodies["facing"] = tuple(scan.space.body(0.5, by) for by in (-ASIDE, ASIDE))
    found = []
    for name in dict.fromkeys((*planar, *bodies)):
        low, high, spread = planar.get(
            name, (0.5, 0.5, space.get(name, (0, 0, 0.0))[2])
        )
        sides = zip((low, high), bodies.get(name, (objects.scanned,) * 2), strict=True)
        lower, upper = (
            replace(objects, block=scan.block(at), scanned=body) for at, body in sides
        )
        found.append(Moved(name, spread, lower, upper))
    return found


def stretched(body: RigidBody, width: float, height: float, mass: float) -> RigidBody:
    """A body in space whose base is wider, whose centre of gravity is higher, and which is heavier, by factors.

    Its polygon's origin lies below its centre of gravity; the inertia is as much larger as the mass.
    """
    assert isinstance(body.base, Polygon)
    x, y, z = body.centre
    return replace(
        body,
        mass=body.mass * mass,
        inertia=checked_tensor(body.tensor * mass),
        centre=(x, y, min(z * height, body.height)),
        base=Polygon(tuple((width * x, width * y) for x, y in body.base.vertices)),
    )


def stretched_block(
    block: Block, width: float = 1.0, height: float = 1.0, mass: float = 1.0
) -> Block:
    """A block with edges further apart, a higher centre of gravity and more mass, by factors."""
    return replace(
        block,
        width=block.width * width,
        mass=block.mass * mass,
        inertia=block.centroidal_inertia * mass,
        cg_height=min(block.h * height, block.height),
    )


def make_objects(settings: Mapping[str, Any], folder: Path) -> Objects:
    """Make the object and what it stands on of checked keys of ``statue.yaml``."""
    assumed: list[Assumption] = []
    quality_flags: list[str] = []
    is_round = bool(settings.get("round", False))
    scan = None
    if "mesh" in settings:
        scan, block, plane = _from_mesh(settings, folder, assumed)
        depth, facing = None, 0.0
    else:
        block, plane, depth, facing = _from_dimensions(settings, assumed, quality_flags)
    pedestals = _pedestals(settings, assumed)
    with errors_of("key pedestal"):
        stacked((*pedestals, block))
    for each in (block, *pedestals):
        if quality_flag := size_warning(each.width, each.height):
            quality_flags.append(quality_flag + ".")
    planar = "scanned" if scan else "box" if depth is not None else "planar"
    first = [assume(f"{'round' if is_round else planar}_base")]
    on_points = scan is not None and not is_round and "restitution" not in settings
    if not is_round and "restitution" not in settings:
        first.append(assume("on_points" if scan else "restitution", "restitution"))
    objects = Objects(
        block=block,
        pedestals=pedestals,
        restitution=settings.get("restitution"),
        friction=settings.get("friction"),
        tolerances=tolerances_in(
            settings,
            TOLERANCES
            | ({"restitution": ON_POINTS["restitution"]} if on_points else {}),
        ),
        livelier=ON_POINTS["livelier"] if on_points else 1.0,
        plane=plane,
        round=is_round,
        depth=depth,
        facing_deg=facing,
        faces_anywhere="facing_deg" not in settings
        and "direction_deg" not in settings.get("mesh", {}),
        base_spread=float(settings.get("base_spread", 0.0)),
        scan=scan,
        scanned=scan.space.body() if scan and scan.space and not is_round else None,
        assumed=(*first, *assumed),
        quality_flags=tuple(quality_flags),
        pad_friction=settings.get("pad_friction"),
    )
    _check_restitution(objects)
    return objects


def _check_restitution(objects: Objects) -> None:
    """Refuse a restitution with which an impact would gain energy."""
    e = objects.restitution
    if e is None:
        return
    shapes = objects.body.system().carried
    most = min(
        geometry.largest_restitution(shape, pivot)
        for shape in shapes
        for pivot in (1, -1)
    )
    if e > most:
        raise InputError(
            f"key restitution: with {e:g} an impact of this object would gain energy, as its centre of gravity "
            f"is not above the middle of its base; give at most {math.floor(1000 * most) / 1000:g}."
        )


def _from_dimensions(
    settings: Mapping[str, Any], assumed: list[Assumption], quality_flags: list[str]
) -> tuple[Block, str, float | None, float]:
    """Block and the plane in which it rocks, across its narrower side; the other side and the plane's direction.

    Side and direction [degrees] are those of a base that is known in space: None and 0 of others.
    """
    width, height = float(settings["width_m"]), float(settings["height_m"])
    is_round = settings.get("round", False)
    if is_round and settings.get("depth_m", width) != width:
        raise InputError(
            "key depth: a round base has one width, its diameter; leave the depth out, or round."
        )
    depth = float(settings.get("depth_m", width))
    plane, across = f"across its {100 * width:.4g} cm", depth < width
    if across:
        plane = f"across its {100 * depth:.4g} cm, the narrower side"
        width, depth = depth, width
    elif "depth_m" not in settings and not is_round:
        # the mass that follows counts only on a pedestal
        assumed.append(assume("depth", depth=depth))
    mass = settings.get("mass_kg")
    if mass is None:
        mass = STONE * width * depth * height * (math.pi / 4 if is_round else 1.0)
        solid = "cylinder" if is_round else "box"
        assumed.append(assume("mass", "mass", mass=mass, solid=solid, density=STONE))
    mass = float(mass)
    check_density(width, height, mass)
    if "depth_m" in settings:
        volume = width * depth * height
        density = mass / volume
        words = f"{mass:g} kg in a box of {volume:.3g} m³ are {density:.3g} kg/m³"
        if not DENSITIES[0] <= density <= DENSITIES[1]:
            raise InputError(
                f"key mass: {words}, a density that no solid has; check the units."
            )
        if not COMMON[0] <= density <= COMMON[1]:
            quality_flags.append(f"{words}, which is unusual; check the units.")
    if "cg_height_m" not in settings:
        assumed.append(assume("cg_height", "cg_height"))
    cg_height = settings.get("cg_height_m")
    if cg_height is not None and cg_height >= height:
        raise InputError(
            f"key cg_height: {cg_height:g} m is not below the top, at {height:g} m; check the unit."
        )
    usual = round_inertia(width, height, mass) if is_round else None
    inertia = settings.get("inertia_kg_m2", usual)
    offset = float(settings.get("cg_offset_m", 0.0))
    block = Block(width, height, mass, inertia, cg_height=cg_height, cg_offset=offset)
    if is_round or "depth_m" not in settings:
        return block, plane, None, 0.0
    return block, plane, depth, float(settings.get("facing_deg", 0.0)) + 90.0 * across


def _from_mesh(
    settings: Mapping[str, Any], folder: Path, assumed: list[Assumption]
) -> tuple[Scan, Block, str]:
    """The planar block of a scanned statue, in the direction towards which it leans over at the least angle."""
    mesh = settings["mesh"]
    if "facing_deg" in settings:
        mesh = mesh | {"direction_deg": -settings["facing_deg"] % 360.0}
    mass = settings.get("mass_kg")
    if mass is None:
        assumed.append(assume("solid", "mass", density=STONE))
    if mesh.get("hull"):
        assumed.append(assume("hull", "cg_height"))
    try:
        shape = read_shape(
            folder / mesh["file"],
            mass=mass,
            density=STONE if mass is None else None,
            metres_per_unit=float(mesh.get("metres_per_unit", 1.0)),
            up=mesh.get("up"),
            hull=bool(mesh.get("hull", False)),
        )
        scan, of_scan = make_scan(
            shape, mesh, settings.get("tolerances", {}).get("contact")
        )
    except InputError as error:
        raise InputError(_in_keys(str(error))) from None
    assumed += of_scan
    way = scan.row_at(0.5)
    plane = (
        f"towards {way['direction_deg']:.0f}° of the mesh, where it balances at {way['alpha_deg']:.1f}°, as the "
        f"middle one of {len(scan.ways)} ways to stand does"
    )
    return scan, scan.block(), plane


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


def _pedestals(
    settings: Mapping[str, Any], assumed: list[Assumption]
) -> tuple[Block, ...]:
    """What the object stands on, from below, in the plane in which it rocks."""
    found, given = [], settings.get("pedestal", [])
    given = [given] if isinstance(given, Mapping) else given
    across = settings.get("depth_m", math.inf) < settings.get("width_m", math.inf)
    for i, block in enumerate(given, start=1):
        width, height = float(block["width_m"]), float(block["height_m"])
        depth = float(block.get("depth_m", width))
        if across:
            width, depth = depth, width
        mass = block.get("mass_kg")
        if mass is None:
            mass = STONE * width * depth * height
            name = f"pedestal {i}" if len(given) > 1 else "the pedestal"
            assumed.append(
                assume("pedestal", "mass", name=name, mass=mass, density=STONE)
            )
        with errors_of("key pedestal"):
            check_density(width, height, float(mass))
        found.append(Block(width, height, float(mass)))
    return tuple(reversed(found))
