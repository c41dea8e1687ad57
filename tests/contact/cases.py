"""Bodies and motions of the tests with friction, integrated by the planar kernels alone."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rockfrag.engines.contract import Case, Request
from rockfrag.engines.planar.cases import contact_run, response_of
from rockfrag.engines.planar.integrate import (
    Book,
    Shaking,
    contact_event_columns,
    history_columns,
    integrate,
)
from rockfrag.engines.planar.records import posed, system_record, working_memory
from rockfrag.rocking.inputs import ground_motion
from rockfrag.rocking.options import system_of
from rockfrag.system import Block, Body, Column, Stack, System, as_system
from rockfrag.system.contact import Contact, checked_friction
from rockfrag.units import GRAVITY

STILL = np.zeros(50)
DT = 0.01


def random_block(rng: np.random.Generator) -> Block:
    """Block of any slenderness, its centre of gravity off the middle."""
    width = rng.uniform(0.1, 1.0)
    height = width * rng.uniform(1.2, 5.0)
    return Block(
        width,
        height,
        rng.uniform(5, 500),
        cg_height=height * rng.uniform(0.4, 0.6),
        cg_offset=rng.uniform(-0.1, 0.1) * width,
    )


def random_stack(rng: np.random.Generator) -> Stack:
    """General stack: centres of gravity off the middle, an uneven base, an offset."""
    lower = Block(
        rng.uniform(0.3, 0.6),
        rng.uniform(0.2, 0.8),
        rng.uniform(20, 200),
        cg_offset=rng.uniform(-0.02, 0.02),
        lean=rng.uniform(-0.01, 0.01),
    )
    width = rng.uniform(0.3, 0.9) * lower.width
    height = width * rng.uniform(1.5, 5)
    upper = Block(
        width,
        height,
        rng.uniform(5, 100),
        cg_height=height * rng.uniform(0.35, 0.6),
        cg_offset=rng.uniform(-0.1, 0.1) * width,
    )
    return Stack(lower, upper, offset=rng.uniform(-0.01, 0.01))


def random_frictions(rng: np.random.Generator, body: Body) -> tuple[float, ...]:
    """Coefficients of 0.15 to 0.9 for each interface."""
    mus = rng.uniform(0.15, 0.9, 2)
    return (float(mus[0]),) if isinstance(body, Block) else (float(mus[0]), float(mus[1]))


def as_friction(mus: tuple[float, ...]) -> float | tuple[float, ...]:
    """Frictions as `simulate` takes them."""
    return mus[0] if len(mus) == 1 else mus


def simulate_with_friction(
    body, acceleration, dt, *, friction, vertical=None, omega0=None, g=GRAVITY
):
    """Simulate what :func:`rockfrag.rocking.simulate` does, never by pure rocking."""
    system = system_of(body, friction, omega0=omega0)
    motion = ground_motion(acceleration, dt, vertical)
    return response_of(contact_run(Case(system, motion, request=Request(g=g)), 1e-6))


G = 9.81


class Found(NamedTuple):
    """What came out: histories at the samples, shape (n, bodies), and counts."""

    system: System
    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    slip: np.ndarray
    residual: np.ndarray
    contact_events: np.ndarray
    fallen: int
    when: float
    work: np.void

    @property
    def theta(self) -> np.ndarray:
        return self.position[:, 2::3]


def random_column(rng: np.random.Generator, bodies: int) -> Column:
    """Draw a column that narrows upwards a little, centres off the middle, uneven bases."""
    blocks, offsets = [], []
    width = rng.uniform(0.3, 1.0)
    for k in range(bodies):
        height = width * rng.uniform(0.3, 3.0)
        mass = rng.uniform(300, 3000) * width**2 * height
        centre = height * rng.uniform(0.4, 0.6), rng.uniform(-0.03, 0.03) * width
        blocks.append(Block(width, height, mass, None, *centre, rng.uniform(-0.003, 0.003)))
        if k:
            offsets.append(rng.uniform(-0.02, 0.02) * width)
        width *= rng.uniform(0.7, 1.05)
    return Column(tuple(blocks), tuple(offsets))


def with_contacts(thing, frictions, laws=None):
    """Give the contacts of a system their friction and laws."""
    system = as_system(thing)
    contacts = []
    for k, contact in enumerate(system.contacts):
        assert isinstance(contact, Contact)
        changed = replace(contact, friction=checked_friction("friction", frictions[k]))
        contacts.append(replace(changed, law=laws[k]) if laws else changed)
    return replace(system, contacts=tuple(contacts))


def run(system, motion, dt=DT, *, vertical=None, theta=None, closing=1e-06, substeps=2, free=800):
    """Integrate a system through a motion and on until it rests or has fallen."""
    p, w, n = system_record(system, G), working_memory(), system.count
    start = posed(p, theta or [0.0] * n, [0.0] * n)
    up = np.zeros(0) if vertical is None else vertical
    history = np.zeros((motion.size + free, history_columns(n)))
    contact_events = np.zeros((100_000, contact_event_columns(n)))
    done, count, when = integrate(
        p,
        Shaking(motion, up, dt, 1.0, substeps, free),
        start,
        closing,
        Book(history, contact_events),
        w,
    )
    history = history[:done]
    q, v = history[:, : 3 * n], history[:, 3 * n : 6 * n]
    kinetic = (0.5 / p["inverse"][: 3 * n] * v**2).sum(axis=1)
    potential = G * (p["mass"][:n] * q[:, 1::3]).sum(axis=1)
    work, rubbed, struck = history[:, -4:-1].T
    total = kinetic + potential - work + rubbed + struck
    unit = max(G * float(p["mass"][:n] @ p["standing"][1 : 3 * n : 3]), float(np.abs(work).max()))
    return Found(
        system, np.arange(done) * dt, q, v, history[:, 6 * n : 7 * n], (total - total[0]) / unit,
        contact_events[:count], int(w["fallen"]), float(when), w,
    )  # fmt: skip


def is_critical(system: System, motion: np.ndarray, dt: float, vertical: np.ndarray) -> bool:
    """Whether up to a hundredth more or less of the motions changes whether the system falls."""
    factors = 1 + 0.01 * np.array(
        [0, -1, 1, -0.5, 0.5, -0.2, 0.2, -0.1, 0.1, -0.05, 0.05, -0.02, 0.02]
    )
    fell = {
        run(system, f * motion, dt, vertical=f * vertical, closing=1e-4).fallen > 0 for f in factors
    }
    return len(fell) == 2
