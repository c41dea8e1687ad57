"""Probabilities agree with a plain integration, and intervals hold the truth as often as they say."""

import json
import math

import numpy as np
import pytest
from scipy import stats

from rockfrag.assess.answer import assess_with
from rockfrag.assess.hazard.curve import PGA, HazardCurve, curve_of_one_level
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.page import write_answer
from rockfrag.assess.request import make_request
from rockfrag.assess.risk import (
    Evidence,
    amplitude_target,
    fraction_target,
    probability_in,
    risk_target,
    toppling_rate,
)

from .conftest import outcomes_of

LEVELS = np.geomspace(0.02, 3.0, 80)
BENT = HazardCurve(
    PGA,
    np.array([0.01, 0.05, 0.12, 0.4, 1.1]),
    np.array([0.3, 0.04, 0.009, 0.0006, 0.00002]),
    "a bent curve",
)


def outcomes_from(capacities, earthquakes, **more) -> ObjectOutcomes:
    """Outcomes of motions that topple from a level on."""
    return outcomes_of(np.asarray(capacities)[:, None] <= LEVELS, LEVELS, earthquakes, **more)


@pytest.fixture(scope="module")
def page(motions, tmp_path_factory):
    """The page of an object under a bent hazard curve, beside which its numbers lie."""
    folder = tmp_path_factory.mktemp("answer")
    (folder / "hazard.csv").write_text(
        "pga_g,annual_rate\n0.01,0.3\n0.05,0.04\n0.12,0.009\n0.4,0.0006\n1.1,0.00002\n6,1e-7\n"
    )
    settings = {"name": "figure", "width": "35 cm", "height": "120 cm", "hazard": ["hazard.csv"]}
    return write_answer(assess_with(make_request(settings, "test", folder), motions), folder)


@pytest.fixture(scope="module")
def answer(page):
    """All numbers of the answer."""
    return json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))


def rates_at(answer, levels):
    """Annual rates of a power law between the points of the hazard curve of an answer."""
    known, rates = (np.log(answer["hazard"][key]) for key in ("levels", "annual_rates"))
    return np.exp(np.interp(np.log(levels), known, rates))


def test_probability_agrees_with_a_plain_integration_of_what_the_answer_says(answer):
    x, fraction = (np.array(answer["fragility"][key]) for key in ("levels", "fraction"))
    # P straight in ln x, by a plain sum over very fine steps
    fine = np.geomspace(x[0], x[-1], 400_001)
    rates = rates_at(answer, fine)
    middle = np.interp(np.log(np.sqrt(fine[1:] * fine[:-1])), np.log(x), fraction)
    rate = (middle * -np.diff(rates)).sum() + fraction[-1] * rates[-1]
    found = answer["probability"]["value"]
    assert found == pytest.approx(1 - math.exp(-50 * rate), abs=1e-6)
    assert -math.log1p(-found) / 50 == pytest.approx(rate, rel=2e-5)


def test_an_object_that_bears_more_topples_less_often():
    fractions = outcomes_from([0.3, 0.5, 0.9], "abc").fractions()
    plain = toppling_rate(LEVELS, fractions, BENT)
    assert (
        toppling_rate(LEVELS, fractions, BENT, 0.2)
        < plain
        < toppling_rate(LEVELS, fractions, BENT, -0.2)
    )
    # a power law shifted is a power law times a factor
    power = curve_of_one_level(PGA, 0.25, 475)
    ratio = toppling_rate(LEVELS, fractions, power, 0.2) / toppling_rate(LEVELS, fractions, power)
    assert ratio == pytest.approx(math.exp(-3 * 0.2), rel=1e-9)


def test_where_nothing_topples_there_is_a_bound_and_no_zero():
    rocks = outcomes_from(np.full(20, 100.0), range(20), all_rock=True)
    found = Evidence(rocks, shifts={"model": 0.2}).estimate(risk_target(BENT, 50))
    assert found.value == 0
    # 19 of 20 chances that fewer than 1 - 0.1^(1/20) of all earthquakes topple it
    assert 0 < found.upper <= probability_in(0.11 * float(BENT.rate(LEVELS[0])), 50) * 1.9


def test_one_earthquake_that_topples_leaves_more_open_than_none():
    limits = []
    for toppling in range(4):
        capacities = np.where(np.arange(20) < toppling, 0.3, 100.0)
        outcomes = outcomes_from(capacities, range(20), all_rock=True)
        found = Evidence(outcomes, shifts={"model": 0.2}).estimate(fraction_target(0.5))
        assert found.lower <= found.value <= found.upper
        # the exact binomial limit of 5 % on that side (Clopper and Pearson 1934)
        exact = stats.beta.ppf(0.95, toppling + 1, 20 - toppling)
        assert found.upper > 0.75 * exact
        limits.append(found.upper)
    assert limits[0] < min(limits[1:])


def test_share_at_a_level_and_level_of_a_share_are_inverse():
    outcomes = outcomes_from(np.geomspace(0.1, 1.5, 40), range(40))
    level = Evidence(outcomes).estimate(amplitude_target(0.5)).value
    assert Evidence(outcomes).estimate(fraction_target(level)).value == pytest.approx(0.5, abs=1e-9)


def test_one_earthquake_alone_gives_no_finite_interval():
    outcomes = outcomes_from([0.3, 0.4, 0.5], ["one"] * 3)
    found = Evidence(outcomes).estimate(risk_target(BENT, 50))
    assert (found.lower, found.upper) == (0, 1)


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    """A world of earthquakes, a width that was measured and a model that errs, all with known truth."""
    theta, between, within, of_width, of_model = 0.5, 0.25, 0.4, 0.1, 0.195
    hazard = curve_of_one_level(PGA, 0.25, 475)
    beta = math.hypot(between, within)
    # ∫ Φ(ln(x/θ)/β) k H0 x^(-k-1) dx = H(θ) exp(k²β²/2)
    truth = float(hazard.rate(theta)) * math.exp(0.5 * (3 * beta) ** 2)
    random = np.random.default_rng(11)
    held, runs, earthquakes, each = 0, 600, 19, 5
    for _ in range(runs):
        error = of_width * random.standard_normal() + of_model * random.standard_normal()
        capacities = theta * np.exp(
            error
            + between * np.repeat(random.standard_normal(earthquakes), each)
            + within * random.standard_normal(earthquakes * each)
        )
        names = np.repeat(np.arange(earthquakes), each)
        outcomes = outcomes_from(capacities, names)
        moved = {
            "width": tuple(
                outcomes_from(capacities * math.exp(sign * of_width), names) for sign in (-1, 1)
            )
        }
        found = Evidence(outcomes, moved, {"model": of_model}).estimate(risk_target(hazard, 50))
        held += found.lower <= probability_in(truth, 50) <= found.upper
    fraction = held / runs
    assert 0.85 < fraction < 0.95
    assert stats.binomtest(held, runs, 0.9).pvalue > 1e-4


def test_all_of_the_motions_are_not_a_bit_less():
    """At a level of the series the fraction is that counted there, whatever logarithms round to."""
    rng = np.random.default_rng(0)
    for _ in range(2000):
        levels = np.unique(np.round(np.exp(rng.uniform(-3, 1, 60)), 3))
        first = int(rng.integers(1, levels.size))
        fractions = np.where(levels < levels[first], np.linspace(0, 0.9, levels.size), 1.0)
        assert fraction_target(float(levels[first])).of(levels, fractions, 0.0) == 1


@pytest.mark.peers
def test_the_probability_is_that_of_openquakes_risk_calculator(page, answer):
    scientific = pytest.importorskip(
        "openquake.risklib.scientific", reason="openquake.engine is not installed"
    )
    from openquake.hazardlib import nrml

    levels = answer["fragility"]["levels"]
    fine = np.geomspace(levels[0], levels[-1], 1000)
    poes = 1 - np.exp(-50 * rates_at(answer, fine))
    (function,) = nrml.to_python(str(page.with_suffix(".xml"))).values()
    _, toppled = scientific.classical_damage(
        function.build(["overturned"], None, 0.0), fine, poes, 50, 50, 1
    )
    assert float(toppled) == pytest.approx(answer["probability"]["value"], rel=0.01)
