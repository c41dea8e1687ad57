"""Bodies and motions of the tests with friction, integrated by the planar kernels alone."""

import math
from dataclasses import replace

import numpy as np

from rockfrag.base.units import GRAVITY
from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.outcomes.response import Response
from rockfrag.simulation.inputs import ground_motion
from rockfrag.simulation.options import system_of
from rockfrag.system import Block, Body, Column, Stack, as_system
from rockfrag.system.contact import checked_friction
from rockfrag.system.system import System

DT = 0.01
G = 9.81


def random_block(
    rng: np.random.Generator,
    width=None,
    slenderness=(1.2, 5.0),
    mass=(5, 500),
    middle=(0.4, 0.6),
) -> Block:
    """Block drawn from ranges of slenderness, mass [kg] and height of its centre, which is off the middle."""
    width = width or rng.uniform(0.1, 1.0)
    height = width * rng.uniform(*slenderness)
    masses, centre = rng.uniform(*mass), height * rng.uniform(*middle)
    return Block(width, height, masses, None, centre, rng.uniform(-0.1, 0.1) * width)


def random_stack(rng: np.random.Generator) -> Stack:
    """General stack: centres of gravity off the middle, an uneven base, an offset."""
    size = [rng.uniform(*limits) for limits in ((0.3, 0.6), (0.2, 0.8), (20, 200))]
    aside, lean = rng.uniform(-0.02, 0.02), rng.uniform(-0.01, 0.01)
    lower = Block(*size, cg_offset=aside, lean=lean)
    width = rng.uniform(0.3, 0.9) * lower.width
    upper = random_block(rng, width, (1.5, 5), (5, 100), (0.35, 0.6))
    return Stack(lower, upper, offset=rng.uniform(-0.01, 0.01))


def random_contacts(rng: np.random.Generator, body: Body) -> System:
    """Body with coefficients of 0.15 to 0.9 for each interface."""
    return with_contacts(body, rng.uniform(0.15, 0.9, 2).tolist())


def run(
    thing,
    motion,
    dt=DT,
    *,
    friction=None,
    vertical=None,
    omega0=None,
    closing=1e-6,
    g=GRAVITY,
):
    """Simulate a system by the contact kernels, never by pure rocking, until it rests or has fallen."""
    system = system_of(thing, friction, omega0=omega0)
    case = Case(system, ground_motion(motion, dt, vertical), request=Request(g=g))
    return ContactRun(case, closing).response()


def imbalance(response: Response) -> float:
    """What the balance of energy does not close by, over weight times height or the largest work [-]."""
    masses = [body.mass for body in response.system.bodies]
    energy, heights = response.energy, response.position[0, :, 1]
    unit = max(G * float(masses @ heights), float(energy["input"].abs().max()))
    return float(energy["residual"].abs().max()) / unit


def samples_until(response: Response, contact_event: int) -> int:
    """Number of samples before a contact event; all if there are fewer."""
    times = response.contact_events["time"]
    until = times.iloc[contact_event] if len(times) > contact_event else math.inf
    return int(np.searchsorted(response.time, until))


def random_column(rng: np.random.Generator, bodies: int) -> Column:
    """Draw a column that narrows upwards a little, centres off the middle, uneven bases."""
    blocks, offsets = [], []
    width = rng.uniform(0.3, 1.0)
    for k in range(bodies):
        height = width * rng.uniform(0.3, 3.0)
        mass = rng.uniform(300, 3000) * width**2 * height
        centre = height * rng.uniform(0.4, 0.6), rng.uniform(-0.03, 0.03) * width
        blocks.append(
            Block(width, height, mass, None, *centre, rng.uniform(-0.003, 0.003))
        )
        if k:
            offsets.append(rng.uniform(-0.02, 0.02) * width)
        width *= rng.uniform(0.7, 1.05)
    return Column(tuple(blocks), tuple(offsets))


def with_contacts(thing, frictions, laws=None):
    """Give the contacts of a system their friction and laws."""
    system = as_system(thing)
    laws = laws or [contact.law for contact in system.contacts]
    contacts = (
        replace(contact, friction=checked_friction("friction", friction), law=law)
        for contact, friction, law in zip(
            system.contacts, frictions, laws, strict=False
        )
    )
    return replace(system, contacts=tuple(contacts))
