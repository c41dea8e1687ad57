"""Random two-block systems in random states, with the thesis's symbols, and the true quantities.

The truth is the chain of bodies in ``tests/oracle/rocking_model.py``, which follows from the positions of the
centres alone and knows no formula of the thesis.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rockfrag.system import Block, Stack

from ...oracle.rocking_model import LinearModel, Model, pivots

Array = np.ndarray


class System:
    """Arrays over the random systems; the names are the thesis's."""

    def __init__(self, **given: Array) -> None:
        self.given = given
        vars(self).update(given)
        self.r1, self.r2 = np.hypot(self.b1, self.h1), np.hypot(self.b2, self.h2)
        self.tc1, self.tc2 = np.arctan2(self.b1, self.h1), np.arctan2(self.b2, self.h2)
        self.io1 = self.ic1 + self.m1 * self.r1**2
        self.io2 = self.ic2 + self.m2 * self.r2**2
        self.xi = self.b1 - self.b2  # 2.61
        self.xi_ = 2 * self.b1 - self.xi  # 2.63
        self.length, self.length_ = (np.hypot(xi, 2 * self.h1) for xi in (self.xi, self.xi_))
        self.beta, self.beta_ = (np.arctan2(xi, 2 * self.h1) for xi in (self.xi, self.xi_))
        self.m = self.m1 + self.m2
        top = 2 * self.h1 + self.h2
        self.h = (self.m1 * self.h1 + self.m2 * top) / self.m  # 2.22
        self.rr = np.sqrt(top**2 + self.b1**2)  # 2.67
        self.big = np.arctan(top / self.b1)  # 2.68, Θ
        self.io = self.io1 + self.ic2 + self.m2 * self.rr**2

    def with_(self, **values: Array | float) -> "System":
        """Return the same systems in another state."""
        return System(**self.given | {k: v + 0 * self.b1 for k, v in values.items()})

    def rigidly_joined(self) -> "System":
        """Return the state of pattern 3, block 2 moving as block 1."""
        return self.with_(th2=self.th1, w2=self.w1, q2=self.q1)

    def standing(self) -> "System":
        """Return the state of pattern 4, block 1 at rest."""
        return self.with_(th1=0.0, w1=0.0, q1=0.0)

    def models(self, kind: type[Model] = Model) -> list[Model]:
        """Return the chain of each system."""
        return [kind(stack, g) for stack, g in zip(self.stacks(), self.g, strict=True)]

    def stacks(self) -> list[Stack]:
        """Return the systems as the package takes them."""
        lower = np.array([2 * self.b1, 2 * self.h1, self.m1, self.ic1]).T.tolist()
        upper = np.array([2 * self.b2, 2 * self.h2, self.m2, self.ic2]).T.tolist()
        return [Stack(Block(*a), Block(*b)) for a, b in zip(lower, upper, strict=True)]

    def get(self, name: str, s1: float, s2: float) -> Array:
        """Evaluate one of the true quantities for these pivots."""
        kind = LinearModel if name == "linear_motion" else Model
        turns = [self.th1, self.th2], [self.w1, self.w2], [self.q1, self.q2]
        state = np.array([*turns, [self.xg, self.a], [self.vg, self.g]])
        found = [
            true_quantity(name, model, (s1, s2), values)
            for model, values in zip(self.models(kind), np.moveaxis(state, -1, 0), strict=True)
        ]
        return np.array(found).T

    def moments(self, s1: float, s2: float) -> Array:
        """Left-hand sides of Lagrange's equations, shape (2, n)."""
        return self.get("motion", s1, s2)


def random_systems(n: int = 60, seed: int = 2) -> System:
    """Draw systems of any inertia, the statue narrower than the pedestal, in any state."""
    rng = np.random.default_rng(seed)
    b1, b2 = rng.uniform(0.2, 1.0, n), rng.uniform(0.3, 0.95, n)
    b2 = b1 * b2
    h1, h2 = rng.uniform(0.2, 2.0, n), rng.uniform(0.3, 2.0, n)
    m1, m2 = rng.uniform(1, 10, n), rng.uniform(1, 10, n)
    return System(
        b1=b1, h1=h1, m1=m1, ic1=m1 * rng.uniform(0.1, 0.5, n) * (b1**2 + h1**2),
        b2=b2, h2=h2, m2=m2, ic2=m2 * rng.uniform(0.1, 0.5, n) * (b2**2 + h2**2),
        g=rng.uniform(9.0, 10.0, n),
        th1=rng.uniform(-0.6, 0.6, n), th2=rng.uniform(-0.6, 0.6, n),
        w1=rng.uniform(-2, 2, n), w2=rng.uniform(-2, 2, n),
        q1=rng.uniform(-9, 9, n), q2=rng.uniform(-9, 9, n),
        xg=rng.uniform(-1, 1, n), vg=rng.uniform(-1, 1, n), a=rng.uniform(-9, 9, n),
    )  # fmt: skip


def uniform_systems(n: int = 200, seed: int = 3) -> System:
    """Draw systems of uniform rectangular blocks."""
    s = random_systems(n, seed)
    return s.with_(ic1=s.m1 * s.r1**2 / 3, ic2=s.m2 * s.r2**2 / 3)


def error(found: Array, true: Array) -> Array:
    """Relative error, of the size of the typical value where a value happens to be small."""
    found, true = np.broadcast_arrays(np.asarray(found, float), np.asarray(true, float))
    typical = np.median(np.abs(true), axis=-1, keepdims=True)
    return np.abs(found - true) / np.maximum(np.maximum(np.abs(true), typical), 1e-300)


def true_quantity(name: str, model: Model, at: tuple[float, float], state: Array) -> Array:
    """One quantity of one system whose pivots are ``at``."""
    theta, omega, turning, (xg, a), (vg, g) = state
    if name.endswith("motion"):
        mass, force = model.terms(at, theta, omega, (a, g))
        return mass @ turning + force
    arms, field = model.arms(at) * np.exp(-1j * theta), model.fields(at, theta)
    points = xg + model.middle[0] + at[0] * model.half[0] + np.array([0, arms[1, 0]])
    centres, velocities = points + np.diag(arms), vg + field @ omega
    vectors = {
        "pivot": points, "centre": centres, "velocity": velocities,
        "acceleration": a + field @ turning - arms @ omega**2,
    }  # fmt: skip
    if name[:-1] in vectors:
        found = vectors[name[:-1]][int(name[-1]) - 1]
        return np.array([found.real, found.imag])
    if name == "potential":
        return g * model.mass @ centres.imag
    return (model.mass @ abs(velocities) ** 2 + model.inertia @ omega**2) / 2


def impact_map(s: System, old: tuple[int, int], new: tuple[int, int]) -> Array:
    """Velocities after an impact that conserves angular momentum about the new pivots, shape (2, n)."""
    theta, omega = np.array([s.th1, s.th2]).T, np.array([s.w1, s.w2]).T
    return np.array(
        [
            model.projected(pivots(new), new, old, *state)
            for model, *state in zip(s.models(), theta, omega, strict=True)
        ]
    ).T


Quantity = Callable[[System], np.ndarray]


@dataclass(frozen=True)
class Equation:
    """A printed equation, its truth and, where the print is wrong, the form that holds.

    Each is a function of the random systems with values of any shape (..., n); an equation A = B is
    given as A - B and compared with the same difference derived from the positions.
    """

    number: str
    printed: Quantity
    true: Quantity
    mended: Quantity | None = None
    systems: Callable[[], System] = random_systems
    tolerance: float = 1e-12


def misprinted(
    number: str, case: Callable[[System, bool], Array], true: Quantity, **more: object
) -> Equation:
    """An equation that holds in another form than the printed one; ``case`` gives both."""
    return Equation(number, lambda s: case(s, True), true, lambda s: case(s, False), **more)


def by_sign(true: Callable[[System, int], Array], angle: str = "th1") -> Quantity:
    """What is true about the pivot that a rotation asks for, from what is about either."""
    return lambda s: np.where(getattr(s, angle) > 0, true(s, 1), true(s, -1))
