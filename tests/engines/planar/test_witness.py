"""Every impact before a witness that knows the change of momentum and nothing of how it was found."""

import numpy as np
import pytest

from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.simulation.inputs import ground_motion
from rockfrag.system import System

from ...oracle import witness
from ...simulation.reference_bodies import random_motion
from .cases import DT, G, random_column, with_contacts

SHUT = 30.0
"""What shutting slow ends asks of impulses at most, over mass and closing speed; speeds come to less [-]."""


def worst_violations(
    system: System, motion, up, closing: float
) -> tuple[dict[str, float], int]:
    """How far the contact events of a history break each law, over what shutting may ask; number of events."""
    case = Case(system, ground_motion(motion, DT, up), request=Request(g=G))
    events, count = ContactRun(case, closing).contact_events, system.count
    column, worst = witness.Column.of(system, G), {}
    for event in events:
        state = (event[name][: 3 * count] for name in ("q", "v_before", "v_after"))
        impact = witness.Impact(*(values.reshape(count, 3) for values in state))
        for law, value in witness.violations(column, impact).items():
            worst[law] = max(worst.get(law, 0.0), value / (SHUT * closing))
    return worst, len(events)


@pytest.mark.parametrize("seed", [11, 25])
def test_what_is_shut_after_an_impact_of_five_bodies_slides_on(seed: int) -> None:
    """An end that parts by micrometres a second is shut, and once took slips away by T of 1.5 N."""
    rng = np.random.default_rng(seed)
    column = random_column(rng, 5)
    system = with_contacts(column, list(rng.uniform(0.3, 0.7, 5)))
    worst, events = worst_violations(system, 2 * random_motion(rng), None, 1e-6)
    assert events > 50
    assert max(worst.values()) < 1
