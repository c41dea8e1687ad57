"""Planar bodies that stick, slide, rock, fly and land (``docs/contact.md``): many outcomes, or one history.

One rule decides, for outcomes and for histories: the contact kernels integrate the case, and where in their
response no contact reached its friction, none opened as a whole and no mode was inconsistent, the case is one of
pure rocking, and the answer is that of the engine of pure rocking.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.engines import response as responses
from rockfrag.engines.built_in import PLANAR
from rockfrag.engines.contract import Case, Cases, Engine, Request, engines, run_cases
from rockfrag.engines.kernels.single import GRAZING_SPEED
from rockfrag.engines.planar import integrate as contact
from rockfrag.engines.planar import records
from rockfrag.engines.response import FLIGHT, ROCKING_MODES, Response
from rockfrag.engines.single import shaking_of
from rockfrag.engines.steps import free_samples, step_count
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes, merge_outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.system.system import System

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CLOSING = 1e-4  # parting speed over √(g b) below which a contact stays closed after an impact [-]
CHUNK = 8  # cases that a thread takes at once

_KINDS = {
    contact.IMPACT: "impact",
    contact.PARADOX: "paradox",
    contact.FALLEN: "fall",
    contact.PASSING: "edge",
}
_STATES = np.array([FLIGHT, -1, +1, 0])
"""Contact state of an interface whose closed ends are the bits (left, right) of a number."""

_OF_CASES = (
    *("overturned_body", "overturning_time", "impacts", "paradoxes", "given_way"),
    *("parted_contact", "several_modes"),
)
"""Columns of cases that the kernels tell under the same names."""


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases."""
    outcomes = empty_outcomes(cases.names, cases.scales, (PLANAR.name,))
    richest = max(cases.motions, key=lambda motion: len(motion.components))
    stuck = [system.held() for system in cases.systems]
    pure = [_pure(system, richest, cases.request) for system in stuck]
    rocking = [i for i, engine in enumerate(pure) if engine is not None]
    if rocking:
        held = run_cases(replace(cases, systems=tuple(stuck[i] for i in rocking)))
        outcomes = replace(outcomes, engines=(PLANAR.name, *held.engines))
        merge_outcomes(outcomes, rocking, held)
    found = contact_outcomes(cases)
    for i, count in enumerate(outcomes.counts):
        _write(outcomes, i, count, found[i], everything=i not in rocking)
    return outcomes


def _pure(system: System, motion: GroundMotion, request: Request) -> Engine | None:
    """Engine of pure rocking of a system, if there is one."""
    others = (engine for engine in engines() if engine is not PLANAR)
    return next((other for other in others if other.supports(system, motion, request)), None)


def _write(into: Outcomes, i: int, count: int, found: NDArray[np.void], everything: bool) -> None:
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


def history(case: Case) -> Response:
    """Return the response of a case."""
    found = ContactRun(case)
    pure = replace(case, system=case.system.held())
    engine = _pure(pure.system, case.motion, pure.request)
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
    contact_events = responses.with_slips(
        response.contact_events, after, still, still.astype(np.float64)
    )
    energy = response.energy.copy()
    energy.insert(energy.shape[1] - 1, "lost_friction", 0.0)
    return replace(response, contact_events=contact_events, energy=energy)


def contact_outcomes(grid: Cases, wanted: NDArray[np.bool_] | None = None) -> NDArray[np.void]:
    """Integrate the ``wanted`` cases of systems × motions × scales, all if None; others are left zero."""
    g, step = grid.request.g, grid.request.step
    dts = np.array([motion.dt for motion in grid.motions])
    described = [_described(system, g) for system in grid.systems]
    ups = [motion.z.acceleration for motion in grid.motions if motion.z is not None]
    sizes = [motion.x.acceleration.size for motion in grid.motions]
    cases = contact.Cases(
        bodies=np.array([body for body, _ in described], records.BODY),
        starts=np.array([start for _, start in described]),
        horizontal=np.concatenate([motion.x.acceleration for motion in grid.motions]),
        vertical=np.concatenate(ups) if ups else np.zeros(0),
        offsets=np.concatenate([[0], np.cumsum(sizes)]),
        dts=dts,
        factors=grid.scales,
        substeps=np.array([step_count(system, dts, g, step) for system in grid.systems]),
        free_samples=np.array([free_samples(system, dts, g) for system in grid.systems]),
    )
    numbers = np.flatnonzero(np.ones(grid.shape) if wanted is None else wanted)
    outcome, nothing = np.zeros(grid.shape, records.OUTCOME), np.zeros((0, 0))

    def work(chunk: Ints) -> None:
        memory = records.working_memory()
        contact.integrate_cases(chunk, cases, CLOSING, nothing, memory, outcome.ravel())

    # compiled before threads begin
    work(numbers[:0])
    with ThreadPoolExecutor(grid.threads) as pool:
        list(pool.map(work, np.array_split(numbers, 1 + numbers.size // CHUNK)))
    return outcome


def _described(system: System, g: float) -> tuple[np.void, Array]:
    """Record ``BODY`` of a system, and the coordinates and velocities that it starts with."""
    body, start = records.system_record(system, g), system.start
    zeros = (0.0,) * system.count
    pose = (zeros, zeros) if start is None else (start.rotation, start.velocity)
    return body, records.posed(body, *pose)


class ContactRun:
    """One planar system that may slide, rock and fly, integrated by the contact kernels."""

    def __init__(self, case: Case, closing: float = CLOSING) -> None:
        self.case, self.count, self.work = case, case.system.count, records.working_memory()
        self.body, start = _described(case.system, case.request.g)
        shaking = shaking_of(case, 1.0)
        samples, most = shaking.samples.size + shaking.free_samples, 4096
        history = np.zeros((samples, contact.history_columns(self.count)))
        while True:
            contact_events = np.zeros((most, contact.contact_event_columns(self.count)))
            done, found = contact.integrate(
                self.body, shaking, start, closing, history, contact_events, self.work
            )
            if found <= most:
                break
            most = found
        # rows of the columns that the kernels write
        self.history, self.contact_events = history[:done], contact_events[:found]

    @property
    def loose(self) -> bool:
        """Whether a contact reached its friction, opened as a whole or had no consistent mode."""
        told = self.work["told"]
        return bool(told["slid"].any() or told["flights"].any() or told["paradoxes"] > 0)

    def response(self) -> Response:
        """Return the response that the contact kernels wrote."""
        case, told, history, blocks = self.case, self.work["told"], self.history, self.count
        done, fallen = len(history), int(told["overturned_body"])
        values, ground = case.scale * case.motion.x.acceleration, np.zeros(done)
        ground[: values.size] = values[:done]
        centres, speeds = history[:, : 6 * blocks].reshape(done, 2, blocks, 3).swapaxes(0, 1)
        rest = history[:, 6 * blocks : 10 * blocks].reshape(done, 4, blocks)
        slips, normal, shear, alpha = rest.swapaxes(0, 1)
        state, slides = _modes(history[:, -1], blocks)
        table = _contact_events(self.contact_events, blocks)
        meets = np.array([np.abs(np.diff([0.0, *w])).max() for w in table["omega_before"]])
        time = np.arange(done, dtype=np.float64) * case.motion.dt
        return Response(
            system=case.system,
            time=time,
            ground_acceleration=ground,
            position=centres[:, :, :2],
            theta=centres[:, :, 2],
            omega=speeds[:, :, 2],
            alpha=alpha,
            state=state,
            slides=slides,
            slip=slips,
            contact_events=table,
            overturned=fallen > 0,
            overturned_body=("", *case.system.names)[fallen],
            overturning_time=float(told["overturning_time"]),
            energy=self._energies(time),
            normal_force=normal,
            friction_force=shear,
            friction_demand=responses.sampled_demand(normal, shear),
            least_normal_force=np.asarray(normal.min(axis=0)),
            grazings=int((table["kind"].eq("impact") & (meets < GRAZING_SPEED)).sum()),
            forced=int(self.work["forced"]),
            **{name: int(told[name]) for name in ("impacts", "paradoxes", "given_way")},
        )

    def _energies(self, time: Array) -> pd.DataFrame:
        """Balance of energy by cause over time [J]."""
        p, history, blocks = self.body, self.history, self.count
        inertia, at = 1.0 / p["inverse"][: 3 * blocks], slice(1, 3 * blocks, 3)
        kinetic = (inertia * history[:, 3 * blocks : 6 * blocks] ** 2).sum(axis=1) / 2
        potential = float(p["g"]) * (p["mass"][:blocks] * history[:, at]).sum(axis=1)
        when, kind, old, new, before, after = self.contact_events[:, :6].T
        struck = np.isin(kind, (contact.IMPACT, contact.PARADOX))
        # the lowest contact whose mode changes as it comes down, or the uppermost
        opened, closed = (_modes(mode, blocks)[0] for mode in (old, new))
        closes = (opened != 0) & (opened != closed)
        closes[:, -1] = True
        losses = when, closes.argmax(axis=1), np.where(struck, before - after, 0.0)
        balance = kinetic, potential, history[:, -4], losses, history[:, -3]
        return responses.energy_table(time, *balance, contacts=blocks)


def _modes(numbers: Array, blocks: int) -> tuple[Ints, Ints]:
    """Contact states and signs of slip in the numbers that the kernels keep, each of shape (n, blocks)."""
    digits = (numbers.astype(np.int64)[:, np.newaxis] >> (4 * np.arange(blocks))) & 15
    return _STATES[digits & 3], (digits >> 2) - 1


def _contact_events(contact_events: Array, blocks: int) -> pd.DataFrame:
    """Make the table of contact events of a response."""
    before, slid = _modes(contact_events[:, 2], blocks)
    after, slides = _modes(contact_events[:, 3], blocks)
    slip, theta, old, new = contact_events[:, 6:].reshape(-1, 4, blocks).transpose(1, 0, 2)
    changes = zip(before, after, slid, slides, strict=True)
    kinds = [
        _KINDS.get(int(kind)) or _kind_of_change(*change)
        for kind, change in zip(contact_events[:, 1], changes, strict=True)
    ]
    energies = contact_events[:, 4], contact_events[:, 5]
    table = responses.contact_event_table(
        contact_events[:, 0], kinds, (before, after), (old, new), theta, energies
    )
    return responses.with_slips(table, after, slides, slip)


def _kind_of_change(before: Ints, after: Ints, slid: Ints, slides: Ints) -> str:
    """Name of a contact event without an impact: what opens first, then what slides."""
    assert contact.CHANGE not in _KINDS
    if np.any((after == FLIGHT) & (before != FLIGHT)):
        return "flight"
    if np.any((after != 0) & (before == 0)):
        return "opening"
    if np.any(after != before):
        return "closing"
    return "slip" if np.any((slides != 0) & (slides != slid)) else "stick"
