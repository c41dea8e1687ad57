"""The surface of toppling velocities over size: what it says of sizes, limits and what it was not fitted to."""

from itertools import product

import numpy as np
import pytest

from rockfrag import InputError
from rockfrag.fragility.model_error import BIASES
from rockfrag.fragility.toppling_velocity import (
    LIMITS,
    MEASURES,
    STANDINGS,
    surface_of,
    surfaces,
    toppling_velocity,
)
from rockfrag.simulation.closed_forms import kaneko_acceleration, kaneko_velocity

WIDTHS, HEIGHTS = np.meshgrid(np.geomspace(0.1, 0.8, 8), np.geomspace(0.3, 3.0, 9))
INSIDE = HEIGHTS / WIDTHS >= 1.25

P58 = {0.737: 0.724, 1.041: 0.493, 1.422: 0.361, 1.803: 0.290, 2.064: 0.251}
"""Bookcases of FEMA P-58, 0.321 m deep: height [m] and median peak floor velocity [m/s]."""


def kaneko(width, height):
    return np.vectorize(kaneko_velocity)(width, height)


@pytest.mark.parametrize("standing", ["plane", "square", "oblong"])
def test_medians_follow_kaneko_within_a_tenth_over_size_and_slenderness(standing):
    medians, _ = toppling_velocity(WIDTHS, HEIGHTS, standing=standing)
    slender = INSIDE & (HEIGHTS / WIDTHS >= 2)
    ratio = np.log(medians / kaneko(WIDTHS, HEIGHTS))[slender]
    assert ratio.std() < 0.1
    assert np.abs(ratio - ratio.mean()).max() < 0.25


@pytest.mark.parametrize("standing", ["plane", "square"])
def test_medians_over_those_of_p58_are_flat_within_a_tenth(standing):
    heights = np.array(list(P58))
    medians, _ = toppling_velocity(0.321, heights, standing=standing)
    ratio = medians / np.array(list(P58.values()))
    assert np.abs(ratio / ratio.mean() - 1).max() < 0.1


@pytest.mark.parametrize("standing", ["plane", "square"])
def test_the_stated_bias_of_cut_blocks_is_that_of_the_surface(standing):
    heights = np.array(list(P58))
    medians, _ = toppling_velocity(0.321, heights, standing=standing)
    published = kaneko(0.321, heights), np.array(list(P58.values()))
    logs = [np.log(medians / each).mean() for each in published]
    stated = BIASES[standing]
    assert stated.bias == pytest.approx(np.mean(logs), abs=0.03)
    assert stated.error > abs(logs[1] - logs[0]) / 2 - 0.01


def test_both_forms_of_kaneko_meet_at_the_boundary_frequency():
    width, height = 0.4, 1.5
    boundary = 15.6 / np.sqrt(100 * height) * (1 + width / height) ** -1.5
    by_velocity = 2 * np.pi * boundary * kaneko_velocity(width, height)
    assert by_velocity == pytest.approx(kaneko_acceleration(width, height), rel=2e-3)


def test_wider_blocks_need_more_and_higher_ones_of_the_same_slenderness_too():
    medians, _ = toppling_velocity(np.geomspace(0.1, 0.8, 20), 2.0)
    assert (np.diff(medians) > 0).all()
    heights = np.geomspace(0.4, 3.0, 20)
    medians, _ = toppling_velocity(heights / 4, heights)
    assert (np.diff(medians) > 0).all()


@pytest.mark.parametrize("standing", STANDINGS)
@pytest.mark.parametrize("measure", MEASURES)
def test_larger_rotations_need_more(standing, measure):
    medians = [
        toppling_velocity(
            WIDTHS, HEIGHTS, standing=standing, limit=limit, measure=measure
        )[0]
        for limit in LIMITS
    ]
    slender = INSIDE & (HEIGHTS / WIDTHS >= 2)
    steps = np.diff(np.log([each[slender] for each in medians]), axis=0)
    # each surface is within its error of the medians, of neighbouring limits much the same
    assert (steps > -0.02).all()
    assert (steps.sum(axis=0) > 0.05).all()


def test_both_components_rock_a_base_at_less_of_their_mean_than_one_alone_does():
    """By the geometric mean of both: one of them is above it, and both add up towards the edge of a round base."""

    def rocks(standing: str) -> np.ndarray:
        medians, _ = toppling_velocity(
            WIDTHS, HEIGHTS, standing=standing, limit=0.01, measure="pga_g"
        )
        return medians[INSIDE]

    plane, square, around = map(rocks, ("plane", "square", "round"))
    assert (square < plane).all() and (around < square).all()
    # two equal components at once would lift a round base at 1 / √2
    assert (around > plane / np.sqrt(2) - 0.1 * plane).all()


def test_the_least_rotation_needs_the_acceleration_of_uplift():
    medians, _ = toppling_velocity(WIDTHS, HEIGHTS, limit=0.01, measure="pga_g")
    ratio = (medians * HEIGHTS / WIDTHS)[INSIDE]
    assert (ratio > 1).all()
    assert ratio.max() < 2.5


def test_sizes_outside_are_not_told_and_arrays_of_any_shape_are():
    medians, dispersions = toppling_velocity([[0.05], [0.3]], [0.2, 1.0, 4.0])
    assert medians.shape == dispersions.shape == (2, 3)
    assert np.isfinite(medians).tolist() == [[False] * 3, [False, True, False]]


def test_a_million_objects_are_one_look_up():
    widths = np.full(1_000_000, 0.3)
    medians, _ = toppling_velocity(widths, 1.0)
    assert medians.shape == (1_000_000,)
    assert (medians == medians[0]).all()


def test_the_surface_states_its_error():
    assert {key[0] for key in surfaces()} == set(STANDINGS)
    for standing, measure in product(STANDINGS, MEASURES):
        surface = surface_of(standing, 1.0, measure)
        assert 0 < surface.residual < surface.largest < 0.2
        assert 0.02 < surface.earthquakes < 0.1


@pytest.mark.parametrize("standing", STANDINGS)
def test_where_nothing_is_said_it_is_the_velocity_that_topples(standing):
    assert surface_of(standing) is surface_of(standing, 1.0, "pgv_m_s")


def test_an_unknown_limit_is_refused_with_those_that_are():
    with pytest.raises(InputError, match=r"0\.01, 0\.05"):
        toppling_velocity(0.3, 1.0, limit=0.33)


def test_medians_have_the_shape_of_the_sizes():
    sizes = (0.32, 1.8), ([0.3], [1.2]), (np.full((2, 1), 0.3), [1.2, 1.3, 1.4])
    for (width, height), shape in zip(sizes, ((), (1,), (2, 3)), strict=True):
        for found in toppling_velocity(width, height):
            assert found.shape == shape
