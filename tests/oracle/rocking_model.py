"""Mechanics of the reference integrator: motion, persistence and impact of any number of bodies.

Written to be read.  Everything follows from the positions of the centres of gravity (``docs/derivation.md``).
Points of the plane are complex numbers x + i y, so a clockwise turn by θ is a factor exp(-i θ).  With the points
of contact P_k, on what is below body k, the centre of body j lies at

    C_j = P_0 + Σ_{k<j} (P_{k+1} - P_k) exp(-i θ_k) + (C_j - P_j) exp(-i θ_j),

with P and C of the standing bodies in the brackets.  Its derivatives by the rotations give mass matrix and forces,
and impact maps are kinetic-metric products of such derivatives.  One and two blocks are the cases n = 1 and 2.

A *contact state* has a number for each contact from below: +1 or -1 where it rocks on its right or left pivot, 0
where it is full.  A *place* is a point of a base as a fraction of its half width, so the pivots are the places +1
and -1.
"""

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from rockfrag.simulation.options import MeasuredRestitution
from rockfrag.system import as_system

from .standing import standing

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
State = tuple[int, ...]

# a speed below this fraction of the largest one counts as none when an impact is judged [-]
NEGLIGIBLE_SPEED = 1e-13


def pivots(state: State) -> State:
    """Places about which a contact state turns; any pivot serves where a contact is full."""
    return tuple(c or 1 for c in state)


def rates(omega: Array) -> Array:
    """Rate of opening of each contact."""
    return omega - np.concatenate([[0.0], omega[:-1]])


@numba.njit(cache=True)
def _terms(arms, mass, inertia, theta, omega, pull):
    """Return M and f, compiled: every rate asks for them."""
    field = arms * (-1j * np.exp(-1j * theta))
    products, force = np.diag(inertia), np.zeros(mass.size)
    for j in range(mass.size):
        # of the centre where all θ'' are zero, with gravity as if the ground rose
        acceleration = pull - 1j * (field[j] * omega * omega).sum()
        momentum = mass[j] * np.conj(field[j])
        force += (momentum * acceleration).real
        for k in range(j + 1):
            products[:, k] += (momentum * field[j, k]).real
    return products, force


@numba.njit(cache=True)
def _accelerations(mass, force, free):
    """Return θ'' of M θ'' + f = τ where τ does no work on the motions ``free``."""
    return -free @ np.linalg.solve(free.T @ mass @ free, free.T @ force)


class Law(NamedTuple):
    """How one contact comes off impacts that end on one corner.

    ``number`` is a factor on what momentum leaves ("couple"), the place of the impulse on the base
    ("position"), or the ratio of the velocities after and before ("ratio").
    """

    name: str
    number: float


class Model:
    """Bodies on each other with their pivots and restitution; angles in [rad], SI units throughout.

    ``restitution`` is of a lone block, or one for each contact from below, None where momentum is conserved.
    """

    def __init__(self, body: object, g: float, restitution: object = None) -> None:
        bodies = standing(as_system(body))
        self.g, self.count = g, len(bodies)
        self.mass, self.inertia = (np.array([b[i] for b in bodies]) for i in (0, 1))
        # of what stands on each contact
        self.weight = g * np.cumsum(self.mass[::-1])[::-1]
        self.centre = np.array([complex(*b.centre) for b in bodies])
        left, right = (
            self.centre + [complex(*b.corners[side]) for b in bodies] for side in (0, 1)
        )
        self.middle, self.half = (left + right) / 2, (right - left) / 2
        reach = max(abs(self.centre[-1] - end) for end in (left[-1], right[-1]))
        self.frequency = np.sqrt(
            g * reach / (self.inertia[-1] / self.mass[-1] + reach**2)
        )
        # column k: the bodies that turn with contact k while all above it are full
        self._above = np.tril(np.ones((self.count, self.count)))
        # the motions that a contact state allows: one for each contact that rocks
        self._free = {
            state: np.ascontiguousarray(self._above[:, np.flatnonzero(state)])
            for state in itertools.product((1, -1, 0), repeat=self.count)
        }
        self._arms: dict[tuple[float, ...], Complex] = {}
        self._laws = self._laws_by_contact(restitution)

    # ---------------------------------------------------------------- motion

    def arms(self, places: tuple[float, ...]) -> Complex:
        """What each body's turn carries each centre by, as they stand: row j has the brackets of C_j [m]."""
        if places not in self._arms:
            point = self.middle + np.array(places) * self.half
            arms = np.tril(np.tile(np.diff(point, append=0.0), (self.count, 1)))
            np.fill_diagonal(arms, self.centre - point)
            self._arms[places] = arms
        return self._arms[places]

    def fields(self, places: tuple[float, ...], theta: Array) -> Complex:
        """Velocity of each centre for a unit of each angular velocity, in the turned position [m]."""
        return self.arms(places) * (-1j * np.exp(-1j * np.asarray(theta)))

    def terms(
        self, places: State, theta: Array, omega: Array, pull: tuple[float, float]
    ) -> tuple[Array, Array]:
        """Return M and f of M θ'' + f = τ.

        ``pull`` is the acceleration of the ground, and gravity with its upward one [m/s²].
        """
        return _terms(
            self.arms(places), self.mass, self.inertia, theta, omega, complex(*pull)
        )

    def accelerations(
        self, state: State, theta: Array, omega: Array, pull: tuple[float, float]
    ) -> Array:
        """Angular accelerations in this contact state [rad/s²]."""
        if not any(state):
            return np.zeros(self.count)
        mass, force = self.terms(pivots(state), theta, omega, pull)
        return _accelerations(mass, force, self._free[state])

    def kinetic_energy(self, state: State, theta: Array, omega: Array) -> float:
        """Kinetic energy relative to the ground [J]."""
        return (
            np.vdot(omega, self.products(pivots(state), pivots(state), theta) @ omega)
            / 2
        )

    # ----------------------------------------------------------- persistence

    def margins(
        self, state: State, theta: Array, omega: Array, pull: tuple[float, float]
    ) -> dict[tuple[int, int], float]:
        """How firmly each full contact presses about each corner, {(contact, pivot): margin} [-].

        The contact moment s τ(s), over weight times half width; below zero the contact would have
        to pull and opens about that pivot.
        """
        turning = self.accelerations(state, theta, omega, pull)
        found = {}
        for i in np.flatnonzero(np.array(state) == 0).tolist():
            for s in (1, -1):
                mass, force = self.terms(_at(pivots(state), i, s), theta, omega, pull)
                # the moments that bodies above give each other cancel
                moment = (mass @ turning + force)[i:].sum()
                found[i, s] = float(s * moment / (self.weight[i] * abs(self.half[i])))
        return found

    def options(
        self, state: State, closed: list[bool], closing: State
    ) -> Iterator[State]:
        """List the states that the contacts allow, open before stuck, the ground first.

        ``closed`` says which contacts are full or just closing, ``closing`` holds the old pivot of
        each contact that just closes (0 if it does not): it does not rebound on it.
        """
        full = [1, -1, 0]
        yield from itertools.product(
            *(
                [c] if not shut else [-old, 0] if old else full
                for c, shut, old in zip(state, closed, closing, strict=True)
            )
        )

    def settled(
        self, state: State, theta: Array, omega: Array, pull: tuple[float, float]
    ) -> State:
        """Open every full contact that cannot persist; several may open at once."""

        def weakest(candidate: State) -> float:
            return min(
                self.margins(candidate, theta, omega, pull).values(), default=0.0
            )

        if weakest(state) >= 0:
            return state
        closed = [c == 0 for c in state]
        for candidate in self.options(state, closed, (0,) * self.count):
            apart = rates(self.accelerations(candidate, theta, omega, pull))
            opens = _parting(candidate, closed, apart, 0.0)
            if candidate != state and opens and weakest(candidate) >= 0:
                return candidate
        if weakest(state) > -1e-9:
            return state
        raise ArithmeticError(
            f"no contact state is consistent at {state}, {theta}, {omega}, {pull}"
        )

    # ---------------------------------------------------------------- impact

    def products(
        self, test: tuple[float, ...], places: tuple[float, ...], theta: Array
    ) -> Array:
        """Kinetic-metric products of the fields about ``test`` with those about ``places``."""
        ours, others = self.fields(test, theta), self.fields(places, theta)
        return (ours.conj().T @ (self.mass[:, None] * others)).real + np.diag(
            self.inertia
        )

    def impulses(self, test, new, old, theta, after, before):
        """Generalised impulses about ``test``: momenta after less momenta before."""
        late, early = (
            self.products(test, pivots(state), theta) for state in (new, old)
        )
        return late @ after - early @ before

    def projected(self, test, new, old, theta, before, given=None):
        """Velocities after an impact without impulse about ``test``; full contacts share theirs.

        ``given`` are rates of opening of some contacts; their impulses do no work on a motion that does not
        change these.
        """
        given = given or {}
        free = self._above[:, [i for i, c in enumerate(new) if c and i not in given]]
        kept = self._above @ [given.get(i, 0.0) for i in range(self.count)]
        lacking = free.T @ self.impulses(test, new, old, theta, kept, before)
        inertia = free.T @ self.products(test, pivots(new), theta) @ free
        return kept - free @ np.linalg.solve(inertia, lacking)

    def impact(self, old: State, closing: State, theta: Array, before: Array):
        """Contact state and angular velocities after an impact (Spanos, Roussis and Politis, 2001).

        ``closing`` holds the old pivot of each contact that closes, 0 for the others.  Last comes
        whether a measured restitution gave way to the largest with which energy does not grow.
        """
        before = np.asarray(before)
        # what met stays together where no other outcome is possible
        met = tuple(0 if shut else c for c, shut in zip(old, closing, strict=True))
        together = met, self.projected(pivots(met), met, old, theta, before)
        plain = next(self.admissible_impacts(old, closing, theta, before), together)
        laws = {i: law for i in range(self.count) if (law := self._law(i, closing))}
        if not laws:
            return *plain, False
        moved = None
        moves = any(law.name == "position" for law in laws.values())
        if moves:
            moved = next(
                self.admissible_impacts(old, closing, theta, before, moved=True), None
            )
        by_law = {
            "ratio": rates(before), "couple": rates(plain[1]), "position": rates((moved or plain)[1])
        }  # fmt: skip
        by_momentum, wanted = {i: rates(plain[1])[i] for i in laws}, {}
        for i, law in laws.items():
            rate = by_law[law.name][i] * (1.0 if law.name == "position" else law.number)
            wanted[i] = rate if rate * closing[i] < 0 else 0.0  # never on its old pivot

        def shared(fraction: float) -> tuple[State, Array]:
            given = {i: p + fraction * (wanted[i] - p) for i, p in by_momentum.items()}
            return self._coming_off(old, closing, theta, before, given)

        energy = self.kinetic_energy(old, theta, before)

        def spare(fraction: float) -> float:
            new, after = shared(fraction)
            return energy - self.kinetic_energy(new, theta, after)

        # less than rounding is no gain
        if spare(1.0) >= -1e-12 * energy:
            return *shared(1.0), moves and moved is None
        if spare(0.0) <= 0:
            return *shared(0.0), True
        return *shared(float(brentq(spare, 0.0, 1.0, xtol=1e-15))), True

    def _coming_off(self, old, closing, theta, before, given):
        """State and velocities after an impact whose closing contacts come off at given rates.

        Momentum decides on the others whether they open: at one corner, at the other, or not at all.
        """
        parted = tuple(int(np.sign(given.get(i, c))) for i, c in enumerate(old))
        closed = [
            i not in given and (c == 0 or closing[i] != 0) for i, c in enumerate(old)
        ]
        speed = NEGLIGIBLE_SPEED * np.abs(before).sum()
        for new in self.options(parted, closed, closing):
            after = self.projected(pivots(new), new, old, theta, before, given)
            if _parting(new, closed, rates(after), speed):
                break
        return new, after

    def admissible_impacts(self, old, closing, theta, before, moved=False):
        """List every outcome of an impact that separates and presses as it must.

        Impulses act at the pivots, or, if ``moved``, where the law of position has them.
        """
        before = np.asarray(before)
        closed = [c == 0 or shut != 0 for c, shut in zip(old, closing, strict=True)]
        speed = NEGLIGIBLE_SPEED * np.abs(before).sum()
        for new in self.options(old, closed, closing):
            places = pivots(new)
            for i, law in enumerate(self._law(i, closing) for i in range(self.count)):
                if moved and new[i] and law and law.name == "position":
                    places = _at(places, i, law.number)
            after = self.projected(places, new, old, theta, before)
            if _parting(new, closed, rates(after), speed) and self._presses(
                new, old, places, theta, after, before
            ):
                yield new, after

    def _presses(self, new, old, places, theta, after, before):
        """Whether the impulses push at every contact that is full after the impact."""
        slack = -NEGLIGIBLE_SPEED * np.linalg.norm(before)
        inertia = self.inertia + self.mass * np.abs(self.half) ** 2
        return all(
            s
            * self.impulses(_at(places, i, s), new, old, theta, after, before)[i:].sum()
            >= slack * inertia[i]
            for i, c in enumerate(new)
            if not c
            for s in (1, -1)
        )

    # ------------------------------------------------------------------ laws

    def _law(self, contact: int, closing: State) -> Law | None:
        """Law of the corner that comes down, if the contact closes."""
        return self._laws[contact].get(-closing[contact])

    def _laws_by_contact(self, restitution: object) -> list[dict[int, Law]]:
        """Laws of each contact by the corner that comes down."""
        name = "position"
        if isinstance(restitution, MeasuredRestitution):
            name, restitution = restitution.law, restitution.value
        if self.count == 1:
            # every law is that of the lone block
            restitution, name = (restitution,), "ratio"
        laws: list[dict[int, Law]] = []
        for i, value in enumerate(restitution or (None,) * self.count):
            pair = value if isinstance(value, tuple | list) else (value, value)
            laws.append(
                {
                    s: self._law_of(i, s, float(e), name)
                    for s, e in zip((1, -1), pair, strict=True)
                }
                if value is not None
                else {}
            )
        return laws

    def _law_of(self, contact: int, corner: int, number: float, name: str) -> Law:
        """Law with which the lone body has ω⁺ = number · ω⁻ in impacts that end on this corner."""
        base = self.half[contact]
        # of the centre, from the middle along the base and across it
        centre = (self.centre[contact] - self.middle[contact]) * abs(base) / base
        inertia = self.inertia[contact] / self.mass[contact] + centre.imag**2
        old, new = (centre.real + side * corner * abs(base) for side in (1, -1))
        by_momentum = (inertia + old * new) / (inertia + new**2)
        if name == "ratio":
            return Law("ratio", number)
        if name == "couple" or number < by_momentum:
            return Law("couple", number / by_momentum)
        # angular momentum is kept about the point x of the base: inertia + (c - x) old before, new after
        lever = inertia * (1 - number) / (number * new - old)
        return Law("position", (centre.real - lever) / abs(base))


class LinearModel(Model):
    """The linearised equations: 2.9 for a lone block, 2.60 to 2.65 (mended) for a stack.

    Masses and impact maps are those of the standing bodies, sin θ = θ, cos θ = 1, and products of
    angles and velocities are dropped.
    """

    def fields(self, places: tuple[float, ...], theta: Array) -> Complex:
        """Velocities of the centres of the standing bodies [m]."""
        return super().fields(places, np.zeros(self.count))

    def terms(self, places, theta, omega, pull):
        """Return M and f of the linearised equations."""
        arms = self.arms(places)
        if self.count == 1:
            # 2.9 goes one step further: sin θc = θc and cos θc = 1
            radius, critical = abs(arms), np.angle(arms) - np.pi / 2
            arms = radius * (-critical + 1j)
        lifts = arms.real + arms.imag * np.asarray(theta)
        force = self.mass @ (arms.imag * pull[0] - lifts * pull[1])
        return self.products(places, places, theta), force


def _at(places: tuple[float, ...], contact: int, place: float) -> tuple[float, ...]:
    """Put the point of one contact elsewhere."""
    return (*places[:contact], place, *places[contact + 1 :])


def _parting(state: State, closed: list[bool], apart: Array, speed: float) -> bool:
    """Whether every contact that was closed and opens parts faster than ``speed``."""
    return all(
        c * rate > speed
        for c, shut, rate in zip(state, closed, apart, strict=True)
        if shut and c
    )
