"""A scanned object: it stands on the polygon of the points that carry, in one of the ways that were drawn.

In: settings of a request. Out: an object (:mod:`rockfrag.assess.standing.contract`), sizes in m and kg. Docs:
``docs/assess.md``, "Scans".
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from rockfrag.assess.assumed import Assumption, Moved, assume, tolerances_in
from rockfrag.assess.scan import Scan, make_scan
from rockfrag.assess.standing.box import ASIDE
from rockfrag.assess.standing.contract import TOLERANCES, Foundation, Standing
from rockfrag.assess.standing.dimensions import on_foundation
from rockfrag.assess.standing.planar import Planar
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.base.plausible import STONE
from rockfrag.fragility.model_error import SCAN
from rockfrag.system.blocks import Block, Body
from rockfrag.system.body import Polygon, RigidBody, checked_tensor
from rockfrag.system.contact import Contact
from rockfrag.system.mesh import Shape, read_shape
from rockfrag.system.system import System
from rockfrag.words.findings import finding, three, whole

ON_POINTS = {"restitution_factor": 0.85, "restitution": 0.1}
"""Middle and relative standard deviation of the restitution of a scanned body over that of momentum, which is
uniform from 0.7 to 1 (:mod:`rockfrag.campaign.standing`)."""


@dataclass(frozen=True)
class Scanned(Standing):
    """A scanned object.

    Attributes
    ----------
    scan : the scan as it may stand
    scanned : the scan in space as it stands; None if it could not
    faces_anywhere : whether nobody said how it faces the shaking, which counts
    """

    scan: Scan | None = None
    scanned: RigidBody | None = None
    faces_anywhere: bool = False

    measured_as: ClassVar[str] = SCAN
    in_space_by: ClassVar[str] = "its mesh"

    @classmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Take what has a mesh."""
        return "mesh" in settings

    @classmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Draw the ways in which the scan may stand, and take the middle one."""
        assumed: list[Assumption] = []
        scan = _scan_of(settings, folder, assumed)
        way = scan.row_at(0.5)
        plane = finding(
            Text.ROCKS_TOWARDS,
            direction=whole(way["direction_deg"]),
            angle=three(way["alpha_deg"]),
            count=len(scan.arrangements),
        )
        restitution_factor, first = 1.0, [assume("scanned_base")]
        if "restitution" not in settings:
            restitution_factor = ON_POINTS["restitution_factor"]
            first.append(assume("on_points", "restitution"))
            usual = TOLERANCES | {"restitution": ON_POINTS["restitution"]}
            under = replace(under, tolerances=tolerances_in(settings, usual))
        block = scan.block()
        said = "facing_deg" in settings or "direction_deg" in settings["mesh"]
        return cls(
            block,
            plane,
            on_foundation(under, block, (*first, *assumed)),
            restitution_factor,
            base_spread=float(settings.get("base_spread", 0.0)),
            scan=scan,
            scanned=scan.space.body() if scan.space else None,
            faces_anywhere=not said,
        )

    def variants(self) -> list[Moved[Self]]:
        """The usual ones, and the ways to stand that are one standard deviation of each source away."""
        return [*super().variants(), *self._arrangements()]

    def _arrangements(self) -> list[Moved[Self]]:
        """The ways to stand in the plane and in space."""
        assert self.scan is not None
        planar, in_space = self.scan.sides(), self.scan.space
        # by source: places lower and higher, and the spread, as of Scan.sides; and both bodies
        space: dict[str, tuple[float, float, float]] = {}
        bodies: dict[str, tuple[RigidBody | None, ...]] = {}
        if in_space is not None and self.scanned is not None:
            space = in_space.sides()
            bodies = {
                name: (in_space.body(low), in_space.body(high))
                for name, (low, high, _) in space.items()
            }
            if self.faces_anywhere:
                bodies["facing"] = tuple(
                    in_space.body(0.5, by) for by in (-ASIDE, ASIDE)
                )
        found = []
        for name in dict.fromkeys((*planar, *bodies)):
            # a source that acts in space alone has the middle way in the plane, and the reverse
            _, _, spread_in_space = space.get(name, (0.0, 0.0, 0.0))
            low, high, spread = planar.get(name, (0.5, 0.5, spread_in_space))
            less, more = bodies.get(name, (self.scanned, self.scanned))
            lower = replace(self, block=self.scan.block(low), scanned=less)
            upper = replace(self, block=self.scan.block(high), scanned=more)
            found.append(Moved(name, spread, lower, upper))
        return found

    def stretched(
        self, width: float = 1.0, height: float = 1.0, mass: float = 1.0
    ) -> Self:
        """Move all edges, those of the polygon in space too."""
        body = self.scanned and stretched_body(self.scanned, width, height, mass)
        return replace(super().stretched(width, height, mass), scanned=body)

    @property
    def in_space(self) -> bool:
        """In space, unless its restitution was measured, its impacts are changed or a pad is to be tried."""
        usual = self.restitution_factor == ON_POINTS["restitution_factor"]
        plain = self.under.restitution is None and self.under.pad_friction is None
        return self.scanned is not None and plain and usual

    def in_plane(self) -> Planar:
        """The object as it rocks in the plane of the middle way."""
        return Planar(self.block, self.plane, self.under, self.restitution_factor)

    def solid(self, body: Body) -> System | None:
        """The scan in space; None with what it is fixed to."""
        top = body.blocks[-1]
        if not self.in_space or self.is_whole(top) or self.scanned is None:
            return None
        return System((self._changed(self.scanned, top),), (Contact(),))

    def _changed(self, scanned: RigidBody, top: Block) -> RigidBody:
        """The scan in space with what another block differs by from the object's."""
        added = top.centroidal_inertia - self.block.centroidal_inertia
        stretched = stretched_body(
            scanned,
            width=top.width / self.block.width,
            height=top.h / self.block.h,
            mass=top.mass / scanned.mass,
        )
        about = checked_tensor(scanned.tensor + np.diag([added, added, 0.0]))
        return replace(stretched, inertia=about)


def stretched_body(
    body: RigidBody, width: float, height: float, mass: float
) -> RigidBody:
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


def _scan_of(
    settings: Mapping[str, Any], folder: Path, assumed: list[Assumption]
) -> Scan:
    """The scan of a mesh, as it may stand."""
    mesh = settings["mesh"]
    if "facing_deg" in settings:
        mesh = mesh | {"direction_deg": -settings["facing_deg"] % 360.0}
    mass = settings.get("mass_kg")
    if mass is None:
        assumed.append(assume("solid", "mass", density=whole(STONE)))
    if mesh.get("hull"):
        assumed.append(assume("hull", "cg_height"))
    contact = settings.get("tolerances", {}).get("contact")
    try:
        scan, of_scan = make_scan(_shape_of(mesh, folder, mass), mesh, contact)
    except InputError as error:
        raise InputError(_in_keys(str(error))) from None
    assumed += of_scan
    return scan


def _shape_of(mesh: Mapping[str, Any], folder: Path, mass: float | None) -> Shape:
    """The body of a mesh file, of stone where its mass is not known."""
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
