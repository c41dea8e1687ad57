"""What holds a block must bear: closed forms against statics, momentum and integrated equations of motion."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockfrag import Block
from rockfrag.base.errors import InputError
from rockfrag.simulation import holding

G = 9.81
BUST = Block(0.3, 0.7, 60.0)
ASIDE = Block(0.3, 0.7, 60.0, cg_offset=0.02)


def pads(block: Block, a: float, up: float, half: float) -> tuple[float, float]:
    """Forces of a left and a right pad on a block that moves with the ground, from balance as two equations."""
    # upwards, and about the centre of gravity: shear at the base turns clockwise where the ground goes right
    x = block.cg_offset
    matrix = np.array([[1.0, 1.0], [half + x, -(half - x)]])
    return tuple(
        np.linalg.solve(matrix, [block.mass * (G + up), block.mass * a * block.h])
    )


@pytest.mark.parametrize("block", [BUST, ASIDE])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_bond_opens_where_the_pull_at_a_pad_is_all_it_holds(
    block: Block, side: float
) -> None:
    half, a, up = 0.12, 5.0 * side, -1.3
    needed = holding.bond_tension_needed(block, a, half, up)
    assert needed == pytest.approx(-2 * min(pads(block, a, up, half)), rel=1e-12)


def test_the_bond_that_a_motion_needs_breaks_at_its_peak() -> None:
    rng = np.random.default_rng(1)
    motion = 4.0 * rng.normal(size=200)
    for block in (BUST, ASIDE):
        needed = holding.bond_tension_needed(block, motion, 0.12)
        breaks = holding.bond_breaks_at(block, needed, 0.12)
        sides = [-motion.min(), motion.max()]
        peak = max(sides) if not block.cg_offset else sides[0]
        assert breaks == pytest.approx(peak, rel=1e-12)
    sheared = holding.bond_shear_needed(BUST, motion, 0.3)
    slides = holding.bond_slides_at(BUST, sheared, 0.3)
    assert slides == pytest.approx(np.abs(motion).max(), rel=1e-12)


def test_without_strength_a_bond_opens_as_the_base_does() -> None:
    assert holding.bond_breaks_at(BUST, 0.0, 0.15) == pytest.approx(0.15 / 0.35 * G)
    assert holding.bond_tension_needed(BUST, 0.15 / 0.35 * G, 0.15) < 1e-9
    assert holding.bond_tension_needed(BUST, [0.1, -0.2], 0.15) == 0


def test_a_layer_cracks_where_the_linear_stress_reaches_its_strength() -> None:
    depth, strength = 0.25, 2e4
    a = holding.layer_cracks_at(BUST, depth, strength)
    # stress over the layer, summed in strips: weight and moment must come out
    x = (np.arange(20_000) + 0.5) / 20_000 * BUST.width - BUST.width / 2
    area, inertia = BUST.width * depth, depth * BUST.width**3 / 12
    stress = BUST.mass * (-G / area + a * BUST.h * x / inertia)
    strip = depth * BUST.width / 20_000
    assert (stress * strip).sum() == pytest.approx(-BUST.mass * G)
    assert (stress * x * strip).sum() == pytest.approx(BUST.mass * a * BUST.h, rel=1e-6)
    assert stress.max() == pytest.approx(strength, rel=1e-3)


def test_a_layer_is_of_use_only_above_twice_the_mean_pressure() -> None:
    pressure = BUST.mass * G / (BUST.width * 0.25)
    lifts = BUST.width / (2 * BUST.h) * G
    assert holding.layer_cracks_at(BUST, 0.25, 1.99 * pressure) < lifts
    assert holding.layer_cracks_at(BUST, 0.25, 2.01 * pressure) > lifts


def test_a_bracket_bears_what_keeps_the_block_from_rising() -> None:
    # about the left edge: weight, inertia and the bracket's force balance, and nothing is left
    a, z, up = 6.0, 0.6, 0.7
    force = holding.bracket_force_needed(ASIDE, [a, 0.0], z, [up, 0.0])
    moment = ASIDE.mass * (a * ASIDE.h - (G + up) * (0.15 + 0.02)) - force * z
    assert moment == pytest.approx(0, abs=1e-9)
    other = holding.bracket_force_needed(ASIDE, -a, z, up)
    assert other > force > 0
    assert holding.bracket_force_needed(ASIDE, 1.0, z) == 0


@pytest.mark.parametrize("a", [0.0, 2.0, 8.0])
def test_a_cord_that_gets_taut_bears_the_peak_of_the_integrated_motion(
    a: float,
) -> None:
    k, z, rate = 4e4, 0.6, 0.3
    half, mass = BUST.width / 2, BUST.mass
    inertia = BUST.centroidal_inertia + mass * (half**2 + BUST.h**2)

    def turns(_: float, y: np.ndarray) -> list[float]:
        return [y[1], (mass * (a * BUST.h - G * half) - k * z * z * y[0]) / inertia]

    solved = solve_ivp(turns, (0, 0.3), [0.0, rate], rtol=1e-10, max_step=1e-4)
    peak = k * z * solved.y[0].max()
    assert holding.cord_peak_force(BUST, k, z, rate, a) == pytest.approx(peak, rel=1e-5)


def test_without_shaking_and_weight_a_cord_bears_the_momentum() -> None:
    inertia = BUST.centroidal_inertia + BUST.mass * (0.15**2 + 0.35**2)
    force = holding.cord_peak_force(BUST, 1e4, 0.6, 0.5, g=1e-12)
    assert force == pytest.approx(0.5 * math.sqrt(1e4 * inertia), rel=1e-9)


@pytest.mark.parametrize("height", [0.0, 0.05, 0.2])
def test_a_kerb_just_topples_by_momentum_and_energy(height: float) -> None:
    speed = holding.kerb_topples_from(BUST, height)
    above, half, mass = BUST.h - height, BUST.width / 2, BUST.mass
    # an impulse at the kerb's edge that stops it there: three unknowns, momentum each
    inertia = BUST.centroidal_inertia
    matrix = np.array(
        [
            [mass, 0.0, 0.0, -1.0, 0.0],
            [0.0, mass, 0.0, 0.0, -1.0],
            [0.0, 0.0, inertia, above, half],
            [1.0, 0.0, -above, 0.0, 0.0],
            [0.0, 1.0, -half, 0.0, 0.0],
        ]
    )
    u, v, omega, *_ = np.linalg.solve(matrix, [mass * speed, 0.0, 0.0, 0.0, 0.0])
    left = (mass * (u * u + v * v) + inertia * omega**2) / 2
    lift = mass * G * (math.hypot(half, above) - above)
    assert left == pytest.approx(lift, rel=1e-12)


def test_a_kerb_at_the_centre_does_not_trip() -> None:
    with pytest.raises(InputError, match="does not trip"):
        holding.kerb_topples_from(BUST, 0.35)


def test_a_wall_sends_the_point_that_meets_it_back_and_throws_the_foot_up() -> None:
    rate, z, e = 0.8, 0.7, 0.4
    impulse = holding.wall_impulse(BUST, z, rate, e)
    # about its right foot, turning clockwise towards a wall on the right
    u, spin = rate * BUST.h, rate
    after_u = u - impulse / BUST.mass
    after_spin = spin - impulse * (z - BUST.h) / BUST.centroidal_inertia
    met = after_u + after_spin * (z - BUST.h)
    assert met == pytest.approx(-e * rate * z, rel=1e-12)
    # the centre of gravity keeps its velocity across, and the foot turns more slowly: it goes up
    across = rate * BUST.width / 2
    foot = across - after_spin * BUST.width / 2
    assert foot > 0


def test_a_pivot_that_held_at_a_wall_would_have_to_pull() -> None:
    """P_x = (1 + e) ω (I_O/z - m h), P_y = -(1 + e) m b ω, from momentum along, upwards and about the centre."""
    rate, z, e, half, mass = 0.8, 0.6, 0.3, BUST.width / 2, BUST.mass
    inertia = BUST.centroidal_inertia + mass * (half**2 + BUST.h**2)
    # unknown: the wall's impulse (against x), and those of the pivot along and upwards
    matrix = [
        [-1.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        # clockwise about the centre; the pivot is below it on the right
        [-(z - BUST.h), -BUST.h, -half],
    ]
    change = (
        -(1 + e)
        * rate
        * np.array([mass * BUST.h, mass * half, BUST.centroidal_inertia])
    )
    wall, along, upwards = np.linalg.solve(matrix, change)
    assert wall == pytest.approx((1 + e) * rate * inertia / z, rel=1e-12)
    assert along == pytest.approx(
        (1 + e) * rate * (inertia / z - mass * BUST.h), rel=1e-12
    )
    assert upwards == pytest.approx(-(1 + e) * mass * half * rate, rel=1e-12)


def test_leaning_needs_the_friction_that_balance_asks_for() -> None:
    shelf = Block(0.3, 1.8, 90.0)
    gap = 0.5
    friction = holding.leaning_friction(shelf, 1.8, gap)
    angle = holding.leaning_angle(shelf, 1.8, gap)
    beyond = 0.9 * math.sin(angle) - 0.15 * math.cos(angle)
    wall = shelf.mass * G * beyond / (1.8 * math.cos(angle))
    assert friction == pytest.approx(wall / (shelf.mass * G), rel=1e-12)
    assert holding.leaning_friction(shelf, 1.8, 0.1) == 0
    with pytest.raises(InputError, match="out of reach"):
        holding.leaning_angle(shelf, 1.8, 2.0)


def test_an_isolator_has_its_period_and_hands_on_what_slope_and_slider_do() -> None:
    assert holding.isolator_period(1.0) == pytest.approx(2.00607, abs=1e-5)
    assert holding.isolator_transmits(1.0, 0.06, 0.18) == pytest.approx(0.24)
