"""Engine of planar bodies that stick, slide, rock, fly and land (``docs/contact.md``)."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines import contract
from rockfrag.engines.contract import Wish
from rockfrag.engines.response import ROCKING_MODES, Response, with_slips
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes, merge_outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.system.system import System

_OF_CASES = (
    *("overturned_body", "overturning_time", "impacts", "paradoxes", "given_way"),
    *("parted_contact", "several_modes"),
)
"""Columns of cases that the kernels tell under the same names."""


class PlanarContact:
    """Bodies whose contacts have friction: pure rocking where nothing slides or flies, and contact otherwise.

    One rule decides, for outcomes and for histories: the contact kernels integrate the case, and where in their
    response no contact reached its friction, none opened as a whole and no mode was inconsistent, the case is one
    of pure rocking, and the answer is that of the engine of pure rocking.
    """

    name = "planar contact"
    meets = frozenset(
        {
            *(Wish.TWO_BODIES, Wish.MANY_BODIES, Wish.VERTICAL, Wish.FRICTION, Wish.RESTITUTION),
            *(Wish.START, Wish.HISTORY),
        }
    )

    def supports(
        self, system: System, motion: GroundMotion, request: contract.Request
    ) -> contract.Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        return contract.by_wishes(self, system, motion, request)

    def run(self, cases: contract.Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.planar.cases import contact_outcomes

        outcomes = empty_outcomes(cases.names, cases.scales, (self.name,))
        richest = max(cases.motions, key=lambda motion: len(motion.components))
        stuck = [system.held() for system in cases.systems]
        pure = [self._pure(system, richest, cases.request) for system in stuck]
        rocking = [i for i, engine in enumerate(pure) if engine is not None]
        if rocking:
            held = contract.run_cases(replace(cases, systems=tuple(stuck[i] for i in rocking)))
            outcomes = replace(outcomes, engines=(self.name, *held.engines))
            merge_outcomes(outcomes, rocking, held)
        found = contact_outcomes(cases)
        for i, count in enumerate(outcomes.counts):
            self._write(outcomes, i, count, found[i], everything=i not in rocking)
        return outcomes

    def _pure(
        self, system: System, motion: GroundMotion, request: contract.Request
    ) -> contract.Engine | None:
        """Engine of pure rocking of a system, if there is one."""
        others = (engine for engine in contract.engines() if engine is not self)
        return next((other for other in others if other.supports(system, motion, request)), None)

    def _write(
        self, into: Outcomes, i: int, count: int, found: NDArray[np.void], everything: bool
    ) -> None:
        """Write what became of one system over what pure rocking has found, where it slid or flew."""
        flights = found["flights"].sum(axis=-1)
        other = (found["slid"].max(axis=-1) > 0) | (flights > 0) | (found["paradoxes"] > 0)
        other |= everything
        place: tuple[Any, ...] = (i, *np.nonzero(other))
        left = found[other]
        fell = left["overturned_body"]
        into.engine[place] = 0
        into.overturned[place] = fell > 0
        into.certain_time[place] = into.unstable_distance[place] = np.nan
        into.flights[place] = flights[other]
        for name in _OF_CASES:
            getattr(into, name)[place] = left[name]
        own, first = (*place, slice(0, count)), fell[:, np.newaxis] == np.arange(1, count + 1)
        for name in ("peak_velocity", "slip", "peak_slip"):
            getattr(into, name)[own] = left[name][:, :count]
        into.peak_rotation[own] = np.where(first, np.inf, left["peak_rotation"][:, :count])

    def history(self, case: contract.Case) -> Response:
        """Return the response of a case."""
        from rockfrag.engines.planar.cases import ContactRun

        found = ContactRun(case)
        pure = replace(case, system=case.system.held())
        engine = self._pure(pure.system, case.motion, pure.request)
        if found.loose or engine is None:
            return found.response()
        return without_slip(replace(engine.history(pure), system=case.system))


def without_slip(response: Response) -> Response:
    """Give a response of pure rocking the columns of one with friction."""
    bodies = response.slip.shape[1]
    states = {name: pair[2 - bodies :] for pair, name in ROCKING_MODES.items()}
    after = np.array([states[name] for name in response.contact_events["to"]], dtype=np.int64)
    after = after.reshape(-1, bodies)
    still = np.zeros_like(after)
    contact_events = with_slips(response.contact_events, after, still, still.astype(np.float64))
    energy = response.energy.copy()
    energy.insert(energy.shape[1] - 1, "lost_friction", 0.0)
    return replace(response, contact_events=contact_events, energy=energy)


ENGINE = PlanarContact()
