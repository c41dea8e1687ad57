"""Mechanics of the reference integrator: motion, persistence and impact, written to be read.

Everything follows from the velocity fields of the blocks (``docs/derivation.md``).  With r1, d and
r2 the vectors pivot of block 1 → its centre, pivot of block 1 → pivot of block 2, pivot of block 2 → its
centre, the centres move with

    v1 = ω1 ⊥r1,   v2 = ω1 ⊥d + ω2 ⊥r2,   ⊥(x, y) = (y, -x)   (clockwise)

and mass matrix, forces and impact maps are kinetic-metric products of such fields.  A lone block is
the upper block of a stack whose lower block cannot move.

A *contact state* is a pair (c1, c2), ground and interface: +1 or -1 where the contact rocks on its
right or left pivot, 0 where it is full.  A *place* is a point of a base as a fraction of its half
width, so the pivots are the places +1 and -1.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from rockfrag.rocking.measured_restitution import MeasuredRestitution
from rockfrag.system import as_system
from rockfrag.system.blocks import Block, Stack, Vector

from .standing import StandingBody, standing, upper_on_contact

State = tuple[int, int]
Pair = tuple[float, float]

# a speed below this fraction of the largest one counts as none when an impact is judged [-]
NEGLIGIBLE_SPEED = 1e-13


def _sign(value: float) -> int:
    return int(value > 0) - int(value < 0)


def _rates(omega: Pair) -> Pair:
    """Rate of opening of ground and interface."""
    return omega[0], omega[1] - omega[0]


def _dot(u: Vector, v: Vector) -> float:
    return u.x * v.x + u.y * v.y


class Model:
    """Two blocks (or one) with their pivots and restitution; angles in [rad], SI units throughout."""

    def __init__(self, body: Block | Stack, g: float, restitution: object = None) -> None:
        self.g = g
        self.alone = isinstance(body, Block)
        bodies = standing(as_system(body))
        if self.alone:
            # a body below that weighs nothing and cannot move
            nowhere = np.zeros(2)
            below = StandingBody(0.0, 0.0, nowhere, np.zeros((2, 2)), np.zeros((2, 2)), 0.0, 0.0)
            bodies.insert(0, below)
        (self.m1, self.m2), (self.i1, self.i2) = (
            [getattr(item, name) for item in bodies] for name in ("mass", "inertia")
        )
        self.b1, self.b2 = (
            float(np.hypot(*(right - left))) / 2 or 1.0
            for left, right in (b.corners for b in bodies)
        )
        self._middles = [Vector(*item.corners.mean(axis=0).tolist()) for item in bodies]
        self._halves = [Vector(*(np.diff(item.corners, axis=0)[0] / 2).tolist()) for item in bodies]
        self._rise = Vector(*(bodies[1].centre - bodies[0].centre).tolist())
        upper = body if isinstance(body, Block) else upper_on_contact(body)
        self.frequency = max(upper.frequency(s, g) for s in (1, -1))
        self._laws = _laws_by_contact(body, restitution)
        pivots = itertools.product((1, -1), repeat=2)
        self._arms = {pair: sum(self.fields(pair, (0.0, 0.0)), ()) for pair in pivots}

    # ---------------------------------------------------------------- motion

    def fields(self, places: Pair, theta: Pair) -> tuple[Vector, Vector, Vector]:
        """Vectors r1, d and r2 in the turned position for pivots at these places [m]."""
        r1, r2 = (
            Vector(-middle.x - place * half.x, -middle.y - place * half.y)
            for middle, half, place in zip(self._middles, self._halves, places, strict=True)
        )
        d = Vector(self._rise.x + r1.x - r2.x, self._rise.y + r1.y - r2.y)
        return r1.turned(theta[0]), d.turned(theta[0]), r2.turned(theta[1])

    def terms(self, pivots, theta, omega, pull):
        """Return M11, M12, M22, f1, f2 of M θ'' + f = τ (Spanos, Roussis and Politis, 2001).

        ``pull`` is the acceleration of the ground, and gravity with its upward one [m/s²].  Plain floats: every
        rate asks for it.
        """
        x1, y1, xd, yd, x2, y2 = self._arms[pivots]
        c, s = math.cos(theta[0]), math.sin(theta[0])
        x1, y1, xd, yd = x1 * c + y1 * s, y1 * c - x1 * s, xd * c + yd * s, yd * c - xd * s
        c, s = math.cos(theta[1]), math.sin(theta[1])
        x2, y2 = x2 * c + y2 * s, y2 * c - x2 * s
        m1, m2 = self.m1, self.m2
        a, g = pull
        v1, v2 = omega[0] * omega[0], omega[1] * omega[1]
        # acceleration of the statue's centre where both θ'' are zero, with gravity as if the ground rose; the
        # pedestal's own centripetal acceleration has no moment about its pivot
        ax, ay = a - v1 * xd - v2 * x2, g - v1 * yd - v2 * y2
        return (
            self.i1 + m1 * (x1 * x1 + y1 * y1) + m2 * (xd * xd + yd * yd),
            m2 * (xd * x2 + yd * y2),
            self.i2 + m2 * (x2 * x2 + y2 * y2),
            m1 * (y1 * a - x1 * g) + m2 * (yd * ax - xd * ay),
            m2 * (y2 * ax - x2 * ay),
        )

    def accelerations(self, state: State, theta: Pair, omega: Pair, pull: Pair) -> Pair:
        """Angular accelerations in this contact state [rad/s²]."""
        c1, c2 = state
        if c1 == 0 and c2 == 0:
            return 0.0, 0.0
        m11, m12, m22, f1, f2 = self.terms((c1 or 1, c2 or 1), theta, omega, pull)
        if c1 == 0:
            return 0.0, -f2 / m22
        if c2 == 0:
            q = -(f1 + f2) / (m11 + 2 * m12 + m22)
            return q, q
        det = m11 * m22 - m12 * m12
        return (m12 * f2 - m22 * f1) / det, (m12 * f1 - m11 * f2) / det

    def kinetic_energy(self, state: State, theta: Pair, omega: Pair) -> float:
        """Kinetic energy relative to the ground [J]."""
        m11, m12, m22, _, _ = self.terms((state[0] or 1, state[1] or 1), theta, omega, (0.0, 0.0))
        return (m11 * omega[0] ** 2 + 2 * m12 * omega[0] * omega[1] + m22 * omega[1] ** 2) / 2

    # ----------------------------------------------------------- persistence

    def margins(self, state, theta, omega, pull):
        """How firmly each full contact presses about each corner, {(contact, pivot): margin} [-].

        The contact moment s τ(s), over weight times half width; below zero the contact would have
        to pull and opens about that pivot.
        """
        c1, c2 = state
        q1, q2 = self.accelerations(state, theta, omega, pull)
        found = {}
        if c2 == 0:
            for s in (1, -1):
                _, m12, m22, _, f2 = self.terms((c1 or 1, s), theta, omega, pull)
                found[2, s] = s * (m12 * q1 + m22 * q2 + f2) / (self.m2 * self.g * self.b2)
        if c1 == 0 and not self.alone:
            for s in (1, -1):
                m11, m12, m22, f1, f2 = self.terms((s, c2 or 1), theta, omega, pull)
                moment = m11 * q1 + m12 * q2 + f1
                if c2 == 0:
                    moment += m12 * q1 + m22 * q2 + f2
                found[1, s] = s * moment / ((self.m1 + self.m2) * self.g * self.b1)
        return found

    def options(self, state: State, closed: tuple[bool, bool], closing: State) -> Iterator[State]:
        """List the states that the contacts allow, open before stuck, the ground first.

        ``closed`` says which contacts are full or just closing, ``closing`` holds the old pivot of
        each contact that just closes (0 if it does not): it does not rebound on it.
        """
        choices = []
        for contact in (0, 1):
            if contact == 0 and self.alone:
                choices.append([0])
            elif not closed[contact]:
                choices.append([state[contact]])
            elif closing[contact]:
                choices.append([-closing[contact], 0])
            else:
                choices.append([1, -1, 0])
        for c1, c2 in itertools.product(*choices):  # noqa: UP028 - mypy needs the pair spelled out
            yield c1, c2

    def settled(self, state: State, theta: Pair, omega: Pair, pull: Pair) -> State:
        """Open every full contact that cannot persist; several may open at once."""
        if all(margin >= 0 for margin in self.margins(state, theta, omega, pull).values()):
            return state
        closed = (state[0] == 0, state[1] == 0)
        for candidate in self.options(state, closed, (0, 0)):
            if candidate == state:
                continue
            q1, q2 = self.accelerations(candidate, theta, omega, pull)
            apart = (candidate[0] * q1, candidate[1] * (q2 - q1))
            opens = all(apart[i] > 0 for i in (0, 1) if closed[i] and candidate[i] != 0)
            if opens and all(
                margin >= 0 for margin in self.margins(candidate, theta, omega, pull).values()
            ):
                return candidate
        if min(self.margins(state, theta, omega, pull).values()) > -1e-9:
            return state
        raise ArithmeticError(
            f"no contact state is consistent at {state}, {theta}, {omega}, {pull}"
        )

    # ---------------------------------------------------------------- impact

    def products(self, test, field, theta):
        """Kinetic-metric products of the fields about ``test`` with those about ``field``."""
        r1t, dt, r2t = self.fields(test, theta)
        r1, d, r2 = self.fields(field, theta)
        return (
            (self.i1 + self.m1 * _dot(r1t, r1) + self.m2 * _dot(dt, d), self.m2 * _dot(dt, r2)),
            (self.m2 * _dot(r2t, d), self.i2 + self.m2 * _dot(r2t, r2)),
        )

    def impulses(self, test, new, old, theta, after, before):
        """Generalised impulses about ``test``: momenta after less momenta before."""
        late = self.products(test, (new[0] or 1, new[1] or 1), theta)
        early = self.products(test, (old[0] or 1, old[1] or 1), theta)
        j1, j2 = (
            late[i][0] * after[0]
            + late[i][1] * after[1]
            - early[i][0] * before[0]
            - early[i][1] * before[1]
            for i in (0, 1)
        )
        return j1, j2

    def projected(self, test: Pair, new: State, old: State, theta: Pair, before: Pair) -> Pair:
        """Velocities after an impact without impulse about ``test``; full contacts share theirs."""
        c1, c2 = new
        if c1 == 0 and c2 == 0:
            return 0.0, 0.0
        left = self.products(test, (c1 or 1, c2 or 1), theta)
        momenta = self.impulses(test, new, old, theta, (0.0, 0.0), before)
        p1, p2 = -momenta[0], -momenta[1]
        if c1 == 0:
            return 0.0, p2 / left[1][1]
        if c2 == 0:
            q = (p1 + p2) / sum(left[0] + left[1])
            return q, q
        det = left[0][0] * left[1][1] - left[0][1] * left[1][0]
        return (
            (p1 * left[1][1] - p2 * left[0][1]) / det,
            (p2 * left[0][0] - p1 * left[1][0]) / det,
        )

    def impact(self, old, closing, theta, before):
        """Contact state and angular velocities after an impact (Spanos, Roussis and Politis, 2001).

        ``closing`` holds the old pivot of each contact that closes, 0 for the others.  Last comes
        whether a measured restitution gave way to the largest with which energy does not grow.
        """
        outcomes = self.admissible_impacts(old, closing, theta, before)
        outcome = next(outcomes, None) or self._together(old, closing, theta, before)
        # the law of the corner that comes down
        laws = [self._laws[i][-closing[i]] if closing[i] else None for i in (0, 1)]
        if laws == [None, None]:
            return *outcome, False
        plain, moved = outcome[1], None
        moves = any(law is not None and law.name == "position" for law in laws)
        if moves:
            found = next(self.admissible_impacts(old, closing, theta, before, moved=True), None)
            moved = None if found is None else found[1]
        wanted = [self._wanted(i, closing, before, plain, moved) for i in (0, 1)]
        given = [law is not None for law in laws]

        def shared(fraction: float) -> tuple[State, Pair]:
            rates = tuple(
                p + fraction * (w - p) for p, w in zip(_rates(plain), wanted, strict=True)
            )
            return self._coming_off(old, closing, theta, before, given, (rates[0], rates[1]))

        energy = self.kinetic_energy(old, theta, before) * (1 + 1e-9)

        def spare(fraction: float) -> float:
            new, after = shared(fraction)
            return energy - self.kinetic_energy(new, theta, after)

        if spare(1.0) >= 0:
            return *shared(1.0), moves and moved is None
        return *shared(float(brentq(spare, 0.0, 1.0, xtol=1e-15))), True

    def _wanted(self, contact, closing, before, plain, moved):
        """Rate at which a contact comes off, by its law if it closes and never on its old pivot.

        ``plain`` and ``moved`` are the velocities after it by momentum, and with impulses where position has them.
        """
        law = self._laws[contact][-closing[contact]] if closing[contact] else None
        if law is None:
            return _rates(plain)[contact]
        if law.name == "ratio":
            rate = law.number * _rates(before)[contact]
        elif law.name == "couple":
            rate = law.number * _rates(plain)[contact]
        else:
            rate = _rates(moved or plain)[contact]
        return rate if rate * closing[contact] < 0 else 0.0

    def _coming_off(self, old, closing, theta, before, given, rates):
        """State and velocities after an impact whose closing contacts come off at given rates.

        The impulses of the contact whose rate is given do no work on a motion that does not change
        that rate.  Of these motions there is one for each state of the other contact, and momentum
        along it decides whether that contact opens: at one corner, at the other, or not at all.
        """
        parted = [
            _sign(rate) if is_given else 0 for rate, is_given in zip(rates, given, strict=True)
        ]
        if all(given):
            return (parted[0], parted[1]), (rates[0], rates[0] + rates[1])
        other = given.index(False)
        for c in (1, -1):
            is_open = old[other] != 0 and closing[other] == 0
            if (
                (is_open and c != old[other])
                or (closing[other] == c)
                or (other == 0 and self.alone)
            ):
                continue
            new = (c, parted[1]) if other == 0 else (parted[0], c)
            places = (float(new[0] or 1), float(new[1] or 1))
            # of the motion in which the closing contact keeps its rate
            along = (1.0, 1.0) if other == 0 else (0.0, 1.0)
            still = (0.0, rates[1]) if other == 0 else (rates[0], rates[0])
            lacking = self.impulses(places, new, old, theta, still, before)
            row = self.products(places, (new[0] or 1, new[1] or 1), theta)
            inertia = sum(along[i] * row[i][j] * along[j] for i in (0, 1) for j in (0, 1))
            speed = -(along[0] * lacking[0] + along[1] * lacking[1]) / inertia
            if is_open or c * speed > NEGLIGIBLE_SPEED * (abs(before[0]) + abs(before[1])):
                return new, (still[0] + along[0] * speed, still[1] + along[1] * speed)
        if other == 0:
            return (0, parted[1]), (0.0, rates[1])
        return (parted[0], 0), (rates[0], rates[0])

    def _together(self, old, closing, theta, before):
        """Keep together what met, where no other outcome is possible."""
        new = (0 if closing[0] else old[0], 0 if closing[1] else old[1])
        pivots = (float(new[0] or 1), float(new[1] or 1))
        return new, self.projected(pivots, new, old, theta, before)

    def admissible_impacts(self, old, closing, theta, before, moved=False):
        """List every outcome of an impact that separates and presses as it must.

        Impulses act at the pivots, or, if ``moved``, where the law of position has them.
        """
        closed = (old[0] == 0 or closing[0] != 0, old[1] == 0 or closing[1] != 0)
        speed = NEGLIGIBLE_SPEED * (abs(before[0]) + abs(before[1]))
        for new in self.options(old, closed, closing):
            places = (float(new[0] or 1), float(new[1] or 1))
            if moved:
                places = (self._place(0, new, closing), self._place(1, new, closing))
            after = self.projected(places, new, old, theta, before)
            apart = (new[0] * after[0], new[1] * (after[1] - after[0]))
            separates = all(apart[i] > speed for i in (0, 1) if closed[i] and new[i] != 0)
            if separates and self._presses(new, old, places, theta, after, before):
                yield new, after

    def _place(self, contact: int, new: State, closing: State) -> float:
        """Where the impulse of a contact acts by the law of position, as a fraction of the half width."""
        law = self._laws[contact][-closing[contact]] if closing[contact] and new[contact] else None
        if law is not None and law.name == "position":
            return law.number
        return float(new[contact] or 1)

    def _presses(self, new, old, places, theta, after, before):
        """Whether the impulses push at every contact that is full after the impact."""
        slack = -NEGLIGIBLE_SPEED * math.hypot(*before)
        for s in (1, -1):
            if new[1] == 0:
                j2 = self.impulses((places[0], s), new, old, theta, after, before)[1]
                if s * j2 < slack * (self.i2 + self.m2 * self.b2**2):
                    return False
            if new[0] == 0 and not self.alone:
                j1, j2 = self.impulses((s, places[1]), new, old, theta, after, before)
                moment = j1 + j2 if new[1] == 0 else j1
                if s * moment < slack * (self.i1 + self.m1 * self.b1**2):
                    return False
        return True


class LinearModel(Model):
    """The linearised equations: 2.9 for a lone block, 2.60 to 2.65 (mended) for a stack.

    Masses and impact maps are those of the standing blocks, sin θ = θ, cos θ = 1, and products of
    angles and velocities are dropped.
    """

    def __init__(self, body: Block | Stack, g: float, restitution: object = None) -> None:
        super().__init__(body, g, restitution)
        self._lone = body if isinstance(body, Block) else None

    def fields(self, places: Pair, theta: Pair) -> tuple[Vector, Vector, Vector]:
        """Vectors r1, d and r2 of the standing blocks [m]."""
        return super().fields(places, (0.0, 0.0))

    def terms(self, pivots, theta, omega, pull):
        """Return M11, M12, M22, f1, f2 of the linearised equations."""
        r1, d, r2 = self.fields(pivots, theta)
        m11 = self.i1 + self.m1 * _dot(r1, r1) + self.m2 * _dot(d, d)
        m12, m22 = self.m2 * _dot(d, r2), self.i2 + self.m2 * _dot(r2, r2)
        if self._lone is not None:
            # 2.9 goes one step further: sin θc = θc and cos θc = 1
            radius = self._lone.radius(pivots[1])
            r2 = Vector(-pivots[1] * self._lone.critical_angle(pivots[1]) * radius, radius)
        moment1 = Vector(self.m1 * r1.x + self.m2 * d.x, self.m1 * r1.y + self.m2 * d.y)
        f1 = moment1.y * pull[0] - pull[1] * (moment1.x + moment1.y * theta[0])
        f2 = self.m2 * (r2.y * pull[0] - pull[1] * (r2.x + r2.y * theta[1]))
        return m11, m12, m22, f1, f2


def impulse_place(block: Block, old_pivot: int, value: float) -> float:
    """Place of an impulse that leaves a lone block with ω⁺ = value · ω⁻, over the half width [-].

    Conservation of angular momentum about a point x of the base, I + m (C - x)·(C - pivot), before
    about the old pivot and after about the other; x is that other pivot where momentum is conserved.
    """
    centre = block.centre
    k = block.centroidal_inertia / block.mass + centre.y**2
    lever = k * (1 - value) / (old_pivot * block.b * (1 + value) - centre.x * (1 - value))
    return (centre.x - lever) / block.b


@dataclass(frozen=True)
class Law:
    """How one interface comes off impacts that end on one corner.

    ``number`` is a factor on what momentum leaves ("couple"), the place of the impulse on the base
    ("position"), or the ratio of the velocities after and before ("ratio").
    """

    name: str
    number: float


Laws = dict[int, Law | None]


def _laws_by_contact(body: Block | Stack, restitution: object) -> tuple[Laws, Laws]:
    """Laws of ground and interface by the corner that comes down."""
    name = "position"
    if isinstance(restitution, MeasuredRestitution):
        name, restitution = restitution.law, restitution.value
    none: Laws = {1: None, -1: None}
    if restitution is None:
        return none, none
    if isinstance(body, Block):
        # every law is that of the lone block
        return none, _laws_of(body, restitution, "ratio")
    ground, interface = restitution
    return _laws_of(body.lower, ground, name), _laws_of(upper_on_contact(body), interface, name)


def _laws_of(block: Block, value: object, name: str) -> Laws:
    if value is None:
        return {1: None, -1: None}
    laws: Laws = {}
    for corner in (1, -1):
        pair = isinstance(value, tuple | list)
        number = float(value[(1 - corner) // 2] if pair else value)
        by_momentum = block.momentum_restitution(-corner)
        if name == "ratio":
            laws[corner] = Law("ratio", number)
        elif name == "position" and number >= by_momentum:
            laws[corner] = Law("position", impulse_place(block, -corner, number))
        else:
            laws[corner] = Law("couple", number / by_momentum)
    return laws
