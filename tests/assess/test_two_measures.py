"""Hazard in two measures: what is known of the velocity at a site moves the result and narrows its interval."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from rockfrag.assess.answer import assess_with
from rockfrag.assess.as_nrml import as_nrml
from rockfrag.assess.conversion import Conversion, OfTwoCurves, SiteVelocity
from rockfrag.assess.hazard.curve import make_curve
from rockfrag.assess.hazard.measure import PGA, PGV, VELOCITY_PER_G
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import IntensityLevels, ObjectOutcomes
from rockfrag.assess.request import make_request
from rockfrag.assess.risk import toppling_rate
from rockfrag.assess.words import assumptions, five_lines, quality_flags
from rockfrag.errors import InputError
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS

K, K0 = 2.5, 1e-4
TABLE = Path(__file__).parents[2] / "docs" / "tables" / "two_measures.py"


def asked(**settings):
    return make_request({"width": "35 cm", "height": "1.2 m", **settings}, "test")


def power_law(measure, at_a_tenth=K0, slope=K, middle=0.1):
    levels = middle * np.array([0.01, 0.1, 1.0, 10.0, 80.0 if measure == PGA else 100.0])
    return make_curve(measure, list(levels), list(at_a_tenth * (levels / middle) ** -slope), "test")


def topples_from(pgv: float, logs: np.ndarray) -> ObjectOutcomes:
    """An object that topples exactly from a PGV on, under motions with these ln PGV/PGA."""
    levels = np.geomspace(0.02, 8.0, 400)
    fell = levels * np.exp(logs)[:, np.newaxis] * VELOCITY_PER_G >= pgv
    intensity_levels = IntensityLevels(
        PGA, levels, np.ones(fell.shape), np.ones(fell.shape, dtype=bool)
    )
    earthquakes = np.array([f"e{i}" for i in range(logs.size)], dtype=object)
    return ObjectOutcomes(intensity_levels, fell, np.ones(fell.shape, dtype=bool), earthquakes)


def conversion_of(logs, known, weight=1.0):
    return Conversion(PGA, None, weight, logs, known, 0.0, 0.0, by_statics=False)


def test_an_object_that_velocity_topples_has_the_rate_of_that_velocity(random):
    logs = math.log(0.1) + 0.5 * random.standard_normal(60)
    acceleration = power_law(PGA)
    # the PGV of the site as it follows from ln PGV = ln(0.07 s) + ln PGA + 0.4 z
    velocity = power_law(PGV, K0 * math.exp((K * 0.4) ** 2 / 2), middle=0.1 * 0.07 * VELOCITY_PER_G)
    outcomes = topples_from(30.0, logs)
    known = OfTwoCurves.of(acceleration, velocity, 0.4)
    assert known.log_ratio(np.array([0.05, 1.0])) == pytest.approx(math.log(0.07), abs=1e-9)
    at_site = conversion_of(logs, known).at_site(outcomes)
    rate = toppling_rate(at_site.intensity_levels.levels, at_site.fractions(), acceleration)
    assert rate == pytest.approx(float(velocity.rate(30.0)), rel=0.03)
    # as recorded the motions say something else, and how PGA and PGV occur together matters little
    as_recorded = toppling_rate(
        outcomes.intensity_levels.levels, outcomes.fractions(), acceleration
    )
    assert as_recorded > 1.5 * rate
    for side in conversion_of(logs, known).sides(outcomes):
        assert toppling_rate(
            side.intensity_levels.levels, side.fractions(), acceleration
        ) == pytest.approx(rate, rel=0.06)


def test_velocity_says_nothing_of_an_object_that_acceleration_topples(random):
    outcomes = topples_from(30.0, np.full(40, math.log(0.1)))
    logs = math.log(0.1) + 0.5 * random.standard_normal(40)
    known = SiteVelocity(lambda x: np.full(x.shape, math.log(0.3)), 0.3)
    at_site = conversion_of(logs, known, weight=0.0).at_site(outcomes)
    assert at_site.fractions() == pytest.approx(outcomes.fractions(), abs=1e-12)


def test_what_differs_between_earthquakes_is_in_the_fraction(random):
    """Under ln PGV/PGA normal about the site's mean, fractions follow the normal distribution function."""
    logs = math.log(0.1) + 0.5 * random.standard_normal(200)
    known = SiteVelocity(lambda x: np.full(x.shape, math.log(0.07)), 0.3)
    at_site = conversion_of(logs, known).at_site(topples_from(30.0, logs))
    x = at_site.intensity_levels.levels
    exact = stats.norm.cdf(np.log(x * 0.07 * VELOCITY_PER_G / 30.0) / 0.3)
    assert np.abs(at_site.fractions() - exact).max() < 0.06
    assert abs(at_site.fractions() - exact).mean() < 0.01


@pytest.fixture(scope="module")
def found(motions: MotionSet):
    """The same object with less and more known of the velocity at the site."""
    middle = 0.6 * float(np.median(motions.values(PGV) / motions.values(PGA)))
    return {
        name: assess_with(asked(pga="0.6 g", return_period="475", **more), motions, brief=True)
        for name, more in {
            "nothing": {},
            "slow": {"pgv": f"{0.75 * middle} cm/s"},
            "fast": {"pgv": f"{1.3 * middle} cm/s"},
        }.items()
    }  # fmt: skip


def test_faster_ground_topples_more_often(found):
    slow, fast = (found[name].probability.value for name in ("slow", "fast"))
    assert slow < fast


def test_what_is_known_of_velocity_is_no_longer_a_source(found):
    assert found["nothing"].fraction.sources["conversion"] > 0
    for name in ("slow", "fast"):
        sources = found[name].probability.sources
        # what is left of it is the error of the weight of velocity
        assert found[name].conversion.spread == 0 < found["nothing"].conversion.spread
        assert "together" in sources
        assert "two measures" in " ".join(assumptions(found[name]))


def test_nothing_known_leaves_counted_fractions(found):
    item = found["nothing"]
    assert item.outcomes is item.counted
    assert item.counts is not None


def test_the_level_is_given_in_both(motions):
    found = assess_with(asked(pga="0.6 g", pgv="40 cm/s"), motions)
    assert "PGA 0.6 g and PGV 40 cm/s" in five_lines(found)[0]
    assert found.conversion.known.spread == 0
    # the made motions are quicker than that
    assert any("PGV of 66.7 cm/s per g" in quality_flag for quality_flag in quality_flags(found))
    with pytest.raises(InputError, match="key pga and key sa"):
        asked(pga="0.6 g", sa=["0.3 s", "0.6 g"])


def test_the_export_says_which_errors_are_not_in_it(found):
    text = as_nrml(found["slow"])
    assert f"{MODEL_ERRORS[CUT].beyond:g} of ln level ({CUT}: " in text
    assert "no campaign of a cut block" in text


@pytest.mark.slow
def test_the_table_of_the_documentation_is_what_its_script_writes(default_records):
    spec = importlib.util.spec_from_file_location("two_measures", TABLE)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    about = script.objects()["bust"]
    line = script.line_of("bust", script.row_of(about, default_records))
    assert line in script.PAGE.read_text()
