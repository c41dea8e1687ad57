"""Of very many motions the same answers come at a fraction of the cost."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.pedestal import censored, mixed, permutation
from rockfrag.pedestal.cluster_means import mean_effect, without_each_event
from rockfrag.pedestal.paired_tests import pair_tests


def ladder(events: int) -> pd.DataFrame:
    """Three motions an event, one object, amplitudes read from a ladder of 5 %."""
    rng = np.random.default_rng(2)
    rows = []
    for k in range(3 * events):
        shared = 0.3 * rng.normal()
        for side, shift in (("NP", 0.0), ("P", 0.08)):
            rung = np.floor((shared + shift + 0.1 * rng.normal()) / np.log(1.05))
            rows.append(
                {
                    "object": "T",
                    "pedestal": side,
                    "event": f"e{k // 3:02d}",
                    "floor": "ground",
                    "motion": f"m{k}",
                    "lower_g": 0.4 * 1.05**rung,
                    "upper_g": 0.4 * 1.05 ** (rung + 1),
                    "amplitude_g": 0.4 * 1.05**rung,
                }
            )
    return pd.DataFrame(rows)


def test_the_linear_jackknife_has_the_limits_of_the_refitted_one(monkeypatch):
    tests = ladder(12)
    refitted = censored.fit_censored(tests).effect
    monkeypatch.setattr(censored, "MOST_REFITTED", 1)
    linear = censored.fit_censored(tests).effect
    assert linear.mean == refitted.mean
    assert linear.se == pytest.approx(refitted.se, rel=0.02)
    assert linear.units == 12


def test_pairs_that_are_alike_weigh_as_many(monkeypatch):
    tests = ladder(12)
    known = censored.fit_censored(tests)
    monkeypatch.setattr(censored, "MOST_PAIRS", 1)
    found = censored.fit_censored(tests)
    assert found.loglik == pytest.approx(known.loglik, rel=1e-6)
    assert found.effect.mean == pytest.approx(known.effect.mean, abs=1e-4)


def test_signed_ranks_of_many_are_those_of_few():
    values = np.round(np.random.default_rng(1).normal(0.1, 1.0, 300), 2)
    known, found = permutation.wilcoxon_exact(values), permutation._wilcoxon_of_many(values, 0.95)
    assert found.p == pytest.approx(known.p, abs=2e-3)
    assert found.estimate == pytest.approx(known.estimate, abs=1e-12)
    assert (found.lower, found.upper) == pytest.approx((known.lower, known.upper), abs=0.011)


def test_each_event_is_left_out_as_if_it_had_not_been():
    rng = np.random.default_rng(3)
    table = pd.DataFrame(
        {
            "event": np.repeat(["a", "b", "c", "d"], 6),
            "motion": np.repeat([f"m{k}" for k in range(12)], 2),
            "d": np.round(rng.normal(0, 0.1, 24), 1),
            "resolution": 0.05,
        }
    )
    for name, one in without_each_event(table).items():
        assert one == mean_effect(table[table["event"] != name])


def test_events_with_equal_floors_are_solved_for_together(monkeypatch):
    pairs = pair_tests(ladder(12)).table
    known = mixed.fit_mixed(pairs, mixed.EFFECT)
    monkeypatch.setattr(mixed, "MOST_APART", 1)
    found = mixed.fit_mixed(pairs, mixed.EFFECT)
    assert found.coefficients.iloc[0]["se"] == pytest.approx(known.coefficients.iloc[0]["se"])
    assert found.sd_event == pytest.approx(known.sd_event, rel=1e-3)


def test_flipped_signs_of_many_are_those_that_are_drawn(monkeypatch):
    values = np.random.default_rng(4).normal(0.08, 1.0, 400)
    drawn = permutation.sign_flip_test(values)
    monkeypatch.setattr(permutation, "MOST_EXACT", 100)
    assert permutation.sign_flip_test(values).p == pytest.approx(drawn.p, abs=0.015)


def test_flipped_signs_of_few_are_all_counted():
    # of the eight patterns four have sums of three or more
    found = permutation.sign_flip_test([1.0, 2.0, 0.0])
    assert (found.p, found.exact) == (0.5, True)
