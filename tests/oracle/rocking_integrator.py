"""The reference integrator of bodies that rock, on the mechanics of `rocking_model`.

Nothing is shared with the fast kernel but the bodies.
"""

import math

import numpy as np

from rockfrag.base.units import GRAVITY

from .integrator import SLACK, Array, Integrator, Key
from .rocking_model import NEGLIGIBLE_SPEED, LinearModel, Model, State, pivots, rates

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
    """Rock bodies on each other on a shaken ground, slowly and accurately.

    Accelerations [m/s²] are linear between samples and zero after the last.  ``restitution`` is a number of a
    block, one for each contact from below, any of which may be None, or a :class:`MeasuredRestitution`;
    ``duration`` is as of :func:`contact_reference.simulate_reference`, and ``chatter`` the parting speed after an
    impact, over p, below which a contact is closed [-].
    """
    motion = np.asarray(acceleration, dtype=float)
    up = np.zeros(motion.size) if vertical is None else vertical
    model = (LinearModel if linear else Model)(body, GRAVITY, restitution)
    return Run(model, np.array([motion, up]), dt, chatter * model.frequency).response(
        duration
    )


class Run(Integrator):
    """One response; the rotations of the bodies come before their velocities in y."""

    def __init__(self, model: Model, motions: Array, dt: float, chatter: float) -> None:
        super().__init__(
            motions, dt, 0.05 / model.frequency, LONGEST_TAIL / model.frequency
        )
        self.model, self.chatter = model, chatter
        self.theta, self.omega = np.zeros((2, model.count))
        self.state: State = (0,) * model.count

    @property
    def y(self) -> Array:
        return np.concatenate([self.theta, self.omega])

    def take(self, y: Array) -> None:
        self.theta, self.omega = (
            self._joined(self.state, part) for part in y.reshape(2, -1)
        )

    def _joined(self, state: State, values: Array) -> Array:
        """What is stuck turns as what it stands on, to the last bit."""
        found = [0.0]
        for c, value in zip(state, values, strict=True):
            found.append(value if c else found[-1])
        return np.array(found[1:])

    def row(self) -> tuple[list[float], list[float]]:
        return self.theta.tolist(), [0.0] * self.model.count

    def resting(self) -> bool:
        return not any(self.state)

    def rates(self, t: float, y: Array) -> Array:
        theta, omega = y.reshape(2, -1)
        turning = self.model.accelerations(self.state, theta, omega, self._pull(t))
        return np.concatenate([omega, turning])

    def watched(self, t: float, y: Array) -> dict[Key, float]:
        theta, omega = y.reshape(2, -1)
        gaps = self.state * rates(theta)
        values: dict[Key, float] = {
            ("gap", i): float(gaps[i]) + TOUCH
            for i, c in enumerate(self.state)
            if c != 0
        }
        values |= {
            ("upright", i): math.pi / 2 - abs(x) for i, x in enumerate(theta.tolist())
        }
        if 0 in self.state:
            moments = self.model.margins(self.state, theta, omega, self._pull(t))
            values |= {
                ("press", *key): margin + SLACK for key, margin in moments.items()
            }
        return values

    def approaches(self, y: Array) -> list[float]:
        opening = rates(y[self.model.count :]).tolist()
        return [c * rate for c, rate in zip(self.state, opening, strict=True) if c]

    def apply(self, t: float, keys: set[Key]) -> None:
        if any(key[0] == "upright" for key in keys):
            self.fallen = True
            self.note(t, "overturning", tuple(self.omega))
            return
        shut = {key[1] for key in keys if key[0] == "gap"}
        if shut:
            self._close(t, shut)
        self._settle(t)

    def _pull(self, t: float) -> tuple[float, float]:
        """Acceleration of the ground, and gravity with its upward one [m/s²]."""
        along, up = self.ground(t)
        return along, self.model.g + up

    def _close(self, time: float, shut: set[int]) -> None:
        """Let the contacts ``shut`` close, and any other that closes at the same instant."""
        old, before = self.state, self.omega
        gaps, parting = (old * rates(values) for values in (self.theta, before))
        shut |= {
            i for i, c in enumerate(old) if c and gaps[i] < 1e-13 and parting[i] < 0
        }
        closing = tuple(c if i in shut else 0 for i, c in enumerate(old))
        met = tuple(0 if i in shut else c for i, c in enumerate(old))
        self.theta = self._joined(met, self.theta)
        quiet = {
            i for i in shut if parting[i] > -NEGLIGIBLE_SPEED * self.model.frequency
        }
        if quiet == shut:
            new, after = self._shut(old, quiet, old, before)
        else:
            new, after, _ = self.model.impact(old, closing, self.theta, before)
            # with one contact shut another may turn out to be as weak
            while weak := self._too_weak(time, new, after, old, closing):
                new, after = self._shut(new, weak, old, before)
                quiet |= weak
        self.state, self.omega = new, after
        self.note(time, "closing" if quiet else "impact", tuple(before))

    def _shut(
        self, new: State, weak: set[int], old: State, before: Array
    ) -> tuple[State, Array]:
        """Close weak contacts for good; the velocities of the others follow from momentum."""
        new = tuple(0 if i in weak else c for i, c in enumerate(new))
        return new, self.model.projected(pivots(new), new, old, self.theta, before)

    def _too_weak(self, time, new, after, old, closing):
        """List contacts that part so slowly after an impact that they would only chatter."""
        pull = rates(self.model.accelerations(new, self.theta, after, self._pull(time)))
        return {
            i
            for i, parting in enumerate(rates(after))
            if new[i] != 0
            and (closing[i] != 0 or old[i] == 0)
            and abs(parting) < self.chatter
            and new[i] * pull[i] < 0
        }

    def _settle(self, time: float) -> None:
        """Open what cannot stay closed."""
        old = self.state
        self.state = self.model.settled(old, self.theta, self.omega, self._pull(time))
        if self.state != old:
            self.note(time, "opening", tuple(self.omega))
