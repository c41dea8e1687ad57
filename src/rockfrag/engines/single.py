"""Engine of single histories in pure rocking: one or two bodies, every impact, everything about the response."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.arrays import Floats
from rockfrag.engines.contract import Case, Cases, Wish
from rockfrag.engines.pure_rocking import PureRocking
from rockfrag.engines.response import Response, contact_event_table, energy_table
from rockfrag.engines.steps import MOST_SAMPLES, free_samples, step_count
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.system.system import System

Records = NDArray[np.void]


class Single(PureRocking):
    """One or two planar bodies that rock and never slide, case by case (``kernels.single``)."""

    name = "single histories"
    meets = frozenset(
        {
            *(Wish.TWO_BODIES, Wish.VERTICAL, Wish.RESTITUTION, Wish.START, Wish.LINEAR),
            *(Wish.FORCES, Wish.HISTORY),
        }
    )

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases, whose histories are not kept."""
        from rockfrag.engines.kernels.record import CONTACT_EVENT, SAMPLE, SUMMARY
        from rockfrag.engines.lanes import write_rocking
        from rockfrag.engines.records import body_record

        g, linear = cases.request.g, cases.request.linear
        records = [body_record(system, linear, g) for system in cases.systems]
        starts = [initial_state(system) for system in cases.systems]
        summaries = np.zeros(cases.shape, SUMMARY)
        nothing = np.empty(0, SAMPLE), np.empty(0, CONTACT_EVENT)

        def work(place: tuple[int, int, int]) -> None:
            i, j, k = place
            case = Case(
                cases.systems[i], cases.motions[j], float(cases.scales[j, k]), cases.request
            )
            summaries[place] = run_integration(
                records[i], shaking_of(case, case.request.g), starts[i], *nothing
            )[1]

        with ThreadPoolExecutor(cases.threads) as pool:
            list(pool.map(work, np.ndindex(*cases.shape)))
        outcomes = empty_outcomes(cases.names, cases.scales, (self.name,))
        for count in sorted(set(outcomes.counts)):
            rows = [i for i, system in enumerate(cases.systems) if system.count == count]
            write_rocking(outcomes, rows, summaries[rows], "ratio")
            _write_summaries(outcomes, rows, summaries[rows], cases.request.forces)
        return outcomes

    def history(self, case: Case) -> Response:
        """Return the response of a case."""
        found = _integrated(case, 4096)
        needed = int(found[-1]["contact_events"])
        if needed > 4096:
            found = _integrated(case, needed)
        return _response(case.system, *found)


def samples_of(case: Case) -> tuple[Floats, Floats, Floats, NDArray[Any]]:
    """Return times [s], (n,), and rotations, velocities and contact states of a case as of :class:`Response`."""
    _, _, rows, _, _ = _integrated(case, 0)
    time, count = np.arange(len(rows), dtype=np.float64) * case.motion.dt, case.system.count
    return time, _of(rows, "theta", count), _of(rows, "omega", count), _of(rows, "c", count)


def _of(rows: Records, name: str, count: int) -> NDArray[Any]:
    """Return a number of each body, from below, in columns."""
    return np.column_stack([rows[name + block] for block in BLOCKS[-count:]])


def _integrated(case: Case, capacity: int) -> tuple[np.void, Any, Records, Records, np.void]:
    """Integrate a case: its record, its shaking, its samples, as many contact events as fit, and the summary."""
    from rockfrag.engines.kernels.record import CONTACT_EVENT, SAMPLE
    from rockfrag.engines.records import body_record

    record = body_record(case.system, case.request.linear, case.request.g)
    shaking = shaking_of(case, case.request.g)
    most = case.motion.x.acceleration.size + shaking.free_samples
    if most > MOST_SAMPLES:
        raise InputError(
            f"motion: {most} samples, with the free rocking after it, are more than the {MOST_SAMPLES} allowed."
        )
    history, contact_events = np.zeros(most, SAMPLE), np.zeros(capacity, CONTACT_EVENT)
    initial = initial_state(case.system)
    done, summary = run_integration(record, shaking, initial, history, contact_events)
    return record, shaking, history[:done], contact_events, summary


def _write_summaries(into: Outcomes, rows: list[int], summaries: Records, forces: bool) -> None:
    """Write what single histories tell beside what lanes do."""
    count = into.counts[rows[0]]
    into.overturning_time[rows] = summaries["fall_time"]
    into.peak_velocity[rows, ..., count - 1] = summaries["speed2"]
    if not forces:
        return
    into.lost_contact[rows] = summaries["lost_contact"]
    # a lone body is the kernels' block 2
    for k, number in enumerate(BLOCKS[-count:]):
        into.friction_demand[rows, ..., k] = summaries["demand"]["friction" + number]
        into.least_normal_force[rows, ..., k] = summaries["demand"]["normal" + number]


BLOCKS = ("1", "2")  # what the kernels call the two bodies


def initial_state(system: System) -> np.void:
    """Return the STATE that the integration begins with."""
    from rockfrag.engines.kernels.equations import STATE

    initial: np.void = np.zeros(1, STATE)[0]
    if system.start is not None:
        for name, values in (("theta", system.start.rotation), ("omega", system.start.velocity)):
            initial[name + "1"], initial[name + "2"] = (0.0, *values)[-2:]
    return initial


def shaking_of(case: Case, unit: float) -> Any:
    """Return what a system is shaken with (``kernels.single.Shaking``), in steps that follow from the system.

    The vertical acceleration is over ``unit`` [m/s²].
    """
    from rockfrag.engines.kernels.single import Shaking

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
    record: np.void, shaking: Any, initial: np.void, history: Records, contact_events: Records
) -> tuple[int, np.void]:
    """Integrate one system; return the number of samples done and the summary."""
    from rockfrag.engines.kernels.jit import compiling_alone
    from rockfrag.engines.kernels.record import SUMMARY
    from rockfrag.engines.kernels.single import integrate, scratch

    summary: np.void = np.zeros(1, SUMMARY)[0]
    with compiling_alone(integrate):
        done = integrate(record, shaking, initial, history, contact_events, summary, scratch())
    return int(done), summary


def _response(
    system: System, record: np.void, shaking: Any, history: Records, found: Records, summary: Any
) -> Response:
    """Put the response of a system together, of whose contact events so many were found."""
    from rockfrag.engines.forces import Turned

    n, contact_events = len(history), found[: int(summary["contact_events"])]
    count, demand = system.count, summary["demand"]
    theta, omega, alpha, state = (
        _of(history, name, count) for name in ("theta", "omega", "alpha", "c")
    )
    samples, dt = shaking.samples * shaking.scale, shaking.dt
    ground, gravity = np.zeros(n), np.full(n, float(record["gravity"]))
    ground[: min(n, samples.size)] = samples[:n]
    up = shaking.scale * shaking.vertical[:n]
    gravity[: up.size] += gravity[: up.size] * up
    turned = Turned(system, state, theta)
    normal, friction = turned.forces(ground, gravity, omega, alpha)
    time = np.arange(n, dtype=np.float64) * dt
    fallen = int(summary["fallen"])
    which = fallen - (2 - system.count) if fallen else 0
    return Response(
        system=system,
        time=time,
        ground_acceleration=ground,
        position=turned.centres(),
        theta=theta,
        omega=omega,
        alpha=alpha,
        state=state,
        slides=np.zeros_like(state),
        slip=np.zeros_like(theta),
        contact_events=_contact_events(contact_events, count),
        overturned=fallen > 0,
        overturned_body=("", *system.names)[which],
        overturning_time=float(summary["fall_time"]),
        energy=_energies(record, time, history, contact_events, system.count),
        normal_force=normal,
        friction_force=friction,
        impacts=int(summary["impacts"]),
        grazings=int(summary["grazings"]),
        paradoxes=0,
        forced=0,
        given_way=int(summary["given_way"]),
        friction_demand=np.array([demand["friction" + block] for block in BLOCKS[-count:]]),
        least_normal_force=np.array([demand["normal" + block] for block in BLOCKS[-count:]]),
        lost_contact=float(summary["lost_contact"]),
        unstable_distance=float(summary["unstable_distance"]),
    )


def _contact_events(contact_events: Records, count: int) -> pd.DataFrame:
    """Make the table of contact events of a response."""
    from rockfrag.engines.kernels.record import CHATTER, CLOSING, LIFTING, OPENING

    before, after = contact_events["before"], contact_events["after"]
    kinds = {OPENING: "opening", CLOSING: "impact", CHATTER: "chatter", LIFTING: "lift-off"}

    return contact_event_table(
        contact_events["time"],
        [kinds[kind] for kind in contact_events["kind"].tolist()],
        (_of(before, "c", count), _of(after, "c", count)),
        (_of(before, "omega", count), _of(after, "omega", count)),
        _of(after, "theta", count),
        (contact_events["energy_before"], contact_events["energy_after"]),
    )


def _energies(
    record: np.void, time: Floats, history: Records, contact_events: Records, contacts: int
) -> pd.DataFrame:
    """Balance of energy by cause over time [J]."""
    from rockfrag.engines.kernels.equations import STATE
    from rockfrag.engines.kernels.jit import compiling_alone
    from rockfrag.engines.kernels.record import OPENING, fill_energies

    kinetic, potential = np.empty(len(history)), np.empty(len(history))
    with compiling_alone(fill_energies):
        fill_energies(record, history, kinetic, potential, np.zeros(1, STATE)[0])
    # an impact closes the ground if the lower body's contact changed, the interface otherwise
    before = contact_events["before"]["c1"]
    by_ground = (before != 0) & (before != contact_events["after"]["c1"])
    lost = contact_events["energy_before"] - contact_events["energy_after"]
    loss = np.where(contact_events["kind"] == OPENING, 0.0, lost)
    # of a lone body, the kernels' second, the interface is the ground
    closed = np.where(by_ground, 0, contacts - 1)
    losses = contact_events["time"], closed, loss
    return energy_table(time, kinetic, potential, history["work"], losses, contacts=contacts)


ENGINE = Single()
