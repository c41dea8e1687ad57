"""Columns of any number of bodies: limits, invariances, and a plain time stepping beside them."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from rockfrag.simulation import overturns
from rockfrag.system import Block, Column, System
from rockfrag.system.body import Interval, RigidBody
from rockfrag.system.contact import Contact

from ...oracle.cases import drum_column, drum_pulse
from ...oracle.rocking_integrator import simulate_reference as rock
from ...simulation.reference_bodies import random_motion
from .cases import DT, imbalance, random_column, run, samples_until, with_contacts


def on_a_foot(rng: np.random.Generator, bodies: int) -> tuple[System, Block]:
    """Wide bodies on one that has a narrow foot, so that no joint opens; and all of them as one block."""
    foot, wide = rng.uniform(0.04, 0.15), Interval(-2.0, 2.0)
    heights, masses = (
        rng.uniform(0.6, 1.2, bodies) / bodies,
        rng.uniform(20, 100, bodies),
    )
    inertias = masses * rng.uniform(0.02, 0.1, bodies)
    made = [
        RigidBody(
            m, i, (0.0, 0.0, h / 2), Interval(-foot, foot) if k == 0 else wide, h, wide
        )
        for k, (m, i, h) in enumerate(zip(masses, inertias, heights, strict=True))
    ]
    middles = np.cumsum(heights) - heights / 2
    centre = float(masses @ middles / masses.sum())
    inertia = float(inertias.sum() + masses @ (middles - centre) ** 2)
    whole = Block(2 * foot, float(heights.sum()), float(masses.sum()), inertia, centre)
    return System(tuple(made), (Contact(),) * bodies), whole


@pytest.mark.parametrize("bodies", [2, 3, 5, 12])
def test_joints_that_do_not_open_leave_one_block(bodies: int) -> None:
    rng = np.random.default_rng(bodies)
    fell = 0
    for _ in range(6):
        column, whole = on_a_foot(rng, bodies)
        motion = 2.5 * random_motion(rng)
        many, single = run(column, motion), run(whole.system(), motion)
        assert many.overturned or not single.overturned
        # a column that falls throws its bodies off
        opens = many.contact_events["modes"].map(
            lambda modes: set(modes[1:]) != {"stands"}
        )
        opening = many.contact_events["time"][opens].min()
        n = min(samples_until(single, 6), int(np.searchsorted(many.time, opening)))
        for k in range(bodies):
            np.testing.assert_allclose(
                many.theta[:n, k], single.theta[:n, 0], atol=1e-7
            )
        assert many.overturned == single.overturned
        fell += single.overturned
    assert 0 < fell < 6


def test_a_light_body_on_top_changes_the_others_in_proportion_to_its_mass():
    rng, compared = np.random.default_rng(2), 0
    for _ in range(8):
        column = random_column(rng, 2)
        mus, motion = list(rng.uniform(0.3, 0.8, 2)), random_motion(rng)
        bare = run(with_contacts(column, mus), motion)
        if len(bare.contact_events) < 4:
            continue
        differences = []
        for part in (1e-2, 1e-6):
            top = Block(0.5 * column.blocks[-1].width, 0.1, part * column.mass)
            capped = Column((*column.blocks, top), (*(column.offsets or ()), 0.0))
            found = run(with_contacts(capped, [*mus, 0.5]), motion)
            n = min(samples_until(bare, 4), len(found.time))
            differences.append(
                float(np.abs(found.theta[:n, :2] - bare.theta[:n]).max())
            )
        compared += 1
        assert differences[1] < 1e-4
        assert differences[1] <= 0.05 * differences[0] + 1e-9
    assert compared >= 3


def shaken_column(rng, bodies):
    """Draw a column with friction, a motion and a vertical one."""
    column = with_contacts(
        random_column(rng, bodies), list(rng.uniform(0.2, 0.9, bodies))
    )
    return column, random_motion(rng), 0.3 * random_motion(rng)


@pytest.mark.parametrize(
    ("bodies", "columns"),
    [(3, 4), (4, 3), (8, 1), pytest.param(12, 20, marks=pytest.mark.slow)],
)
def test_the_energy_balance_of_a_column_closes(bodies, columns):
    rng = np.random.default_rng(bodies)
    for _ in range(columns):
        column, motion, up = shaken_column(rng, bodies)
        assert imbalance(run(column, motion, vertical=up)) < 2e-8


@pytest.mark.slow
def test_sliding_that_jams_between_a_light_and_heavy_bodies_keeps_the_energy_balance():
    rng = np.random.default_rng(12)
    column, motion, up = [shaken_column(rng, 12) for _ in range(13)][-1]
    assert imbalance(run(column, motion[:60], vertical=up[:60])) < 2e-8


def mirrored(block: Block) -> Block:
    """The mirror image of a block."""
    return replace(block, cg_offset=-block.cg_offset, lean=-block.lean)


def grown(block: Block, ratio: float) -> Block:
    """The block with all its lengths times a ratio."""
    lengths = "width", "height", "cg_height", "cg_offset"
    sizes = {name: ratio * getattr(block, name) for name in lengths}
    return replace(block, mass=ratio**3 * block.mass, **sizes)


@pytest.mark.parametrize("bodies", [1, 2, 3, 5])
@pytest.mark.parametrize(
    ("alike", "ratio", "side", "off"),
    [
        (mirrored, 1.0, -1, 1e-9),
        *((partial(grown, ratio=ratio), ratio, 1, 1e-7) for ratio in (0.3, 4.0)),
    ],
)
def test_a_mirrored_or_larger_column_moves_alike(alike, ratio, side, off, bodies):
    """Lengths times λ, times times √λ, the same accelerations."""
    rng = np.random.default_rng(bodies)
    for _ in range(4):
        column = random_column(rng, bodies)
        offsets = tuple(side * ratio * x for x in column.offsets or ())
        twin = Column(tuple(map(alike, column.blocks)), offsets)
        mus, motion = list(rng.uniform(0.3, 0.8, bodies)), random_motion(rng)
        up = 0.5 * random_motion(rng)
        found = run(with_contacts(column, mus), motion, vertical=up)
        other = run(
            with_contacts(twin, mus), side * motion, DT * math.sqrt(ratio), vertical=up
        )
        n = samples_until(found, 5)
        np.testing.assert_allclose(found.theta[:n], side * other.theta[:n], atol=off)
        np.testing.assert_allclose(
            found.slip[:n], side * other.slip[:n] / ratio, atol=off
        )


def test_without_a_motion_a_column_rests_for_ever() -> None:
    rng = np.random.default_rng(4)
    for bodies in (1, 3, 7, 12):
        column = with_contacts(random_column(rng, bodies), [0.3] * bodies)
        found = run(column, np.zeros(50))
        assert (np.ptp(found.position, axis=0) == 0).all() and not found.overturned
        assert len(found.contact_events) <= 1


def test_contact_events_on_the_spot_do_not_stop_a_body_that_falls() -> None:
    # rough contacts: no mode is consistent shortly before the statue lies, and an impulse does not help
    statue = Block(0.42, 1.65, 410.0, cg_height=0.75, inertia=99.04575)
    column = Column((Block(0.8, 0.3, 480.0), Block(0.6, 0.9, 700.0), statue))
    time = np.arange(0, 6, DT)
    motion = 48 * np.sin(2 * np.pi * 5.72 * time) * np.sin(np.pi * time / 6) ** 2
    found = [run(column.system(), factor * motion) for factor in (1.1, 1.18, 1.3, 1.5)]
    # whether it falls hangs on a thousandth of the motion
    falls = [each for each in found if each.overturned]
    assert {each.overturned_body for each in falls} == {found[0].system.names[2]}
    for each in found:
        assert each.overturned or each.time[-1] >= time[-1]
        assert len(each.contact_events) < 400 * each.time[-1]


@pytest.mark.parametrize("seed", [4, 5])
def test_a_contact_too_rough_to_slide_takes_no_shear_without_pressure(
    seed: int,
) -> None:
    # a statue on a plate hardly narrower than the base below: rounding of the pressure once counted 10⁶ times
    statue = Block(0.4375, 1.22, 210.0, cg_height=0.5327, inertia=33.5)
    column = Column((Block(0.6, 0.8, 720.0), Block(0.45, 0.25, 126.5625), statue))
    motion = random_motion(np.random.default_rng(seed))
    found = run(column.system(), motion, closing=1e-4)
    assert imbalance(found) < 2e-8
    assert found.paradoxes > 0 and found.forced == 0
    assert len(found.contact_events) < 1000


def test_rough_columns_rock_as_the_plain_integrator_of_pure_rocking_says() -> None:
    rng = np.random.default_rng(9)
    for bodies in (3, 4):
        column, motion = random_column(rng, bodies), random_motion(rng)
        found = run(column.system(), motion)
        n = samples_until(found, 5)
        assert 20 < n < len(found.time)
        plain = rock(column, motion, DT, duration=n * DT)
        np.testing.assert_allclose(found.theta[:n], plain.theta[:n], atol=1e-6)


@pytest.mark.slow
def test_long_pulses_overturn_a_column_of_drums_at_less_than_short_ones() -> None:
    amplitudes, least = np.linspace(0.15, 1.2, 8), []
    for drums in (7, 1):
        motions = [9.81 * drum_pulse(duration, 0.005) for duration in (0.2, 0.45, 0.9)]
        scales = np.tile(amplitudes, (3, 1))
        fell = overturns(
            drum_column(drums), motions, 0.005, scales, friction=[0.6]
        ).overturned[0]
        least.append(
            [float(amplitudes[row][0]) if row.any() else math.inf for row in fell]
        )
    many, single = least
    # HybriDFEM's domain: nothing at 0.2 s, and a falling limit that nears the static one of b/h = 0.17
    assert many[0] == math.inf and many[1] >= many[2] >= 0.15
    assert single[1] >= single[2] >= 0.15
    assert many[2] <= 0.45
