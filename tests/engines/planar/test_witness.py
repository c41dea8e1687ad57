"""Every impact before a witness that knows the change of momentum and nothing of how it was found."""

from dataclasses import replace

import numpy as np
import pytest

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar import integrate as contact
from rockfrag.engines.planar import records
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.engines.planar.witness import breaks_a_law
from rockfrag.simulation.inputs import ground_motion
from rockfrag.system import Block, Column, System

from ...oracle import witness
from ...simulation.reference_bodies import random_motion
from .cases import DT, G, random_column, with_contacts
from .violations import SHUT, history_of, impacts_of, worst_violations


@pytest.mark.parametrize("seed", [11, 25])
def test_what_is_shut_after_an_impact_of_five_bodies_slides_on(seed: int) -> None:
    """An end that parts by micrometres a second is shut; once that took slips of .4 m/s away."""
    rng = np.random.default_rng(seed)
    column = random_column(rng, 5)
    system = with_contacts(column, list(rng.uniform(0.3, 0.7, 5)))
    found = history_of(system, 2 * random_motion(rng), None, 1e-6)
    assert len(found.contact_events) > 50
    assert max(worst_violations(system, found.contact_events, 1e-6).values()) < 1


def shaken(rng: np.random.Generator) -> tuple[System, np.ndarray, np.ndarray]:
    """Draw one to eight leaning, off-centre bodies, static above kinetic friction, and two motions."""
    bodies = int(rng.integers(1, 9))
    kinetic = rng.uniform(0.15, 0.8, bodies)
    static = kinetic * rng.choice([1.0, 1.4, 2.0], bodies)
    frictions = list(zip(static.tolist(), kinetic.tolist(), strict=True))
    system = with_contacts(random_column(rng, bodies), frictions)
    return system, 2 * random_motion(rng), 0.3 * random_motion(rng)


@pytest.mark.parametrize(
    ("impacts", "of_each", "closing"),
    [
        (1000, 150, 1e-6),
        (1000, 150, 1e-4),
        pytest.param(100_000, 2000, 1e-4, marks=pytest.mark.slow),
    ],
)
def test_every_impact_obeys_its_laws(
    impacts: int, of_each: int, closing: float
) -> None:
    """Of random columns; what has no outcome is counted as a paradox and nothing else is."""
    rng, seen, unlawful = np.random.default_rng(3), 0, 0
    while seen < impacts:
        system, motion, up = shaken(rng)
        found = history_of(system, motion, up, closing)
        events = found.contact_events
        struck = events[events["kind"] == contact.IMPACT][:of_each]
        seen += len(struck)
        if found.work["outcome"]["paradoxes"] == 0:
            assert (
                max(worst_violations(system, struck, closing).values(), default=0) < 1
            )
        else:
            unlawful += int(found.work["outcome"]["paradoxes"])
    assert unlawful <= impacts / 1000


@entry_kernel
def judge(p, w, closing):
    """Whether the package's own witness finds that an impact breaks a law."""
    return breaks_a_law(p, w, closing, True)


@pytest.mark.parametrize("impacts", [120, pytest.param(1000, marks=pytest.mark.slow)])
def test_the_witness_of_every_history_sees_what_the_independent_one_sees(
    impacts: int,
) -> None:
    """Impacts as they were, and with what no contact could have done: a stop, a pull, a push from nowhere."""
    rng, seen, broken = np.random.default_rng(5), 0, 0
    while seen < impacts:
        system, motion, up = shaken(rng)
        column = witness.Column.of(system, G)
        p, w = records.system_record(system, G), records.working_memory()
        for impact in impacts_of(
            system, history_of(system, motion, up, 1e-6).contact_events
        )[:30]:
            spoilt = impact.after.copy()
            kind = int(rng.integers(4))
            if kind:
                spoilt[rng.integers(system.count), kind - 1] += rng.normal(0, 0.1)
            n = 3 * system.count
            w["q"][:n], w["old_v"][:n] = impact.q.ravel(), impact.before.ravel()
            w["v"][:n] = spoilt.ravel()
            spoilt_impact = replace(impact, after=spoilt)
            laws = witness.violations(column, spoilt_impact)
            worst = max(laws.values()) / (SHUT * 1e-6)
            if 0.3 < worst < 3:
                continue
            seen += 1
            broken += worst > 1
            assert judge(p, w, 1e-6) == (worst > 1), laws
    assert impacts / 3 < broken < 29 / 30 * impacts


def test_a_state_that_is_no_number_counts_as_a_fall_and_as_a_paradox() -> None:
    """Once such a body went on as one that stands; a sample stands for what brings it about."""
    system = with_contacts(Column([Block(0.3, 1.0, 50.0)] * 2), [0.8, 0.8])
    moved = ground_motion(np.full(10, 3.0), DT)
    case = Case(system, moved, request=Request(g=G))
    stands = ContactRun(case, 1e-4).work["outcome"]
    assert stands["overturned_body"] == 0 < stands["peak_rotation"].max()
    # no door lets it in
    moved.x.acceleration.setflags(write=True)
    moved.x.acceleration[-1] = np.nan
    lost = ContactRun(case, 1e-4).work["outcome"]
    assert lost["overturned_body"] > 0
    assert lost["paradoxes"] > stands["paradoxes"]
