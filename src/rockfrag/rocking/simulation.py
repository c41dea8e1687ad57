"""One body, one motion, everything about the response."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking import _tally as tally
from rockfrag.rocking._compile import compiling_alone
from rockfrag.rocking._march import march
from rockfrag.rocking.bodies import Block, Body
from rockfrag.rocking.forces import contact_forces
from rockfrag.rocking.inputs import (
    CLOSING_SPEED,
    STEP,
    checked_acceleration,
    free_samples,
    step_count,
    warn_if_weak,
)
from rockfrag.rocking.parameters import Restitution, body_parameters
from rockfrag.rocking.response import PATTERNS, Response
from rockfrag.units import STANDARD_GRAVITY


def _initial(body: Body, value: float | Sequence[float] | None, name: str) -> list[float]:
    blocks = 1 if isinstance(body, Block) else 2
    if value is None:
        return [0.0, 0.0]
    values = [float(v) for v in np.atleast_1d(np.asarray(value, dtype=float))]
    if len(values) != blocks or not all(math.isfinite(v) for v in values):
        raise InputError(f"{name}: expected {blocks} finite number(s), got {value!r}.")
    if name == "theta0" and any(abs(v) >= math.pi / 2 for v in values):
        raise InputError("theta0: a block turned by π/2 or more lies on its side already.")
    return [0.0, *values] if blocks == 1 else values


def simulate(
    body: Body,
    acceleration: ArrayLike,
    dt: float,
    *,
    theta0: float | Sequence[float] | None = None,
    omega0: float | Sequence[float] | None = None,
    restitution: Restitution = None,
    linear: bool = False,
    g: float = STANDARD_GRAVITY,
) -> Response:
    """Simulate the rocking of a block, or of a statue on its pedestal, under a horizontal motion.

    Parameters
    ----------
    body
        A :class:`Block` or a :class:`Stack`.
    acceleration
        Acceleration of the ground or floor [m/s²], shape (n,), linear between samples, n ≥ 2.
    dt
        Sampling interval [s].
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start: a number, or (pedestal, statue).
    restitution
        Measured ratio of angular velocities of an impact: a number, or (ground, interface); None, the
        default, conserves momentum (thesis eq. 2.14, 2.76-2.86).
    linear
        Use the linearised equations of motion (thesis eq. 2.9; 2.60-2.65).
    g
        Acceleration of gravity [m/s²].

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    values = checked_acceleration(acceleration, dt)
    warn_if_weak(values)
    p = body_parameters(body, restitution, linear, g)
    first, second = _initial(body, theta0, "theta0"), _initial(body, omega0, "omega0")
    initial = np.array([first[0], second[0], first[1], second[1]])
    free = int(free_samples(body, dt, g))
    history = np.zeros((values.size + free, tally.HISTORY))
    summary = np.zeros(tally.SUMMARY)
    capacity = 4096
    while True:
        events = np.zeros((capacity, tally.EVENT))
        with compiling_alone(march):
            done = march(
                p, values, float(dt), 1.0, int(step_count(body, dt, g, STEP)), free, initial,
                CLOSING_SPEED, history, events, tally.scratch(), summary,
            )  # fmt: skip
        count = int(summary[tally.N_EVENTS])
        if count <= capacity:
            break
        capacity = count
    return _response(body, p, values, dt, history[:done], events[:count], summary, g)


def _response(
    body: Body,
    p: np.void,
    values: NDArray[np.float64],
    dt: float,
    history: NDArray[np.float64],
    events: NDArray[np.float64],
    summary: NDArray[np.float64],
    g: float,
) -> Response:
    n = len(history)
    blocks = [1] if isinstance(body, Block) else [0, 1]
    theta = history[:, [0, 2]][:, blocks]
    omega = history[:, [1, 3]][:, blocks]
    alpha = history[:, [6, 7]][:, blocks]
    state = history[:, [4, 5]][:, blocks].astype(np.int64)
    ground = np.zeros(n)
    ground[: min(n, values.size)] = values[:n]
    normal, friction = contact_forces(body, ground, state, theta, omega, alpha, g)
    time = np.arange(n, dtype=np.float64) * float(dt)
    table = _event_table(events, blocks)
    fallen = int(summary[tally.FALLEN])
    return Response(
        body=body,
        time=time,
        ground_acceleration=ground,
        theta=theta,
        omega=omega,
        alpha=alpha,
        state=state,
        events=table,
        overturned=fallen > 0,
        overturned_body=("", "pedestal", "block" if isinstance(body, Block) else "statue")[fallen],
        overturning_time=float(summary[tally.FALL_TIME]),
        energy=_energy_table(p, time, history, events),
        normal_force=normal,
        friction_force=friction,
        impacts=int(summary[tally.IMPACTS]),
        grazings=int(summary[tally.GRAZINGS]),
        closest_approach=float(summary[tally.CLOSEST]),
    )


def _event_table(events: NDArray[np.float64], blocks: list[int]) -> pd.DataFrame:
    kinds = {tally.OPENING: "opening", tally.CLOSING: "impact", tally.CHATTER: "chatter"}
    rows: list[dict[str, Any]] = [
        {
            "time": row[0],
            "kind": kinds[row[1]],
            "from": PATTERNS[int(row[2]), int(row[3])],
            "to": PATTERNS[int(row[4]), int(row[5])],
            "omega_before": tuple(row[[6, 7]][blocks].tolist()),
            "omega_after": tuple(row[[8, 9]][blocks].tolist()),
            "theta": tuple(row[[10, 11]][blocks].tolist()),
            "energy_before": row[12],
            "energy_after": row[13],
        }
        for row in events
    ]
    columns = [
        "time", "kind", "from", "to", "omega_before", "omega_after", "theta",
        "energy_before", "energy_after",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _energy_table(
    p: np.void,
    time: NDArray[np.float64],
    history: NDArray[np.float64],
    events: NDArray[np.float64],
) -> pd.DataFrame:
    """Ledger of energy by cause over time [J]."""
    kinetic = np.empty(len(history))
    potential = np.empty(len(history))
    tally.fill_energies(p, history, kinetic, potential)
    # an impact closes the ground if the pedestal's contact changed, the interface otherwise
    by_ground = (events[:, 2] != 0) & (events[:, 2] != events[:, 4])
    loss = np.where(events[:, 1] == tally.OPENING, 0.0, events[:, 12] - events[:, 13])
    at = np.searchsorted(time, events[:, 0] - 1e-12 * max(1.0, time[-1]))

    def so_far(values: NDArray[np.float64]) -> NDArray[np.float64]:
        total = np.zeros(len(time) + 1)
        np.add.at(total, at, values)
        return np.cumsum(total)[: len(time)]

    lost_ground, lost_interface = so_far(loss * by_ground), so_far(loss * ~by_ground)
    work = history[:, 8]
    start = kinetic[0] + potential[0]
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            "lost_ground": lost_ground,
            "lost_interface": lost_interface,
            "residual": kinetic + potential + lost_ground + lost_interface - work - start,
        }
    )
