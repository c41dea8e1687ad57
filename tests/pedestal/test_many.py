"""Of very many motions the same answers come at a fraction of the cost."""

import numpy as np
import pytest

from rockfrag.pedestal import permutation


def test_flipped_signs_of_many_are_those_that_are_drawn(monkeypatch):
    values = np.random.default_rng(4).normal(0.08, 1.0, 400)
    drawn = permutation.sign_flip_test(values)
    monkeypatch.setattr(permutation, "MOST_DRAWN", 100)
    assert permutation.sign_flip_test(values).p == pytest.approx(drawn.p, abs=0.015)


def test_flipped_signs_of_few_are_all_counted():
    # of the eight patterns four have sums of three or more
    found = permutation.sign_flip_test([1.0, 2.0, 0.0])
    assert (found.p, found.exact) == (0.5, True)
