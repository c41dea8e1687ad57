"""Engine of planar bodies that stick, slide, rock, fly and land (``docs/contact.md``)."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.contract import (
    Case,
    Cases,
    Request,
    Support,
    Wish,
    by_wishes,
    engine_for,
    run_cases,
)
from rockfrag.engines.response import Response
from rockfrag.engines.two_blocks import pair_support
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag.system.body import Interval
from rockfrag.system.contact import ROUGHEST, Friction
from rockfrag.system.system import System


class PlanarContact:
    """Bodies whose contacts have friction: pure rocking where nothing slides or flies, and contact otherwise.

    One rule decides, for outcomes and for histories: the contact kernels integrate the case, and where in their
    response no contact reached its friction, none opened as a whole and no mode was inconsistent, the case is one
    of pure rocking, and the answer is that of the engine of pure rocking.
    """

    name = "planar contact"
    meets = frozenset({Wish.TWO_BODIES, Wish.VERTICAL, Wish.FRICTION, Wish.START, Wish.HISTORY})

    def supports(self, system: System, motion: GroundMotion, request: Request) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = by_wishes(self, system, motion, request)
        if not found:
            return found
        if not system.loose:
            return Support(reason="no contact has friction")
        return pair_support(system)

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases."""
        from rockfrag.engines.lanes import intervals_of, step_of
        from rockfrag.rocking.contact.ensemble import Moving, Standing, contact_outcomes

        systems = cases.systems
        outcomes = run_cases(replace(cases, systems=tuple(map(without_friction, systems))))
        outcomes = replace(outcomes, engines=(*outcomes.engines, self.name))
        starts = [started(system) for system in systems]
        standing = Standing(
            [written(system) for system in systems],
            [frictions(system) for system in systems],
            [rotation for rotation, _ in starts],
            [velocity for _, velocity in starts],
        )
        moving = Moving(
            [motion.x.acceleration for motion in cases.motions],
            [motion.z.acceleration for motion in cases.motions if motion.z is not None],
            intervals_of(cases),
            cases.scales,
        )
        wanted = np.ones(cases.shape, dtype=bool)
        found = contact_outcomes(
            standing, moving, wanted, cases.request.g, step_of(cases), cases.threads
        )
        for i, count in enumerate(outcomes.counts):
            self._write(outcomes, i, count, found[i])
        return outcomes

    def _write(self, into: Outcomes, i: int, count: int, found: NDArray[np.void]) -> None:
        """Write what became of one system over what pure rocking has found, where it slid or flew."""
        flights = np.asarray(found["flights"])
        flights = flights if flights.ndim == found.ndim else flights.sum(axis=-1)
        other = (found["slid"].max(axis=-1) > 0) | (flights > 0) | (found["paradoxes"] > 0)
        place: tuple[Any, ...] = (i, *np.nonzero(other))
        left = found[other]
        fell = left["fallen"]
        into.engine[place] = len(into.engines) - 1
        into.overturned[place] = fell > 0
        into.overturned_body[place] = fell
        into.overturning_time[place] = np.where(fell > 0, left["time"], np.nan)
        into.certain_time[place] = np.nan
        into.impacts[place] = left["impacts"]
        into.flights[place] = flights[other]
        into.paradoxes[place] = left["paradoxes"]
        into.unstable_distance[place] = np.nan
        for k in range(count):
            own = (*place, k)
            into.peak_rotation[own] = np.where(fell == k + 1, np.inf, left["peak"][:, k])
            into.peak_velocity[own] = left["peak_speed"][:, k]
            into.slip[own] = left["slip"][:, k]
            into.peak_slip[own] = left["peak_slip"][:, k]

    def history(self, case: Case) -> Response:
        """Return the response of a case."""
        from rockfrag.rocking.contact.ensemble import COARSE_CLOSING
        from rockfrag.rocking.contact.simulation import contact_history

        motion = case.motion
        theta, omega = started(case.system)
        mu = frictions(case.system)
        found, loose = contact_history(
            written(case.system),
            case.scale * motion.x.acceleration,
            motion.dt,
            friction=mu if len(mu) > 1 else mu[0],
            vertical=None if motion.z is None else case.scale * motion.z.acceleration,
            theta0=theta,
            omega0=omega,
            g=case.request.g,
            # as outcomes have it, so that history and outcome are of one response
            closing=COARSE_CLOSING,
        )
        if loose:
            return replace(found, system=case.system)
        pure = replace(case, system=without_friction(case.system))
        engine = engine_for(pure.system, motion, pure.request)
        return without_slip(replace(engine.history(pure), system=case.system))


def frictions(system: System) -> tuple[Friction, ...]:
    """Friction of each contact; one that never slides is as rough as can be."""
    never = Friction(ROUGHEST, ROUGHEST)
    return tuple(contact.friction or never for contact in system.contacts)


def without_friction(system: System) -> System:
    """Return the system whose contacts never slide."""
    contacts = tuple(replace(contact, friction=None) for contact in system.contacts)
    return replace(system, contacts=contacts)


def started(system: System) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Rotations [rad] and angular velocities [rad/s] of the bodies at the start."""
    zeros = (0.0,) * system.count
    return (
        (zeros, zeros) if system.start is None else (system.start.rotation, system.start.velocity)
    )


def written(system: System) -> Body:
    """Return the block or the stack that a planar system of one or two bodies is."""
    blocks = []
    for body, contact in zip(system.in_plane().bodies, system.contacts, strict=True):
        assert isinstance(body.base, Interval)
        middle = (body.base.left + body.base.right) / 2
        blocks.append(
            Block(
                width=body.base.right - body.base.left,
                height=body.height,
                mass=body.mass,
                inertia=body.inertia,
                cg_height=body.centre[2],
                cg_offset=body.centre[0] - middle,
                lean=contact.tilt,
            )
        )
    return blocks[0] if len(blocks) == 1 else Stack(blocks[0], blocks[1], system.pile.offset)


def without_slip(response: Response) -> Response:
    """Give a response of pure rocking the columns of one with friction."""
    import pandas as pd

    from rockfrag.engines.response import PATTERNS, mode_name

    bodies = response.slip.shape[1]
    states = {name: pair[2 - bodies :] for pair, name in PATTERNS.items()}
    modes = [tuple(mode_name(state, 0) for state in states[name]) for name in response.events["to"]]
    events = response.events.copy()
    events["modes"] = pd.Series(modes, dtype=object)
    events["slip"] = pd.Series([(0.0,) * bodies] * len(modes), dtype=object)
    energy = response.energy.copy()
    energy.insert(energy.shape[1] - 1, "lost_friction", 0.0)
    return replace(response, events=events, energy=energy)


ENGINE = PlanarContact()
