"""Engine of single histories in pure rocking: one or two bodies, every impact, everything about the response.

In: a :class:`rockfrag.engines.contract.Case`. Out: its :class:`rockfrag.outcomes.response.Response`. Theory:
``docs/rocking.md``; the kernels: ``docs/kernels.md``.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, NamedTuple

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


class Link(NamedTuple):
    """A vector that is fixed in a body, as it lies relative to the ground at n samples, shape (n,) each."""

    x: Floats  # [m], to the right
    y: Floats  # [m], upwards
    # acceleration of its tip relative to its foot [m/s²], to the right and upwards
    ax: Floats
    ay: Floats


class UpperLinks(NamedTuple):
    """Links to the upper one of two bodies."""

    foot: Link  # from the pivot on the ground to the pivot of the upper body
    centre: Link  # from there to its centre of gravity
    # top of the pedestal, from its left to its right end, x and y [m], shape (n,) each
    top: tuple[Floats, Floats]


@dataclass(frozen=True)
class _Turning:
    """How one body turns over a history of n samples."""

    # of its rotation [-], shape (n,) each
    sine: Floats
    cosine: Floats
    omega: Floats  # angular velocity [rad/s], shape (n,)
    alpha: Floats  # angular acceleration [rad/s²], shape (n,)

    def turned(self, arm: Floats) -> tuple[Floats, Floats]:
        """Arm in the body [m], shape (2,) or (n, 2), as it lies relative to the ground: x and y [m], (n,) each."""
        x, y = np.transpose(arm)
        return x * self.cosine + y * self.sine, -x * self.sine + y * self.cosine

    def link(self, arm: Floats) -> Link:
        """Arm in the body [m], shape (2,) or (n, 2), with the acceleration of its tip, α × r - ω² r."""
        x, y = self.turned(arm)
        inwards = self.omega * self.omega
        ax, ay = self.alpha * y - inwards * x, -self.alpha * x - inwards * y
        return Link(x, y, ax, ay)


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
    """Return the outcomes of cases that are integrated one by one, on several threads.

    Parameters
    ----------
    cases : systems × motions × scales
    name : of the engine, for ``Outcomes.engine``
    summary_of : gives the SUMMARY of a case, the record BODY of its system and the STATE that it begins with

    Returns
    -------
    The outcomes, shape (systems, motions, scales).
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
        """Return the field ``name`` of each body, from below, of the samples or of other rows, (rows, blocks)."""
        rows = self.history if rows is None else rows
        return np.column_stack([rows[name + block] for block in BLOCKS[-self.count :]])

    def response(self) -> Response:
        """Return the response that the kernel wrote."""
        summary = self.summary
        demand = self.summary["demand"]
        blocks = BLOCKS[-self.count :]
        theta, state, n = self.of("theta"), self.of("c"), len(self.history)
        fallen = int(summary["fallen"])
        ground, upward = self.ground(n)
        turns = self._turns(theta)
        # number of each sample's pivots among PIVOTS, shape (n, blocks)
        number = (state < 0).astype(np.int64)
        lower = self._lower_link(turns[0], number[:, 0])
        above = self._upper_links(turns, number) if self.count == 2 else None
        normal, friction = self._forces(ground, upward, lower, above)
        return Response(
            system=self.system,
            time=self.time,
            ground_acceleration=ground,
            position=self._positions(lower, above, number[:, 0]),
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
        """Acceleration of the ground at the first samples [m/s²], and upwards over gravity [-], (count,) each."""
        found = np.zeros((2, count))
        for row, samples in zip(
            found, (self.shaking.samples, self.shaking.vertical), strict=True
        ):
            row[: samples.size] = self.shaking.scale * samples[:count]
        return found[0], found[1]

    def _lower_link(self, turning: _Turning, number: NDArray[np.int64]) -> Link:
        """Link from the pivot on the ground to the lower body's centre of gravity; ``number`` of PIVOTS, (n,)."""
        arms = np.array([geometry.arm(self.system.shapes[0], each) for each in PIVOTS])
        return turning.link(arms[number])

    def _positions(
        self, lower: Link, above: UpperLinks | None, number: NDArray[np.int64]
    ) -> Floats:
        """Centres of gravity relative to the middle of the ground's face [m], shape (n, blocks, 2).

        ``lower``, ``above`` and ``number``, shape (n,), say where they lie from the pivot on the ground, and which
        of ``PIVOTS`` that is.
        """
        centres = [(lower.x, lower.y)]
        if above is not None:
            foot, centre = above.foot, above.centre
            centres.append((foot.x + centre.x, foot.y + centre.y))
        position = np.stack([np.column_stack(each) for each in centres], axis=1)
        shape = self.system.shapes[0]
        arm_x = np.array([geometry.arm(shape, pivot)[0] for pivot in PIVOTS])
        position[..., 0] += shape.x - arm_x[number][:, np.newaxis]
        return position

    def _turns(self, theta: Floats) -> list[_Turning]:
        """Return how each block turns over the samples; ``theta``: rotations [rad], shape (n, blocks)."""
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
    ) -> UpperLinks:
        """Links to the upper body; ``number`` is which of ``PIVOTS`` both bodies rock on, shape (n, 2)."""
        pile = self.system.pile
        feet = np.array([[geometry.reach(pile, a, b) for b in PIVOTS] for a in PIVOTS])
        above = np.array([geometry.upper_arm(pile, pivot) for pivot in PIVOTS])
        return UpperLinks(
            foot=turns[0].link(feet[number[:, 0], number[:, 1]]),
            centre=turns[1].link(above[number[:, 1]]),
            top=turns[0].turned(np.subtract(pile.right, pile.left)),
        )

    def _forces(
        self, ground: Floats, upward: Floats, lower: Link, above: UpperLinks | None
    ) -> tuple[Floats, Floats]:
        """Normal and friction force of each interface, across and along the face that carries [N], (n, blocks).

        They follow from the absolute accelerations of the centres of gravity, as at the head of the class.
        ``ground`` is the acceleration of the ground [m/s²], ``upward`` its vertical one over gravity, both (n,).
        """
        still = float(self.record["gravity"])
        gravity = still + still * upward
        mass = self.system.shapes[0].mass
        normal, friction = mass * (gravity + lower.ay), mass * (ground + lower.ax)
        if above is None:
            return normal[:, np.newaxis], friction[:, np.newaxis]
        pile, foot, centre = self.system.pile, above.foot, above.centre
        level = pile.upper.mass * (ground + foot.ax + centre.ax)
        upright = pile.upper.mass * (gravity + foot.ay + centre.ay)
        # the interface's force is level and upright so far: the pedestal's top turns with it
        width, height = np.subtract(pile.right, pile.left)
        length = hypot(float(width), float(height))
        tx, ty = above.top[0] / length, above.top[1] / length
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
        """Return the table of energies [J] over time: kinetic, potential, work of the ground, losses."""
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
    """Return the STATE that the integration begins with: the system's start, or rest."""
    initial: np.void = np.zeros(1, STATE)[0]
    if system.start is not None:
        for name, values in (
            ("theta", system.start.rotation),
            ("omega", system.start.velocity),
        ):
            initial[name + "1"], initial[name + "2"] = (0.0, *values)[-2:]
    return initial


def shaking_of(case: Case, unit: float) -> Any:
    """Return the motion of a case as kernels take it, a ``kernels.single.Shaking``.

    Steps and the length of free rocking follow from the system; the vertical acceleration is over ``unit`` [m/s²].
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
    """Integrate one system by the kernel of single histories.

    Parameters
    ----------
    record : its BODY
    shaking : ``kernels.single.Shaking``
    initial : STATE to begin with
    history, contact_events : records SAMPLE and CONTACT_EVENT to fill, as far as they reach
    memory : SCRATCH to work in, which holds the last state afterwards; None for one of its own

    Returns
    -------
    Number of samples done, and the SUMMARY.
    """
    summary = np.zeros(1, kept.SUMMARY)[0]
    work = np.zeros(1, SCRATCH)[0] if memory is None else memory
    with compiling_alone(integrate):
        done = integrate(
            record, shaking, initial, history, contact_events, summary, work
        )
    return int(done), summary
