"""Bodies and states for kernels of pure rocking, called one by one as plain Python, and the oracle's models."""

import itertools

import numpy as np

from rockfrag.simulation.options import system_of

from ...mutants.plain import plain_library
from ...oracle.rocking_model import LinearModel, Model
from ..planar.cases import G, random_stack

with plain_library():
    from rockfrag.engines.pure_rocking.ensembles import body_record
    from rockfrag.engines.pure_rocking.kernels import (
        chatter,
        contact_states,
        demand,
        dormand_prince,
        impact,
        record,
        roots,
        single,
        taylor,
    )
    from rockfrag.engines.pure_rocking.kernels import equations as eq
    from rockfrag.engines.pure_rocking.kernels import laws as kernel_laws
    from rockfrag.laws import laws

# what is imported plain is so once: modules of tests take it from here
__all__ = [
    "PULL",
    "STATES",
    "body_record",
    "chatter",
    "contact_states",
    "demand",
    "dormand_prince",
    "drawn_motion",
    "eq",
    "impact",
    "kernel_laws",
    "laws",
    "plain",
    "record",
    "roots",
    "single",
    "stacks",
    "state_of",
    "taylor",
]

STATES = [c for c in itertools.product((1, -1, 0), repeat=2) if any(c)]
PULL = (1.3, 8.7)  # acceleration of the ground, and gravity with its upward one [m/s²]


def plain(made):
    """A record whose fields are attributes."""
    return np.array([made]).view(np.recarray)[0]


def state_of(c, theta, omega, pull=PULL):
    """A state of the kernels."""
    made = plain(np.zeros(1, eq.STATE)[0])
    made.c1, made.c2 = c
    made.theta1, made.theta2 = theta
    made.omega1, made.omega2 = omega
    made.ground, made.gravity = pull
    return made


def stacks(seed, count, linear=False):
    """Random stacks as the kernels know them, and as the oracle does."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        stack = random_stack(rng)
        body = plain(body_record(system_of(stack), linear, G))
        yield rng, body, (LinearModel if linear else Model)(stack, G)


def drawn_motion(rng, c):
    """Rotations and rates of a contact state."""
    opens, opening = (
        np.array(c) * rng.uniform(0, 0.3, 2),
        (np.array(c) != 0) * rng.normal(size=2),
    )
    return opens.cumsum(), opening.cumsum()
