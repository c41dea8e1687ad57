"""Static above kinetic friction in an impact that slides, beside Routh's equations of one contact."""

from collections import Counter

import numpy as np
import pytest

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.planar.impact import strike
from rockfrag.engines.planar.records import posed, system_record, working_memory
from rockfrag.engines.planar.solve import look_at
from rockfrag.simulation.history import simulate
from rockfrag.simulation.options import Friction
from rockfrag.system import Block

from ...oracle import routh, witness
from .cases import G, random_column, with_contacts


@entry_kernel
def hit(p, w):
    """Strike; the number of impacts that had no outcome."""
    look_at(p, w, w.q)
    strike(p, w, 0.0, 0.0, 0.0)
    return w.outcome.paradoxes


@pytest.mark.parametrize(
    ("ground", "after", "slides"), [(18.0, -0.733, True), (-12.0, -0.833, False)]
)
def test_a_block_sticks_where_the_impulse_stops_its_slip_and_not_where_it_drives_it(
    ground: float, after: float, slides: bool
) -> None:
    """Block .2 × .6 m, µ .4 static and .15 kinetic; (h/b)(1 - e)/(1 + e) = .243 lies in between.

    It slides at -.003 and +.0117 m/s as its corner lands at -1.023 and -1.011 rad/s: worked out by hand, kinetic
    friction through the first impact, and momentum about the corner through the second.
    """
    block, motion = Block(0.2, 0.6, 1.0), np.full(40, ground)
    start = {"theta0": 0.0008, "omega0": -1.0, "friction": Friction(0.4, 0.15)}
    events = simulate(block, motion, 2e-4, **start).contact_events
    first = events.query("kind == 'impact'").iloc[0]
    assert first["omega_after"] == pytest.approx((after,), abs=5e-4)
    assert ("slides" in first["modes"][0]) == slides


def beside_routh(number: int, seed: int) -> Counter:
    """Count random impacts of one contact, of columns of one to three bodies, and those that end otherwise."""
    rng, counts = np.random.default_rng(seed), Counter()
    while counts["impacts"] < number:
        bodies = int(rng.integers(1, 4))
        column = random_column(rng, bodies)
        kinetic = rng.uniform(0.05, 0.8)
        static = kinetic * rng.uniform(1.0, 4.0)
        system = with_contacts(column, [(static, kinetic)] * bodies)
        p, w = system_record(system, G), working_memory()
        contact, end = int(rng.integers(bodies)), int(rng.integers(2))
        theta = np.zeros(bodies)
        theta[contact:] = (2 * end - 1) * rng.uniform(0.01, 0.6)
        w["drive"][:] = -1
        w["kind"][:] = 1
        w["q"], _ = posed(p, theta.tolist(), [0.0] * bodies)
        q = w["q"][: 3 * bodies].reshape(bodies, 3)
        beside = witness.Column.of(system, G)
        touched = witness.ends_of(beside, q, contact)[end]
        before = rng.normal(0, 1, (bodies, 3)) * [0.5, 0.5, 1.0]
        speed = witness.relative(beside, q, before, contact, touched.point)
        u_n, u_t = float(speed @ touched.normal), float(speed @ touched.tangent)
        if u_n > -0.01:
            continue
        w["v"][: 3 * bodies] = before.ravel()
        w["touching"][contact, end] = 1
        felt = routh.felt(beside, q, contact, touched)
        expected = routh.integrate(felt, (static, kinetic), u_n, u_t)
        hit(p, w)
        after = w["v"][: 3 * bodies].reshape(bodies, 3)
        masses = np.array([body.mass for body in beside.bodies])[contact:, np.newaxis]
        change = (masses * (after - before)[contact:, :2]).sum(axis=0)
        found = float(change @ touched.normal), float(change @ touched.tangent)
        counts["impacts"] += 1
        ratio = abs(felt.both) / felt.tangent
        counts["between"] += kinetic < ratio <= static
        counts["slips back"] += ratio > static and expected[1] * u_t > 0
        counts["differ"] += not np.allclose(
            found, expected, rtol=1e-7, atol=1e-9 * expected[0]
        )
    return counts


@pytest.mark.parametrize(
    ("number", "seed"),
    [(40, 3), (400, 1), pytest.param(20_000, 2, marks=pytest.mark.slow)],
)
def test_impacts_of_one_contact_are_those_of_routh(number: int, seed: int) -> None:
    counts = beside_routh(number, seed)
    assert counts["differ"] == 0
    assert counts["between"] > 0.1 * number
    assert counts["slips back"] > 0.002 * number
