"""The chain against positions, Newton and Euler; the fast kernel and the thesis (2.1 to 2.86) against it."""

import itertools

import numpy as np
import pytest

from rockfrag import MeasuredRestitution, Stack
from rockfrag.engines.kernels.equations import STATE, equations
from rockfrag.engines.kernels.impact import impact
from rockfrag.engines.kernels.jit import entry_kernel
from rockfrag.engines.records import body_record
from rockfrag.laws import law_names
from rockfrag.rocking.options import system_of

from ...oracle.rocking_model import Model
from ...oracle.standing import upper_on_contact
from . import impacts, motion, single_block, transitions
from .systems import Equation, System, error, impact_map, random_systems

PIVOTS = list(itertools.product((1, -1), (1, -1)))
STATES = [s for s in itertools.product((1, 0, -1), (1, 0, -1)) if s != (0, 0)]
S = random_systems()
N = len(S.b1)


# kernels can be called by kernels only
@entry_kernel
def kernel_equations(body, sigma1, sigma2, at):
    return equations(body, sigma1, sigma2, at)


@entry_kernel
def kernel_impact(body, at, closes1, closes2):
    return impact(body, at, closes1, closes2)


def record(c, theta, omega, pull: tuple[float, float]) -> np.void:
    """The kernels' record of contacts and motion; ``pull``: acceleration of the ground, and gravity."""
    made = np.zeros(1, STATE)
    made[0] = (*c, theta[0], omega[0], theta[1], omega[1], *pull)
    return made[0]


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
        found = kernel_equations(p, *pivots, record(pivots, *state(S, k), pull(k)))
        m11, m12, m22, f1, f2 = found
        q1, q2 = S.q1[k], S.q2[k]
        return m11 * q1 + m12 * q2 + f1, m12 * q1 + m22 * q2 + f2

    true = S.get("linear_motion" if linear else "motion", *pivots)
    assert error(each(kernel), true).max() < 1e-12


@pytest.mark.parametrize("pivots", PIVOTS)
def test_velocities_and_accelerations_are_rates_of_the_positions(pivots):
    h = 1e-4
    rates = {"th1": (S.w1, S.q1), "th2": (S.w2, S.q2), "xg": (S.vg, S.a)}
    before, after = (
        S.with_(**{n: S.given[n] + t * v + t**2 / 2 * a for n, (v, a) in rates.items()})
        for t in (-h, h)
    )
    for i in (1, 2):
        early, now, late = (s.get(f"centre{i}", *pivots) for s in (before, S, after))
        assert S.get(f"velocity{i}", *pivots) == pytest.approx((late - early) / (2 * h), abs=1e-6)
        second = (late - 2 * now + early) / h**2
        assert S.get(f"acceleration{i}", *pivots) == pytest.approx(second, abs=1e-5)


def corner_force(s: System, contact: int, pivot: int, pivots: tuple[int, int]) -> np.ndarray:
    """Normal force at the corner opposite to ``pivot``, from Newton's and Euler's laws.

    The resultant of a full contact is split on its two corners; the accelerations are those of the
    centres, the forces are taken in the frame of the lower surface.
    """
    up = np.array([0 * s.g, s.g])
    force2 = s.m2 * (s.get("acceleration2", *pivots) + up)
    where, inertia = ("pivot2", s.ic2 * s.q2) if contact == 2 else ("pivot1", 0)
    at = s.get(where, *pivots)
    arm2 = s.get("centre2", *pivots) - at
    moment = arm2[1] * force2[0] - arm2[0] * force2[1] + s.ic2 * s.q2
    half_width = s.b2
    if contact == 1:
        force1 = s.m1 * (s.get("acceleration1", *pivots) + up)
        arm1 = s.get("centre1", *pivots) - at
        moment = moment + arm1[1] * force1[0] - arm1[0] * force1[1] + s.ic1 * s.q1 + inertia
        half_width = s.b1
    # a unit normal force at the other corner, 2 b away towards -pivot, turns by pivot · 2 b clockwise
    return moment / (pivot * 2 * half_width)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("pivot", [1, -1])
@pytest.mark.parametrize("contact", [2, 1], ids=["pattern 3", "pattern 4"])
def test_a_full_contact_persists_while_both_its_corners_are_pressed(contact, side, pivot):
    stuck, at = (S.rigidly_joined(), (side, 0)) if contact == 2 else (S.standing(), (0, side))
    models = [Model(STACKS[k], S.g[k]) for k in range(N)]
    # the true angular acceleration is that of the stuck state
    q = each(lambda k: models[k].accelerations(at, *state(stuck, k), pull(k)))
    stuck = stuck.with_(q1=q[0], q2=q[1])
    force = corner_force(stuck, contact, pivot, (at[0] or pivot, at[1] or pivot))
    found = each(lambda k: models[k].margins(at, *state(stuck, k), pull(k))[contact - 1, pivot])
    scale = (S.m2 if contact == 2 else S.m1 + S.m2) * S.g / 2
    assert error(found * scale, force).max() < 1e-11


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


IMPACTS = pytest.mark.parametrize(
    ("old", "closing", "s"),
    every_impact(),
    ids=lambda v: "" if isinstance(v, System) else f"{v[0]:+d}{v[1]:+d}",
)


@IMPACTS
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
            p, record(old, theta, omega, (0.0, S.g[k])), closing[0] != 0, closing[1] != 0
        )
        assert (n1, n2) == new and not gave_way and not fast_gave_way
        assert (w1, w2) == pytest.approx(after, rel=1e-10, abs=1e-12)
    # only where both contacts of pattern 2 close at the same instant may none be left; then what met
    # stays together
    both_of_rocking_mode_2 = closing[0] * closing[1] == -1
    assert without == 0 or both_of_rocking_mode_2


def has_something_to_multiply(stack: Stack) -> bool:
    """Whether momentum leaves both blocks something to rock on with, which the law "couple" asks for."""
    return all(b.momentum_restitution() > 0 for b in (stack.lower, upper_on_contact(stack)))


@pytest.mark.parametrize("law", law_names())
@pytest.mark.parametrize("measured", [(0.2, 0.3), (0.6, 0.9), (1.0, 1.0)])
@IMPACTS
def test_energy_never_grows_whatever_restitution_is_asked_for(old, closing, s, measured, law):
    restitution = MeasuredRestitution(measured, law)
    asked = range(0, N, 5)
    if law == "couple":
        asked = [k for k in range(N) if has_something_to_multiply(STACKS[k])]
        assert len(asked) >= N // 5
    for k in asked:
        model = Model(STACKS[k], S.g[k], restitution)
        theta, omega = state(s, k)
        before = model.kinetic_energy(old, theta, omega)
        new, after, _ = model.impact(old, closing, theta, omega)
        assert model.kinetic_energy(new, theta, after) <= before * (1 + 1e-8)
        n1, n2, w1, w2, _ = kernel_impact(
            body_record(system_of(STACKS[k], restitution=restitution), g=S.g[k]),
            record(old, theta, omega, (0.0, S.g[k])),
            closing[0] != 0,
            closing[1] != 0,
        )
        assert model.kinetic_energy((n1, n2), theta, (w1, w2)) <= before * (1 + 1e-8)


EQUATIONS = [*single_block.EQUATIONS, *motion.EQUATIONS, *transitions.EQUATIONS, *impacts.EQUATIONS]

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
