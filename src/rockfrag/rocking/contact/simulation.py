"""One body, one motion, with friction, flight and vertical motion."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Block, Body
from rockfrag.rocking.contact._body import contact_body, posed, working_memory
from rockfrag.rocking.contact._march import EVENT, HISTORY, march
from rockfrag.rocking.contact.friction import FrictionInput, interface_frictions
from rockfrag.rocking.contact.response import ContactResponse, mode_names
from rockfrag.rocking.inputs import (
    STEP,
    checked_motion,
    free_samples,
    step_count,
    warn_if_weak,
)
from rockfrag.rocking.kernels.jit import compiling_alone
from rockfrag.units import STANDARD_GRAVITY

Array = NDArray[np.float64]

CLOSING = 1e-6
"""Parting speed over √(g b) below which a contact stays closed after an impact, where the history is kept."""

_KINDS = ("change", "impact", "paradox", "fall")


def simulate_with_friction(
    body: Body,
    acceleration: ArrayLike,
    dt: float,
    *,
    friction: FrictionInput,
    vertical: ArrayLike | None = None,
    theta0: float | Sequence[float] | None = None,
    omega0: float | Sequence[float] | None = None,
    g: float = STANDARD_GRAVITY,
    step: float = STEP,
    closing: float = CLOSING,
) -> ContactResponse:
    """Simulate a block, or a statue on its pedestal, that may slide, rock and fly.

    Parameters
    ----------
    body
        A :class:`Block` or a :class:`Stack`.
    acceleration
        Horizontal acceleration of the ground or floor [m/s²], shape (n,), linear between samples and zero one
        sample after the last, n ≥ 2.
    dt
        Sampling interval [s].
    friction
        Coefficient of friction, or a pair (static, kinetic), of a lone block; (ground, interface) of a stack.
    vertical
        Vertical acceleration, upwards [m/s²], shape (n,).
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start, about the corners that these leave: a
        number, or (pedestal, statue).
    g
        Acceleration of gravity [m/s²].
    step
        Largest product of the frequency parameter and the step [-].
    closing
        Parting speed over √(g b) below which a contact that would fall shut again stays closed after an
        impact [-].

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    values, _ = checked_motion(acceleration, dt, "acceleration")
    up = np.zeros(0) if vertical is None else checked_motion(vertical, dt, "vertical")[0]
    if up.size not in (0, values.size):
        raise InputError(f"vertical: {up.size} samples for {values.size} horizontal ones.")
    warn_if_weak(values)
    frictions = interface_frictions(body, friction)
    p = contact_body(body, frictions, g)
    blocks = int(p["count"])
    start = posed(p, _start(theta0, blocks, "theta0"), _start(omega0, blocks, "omega0"))
    free = int(free_samples(body, dt, g))
    history = np.zeros((values.size + free, HISTORY))
    work = working_memory()
    capacity = 4096
    while True:
        events = np.zeros((capacity, EVENT))
        with compiling_alone(march):
            done, count, fall = march(
                p, values, up, float(dt), 1.0, int(step_count(body, dt, g, step)), free, start, closing,
                history, events, work,
            )  # fmt: skip
        if count <= capacity:
            break
        capacity = count
    history = history[:done]
    time = np.arange(done, dtype=np.float64) * float(dt)
    centres = history[:, :6].reshape(done, 2, 3)[:, :blocks]
    speeds = history[:, 6:12].reshape(done, 2, 3)[:, :blocks]
    fallen = int(work["fallen"])
    names = ("", "block") if isinstance(body, Block) else ("", "pedestal", "statue")
    return ContactResponse(
        body=body,
        time=time,
        position=centres[:, :, :2],
        theta=centres[:, :, 2],
        omega=speeds[:, :, 2],
        slip=history[:, 12 : 12 + blocks],
        mode=np.array([mode_names(int(x), blocks) for x in history[:, 21]]),
        events=_event_table(events[:count], blocks),
        overturned=fallen > 0,
        overturned_body=names[fallen],
        overturning_time=float(fall),
        energy=_energy_table(p, time, history, centres, speeds),
        normal_force=history[:, 14 : 14 + blocks],
        friction_force=history[:, 16 : 16 + blocks],
        impacts=int(work["impacts"]),
        paradoxes=int(work["paradoxes"]),
        forced=int(work["forced"]),
    )


def _start(value: float | Sequence[float] | None, blocks: int, name: str) -> Array:
    """Rotations or angular velocities at the start, shape (2,)."""
    start = np.zeros(2)
    if value is not None:
        values = np.atleast_1d(np.asarray(value, dtype=float))
        if values.shape != (blocks,) or not np.isfinite(values).all():
            raise InputError(f"{name}: expected {blocks} finite number(s), got {value!r}.")
        if name == "theta0" and (np.abs(values) >= np.pi / 2).any():
            raise InputError("theta0: a block turned by π/2 or more lies on its side already.")
        start[:blocks] = values
    return start


def _event_table(events: Array, blocks: int) -> pd.DataFrame:
    rows: list[dict[str, Any]] = [
        {
            "time": row[0],
            "kind": _KINDS[int(row[1])],
            "from": mode_names(int(row[2]), blocks),
            "to": mode_names(int(row[3]), blocks),
            "slip": tuple(row[4 : 4 + blocks].tolist()),
            "loss": row[6],
        }
        for row in events
    ]
    return pd.DataFrame(rows, columns=["time", "kind", "from", "to", "slip", "loss"])


def _energy_table(
    p: np.void, time: Array, history: Array, centres: Array, speeds: Array
) -> pd.DataFrame:
    blocks = centres.shape[1]
    mass, inertia = p["mass"][:blocks], p["inertia"][:blocks]
    kinetic = (mass * (speeds[:, :, 0] ** 2 + speeds[:, :, 1] ** 2) / 2).sum(axis=1)
    kinetic += (inertia * speeds[:, :, 2] ** 2 / 2).sum(axis=1)
    potential = float(p["g"]) * (mass * centres[:, :, 1]).sum(axis=1)
    work, rubbed, struck = history[:, 18], history[:, 19], history[:, 20]
    start = kinetic[0] + struck[0] + potential[0]
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            "lost_friction": rubbed,
            "lost_impacts": struck,
            "residual": kinetic + potential + rubbed + struck - work - start,
        }
    )
