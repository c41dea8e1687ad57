"""From a body and its restitution to the record of numbers that the kernels read."""

import numpy as np

from rockfrag.engines.kernels.equations import BODY
from rockfrag.errors import InputError
from rockfrag.input_checks import positive_number, shown
from rockfrag.rocking.measured_restitution import BY_MOMENTUM, Restitution, stack_restitution
from rockfrag.system import geometry
from rockfrag.system.blocks import Block, Body, Stack


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
    afters = stack_restitution(body, restitution)
    store = np.zeros(1, BODY)
    p: np.void = store[0]
    for name, after in zip(("after1r", "after1l", "after2r", "after2l"), afters, strict=True):
        p[name] = after
    p["gravity"] = g
    # a view whose fields are attributes, as those of records are in kernels
    named = store.view(np.recarray)[0]
    if isinstance(body, Block):
        geometry.fill_block(named, body.shape)
        p["linear"] = 2 if linear else 0
    else:
        geometry.fill_pile(named, body.pile)
        p["linear"] = 1 if linear else 0
    p["measured"] = any(after != BY_MOMENTUM for after in afters)
    return p
