"""Engine of lone bodies in pure rocking: 64 lanes side by side."""

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.contract import Case, Cases, Request, Support, Wish, by_wishes
from rockfrag.engines.response import Response
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.system import geometry
from rockfrag.system.system import System


class LoneBlock:
    """Lone planar bodies that rock and never slide, from rest (``kernels.lanes.block``)."""

    name = "lanes of lone blocks"
    meets = frozenset({Wish.VERTICAL, Wish.RESTITUTION})

    def supports(self, system: System, motion: GroundMotion, request: Request) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        return by_wishes(self, system, motion, request)

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.kernels.lanes import block
        from rockfrag.engines.kernels.lanes.case import OUTCOME, Ensemble
        from rockfrag.engines.lanes import integrate, sampled, write_lanes
        from rockfrag.engines.records import body_record

        g = cases.request.g
        motions, rows, intervals = sampled(cases, 1.0)
        pivots = np.empty((*intervals.shape, 2), block.PIVOT)
        for i, system in enumerate(cases.systems):
            pivots[i] = _pivots(body_record(system, g=g), block.PIVOT)
        pivots["swing"] *= intervals[:, :, np.newaxis] ** 2
        pivots["per_swing"] /= intervals[:, :, np.newaxis] ** 2
        count = len(cases.systems) * cases.scales.size
        ensemble = Ensemble(
            counter=np.array([0]),
            count=count,
            bodies=pivots,
            factors=cases.scales / g,
            rows=rows,
            intervals=intervals,
            parts=np.ones(intervals.shape),
            free=np.zeros(intervals.shape, np.int64),
        )
        found = np.empty(count, OUTCOME)
        integrate(block.integrate_blocks, block.worker, cases.threads, ensemble, motions, found)
        outcomes = empty_outcomes(cases.names, cases.scales, (self.name,))
        write_lanes(outcomes, found.reshape(cases.shape), intervals[:, :, np.newaxis])
        return outcomes

    def history(self, case: Case) -> Response:
        """Refuse: lanes keep no history."""
        raise NotImplementedError


def _pivots(body: np.void, dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """Constants of a body's right and left pivot from its record, with p² where p² dt² belongs."""
    pivots = np.empty(2, dtype)
    shape = geometry.Shape(*(float(body[name]) for name in ("b2", "m2", "i2", "c2x", "c2y")))
    g = float(body["gravity"])
    # of the impact that ends rocking on a pivot and comes down on the other
    for at, pivot, after in ((0, +1, body["after2l"]), (1, -1, body["after2r"])):
        p, alpha = geometry.frequency(shape, pivot, g), geometry.critical_angle(shape, pivot)
        if not p * p * alpha * alpha > 0:
            raise InputError(
                "body: lengths, mass and inertia are too far apart; check their units."
            )
        by_momentum = geometry.momentum_restitution(shape, -pivot)
        e = float(after["value"]) if body["measured"] else by_momentum
        pivots[at] = geometry.pivot_constants(shape, pivot, e, g)
    return pivots


ENGINE = LoneBlock()
