"""How many verdicts hang on the step of the integration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import whole_number
from rockfrag.keywords import named_keywords
from rockfrag.rocking.case_list import overturns_of_cases
from rockfrag.rocking.inputs import STEP, MotionLike, checked_scales, listed
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.short_repr import short_repr
from rockfrag.system.blocks import Body
from rockfrag.units import GRAVITY


@dataclass(frozen=True)
class FragileVerdicts:
    """Verdicts that change when every step is halved: numerically fragile ones.

    Attributes
    ----------
    sampled
        Number of cases looked at.
    changed
        Number of them whose verdict changed.
    cases
        Body, motion and scale (positions) of the changed ones, shape (changed, 3).
    """

    sampled: int
    changed: int
    cases: NDArray[np.int64]

    __repr__ = short_repr

    @property
    def share(self) -> float:
        """Share of the sampled verdicts that changed [-]."""
        return self.changed / self.sampled


@named_keywords
def fragile_verdicts(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    *,
    sample: int = 1000,
    seed: int = 0,
    restitution: Sequence[Restitution] | None = None,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> FragileVerdicts:
    """Count the verdicts of an ensemble that change when the step is halved, on a sample of its cases.

    Near-critical cases always exist: their verdict hangs on the last digits of any integration.

    Parameters
    ----------
    bodies, motions, dt, scales
        The ensemble, as in :func:`overturns`.
    sample
        Number of cases, drawn without repetition; all of them if there are fewer.
    seed
        Seed of the draw.
    restitution, g, step, threads
        As in :func:`overturns`.

    Returns
    -------
    The :class:`FragileVerdicts`: how many cases were looked at, and which of them changed.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.

    Examples
    --------
    >>> import numpy as np
    >>> from rockfrag import Block, Motion, fragile_verdicts
    >>> time = np.arange(0, 2, 0.01)
    >>> motion = Motion(np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
    >>> found = fragile_verdicts(Block(0.3, 1.2, 180.0), motion, None, np.arange(2.5, 8.0, 0.1))
    >>> found.sampled, found.changed
    (55, 0)
    """
    body_list, values, dts = listed(bodies, motions, dt, restitution)
    factors = checked_scales(scales, values)
    shape = (len(body_list), *factors.shape)
    total = int(np.prod(shape))
    if whole_number("sample", sample) < 1 or total < 1:
        raise InputError(f"sample: expected at least one of {total} cases, got {sample}.")
    chosen = np.random.default_rng(seed).choice(total, min(sample, total), replace=False)
    cases = np.stack(np.unravel_index(np.sort(chosen), shape), axis=1).astype(np.int64)
    body, motion, column = cases.T
    drawn = (body, motion, factors[motion, column])
    given = overturns_of_cases(
        body_list, values, dts, *drawn, restitution=restitution, g=g, step=step, threads=threads
    )
    # twice the samples on the same straight lines and half the bound on p h: exactly half of each step
    halved = overturns_of_cases(
        body_list, [_doubled(one) for one in values], dts / 2, *drawn,
        restitution=restitution, g=g, step=step / 2, threads=threads,
    )  # fmt: skip
    changed = cases[given != halved]
    return FragileVerdicts(sampled=len(cases), changed=len(changed), cases=changed)


def _doubled(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sample a motion, which is zero one sample after its last, twice as densely."""
    closed = np.append(values, 0.0)
    at = np.arange(2 * closed.size - 1) / 2
    return np.asarray(np.interp(at, np.arange(closed.size), closed))
