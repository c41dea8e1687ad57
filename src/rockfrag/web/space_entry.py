"""The functions of the module that shakes a body in space, and the record through which a page calls them.

They are compiled to WebAssembly alone (``build``), around the kernel that the engine in space runs.
"""

import numpy as np

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import compile_for_kernels, kernel
from rockfrag.engines.spatial import _describe
from rockfrag.engines.spatial._body import BODY, SIZE
from rockfrag.engines.spatial._forces import CASE
from rockfrag.engines.spatial._integrate import OUTCOME, integrate
from rockfrag.system import geometry

_F, _I = np.float64, np.int64

SPACE = np.dtype(
    [
        # what describe reads, beside base and friction in the body's record: mass, centre of gravity from where
        # the base is drawn, tensor, and the turn about the vertical [rad]
        ("mass", _F), ("at", _F, 3), ("tensor", _F, (3, 3)), ("turn", _F), ("gravity", _F),
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

compile_for_kernels(_describe)


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
def integrate_solid(call, acceleration, peaks, history):
    """Integrate the body of a call; see ``spatial.integrate``."""
    integrate(
        call.body, acceleration, peaks, call.scale, call.dt, call.gravity, call.extra, call.tolerance, call.cut,
        call.state, history, call.outcome, call.case,
    )  # fmt: skip
