"""Probabilities agree with plain integration; intervals hold what is not known, the truth as often as they say."""

import html
import importlib.util
import json
import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from rockfrag.assess.answer import assess_with
from rockfrag.assess.conversion import (
    OF_THE_SITE,
    PRIOR,
    TOGETHER,
    UNKNOWN,
    Conversion,
    PublishedVelocity,
    SiteVelocity,
    VelocityRelation,
)
from rockfrag.assess.core.velocity import spread_of_mean
from rockfrag.assess.export import as_nrml
from rockfrag.assess.findings import (
    assumptions,
    details_of,
    lines_of,
    quality_flags,
)
from rockfrag.assess.hazard.curve import (
    PGA,
    PGV,
    VELOCITY_PER_G,
    HazardCurve,
    curve_of_one_level,
    make_curve,
)
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.page import page_of, write_answer
from rockfrag.assess.request import Records, make_request
from rockfrag.assess.risk import (
    Evidence,
    _weights_of_normal,
    after_uplift,
    amplitude_target,
    fraction_target,
    probability_in,
    risk_target,
    shift_of,
    toppling_rate,
)
from rockfrag.assess.rules import rules_study
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.words.catalogue import catalogue
from rockfrag.words.numbers import kept_together

from .conftest import asked, outcomes_of

LEVELS = np.geomspace(0.02, 3.0, 80)
BENT = HazardCurve(
    PGA,
    np.array([0.01, 0.05, 0.12, 0.4, 1.1]),
    np.array([0.3, 0.04, 0.009, 0.0006, 0.00002]),
    "a bent curve",
)


def outcomes_from(capacities, earthquakes, **more) -> ObjectOutcomes:
    """Outcomes of motions that topple from a level on."""
    return outcomes_of(
        np.asarray(capacities)[:, None] <= LEVELS, LEVELS, earthquakes, **more
    )


@pytest.fixture(scope="module")
def page(motions, tmp_path_factory):
    """The page of an object under a bent hazard curve, beside which its numbers lie."""
    folder = tmp_path_factory.mktemp("answer")
    (folder / "hazard.csv").write_text(
        "pga_g,annual_rate\n0.01,0.3\n0.05,0.04\n0.12,0.009\n0.4,0.0006\n1.1,0.00002\n6,1e-7\n"
    )
    settings = {
        "name": "figure",
        "width": "35 cm",
        "height": "120 cm",
        "hazard": ["hazard.csv"],
    }
    return write_answer(
        assess_with(make_request(settings, "test", folder), motions), folder
    )


@pytest.fixture(scope="module")
def answer(page):
    """All numbers of the answer."""
    return json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))


def rates_at(answer, levels):
    """Annual rates of a power law between the points of the hazard curve of an answer."""
    known, rates = (np.log(answer["hazard"][key]) for key in ("levels", "annual_rates"))
    return np.exp(np.interp(np.log(levels), known, rates))


def test_probability_agrees_with_a_plain_integration_of_what_the_answer_says(answer):
    x, fraction = (
        np.array(answer["fragility"][key]) for key in ("levels", "probability")
    )
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
    ratio = toppling_rate(LEVELS, fractions, power, 0.2) / toppling_rate(
        LEVELS, fractions, power
    )
    assert ratio == pytest.approx(math.exp(-3 * 0.2), rel=1e-9)


def test_what_topples_no_motion_is_as_unlikely_as_it_is_far_away():
    found = [
        Evidence(
            outcomes_from(np.full(20, capacity), range(20), all_rock=True),
            shifts={"model": after_uplift(0.2)},
        ).estimate(fraction_target(0.5))
        for capacity in (0.51, 0.7, 1.0, 2.0)
    ]
    for near, far in pairwise(found):
        assert near.value > far.value and near.upper > far.upper
    # ln(0.7/0.5) is 1.7 standard deviations of the model away, ln(2/0.5) is 6.9
    assert found[1].value == pytest.approx(stats.norm.sf(1.7), rel=0.5)
    assert found[3].upper < 1e-4


@pytest.mark.parametrize("spread", [0.1, 0.5])
def test_weights_of_a_normal_value_give_the_mean_of_what_is_linear_between_points(
    spread,
):
    """Beside an integral: all points, a straight line, and a bend."""
    x = np.array([-0.9, -0.4, -0.1, 0.3, 1.2])
    weights = _weights_of_normal(x, spread)
    assert weights.sum() == pytest.approx(1.0)
    z, step = np.linspace(-8, 8, 160_001, retstep=True)
    density = stats.norm.pdf(z) * step
    for values in (x, np.abs(x), np.eye(5)[1]):
        mean = (np.interp(spread * z, x, values) * density).sum()
        assert weights @ values == pytest.approx(mean, abs=1e-6)


def test_one_earthquake_that_topples_leaves_more_open_than_none():
    limits = []
    for toppling in range(4):
        capacities = np.where(np.arange(20) < toppling, 0.3, 100.0)
        outcomes = outcomes_from(capacities, range(20), all_rock=True)
        found = Evidence(outcomes, shifts={"model": after_uplift(0.2)}).estimate(
            fraction_target(0.5)
        )
        assert found.lower <= found.value <= found.upper
        # no less than what was counted and its standard error
        counted = toppling / 20
        assert found.upper >= counted + math.sqrt(counted * (1 - counted) / 20)
        limits.append(found.upper)
    assert limits == sorted(limits)


def test_share_at_a_level_and_level_of_a_share_are_inverse():
    outcomes = outcomes_from(np.geomspace(0.1, 1.5, 40), range(40))
    level = amplitude_target(0.5).value(outcomes)
    assert fraction_target(level).value(outcomes) == pytest.approx(0.5, abs=1e-9)
    # the median over what is not known of either lies there too
    assert Evidence(outcomes).estimate(amplitude_target(0.5)).value == pytest.approx(
        level, rel=0.05
    )


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
        error = (
            of_width * random.standard_normal() + of_model * random.standard_normal()
        )
        capacities = theta * np.exp(
            error
            + between * np.repeat(random.standard_normal(earthquakes), each)
            + within * random.standard_normal(earthquakes * each)
        )
        names = np.repeat(np.arange(earthquakes), each)
        # all rock, as what rocks only where it topples can topple no earlier, whatever errs
        outcomes = outcomes_from(capacities, names, all_rock=True)
        sides = (
            outcomes_from(capacities * math.exp(sign * of_width), names, all_rock=True)
            for sign in (-1, 1)
        )
        shifts = {"width": shift_of(*sides), "model": after_uplift(of_model)}
        found = Evidence(outcomes, shifts).estimate(risk_target(hazard, 50))
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
        fractions = np.where(
            levels < levels[first], np.linspace(0, 0.9, levels.size), 1.0
        )
        assert fraction_target(float(levels[first])).of(levels, fractions) == 1


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


def set_of(
    records: int, rng: np.random.Generator, noise
) -> tuple[MotionSet, np.ndarray]:
    """Motions of records with known magnitude, ln distance and ln Vs30; the numbers too."""
    about = rng.uniform([6, 0, 5], [8, 4, 7], (records, 3))
    motions = []
    for i, (magnitude, distance, vs30) in enumerate(about.tolist()):
        known = {"earthquake": f"e{i // 3}", "station": f"s{i}", "magnitude": magnitude}
        known |= {"distance_km": math.exp(distance), "vs30_m_s": math.exp(vs30)}
        motions.append(replace(noise(0, 20), name=f"{i}", metadata=known))
    return MotionSet(tuple(motions), tuple(motions), (), "made"), about


def test_what_is_known_of_the_earthquakes_is_no_ignorance(noise):
    random = np.random.default_rng(7)
    motions, about = set_of(60, random, noise)
    logs = 1.0 + about @ np.array([0.5, -0.2, -0.3])
    parts = np.array([0.5, -0.2, -0.3]) * list(UNKNOWN.values())
    relation = VelocityRelation.of(motions.about, logs)
    assert relation.unknown(Records()) == pytest.approx(np.linalg.norm(parts))
    known = Records(magnitude=7.0, distance_km=10.0)
    assert relation.unknown(known) == pytest.approx(abs(parts[2]))
    # the mean is that of such earthquakes on the ground of the set
    there = [7.0, math.log(10.0), about[:, 2].mean()]
    assert relation.mean(known) == pytest.approx(
        1.0 + there @ np.array([0.5, -0.2, -0.3])
    )


def test_what_differs_between_motions_of_one_site_is_not_all_ignorance(noise):
    random = np.random.default_rng(7)
    motions, _ = set_of(3000, random, noise)
    logs = 0.4 * random.standard_normal(3000)
    known = VelocityRelation.of(motions.about, logs).unknown(Records())
    assert known == pytest.approx(0.4 * math.sqrt(OF_THE_SITE), rel=0.05)
    few = VelocityRelation.of(motions.about[:20], logs[:20]).unknown(Records())
    assert few == pytest.approx(logs[:20].std(ddof=1) * math.sqrt(OF_THE_SITE))


def test_the_velocity_of_a_site_is_the_published_one_of_its_earthquakes(motions):
    """PGV/PGA at 0.2 g of three earthquakes as Abrahamson and Bhasin (2020) have it on their reference ground."""
    for magnitude, distance, expected in (
        (6, 20, 58.0),
        (6.5, 12, 87.0),
        (7, 20, 101.0),
    ):
        known = Records(magnitude=magnitude, distance_km=distance)
        site = replace(PublishedVelocity.of(PGA, known), vs30=425.0)
        at_one, slope = site.lines(known)[0]
        ratio = math.exp(at_one + slope * math.log(0.2)) * VELOCITY_PER_G
        assert ratio == pytest.approx(expected, abs=0.5)
    # less is open the more is given
    full, part, none = (
        spread_of_mean(0.2, site.of_site, PublishedVelocity.of(PGA, given).lines(given))
        for given in (known, Records(magnitude=7.0), Records())
    )
    assert math.sqrt(OF_THE_SITE) * site.scatter < full < part < none
    slow, fast = (
        assess_with(
            figure(pga="0.6 g", magnitude=m, distance_km=20.0), motions, brief=True
        )
        for m in (6.0, 7.5)
    )
    assert slow.conversion.known.published.magnitude == 6.0
    assert slow.fraction.value < fast.fraction.value


def figure(**settings):
    return asked(width="35 cm", height="1.2 m", **settings)


def test_every_source_says_where_its_size_comes_from(motions):
    pedestal, shaking = (
        {"width": "50 cm", "height": "90 cm"},
        {"pga": "0.5 g", "floor": "2/4"},
    )
    request = figure(pedestal=pedestal, return_period="475 years", **shaking)
    found = assess_with(request, motions.at(request.place))
    assert {"space", "model", "period", "conversion", "hazard"} <= set(
        found.main.sources
    )
    assert set(found.main.sources) <= set(SOURCES)
    parts = parts_of(found.main.sources)
    assert sum(parts.values()) == pytest.approx(1)
    assert list(parts.values()) == sorted(parts.values(), reverse=True)
    page = html.unescape(page_of(found))
    for name in found.main.sources:
        basis = catalogue().sentence(SOURCES[name].basis)
        assert kept_together(basis) in page
    # the three largest are named
    for name in list(parts)[:3]:
        assert catalogue().say(SOURCES[name].called) in details_of(found)[4]


def test_how_a_scan_stands_is_a_source_until_it_is_measured(tmp_path, few):
    # a block of 0.3 × 0.3 × 1 m on a plate of 0.2 m at 1 mm below it: which carries depends on the tolerance
    trimesh = pytest.importorskip("trimesh")
    block, plate = (
        trimesh.creation.box(sides) for sides in ((0.3, 0.3, 1), (0.2, 0.2, 0.001))
    )
    block.apply_translation((0, 0, 0.501))
    plate.apply_translation((0, 0, 0.0005))
    trimesh.util.concatenate([block, plate]).export(tmp_path / "feet.stl")

    def of(**mesh):
        mesh["file"] = str(tmp_path / "feet.stl")
        return asked(mesh=mesh, mass="200 kg", pga="0.6 g")

    request = of()
    scan = request.objects.scan
    # 1 mm reach the block, less only the plate: half of the ways stand on each
    assert sum(scan.parts.values()) == pytest.approx(1)
    assert max(scan.parts, key=scan.parts.get) == "contact"
    low, high = (scan.block(at).width for at in (0.05, 0.95))
    assert 0.18 < low < 0.29 < high < 0.43
    measured = of(contact_tolerance="2 mm", edge_retreat="0 mm", direction_deg=0)
    assert measured.objects.block.width == pytest.approx(0.3, rel=1e-3)

    def sources(item):
        return assess_with(item, few, brief=True).amplitudes[0.5].sources

    blind, known, faced = (
        sources(item) for item in (request, measured, of(direction_deg=0))
    )
    assert blind["contact"] > 0.1 and "facing" not in faced
    ways = ("contact", "retreat", "facing")
    assert math.hypot(*(known.get(name, 0.0) for name in ways)) < 0.02
    assert math.hypot(*(blind.get(name, 0.0) for name in ways)) > 0.15
    # a scan whose ways to stand are sources of its own has no second one for them in the model's
    cut = asked(width="0.3 m", height="1 m", pga="0.6 g")
    assert blind["model"] < sources(cut)["model"]
    # on few points it loses more in impacts than a cut block
    tolerances = request.objects.under.tolerances
    assert request.objects.restitution_factor == pytest.approx((0.7 + 1) / 2)
    assert tolerances["restitution"] == pytest.approx(
        0.3 / math.sqrt(12) / 0.85, rel=0.03
    )
    assert cut.objects.restitution_factor == 1


ROOT = Path(__file__).resolve().parents[2]
K, K0 = 2.5, 1e-4


def power_law(measure, at_a_tenth=K0, slope=K, middle=0.1):
    levels = middle * np.array(
        [0.01, 0.1, 1.0, 10.0, 80.0 if measure == PGA else 100.0]
    )
    return make_curve(
        measure, list(levels), list(at_a_tenth * (levels / middle) ** -slope), "test"
    )


def topples_from(pgv: float, logs: np.ndarray) -> ObjectOutcomes:
    """An object that topples exactly from a PGV on, under motions with these ln PGV/PGA."""
    levels = np.geomspace(0.02, 8.0, 400)
    fell = levels * np.exp(logs)[:, np.newaxis] * VELOCITY_PER_G >= pgv
    return outcomes_of(fell, levels, [f"e{i}" for i in range(logs.size)], all_rock=True)


def conversion_of(logs, known, weight=1.0):
    return Conversion(PGA, (), weight, 0.0, logs, known, 0.0, 0.0, by_statics=False)


def test_an_object_that_velocity_topples_has_the_rate_of_that_velocity():
    random = np.random.default_rng(7)
    logs = math.log(0.1) + 0.5 * random.standard_normal(60)
    acceleration = power_law(PGA)
    # the PGV of the site as it follows from ln PGV = ln(0.07 s) + ln PGA + 0.4 z
    velocity = power_law(
        PGV, K0 * math.exp((K * 0.4) ** 2 / 2), middle=0.1 * 0.07 * VELOCITY_PER_G
    )
    outcomes = topples_from(30.0, logs)
    known = SiteVelocity(0.4, curves=(acceleration, velocity))
    assert known.log_ratio(np.array([0.05, 1.0])) == pytest.approx(
        math.log(0.07), abs=1e-9
    )

    def rate_of(each: ObjectOutcomes) -> float:
        return toppling_rate(
            each.intensity_levels.levels, each.fractions(), acceleration
        )

    rate = rate_of(conversion_of(logs, known).at_site(outcomes))
    assert rate == pytest.approx(float(velocity.rate(30.0)), rel=0.03)
    # as recorded the motions say something else, and how PGA and PGV occur together matters little
    assert rate_of(outcomes) > 1.5 * rate
    for side in conversion_of(logs, known).sides(outcomes):
        assert rate_of(side) == pytest.approx(rate, rel=0.06)


def test_sides_of_the_spread_of_velocities_are_those_that_are_documented():
    said = (ROOT / "docs" / "assess.md").read_text(encoding="utf-8")
    assert f"± {100 * TOGETHER:g} % of the spread of ln PGV at a given level" in said


def test_velocity_says_nothing_of_an_object_that_acceleration_topples():
    random = np.random.default_rng(7)
    outcomes = topples_from(30.0, np.full(40, math.log(0.1)))
    logs = math.log(0.1) + 0.5 * random.standard_normal(40)
    known = SiteVelocity(0.3, math.log(0.3))
    at_site = conversion_of(logs, known, weight=0.0).at_site(outcomes)
    assert at_site.fractions() == pytest.approx(outcomes.fractions(), abs=1e-12)


def test_what_differs_between_earthquakes_is_in_the_fraction():
    """Under ln PGV/PGA normal about the site's mean, fractions follow the normal distribution function."""
    random = np.random.default_rng(7)
    logs = math.log(0.1) + 0.5 * random.standard_normal(200)
    known = SiteVelocity(0.3, math.log(0.07))
    at_site = conversion_of(logs, known).at_site(topples_from(30.0, logs))
    x = at_site.intensity_levels.levels
    exact = stats.norm.cdf(np.log(x * 0.07 * VELOCITY_PER_G / 30.0) / 0.3)
    assert np.abs(at_site.fractions() - exact).max() < 0.06
    assert abs(at_site.fractions() - exact).mean() < 0.01


def test_what_is_known_of_velocity_counts_and_is_no_longer_a_source(motions):
    middle = 0.6 * float(np.median(motions.values(PGV) / motions.values(PGA)))
    nothing, slow, fast = (
        assess_with(
            figure(pga="0.6 g", return_period="475", **more), motions, brief=True
        )
        for more in ({}, {"pgv": "40 cm/s"}, {"pgv": f"{1.3 * middle} cm/s"})
    )
    # with nothing said the velocity is that of the usual earthquakes; motions are counted as recorded
    assert nothing.conversion.known.published.magnitude == PRIOR["magnitude"]
    assert nothing.counts[0] == len(motions.ground)
    assert nothing.fraction.sources["conversion"] > 0
    assert slow.probability.value < fast.probability.value
    for found in (slow, fast):
        # what is left of it is the error of the weight of velocity
        assert found.conversion.known.spread > found.conversion.spread == 0
        assert nothing.conversion.spread > 0
        assert "together" in found.probability.sources
        assert "two measures" in " ".join(catalogue().lines(assumptions(found)))
    # of a level in both the velocity is known, and the made motions are quicker
    found = assess_with(figure(pga="0.6 g", pgv="40 cm/s"), motions, brief=True)
    assert "PGA 0.6 g, PGV 40 cm/s" in lines_of(found)[0]
    assert found.conversion.known.spread == 0
    assert any(
        "PGV of 66.7 cm/s per g" in flag
        for flag in catalogue().lines(quality_flags(found))
    )
    # the export says which errors are not in it
    text = as_nrml(slow)
    assert f"{MODEL_ERRORS[CUT].beyond:g} of ln level ({CUT}: " in text


@pytest.mark.slow
def test_the_table_of_the_documentation_is_what_its_script_writes(default_records):
    spec = importlib.util.spec_from_file_location(
        "two_measures", ROOT / "docs" / "tables" / "two_measures.py"
    )
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    about = script.objects()["bust"]
    line = script.line_of("bust", script.row_of(about, default_records))
    assert line in script.PAGE.read_text()


@pytest.mark.slow
def test_the_documented_bias_of_rules_is_the_computed_one(default_records):
    table = rules_study(ROOT / "config" / "rules-of-thumb.yaml", default_records)
    text = (ROOT / "docs" / "rules-of-thumb.md").read_text(encoding="utf-8")
    header, _, *rows = re.findall(r"^\|(.*)\|$", text, re.MULTILINE)
    rules = [cell.strip() for cell in header.split("|")][1:]
    documented = {}
    for row in rows:
        name, *cells = (cell.strip() for cell in row.split("|"))
        documented |= {
            (name, rule): cell for rule, cell in zip(rules, cells, strict=True)
        }
    computed = {
        (
            row.object,
            row.rule,
        ): f"{row.bias:.2f} ± {row.scatter:.2f}, {100 * row.unsafe:.0f} %"
        for row in table.itertuples()
    }
    assert documented == computed
