"""Planar bodies that stick, slide, rock, fly and land (``docs/contact.md``): many outcomes, or one history.

One rule decides, for outcomes and for histories: the contact kernels integrate the case, and where in their
response no contact reached its friction, none opened as a whole and no mode was inconsistent, the case is one of
pure rocking, and the answer is that of the engine of pure rocking.

In: :class:`rockfrag.engines.contract.Cases` of planar systems. Out: :class:`rockfrag.outcomes.Outcomes`, or of one
case its :class:`rockfrag.outcomes.response.Response`.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.engines.built_in import PLANAR, PlanarEngine
from rockfrag.engines.contract import Case, Cases, Engine, Request, engines, run_cases
from rockfrag.engines.planar import integrate as contact
from rockfrag.engines.planar import records
from rockfrag.engines.planar.holding import THIN, check_start, with_plate
from rockfrag.engines.pure_rocking.histories import shaking_of
from rockfrag.engines.pure_rocking.kernels.single import GRAZING_SPEED
from rockfrag.engines.steps import free_samples, step_count
from rockfrag.outcomes import response as responses
from rockfrag.outcomes.outcomes import (
    Outcomes,
    empty_outcomes,
    merge_outcomes,
)
from rockfrag.outcomes.response import FLIGHT, ROCKING_MODES, Response
from rockfrag.records.motion import GroundMotion
from rockfrag.system.system import System

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Records = NDArray[np.void]
VELOCITY_STEP = 8  # a jump of the base's velocity, of which the kernels know nothing

# speed over √(g b) below which a contact stays closed and slips no more after an impact [-]: of one or two bodies,
# and of columns, in which every impact calls forth others (docs/columns.md, "Speed")
CLOSING, CLOSING_OF_COLUMNS = 1e-4, 1e-3
CHUNK = 8  # cases that a thread takes at once

_KINDS = {
    contact.IMPACT: "impact",
    contact.PARADOX: "paradox",
    contact.FALLEN: "fall",
    contact.PASSING: "edge",
    contact.AT_WALL: "wall",
    contact.TIED: "tie",
    contact.BROKEN: "break",
    VELOCITY_STEP: "velocity step",
}
_STATES = np.array([FLIGHT, -1, +1, 0])
"""Contact state of an interface whose closed ends are the bits (left, right) of a number."""

_OF_CASES = (
    "overturned_body",
    "overturning_time",
    "impacts",
    "paradoxes",
    "given_way",
    "parted_contact",
    "several_modes",
)
"""Columns of cases that records ``OUTCOME`` have under the same names."""

_OF_CONSTRAINTS = (
    "hits",
    "largest_impulse",
    "largest_force",
    "breaking_time",
    "stroke",
)
"""Columns of constraints that they have."""


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases.

    Systems that pure rocking can answer get its answers first; over these, the outcomes of the contact kernels are
    written wherever something slid, flew or had no consistent mode.
    """
    outcomes = empty_outcomes(
        cases.names, cases.scales, (PLANAR.name,), holding=cases.holding
    )
    richest = max(cases.motions, key=lambda motion: len(motion.components))
    # as if nothing could slide
    stuck = [system.held() for system in cases.systems]
    pure = [_pure(system, richest, cases.request) for system in stuck]
    rocking = [i for i, engine in enumerate(pure) if engine is not None]
    if rocking:
        held = run_cases(replace(cases, systems=tuple(stuck[i] for i in rocking)))
        outcomes = replace(outcomes, engines=(PLANAR.name, *held.engines))
        merge_outcomes(outcomes, rocking, held)
        if len(rocking) == len(cases.systems):
            outcomes = replace(outcomes, without_sliding=held.overturned)
    found = contact_outcomes(cases)
    for i, system in enumerate(cases.systems):
        own = without_plate(found[i], system)
        write_contact(outcomes, i, system.count, own, everything=i not in rocking)
    return outcomes


def _pure(system: System, motion: GroundMotion, request: Request) -> Engine | None:
    """Engine of pure rocking of a system that nothing holds, if there is one; None otherwise.

    Engines that are not of planar contact are of pure rocking where they support a planar system.
    """
    if system.holding:
        return None
    others = (each for each in engines() if not isinstance(each, PlanarEngine))
    return next(
        (other for other in others if other.supports(system, motion, request)), None
    )


_OF_BODIES = ("peak_rotation", "peak_velocity", "peak_slip", "slip", "slid", "flights")
"""What the kernels write of each body or of the contact under it."""


def without_plate(outcome: NDArray[np.void], system: System) -> NDArray[np.void]:
    """Outcomes whose lowest body is that of the system: the kernels count the plate of an isolator as a body.

    Parameters
    ----------
    outcome : records ``OUTCOME`` of the kernels, of any shape
    system : of which they are

    Returns
    -------
    The records, of that shape, with bodies numbered without the plate.
    """
    if system.support is None:
        return outcome
    own = outcome.copy()
    for name in _OF_BODIES:
        own[name] = np.roll(outcome[name], -1, axis=-1)
        own[name][..., -1] = 0
    for name in ("overturned_body", "parted_contact"):
        own[name] = np.maximum(outcome[name] - 1, 0)
    return own


def write_contact(
    into: Outcomes, i: int, count: int, found: NDArray[np.void], everything: bool
) -> None:
    """Write what became of one system over what pure rocking has found, where it slid or flew.

    Parameters
    ----------
    into, i : outcomes, and number of the system
    count, found : of its bodies, and records ``OUTCOME``, shape (motions, scales)
    everything : whether pure rocking has found nothing
    """
    flights = found["flights"].sum(axis=-1)
    other = (found["slid"].max(axis=-1) > 0) | (flights > 0) | (found["paradoxes"] > 0)
    other |= everything
    place: tuple[Any, ...] = (i, *np.nonzero(other))
    left = found[other]
    fell = left["overturned_body"]
    into.engine[place] = 0
    into.overturned[place] = fell > 0
    into.certain_time[place] = np.nan
    into.unstable_distance[place] = np.nan
    into.flights[place] = flights[other]
    into.leaning[place] = left["leaning"] > 0
    for name in _OF_CASES:
        getattr(into, name)[place] = left[name]
    own = (*place, slice(0, count))
    # whether each body is the one that fell first
    first = fell[:, np.newaxis] == np.arange(1, count + 1)
    for name in ("peak_velocity", "slip", "peak_slip"):
        getattr(into, name)[own] = left[name][:, :count]
    held = (*place, slice(0, len(into.holding[i])))
    for name in _OF_CONSTRAINTS:
        getattr(into, name)[held] = left[name][:, : len(into.holding[i])]
    into.peak_rotation[own] = np.where(first, np.inf, left["peak_rotation"][:, :count])


def history(case: Case) -> Response:
    """Return the response of a case."""
    found = ContactRun(case)
    pure = replace(case, system=case.system.held())
    engine = _pure(pure.system, case.motion, pure.request)
    outcome = found.work["outcome"]
    loose = (
        outcome["slid"].any() or outcome["flights"].any() or outcome["paradoxes"] > 0
    )
    if loose or engine is None:
        return found.response()
    return without_slip(replace(engine.history(pure), system=case.system))


def without_slip(response: Response) -> Response:
    """Give a response of pure rocking the columns of one with friction: slips, all zero, and energy lost to it."""
    bodies = response.slip.shape[1]
    states = {name: pair[2 - bodies :] for pair, name in ROCKING_MODES.items()}
    after = np.array(
        [states[name] for name in response.contact_events["to"]], dtype=np.int64
    )
    after = after.reshape(-1, bodies)
    still = np.zeros_like(after)
    contact_events = responses.with_slips(
        response.contact_events, after, still, still.astype(np.float64)
    )
    energy = response.energy.copy()
    energy.insert(energy.shape[1] - 1, "lost_friction", 0.0)
    return replace(response, contact_events=contact_events, energy=energy)


def contact_outcomes(
    grid: Cases, wanted: NDArray[np.bool_] | None = None
) -> NDArray[np.void]:
    """Integrate the ``wanted`` cases of systems × motions × scales, all if None; others are left zero.

    Parameters
    ----------
    grid : systems × motions × scales
    wanted : of them, shape (systems, motions, scales)

    Returns
    -------
    Records ``OUTCOME``, shape (systems, motions, scales).
    """
    g, step = grid.request.g, grid.request.step
    dts = np.array([motion.dt for motion in grid.motions])
    given = [described(system, g) for system in grid.systems]
    ups = [motion.z.acceleration for motion in grid.motions if motion.z is not None]
    sizes = [motion.x.acceleration.size for motion in grid.motions]
    cases = contact.Cases(
        bodies=np.array([body for body, _ in given], records.BODY),
        starts=np.array([start for _, start in given]),
        horizontal=np.concatenate([motion.x.acceleration for motion in grid.motions]),
        vertical=np.concatenate(ups) if ups else np.zeros(0),
        offsets=np.concatenate([[0], np.cumsum(sizes)]),
        dts=dts,
        factors=grid.scales,
        closing=np.array([closing_of(system) for system in grid.systems]),
        substeps=np.array(
            [step_count(system, dts, g, step) for system in grid.systems]
        ),
        free_samples=np.array(
            [free_samples(system, dts, g) for system in grid.systems]
        ),
    )
    numbers = np.flatnonzero(np.ones(grid.shape) if wanted is None else wanted)
    outcome = np.zeros(grid.shape, records.OUTCOME)
    nothing = contact.Kept(
        np.zeros(0, contact.SAMPLE), np.zeros(0, contact.CONTACT_EVENT)
    )

    def work(chunk: Ints) -> None:
        memory = records.working_memory()
        contact.integrate_cases(chunk, cases, nothing, memory, outcome.ravel())

    # compiled before threads begin
    work(numbers[:0])
    with ThreadPoolExecutor(grid.threads) as pool:
        list(pool.map(work, np.array_split(numbers, 1 + numbers.size // CHUNK)))
    return outcome


def closing_of(system: System) -> float:
    """Speed over √(g b) below which contacts of a system stay closed after an impact [-].

    b is half the width of the uppermost body.
    """
    return CLOSING if system.count < 3 else CLOSING_OF_COLUMNS


def described(system: System, g: float) -> tuple[np.void, Array]:
    """Record ``BODY`` of a system, and the coordinates and velocities that it starts with.

    Parameters
    ----------
    system, g : the bodies, and the acceleration of gravity [m/s²]

    Returns
    -------
    The record, and coordinates and velocities, shape (2, 3 MOST).

    Raises
    ------
    InputError
        If the start is inside a wall, or beyond a stop.
    """
    body, start = records.system_record(system, g), with_plate(system).start
    zeros = (0.0,) * int(body["count"])
    pose = (zeros, zeros) if start is None else (start.rotation, start.velocity)
    placed = records.posed(body, *pose)
    if start is not None and start.position is not None:
        for k, at in enumerate(start.position):
            placed[0, 3 * k : 3 * k + 2] = at
    if start is not None:
        check_start(body, placed, system)
    return body, placed


class ContactRun:
    """One planar system that may slide, rock and fly, integrated by the contact kernels."""

    def __init__(self, case: Case, closing: float | None = None) -> None:
        closing = closing_of(case.system) if closing is None else closing
        self.case, self.work = case, records.working_memory()
        self.body, start = described(case.system, case.request.g)
        shaking = shaking_of(case, 1.0)
        history = np.zeros(shaking.samples.size + shaking.free_samples, contact.SAMPLE)
        most = 4096
        while True:
            kept = contact.Kept(history, np.zeros(most, contact.CONTACT_EVENT))
            done = contact.integrate(
                self.body, shaking, start, closing, kept, self.work
            )
            found = int(self.work["noted"])
            if found <= most:
                break
            most = found
        self.history, self.contact_events = history[:done], kept.contact_events[:found]
        values = case.scale * case.motion.x.acceleration
        self.time: Array = np.arange(done, dtype=np.float64) * case.motion.dt
        self.ground: Array = np.zeros(done)
        self.ground[: values.size] = values[:done]
        # of samples and of contact events, for which comes before which
        self.clock, self.event_clock = self.time, self.contact_events["time"]

    def response(self) -> Response:
        """Return the response that the contact kernels wrote."""
        case, history = self.case, self.history
        outcome = without_plate(np.array(self.work["outcome"]), case.system)
        count, fallen = case.system.count, int(outcome["overturned_body"])
        # the lowest body of an isolated system is the plate
        first = int(self.body["count"]) - count
        above = slice(first, first + count)
        # x, y and θ of each body, and their rates, shape (samples, bodies, 3)
        of_bodies, each = slice(3 * first, 3 * (first + count)), (-1, count, 3)
        centres = history["q"][:, of_bodies].reshape(each)
        speeds = history["v"][:, of_bodies].reshape(each)
        normal, shear = history["normal"][:, above], history["shear"][:, above]
        state, slides = _modes(history["mode"], count, first)
        table = _contact_events(self.contact_events, first, count)
        return Response(
            system=case.system,
            time=self.time,
            ground_acceleration=self.ground,
            position=centres[:, :, :2] - (0.0, THIN if first else 0.0),
            theta=centres[:, :, 2],
            omega=speeds[:, :, 2],
            alpha=history["alpha"][:, above],
            state=state,
            slides=slides,
            slip=history["slip"][:, above],
            contact_events=table,
            overturned=fallen > 0,
            overturned_body=("", *case.system.names)[fallen],
            overturning_time=float(outcome["overturning_time"]),
            leaning=bool(outcome["leaning"]),
            energy=self._energies(),
            constraints=self._constraints(),
            plate=history["q"][:, 0].copy() if first else None,
            normal_force=normal,
            friction_force=shear,
            friction_demand=responses.sampled_demand(normal, shear),
            least_normal_force=np.asarray(normal.min(axis=0)),
            grazings=_grazings(table),
            forced=int(self.work["forced"]),
            **{
                name: int(outcome[name])
                for name in ("impacts", "paradoxes", "given_way")
            },
        )

    def _constraints(self) -> pd.DataFrame:
        """Make the table of what holds the bodies: hits, forces [N], strokes [m] and times of breaking [s]."""
        return responses.constraint_table(
            self.case.system.holding, self.work["outcome"]
        )

    def _energies(self) -> pd.DataFrame:
        """Return the table of energies [J] over time: kinetic, potential, work, losses by contact, friction."""
        p, history, contact_events = self.body, self.history, self.contact_events
        count = int(self.body["count"])
        inertia, at = 1.0 / p["inverse"][: 3 * count], slice(1, 3 * count, 3)
        kinetic = (inertia * history["v"][:, : 3 * count] ** 2).sum(axis=1) / 2
        potential = float(p["g"]) * (p["mass"][:count] * history["q"][:, at]).sum(
            axis=1
        )
        lost = contact_events["energy_before"] - contact_events["energy_after"]
        lost[~np.isin(contact_events["kind"], (contact.IMPACT, contact.PARADOX))] = 0.0
        # the lowest contact whose mode changes as it comes down, or the uppermost
        opened, _ = _modes(contact_events["before"], count)
        closed, _ = _modes(contact_events["after"], count)
        closes = (opened != 0) & (opened != closed)
        closes[:, -1] = True
        own = self.case.system.count
        contact_of = np.maximum(closes.argmax(axis=1) - (count - own), 0)
        contact_of[contact_events["at_wall"] > 0] = own
        table = responses.energy_table(
            self.clock,
            kinetic,
            potential,
            history["work"],
            contacts=own,
            losses=(self.event_clock, contact_of, lost),
            friction=history["friction_loss"],
            held=history["tied"] if self.case.system.holding else None,
        )
        table["time"] = self.time
        return table


def _modes(numbers: Ints, blocks: int, first: int = 0) -> tuple[Ints, Ints]:
    """Contact states and signs of slip of bodies from the ``first`` on, each of shape (n, blocks).

    ``numbers`` are modes as ``search.mode_number`` writes them, shape (n,).
    """
    # a digit of four bits for each contact: two for its closed ends, two for the sign of slip plus one
    places = 4 * np.arange(first, first + blocks)
    digits = (numbers[:, np.newaxis] >> places) & 15
    return _STATES[digits & 3], (digits >> 2) - 1


def _contact_events(found: NDArray[Any], first: int, blocks: int) -> pd.DataFrame:
    """Make the table of contact events of a response, of the bodies from the ``first`` on.

    ``found``: records CONTACT_EVENT of the kernels, whose modes, angles and rates have the plate of an isolator
    too; ``blocks``: number of the bodies.
    """
    above = slice(first, first + blocks)
    before, slid = _modes(found["before"], blocks, first)
    after, slides = _modes(found["after"], blocks, first)
    slip = found["slip"][:, above]
    turns = slice(3 * first + 2, 3 * (first + blocks), 3)
    kinds = [
        _KINDS.get(kind) or _kind_of_change(*change)
        for kind, *change in zip(
            found["kind"].tolist(), before, after, slid, slides, strict=True
        )
    ]
    table = responses.contact_event_table(
        found["time"],
        kinds,
        (before, after),
        (found["v_before"][:, turns], found["v_after"][:, turns]),
        theta=found["q"][:, turns],
        kinetic=(found["energy_before"], found["energy_after"]),
    )
    return responses.with_slips(table, after, slides, slip)


def _grazings(contact_events: pd.DataFrame) -> int:
    """Number of impacts of which no contact came down faster than ``GRAZING_SPEED``.

    Its speed is the difference of the angular velocities of both sides, of which the ground has none.
    """
    fastest = np.array(
        [
            np.abs(np.diff([0.0, *omega])).max()
            for omega in contact_events["omega_before"]
        ]
    )
    grazes = contact_events["kind"].eq("impact") & (fastest < GRAZING_SPEED)
    return int(grazes.sum())


def _kind_of_change(before: Ints, after: Ints, slid: Ints, slides: Ints) -> str:
    """Name of a contact event without an impact: what opens first, then what slides.

    ``before``, ``after``: contact states; ``slid``, ``slides``: signs of slip; one a body each.
    """
    if np.any((after == FLIGHT) & (before != FLIGHT)):
        return "flight"
    if np.any((after != 0) & (before == 0)):
        return "opening"
    if np.any(after != before):
        return "closing"
    return "slip" if np.any((slides != 0) & (slides != slid)) else "stick"
