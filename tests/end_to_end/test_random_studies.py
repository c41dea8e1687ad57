"""No combination of a study's keys ends in a traceback, and no report contradicts its tables."""

import random

import pandas as pd
import pytest

from .asking_studies import draw, fate, wrong_limits


@pytest.mark.parametrize("number", (9, 15, 21))
def test_random_studies_end_with_a_report_or_are_refused_in_a_sentence(number, tmp_path):
    assert fate(draw(random.Random(f"0 {number}")), tmp_path)[1] == []


def test_the_checker_sees_limits_that_do_not_hold_their_estimate():
    table = pd.DataFrame({"theta": [0.3], "theta_lower": [0.1], "theta_upper": [0.2]})
    assert len(wrong_limits(table)) == 1
    assert wrong_limits(table.assign(theta_upper=0.4)) == []
