"""Engines of ensembles in pure rocking, from rest, and what all engines of pure rocking share."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.contract import Cases, Request, Support, Wish, by_wishes
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.system import geometry
from rockfrag.system.system import System

_REASONS = {
    geometry.BESIDE: "the upper body does not stand on the lower one",
    geometry.OFF_CONTACT: "the upper body's centre of gravity is not above its contact",
    geometry.TILTED_OFF: "a centre of gravity is not above its base as the bodies stand",
    geometry.REACHES_GROUND: "the upper body reaches so far beyond the lower one that it could touch the ground",
}


class PureRocking:
    """One or two planar bodies that rock and never slide; the lower one is as wide above as below."""

    name: str
    meets: frozenset[Wish]

    def supports(self, system: System, motion: GroundMotion, request: Request) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = by_wishes(self, system, motion, request)
        if not found or system.count != 2:
            return found
        lower = system.in_plane().bodies[0]
        if lower.face != lower.base:
            return Support(reason="the lower body's face is not as wide as its base")
        return Support(reason=_REASONS.get(geometry.failed_stability_check(system.pile), ""))

    def _by_lanes(
        self, cases: Cases, kernel: Any, worker: Callable[[], Any], sampled: Any, **told: Any
    ) -> Outcomes:
        """Return what lanes make of motions ``sampled`` for an ensemble, and of what its kernel is ``told``."""
        from rockfrag.engines.kernels.lanes.case import OUTCOME, Ensemble
        from rockfrag.engines.lanes import integrate, write_lanes

        motions, rows, intervals = sampled
        count = len(cases.systems) * cases.scales.size
        ensemble = Ensemble(np.array([0]), count, rows=rows, intervals=intervals, **told)
        found = np.empty(count, OUTCOME)
        integrate(kernel, worker, cases.threads, ensemble, motions, found)
        outcomes = empty_outcomes(cases.names, cases.scales, (self.name,))
        write_lanes(outcomes, found.reshape(cases.shape), intervals[:, :, np.newaxis])
        return outcomes


class LoneBlocks(PureRocking):
    """Lone bodies: 64 lanes side by side (``kernels.lanes.block``)."""

    name = "lanes of lone blocks"
    meets = frozenset({Wish.VERTICAL, Wish.RESTITUTION})

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.kernels.lanes import block
        from rockfrag.engines.lanes import sampled

        g, made = cases.request.g, sampled(cases, 1.0)
        intervals = made[2]
        pivots = np.empty((*intervals.shape, 2), block.PIVOT)
        for i, system in enumerate(cases.systems):
            pivots[i] = _pivots(system, g, block.PIVOT)
        pivots["swing"] *= intervals[:, :, np.newaxis] ** 2
        pivots["per_swing"] /= intervals[:, :, np.newaxis] ** 2
        parts, free = np.ones(intervals.shape), np.zeros(intervals.shape, np.int64)
        told = {"bodies": pivots, "factors": cases.scales / g, "parts": parts, "free": free}
        return self._by_lanes(cases, block.integrate_blocks, block.worker, made, **told)


def _pivots(system: System, g: float, dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """Constants of a lone body's right and left pivot, with p² where p² dt² belongs."""
    pivots = np.empty(2, dtype)
    shape, law = system.shapes[0], system.contacts[0].law
    # of the impact that ends rocking on a pivot and comes down on the other
    for at, pivot, measured in ((0, +1, law.left), (1, -1, law.right)):
        p, alpha = geometry.frequency(shape, pivot, g), geometry.critical_angle(shape, pivot)
        if not p * p * alpha * alpha > 0:
            raise InputError(
                "body: lengths, mass and inertia are too far apart; check their units."
            )
        by_momentum = geometry.momentum_restitution(shape, -pivot)
        e = by_momentum if law.name == "momentum" else measured
        pivots[at] = geometry.pivot_constants(shape, pivot, e, g)
    return pivots


class TwoBlocks(PureRocking):
    """Two bodies on each other: lanes of stacks side by side (``kernels.lanes.stack_case``)."""

    name = "lanes of two blocks"
    meets = frozenset({Wish.TWO_BODIES, Wish.VERTICAL, Wish.RESTITUTION})

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.kernels.equations import BODY
        from rockfrag.engines.kernels.lanes import stack_case
        from rockfrag.engines.kernels.lanes.scheduler import integrate_stacks
        from rockfrag.engines.lanes import sampled
        from rockfrag.engines.records import body_record
        from rockfrag.engines.steps import STACK_STEP, free_samples, step_count

        g, step = cases.request.g, STACK_STEP * cases.request.step
        made = sampled(cases, 1.0 / g)
        each = list(zip(cases.systems, made[2], strict=True))
        return self._by_lanes(
            *(cases, integrate_stacks, stack_case.worker, made),
            bodies=np.array([body_record(system, g=g) for system in cases.systems], BODY),
            factors=cases.scales,
            parts=1.0 / np.array([step_count(system, h, g, step) for system, h in each]),
            free=np.array([free_samples(system, h, g) for system, h in each]),
        )


LONE_BLOCKS, TWO_BLOCKS = LoneBlocks(), TwoBlocks()
