"""One body, one motion, with friction, flight and vertical motion."""

import math
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.engines.kernels.single import GRAZING_SPEED
from rockfrag.engines.planar.ensemble import started
from rockfrag.engines.planar.integrate import (
    CHANGE,
    FALLEN,
    IMPACT,
    PARADOX,
    PASSING,
    Book,
    Shaking,
    contact_event_columns,
    history_columns,
    integrate,
)
from rockfrag.engines.planar.records import posed, system_record, working_memory
from rockfrag.engines.response import FLIGHT, Response, mode_name, rocking_mode_name, sampled_demand
from rockfrag.engines.steps import STEP, free_samples, step_count
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]
Modes = tuple[tuple[int, int], ...]
"""Contact state and sign of slip of each interface."""

CLOSING = 1e-6
"""Parting speed over √(g b) below which a contact stays closed after an impact, where the history is kept."""

_KINDS = {IMPACT: "impact", PARADOX: "paradox", FALLEN: "fall", PASSING: "edge"}
_STATES = (FLIGHT, -1, +1, 0)
"""Contact state of an interface whose closed ends are the bits (left, right) of a number."""


def contact_history(
    system: System,
    motion: GroundMotion,
    g: float = GRAVITY,
    step: float = STEP,
    closing: float = CLOSING,
) -> tuple[Response, bool]:
    """Integrate one planar system that may slide, rock and fly.

    Parameters
    ----------
    system, motion
        What is shaken, and by what.
    g
        Acceleration of gravity [m/s²].
    step
        Largest product of the frequency parameter and the step [-].
    closing
        Parting speed over √(g b) below which a contact that would fall shut again stays closed after an
        impact [-].

    Returns
    -------
    The response, and whether a contact reached its friction, opened as a whole or had no consistent mode.
    """
    values, interval = motion.x.acceleration, motion.dt
    up = np.zeros(0) if motion.z is None else motion.z.acceleration
    p = system_record(system, g)
    blocks = int(p["count"])
    start = posed(p, *started(system))
    substeps = int(step_count(system, interval, g, step))
    free = int(free_samples(system, interval, g))
    shaking = Shaking(values, up, interval, 1.0, substeps, free)
    history = np.zeros((values.size + free, history_columns(blocks)))
    work = working_memory()
    capacity = 4096
    while True:
        contact_events = np.zeros((capacity, contact_event_columns(blocks)))
        done, count, fall = integrate(
            p, shaking, start, closing, Book(history, contact_events), work
        )
        if count <= capacity:
            break
        capacity = count
    history, contact_events = history[:done], contact_events[:count]
    time = np.arange(done, dtype=np.float64) * interval
    centres, speeds = history[:, : 6 * blocks].reshape(done, 2, blocks, 3).transpose(1, 0, 2, 3)
    slips, normal, shear, alpha = (
        history[:, 6 * blocks : 10 * blocks].reshape(done, 4, blocks).transpose(1, 0, 2)
    )
    modes = [_modes(number, blocks) for number in history[:, -1]]
    fallen = int(work["fallen"])
    table = _contact_event_table(contact_events, blocks)
    ground = np.zeros(done)
    ground[: min(done, values.size)] = values[:done]
    loose = work["slid"].max() > 0 or np.any(work["flights"]) or work["paradoxes"] > 0
    response = Response(
        system=system,
        time=time,
        ground_acceleration=ground,
        position=centres[:, :, :2],
        theta=centres[:, :, 2],
        omega=speeds[:, :, 2],
        alpha=alpha,
        state=np.array([[state for state, _ in mode] for mode in modes]),
        slides=np.array([[slides for _, slides in mode] for mode in modes]),
        slip=slips,
        contact_events=table,
        overturned=fallen > 0,
        overturned_body=("", *system.names)[fallen],
        overturning_time=float(fall),
        energy=_energy_table(p, time, history, contact_events),
        normal_force=normal,
        friction_force=shear,
        impacts=int(work["impacts"]),
        grazings=_grazings(table),
        given_way=int(work["given_way"]),
        friction_demand=sampled_demand(normal, shear),
        least_normal_force=np.asarray(normal.min(axis=0)),
        lost_contact=math.nan,
        paradoxes=int(work["paradoxes"]),
        forced=int(work["forced"]),
        unstable_distance=float("nan"),
    )
    return response, bool(loose)


def _modes(number: float, blocks: int) -> Modes:
    """Contact states and signs of slip in the number that the kernels keep."""
    digits = [(int(number) >> (4 * k)) & 15 for k in range(blocks)]
    return tuple((_STATES[digit & 3], (digit >> 2) - 1) for digit in digits)


def _contact_event_table(contact_events: Array, blocks: int) -> pd.DataFrame:
    rows: list[dict[str, Any]] = []
    for contact_event in contact_events:
        before, after = _modes(contact_event[2], blocks), _modes(contact_event[3], blocks)
        slips, theta, old, new = contact_event[6:].reshape(4, blocks).tolist()
        rows.append(
            {
                "time": contact_event[0],
                "kind": _KINDS.get(int(contact_event[1])) or _kind_of_change(before, after),
                "from": _rocking_mode(before),
                "to": _rocking_mode(after),
                "omega_before": tuple(old),
                "omega_after": tuple(new),
                "theta": tuple(theta),
                "energy_before": contact_event[4],
                "energy_after": contact_event[5],
                "modes": tuple(mode_name(*mode) for mode in after),
                "slip": tuple(slips),
            }
        )
    columns = [
        "time", "kind", "from", "to", "omega_before", "omega_after", "theta",
        "energy_before", "energy_after", "modes", "slip",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _kind_of_change(before: Modes, after: Modes) -> str:
    """Name of a contact event without an impact: what opens first, then what slides."""
    pairs = list(zip(before, after, strict=True))
    assert CHANGE not in _KINDS
    if any(new[0] == FLIGHT and old[0] != FLIGHT for old, new in pairs):
        return "flight"
    if any(new[0] != 0 and old[0] == 0 for old, new in pairs):
        return "opening"
    if any(new[0] != old[0] for old, new in pairs):
        return "closing"
    return "slip" if any(new[1] not in (0, old[1]) for old, new in pairs) else "stick"


def _rocking_mode(modes: Modes) -> str:
    states = [state for state, _ in modes]
    return rocking_mode_name(states)


def _grazings(contact_events: pd.DataFrame) -> int:
    """Impacts that met with less than the speed of grazing."""
    speeds = [np.abs(np.diff([0.0, *omega])).max() for omega in contact_events["omega_before"]]
    return int(((contact_events["kind"] == "impact") & (np.array(speeds) < GRAZING_SPEED)).sum())


def _energy_table(p: np.void, time: Array, history: Array, contact_events: Array) -> pd.DataFrame:
    """Ledger of energy by cause over time [J]."""
    blocks = int(p["count"])
    coordinates = slice(0, 3 * blocks)
    inertia = 1.0 / p["inverse"][coordinates]
    kinetic = (inertia * history[:, 3 * blocks : 6 * blocks] ** 2).sum(axis=1) / 2
    potential = float(p["g"]) * (p["mass"][:blocks] * history[:, 1 : 3 * blocks : 3]).sum(axis=1)
    struck = np.isin(contact_events[:, 1], (IMPACT, PARADOX))
    loss = np.where(struck, contact_events[:, 4] - contact_events[:, 5], 0.0)
    meets = np.array(
        [_meeting(contact_event, blocks) for contact_event in contact_events], dtype=np.int64
    )
    at = np.searchsorted(time, contact_events[:, 0] - 1e-12 * max(1.0, time[-1]))
    so_far = np.zeros((blocks, time.size + 1))
    np.add.at(so_far, (meets, at), loss)
    lost = np.cumsum(so_far, axis=1)[:, : time.size]
    work, rubbed = history[:, -4], history[:, -3]
    total = kinetic + potential + lost.sum(axis=0)
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            **{f"lost_contact_{k + 1}": values for k, values in enumerate(lost)},
            "lost_friction": rubbed,
            "residual": total + rubbed - work - total[0],
        }
    )


def _meeting(contact_event: Array, blocks: int) -> int:
    """Contact that an impact closes: the lowest whose mode changes as it comes down, or the uppermost."""
    before, after = (_modes(number, blocks) for number in contact_event[2:4])
    for k in range(blocks - 1):
        if before[k][0] not in (0, after[k][0]):
            return k
    return blocks - 1
