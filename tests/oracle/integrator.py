"""What the reference integrators share: slow, tight and plain, to judge the fast ones by.

Dormand and Prince's 8(5,3) pair (Hairer, Nørsett & Wanner 1993, as scipy's DOP853) from sample to sample of the
motion, where the acceleration is linear, with every contact event located on its dense output.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

Array = NDArray[np.float64]
Key = tuple  # what is watched, and where: ("gap", 0)

RTOL, ATOL = 1e-10, 1e-14

# slack before a contact event is seen, so that what has just begun is not taken for its end [-]
SLACK = 1e-12

MOST_CONTACT_EVENTS = 200_000

# where to look for contact events inside a step, as fractions of it: after a contact event, while something but
# gaps is watched, otherwise
_FRESH = np.concatenate([np.logspace(-10, -1, 19), np.linspace(0.15, 1.0, 18)])
_NODES = np.linspace(0.0, 1.0, 7)[1:]
_ENDS = np.array([1.0])


class ContactEvent(NamedTuple):
    """One change of the contact state, with the angular velocities before it [rad/s]."""

    time: float
    kind: str
    omega_before: tuple[float, ...]


class Response(NamedTuple):
    """Response at the samples, up to the last one before a fall."""

    time: Array  # [s], shape (n,)
    theta: Array  # rotations [rad], shape (n, bodies)
    # displacements along each interface [m] where bodies slide, shape (n, bodies)
    slip: Array
    contact_events: list[ContactEvent]
    overturned: bool


class Integrator:
    """One response as it unfolds; time inside a sample interval is counted from its start.

    ``motions`` are the horizontal and vertical acceleration of the ground [m/s²], shape (2, n), zero from the last
    sample on; ``longest`` is the longest step and ``tail`` the longest free motion after the last sample [s].
    A model adds ``y``, coordinates and velocities; ``take(y)``, which goes on from there; ``row()``, rotations
    [rad] and slips [m]; ``resting()``, whether all stands in full contact; ``rates(t, y)`` of change of y;
    ``watched(t, y)``, what must stay positive until the next contact event; ``approaches(y)``, rates at which open
    contacts part; and ``apply(t, keys)``, which changes the contact state where these have vanished, or where the
    motion begins or ends.
    """

    def __init__(self, motions: Array, dt: float, longest: float, tail: float) -> None:
        self.motions, self.dt, self.longest, self.tail = motions, dt, longest, tail
        self.contact_events: list[ContactEvent] = []
        self.fallen = False
        self.start = 0.0
        self.load = np.zeros((2, 2)).tolist()

    def response(self, duration: float | None) -> Response:
        """Run to the end, at the latest ``duration`` [s], and collect the samples."""
        last = self.motions.shape[1] - 1
        end = last * self.dt + self.tail if duration is None else duration
        steps = math.ceil(end / self.dt * (1 - 1e-12))
        rows = []
        for k in range(steps + 1):
            self.start = k * self.dt
            self.load = (
                self.motions[:, k : k + 2].T if k < last else np.zeros((2, 2))
            ).tolist()
            if k in (0, last):
                self.apply(0.0, set())
            rows.append(self.row())
            if k == steps or (duration is None and k >= last and self.resting()):
                break
            self._interval()
            if self.fallen:
                break
        return Response(
            time=np.arange(len(rows)) * self.dt,
            theta=np.array([row[0] for row in rows]),
            slip=np.array([row[1] for row in rows]),
            contact_events=self.contact_events,
            overturned=self.fallen,
        )

    def ground(self, t: float) -> list[float]:
        """Horizontal and vertical acceleration of the ground [m/s²]."""
        x = t / self.dt
        return [
            early + x * (late - early) for early, late in zip(*self.load, strict=True)
        ]

    def note(self, t: float, kind: str, omega_before: tuple[float, ...]) -> None:
        """Keep a contact event."""
        self.contact_events.append(ContactEvent(self.start + t, kind, omega_before))

    def _interval(self) -> None:
        """Go from one sample to the next through all the contact events between them."""
        t, in_place = 0.0, 0
        while t < self.dt and not self.fallen:
            before = t
            t = self._stand(t) if self.resting() else self._move(t)
            in_place = in_place + 1 if t == before else 0
            if in_place > 100 or len(self.contact_events) > MOST_CONTACT_EVENTS:
                raise ArithmeticError(
                    f"contact events without end at {self.start + t} s"
                )

    def _stand(self, t: float) -> float:
        """Everything is at rest: what is watched is linear in time, so the opening is exact."""
        early, late = (self.watched(time, self.y) for time in (t, self.dt))
        crossings = {
            key: t + (self.dt - t) * max(early[key], 0.0) / (early[key] - late[key])
            for key in early
            if late[key] < 0 and late[key] < early[key]
        }
        if not crossings:
            return self.dt
        return self._happen(crossings)

    def _happen(self, crossings: dict[Key, float]) -> float:
        """Let the earliest happen, and all that vanish with it; its time."""
        when = min(crossings.values())
        self.apply(
            when, {key for key, time in crossings.items() if time <= when + 1e-13}
        )
        return when

    def _move(self, t: float) -> float:
        """Integrate up to the next contact event or the end of the interval, whichever comes first."""
        solver = DOP853(
            self.rates, t, self.y, self.dt, rtol=RTOL, atol=ATOL, max_step=self.longest,
            first_step=min(self.dt - t, self.longest),
        )  # fmt: skip
        while solver.status == "running":
            t0, y0 = solver.t, solver.y.copy()
            solver.step()
            if solver.status == "failed":
                raise ArithmeticError(
                    f"the integration failed at {self.start + solver.t} s"
                )
            dense = cache(solver.dense_output)

            def at(t: float, y0: Array = y0, ends: tuple = (t0, solver.t)) -> Array:
                return y0 if t == ends[0] else solver.y if t == ends[1] else dense()(t)  # noqa: B023

            crossings = self._crossings(at, t0, solver.t)
            if crossings:
                self.take(at(min(crossings.values())))
                return self._happen(crossings)
        self.take(solver.y)
        return self.dt

    def _crossings(
        self, at: Callable[[float], Array], t0: float, t1: float
    ) -> dict[Key, float]:
        """Zeros of what is watched, in the part of a step where there are the first ones."""
        time, values = t0, self.watched(t0, at(t0))
        for x in _places(values):
            node = t1 if x == 1 else t0 + (t1 - t0) * float(x)
            for stop in (*sorted(self._nearest(at, time, node)), node):
                now = self.watched(stop, at(stop))
                failing = [key for key, value in now.items() if value < 0]
                if failing:
                    return {
                        key: self._root(at, key, time, stop, values[key])
                        for key in failing
                    }
                time, values = stop, now
        return {}

    def _nearest(
        self, at: Callable[[float], Array], t0: float, t1: float
    ) -> Iterator[float]:
        """Times at which a contact comes near and leaves again."""
        rates = zip(self.approaches(at(t0)), self.approaches(at(t1)), strict=True)
        for i, (early, late) in enumerate(rates):
            if early < 0 < late:
                yield brentq(
                    lambda t, i=i: self.approaches(at(t))[i], t0, t1, xtol=1e-15
                )

    def _root(self, at, key, t0, t1, first):
        if first <= 0:
            return t0
        return float(brentq(lambda t: self.watched(t, at(t))[key], t0, t1, xtol=1e-16))


def _places(values: dict[Key, float]) -> Array:
    """Where to look inside a step that starts from these values."""
    if min(values.values()) <= 2 * SLACK:
        return _FRESH
    return _ENDS if {key[0] for key in values} <= {"gap", "upright"} else _NODES
