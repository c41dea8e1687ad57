"""What motions ask of a holder, and in how many of them it holds; compiled.

In: demands of motions [N or m]. Out: the least strength or stroke that is enough. Docs: ``docs/holding.md``.
"""

import math

from rockfrag.assess.core.compiled import entry_kernel
from rockfrag.assess.core.ordering import sort

PART = 0.95
"""Part of the motions at the level in which a holder that is tried holds [-]."""


@entry_kernel
def ask(demands, ordered):
    """Return the least demand that is enough for :data:`PART` of the motions; 0 without motions.

    Parameters
    ----------
    demands : of each motion [N or m], shape (motions,)
    ordered : memory of that shape, in which they are sorted
    """
    if demands.size == 0:
        return 0.0
    for i in range(demands.size):
        ordered[i] = demands[i]
    sort(ordered)
    return ordered[math.ceil(PART * (demands.size - 1))]


@entry_kernel
def count_held(demands, bears):
    """Number of motions whose demands, shape (motions,), are no more than a holder ``bears`` [N or m]."""
    count = 0.0
    for i in range(demands.size):
        if demands[i] <= bears * (1 + 1e-9):
            count += 1.0
    return count
