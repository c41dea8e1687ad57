"""The fast kernel beside a plain event-driven integrator and time stepping, under made and measured motions."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest

from rockfrag import read_motion
from rockfrag.engines.planar.engine import closing_of
from rockfrag.outcomes.response import Response
from rockfrag.records.motion import Motion
from rockfrag.system import Block, Body, Column, as_system

from ...oracle.contact_reference import simulate_reference
from ...oracle.time_stepping import time_stepping
from ...simulation.reference_bodies import random_motion
from . import cases as drawn
from .cases import DT, G


class Case(NamedTuple):
    """A body, its coefficients of friction from below, and what shakes it [m/s²]."""

    body: Body | Column
    friction: tuple[float, ...]
    horizontal: np.ndarray
    vertical: np.ndarray
    dt: float = DT

    def history(self, factor: float = 1.0, closing: float = 1e-6) -> Response:
        """By the planar kernels, of motions times a factor."""
        system, up = (
            drawn.with_contacts(self.body, self.friction),
            factor * self.vertical,
        )
        return drawn.run(
            system, factor * self.horizontal, self.dt, vertical=up, closing=closing
        )

    def stepped(self, step: float) -> tuple:
        """By time stepping."""
        return time_stepping(
            self.body,
            self.horizontal,
            self.dt,
            self.friction,
            step=step,
            vertical=self.vertical,
        )

    def is_critical(self) -> bool:
        """Whether a hundredth more or less of the motions changes the outcome."""
        factors = (
            1 + 0.01 * np.outer([1, -1], [0.0, 1, 0.5, 0.2, 0.1, 0.05, 0.02]).ravel()
        )
        return len({self.history(f, closing=1e-4).overturned for f in factors}) == 2


def random_case(rng: np.random.Generator, bodies: int) -> Case:
    """Draw so many bodies, columns narrow upwards a little, and a motion with a vertical part."""
    if bodies > 2:
        column, mus = (
            drawn.random_column(rng, bodies),
            tuple(rng.uniform(0.2, 0.9, bodies)),
        )
        return Case(column, mus, 2.5 * random_motion(rng), 0.3 * random_motion(rng))
    body = drawn.random_stack(rng) if bodies == 2 else drawn.random_block(rng)
    mus = tuple(rng.uniform(0.15, 0.9, 2)[:bodies])
    return Case(body, mus, random_motion(rng), 0.5 * random_motion(rng))


# how long the reference integrates, a little more than the motions last [s]
LENGTH = 3.2


@pytest.mark.parametrize(
    ("bodies", "cases", "seed", "least"),
    [
        *((1, 2, 20, 1), (2, 2, 20, 1)),
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
        case = random_case(rng, bodies)
        fast, length = case.history(), LENGTH
        if len(fast.contact_events) > last + 2:
            length = min(LENGTH, fast.contact_events["time"].iloc[last + 2] + 2 * DT)
        more = {
            "friction": case.friction,
            "vertical": case.vertical,
            "duration": length,
        }
        plain = simulate_reference(case.body, case.horizontal, DT, **more)
        times = [contact_event.time for contact_event in plain.contact_events]
        assert len(times) > last or length == LENGTH
        until = times[last] if len(times) > last else math.inf
        n = min(
            np.searchsorted(plain.time, until), len(plain.time) - 1, len(fast.time) - 1
        )
        np.testing.assert_allclose(fast.theta[:n], plain.theta[:n], atol=2e-6)
        np.testing.assert_allclose(fast.slip[:n], plain.slip[:n], atol=2e-6)
        eventful += len(times) > 4
        assert plain.overturned == (fast.overturned and fast.overturning_time < length)
    assert eventful >= least


def beside_stepping(cases: list[Case], step: float) -> pd.DataFrame:
    """Whether each case falls and does not in time stepping, and what turns [rad] and slips [m] differ by.

    Outcomes are with the closing speed that users get.  Slips are those left of what stands, turns those up to the
    fourth contact event; both with hardly any closing.
    """
    rows = []
    for case in cases:
        fast = case.history()
        falls = case.history(closing=closing_of(as_system(case.body))).overturned
        fell, _, _, stepped = case.stepped(step)
        n = min(drawn.samples_until(fast, 3), len(stepped), len(fast.time))
        turn = np.abs(
            stepped[:n, 2 : fast.theta.shape[1] * 3 : 3] - fast.theta[:n]
        ).max(initial=0.0)
        start, stands = 3 * (fast.theta.shape[1] - 1), not (fell or fast.overturned)
        moved = stepped[-1, start] - stepped[0, start] - fast.slip[-1].sum()
        rows.append(
            (
                falls,
                fell != falls,
                turn,
                abs(moved) if stands else None,
            )
        )
    return pd.DataFrame(rows, columns=["falls", "differs", "turn", "slip"])


@pytest.mark.parametrize(
    ("bodies", "seed", "step", "differing", "falls"),
    [
        ((1,) * 8, 25, 1e-4, 1, (1, 7)),
        ((2,) * 5, 25, 1e-4, 1, (1, 4)),
        ((3,) * 6, 7, 2e-4, 1, (1, 5)),
        pytest.param((1, 2), 31, 5e-6, 0, (0, 2), marks=pytest.mark.slow),
        pytest.param((1,) * 200, 23, 2e-5, 6, (20, 180), marks=pytest.mark.slow),
        pytest.param((2,) * 200, 23, 2e-5, 6, (20, 180), marks=pytest.mark.slow),
        pytest.param((3, 4) * 100, 8, 2e-4, 4, (50, 150), marks=pytest.mark.slow),
        pytest.param((8,) * 50, 8, 2e-4, 3, (12, 47), marks=pytest.mark.slow),
        pytest.param(
            (4, 5, 6, 7, 8) * 100, 9, 2e-5, 10, (100, 450), marks=pytest.mark.slow
        ),
    ],
    ids=lambda value: f"{len(value)} of {value[0]}" if isinstance(value, tuple) else "",
)
def test_outcomes_are_those_of_time_stepping(bodies, seed, step, differing, falls):
    """Of columns of four to eight one in fifty differs, at 20 µs and at 200 µs: the stepping is not of one mind.

    Of eight that differ at 20 µs three end otherwise at 10 µs, one of them as before at 5 µs; the others but for
    it hang on a hundredth of the motion, as 41 of the 500 do.
    """
    rng = np.random.default_rng(seed)
    cases = [random_case(rng, n) for n in bodies]
    found = beside_stepping(cases, step)
    assert found["differs"].sum() <= differing
    if bodies[0] > 3:
        # no step is short enough for columns that rock for long: what differs may only hang on a hundredth of
        # the motion, or on the step
        assert all(
            case.is_critical() or case.stepped(step)[0] != case.stepped(step / 2)[0]
            for case, differs in zip(cases, found["differs"], strict=True)
            if differs
        )
    assert falls[0] <= found["falls"].sum() <= falls[1]
    # some graze: there the time of a contact event hangs on a root, and the stepping's error is as large
    assert found["turn"].median() < step / 2
    if bodies[0] < 3:
        assert found["slip"].median() < step / 2
        assert (found["turn"] > 1e-3).sum() <= max(1, 0.02 * len(bodies))


RECORDS = ("Kobe", "Northridge", "Friuli", "Loma_Prieta")


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
        blocks.append(
            Block(width, height, mass, cg_height=middle, cg_offset=aside, lean=lean)
        )
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
    values = (
        values * G * min(slim, whole) * rng.uniform(1.0, 4.5) / np.abs(values).max()
    )
    up = 0.4 * np.roll(values, 7) if rng.uniform() < 0.3 else np.zeros(values.size)
    return Case(
        column, tuple(rng.uniform(0.3, 0.8, len(column.blocks))), values, up, dt
    )


@pytest.mark.slow
def test_columns_of_strangers_fall_as_in_time_stepping(shared: Path) -> None:
    records = [read_motion(shared / "records" / f"{name}.dat") for name in RECORDS]
    rng = np.random.default_rng(1)
    cases = [drawn_case(rng, records) for _ in range(120)]
    found = beside_stepping(cases, 1e-4)
    assert 30 <= found["falls"].sum() <= 90
    differ = [
        case for case, differs in zip(cases, found["differs"], strict=True) if differs
    ]
    assert beside_stepping(differ, 1e-5)["differs"].sum() <= 0.03 * len(cases)
    assert all(case.is_critical() for case in differ)
