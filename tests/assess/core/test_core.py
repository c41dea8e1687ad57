"""All that is not known drawn at once: closed forms, statics as a cap, parts of sources, decisions."""

import math
from dataclasses import replace
from itertools import product
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from scipy import stats

from rockfrag.assess.core import choices, holding, sobol
from rockfrag.assess.core import demands as demands_of
from rockfrag.assess.core.decisions import Action, decide
from rockfrag.assess.core.draws import make_draws
from rockfrag.assess.core.estimates import FRACTION, MOTIONS, fill_estimate, fill_order
from rockfrag.assess.core.fractions import count_motions, fill_deciding
from rockfrag.assess.core.likelihood import Likelihood, likelihood_of
from rockfrag.assess.core.prediction import Prediction, Shift, predict
from rockfrag.assess.core.sobol import sobol_points
from rockfrag.assess.findings import TEXTS
from rockfrag.base.units import GRAVITY

LEVELS = np.geomspace(0.02, 4.0, 80)
MANY = 400


def predicted(capacities, shifts, uplifts=None, levels=LEVELS):
    """A prediction for motions, each an earthquake, that topple from a level on."""
    capacities = np.asarray(capacities, dtype=float)
    fell = capacities[:, None] <= levels
    uplifts = np.full(capacities.size, levels[0]) if uplifts is None else uplifts
    counts = count_motions(
        levels, fell, np.ones_like(fell), uplifts, np.arange(capacities.size)
    )
    return predict(levels, counts, shifts)


def drawn(*sources):
    """Draws of sources under ten earthquakes, as a prediction of nothing has them."""
    draws, none = make_draws(len(sources), 10), np.zeros((0, 0))
    return Prediction(LEVELS, sources, draws, none, none)


def lognormal(median, spread):
    """Capacities at equal probabilities of a lognormal distribution."""
    z = stats.norm.ppf((np.arange(MANY) + 0.5) / MANY)
    return median * np.exp(spread * z)


def test_the_mean_is_the_lognormal_curve_of_both_spreads():
    shifts = {"model": Shift(0.0, 0.25), "width": Shift(0.05, 0.15)}
    found = predicted(lognormal(0.5, 0.3), shifts).toppling.mean(axis=0)
    both = np.sqrt(0.3**2 + 0.25**2 + 0.15**2)
    exact = stats.norm.cdf(np.log(LEVELS / 0.5) / both)
    assert np.abs(found - exact).max() < 0.015


def test_what_is_not_lifted_does_not_topple_whatever_the_errors():
    # the text's formula: E[F(x exp(-s-m)) 1(x exp(-s) ≥ u)] with F lognormal
    of_statics, of_model, lifted = 0.06, 0.4, 0.45
    shifts = {"width": Shift(of_statics, of_statics), "model": Shift(0.0, of_model)}
    uplifts = np.full(MANY, lifted)
    found = predicted(lognormal(0.5, 0.3), shifts, uplifts)
    assert (found.toppling <= found.rocking).all()
    for x in (0.35, 0.42, 0.47, 0.6):
        place = LEVELS.searchsorted(x)
        level = LEVELS[place]
        s = np.linspace(-5, 5, 4001) * of_statics
        density = stats.norm.pdf(s, scale=of_statics) * (s[1] - s[0])
        beyond = np.hypot(0.3, of_model)
        falls = stats.norm.cdf((np.log(level / 0.5) - s) / beyond)
        exact = density @ (falls * (np.log(level / lifted) >= s))
        assert found.toppling[:, place].mean() == pytest.approx(exact, abs=0.01)
        rocks = stats.norm.cdf(np.log(level / lifted) / of_statics)
        assert found.rocking[:, place].mean() == pytest.approx(rocks, abs=0.01)


def test_a_motion_that_lifts_later_topples_no_earlier():
    """By motion: of two that would topple alike, the one whose components lift it at twice the level holds."""
    capacities, levels = np.full(40, 0.3), np.geomspace(0.1, 2.0, 60)
    uplifts = np.where(np.arange(40) < 20, 0.2, 0.6)
    found = predicted(capacities, {}, uplifts, levels).toppling.mean(axis=0)
    assert found[levels.searchsorted(0.4)] == pytest.approx(0.5, abs=0.05)
    assert found[levels.searchsorted(0.7)] == pytest.approx(1.0, abs=0.03)


def test_parts_are_those_of_a_sum_of_sources():
    """Of a level that is a product of errors the parts are their variances over the sum."""
    sources = {"a": 0.3, "b": 0.2, "c": 0.1}
    draws = make_draws(3, 10)
    values = draws.sources @ np.array(list(sources.values()))
    work, found = np.zeros((2, values.size)), np.zeros(MOTIONS + 4)
    given = FRACTION, 1.0, values.mean(), 1.0, values
    fill_estimate(*given, *work, draws.bins, len(draws.weights), 10, found)
    total = values.std()
    for found_part, size in zip(found[-3:], sources.values(), strict=True):
        assert (found_part / total) ** 2 == pytest.approx(size**2 / total**2, abs=0.02)


def test_draws_have_the_moments_of_what_they_stand_for():
    draws = make_draws(8, 19)
    assert np.abs(draws.sources.mean(axis=0)).max() < 0.01
    assert draws.sources.std(axis=0) == pytest.approx(1.0, abs=0.02)
    assert np.abs(np.corrcoef(draws.sources.T) - np.eye(8)).max() < 0.05
    assert draws.weights.sum(axis=1) == pytest.approx(1.0)
    assert draws.weights.mean(axis=0) == pytest.approx(1 / 20, rel=0.1)
    assert make_draws(8, 19) is draws


@pytest.mark.parametrize("count", [6, 19])
def test_the_interval_of_a_mean_of_few_earthquakes_is_students(count):
    values = stats.norm.ppf((np.arange(count) + 0.5) / count)
    weights = make_draws(1, count).weights[:, :count]
    means = weights @ values / weights.sum(axis=1)
    exact = stats.t.ppf(0.95, count - 1) * values.std(ddof=1) / np.sqrt(count)
    half = np.diff(np.quantile(means, [0.05, 0.95]))[0] / 2
    assert half == pytest.approx(exact, rel=0.12)


def test_a_measurement_is_named_where_it_would_turn_the_decision_round():
    sources = drawn("velocity", "width")
    known = sources.draws.sources[:, 0]
    # the probability is 5 or 25 %, as the velocity is low or high
    values = np.where(known > 0.5, 0.25, 0.05)
    found = decide(values.mean(), values, sources, {"width": 0.2, "velocity": 0.0}, 0.1)
    assert (found.action, found.source) == (Action.MEASURE, "velocity")
    # the mean is above 10 %; it is low with a probability of 69 %
    assert found.otherwise is Action.SECURE
    assert found.chance == pytest.approx(stats.norm.cdf(0.5), abs=0.04)
    # the cheapest of those that would do
    draws = sources.draws._replace(bins=sources.draws.bins[[0, 0]])
    both = replace(sources, draws=draws)
    first = decide(values.mean(), values, both, {"width": 0.2, "velocity": 0.0}, 0.1)
    assert first.source == "width"
    # far from what is accepted nothing turns it round
    for accepted, action in ((0.001, Action.SECURE), (0.6, Action.LEAVE)):
        sure = decide(values.mean(), values, sources, {"velocity": 0.0}, accepted)
        assert (sure.action, sure.source) == (action, "")


def test_a_measurement_that_leaves_much_decides_less():
    source = drawn("a")
    values = stats.norm.cdf(source.draws.sources[:, 0] - 1.0)
    chances = [
        decide(values.mean(), values, source, {"a": left}, 0.1).measurements[0].chance
        for left in (0.0, 0.5, 0.95)
    ]
    assert chances[0] >= chances[1] > chances[2] == 0


def test_likelihoods_are_those_of_the_scale():
    steps = [likelihood_of(p) for p in (0.005, 0.05, 0.2, 0.5, 0.8, 0.95, 0.995)]
    assert steps == list(Likelihood)


NUMBERS = (0.0, 0.001, 0.005, 0.05, 0.2, 0.5, 0.8, 0.95, 1.0, np.inf, np.nan)


@pytest.mark.parametrize("choice", TEXTS, ids=lambda choice: choice.__name__)
def test_every_choice_takes_each_of_its_texts_and_no_other(choice):
    """Of numbers from 0 to infinity, flags and actions; none is out of reach, and none is missing."""
    count = choice.__code__.co_argcount
    kinds = [
        choice.__annotations__[name].__name__
        for name in choice.__code__.co_varnames[:count]
    ]
    of_kind = {"float": NUMBERS, "bool": (False, True), "int": (0, 1, 2)}
    given = product(*(of_kind[kind] for kind in kinds))
    assert {choice(*numbers) for numbers in given} == set(range(len(TEXTS[choice])))


def test_a_change_that_leaves_nothing_is_told_apart_from_one_that_changes_nothing():
    assert choices.reduces(0.0, grows=False) == choices.reduces(0.0, grows=True) == 0
    assert [choices.reduces(1.0, grows) for grows in (False, True)] == [1, 2]


@pytest.mark.parametrize("shown", [False, True])
@pytest.mark.parametrize("grows", [False, True])
def test_of_what_changes_nothing_no_number_is_said(grows, shown):
    """A bracket said "0 % less risk; so few motions do not show it"."""
    text = TEXTS[choices.change_alone][choices.change_alone(1.0, grows, shown)]
    assert text == "cell_same"


def test_of_what_takes_off_nearly_all_one_bound_is_said_and_never_all():
    """It was said of "more than 99 % less risk (100 to 100 %)"."""
    nearly = TEXTS[choices.reduces][choices.reduces(0.004, grows=False)]
    assert nearly == "reduces_nearly_all"
    assert TEXTS[choices.reduces][choices.reduces(0.006, grows=False)] == "reduces"
    parts = (0.0, 0.628, 0.99, 0.9999, 1.0)
    found = [choices.whole_percent_below(part) for part in parts]
    assert found == [0, 62, 99, 99, 99]


def test_what_is_open_is_said_to_be_and_no_limit_is_said_twice():
    assert (
        choices.between(0.3, 0.0, 1.0) == 0 and choices.over_years(0.3, 0.0, 1.0) == 1
    )
    assert choices.chance(0.0, 0.0, 0.04) == 1 and choices.chance(0.0, 0.0, 0.0) == 0
    assert choices.advice(choices.MEASURE, True, True, 0.3) == 0
    # next to nothing, or all, of what a fall costs is no part to be said
    assert choices.advice(choices.LEAVE, False, False, 1e-6) == 3
    assert choices.advice(choices.SECURE, False, False, 0.999) == 1
    # what does not move is left, unless the hazard says otherwise
    assert choices.advice(choices.LEAVE, False, True, 0.01) == 3
    assert choices.advice(choices.SECURE, True, True, 0.3) == 1


def test_what_is_ranked_stands_as_pythons_sort_puts_it():
    random = np.random.default_rng(5)
    first = random.choice([0.0, 0.5, 0.7, np.nan], 40)
    second = random.choice([0.1, 0.2], 40)
    order = np.zeros(40, dtype=np.int64)
    fill_order(first, second, False, order)
    keys = [
        (np.isnan(a), np.nan_to_num(a), b) for a, b in zip(first, second, strict=True)
    ]
    assert order.tolist() == sorted(range(40), key=lambda place: keys[place])


@pytest.mark.parametrize("dimensions, count, first", [(1, 16, 0), (33, 256, 512)])
def test_points_of_sobol_are_those_of_scipy_to_the_last_bit(dimensions, count, first):
    sequence = stats.qmc.Sobol(dimensions, scramble=False)
    if first:
        sequence.fast_forward(first)
    found = sobol_points(dimensions, count, first)
    assert np.array_equal(found, sequence.random(count))
    # where scipy keeps no such table
    with patch.object(sobol, "_TABLE", Path("nowhere")):
        assert np.array_equal(sobol_points(dimensions, count, first), found)


# ---- what is drawn and tried in the page


def test_the_motion_that_is_drawn_topples_it_at_the_lowest_level():
    levels, allowed = np.array([0.1, 0.2, 0.3]), np.ones((3, 3), bool)
    fell = np.array([[0, 0, 1], [0, 1, 1], [0, 1, 1]], bool)
    found = np.zeros(3)
    fill_deciding(levels, allowed, fell, 0.25, found)
    assert found.tolist() == [1, 0.2, 1]
    # one that may not be scaled so far does not count
    fill_deciding(levels, allowed & (np.arange(3) != 1), fell, 0.25, found)
    assert found.tolist() == [0, 0.3, 1]
    fill_deciding(levels, allowed, np.zeros_like(fell), 0.25, found)
    assert found.tolist() == [0, 0.25, 0]


def test_what_is_asked_is_enough_for_as_many_motions_as_said():
    rng = np.random.default_rng(2)
    for count in (1, 2, 21, 40, 100):
        demands = rng.exponential(300.0, count)
        least = demands_of.ask(demands, np.zeros(count))
        assert least == np.quantile(demands, demands_of.PART, method="higher")
        held = demands_of.count_held(demands, least)
        assert held == (demands <= least).sum() >= demands_of.PART * (count - 1)
    assert demands_of.ask(np.zeros(0), np.zeros(0)) == 0


def test_a_strength_of_two_digits_is_the_least_that_is_enough():
    rng = np.random.default_rng(4)
    for value in 10.0 ** rng.uniform(-6, 9, 300):
        found = holding.rounded_up(value)
        assert float(f"{found:.1e}") == found >= value
        assert holding.rounded_up(found) == found
        # one step less is too little
        step = 10.0 ** (math.floor(math.log10(value)) - 1)
        assert found - step < value * (1 + 1e-9)


def test_a_bracket_gives_a_millimetre_under_the_weight_and_is_damped_as_said():
    width, height, mass = 0.4, 1.1, 200.0
    given, found = (
        np.array([width, height, mass, *[np.nan] * 2, 0.0, np.nan]),
        np.zeros(4),
    )
    holding.tell_fastener(given, True, found)
    at, reach, stiffness, damping = found
    assert mass * GRAVITY / stiffness == pytest.approx(0.001)
    assert (at, reach) == pytest.approx((0.8 * height, width / 2 + 0.1))
    # of an oscillator that turns about the middle of its base
    inertia = mass * (width**2 + height**2) / 12 + mass * (height / 2) ** 2
    critical = 2 * math.sqrt(stiffness * at**2 * inertia)
    assert damping * at**2 / critical == pytest.approx(holding.DAMPED)
    holding.tell_fastener(given, False, found)
    assert found[3] == 0 and mass * GRAVITY / found[2] == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("factor", "limits", "said"),
    [
        (0.25, (0.1, 0.6), (0.75, 0.4, 0.9)),
        (1.5, (0.8, 3.0), (0.5, -0.2, 2.0)),
    ],
)
def test_a_reduction_has_rising_limits(factor, limits, said):
    found = np.zeros(3)
    choices.tell_reduction(factor, *limits, found)
    assert found == pytest.approx(said)
