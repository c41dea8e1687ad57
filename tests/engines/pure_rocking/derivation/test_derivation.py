"""The chain against angular momentum; the fast kernel and the thesis (2.1 to 2.86) against it.

The truth is the chain of bodies in ``tests/oracle/rocking_model.py``, which follows from the positions of the
centres alone and knows no formula of the thesis.
"""

import itertools
import re

import numpy as np
import pytest

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.pure_rocking.ensembles import body_record
from rockfrag.engines.pure_rocking.kernels.equations import equations
from rockfrag.system import Block, Stack

from ....case_tables import case_tables
from ....oracle.rocking_model import LinearModel, Model, pivots
from ..kernel_impact import kernel_impact, state_record

Array = np.ndarray


class System:
    """Arrays over random two-block systems in random states; the names are the thesis's."""

    def __init__(self, **given: Array) -> None:
        self.given = given
        vars(self).update(given)

    def with_(self, **values: Array | float) -> "System":
        """Return the same systems in another state."""
        return System(**self.given | {k: v + 0 * self.b1 for k, v in values.items()})

    def joined(self) -> "System":
        """Return the state of pattern 3, block 2 moving as block 1."""
        return self.with_(th2=self.th1, w2=self.w1, q2=self.q1)

    def standing(self) -> "System":
        """Return the state of pattern 4, block 1 at rest."""
        return self.with_(th1=0.0, w1=0.0, q1=0.0)

    def stacks(self) -> list[Stack]:
        """Return the systems as the package takes them."""
        lower = np.array([2 * self.b1, 2 * self.h1, self.m1, self.ic1]).T.tolist()
        upper = np.array([2 * self.b2, 2 * self.h2, self.m2, self.ic2]).T.tolist()
        return [Stack(Block(*a), Block(*b)) for a, b in zip(lower, upper, strict=True)]

    def models(self, kind: type[Model] = Model) -> list[Model]:
        """Return the chain of each system."""
        return [kind(stack, g) for stack, g in zip(self.stacks(), self.g, strict=True)]

    def get(self, name: str, s1: Array | float, s2: Array | float) -> Array:
        """Evaluate one of the quantities of the chain for these pivots."""
        models = self.models(LinearModel if name == "linear" else Model)
        turns = [self.th1, self.th2], [self.w1, self.w2], [self.q1, self.q2]
        states = np.array([*turns, [self.xg, self.a], [self.vg, self.g]])
        places = zip(*np.broadcast_arrays(s1, s2, self.b1)[:2], strict=True)
        found = [
            quantity(name, model, at, state)
            for model, at, state in zip(
                models, places, np.moveaxis(states, -1, 0), strict=True
            )
        ]
        return np.array(found).T


def quantity(name: str, model: Model, at: tuple[float, float], state: Array) -> Array:
    """One quantity of one chain whose pivots are ``at``."""
    theta, omega, turning, (xg, a), (vg, g) = state
    if name in ("τ", "linear"):
        mass, force = model.terms(at, theta, omega, (a, g))
        return mass @ turning + force
    arms, field = model.arms(at) * np.exp(-1j * theta), model.fields(at, theta)
    points = xg + model.middle[0] + at[0] * model.half[0] + np.array([0, arms[1, 0]])
    centres, velocities = points + np.diag(arms), vg + field @ omega
    if name == "V":
        return g * model.mass @ centres.imag
    if name == "T":
        return (model.mass @ abs(velocities) ** 2 + model.inertia @ omega**2) / 2
    vectors = {
        "pivot": points, "centre": centres, "velocity": velocities,
        "acceleration": a + field @ turning - arms @ omega**2,
    }  # fmt: skip
    return np.array([vectors[name].real, vectors[name].imag])


def random_systems(n: int = 15, seed: int = 2) -> System:
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


S = random_systems()
N = len(S.b1)
STACKS = S.stacks()
STATES = [s for s in itertools.product((1, 0, -1), (1, 0, -1)) if s != (0, 0)]


def error(found: Array, true: Array) -> Array:
    """Relative error, of the size of the typical value where a value happens to be small."""
    typical = np.median(np.abs(true), axis=-1, keepdims=True)
    return np.abs(found - true) / np.maximum(np.maximum(np.abs(true), typical), 1e-300)


def impact_map(s: System, old: tuple[int, int], new: tuple[int, int]) -> Array:
    """Velocities after an impact that conserves angular momentum about the new pivots, shape (2, n)."""
    theta, omega = np.array([s.th1, s.th2]).T, np.array([s.w1, s.w2]).T
    found = [
        model.projected(pivots(new), new, old, *state)
        for model, *state in zip(s.models(), theta, omega, strict=True)
    ]
    return np.array(found).T


# --------------------------------------------------------------------------- the thesis


ALONE, UNIFORM = S.standing(), random_systems(50, 3)
UNIFORM = UNIFORM.with_(
    ic1=UNIFORM.m1 * (UNIFORM.b1**2 + UNIFORM.h1**2) / 3,
    ic2=UNIFORM.m2 * (UNIFORM.b2**2 + UNIFORM.h2**2) / 3,
)
# slenderness 1e7, rotated in proportion
SLENDER = UNIFORM.standing().with_(
    b2=1e-7 * UNIFORM.h2, th2=1e-7 * UNIFORM.th2, q2=1e-7 * UNIFORM.q2, a=1e-7 * UNIFORM.a,
    ic2=UNIFORM.m2 * UNIFORM.h2**2 / 3,
)  # fmt: skip
AT_REST = {"th1": 0.0, "th2": 0.0, "w1": 0.0, "w2": 0.0, "q1": 0.0, "q2": 0.0}
LET_GO = {"w2": 0.0, "q2": 0.0, "a": 0.0}
SYSTEMS = {
    "random": S,
    "standing": ALONE,
    "joined": S.joined(),
    "rest": S.with_(**AT_REST),
    "tiny": ALONE.with_(th2=1e-7 * S.th2),
    "slender": SLENDER,
    "slender_free": SLENDER.with_(a=0.0),
    "let_go": ALONE.with_(**LET_GO),
    "let_go_uniform": UNIFORM.standing().with_(**LET_GO),
    "fallen": ALONE.with_(th2=0.0, vg=0.0),
    "uniform": UNIFORM.standing().with_(th2=0.0),
    "on_the_ground": S.with_(th1=0.0),
    "on_each_other": S.with_(th2=S.th1),
    "joined_rest": S.joined().with_(th1=0.0, th2=0.0),
}


def symbols(s: System) -> dict[str, object]:
    """What the equations are written in; a stroke is an underscore."""
    r1, r2 = np.hypot(s.b1, s.h1), np.hypot(s.b2, s.h2)
    xi, xi_ = s.b1 - s.b2, s.b1 + s.b2
    m, top = s.m1 + s.m2, 2 * s.h1 + s.h2
    r = np.hypot(top, s.b1)
    io1, io2 = s.ic1 + s.m1 * r1**2, s.ic2 + s.m2 * r2**2
    known = {
        name: getattr(s, name)
        for name in ("b1", "b2", "h1", "h2", "m1", "m2", "g", "a")
    }
    for i, (th, w, q) in enumerate([(s.th1, s.w1, s.q1), (s.th2, s.w2, s.q2)], start=1):
        known |= {f"θ{i}": th, f"θ{i}_": w, f"θ{i}__": q}
    return known | {
        "x_g": s.xg, "v_g": s.vg, "S": np.sign(s.th1), "S2": np.sign(s.th2),
        "R1": r1, "R2": r2, "θc1": np.arctan2(s.b1, s.h1), "θc2": np.arctan2(s.b2, s.h2),
        "I_C1": s.ic1, "I_C2": s.ic2, "I_O1": io1, "I_O2": io2, "I_o": io1 + s.ic2 + s.m2 * r**2,
        "ξ": xi, "ξ_": xi_, "l": np.hypot(xi, 2 * s.h1), "l_": np.hypot(xi_, 2 * s.h1),
        "β": np.arctan2(xi, 2 * s.h1), "β_": np.arctan2(xi_, 2 * s.h1),
        "m": m, "h": (s.m1 * s.h1 + s.m2 * top) / m, "r": r, "Θ": np.arctan(top / s.b1),
        "τ": lambda i, *at: s.get("τ", *at)[i - 1],
        "linear": lambda i, *at: s.get("linear", *at)[i - 1],
        "x": lambda i, *at: s.get("centre", *at)[i - 1, 0],
        "y": lambda i, *at: s.get("centre", *at)[i - 1, 1],
        "x_": lambda i, *at: s.get("velocity", *at)[i - 1, 0],
        "y_": lambda i, *at: s.get("velocity", *at)[i - 1, 1],
        "T": lambda *at: s.get("T", *at),
        "V": lambda *at: s.get("V", *at),
        **{name: getattr(np, name) for name in ("sin", "cos", "cosh", "arccosh", "arctan", "sqrt", "abs")},
    }  # fmt: skip


def value(text: str, known: dict[str, object]) -> Array:
    """Evaluate a formula in which factors stand beside each other, with a space between."""
    text = text.replace("²", "**2").replace("'", "_").replace("⁺", "after")
    return eval(re.sub(r"(?<=[\w)]) (?=[\w(])", "*", text), {}, known)


def sides(equation: dict, mended: bool) -> tuple[Array, Array]:
    """Both sides of an equation, as printed or as it holds."""
    s = SYSTEMS[equation.get("of", "random")]
    known = symbols(s)
    if "impact" in equation:
        known["θ1_after"], known["θ2_after"] = impact_map(
            s, *map(tuple, equation["impact"])
        )
    for name, text in equation.get("let", {}).items():
        known[name] = value(text if isinstance(text, str) else text[mended], known)
    left, right = (value(side, known) for side in equation["says"].split(" = "))
    return left, right + 0 * s.b1


EQUATIONS = case_tables(__file__)["equations"]


def is_misprinted(equation: dict) -> bool:
    return any(isinstance(text, list) for text in equation.get("let", {}).values())


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda e: f"2.{e['eq'][0]}")
def test_the_equation_holds_or_its_mended_form_does(equation):
    assert error(*sides(equation, mended=True)).max() < 1e-12
    if is_misprinted(equation):
        printed = error(*sides(equation, mended=False))
        assert printed.max() > 1e-3
        assert np.mean(printed > 1e-6) > 0.3


def test_every_equation_is_judged_and_the_misprints_are_those_of_the_table():
    judged = {number for equation in EQUATIONS for number in equation["eq"]}
    # Lagrange's equations (below), and when an interface closes
    assert judged == {*range(1, 87)} - {26, 77}
    wrong = {equation["eq"][0] for equation in EQUATIONS if is_misprinted(equation)}
    # those that docs/derivation.md lists
    assert wrong == {
        15,
        16,
        33,
        39,
        46,
        47,
        51,
        60,
        62,
        64,
        66,
        *range(69, 77),
        *range(78, 86),
    }


def test_lagranges_equations_are_those_of_newton_and_euler():
    force = S.get("acceleration", 1, -1) * np.array([S.m1, S.m2])[:, np.newaxis]
    force[:, 1] += np.array([S.m1, S.m2]) * S.g

    def moment(about: int, body: int) -> Array:
        arm = S.get("centre", 1, -1)[body] - S.get("pivot", 1, -1)[about]
        return arm[1] * force[body, 0] - arm[0] * force[body, 1]

    upper = moment(1, 1) + S.ic2 * S.q2
    both = moment(0, 0) + S.ic1 * S.q1 + moment(0, 1) + S.ic2 * S.q2
    assert error(np.array([both - upper, upper]), S.get("τ", 1, -1)).max() < 1e-12


@pytest.mark.parametrize(
    ("old", "new"), [(o, n) for o in STATES for n in STATES if o != n]
)
def test_impact_maps_keep_angular_momentum_about_the_new_pivots(old, new):
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
    early, late = pivots(old), pivots(new)
    for contact in (0, 1):
        if new[contact]:
            about = s.get("pivot", *late)[contact]
            lost = momentum(s, early, about, contact) - momentum(
                s.with_(w1=w1, w2=w2), late, about, contact
            )
            np.testing.assert_allclose(lost, 0.0, atol=1e-10)
    assert new[0] or not w1.any()
    assert new[1] or (w1 == w2).all()


def momentum(s: System, at: tuple[int, int], about: Array, contact: int) -> Array:
    """Clockwise angular momentum about a point, of the bodies above a contact on a ground that stands still."""
    arms, speeds = s.get("centre", *at) - about, s.with_(vg=0.0).get("velocity", *at)
    bodies = ((s.ic1, s.m1, s.w1), (s.ic2, s.m2, s.w2))
    return sum(
        inertia * omega + mass * (arm[1] * v[0] - arm[0] * v[1])
        for (inertia, mass, omega), arm, v in list(
            zip(bodies, arms, speeds, strict=True)
        )[contact:]
    )


# --------------------------------------------------------------------------- the fast kernel


# kernels can be called by kernels only
@entry_kernel
def kernel_equations(body, sigma1, sigma2, at):
    return equations(body, sigma1, sigma2, at)


def state(s: System, k: int) -> Array:
    """Rotations and angular velocities."""
    return np.array([[s.th1[k], s.th2[k]], [s.w1[k], s.w2[k]]])


@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("at", itertools.product((1, -1), (1, -1)))
def test_the_equations_of_motion_of_the_fast_kernel_are_those_of_the_chain(at, linear):
    found = np.empty((2, N))
    for k in range(N):
        record = body_record(STACKS[k].system(), linear=linear, g=S.g[k])
        started = state_record(at, *state(S, k), (float(S.a[k]), float(S.g[k])))
        m11, m12, m22, f1, f2 = kernel_equations(record, *at, started)
        found[:, k] = np.array([[m11, m12], [m12, m22]]) @ [S.q1[k], S.q2[k]] + [f1, f2]
    assert error(found, S.get("linear" if linear else "τ", *at)).max() < 1e-12


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
                s = s.joined()
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
    for k, model in enumerate(S.models()):
        theta, omega = state(s, k)
        outcomes = list(model.admissible_impacts(old, closing, theta, omega))
        assert len(outcomes) <= 1
        without += not outcomes
        new, after, gave_way = model.impact(old, closing, theta, omega)
        before = model.kinetic_energy(old, theta, omega)
        assert model.kinetic_energy(new, theta, after) <= before * (1 + 1e-12)
        p = body_record(STACKS[k].system(), g=S.g[k])
        n1, n2, w1, w2, fast_gave_way = kernel_impact(
            p,
            state_record(old, theta, omega, (0.0, S.g[k])),
            closing[0] != 0,
            closing[1] != 0,
        )
        assert (n1, n2) == new and not gave_way and not fast_gave_way
        assert (w1, w2) == pytest.approx(after, rel=1e-10, abs=1e-12)
    # only where both contacts of pattern 2 close at the same instant may none be left; then what met
    # stays together
    both_of_rocking_mode_2 = closing[0] * closing[1] == -1
    assert without == 0 or both_of_rocking_mode_2
