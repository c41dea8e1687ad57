"""The fast kernel beside a plain event-driven integrator and time stepping, under made and measured motions."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from rockfrag import read_motion
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.system import Block, Column

from ..oracle.contact_reference import simulate_reference
from ..oracle.time_stepping import time_stepping
from ..rocking.reference_bodies import random_motion
from .cases import (
    DT,
    G,
    as_friction,
    is_critical,
    random_block,
    random_column,
    random_frictions,
    random_stack,
    simulate_with_friction,
    with_contacts,
)


def case(rng: np.random.Generator, bodies: int) -> tuple:
    """Draw so many bodies, their frictions, and a motion with a vertical part."""
    if bodies > 2:
        column, mus = random_column(rng, bodies), tuple(rng.uniform(0.3, 0.8, bodies).tolist())
        return column, mus, random_motion(rng), 0.3 * random_motion(rng)
    body = random_stack(rng) if bodies == 2 else random_block(rng)
    return body, random_frictions(rng, body), random_motion(rng), 0.5 * random_motion(rng)


LENGTH = 3.2
"""How long the reference integrates, a little more than the motions last [s]."""


ONE_AND_TWO = pytest.mark.parametrize("bodies", [1, 2], ids=["blocks", "stacks"])


@pytest.mark.parametrize(
    ("bodies", "cases", "seed", "least"),
    [
        *((1, 4, 20, 2), (2, 4, 20, 2), (3, 1, 6, 1)),
        *(pytest.param(n, 60, 21, 30, marks=pytest.mark.slow) for n in (1, 2)),
        pytest.param(3, 3, 6, 2, marks=pytest.mark.slow),
    ],
)
def test_histories_are_those_of_the_reference(bodies, cases, seed, least):
    """Up to the eighth contact event, of columns up to the sixth.

    The reference, which takes a second for a hundred contact events, stops soon after the last contact event up
    to which histories are compared; outcomes are those up to then.
    """
    rng, eventful, last = np.random.default_rng(seed), 0, 8 if bodies < 3 else 6
    for _ in range(cases):
        body, mus, motion, up = case(rng, bodies)
        fast = simulate_with_friction(body, motion, DT, friction=as_friction(mus), vertical=up)
        length = LENGTH
        if len(fast.contact_events) > last + 2:
            length = min(LENGTH, fast.contact_events["time"].iloc[last + 2] + 2 * DT)
        plain = simulate_reference(body, motion, DT, duration=length, friction=mus, vertical=up)
        times = [contact_event.time for contact_event in plain.contact_events]
        assert len(times) > last or length == LENGTH
        until = times[last] if len(times) > last else math.inf
        n = min(np.searchsorted(plain.time, until), len(plain.time) - 1, len(fast.time) - 1)
        np.testing.assert_allclose(fast.theta[:n], plain.theta[:n], atol=2e-6)
        np.testing.assert_allclose(fast.slip[:n], plain.slip[:n], atol=2e-6)
        eventful += len(times) > 4
        assert plain.overturned == (fast.overturned and fast.overturning_time < length)
    assert eventful >= least


def compare_with_stepping(cases, bodies, seed, step):
    """Beside time stepping: outcomes that differ, falls, slips that differ [m], and turns that do [rad].

    Slips are those left of what stands, turns those up to the fourth contact event.
    """
    rng = np.random.default_rng(seed)
    differing = fallen = 0
    slips, turns = [], []
    for _ in range(cases):
        body, mus, motion, up = case(rng, bodies)
        fast = simulate_with_friction(body, motion, DT, friction=as_friction(mus), vertical=up)
        fell, _, _, rows = time_stepping(body, motion, DT, mus, step=step, vertical=up)
        fallen += fast.overturned
        times = fast.contact_events["time"].tolist()
        until = np.searchsorted(fast.time, times[3] if len(times) > 3 else math.inf)
        n = min(int(until), len(rows), len(fast.time))
        rotation = rows[:n, [3 * k + 2 for k in range(len(mus))]]
        turns.append(float(np.abs(rotation - fast.theta[:n]).max(initial=0.0)))
        if fell != fast.overturned:
            differing += 1
        elif not fell:
            start = 3 * (len(mus) - 1)
            moved = rows[-1, start] - rows[0, start]
            slips.append(abs(float(moved - fast.slip[-1].sum())))
    return differing, fallen, np.array(slips), np.array(turns)


@ONE_AND_TWO
def test_outcomes_are_those_of_time_stepping(bodies):
    differing, fallen, slips, turns = compare_with_stepping(
        5 if bodies == 2 else 8, bodies, 25, 1e-4
    )
    assert differing <= 1 <= fallen
    assert np.median(slips) < 1e-3
    assert np.median(turns) < 1e-4


@pytest.mark.slow
@ONE_AND_TWO
def test_two_hundred_cases_are_those_of_time_stepping(bodies):
    differing, fallen, slips, turns = compare_with_stepping(200, bodies, 23, 2e-5)
    assert differing <= 6 and 20 <= fallen <= 180
    assert np.median(slips) < 1e-5
    # some graze: there the time of a contact event hangs on a root, and the stepping's error is as large
    assert np.median(turns) < 1e-5
    assert (turns > 1e-3).sum() <= 4


@pytest.mark.slow
@ONE_AND_TWO
def test_histories_of_time_stepping_converge_to_those_of_contact_events(bodies):
    coarse, fine = (compare_with_stepping(15, bodies, 29, step)[3] for step in (8e-5, 1e-5))
    moving = coarse > 1e-6
    assert moving.sum() > 5
    assert np.median(fine[moving] / coarse[moving]) < 0.25


RECORDS = ("Kobe", "Northridge", "Friuli", "Loma_Prieta")


class Case(NamedTuple):
    """A column, its coefficients of friction from below, and what shakes it [m/s²]."""

    column: Column
    friction: tuple[float, ...]
    horizontal: np.ndarray
    vertical: np.ndarray
    dt: float

    def falls(self) -> bool:
        """Whether it falls by the public door."""
        friction = {"ground": self.friction[0], "interface": list(self.friction[1:])}
        found = overturns(
            self.column, [self.horizontal], self.dt, friction=[friction], vertical=[self.vertical]
        )
        return bool(found.overturned.item())

    def falls_by_stepping(self, step: float) -> bool:
        """Whether it falls by time stepping."""
        return time_stepping(
            self.column, self.horizontal, self.dt, self.friction, step=step, vertical=self.vertical
        )[0]

    def is_critical(self) -> bool:
        """Whether a hundredth more or less of the motions changes the outcome."""
        system = with_contacts(self.column, list(self.friction))
        return is_critical(system, self.horizontal, self.dt, self.vertical)


def drawn_column(rng: np.random.Generator) -> Column:
    """Narrowing blocks, drums, a statue on steps or blocks that overhang, uneven and off the middle."""
    bodies, kind = int(rng.integers(3, 9)), int(rng.integers(4))
    blocks: list[Block] = []
    offsets: list[float] = []
    width = rng.uniform(0.3, 1.2)
    for k in range(bodies):
        top = (1.5, 4.0) if k == bodies - 1 else (0.15, 1.0)
        heights, narrows = (
            ((0.2, 2.5), (0.65, 1.05)),
            ((0.5, 0.9), (0.94, 1.0)),
            (top, (0.6, 0.9)),
            ((0.2, 1.5), (0.7, 1.3)),
        )[kind]
        height = width * rng.uniform(*heights)
        mass = rng.uniform(500, 3000) * width**2 * height
        aside, lean = rng.uniform(-0.05, 0.05) * width, rng.uniform(-0.01, 0.01)
        middle = height * rng.uniform(0.4, 0.6)
        blocks.append(Block(width, height, mass, cg_height=middle, cg_offset=aside, lean=lean))
        if k:
            offsets.append(rng.uniform(-0.04, 0.04) * min(width, blocks[-2].width))
        width *= rng.uniform(*narrows)
    return Column(tuple(blocks), tuple(offsets))


def eight_seconds(record: Motion) -> tuple[np.ndarray, float]:
    """Strong part of a record, faded in and out, and its sampling interval [s]."""
    values, dt = record.acceleration, record.dt
    begin = int(np.argmax(np.cumsum(values**2) > 0.02 * np.sum(values**2)))
    part, fade = values[begin : begin + int(8 / dt)].copy(), int(0.2 / dt)
    part[:fade] *= np.linspace(0, 1, fade)
    part[-fade:] *= np.linspace(1, 0, fade)
    return part, dt


def pulse(rng: np.random.Generator) -> tuple[np.ndarray, float]:
    """A few whole sines, and the sampling interval [s]."""
    period, dt = rng.uniform(0.3, 1.5), 0.01
    time = np.arange(0, rng.integers(1, 4) * period, dt)
    return np.sin(2 * np.pi * time / period), dt


def drawn_case(rng: np.random.Generator, records: list[Motion]) -> Case:
    """Draw a column with friction under a motion that may throw it, some with a vertical one."""
    column = drawn_column(rng)
    known = rng.uniform() < 0.7
    values, dt = eight_seconds(records[int(rng.integers(4))]) if known else pulse(rng)
    slim = min(b.width / b.height for b in column.blocks)
    whole = column.blocks[0].width / sum(b.height for b in column.blocks)
    values = values * G * min(slim, whole) * rng.uniform(1.0, 4.5) / np.abs(values).max()
    up = 0.4 * np.roll(values, 7) if rng.uniform() < 0.3 else np.zeros(values.size)
    return Case(column, tuple(rng.uniform(0.3, 0.8, len(column.blocks))), values, up, dt)


def beside_stepping(cases: list[Case], coarse: float, fine: float) -> tuple[int, list, list]:
    """Count the falls; the cases whose outcomes differ from those of coarse time stepping, and of fine too."""
    fell = [case.falls() for case in cases]
    differ = [i for i, case in enumerate(cases) if case.falls_by_stepping(coarse) != fell[i]]
    finer = [cases[i] for i in differ if cases[i].falls_by_stepping(fine) != fell[i]]
    print(
        f"{sum(fell)} of {len(cases)} fall; differ at {coarse}: {differ}, at {fine}: {len(finer)}"
    )
    return sum(fell), [cases[i] for i in differ], finer


def narrowing(rng: np.random.Generator, bodies: int) -> Case:
    """Draw a column that narrows upwards a little, under a strong motion."""
    column, mus = random_column(rng, bodies), tuple(rng.uniform(0.2, 0.9, bodies))
    return Case(column, mus, 2.5 * random_motion(rng), 0.3 * random_motion(rng), DT)


@pytest.mark.slow
def test_outcomes_of_many_columns_are_those_of_time_stepping() -> None:
    (short, off, _), (long, off_too, _) = (
        beside_stepping([narrowing(rng, n) for n in bodies], 2e-4, 2e-5)
        for rng, bodies in ((np.random.default_rng(8), (3, 4) * 100), (np.random.default_rng(8), (8,) * 50))
    )  # fmt: skip
    assert len(off) + len(off_too) <= 0.03 * 250
    assert 50 <= short <= 150 and 12 <= long <= 47


def test_outcomes_of_columns_are_those_of_time_stepping() -> None:
    rng = np.random.default_rng(7)
    fallen, differ, _ = beside_stepping([narrowing(rng, 3) for _ in range(6)], 2e-4, 2e-5)
    assert len(differ) <= 1 <= fallen


@pytest.mark.slow
def test_columns_of_strangers_fall_as_in_time_stepping(shared: Path) -> None:
    records = [read_motion(shared / "records" / f"{name}.dat") for name in RECORDS]
    rng = np.random.default_rng(1)
    cases = [drawn_case(rng, records) for _ in range(120)]
    fallen, differ, finer = beside_stepping(cases, 1e-4, 1e-5)
    assert 30 <= fallen <= 90
    assert len(finer) <= 0.03 * len(cases)
    assert all(case.is_critical() for case in differ)
