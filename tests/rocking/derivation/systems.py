"""Random two-block systems in random states, with the thesis's symbols, and the true quantities."""

import numpy as np

from .lagrange import derived

Array = np.ndarray


BODY = ("b1", "h1", "m1", "ic1", "b2", "h2", "m2", "ic2", "g")
STATE = ("th1", "th2", "w1", "w2", "q1", "q2", "xg", "vg", "a")


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

    def get(self, name: str, s1: float, s2: float) -> Array:
        """Evaluate one of the derived quantities for these pivots."""
        body, state = ([self.given[key] for key in keys] for keys in (BODY, STATE))
        return derived()[name](*body, float(s1), float(s2), *state)

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


# ------------------------------------------------------------------------ impacts


def angular_momentum(s: System, s1: float, s2: float, about: Array, whole: bool) -> Array:
    """Clockwise angular momentum about a point, of the whole system or of block 2 alone."""
    parts = []
    for i, inertia, mass, omega in ((1, s.ic1, s.m1, s.w1), (2, s.ic2, s.m2, s.w2)):
        if i == 1 and not whole:
            continue
        arm = s.get(f"centre{i}", s1, s2) - about
        v = s.get(f"velocity{i}", s1, s2)
        parts.append(inertia * omega + mass * (arm[1] * v[0] - arm[0] * v[1]))
    return sum(parts)


def impact_map(s: System, old: tuple[int, int], new: tuple[int, int]) -> tuple[Array, Array]:
    """Velocities after an impact by conservation of angular momentum about the new pivots.

    The whole system keeps it about block 1's new pivot and block 2 about its own; of what is stuck
    after the impact only the part that does not pass impulses to unknown points is used.  ``old`` and
    ``new`` are contact states; the ground does not move during the impact.
    """
    s = s.with_(vg=0.0, xg=0.0)
    o1, o2 = old[0] or 1, old[1] or 1
    n1, n2 = new[0] or 1, new[1] or 1
    about1, about2 = s.get("pivot1", n1, n2), s.get("pivot2", n1, n2)

    def momenta(state: System, s1: int, s2: int) -> Array:
        return np.array(
            [
                angular_momentum(state, s1, s2, about1, whole=True),
                angular_momentum(state, s1, s2, about2, whole=False),
            ]
        )

    before = momenta(s, o1, o2)
    first = momenta(s.with_(w1=1.0, w2=0.0), n1, n2)
    two = momenta(s.with_(w1=0.0, w2=1.0), n1, n2)
    nothing = np.zeros_like(s.b1)
    if new == (0, 0):
        return nothing, nothing
    if new[0] == 0:
        return nothing, before[1] / two[1]
    if new[1] == 0:
        both = before[0] / (first[0] + two[0])
        return both, both
    det = first[0] * two[1] - first[1] * two[0]
    return (
        (before[0] * two[1] - before[1] * two[0]) / det,
        (first[0] * before[1] - first[1] * before[0]) / det,
    )
