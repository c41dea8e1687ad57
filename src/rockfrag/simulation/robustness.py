"""How sure an outcome is: slightly different experiments that end otherwise, and steps that decide.

Whether a rocking body falls depends on its motion and its dimensions without end in detail, and no number of one
history predicts how a neighbouring one ends.  So neighbours are simulated.

In: a case, and how little its numbers are known. Out: fraction of neighbours that end otherwise [-]. Theory:
``docs/definitions.md``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_number, whole_number
from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.engines.pure_rocking.ensembles import refined
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.ensemble import Options, overturned_cases, prepared, shaken
from rockfrag.simulation.inputs import MotionLike
from rockfrag.system.blocks import SystemLike
from rockfrag.system.body import (
    Circle,
    Interval,
    Outline,
    Polygon,
    RigidBody,
    checked_tensor,
)
from rockfrag.system.geometry import shape_of
from rockfrag.system.system import System, with_bodies

LARGEST_PERTURBATION = 0.1  # beyond this a copy is another experiment


@named_keywords
def outcome_robustness(
    bodies: SystemLike | Sequence[SystemLike],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None = None,
    scales: ArrayLike = (1.0,),
    *,
    perturbation: float,
    copies: int = 16,
    seed: int = 0,
    **options: Unpack[Options],
) -> NDArray[np.float64]:
    """Fraction of perturbed copies of every case whose outcome is the case's own.

    Each copy has a motion, and widths and heights of its blocks, that are larger or smaller by at most
    ``perturbation``, drawn evenly and independently; one draw serves all cases of a copy.

    Walls move with the faces beside them, so that gaps stay: a gap is measured by itself, and is not narrower
    where a block is wider.  Pads of a bond stay where they are, or at the edge of a narrower base.

    Parameters
    ----------
    bodies, motions, dt, scales : the ensemble, as in :func:`rockfrag.simulation.overturns`
    perturbation : largest relative change [-], such as 1e-6
    copies, seed : number of copies, and seed of the draws
    **options
        As in :func:`rockfrag.simulation.overturns`, but for ``forces``; measured
        restitution, friction and start stay as they are.

    Returns
    -------
    Fractions from 0 to 1, shape (bodies, motions, scales): 1 where no copy ends otherwise.

    Examples
    --------
    >>> from rockfrag import Block, outcome_robustness
    >>> from rockfrag.motions import one_sine
    >>> motion = one_sine(1.0, period=1.0)
    >>> block = Block(0.3, 1.2, 180.0)
    >>> outcome_robustness(block, motion, scales=[2.6, 5.0], perturbation=0.01)
    array([[[1., 1.]]])
    """
    size = real_number("perturbation", perturbation)
    if not 0 < size <= LARGEST_PERTURBATION:
        raise InputError(
            f"perturbation: expected a relative change above 0 and up to {LARGEST_PERTURBATION}, got {size:g}."
        )
    if whole_number("copies", copies) < 1:
        raise InputError(f"copies: expected at least one, got {copies}.")
    cases = prepared(bodies, motions, dt, scales, **options)
    rng = np.random.default_rng(seed)
    given = shaken(cases).overturned
    same = np.zeros(given.shape)
    for _ in range(copies):
        near = tuple(perturbed(system, size, rng) for system in cases.systems)
        scale = 1.0 + size * float(rng.uniform(-1, 1))
        found = shaken(replace(cases, systems=near, scales=scale * cases.scales))
        same += found.overturned == given
    return same / copies


def perturbed(system: System, size: float, rng: np.random.Generator) -> System:
    """System whose widths and heights differ by at most ``size``, relative, drawn evenly.

    Parameters
    ----------
    system, size, rng : the system, the largest relative difference [-], and the random numbers

    Returns
    -------
    The system.
    """
    bodies = []
    for body in system.bodies:
        across, up = (1 + size * rng.uniform(-1, 1, 2)).tolist()
        bodies.append(_resized(body, across, up))
    return with_bodies(system, bodies)


def _resized(body: RigidBody, across: float, up: float) -> RigidBody:
    """A body in space scaled across and up, of the same density."""
    x, y, z = body.centre
    base, height = _scaled(body.base, across), body.height * up
    made = replace(
        body,
        centre=(x, y, z * up),
        base=base,
        height=height,
        face=None if body.face is None else _scaled(body.face, across),
    )
    if isinstance(body.inertia, tuple):
        inertia = body.tensor
        stretch = (across, across if isinstance(base, Circle) else 1.0, up)
        # I = tr(S) 1 - S of the second moments S, which grow with the product of their two axes
        second_moments = np.trace(inertia) / 2 * np.eye(3) - inertia
        second_moments *= np.outer(stretch, stretch)
        stretched = np.trace(second_moments) * np.eye(3) - second_moments
        return replace(made, inertia=checked_tensor(stretched))
    if body.inertia == _uniform(body):
        return replace(made, inertia=_uniform(made))
    return made


def _uniform(body: RigidBody) -> float:
    """Moment of inertia of a uniform rectangle of the body's size [kg m²]."""
    return shape_of(
        body.width, body.height, body.mass, math.nan, math.nan, 0.0, 0.0
    ).inertia


def _scaled(outline: Outline, across: float) -> Outline:
    """An outline scaled across."""
    if isinstance(outline, Interval):
        return Interval(outline.left * across, outline.right * across)
    if isinstance(outline, Circle):
        return Circle(outline.radius * across, outline.centre)
    return Polygon(tuple((x * across, y) for x, y in outline.vertices))


@dataclass(frozen=True)
class StepSizeSensitive:
    """Step-size-sensitive outcomes: those that change when every step is halved."""

    sampled: int  # number of cases looked at
    changed: int  # number of them whose outcome changed
    # body, motion and scale (positions) of the changed ones, shape (changed, 3)
    cases: NDArray[np.int64]

    __repr__ = short_repr

    @property
    def fraction(self) -> float:
        """Fraction of the sampled outcomes that changed [-]."""
        return self.changed / self.sampled


@named_keywords
def find_step_size_sensitive(
    bodies: SystemLike | Sequence[SystemLike],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    *,
    sample: int = 1000,
    seed: int = 0,
    **options: Unpack[Options],
) -> StepSizeSensitive:
    """Count the outcomes of an ensemble that change when the step is halved, on a sample of its cases.

    Near-critical cases always exist: their outcome hangs on the last digits of any integration.

    Parameters
    ----------
    bodies, motions, dt, scales : the ensemble, as in :func:`overturns`
    sample, seed : number of cases, drawn without repetition (all of them if there are fewer), and seed of the draw
    **options : as in :func:`rockfrag.simulation.overturns`, but for ``forces``

    Returns
    -------
    The :class:`StepSizeSensitive`: how many cases were looked at, and which of them changed.

    Examples
    --------
    >>> import numpy as np
    >>> from rockfrag import Block, find_step_size_sensitive
    >>> from rockfrag.motions import one_sine
    >>> motion = one_sine(1.0, period=1.0)
    >>> found = find_step_size_sensitive(Block(0.3, 1.2, 180.0), motion, None, np.arange(2.5, 8.0, 0.1))
    >>> found.sampled, found.changed
    (55, 0)
    """
    grid = prepared(bodies, motions, dt, scales, **options)
    factors, shape = grid.scales, grid.shape
    total = int(np.prod(shape))
    if whole_number("sample", sample) < 1 or total < 1:
        raise InputError(
            f"sample: expected at least one of {total} cases, got {sample}."
        )
    chosen = np.random.default_rng(seed).choice(
        total, min(sample, total), replace=False
    )
    cases = np.stack(np.unravel_index(np.sort(chosen), shape), axis=1).astype(np.int64)
    body, motion, column = cases.T
    scale = factors[motion, column]
    given = overturned_cases(grid, body, motion, scale)
    # twice the samples on the same straight lines and half the bound on p h: exactly half of each step
    finer = replace(
        grid,
        motions=tuple(map(_doubled, grid.motions)),
        request=replace(grid.request, step=grid.request.step / 2),
    )
    halved = overturned_cases(finer, body, motion, scale)
    changed = cases[given != halved]
    return StepSizeSensitive(sampled=len(cases), changed=len(changed), cases=changed)


def _doubled(motion: GroundMotion) -> GroundMotion:
    """Sample a ground motion, which is zero one sample after its last, twice as densely."""

    def dense(component: Motion) -> Motion:
        return replace(
            component,
            acceleration=refined(component.acceleration, 2),
            dt=component.dt / 2,
        )

    return replace(
        motion,
        x=dense(motion.x),
        y=None if motion.y is None else dense(motion.y),
        z=None if motion.z is None else dense(motion.z),
    )
