"""The functions of the module that shakes a body in space, and the record through which a page calls them.

They are compiled to WebAssembly alone (``build``), around the kernel that the engine in space runs.
"""

import math

import numpy as np

from rockfrag.base.elementary import atan2, sin_cos
from rockfrag.engines.compile.jit import compile_for_kernels, kernel
from rockfrag.engines.spatial import _describe
from rockfrag.engines.spatial._body import BODY, SIZE
from rockfrag.engines.spatial._case import CASE
from rockfrag.engines.spatial._integrate import integrate
from rockfrag.engines.spatial._outcome import OUTCOME
from rockfrag.system import footprint, geometry

_F, _I = np.float64, np.int64

SPACE = np.dtype(
    [
        # what describe reads, beside base and friction in the body's record: mass, centre of gravity from where
        # the base is drawn, tensor, and the turn about the vertical [rad]
        ("mass", _F), ("at", _F, 3), ("tensor", _F, (3, 3)), ("turn", _F), ("gravity", _F),
        # how far a smooth wall stands from the edge nearest to the base's origin (NaN: none), and the height of
        # the body [m]; what a bond of four pads holds in tension (NaN: none) and shear [N], and where its pads are
        # over where the edges are [-]
        ("wall", _F), ("tall", _F), ("tension", _F), ("shear", _F), ("pads_at", _F),
        ("stands", _I),
        # what integrate reads, the body among it, and leaves
        ("body", BODY), ("scale", _F), ("dt", _F), ("extra", _I), ("tolerance", _F), ("cut", _F),
        ("state", _F, SIZE), ("outcome", _F, OUTCOME),
        # what it works in
        ("case", CASE),
    ],
    align=True,
)  # fmt: skip
"""What a page and the module hand to each other."""

for _module in (_describe, footprint):
    compile_for_kernels(_module)


@kernel
def describe_solid(call):
    """Describe a body to the kernel: place its base below its centre of gravity, and turn both."""
    body, tensor = call.body, call.tensor
    sine, cosine = sin_cos(call.turn)
    if call.turn != 0.0:
        for i in range(body.count):
            point = body.points[i]
            point[0], point[1] = geometry.turned_in_plan(
                point[0], point[1], sine, cosine
            )
        call.at[0], call.at[1] = geometry.turned_in_plan(
            call.at[0], call.at[1], sine, cosine
        )
        xx, xy, yy = geometry.turned_moments(
            tensor[0, 0], tensor[0, 1], tensor[1, 1], sine, cosine
        )
        xz, yz = geometry.turned_in_plan(tensor[0, 2], tensor[1, 2], sine, cosine)
        tensor[0, 0], tensor[1, 1] = xx, yy
        tensor[0, 1] = tensor[1, 0] = xy
        tensor[0, 2] = tensor[2, 0] = xz
        tensor[1, 2] = tensor[2, 1] = yz
    if not math.isnan(call.wall):
        _stand_at_wall(call)
    if not math.isnan(call.tension):
        _bond(call)
    for i in range(body.count):
        body.points[i, 0] -= call.at[0]
        body.points[i, 1] -= call.at[1]
    if body.rim > 0:
        body.centre[0] -= call.at[0]
        body.centre[1] -= call.at[1]
    body.height = call.at[2]
    for i in range(3):
        for j in range(3):
            body.inertia[i, j] = tensor[i, j] / call.mass
    call.stands = 1 if _describe.fill_body(body, call.gravity) else 0


@kernel
def _stand_at_wall(call):
    """Set a smooth wall behind the narrower side of a polygon, which corners of base and face may meet."""
    body, at = call.body, call.at
    body.constraints = body.walls = 1
    body.corners = 2 * body.count
    for i in range(body.corners):
        point = body.points[i % body.count]
        height = 0.0 if i < body.count else call.tall
        body.corner[i, 0], body.corner[i, 1] = point[0] - at[0], point[1] - at[1]
        body.corner[i, 2] = height - at[2]
    _, east, north = footprint.nearest_edge(body.points, body.count)
    distance = footprint.reach(body.points, body.count, east, north) + call.wall
    _describe.fill_wall(body, 0, atan2(north, east), distance, (at[0], at[1]))


@kernel
def _bond(call):
    """Bond the base to the ground by four pads near its corners."""
    body = call.body
    body.bonded = 1
    body.tension, body.shear = call.tension / call.mass, call.shear / call.mass
    body.aside[0], body.aside[1] = call.at[0], call.at[1]
    pads = footprint.pads_in_circle(body.rim, call.pads_at)
    if body.rim == 0:
        pads = footprint.pads_in_polygon(body.points, body.count, call.pads_at)
    body.pads[0], body.pads[1] = pads


@kernel
def integrate_solid(call, acceleration, peaks, history):
    """Integrate the body of a call; see ``spatial.integrate``."""
    integrate(
        call.body, acceleration, peaks, call.scale, call.dt, call.gravity, call.extra, call.tolerance, call.cut,
        call.state, history, call.outcome, call.case,
    )  # fmt: skip
