"""The chain against angular momentum; the fast kernel and the thesis (2.1 to 2.86) against it."""

import itertools

import numpy as np
import pytest

from rockfrag.engines.kernels.equations import equations
from rockfrag.engines.kernels.jit import entry_kernel
from rockfrag.engines.lanes import body_record

from ...oracle.rocking_model import Model
from ..kernel_impact import kernel_impact, state_record
from . import motion, single_block, transitions
from .systems import Equation, System, error, impact_map, random_systems

PIVOTS = list(itertools.product((1, -1), (1, -1)))
STATES = [s for s in itertools.product((1, 0, -1), (1, 0, -1)) if s != (0, 0)]
S = random_systems()
N = len(S.b1)


# kernels can be called by kernels only
@entry_kernel
def kernel_equations(body, sigma1, sigma2, at):
    return equations(body, sigma1, sigma2, at)


STACKS = S.stacks()


def each(function) -> np.ndarray:
    """Collect a function of the system's number, shape (2, n)."""
    return np.array([function(k) for k in range(N)]).T


def state(s: System, k: int) -> np.ndarray:
    """Rotations and angular velocities."""
    return np.array([[s.th1[k], s.th2[k]], [s.w1[k], s.w2[k]]])


def pull(k: int) -> tuple[float, float]:
    """Acceleration of the ground, and gravity."""
    return float(S.a[k]), float(S.g[k])


@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("pivots", PIVOTS)
def test_equations_of_motion(pivots, linear):
    def kernel(k):
        p = body_record(STACKS[k].system(), linear=linear, g=S.g[k])
        found = kernel_equations(p, *pivots, state_record(pivots, *state(S, k), pull(k)))
        m11, m12, m22, f1, f2 = found
        q1, q2 = S.q1[k], S.q2[k]
        return m11 * q1 + m12 * q2 + f1, m12 * q1 + m22 * q2 + f2

    true = S.get("linear_motion" if linear else "motion", *pivots)
    assert error(each(kernel), true).max() < 1e-12


@pytest.mark.parametrize(("old", "new"), [(o, n) for o in STATES for n in STATES if o != n])
def test_impact_maps(old: tuple[int, int], new: tuple[int, int]) -> None:
    s = S
    if 0 in (old[0], new[0]) or old[0] != new[0]:
        s = s.with_(th1=0.0)
    if 0 in (old[1], new[1]) or old[1] != new[1]:
        s = s.with_(th2=s.th1)
    if old[0] == 0:
        s = s.standing()
    if old[1] == 0:
        s = s.with_(w2=s.w1)
    w1, w2 = impact_map(s, old, new)
    early, late = ((c1 or 1, c2 or 1) for c1, c2 in (old, new))
    for contact in (0, 1):
        if new[contact]:
            about = s.get(f"pivot{contact + 1}", *late)
            lost = momentum(s, early, about, contact) - momentum(
                s.with_(w1=w1, w2=w2), late, about, contact
            )
            np.testing.assert_allclose(lost, 0.0, atol=1e-10)
    assert new[0] or not w1.any()
    assert new[1] or (w1 == w2).all()


def momentum(s: System, pivots: tuple[int, int], about: np.ndarray, contact: int) -> np.ndarray:
    """Clockwise angular momentum about a point, of the bodies above a contact on a ground that stands still."""
    total = 0 * s.b1
    for i, inertia, mass, omega in ((1, s.ic1, s.m1, s.w1), (2, s.ic2, s.m2, s.w2))[contact:]:
        arm = s.get(f"centre{i}", *pivots) - about
        v = s.with_(vg=0.0).get(f"velocity{i}", *pivots)
        total = total + inertia * omega + mass * (arm[1] * v[0] - arm[0] * v[1])
    return total


def every_impact() -> list[tuple[tuple[int, int], tuple[int, int], System]]:
    """Every kind of impact: the old state, the old pivots of what closes, states that close so."""
    cases = []
    for old in STATES:
        for which in ((1, 0), (0, 1), (1, 1)):
            if any(w and not c for w, c in zip(which, old, strict=True)):
                continue
            s = S
            if old[0] == 0:
                s = s.standing()
            if which[0]:
                s = s.with_(th1=0.0, w1=-old[0] * np.abs(s.w1))
            if old[1] == 0:
                s = s.rigidly_joined()
            elif which[1]:
                s = s.with_(th2=s.th1, w2=s.w1 - old[1] * np.abs(s.w2))
            cases.append((old, (old[0] * which[0], old[1] * which[1]), s))
    return cases


@pytest.mark.parametrize(
    ("old", "closing", "s"),
    every_impact(),
    ids=lambda v: "" if isinstance(v, System) else f"{v[0]:+d}{v[1]:+d}",
)
def test_an_impact_has_one_outcome_which_takes_energy_and_which_the_fast_kernel_finds(
    old, closing, s
):
    without = 0
    for k in range(N):
        model = Model(STACKS[k], S.g[k])
        theta, omega = state(s, k)
        outcomes = list(model.admissible_impacts(old, closing, theta, omega))
        assert len(outcomes) <= 1
        without += not outcomes
        new, after, gave_way = model.impact(old, closing, theta, omega)
        before = model.kinetic_energy(old, theta, omega)
        assert model.kinetic_energy(new, theta, after) <= before * (1 + 1e-12)
        p = body_record(STACKS[k].system(), g=S.g[k])
        n1, n2, w1, w2, fast_gave_way = kernel_impact(
            p, state_record(old, theta, omega, (0.0, S.g[k])), closing[0] != 0, closing[1] != 0
        )
        assert (n1, n2) == new and not gave_way and not fast_gave_way
        assert (w1, w2) == pytest.approx(after, rel=1e-10, abs=1e-12)
    # only where both contacts of pattern 2 close at the same instant may none be left; then what met
    # stays together
    both_of_rocking_mode_2 = closing[0] * closing[1] == -1
    assert without == 0 or both_of_rocking_mode_2


EQUATIONS = [*single_block.EQUATIONS, *motion.EQUATIONS, *transitions.EQUATIONS]

# the misprints that docs/derivation.md lists
WRONG = [
    f"2.{i}" for i in (15, 16, 33, 39, 46, 47, 51, 60, 62, 64, 66, *range(69, 77), *range(78, 86))
]


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda e: e.number)
def test_the_equation_holds_or_its_mended_form_does(equation: Equation) -> None:
    systems = equation.systems()
    true = equation.true(systems)
    printed = error(equation.printed(systems), true)
    if equation.mended is None:
        assert printed.max() < equation.tolerance
        return
    # a wrong print is wrong for every system in at least one of its components or states
    assert printed.max() > 1e-3
    worst = printed.reshape(-1, printed.shape[-1]).max(axis=0)
    assert np.mean(worst > 1e-6) > 0.3
    assert error(equation.mended(systems), true).max() < equation.tolerance


def test_every_equation_is_judged_once() -> None:
    assert [e.number for e in EQUATIONS] == [f"2.{i}" for i in range(1, 87)]


def test_the_misprints_are_those_of_the_table() -> None:
    assert [e.number for e in EQUATIONS if e.mended is not None] == WRONG
