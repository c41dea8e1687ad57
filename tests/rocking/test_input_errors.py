"""Absurd input gives one clear sentence, never a hang or a number."""

import math
import warnings

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.rocking import Block, Stack, overturns, simulate

T2 = Block(0.124, 0.496, 2.790)
STACK = Stack(Block(0.184, 0.208, 2.300), T2)
SHAKE = 4.0 * np.sin(np.arange(100) * 0.2)


@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
@pytest.mark.parametrize(
    ("acceleration", "dt", "message"),
    [
        ([], 0.01, "at least two samples, got 0"),
        ([3.0], 0.01, "at least two samples, got 1"),
        ([0.0, math.nan, 1.0], 0.01, "sample 1 is not a finite number"),
        ([0.0, 1.0, math.inf], 0.01, "sample 2 is not a finite number"),
        ([[0.0, 1.0]], 0.01, r"expected shape \(n,\)"),
        (["a", "b"], 0.01, "expected numbers"),
        (None, 0.01, "at least two samples"),
        ([0.0, 1e6], 0.01, "beyond any earthquake"),
        (SHAKE, 0.0, "dt: expected a positive number"),
        (SHAKE, -0.01, "dt: expected a positive number"),
        (SHAKE, math.nan, "dt: expected a positive number"),
        (SHAKE, math.inf, "dt: expected a positive number"),
        (SHAKE, "0.01", "dt: expected a positive number"),
        (SHAKE, 1e6, "too long"),
    ],
)
def test_a_motion_that_cannot_be_used(
    body: Block | Stack, acceleration: object, dt: object, message: str
) -> None:
    with pytest.raises(InputError, match=message) as caught:
        simulate(body, acceleration, dt)  # type: ignore[arg-type]
    assert str(caught.value).count(". ") == 0


@pytest.mark.parametrize(
    ("acceleration", "dt", "message"),
    [
        ([[]], 0.01, r"accelerations\[0\]: a motion needs at least two"),
        ([[1.0]], 0.01, r"accelerations\[0\]: a motion needs at least two"),
        ([SHAKE, [0.0, math.nan]], 0.01, r"accelerations\[1\]: sample 1"),
        ([SHAKE], 0.0, "dt: expected a positive"),
        ([SHAKE], math.nan, "dt: expected a positive"),
    ],
)
def test_an_ensemble_says_which_motion_cannot_be_used(
    acceleration: list[object], dt: float, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        overturns([T2, STACK], acceleration, dt, [1.0])  # type: ignore[arg-type]


@pytest.mark.parametrize("scales", [[math.nan], [math.inf], [[1.0], [2.0]], [[[1.0]]]])
def test_scales_that_make_no_sense(scales: list[object]) -> None:
    with pytest.raises(InputError, match="scales: expected finite"):
        overturns([T2], [SHAKE], 0.01, scales)  # type: ignore[arg-type]


@pytest.mark.parametrize("step", [0.0, -1.0, math.nan])
def test_a_step_that_makes_no_sense(step: float) -> None:
    with pytest.raises(InputError, match="step: expected a positive"):
        overturns([T2], [SHAKE], 0.01, [1.0], step=step)


@pytest.mark.parametrize(
    ("body", "restitution", "message"),
    [
        (T2, 1.01, "would gain energy"),
        (T2, -0.1, "would gain energy"),
        (T2, math.nan, "would gain energy"),
        (T2, (0.9, 0.9), "lone block takes one number"),
        (STACK, 0.9, "a pair"),
        (STACK, (0.9, 1.2), "restitution of the interface"),
        (STACK, (1.2, None), "restitution of the ground"),
        (STACK, (0.9,), "a pair"),
    ],
)
def test_restitution_that_gains_energy_or_does_not_fit(
    body: Block | Stack, restitution: object, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        simulate(body, SHAKE, 0.01, restitution=restitution)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=message):
        overturns([body], [SHAKE], 0.01, [1.0], restitution=[restitution])  # type: ignore[list-item]


@pytest.mark.parametrize("g", [0.0, -9.81, math.nan])
def test_gravity_must_pull(g: float) -> None:
    with pytest.raises(InputError, match="g must be"):
        simulate(T2, SHAKE, 0.01, g=g)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        ({"theta0": math.nan}, "theta0: expected 1 finite"),
        ({"theta0": (0.1, 0.1)}, "theta0: expected 1 finite"),
        ({"theta0": 2.0}, "lies on its side already"),
        ({"omega0": math.inf}, "omega0: expected 1 finite"),
    ],
)
def test_a_start_that_makes_no_sense(start: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulate(T2, SHAKE, 0.01, **start)  # type: ignore[arg-type]


def test_a_body_must_be_one() -> None:
    with pytest.raises(InputError, match="Block or a Stack"):
        simulate("T2", SHAKE, 0.01)  # type: ignore[arg-type]


@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_a_motion_in_g_is_warned_about_and_zeros_are_not(body: Block | Stack) -> None:
    with pytest.warns(UserWarning, match=r"multiply it by 9\.81"):
        simulate(body, 0.004 * SHAKE, 0.01)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(body, 0.0 * SHAKE, 0.01)
        simulate(body, SHAKE, 0.01)


@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_hostile_motions_end(body: Block | Stack) -> None:
    rng = np.random.default_rng(0)
    for values in (
        rng.normal(0, 1000, 200),
        np.tile([50.0, -50.0], 100),
        np.full(200, T2.b / T2.h * 9.81),
        np.r_[np.zeros(199), 1e4],
    ):
        response = simulate(body, values, 0.01)
        assert np.isfinite(response.theta).all()
        assert response.overturned in (True, False)
