"""Closed forms against independently computed figures and against the reference integrator."""

import math

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack
from rockfrag.rocking import closed_forms as cf

from ..oracle import closed_forms as formulas
from ..oracle.rocking_integrator import simulate_reference
from .reference_bodies import T1, T2, T3, TOWERS, P, random_motion, uniform

G = 9.81


@pytest.mark.parametrize(
    ("block", "e", "p"),
    [
        (T1, 0.850000, 6.12589),
        (T2, 0.911765, 5.36484),
        (T3, 0.942308, 4.82421),
        (P, 0.341494, 7.27928),
    ],
)
def test_restitution_and_frequency_of_the_specimens(block: Block, e: float, p: float) -> None:
    assert block.momentum_restitution() == pytest.approx(e, abs=1e-6)
    assert block.frequency() == pytest.approx(p, abs=1e-5)


@pytest.mark.parametrize(
    ("upper", "e", "p"), [(T1, 0.8289, 5.092), (T2, 0.8809, 4.631), (T3, 0.9138, 4.2655)]
)
def test_restitution_and_frequency_of_the_stacks_as_one_body(
    upper: Block, e: float, p: float
) -> None:
    whole = Stack(P, upper).rigidly_joined()
    assert whole.momentum_restitution() == pytest.approx(e, abs=5e-4)
    assert whole.frequency() == pytest.approx(p, abs=5e-4)


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        (T1, (0.45260, 0.85993, 1.95447)),
        (T2, (0.51681, 0.98192, 2.23173)),
        (T3, (0.57472, 1.09196, 2.48184)),
    ],
)
def test_period_grows_with_amplitude(block: Block, expected: tuple[float, ...]) -> None:
    for ratio, period in zip((0.2, 0.5, 0.9), expected, strict=True):
        found = formulas.free_period(ratio * block.alpha, block.alpha, block.frequency())
        assert found == pytest.approx(period, abs=1e-5)


def test_rotation_vanishes_after_a_quarter_period() -> None:
    theta0, alpha, p = 0.1, T2.alpha, T2.frequency()
    quarter = formulas.free_period(theta0, alpha, p) / 4
    start, end = formulas.free_rotation([0.0, quarter], theta0, alpha, p)
    assert start == pytest.approx(theta0, abs=1e-15)
    assert end == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize(
    ("block", "expected"), zip(TOWERS, (0.215637, 0.245912, 0.273302), strict=True)
)
def test_exact_quarter_period(block: Block, expected: float) -> None:
    found = formulas.quarter_period(0.5 * block.alpha, block.alpha, block.frequency())
    assert found == pytest.approx(expected, abs=1e-5)


def test_amplitudes_decay_with_restitution() -> None:
    phi = 0.5
    for expected in (0.38639, 0.30596, 0.24560):
        phi = formulas.next_amplitude(phi, T2.momentum_restitution())
        assert phi == pytest.approx(expected, abs=1e-5)


def test_rectangular_pulse() -> None:
    x = cf.rectangular_pulse(1.0, 1.0)
    assert x == pytest.approx(1.58198, abs=1e-4)
    assert math.cosh(0.7) == pytest.approx(
        1 + 1 / (2 * (y := cf.rectangular_pulse(0.7, 1.0)) * (y - 1)), rel=1e-12
    )


@pytest.mark.parametrize(
    ("function", "ratio", "expected"),
    [
        (cf.half_sine_pulse, 1.0, 1.3224),
        (cf.half_sine_pulse, 3.0, 2.2939),
        (cf.one_sine_pulse, 2.0, 2.3499),
        (cf.one_sine_pulse, 5.0, 7.1681),
    ],
)
def test_sine_pulses(function: object, ratio: float, expected: float) -> None:
    assert function(2.14 * ratio, 2.14) == pytest.approx(expected, abs=1e-3)  # type: ignore[operator]


def test_housner_s_half_sine_is_too_high() -> None:
    assert formulas.housner_half_sine(3.0, 1.0) == pytest.approx(math.sqrt(10))
    assert formulas.housner_half_sine(3.0, 1.0) > cf.half_sine_pulse(3.0, 1.0)


P0, ALPHA = 2.14, 0.25
BLOCK = uniform(P0, ALPHA)

DECIDED = 12 / P0
"""Time after a pulse by which a block a thousandth off its balance has fallen or come down [s]."""


def pulse(shape: str, ratio: float, samples: int = 161) -> tuple[np.ndarray, float]:
    """Pulse of unit amplitude x, and its sampling interval."""
    omega = ratio * P0
    end = (math.pi if shape == "half-sine" else 2 * math.pi) / omega
    t = np.linspace(0.0, end, samples)
    wave = np.cos(omega * t) if shape == "cosine" else np.sin(omega * t)
    return ALPHA * G * wave, float(t[1])


@pytest.mark.parametrize(
    ("shape", "ratio", "x"),
    [
        ("half-sine", 1.0, cf.half_sine_pulse(P0, P0)),
        ("half-sine", 3.0, cf.half_sine_pulse(3 * P0, P0)),
        ("sine", 2.0, cf.one_sine_pulse(2 * P0, P0)),
        ("cosine", 1.0, cf.one_cosine_pulse(P0, P0)),
    ],
)
def test_the_linear_block_overturns_above_the_closed_form_and_not_below(
    shape: str, ratio: float, x: float
) -> None:
    motion, dt = pulse(shape, ratio)
    for factor, falls in ((1 - 1e-3, False), (1 + 1e-3, True)):
        response = simulate_reference(
            BLOCK, factor * x * motion, dt, linear=True, duration=dt * motion.size + DECIDED
        )
        impacts = [e for e in response.contact_events if e.kind == "impact"]
        assert (response.overturned and not impacts) is falls
        assert falls or impacts


def test_a_rectangular_pulse_overturns_at_its_closed_form() -> None:
    duration = 1.0 / P0
    x = cf.rectangular_pulse(duration, P0)
    for factor, falls in ((1 - 1e-4, False), (1 + 1e-4, True)):
        motion = np.full(2, factor * x * ALPHA * G)  # zero after its last sample
        response = simulate_reference(BLOCK, motion, duration, linear=True)
        assert response.overturned is falls


def test_the_integral_criterion_agrees_with_simulation_for_any_motion() -> None:
    rng = np.random.default_rng(12)
    judged = 0
    while judged < 4:
        t = np.arange(60) * 0.02
        motion = random_motion(rng, 60, 0.02) + 2.0 * np.sin(math.pi * t / t[-1])

        def excess(x: float, motion: np.ndarray = motion) -> float:
            return formulas.no_impact(x * motion, 0.02, ALPHA, P0).value - 1

        x = next((x for x in np.arange(0.3, 6, 0.1) if excess(x) > 0), None)
        if x is None:
            continue
        low, high = x - 0.1, x
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (low, middle) if excess(middle) > 0 else (middle, high)
        if formulas.no_impact(high * motion, 0.02, ALPHA, P0).impact:
            continue
        judged += 1
        for factor, falls in ((1 - 1e-4, False), (1 + 1e-4, True)):
            criterion = formulas.no_impact(factor * high * motion, 0.02, ALPHA, P0)
            response = simulate_reference(BLOCK, factor * high * motion, 0.02, linear=True)
            without = not any(e.kind == "impact" for e in response.contact_events)
            assert criterion.overturns is falls
            assert (response.overturned and without) is falls
            assert response.contact_events[0].time == pytest.approx(criterion.start, abs=1e-9)
            assert response.contact_events[0].after == (criterion.pivot,)


def test_a_motion_below_the_threshold_moves_nothing() -> None:
    judged = formulas.no_impact([0.0, 0.9 * ALPHA * G, 0.0], 0.1, ALPHA, P0)
    assert judged.pivot == 0
    assert not judged.overturns


def test_a_block_that_comes_down_first_is_not_judged() -> None:
    t = np.arange(400) * 0.01
    motion = 1.3 * ALPHA * G * np.sin(2 * math.pi * t / 0.4)
    assert formulas.no_impact(motion, 0.01, ALPHA, P0).impact


@pytest.mark.parametrize(
    ("linear", "resurrections"),
    [(True, (3.0186, 6.3181, 7.1681)), (False, (3.032, 6.743, 7.493))],
)
def test_one_sine_overturns_in_a_window_and_again_above_it(
    linear: bool, resurrections: tuple[float, float, float]
) -> None:
    motion, dt = pulse("sine", 5.0, 161)
    begin, end, again = resurrections
    expected = ((begin, False, True), (end, True, False), (again, False, True))
    for x, below, above in expected:
        for factor, falls in ((0.998, below), (1.002, above)):
            response = simulate_reference(
                *(BLOCK, factor * x * motion, dt),
                restitution=0.9,
                linear=linear,
                duration=dt * motion.size + DECIDED,
            )
            assert response.overturned is falls
            # after an impact without shaking nothing has the energy to overturn any more
            assert falls or response.contact_events[-1].time > dt * motion.size


def test_no_simulated_block_overturns_below_ishiyamas_bounds() -> None:
    rng = np.random.default_rng(14)
    fallen = 0
    for _ in range(12):
        block = uniform(rng.uniform(2.5, 5), rng.uniform(0.12, 0.3))
        motion = random_motion(rng, 200, 0.01)
        velocity = np.concatenate([[0], np.cumsum((motion[1:] + motion[:-1]) / 2 * 0.01)])
        bounds = formulas.ishiyama_bounds(block)
        if simulate_reference(block, motion, 0.01, duration=4.0).overturned:
            fallen += 1
            assert np.abs(motion).max() >= bounds.acceleration
            # the bound is an envelope of simulations of earthquakes: it is met within a tenth
            assert np.abs(velocity).max() >= 0.9 * bounds.velocity
    assert fallen >= 3


def test_housners_velocity_is_of_the_order_of_fema_s_vertical_files() -> None:
    inch = 0.0254
    for depth, median in ((15, 0.498), (24, 1.229)):
        file = Block(depth * inch, 52 * inch, 100.0)
        found = cf.housner_velocity(file.alpha, file.frequency())
        assert median / 2 < found < 2 * median


def test_west_is_the_threshold_of_motion() -> None:
    assert formulas.west_acceleration(T2) == pytest.approx(9.81 / 4)
