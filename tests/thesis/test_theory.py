"""C1 to C24: what is exact comes out exactly, and what cannot be decided says why."""

import dataclasses
import math

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.rocking import Block, Stack, simulate
from rockfrag.thesis.specimens import THESIS_BODIES
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.theory import CHECKS, theory_claims
from rockfrag.thesis.statements.theory_blocks import _perturbed
from rockfrag.thesis.statements.theory_setting import bisect, make_setting, uplift_threshold, wilson
from rockfrag.thesis.statements.theory_spectra import _auc, _crossings, _discordance
from rockfrag.thesis.statements.theory_stacks import _free_fall


def made_motion(seed: int) -> Motion:
    """Broad-band shaking of 8 s under an envelope, peak 4 m/s²."""
    rng = np.random.default_rng(seed)
    t = np.arange(800) * 0.01
    waves = sum(
        rng.normal() / f * np.sin(2 * np.pi * f * t + rng.uniform(0, 2 * np.pi))
        for f in np.geomspace(0.3, 8, 24)
    )
    shape = waves * np.sin(np.pi * t / t[-1]) ** 2
    return Motion(4.0 * shape / np.abs(shape).max(), 0.01, f"made {seed}")


MOTIONS = [made_motion(seed) for seed in range(4)]


@pytest.fixture(scope="module")
def ledger() -> dict[int, ClaimResult]:
    return {one.number: one for one in theory_claims(THESIS_BODIES, MOTIONS, seed=7, threads=2)}


def test_every_statement_has_one_result_and_a_reason_if_undecided(
    ledger: dict[int, ClaimResult],
) -> None:
    assert list(ledger) == list(range(1, 25)) == list(CHECKS)
    for result in ledger.values():
        assert result.figure and result.test
        assert math.isnan(result.lower) or result.lower <= result.estimate <= result.upper


@pytest.mark.parametrize("number", [1, 2, 3, 4, 6, 7, 10, 13, 20, 21, 22, 23, 24])
def test_what_mechanics_settles_is_settled(ledger: dict[int, ClaimResult], number: int) -> None:
    assert ledger[number].verdict == "supported", ledger[number]


def test_printed_tables_agree_to_the_digit(ledger: dict[int, ClaimResult]) -> None:
    assert ledger[2].figure.startswith("9 of 9 figures agree")
    assert ledger[3].figure.startswith("12 of 12 figures agree")


def test_error_of_the_linearised_quarter_period(ledger: dict[int, ClaimResult]) -> None:
    assert "T1 0.30, T2 0.18, T3 0.11 %" in ledger[7].figure


def test_a_sudden_acceleration_starts_pattern_1_and_a_continuous_one_does_not(
    ledger: dict[int, ClaimResult],
) -> None:
    records, sudden = ledger[9].figure.split("sudden")
    assert "1a" not in records and "1b" not in records
    assert "1a" in sudden and "1b" in sudden
    assert ledger[9].verdict == "contradicted"


def test_the_statue_s_impact_lifts_the_pedestal_of_the_specimens(
    ledger: dict[int, ClaimResult],
) -> None:
    # eq. 2.85 with the specimens' numbers has θ1⁺ < 0 after an impact in 4a: it is 1b, never 4b
    assert "P&T1 1b, P&T2 1b, P&T3 1b" in ledger[12].figure
    assert ledger[12].verdict == "contradicted"


@pytest.mark.parametrize("name", ["T1", "T2", "T3"])
def test_the_thesis_s_own_formula_has_the_pedestal_lifted(name: str) -> None:
    # eq. 2.85 with θ2'⁻ on its right-hand sides; 1b is possible if θ1'⁺ has the sign of θ2'⁻
    one, two = THESIS_BODIES["P"], THESIS_BODIES[name]
    theta, beta = two.alpha, math.atan2(one.b - two.b, 2 * one.h)
    reach, up = math.hypot(one.b - two.b, 2 * one.h), 2 * one.h + two.h
    moment = two.mass * two.radius()
    c1 = two.pole_inertia()
    c2 = two.centroidal_inertia + moment * (up * math.cos(theta) - one.b * math.sin(theta))
    c3 = two.centroidal_inertia + moment * (up * math.cos(theta) + one.b * math.sin(theta))
    c4 = two.pole_inertia() - 2 * two.mass * two.b**2
    c5 = one.pole_inertia() + two.mass * reach * (up * math.cos(beta) + one.b * math.sin(beta))
    c6 = two.mass * reach * (two.h * math.cos(beta) + two.b * math.sin(beta))
    a = (c1 * c2 - c3 * c4) / (c5 * c1 - c3 * c6)
    b = (c6 * c2 - c5 * c4) / (c3 * c6 - c1 * c5)
    assert a > 0
    impact = _free_fall(Stack(one, two)).iloc[0]
    before, (after1, after2) = impact["omega_before"][1], impact["omega_after"]
    assert (impact["from"], impact["to"]) == ("4a", "1b")
    assert after1 == pytest.approx(a * before, rel=1e-9)
    assert after2 == pytest.approx(b * before, rel=1e-9)


def test_pedestals_of_random_stacks_come_to_rest_under_a_rocking_statue(
    ledger: dict[int, ClaimResult],
) -> None:
    assert "1a→4a" in ledger[11].figure
    assert ledger[11].verdict == "contradicted"


def test_without_a_measured_history_restitution_stays_undecided(
    ledger: dict[int, ClaimResult],
) -> None:
    assert ledger[5].verdict == "undecided"
    assert "without a measured history" in ledger[5].remark


def test_results_do_not_depend_on_threads_or_repetition(ledger: dict[int, ClaimResult]) -> None:
    again = theory_claims(THESIS_BODIES, MOTIONS, seed=7, threads=1)
    for one in again:
        for name in (field.name for field in dataclasses.fields(ClaimResult)):
            mine, other = getattr(one, name), getattr(ledger[one.number], name)
            assert mine == other or (mine != mine and other != other), (one.number, name)


def history(name: str, e: float) -> tuple[np.ndarray, np.ndarray]:
    block = THESIS_BODIES[name]
    response = simulate(block, np.zeros(400), 0.005, theta0=0.7 * block.alpha, restitution=e)
    noise = np.random.default_rng(5).normal(0, 0.001, 400)
    return response.time[:400], response.theta[:400, 0] + noise


@pytest.mark.parametrize(
    ("restitution", "verdict"), [(0.87, "supported"), (None, "contradicted")], ids=["real", "ideal"]
)
def test_measured_free_rocking_decides_about_restitution(
    restitution: float | None, verdict: str
) -> None:
    e = restitution or THESIS_BODIES["T3"].momentum_restitution()
    setting = make_setting(THESIS_BODIES, [], 1, {"T3": history("T3", e)})
    result = CHECKS[5](setting)
    assert (result.verdict, result.basis) == (verdict, "measured")
    assert result.lower <= e - THESIS_BODIES["T3"].momentum_restitution() <= result.upper


def test_an_unusable_history_is_the_users_error() -> None:
    with pytest.raises(InputError, match="one per time"):
        theory_claims(
            {"T3": THESIS_BODIES["T3"]}, [], seed=1, free_rocking={"T3": (np.arange(9), np.ones(8))}
        )


@pytest.mark.parametrize(
    ("specimens", "motions", "undecided"),
    [
        ({}, [], set(CHECKS)),
        ({"T1": THESIS_BODIES["T1"]}, [], set(CHECKS) - {1, 4, 6, 7, 20}),
        ({"T1": THESIS_BODIES["T1"]}, [Motion(np.zeros(10), 0.01)], set(CHECKS) - {1, 4, 6, 7, 20}),
    ],
    ids=["nothing", "one block", "no shaking"],
)
def test_what_the_data_cannot_say_is_undecided_with_the_reason(
    specimens: dict[str, Block], motions: list[Motion], undecided: set[int]
) -> None:
    for one in theory_claims(specimens, motions, seed=1):
        assert (one.verdict == "undecided") == (one.number in undecided), one
        if one.number in undecided:
            assert "not decidable" in one.remark


def test_printed_tables_say_nothing_about_other_specimens() -> None:
    other = {**THESIS_BODIES, "T1": Block(0.13, 0.372, 2.172)}
    for number in (2, 3):
        with pytest.raises(Exception, match="T1 differs"):
            CHECKS[number](make_setting(other, [], 1))


def test_area_under_the_curve_is_the_chance_of_the_right_order() -> None:
    measure, fell = np.array([1.0, 2.0, 2.0, 3.0]), np.array([False, True, False, True])
    # pairs (2,1) (2,2) (3,1) (3,2): three right and one tie
    assert _auc(measure, fell) == pytest.approx(3.5 / 4)
    assert math.isnan(_auc(measure, np.ones(4, dtype=bool)))


def test_orders_and_crossings_of_two_spectra() -> None:
    one = np.array([[1.0, 2.0, 3.0, 1.0], [2.0, 1.0, 1.0, 1.0]])
    other = np.array([[1.0, 2.0, 0.0, 1.0], [2.0, 1.0, 1.0, 2.0]])
    assert _discordance(one, other) == (1 / 3, 3)
    assert _crossings(one) == 1.0


def test_threshold_of_a_object_is_where_bisection_ends() -> None:
    assert bisect(lambda x: x >= 2.0, 1.0, 3.0) == pytest.approx(2.0, rel=1e-11)
    assert uplift_threshold(Block(1.0, 4.0, 1.0)) == pytest.approx(9.81 / 4, rel=1e-11)
    with pytest.raises(Exception, match="no threshold"):
        bisect(lambda x: False, 1.0, 3.0)


def test_wilson_limits_of_one_half() -> None:
    # Wilson (1927) for 5 of 10 at 95 %
    assert wilson(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)


def test_copies_stay_within_their_tolerances() -> None:
    block, rng = THESIS_BODIES["T2"], np.random.default_rng(0)
    for _ in range(50):
        copy, e = _perturbed(block, rng)
        assert abs(copy.width / block.width - 1) <= 0.01
        assert abs(copy.height / block.height - 1) <= 0.005
        assert abs(e - copy.momentum_restitution()) <= 0.02


@pytest.mark.slow
def test_thesis_motions_give_the_ledger(four_records: dict[str, Motion]) -> None:
    motions = list(four_records.values())
    results = {one.number: one for one in theory_claims(THESIS_BODIES, motions, seed=1)}
    for number in (14, 15, 17):
        assert results[number].verdict == "supported", results[number]
