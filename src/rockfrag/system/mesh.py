"""Bodies of any shape: mass properties from a closed mesh, and the planar block that rocks in one direction.

A rock or a statue does not stand on a flat base but on a few points.  Which points carry depends on how
close to the support a point must be to count, the contact tolerance; the polygon around them gives, for a
direction of shaking, the distances of the two edges from the centre of gravity.  Those distances, the
height of the centre of gravity and the moment of inertia make the planar block of :class:`Block`.
"""

import math
import os
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number
from rockfrag.base.plausible import LARGEST_SIZE, MEAN_DENSITIES
from rockfrag.base.short_repr import short_repr
from rockfrag.system.blocks import Block
from rockfrag.system.body import Polygon, RigidBody
from rockfrag.system.mesh_file import Y_UP, load_mesh

FEWEST_CARRY = 3  # points that make a polygon to stand on
MOST_CORNERS = 48  # of a polygon to stand on in space
FLAT = 1e-3  # distance over the polygon's size at which a corner hardly turns it [-]


@dataclass(frozen=True, eq=False)
class Shape:
    """A rigid body described by its surface, standing as its mesh stands (z up).

    Attributes
    ----------
    points : vertices of the surface relative to the centre of gravity [m], shape (n, 3)
    mass : [kg]
    inertia : tensor about the centre of gravity [kg m²], shape (3, 3)
    volume : [m³]
    name : of the file it came from
    """

    points: Floats
    mass: float
    inertia: Floats
    volume: float
    name: str = ""

    __repr__ = short_repr

    @cached_property
    def cg_height(self) -> float:
        """Height of the centre of gravity above the lowest point [m]."""
        return float(-self.points[:, 2].min())

    @property
    def height(self) -> float:
        """Overall height [m]."""
        return float(np.ptp(self.points[:, 2]))

    @property
    def outline(self) -> Floats:
        """Convex outline seen from above, relative to the centre of gravity, in order [m], shape (n, 2)."""
        seen = self.points[:, :2]
        return np.asarray(seen[_hull(seen)])

    def contact_polygon(self, tolerance: float) -> Floats:
        """Return the corners of the polygon around all points at most ``tolerance`` [m] above the lowest one.

        They are relative to the centre of gravity, in order [m], shape (n, 2).
        """
        low = self.points[self.points[:, 2] <= tolerance - self.cg_height][:, :2]
        try:
            corners = _hull(low)
        except (RuntimeError, ValueError) as error:
            raise InputError(
                f"{self.name}: within {1000 * tolerance:g} mm of its lowest point the mesh has "
                f"{len(low)} point(s), which make no polygon to stand on; {self._way_out(tolerance)}"
            ) from error
        return np.asarray(low[corners])

    def _way_out(self, tolerance: float) -> str:
        """What to do with a body that stands on too few points: it may lie on its side."""
        for axis, up in ((1, "y"), (0, "x")):
            heights = self.points[:, axis]
            carry = int((heights <= heights.min() + tolerance).sum())
            if carry >= FEWEST_CARRY:
                return f"with {up} up it stands on {carry} points: give up='{up}'."
        return "give a larger contact tolerance (contact_tolerance)."

    def edges(self, direction_deg: float, tolerance: float) -> tuple[float, float]:
        """Return the distances of the edges from the centre of gravity, against and along a direction [m].

        The direction runs from the mesh's x axis towards its y axis [degrees].
        """
        angle = math.radians(direction_deg)
        along = self.contact_polygon(tolerance) @ np.array(
            [math.cos(angle), math.sin(angle)]
        )
        return float(-along.min()), float(along.max())

    def scanned_again(self, scan_tolerance: float, rng: np.random.Generator) -> "Shape":
        """Return the shape as another scan might have seen it, of this standard deviation of heights [m]."""
        points = self.points.copy()
        points[:, 2] += scan_tolerance * rng.standard_normal(len(points))
        return replace(self, points=points)

    def block(
        self, direction_deg: float, tolerance: float, retreat: float = 0.0
    ) -> Block:
        """Return the planar block that rocks in the vertical plane of a direction, as of :meth:`edges` [degrees].

        Points up to ``tolerance`` above the lowest carry; edges lie ``retreat`` further in than their polygon [m].
        """
        # rounded or crushed edges carry further in
        left, right = self.edges(direction_deg, tolerance)
        left, right = left - retreat, right - retreat
        if min(left, right) <= 0:
            raise InputError(
                f"{self.name}: along {direction_deg:g}° its edges are {left:.4f} and {right:.4f} m "
                "from the centre of gravity, so it cannot stand; give a larger tolerance or less retreat."
            )
        size = {"cg_height": self.cg_height, "height": self.height, "mass": self.mass}
        angle = math.radians(direction_deg)
        axis = np.array([-math.sin(angle), math.cos(angle), 0.0])
        return Block.from_edges(
            left, right, **size, inertia=float(axis @ self.inertia @ axis)
        )

    def body(
        self, direction_deg: float, tolerance: float, retreat: float = 0.0
    ) -> RigidBody:
        """Return the body in space on the polygon that carries, turned so that a direction [degrees] is its x.

        Its origin lies below its centre of gravity; its edges lie ``retreat`` [m] further in than the polygon.
        """
        angle = -math.radians(direction_deg)
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        polygon = _without_hardly_turning(self.contact_polygon(tolerance))
        corners = _retreated(polygon @ turn[:2, :2].T, retreat)
        if corners is None:
            raise InputError(
                f"{self.name}: its centre of gravity is not above what is left of its base, so it cannot stand; "
                "give a larger tolerance or less retreat."
            )
        inertia = turn @ self.inertia @ turn.T
        return RigidBody(
            self.mass,
            (inertia + inertia.T) / 2,
            (0.0, 0.0, self.cg_height),
            Polygon(tuple((float(x), float(y)) for x, y in corners)),
            self.height,
            name="body",
        )

    def worst_direction(
        self, tolerance: float, step_deg: float = 1.0
    ) -> tuple[float, float]:
        """Return the direction in which the body leans over its edge at the least angle, and that angle [rad].

        Points up to ``tolerance`` [m] above the lowest carry; directions [degrees] are ``step_deg`` apart.
        """
        directions = np.arange(0.0, 360.0, step_deg)
        angle = np.radians(directions)
        polygon = self.contact_polygon(tolerance)
        reach = (polygon @ np.array([np.cos(angle), np.sin(angle)])).max(axis=0)
        least = int(reach.argmin())
        return float(directions[least]), float(math.atan2(reach[least], self.cg_height))


def outward_normals(corners: Floats) -> Floats:
    """Unit normals of the edges of a convex polygon in order, shape (n, 2).

    Parameters
    ----------
    corners : of the polygon, anticlockwise, shape (n, 2) [m]

    Returns
    -------
    The normals [-], that of the edge from each corner to the next.
    """
    edges = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(*edges.T)[:, np.newaxis]
    return np.asarray(np.column_stack([edges[:, 1], -edges[:, 0]]) / lengths)


def edge_distances(corners: Floats) -> Floats:
    """Distances of a convex polygon's edges from the origin, negative where that is outside [m], shape (n,).

    Parameters
    ----------
    corners : of the polygon, anticlockwise, shape (n, 2) [m]

    Returns
    -------
    The distances [m], shape (n,).
    """
    return np.asarray(np.einsum("ni,ni->n", outward_normals(corners), corners))


def _without_hardly_turning(corners: Floats) -> Floats:
    """Leave out corners of a polygon that hardly turn, shape (n, 2) [m], until few are left.

    Every time it is the corner that is least off the line from the one before it to the one after it, as long as
    there are more than MOST_CORNERS, or it is less than FLAT of the polygon's size off.
    """
    kept = corners
    size = float(np.ptp(corners, axis=0).max())
    while len(kept) > FEWEST_CARRY:
        chord = np.roll(kept, -1, axis=0) - np.roll(kept, 1, axis=0)
        side = kept - np.roll(kept, 1, axis=0)
        # distance of each corner from its chord [m]
        off = np.abs(chord[:, 0] * side[:, 1] - chord[:, 1] * side[:, 0]) / np.hypot(
            *chord.T
        )
        least = int(off.argmin())
        if len(kept) <= MOST_CORNERS and off[least] >= FLAT * size:
            break
        kept = np.delete(kept, least, axis=0)
    return kept


def _hull(points: Floats) -> NDArray[np.intp]:
    """Places of the corners of the convex hull of points in a plane, in order; RuntimeError without one."""
    # loaded for objects with corners of their own, which most are not
    from scipy.spatial import ConvexHull

    return np.asarray(ConvexHull(points).vertices)


def _retreated(corners: Floats, distance: float) -> Floats | None:
    """Move the edges of a convex polygon about the origin inwards; None where the origin is left outside."""
    outward = outward_normals(corners)
    reach = edge_distances(corners) - distance
    if not (reach > 0).all():
        return None
    # corners of the polygon are the dual of the hull of its edges' poles
    poles = outward / reach[:, np.newaxis]
    kept = _hull(poles)
    ahead = np.roll(kept, -1)
    cross = outward[kept, 0] * outward[ahead, 1] - outward[kept, 1] * outward[ahead, 0]
    x = (reach[kept] * outward[ahead, 1] - reach[ahead] * outward[kept, 1]) / cross
    y = (outward[kept, 0] * reach[ahead] - outward[ahead, 0] * reach[kept]) / cross
    return np.column_stack([x, y])


def read_shape(
    path: str | os.PathLike[str],
    *,
    mass: float | None = None,
    density: float | None = None,
    metres_per_unit: float = 1.0,
    up: str | None = None,
    hull: bool = False,
) -> Shape:
    """Read a closed surface and derive its mass properties.

    Parameters
    ----------
    path : of the mesh as OBJ, PLY, STL or GLB, standing on its lowest points
    mass, density : one of them [kg, kg/m³]; the body is taken as homogeneous
    metres_per_unit : length of the mesh's unit [m]
    up : axis of the mesh that points up, ``"x"``, ``"y"`` or ``"z"``; by default z, and y in glTF files
    hull : whether to take the convex hull of the vertices
        It closes a surface with holes and a cloud of points, and fills what is hollow or undercut.

    Returns
    -------
    The :class:`Shape`.
    """
    if (mass is None) == (density is None):
        raise InputError(f"{path}: give either the mass or the density of the body.")
    file = Path(path)
    mesh = _closed_mesh(file, hull)
    above = up or ("y" if file.suffix.lower() in Y_UP else "z")
    if above not in ("x", "y", "z"):
        raise InputError(f"{path}: up must be x, y or z, got {up!r:.20}.")
    # a turn, so that nothing is mirrored
    turn = {"x": [1, 2, 0], "y": [2, 0, 1], "z": [0, 1, 2]}[above]
    mesh.vertices = np.asarray(mesh.vertices)[:, turn]
    mesh.apply_scale(metres_per_unit)
    size = float(np.ptp(mesh.bounds, axis=0).max())
    if size > LARGEST_SIZE:
        raise InputError(
            f"{path}: the mesh is {size:.4g} m large; if its unit is not the metre, give metres_per_unit "
            "(0.001 for millimetres, 0.3048 for feet)."
        )
    volume = float(mesh.volume)
    if density is None:
        density = positive_number(f"{path}: mass", mass, "kg") / volume
    mass = positive_number(f"{path}: density", density, "kg/m³") * volume
    if not MEAN_DENSITIES[0] <= density <= MEAN_DENSITIES[1]:
        raise InputError(
            f"{path}: {mass:.4g} kg in {volume:.4g} m³ are {density:.4g} kg/m³, which no solid object has; "
            "check the mass and the unit of the mesh (metres_per_unit)."
        )
    return Shape(
        points=np.asarray(mesh.vertices - mesh.center_mass, dtype=np.float64),
        mass=mass,
        inertia=np.asarray(mesh.moment_inertia, dtype=np.float64) * (mass / volume),
        volume=volume,
        name=Path(path).name,
    )


def _closed_mesh(path: Path, hull: bool) -> Any:
    """Read a mesh with trimesh and turn it outside out; refuse one with holes."""
    import trimesh

    mesh = load_mesh(path)
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    faces = np.asarray(getattr(mesh, "faces", ()))
    if not np.isfinite(vertices).all():
        raise InputError(f"{path}: the mesh has a vertex that is not finite.")
    if hull:
        try:
            return trimesh.convex.convex_hull(vertices)
        except (RuntimeError, ValueError, IndexError) as error:
            raise InputError(
                f"{path}: its {len(vertices)} points enclose no volume."
            ) from error
    if len(faces) == 0:
        raise InputError(
            f"{path}: is a cloud of {len(vertices)} points without triangles; make a closed mesh of it, or take "
            "its convex hull (hull=True)."
        )
    if not mesh.is_watertight:
        # triangles of an STL file do not know their neighbours, and seams of a texture part vertices
        mesh.merge_vertices(merge_tex=True, merge_norm=True)
    if not mesh.is_watertight:
        _, count = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
        raise InputError(
            f"{path}: the surface is not closed ({int((count % 2).sum())} edges do not belong to two triangles), "
            "so it has no volume; close its holes, or take its convex hull (hull=True)."
        )
    # what encloses nothing has no centre, which the same call looks for
    with np.errstate(invalid="ignore", divide="ignore"):
        volume = mesh.volume
    if not abs(volume) > 0:
        raise InputError(f"{path}: the surface encloses no volume.")
    if volume < 0:
        mesh.invert()
    return mesh
