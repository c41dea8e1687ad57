"""How far the impacts of a planar history break the laws that the witness asks."""

from collections import Counter

from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.simulation.inputs import ground_motion
from rockfrag.system import System

from ...oracle import witness
from .cases import DT, G

SHUT = 30.0
"""What shutting slow ends asks of impulses at most, over mass and closing speed; speeds come to less [-]."""


def impacts_of(system: System, events) -> list[witness.Impact]:
    """What the witness looks at, of contact events."""
    count, found = system.count, []
    for event in events:
        state = (event[name][: 3 * count] for name in ("q", "v_before", "v_after"))
        found.append(witness.Impact(*(values.reshape(count, 3) for values in state)))
    return found


def history_of(system: System, motion, up, closing: float) -> ContactRun:
    """History by the planar kernels."""
    case = Case(system, ground_motion(motion, DT, up), request=Request(g=G))
    return ContactRun(case, closing)


def worst_violations(system: System, events, closing: float) -> dict[str, float]:
    """How far contact events break each law at most, over what shutting may ask."""
    column, worst = witness.Column.of(system, G), Counter()
    for impact in impacts_of(system, events):
        for law, value in witness.violations(column, impact).items():
            worst[law] = max(worst[law], value / (SHUT * closing))
    return worst
