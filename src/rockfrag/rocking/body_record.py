"""From a body and its restitution to the record of numbers that the kernels read."""

import math
from collections.abc import Sequence

import numpy as np

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Block, Body, Stack, Vector
from rockfrag.rocking.checks import positive_number, real_number, shown
from rockfrag.rocking.kernels import geometry
from rockfrag.rocking.kernels.equations import BODY

Restitution = float | Sequence[float | None] | None
"""Measured ratio of angular velocities after and before an impact: one number for a lone block, a pair
(ground, interface) for a stack; None conserves momentum at the new pole."""


def impulse_position(block: Block, restitution: float, new_pole: int) -> float:
    """Where the impulse of a closing base acts, if the lone block comes off with ``restitution``.

    The angular momentum about the point of the impulse is conserved; conserving it about the new pole
    (position 1) gives :meth:`Block.momentum_restitution`, about the middle of the base (position 0) of
    a symmetric block gives 1.

    Parameters
    ----------
    restitution
        ω⁺ / ω⁻ of the lone block on a rigid base [-].
    new_pole
        The corner that comes down, +1 or -1.

    Returns
    -------
    Position σ of the impulse in half widths from the middle towards the new pole [-].
    """
    centre, b, m = block.centre, block.b, block.mass
    inertia = block.centroidal_inertia
    old = centre.minus(Vector(-new_pole * b, 0.0))
    new = centre.minus(Vector(new_pole * b, 0.0))

    def product(arm: Vector) -> float:
        return inertia + m * (centre.x * arm.x + centre.y * arm.y)

    return (product(old) - restitution * product(new)) / (
        m * new_pole * b * (old.x - restitution * new.x)
    )


def largest_restitution(block: Block) -> float:
    """Largest ratio of angular velocities that no impact of the lone block gains energy with [-].

    1 for a symmetric block; √ of the ratio of the pole inertias where they differ.
    """
    right, left = block.pole_inertia(+1), block.pole_inertia(-1)
    return math.sqrt(min(right, left) / max(right, left))


def _checked(name: str, restitution: object, block: Block) -> float | None:
    if restitution is None:
        return None
    value, largest = real_number(name, restitution), largest_restitution(block)
    if not 0.0 <= value <= largest:
        raise InputError(
            f"{name}: {value:.6g} would gain energy or is no ratio; give a ratio of angular "
            f"velocities from 0 to at most {largest:.6g}, or None to conserve momentum."
        )
    return value


def _pair(body: Body, restitution: object) -> tuple[float | None, float | None]:
    """Split what the user gave into (ground, interface) of the kernels' two blocks."""
    if restitution is None:
        return None, None
    if isinstance(body, Block):
        if isinstance(restitution, (tuple, list, np.ndarray)):
            raise InputError("restitution: a lone block takes one number, not several.")
        return None, _checked("restitution of the block", restitution, body)
    if not (isinstance(restitution, (tuple, list, np.ndarray)) and len(restitution) == 2):
        raise InputError(
            "restitution: a stack takes a pair (ground, interface), each of which may be None, "
            f"got {shown(restitution)}."
        )
    return (
        _checked("restitution of the ground", restitution[0], body.pedestal),
        _checked("restitution of the interface", restitution[1], body.contact_statue),
    )


def lone_restitution(block: Block, restitution: Restitution) -> float | None:
    """Return the checked restitution of a lone block; None if momentum is conserved."""
    return _pair(block, restitution)[1]


def body_record(
    body: Body, restitution: Restitution = None, linear: bool = False, g: float = 9.81
) -> np.void:
    """Return the record of a body that the kernels read (``kernels.equations.BODY``).

    Parameters
    ----------
    linear
        Use the linearised equations: eq. 2.9 for a lone block, eq. 2.60-2.65 for a stack.
    g
        Acceleration of gravity [m/s²].

    Raises
    ------
    InputError
        If the restitution does not fit the body or would add energy, or ``g`` is not positive.
    """
    positive_number("g", g, "m/s²")
    if not isinstance(body, (Block, Stack)):
        raise InputError(f"body: expected a Block or a Stack, got {shown(body)}.")
    ground, interface = _pair(body, restitution)
    store = np.zeros(1, BODY)
    p: np.void = store[0]
    for name in ("eta1r", "eta1l", "eta2r", "eta2l"):
        p[name] = 1.0
    p["gravity"] = g
    # a view whose fields are attributes, as those of records are in kernels
    named = store.view(np.recarray)[0]
    if isinstance(body, Block):
        statue = body
        geometry.fill_block(named, body.shape)
        p["linear"] = 2 if linear else 0
    else:
        statue, pedestal = body.contact_statue, body.pedestal
        geometry.fill_pile(named, body.pile)
        p["linear"] = 1 if linear else 0
        if ground is not None:
            p["eta1r"] = impulse_position(pedestal, ground, +1)
            p["eta1l"] = impulse_position(pedestal, ground, -1)
    p["measured"] = ground is not None or interface is not None
    if interface is not None:
        p["eta2r"] = impulse_position(statue, interface, +1)
        p["eta2l"] = impulse_position(statue, interface, -1)
    return p
