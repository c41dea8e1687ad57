"""The tables of a response, contact events and the balance of energy, whichever engine answers."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.engines.response import mode_name, rocking_mode_name

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def contact_event_table(
    time: Floats,
    kind: Sequence[str],
    states: tuple[Ints, Ints],
    omega: tuple[Floats, Floats],
    theta: Floats,
    kinetic: tuple[Floats, Floats],
) -> pd.DataFrame:
    """Make the columns of ``Response.contact_events`` that a response without friction has.

    ``states`` and ``omega`` [rad/s] are those before and after, each of shape (n, contacts), ``kinetic`` energies
    before and after [J], each of shape (n,).
    """
    return pd.DataFrame(
        {
            "time": time,
            "kind": list(kind),
            "from": _rocking_modes(states[0]),
            "to": _rocking_modes(states[1]),
            "omega_before": _tuples(omega[0]),
            "omega_after": _tuples(omega[1]),
            "theta": _tuples(theta),
            "energy_before": kinetic[0],
            "energy_after": kinetic[1],
        }
    )


def _tuples(rows: Floats) -> list[tuple[float, ...]]:
    return list(zip(*rows.T.tolist(), strict=True))


def _rocking_modes(states: Ints) -> list[str]:
    """Names of rows of contact states, each of the few that there are named once."""
    code = (states + 1) @ 4 ** np.arange(states.shape[1])
    _, first, which = np.unique(code, return_index=True, return_inverse=True)
    names = [rocking_mode_name(states[at].tolist()) for at in first]
    return [names[at] for at in which.tolist()]


def with_slips(table: pd.DataFrame, states: Ints, slides: Ints, slip: Floats) -> pd.DataFrame:
    """Return a table of contact events with what each interface does from then on, and its slip [m]."""
    pairs = np.stack([states, slides], axis=-1).tolist()
    modes = [tuple(mode_name(*pair) for pair in each) for each in pairs]
    return table.assign(
        modes=pd.Series(modes, dtype=object), slip=pd.Series(_tuples(slip), dtype=object)
    )


def energy_table(
    time: Floats,
    kinetic: Floats,
    potential: Floats,
    work: Floats,
    losses: tuple[Floats, Ints, Floats],
    friction: Floats | None = None,
    *,
    contacts: int,
) -> pd.DataFrame:
    """Make the balance of energy by cause over time [J], with the columns of ``Response.energy``.

    ``losses`` are of each impact its time [s], its contact from 0 and what it lost [J]; ``friction`` is what
    friction has taken so far [J], shape (n,), None where nothing slides.
    """
    when, contact, lost = losses
    at = np.searchsorted(time, when - 1e-12 * max(1.0, time[-1]))
    by_sample = np.zeros((contacts, time.size + 1))
    np.add.at(by_sample, (contact, at), lost)
    so_far = np.cumsum(by_sample, axis=1)[:, : time.size]
    total = kinetic + potential
    for each in so_far:
        total = total + each
    residual = total - work - total[0] if friction is None else total + friction - work - total[0]
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            **{f"lost_contact_{k + 1}": values for k, values in enumerate(so_far)},
            **({} if friction is None else {"lost_friction": friction}),
            "residual": residual,
        }
    )
