"""Perturbed parameters in words that stand in a sentence, and what is said of them."""

import re

import pandas as pd
import pytest

from rockfrag.report.sections.explanation import FACTORS, departures


@pytest.mark.parametrize("factor", FACTORS.values(), ids=list(FACTORS))
def test_a_departure_reads_as_english_in_the_middle_of_a_sentence(factor):
    at = factor.at("-2.5")
    for words in (factor.title, at):
        # a noun with its article, or in the plural
        assert re.match(r"(the|a|neglecting) [a-z]|[a-z]+s of ", words), words
        # commas part one departure from the next
        assert not re.search(r"[,:;]", words), words
    # a level has its unit, or is a factor or a coefficient
    assert re.search(r"−2\.5 (%|mm|cm|kg)( |$)|−2\.5°$|× −2\.5$|coefficient of −2\.5 ", at), at
    assert factor.written("-2.5") in at


def test_departures_are_named_by_factor_and_level_in_the_order_of_the_figure():
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
    assert departures(effects)["name"].tolist() == [
        "the object's restitution everywhere × 1",
        "neglecting the mass of a 10 kg table",
    ]
