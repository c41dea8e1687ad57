"""Engine of two bodies on each other in pure rocking: lanes of stacks side by side."""

import numpy as np

from rockfrag.engines.contract import Case, Cases, Request, Support, Wish, by_wishes
from rockfrag.engines.response import Response
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.system import geometry
from rockfrag.system.system import System


class TwoBlocks:
    """Two planar bodies on each other that rock and never slide, from rest (``kernels.lanes.stack_case``)."""

    name = "lanes of two blocks"
    meets = frozenset({Wish.TWO_BODIES, Wish.VERTICAL, Wish.RESTITUTION})

    def supports(self, system: System, motion: GroundMotion, request: Request) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = by_wishes(self, system, motion, request)
        return found if not found else pair_support(system)

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.kernels.equations import BODY
        from rockfrag.engines.kernels.lanes import stack_case
        from rockfrag.engines.kernels.lanes.case import OUTCOME, Ensemble
        from rockfrag.engines.kernels.lanes.scheduler import integrate_stacks
        from rockfrag.engines.lanes import integrate, sampled, step_of, write_lanes
        from rockfrag.engines.records import body_record
        from rockfrag.engines.steps import STACK_STEP, free_samples, step_count

        g, step = cases.request.g, STACK_STEP * step_of(cases)
        motions, rows, intervals = sampled(cases, 1.0 / g)
        each = list(zip(cases.systems, intervals, strict=True))
        count = len(cases.systems) * cases.scales.size
        ensemble = Ensemble(
            counter=np.array([0]),
            count=count,
            bodies=np.array([body_record(system, g=g) for system in cases.systems], BODY),
            factors=cases.scales,
            rows=rows,
            intervals=intervals,
            parts=1.0 / np.array([step_count(system, h, g, step) for system, h in each]),
            free=np.array([free_samples(system, h, g) for system, h in each]),
        )
        found = np.empty(count, OUTCOME)
        integrate(integrate_stacks, stack_case.worker, cases.threads, ensemble, motions, found)
        outcomes = empty_outcomes(cases.names, cases.scales, (self.name,))
        write_lanes(outcomes, found.reshape(cases.shape), intervals[:, :, np.newaxis])
        return outcomes

    def history(self, case: Case) -> Response:
        """Refuse: lanes keep no history."""
        raise NotImplementedError


_REASONS = {
    geometry.BESIDE: "the upper body does not stand on the lower one",
    geometry.OFF_CONTACT: "the upper body's centre of gravity is not above its contact",
    geometry.TILTED_OFF: "a centre of gravity is not above its base as the bodies stand",
    geometry.REACHES_GROUND: "the upper body reaches so far beyond the lower one that it could touch the ground",
}


def pair_support(system: System) -> Support:
    """Say whether kernels of two bodies know the geometry of a system: the lower one is as wide above as below."""
    if system.count != 2:
        return Support()
    lower = system.in_plane().bodies[0]
    if lower.face != lower.base:
        return Support(reason="the lower body's face is not as wide as its base")
    return Support(reason=_REASONS.get(geometry.failed_stability_check(system.pile), ""))


ENGINE = TwoBlocks()
