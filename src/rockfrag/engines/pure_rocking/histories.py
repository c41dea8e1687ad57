"""Engine of single histories in pure rocking: one or two bodies, every impact, everything about the response.

In: a :class:`rockfrag.engines.contract.Case`. Out: its :class:`rockfrag.outcomes.response.Response`. Theory:
``docs/rocking.md``; the kernels: ``docs/kernels.md``.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.elementary import hypot
from rockfrag.base.errors import InputError
from rockfrag.engines.built_in import SINGLE
from rockfrag.engines.compile.jit import compiling_alone
from rockfrag.engines.contract import Case, Cases
from rockfrag.engines.pure_rocking.ensembles import (
    BLOCKS,
    blocks_of,
    body_record,
    write_rocking,
)
from rockfrag.engines.pure_rocking.kernels import record as kept
from rockfrag.engines.pure_rocking.kernels.equations import STATE
from rockfrag.engines.pure_rocking.kernels.single import SCRATCH, Shaking, integrate
from rockfrag.engines.steps import MOST_SAMPLES, free_samples, step_count
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.outcomes.response import Response, contact_event_table, energy_table
from rockfrag.system import geometry
from rockfrag.system.system import System

VELOCITY_STEP = 4  # a jump of the base's velocity, of which the kernels know nothing
KINDS = {
    kept.OPENING: "opening",
    kept.CLOSING: "impact",
    kept.CHATTER: "chatter",
    kept.LIFTING: "lift-off",
    VELOCITY_STEP: "velocity step",
}
"""Kinds of contact events in words."""

PIVOTS = (+1, -1)  # right and left pivot

Records = NDArray[np.void]

Link = tuple[Floats, ...]


@dataclass(frozen=True)
class _Turning:
    """How one body turns over a history of n samples."""

    # of its rotation [-], shape (n,) each
    sine: Floats
    cosine: Floats
    omega: Floats  # angular velocity [rad/s], shape (n,)
    alpha: Floats  # angular acceleration [rad/s²], shape (n,)

    def turned(self, arm: Floats) -> Link:
        """Arm in the body [m], shape (2,) or (n, 2), as it lies relative to the ground: x and y [m], (n,) each."""
        x, y = np.transpose(arm)
        return x * self.cosine + y * self.sine, -x * self.sine + y * self.cosine

    def link(self, arm: Floats) -> Link:
        """The same, and the acceleration of its tip about its foot [m/s²], α × r - ω² r, (n,) each."""
        x, y = self.turned(arm)
        inwards = self.omega * self.omega
        return x, y, self.alpha * y - inwards * x, -self.alpha * x - inwards * y


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases, whose histories are not kept."""
    no_samples = np.empty(0, kept.SAMPLE)
    no_contact_events = np.empty(0, kept.CONTACT_EVENT)

    def summary_of(case: Case, record: np.void, start: np.void) -> np.void:
        shaking = shaking_of(case, case.request.g)
        return run_integration(record, shaking, start, no_samples, no_contact_events)[1]

    return summarised(cases, SINGLE.name, summary_of)


def summarised(
    cases: Cases, name: str, summary_of: Callable[[Case, np.void, np.void], np.void]
) -> Outcomes:
    """Return the outcomes of cases by an engine of a name, from the SUMMARY of each.

    ``summary_of`` takes a case, the record of its body and the STATE that it begins with.
    """
    records = [
        body_record(system, cases.request.linear, cases.request.g)
        for system in cases.systems
    ]
    starts = [initial_state(system) for system in cases.systems]
    summaries = np.zeros(cases.shape, kept.SUMMARY)

    def work(place: tuple[int, int, int]) -> None:
        """Integrate one case and keep what outcomes take from it."""
        i, j, k = place
        case = Case(
            cases.systems[i], cases.motions[j], float(cases.scales[j, k]), cases.request
        )
        summaries[place] = summary_of(case, records[i], starts[i])

    with ThreadPoolExecutor(cases.threads) as pool:
        list(pool.map(work, np.ndindex(*cases.shape)))
    outcomes = empty_outcomes(cases.names, cases.scales, (name,))
    write_rocking(outcomes, summaries, "ratio")
    outcomes.overturning_time[:] = summaries["fall_time"]
    for rows, k, number in blocks_of(outcomes):
        place, found = (rows, ..., k), summaries[rows]
        if number == "2":
            outcomes.peak_velocity[place] = found["speed2"]
        if cases.request.forces:
            outcomes.friction_demand[place] = found["demand"]["friction" + number]
            outcomes.least_normal_force[place] = found["demand"]["normal" + number]
    if cases.request.forces:
        outcomes.lost_contact[:] = summaries["lost_contact"]
    return outcomes


def history(case: Case) -> Response:
    """Return the response of a case."""
    return SingleRun(case).response()


class SingleRun:
    """A case integrated by the kernel of single histories, with all its contact events.

    Forces follow from the absolute accelerations of the centres of gravity: N2 = m2 (g + y2''), T2 = m2 x2'', and
    the sums over both blocks at the ground.
    """

    def __init__(self, case: Case) -> None:
        self.system, self.count = case.system, case.system.count
        self.record = body_record(case.system, case.request.linear, case.request.g)
        self.shaking = shaking_of(case, case.request.g)
        most = self.shaking.samples.size + self.shaking.free_samples
        if most > MOST_SAMPLES:
            raise InputError(
                f"motion: {most} samples, with the free rocking after it, are more than the "
                f"{MOST_SAMPLES} allowed."
            )
        start = initial_state(case.system)
        samples = np.zeros(most, kept.SAMPLE)
        room, count = 0, 4096
        while count > room:
            room, found = count, np.zeros(count, kept.CONTACT_EVENT)
            done, self.summary = run_integration(
                self.record, self.shaking, start, samples, found
            )
            count = int(self.summary["contact_events"])
        self.history, self.contact_events = samples[:done], found[:count]
        self.time = np.arange(done, dtype=np.float64) * case.motion.dt

    def of(self, name: str, rows: Records | None = None) -> NDArray[Any]:
        """Return a number of each body, from below, in columns, of the samples or of other rows."""
        rows = self.history if rows is None else rows
        return np.column_stack([rows[name + block] for block in BLOCKS[-self.count :]])

    def response(self) -> Response:
        """Return the response that the kernel wrote."""
        summary, demand, blocks = (
            self.summary,
            self.summary["demand"],
            BLOCKS[-self.count :],
        )
        theta, state, n = self.of("theta"), self.of("c"), len(self.history)
        fallen = int(summary["fallen"])
        ground, upward = self.ground(n)
        position, links = self._links(theta, state)
        normal, friction = self._forces(ground, upward, links)
        return Response(
            system=self.system,
            time=self.time,
            ground_acceleration=ground,
            position=position,
            theta=theta,
            omega=self.of("omega"),
            alpha=self.of("alpha"),
            state=state,
            slides=np.zeros_like(state),
            slip=np.zeros_like(theta),
            contact_events=self._contact_events(),
            overturned=fallen > 0,
            overturned_body=("", *self.system.names)[
                fallen - (2 - self.count) if fallen else 0
            ],
            overturning_time=float(summary["fall_time"]),
            energy=self._energies(),
            normal_force=normal,
            friction_force=friction,
            friction_demand=np.array([demand["friction" + block] for block in blocks]),
            least_normal_force=np.array([demand["normal" + block] for block in blocks]),
            lost_contact=float(summary["lost_contact"]),
            unstable_distance=float(summary["unstable_distance"]),
            impacts=int(summary["impacts"]),
            grazings=int(summary["grazings"]),
            given_way=int(summary["given_way"]),
        )

    def ground(self, count: int) -> tuple[Floats, Floats]:
        """Acceleration of the ground at the first samples [m/s²], and upwards over gravity, (count,) each."""
        found = np.zeros((2, count))
        for row, samples in zip(
            found, (self.shaking.samples, self.shaking.vertical), strict=True
        ):
            row[: samples.size] = self.shaking.scale * samples[:count]
        return found[0], found[1]

    def _links(self, theta: Floats, state: NDArray[Any]) -> tuple[Floats, list[Link]]:
        """Centres of gravity relative to the ground [m], (n, blocks, 2), and the links between pivots and them.

        Of each link x, y [m] and the acceleration of its tip [m/s²], each (n,): to the lower centre, to the foot
        of the upper body, from there to its centre, and along the top of the pedestal.
        """
        turns = self._turns(theta)
        lower = self.system.shapes[0]
        # number of each sample's pivots among these, shape (n, blocks)
        number = (state < 0).astype(np.int64)
        arms = np.array([geometry.arm(lower, pivot) for pivot in PIVOTS])
        arm = arms[number[:, 0]]
        links = [turns[0].link(arm)]
        centres = [links[0][:2]]
        if self.count == 2:
            links += self._upper_links(turns, number)
            (foot_x, foot_y, *_), (x, y, *_) = links[1:3]
            centres.append((foot_x + x, foot_y + y))
        position = np.stack([np.column_stack(each) for each in centres], axis=1)
        # from the pivot to the middle of the ground's face
        position[..., 0] += lower.x - arm[:, :1]
        return position, links

    def _turns(self, theta: Floats) -> list[_Turning]:
        """Rotation of each block at the samples, of its rotations [rad], shape (n, blocks)."""
        sine, cosine = np.empty((2, *theta.shape))
        with compiling_alone(kept.fill_sines):
            # the same on every processor
            kept.fill_sines(theta, sine, cosine)
        omega, alpha = self.of("omega"), self.of("alpha")
        return [
            _Turning(sine[:, i], cosine[:, i], omega[:, i], alpha[:, i])
            for i in range(self.count)
        ]

    def _upper_links(
        self, turns: Sequence[_Turning], number: NDArray[np.int64]
    ) -> list[Link]:
        """Links to the foot of the upper body, from there to its centre, and along the top of the pedestal.

        ``number`` says of each sample which of ``PIVOTS`` both bodies rock on, shape (n, 2).
        """
        pile = self.system.pile
        feet = np.array([[geometry.reach(pile, a, b) for b in PIVOTS] for a in PIVOTS])
        above = np.array([geometry.upper_arm(pile, pivot) for pivot in PIVOTS])
        top = np.subtract(pile.right, pile.left)
        return [
            turns[0].link(feet[number[:, 0], number[:, 1]]),
            turns[1].link(above[number[:, 1]]),
            turns[0].turned(top),
        ]

    def _forces(
        self, ground: Floats, upward: Floats, links: list[Link]
    ) -> tuple[Floats, Floats]:
        """Normal and friction force of each interface, across and along the face that carries [N], (n, blocks).

        ``ground`` is the acceleration of the ground [m/s²], ``upward`` its vertical one over gravity, both (n,). A
        link is x and y of a point as seen from the one below [m], and their accelerations [m/s²].
        """
        still = float(self.record["gravity"])
        gravity = still + still * upward
        mass, (_, _, ax, ay) = self.system.shapes[0].mass, links[0]
        normal, friction = mass * (gravity + ay), mass * (ground + ax)
        if self.count == 1:
            return normal[:, np.newaxis], friction[:, np.newaxis]
        pile, (foot, upper, top) = self.system.pile, links[1:]
        level = pile.upper.mass * (ground + foot[2] + upper[2])
        upright = pile.upper.mass * (gravity + foot[3] + upper[3])
        # of the interface so far upright and level: the pedestal's top turns with it
        length = hypot(*(float(x) for x in np.subtract(pile.right, pile.left)))
        tx, ty = top[0] / length, top[1] / length
        return (
            np.column_stack([normal + upright, tx * upright - ty * level]),
            np.column_stack([friction + level, tx * level + ty * upright]),
        )

    def _contact_events(self) -> pd.DataFrame:
        """Make the table of contact events."""
        found = self.contact_events
        before, after = found["before"], found["after"]
        return contact_event_table(
            found["time"],
            [KINDS[kind] for kind in found["kind"].tolist()],
            (self.of("c", before), self.of("c", after)),
            (self.of("omega", before), self.of("omega", after)),
            theta=self.of("theta", after),
            kinetic=(found["energy_before"], found["energy_after"]),
        )

    def _energies(self) -> pd.DataFrame:
        """Balance of energy by cause over time [J]."""
        kinetic, potential = np.empty((2, len(self.history)))
        with compiling_alone(kept.fill_energies):
            kept.fill_energies(
                self.record, self.history, kinetic, potential, np.zeros(1, STATE)[0]
            )
        # an impact closes the ground if the lower body's contact changed, the interface otherwise
        found = self.contact_events
        before = found["before"]["c1"]
        by_ground = (before != 0) & (before != found["after"]["c1"])
        lost = found["energy_before"] - found["energy_after"]
        # of a lone body, the kernels' second, the interface is the ground
        closed = np.where(by_ground, 0, self.count - 1)
        losses = (
            found["time"],
            closed,
            np.where(found["kind"] == kept.OPENING, 0.0, lost),
        )
        work = self.history["work"]
        return energy_table(
            self.time, kinetic, potential, work, losses=losses, contacts=self.count
        )


def initial_state(system: System) -> np.void:
    """Return the STATE that the integration begins with."""
    initial: np.void = np.zeros(1, STATE)[0]
    if system.start is not None:
        for name, values in (
            ("theta", system.start.rotation),
            ("omega", system.start.velocity),
        ):
            initial[name + "1"], initial[name + "2"] = (0.0, *values)[-2:]
    return initial


def shaking_of(case: Case, unit: float) -> Any:
    """Return what a system is shaken with (``kernels.single.Shaking``), in steps that follow from the system.

    The vertical acceleration is over ``unit`` [m/s²].
    """
    motion, request = case.motion, case.request
    return Shaking(
        samples=motion.x.acceleration,
        vertical=np.zeros(0) if motion.z is None else motion.z.acceleration / unit,
        scale=float(case.scale),
        dt=motion.dt,
        substeps=int(step_count(case.system, motion.dt, request.g, request.step)),
        free_samples=int(free_samples(case.system, motion.dt, request.g)),
    )


def run_integration(
    record: np.void,
    shaking: Any,
    initial: np.void,
    history: Records,
    contact_events: Records,
    *,
    memory: np.void | None = None,
) -> tuple[int, np.void]:
    """Integrate one system; return the number of samples done and the summary.

    ``memory`` is a SCRATCH that holds the last state afterwards.
    """
    summary = np.zeros(1, kept.SUMMARY)[0]
    work = np.zeros(1, SCRATCH)[0] if memory is None else memory
    with compiling_alone(integrate):
        done = integrate(
            record, shaking, initial, history, contact_events, summary, work
        )
    return int(done), summary
