"""Many systems × motions × amplitudes at once, with friction, flight and vertical motion."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.contract import Cases as Grid
from rockfrag.engines.lanes import intervals_of
from rockfrag.engines.planar import records
from rockfrag.engines.planar.integrate import Book, Cases, integrate_cases
from rockfrag.engines.steps import free_samples, step_count
from rockfrag.system.system import System

COARSE_CLOSING = 1e-4
"""Parting speed over √(g b) below which a contact stays closed after an impact, where only the outcome matters."""

CHUNK = 4  # cases that a thread takes at once


def contact_outcomes(grid: Grid, wanted: NDArray[np.bool_] | None = None) -> NDArray[np.void]:
    """Integrate the ``wanted`` cases of systems × motions × scales, all if None; the others are left zero."""
    g, step, dts = grid.request.g, grid.request.step, intervals_of(grid)
    wanted = np.ones(grid.shape, dtype=bool) if wanted is None else wanted
    table = np.zeros(len(grid.systems), records.BODY)
    starts = np.zeros((len(grid.systems), 2, 3 * records.MOST))
    for i, system in enumerate(grid.systems):
        table[i] = records.system_record(system, g)
        starts[i] = records.posed(table[i], *started(system))
    ups = [motion.z.acceleration for motion in grid.motions if motion.z is not None]
    sizes = [motion.x.acceleration.size for motion in grid.motions]
    cases = Cases(
        bodies=table,
        starts=starts,
        horizontal=np.concatenate([motion.x.acceleration for motion in grid.motions]),
        vertical=np.concatenate(ups) if ups else np.zeros(0),
        offsets=np.concatenate([[0], np.cumsum(sizes)]),
        dts=dts,
        factors=grid.scales,
        substeps=np.array([step_count(system, dts, g, step) for system in grid.systems]),
        free_samples=np.array([free_samples(system, dts, g) for system in grid.systems]),
    )
    outcome = np.zeros(wanted.size, records.OUTCOME)
    numbers = np.flatnonzero(wanted)
    book = Book(np.zeros((0, 0)), np.zeros((0, 0)))

    firsts = iter(range(0, numbers.size, CHUNK))

    def work(memory: np.void) -> None:
        for first in firsts:
            chunk = numbers[first : first + CHUNK]
            integrate_cases(chunk, cases, COARSE_CLOSING, book, memory, outcome)

    memories = [records.working_memory() for _ in range(grid.threads)]
    integrate_cases(numbers[:0], cases, COARSE_CLOSING, book, memories[0], outcome)
    if grid.threads == 1:
        work(memories[0])
    else:
        with ThreadPoolExecutor(grid.threads) as pool:
            list(pool.map(work, memories))
    return outcome.reshape(wanted.shape)


def started(system: System) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Rotations [rad] and angular velocities [rad/s] of the bodies at the start."""
    zeros = (0.0,) * system.count
    return (
        (zeros, zeros) if system.start is None else (system.start.rotation, system.start.velocity)
    )
