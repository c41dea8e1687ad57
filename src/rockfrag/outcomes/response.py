"""What a simulation returns.

In: what an engine has integrated. Out: histories of rotations [rad], slips [m], forces [N], energies [J] and
contact events. Theory: ``docs/rocking.md``, ``docs/derivation.md``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.outcomes.outcomes import columns
from rockfrag.system.support import BilinearIsolator
from rockfrag.system.system import Start, System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Ints = NDArray[np.int64]

ROCKING_MODES = {
    (0, 0): "rest", (1, 1): "1a", (-1, -1): "1b", (1, -1): "2a", (-1, 1): "2b",
    (1, 0): "3a", (-1, 0): "3b", (0, 1): "4a", (0, -1): "4b",
}  # fmt: skip
"""Names of the contact states (ground, interface): the modes of Psycharis (1990) to both sides."""

AT_REST = 1e-3  # angular velocity below which what is left of a response rests [rad/s]
FLIGHT = 2  # contact state of an interface that is open at both ends

MODES = {0: "stands", +1: "rocks right", -1: "rocks left", FLIGHT: "flies"}
"""What an interface does in each contact state."""


LETTERS = {0: "0", +1: "R", -1: "L", FLIGHT: "F"}
"""Letter of each contact state, in the pattern of three and more bodies."""


def rocking_mode_name(states: Sequence[int]) -> str:
    """Name of a pattern, of the contact states from below.

    Of one and two bodies that of `ROCKING_MODES`, or "flight"; of more a letter per contact from below: 0 stands,
    R and L rocks on its right and left end, F flies.
    """
    if len(states) > 2:
        return "".join(LETTERS[int(state)] for state in states)
    ground, interface = (0, *states)[-2:]
    return (
        "flight"
        if FLIGHT in (ground, interface)
        else ROCKING_MODES[int(ground), int(interface)]
    )


def mode_name(state: int, slides: int) -> str:
    """Say what an interface does, such as "rocks right, slides left"."""
    way = "" if slides == 0 else ("slides right" if slides > 0 else "slides left")
    if state == 0 and way:
        return way
    return MODES[state] + (f", {way}" if way else "")


SPATIAL_COLUMNS = (
    *("x_m", "y_m", "z_m", "tilt_rad", "axis_x", "axis_y", "turn_rad", "base_x_m"),
    *("base_y_m", "omega_x_rad_s", "omega_y_rad_s", "omega_z_rad_s", "contacts"),
)
"""What a sample of a body in space tells, beside its time."""


@dataclass(frozen=True, kw_only=True)
class Response:
    """Response of one body to one motion.

    Columns are bodies, or the contacts under them, from below.

    Attributes
    ----------
    system : that was simulated
    time : of the samples [s], shape (n,); the motion and the free rocking after it
    ground_acceleration : at these times [m/s²], shape (n,)
    position : of the centres of gravity, x and y relative to the moving ground [m], shape (n, blocks, 2)
        The middle of the lowest base stood at 0.
    theta, omega, alpha : rotations [rad], angular velocities [rad/s] and accelerations [rad/s²], shape (n, blocks)
    state : contact states, shape (n, blocks)
        +1, -1 (rocking on the right, left pivot), 0 (full contact) or, with friction, 2 (flight).
    slides : whether the upper side of each interface sticks (0) or slides to the right (+1) or left (-1), likewise
    slip : displacement along each interface of the corner that carries [m], shape (n, blocks)
        From where it stood at first; positive to the right.
    contact_events : table, a row per opening, impact or closed chatter
        ``time`` [s], ``kind``, ``from``, ``to`` (patterns), ``omega_before``, ``omega_after`` [rad/s], ``theta``
        [rad] (tuples), ``energy_before``, ``energy_after`` (kinetic) [J].  With friction there are also the kinds
        ``slip`` and ``stick``, ``flight``, ``edge`` (a corner of the statue passes an edge of the pedestal),
        ``closing`` (a contact closes without an impact), ``paradox`` and ``fall``, and the columns ``modes`` (what
        each interface does from now on) and ``slip`` [m] (tuples).
    overturned, overturned_body : whether a block fell, and its name, or ``""``
    overturning_time : when it lay down [s], NaN if it did not
    leaning : whether a body that has not fallen rests beyond its balance at the end, against a wall or in a tie
    energy : table over time [J]
        ``kinetic``, ``potential``, ``input`` (work of the ground so far), ``lost_contact_1`` and on (in impacts of
        each contact so far, the ground's first), with friction ``lost_friction``, and ``residual``, which is zero
        but for rounding.  Where something holds the bodies also ``lost_walls`` (in impacts at walls) and ``held``
        (given to ties and isolators so far: what their springs store, and what they have lost).
    plate : displacement of the plate of an isolator [m], shape (n,); None without one
    constraints : table, a row per wall, tie, bond and isolator, as in :class:`rockfrag.outcomes.Outcomes`; None
        where nothing holds the bodies
    normal_force, friction_force : of each interface on the block above it [N], shape (n, blocks)
        Across and along the face that carries; after a fall those of the mode in which it fell.
    friction_demand : largest |T| / N that the response asked of each interface [-], shape (blocks,)
        By forces and by impulses, between samples too, until the last time that the block which falls was on this
        side of its balance; infinite where a normal force was not positive.  With friction, by the forces at the
        samples.
    least_normal_force : of each interface until then [N], shape (blocks,)
    lost_contact : when a normal force first was none [s], NaN if they pushed throughout
        The body would have jumped, and what follows is beyond pure rocking.  NaN with friction, where flight is
        among the modes.
    impacts, grazings : numbers of impacts, and of contacts that met with less than 1e-3 rad/s
    paradoxes, forced : with friction, numbers of times
        That no mode of contact was consistent, and that accumulating contact events were ended more coarsely than
        usual (``docs/contact.md``).
    given_way : number of impacts in which the law of a measured restitution had to give way, lest energy grow
    unstable_distance : least distance from an unstable equilibrium
        In units of the critical angle (and of p times it for the velocity).  An outcome with a small one hangs on
        little; a large one promises nothing, since impacts and chaos decide too
        (:func:`rockfrag.simulation.robustness.outcome_robustness`).  NaN once a block has slid or flown.
    """

    system: System
    time: Floats
    ground_acceleration: Floats
    position: Floats
    theta: Floats
    omega: Floats
    alpha: Floats
    state: Ints
    slides: Ints
    slip: Floats
    contact_events: pd.DataFrame
    overturned: bool
    overturned_body: str
    overturning_time: float
    leaning: bool = False
    energy: pd.DataFrame
    normal_force: Floats
    friction_force: Floats
    friction_demand: Floats
    least_normal_force: Floats
    lost_contact: float = math.nan
    impacts: int
    grazings: int
    paradoxes: int = 0
    forced: int = 0
    given_way: int
    unstable_distance: float = math.nan
    constraints: pd.DataFrame | None = field(default=None, repr=False)
    plate: Floats | None = field(default=None, repr=False)

    __repr__ = short_repr

    def plot(self, title: str = "") -> Figure:
        """Draw the ground's acceleration [g], rotations over the critical angle, any slip, and patterns."""
        # matplotlib is loaded only by those who draw
        from rockfrag.outcomes.response_figure import response_figure

        return response_figure(self, title)

    def system_after(self) -> System:
        """Return the system as this response left it: where its bodies stand or lean, without what has broken.

        A response to what follows is that to both motions with quiet time between them.

        Raises
        ------
        InputError
            If a body has fallen, or a body or the plate of an isolator still moves at the last sample; and if a
            bilinear isolator is not where it was set, since no start says how its spring has yielded.
        """
        system = self.system
        if self.overturned:
            raise InputError(
                f"system_after: the {self.overturned_body} has fallen; nothing is left to be shaken again."
            )
        plate = np.zeros(2) if self.plate is None else self.plate[-2:]
        if isinstance(system.support, BilinearIsolator) and plate.any():
            raise InputError(
                "system_after: the plate of a bilinear isolator swings on, and no start says how its spring has "
                "yielded; append the records, with quiet time between them."
            )
        if (
            np.abs(self.omega[-1]).max() > AT_REST
            or self.slides[-1].any()
            or np.ptp(plate) > 0
        ):
            raise InputError(
                "system_after: the bodies, or what they stand on, still move at the end; let quiet time follow "
                "the motion, or append the records."
            )
        broken = set()
        if self.constraints is not None:
            fallen = self.constraints["breaking_time_s"].notna()
            broken = set(self.constraints["name"][fallen])
        contacts = tuple(
            replace(contact, bond=None) if f"bond {k}" in broken else contact
            for k, contact in enumerate(system.contacts, 1)
        )
        kept = zip(system.constraints, system.holding, strict=False)
        left = replace(
            system,
            contacts=contacts,
            constraints=tuple(each for each, name in kept if name not in broken),
            start=None,
        )
        if not (self.slip[-1].any() or self.theta[-1].any() or plate[-1]):
            return left
        still = (0.0,) * system.count
        places = tuple((x, z) for x, z in self.position[-1].tolist())
        start = Start(tuple(self.theta[-1].tolist()), still, places, float(plate[-1]))
        return replace(left, start=start)

    def samples(self) -> dict[str, NDArray[Any]]:
        """Return the columns of a row per sample and body, the bodies running fastest (from below, from 1)."""
        count, bodies = self.theta.shape
        return {
            "time_s": np.repeat(self.time, bodies),
            "body": np.tile(np.arange(1, bodies + 1), count),
            "theta_rad": self.theta.ravel(),
            "omega_rad_s": self.omega.ravel(),
            "state": self.state.ravel(),
        }

    @property
    def rocking_mode(self) -> NDArray[np.str_]:
        """Pattern of rocking at each sample ("rest", "4a", …, "flight"), shape (n,)."""
        return np.array(_rocking_modes(self.state))

    @property
    def mode(self) -> NDArray[np.str_]:
        """What each interface does at each sample ("stands", "rocks right, slides left", …), shape (n, blocks)."""
        rows = np.stack([self.state, self.slides], axis=-1).tolist()
        return np.array([[mode_name(*pair) for pair in row] for row in rows])


def sampled_demand(normal: Floats, friction: Floats) -> Floats:
    """Largest |T| / N of each interface over the samples, infinite where N is not positive.

    Parameters
    ----------
    normal, friction : forces [N], shape (n, contacts)

    Returns
    -------
    The ratios [-], shape (contacts,).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.abs(friction) / normal
    return np.asarray(np.where(normal > 0, ratio, np.inf).max(axis=0))


def contact_event_table(
    time: Floats,
    kind: Sequence[str],
    states: tuple[Ints, Ints],
    omega: tuple[Floats, Floats],
    *,
    theta: Floats,
    kinetic: tuple[Floats, Floats],
) -> pd.DataFrame:
    """Columns of ``Response.contact_events`` of a response without friction.

    Parameters
    ----------
    time, kind : instants [s], shape (n,), and kinds
    states, omega : contact states, and angular velocities [rad/s], before and after, shape (n, contacts) each
    theta, kinetic : rotations [rad], shape (n, contacts), and energies before and after [J], shape (n,) each

    Returns
    -------
    pandas.DataFrame, n rows.
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
    """Names of rows of contact states."""
    return [rocking_mode_name(row) for row in states.tolist()]


def with_slips(
    table: pd.DataFrame, states: Ints, slides: Ints, slip: Floats
) -> pd.DataFrame:
    """Table of contact events with the mode of each interface from then on, and its slip.

    Parameters
    ----------
    table : n contact events
    states, slides, slip : contact states, directions of sliding and slips [m], shape (n, contacts)

    Returns
    -------
    pandas.DataFrame, n rows.
    """
    pairs = np.stack([states, slides], axis=-1).tolist()
    modes = [tuple(mode_name(*pair) for pair in each) for each in pairs]
    return table.assign(
        modes=pd.Series(modes, dtype=object),
        slip=pd.Series(_tuples(slip), dtype=object),
    )


def constraint_table(
    names: Sequence[str], values: Mapping[str, NDArray[Any]]
) -> pd.DataFrame:
    """What each wall, tie, bond and isolator had to bear, with the columns of ``Response.constraints``.

    Parameters
    ----------
    names : of what holds the bodies
    values : of each column of outcomes about constraints, by its name, shape (n,): n is that of ``names`` at least

    Returns
    -------
    pandas.DataFrame, a row a name.
    """
    count = len(names)
    table = {"constraint": np.arange(1, count + 1), "name": list(names)}
    for column in columns("constraints"):
        table[column.title] = np.array(values[column.name][:count])
    return pd.DataFrame(table)


def energy_table(
    time: Floats,
    kinetic: Floats,
    potential: Floats,
    work: Floats,
    *,
    contacts: int,
    losses: tuple[Floats, Ints, Floats],
    friction: Floats | None = None,
    held: Floats | None = None,
) -> pd.DataFrame:
    """Balance of energy by cause over time [J], with the columns of ``Response.energy``.

    Parameters
    ----------
    time, kinetic, potential, work : instants [s] and energies [J], shape (n,) each
    contacts : number of contacts
    losses : of each impact its instant [s], its contact from 0 and what it lost [J]
    friction : what friction has taken so far [J], shape (n,); None where nothing slides
    held : energy given to ties and isolators so far [J], shape (n,); None where nothing holds the bodies
        A contact beyond the last is then a wall.

    Returns
    -------
    pandas.DataFrame, n rows.
    """
    when, contact, lost = losses
    at = np.searchsorted(time, when - 1e-12 * max(1.0, time[-1]))
    by_sample = np.zeros((contacts + (held is not None), time.size + 1))
    np.add.at(by_sample, (contact, at), lost)
    so_far = np.cumsum(by_sample, axis=1)[:, : time.size]
    total = kinetic + potential
    for each in so_far:
        total = total + each
    if held is not None:
        total = total + held
    residual = (
        total - work - total[0]
        if friction is None
        else total + friction - work - total[0]
    )
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            **{f"lost_contact_{k + 1}": so_far[k] for k in range(contacts)},
            **({} if held is None else {"lost_walls": so_far[-1], "held": held}),
            **({} if friction is None else {"lost_friction": friction}),
            "residual": residual,
        }
    )
