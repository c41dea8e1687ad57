"""The reference integrator of bodies that rock, on the mechanics of `rocking_model`.

Nothing is shared with the fast kernel but the bodies.
"""

import math

import numpy as np

from rockfrag.units import GRAVITY

from .integrator import SLACK, Array, Integrator, Key
from .rocking_model import NEGLIGIBLE_SPEED, LinearModel, Model, Pair, State

# A contact that would part at less than this speed after an impact is closed, if it would fall shut
# again anyway; a fraction of the frequency parameter p [-].
CHATTER = 1e-6

# a contact counts as closed this far below zero [rad], which is above the noise of the dense output
TOUCH = 1e-15

# longest free rocking after the motion's end, over 1/p, if no duration is given [-]
LONGEST_TAIL = 1000.0


def simulate_reference(
    body,
    acceleration,
    dt,
    *,
    restitution=None,
    linear=False,
    vertical=None,
    duration=None,
    chatter=CHATTER,
):
    """Rock a block or a stack on a shaken ground, slowly and accurately.

    Accelerations [m/s²] are linear between samples and zero after the last.  ``restitution`` is a number of a
    block, a pair (ground, interface) of a stack, either of which may be None, or a :class:`MeasuredRestitution`;
    ``duration`` is as of :func:`contact_reference.simulate_reference`, and ``chatter`` the parting speed after an
    impact, over p, below which a contact is closed [-].
    """
    motion = np.asarray(acceleration, dtype=float)
    up = np.zeros(motion.size) if vertical is None else vertical
    model = (LinearModel if linear else Model)(body, GRAVITY, restitution)
    return _Run(model, np.array([motion, up]), dt, chatter * model.frequency).response(duration)


def _gaps(values: Pair) -> Pair:
    """Rotation (or velocity) of each block relative to what it stands on."""
    return values[0], values[1] - values[0]


def _pairs(y: Array) -> tuple[Pair, Pair]:
    """Rotations and angular velocities."""
    th1, th2, w1, w2 = y.tolist()
    return (th1, th2), (w1, w2)


class _Run(Integrator):
    """One response; a lone block is the upper of two."""

    def __init__(self, model: Model, motions: Array, dt: float, chatter: float) -> None:
        super().__init__(motions, dt, 0.05 / model.frequency, LONGEST_TAIL / model.frequency)
        self.model, self.chatter = model, chatter
        self.theta, self.omega = (0.0, 0.0), (0.0, 0.0)
        self.state: State = (0, 0)
        self.columns = slice(1, 2) if model.alone else slice(0, 2)

    @property
    def y(self) -> Array:
        return np.array([*self.theta, *self.omega])

    def take(self, y: Array) -> None:
        self.theta, self.omega = _pairs(y)
        if self.state[1] == 0:  # what is stuck turns as what it stands on, to the last bit
            self.theta, self.omega = (self.theta[0],) * 2, (self.omega[0],) * 2

    def row(self) -> tuple[list[float], list[float]]:
        theta = list(self.theta[self.columns])
        return theta, [0.0] * len(theta)

    def resting(self) -> bool:
        return self.state == (0, 0)

    def rates(self, t: float, y: Array) -> Array:
        theta, omega = _pairs(y)
        return np.array(
            [*omega, *self.model.accelerations(self.state, theta, omega, self._pull(t))]
        )

    def watched(self, t: float, y: Array) -> dict[Key, float]:
        theta, omega = _pairs(y)
        gaps = _gaps(theta)
        values: dict[Key, float] = {
            ("gap", i): c * gaps[i] + TOUCH for i, c in enumerate(self.state) if c != 0
        }
        values |= {("upright", i): math.pi / 2 - abs(theta[i]) for i in (0, 1)}
        if 0 in self.state:
            moments = self.model.margins(self.state, theta, omega, self._pull(t))
            values |= {("press", c * s): margin + SLACK for (c, s), margin in moments.items()}
        return values

    def approaches(self, y: Array) -> list[float]:
        rates = _gaps(_pairs(y)[1])
        return [c * rate for c, rate in zip(self.state, rates, strict=True) if c]

    def apply(self, t: float, keys: set[Key]) -> None:
        if any(kind == "upright" for kind, _ in keys):
            self.fallen = True
            self._note(t, "overturning", self.omega)
            return
        shut = {i for kind, i in keys if kind == "gap"}
        if shut:
            self._close(t, shut)
        self._settle(t)

    def _pull(self, t: float) -> Pair:
        """Acceleration of the ground, and gravity with its upward one [m/s²]."""
        along, up = self.ground(t)
        return along, self.model.g + up

    def _close(self, time: float, shut: set[int]) -> None:
        """Let the contacts ``shut`` close, and any other that closes at the same instant."""
        gaps, rates = _gaps(self.theta), _gaps(self.omega)
        shut |= {
            i for i, c in enumerate(self.state) if c and c * gaps[i] < 1e-13 and c * rates[i] < 0
        }
        theta1 = 0.0 if 0 in shut else self.theta[0]
        self.theta = (theta1, theta1 if 1 in shut or self.state[1] == 0 else self.theta[1])
        old, before = self.state, self.omega
        closing = (old[0] if 0 in shut else 0, old[1] if 1 in shut else 0)
        quiet = {i for i in shut if old[i] * rates[i] > -NEGLIGIBLE_SPEED * self.model.frequency}
        if quiet == shut:
            new, after = self._shut(old, quiet, old, before)
        else:
            new, after, _ = self.model.impact(old, closing, self.theta, before)
            # with one contact shut another may turn out to be as weak
            while weak := self._too_weak(time, new, after, old, closing):
                new, after = self._shut(new, weak, old, before)
                quiet |= weak
        self.state, self.omega = new, after
        self._note(time, "closing" if quiet else "impact", before)

    def _shut(self, new: State, weak: set[int], old: State, before: Pair) -> tuple[State, Pair]:
        """Close weak contacts for good; the velocities of the others follow from momentum."""
        new = (0 if 0 in weak else new[0], 0 if 1 in weak else new[1])
        pivots = (float(new[0] or 1), float(new[1] or 1))
        return new, self.model.projected(pivots, new, old, self.theta, before)

    def _too_weak(self, time, new, after, old, closing):
        """List contacts that part so slowly after an impact that they would only chatter."""
        parting = _gaps(after)
        pull = _gaps(self.model.accelerations(new, self.theta, after, self._pull(time)))
        return {
            i
            for i in (0, 1)
            if new[i] != 0
            and (closing[i] != 0 or old[i] == 0)
            and abs(parting[i]) < self.chatter
            and new[i] * pull[i] < 0
        }

    def _settle(self, time: float) -> None:
        """Open what cannot stay closed."""
        old = self.state
        self.state = self.model.settled(old, self.theta, self.omega, self._pull(time))
        if self.state != old:
            self._note(time, "opening", self.omega)

    def _note(self, time: float, kind: str, before: Pair) -> None:
        self.note(time, kind, before[self.columns])
