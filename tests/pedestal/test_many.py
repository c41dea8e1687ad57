"""Of very many motions the same answers come at a fraction of the cost."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.pedestal import censored, permutation


def intensity_levels(earthquakes: int) -> pd.DataFrame:
    """Three motions an earthquake, one object, amplitudes read from a series of 5 %."""
    rng = np.random.default_rng(2)
    rows = []
    for k in range(3 * earthquakes):
        shared = 0.3 * rng.normal()
        for side, shift in (("NP", 0.0), ("P", 0.08)):
            level = np.floor((shared + shift + 0.1 * rng.normal()) / np.log(1.05))
            rows.append(
                {
                    "object": "T",
                    "pedestal": side,
                    "earthquake": f"e{k // 3:02d}",
                    "floor": "ground",
                    "motion": f"m{k}",
                    "lower_g": 0.4 * 1.05**level,
                    "upper_g": 0.4 * 1.05 ** (level + 1),
                    "amplitude_g": 0.4 * 1.05**level,
                }
            )
    return pd.DataFrame(rows)


def test_the_linear_jackknife_has_the_limits_of_the_refitted_one(monkeypatch):
    tests = intensity_levels(12)
    refitted = censored.fit_censored(tests).effect
    monkeypatch.setattr(censored, "MOST_REFITTED", 1)
    linear = censored.fit_censored(tests).effect
    assert linear.mean == refitted.mean
    assert linear.se == pytest.approx(refitted.se, rel=0.02)
    assert linear.units == 12


def test_pairs_that_are_alike_weigh_as_many(monkeypatch):
    tests = intensity_levels(12)
    known = censored.fit_censored(tests)
    monkeypatch.setattr(censored, "MOST_PAIRS", 1)
    found = censored.fit_censored(tests)
    assert found.loglik == pytest.approx(known.loglik, rel=1e-6)
    assert found.effect.mean == pytest.approx(known.effect.mean, abs=1e-4)


def test_flipped_signs_of_many_are_those_that_are_drawn(monkeypatch):
    values = np.random.default_rng(4).normal(0.08, 1.0, 400)
    drawn = permutation.sign_flip_test(values)
    monkeypatch.setattr(permutation, "MOST_DRAWN", 100)
    assert permutation.sign_flip_test(values).p == pytest.approx(drawn.p, abs=0.015)


def test_flipped_signs_of_few_are_all_counted():
    # of the eight patterns four have sums of three or more
    found = permutation.sign_flip_test([1.0, 2.0, 0.0])
    assert (found.p, found.exact) == (0.5, True)
