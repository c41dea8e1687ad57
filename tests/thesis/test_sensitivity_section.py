"""Perturbed parameters in words that stand in a sentence, and what is said of them."""

import re

import numpy as np
import pandas as pd
import pytest

from rockfrag_thesis.sections.sensitivity_analysis import (
    FACTORS,
    MOST_DRAWN,
    adjusted_words,
    perturbations,
    sensitivity_analysis_figure,
)
from rockfrag_thesis.sensitivity_analysis.simulated import REFERENCE


@pytest.mark.parametrize("factor", FACTORS.values(), ids=list(FACTORS))
def test_a_perturbation_reads_as_english_in_the_middle_of_a_sentence(factor):
    at = factor.at("-2.5")
    for words in (factor.title, at):
        # a noun with its article, or in the plural
        assert re.match(r"(the|a|neglecting) [a-z]|[a-z]+s of ", words), words
        # commas part one perturbed parameter from the next
        assert not re.search(r"[,:;]", words), words
    # a level has its unit, or is a factor or a coefficient
    assert re.search(r"−2\.5 (%|mm|cm|kg)( |$)|−2\.5°$|× −2\.5$|coefficient of −2\.5 ", at), at


def test_perturbations_are_named_by_factor_and_level_in_the_order_of_the_figure():
    effects = pd.DataFrame(
        {
            "factor": ["table_not_counted", "statue_restitution", "statue_restitution"],
            "level": ["10", "1", "ideal"],
            "floor": "all",
            "ratio_lower": 0.9,
            "ratio": 1.0,
            "ratio_upper": 1.1,
            "p": 0.5,
        }
    )
    assert perturbations(effects)["name"].tolist() == [
        "the object's restitution everywhere × 1",
        "neglecting the mass of a 10 kg table",
    ]


def perturbed(ratios: dict[str, float], p: float = 0.04) -> pd.DataFrame:
    """Effects of perturbations of one parameter on two floors together."""
    rows = [
        {"factor": "statue_restitution", "level": level, "floor": floor, "ratio": ratio}
        for level, ratio in {REFERENCE: 1.0, **ratios}.items()
        for floor in ("all", "cellar", "attic")
    ]
    table = pd.DataFrame(rows)
    return table.assign(ratio_lower=0.97 * table["ratio"], ratio_upper=1.03 * table["ratio"], p=p)


def test_the_rule_for_many_perturbations_is_named_and_counts_all():
    simulated = perturbations(perturbed({"0.9": 0.9, "0.95": 0.95, "1.05": 1.0}, p=0.04))
    words = adjusted_words(simulated)
    assert words.startswith("2 of 3 simulated perturbations have 95 % intervals that exclude 1")
    assert "Benjamini–Hochberg adjustment for 3 tests" in words
    alone = perturbations(perturbed({"0.9": 0.9}, p=0.04))
    assert "1 differs from 1" in adjusted_words(alone)


def test_the_figure_shows_the_largest_perturbations_and_says_no_row_twice():
    levels = {f"{0.5 + 0.02 * k:.2f}": float(np.exp(0.01 * (k - 10))) for k in range(40)}
    figure = sensitivity_analysis_figure(perturbed(levels), ["cellar", "attic"])
    labels = [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    assert len(labels) == len(set(labels)) == MOST_DRAWN + 1
    assert labels[0] == "Ideal model"
    width, height = figure.get_size_inches()
    assert height < 1.5 * width
    # floors stand below the mean that they belong to
    marks = [line for line in figure.axes[0].lines if line.get_marker() == "D"]
    assert len(marks) == MOST_DRAWN + 1
