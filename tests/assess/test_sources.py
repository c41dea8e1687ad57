"""What differs between earthquakes is in the probability, what is not known in the interval; documented tables."""

import html
import importlib.util
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from rockfrag.assess.answer import assess_with
from rockfrag.assess.conversion import (
    OF_THE_SITE,
    UNKNOWN,
    Conversion,
    SiteVelocity,
    VelocityRelation,
)
from rockfrag.assess.export import as_nrml
from rockfrag.assess.hazard.curve import PGA, PGV, VELOCITY_PER_G, make_curve
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.page import page_of
from rockfrag.assess.request import Records
from rockfrag.assess.risk import toppling_rate
from rockfrag.assess.rules import rules_study
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.assess.words import five_lines, says
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS

from .conftest import asked, outcomes_of


def set_of(records: int, rng: np.random.Generator, noise) -> tuple[MotionSet, np.ndarray]:
    """Motions of records with known magnitude, ln distance and ln Vs30; the numbers too."""
    about = rng.uniform([6, 0, 5], [8, 4, 7], (records, 3))
    motions = []
    for i, (magnitude, distance, vs30) in enumerate(about.tolist()):
        known = {"earthquake": f"e{i // 3}", "station": f"s{i}", "magnitude": magnitude}
        known |= {"distance_km": math.exp(distance), "vs30_m_s": math.exp(vs30)}
        motions.append(replace(noise(0, 20), name=f"{i}", metadata=known))
    return MotionSet(tuple(motions), tuple(motions), (), "made"), about


def test_what_is_known_of_the_earthquakes_is_no_ignorance(noise, random):
    motions, about = set_of(60, random, noise)
    logs = 1.0 + about @ np.array([0.5, -0.2, -0.3])
    parts = np.array([0.5, -0.2, -0.3]) * list(UNKNOWN.values())
    relation = VelocityRelation.of(motions.about, logs)
    assert relation.unknown(Records()) == pytest.approx(np.linalg.norm(parts))
    known = Records(magnitude=7.0, distance_km=10.0)
    assert relation.unknown(known) == pytest.approx(abs(parts[2]))
    # the mean is that of such earthquakes on the ground of the set
    there = [7.0, math.log(10.0), about[:, 2].mean()]
    assert relation.mean(known) == pytest.approx(1.0 + there @ np.array([0.5, -0.2, -0.3]))


def test_what_differs_between_motions_of_one_site_is_not_all_ignorance(noise, random):
    motions, _ = set_of(3000, random, noise)
    logs = 0.4 * random.standard_normal(3000)
    known = VelocityRelation.of(motions.about, logs).unknown(Records())
    assert known == pytest.approx(0.4 * math.sqrt(OF_THE_SITE), rel=0.05)
    few = VelocityRelation.of(motions.about[:20], logs[:20]).unknown(Records())
    assert few == pytest.approx(logs[:20].std(ddof=1) * math.sqrt(OF_THE_SITE))


def figure(**settings):
    return asked(width="35 cm", height="1.2 m", **settings)


def test_every_source_says_where_its_size_comes_from(motions):
    pedestal, shaking = {"width": "50 cm", "height": "90 cm"}, {"pga": "0.5 g", "floor": "2/4"}
    request = figure(pedestal=pedestal, return_period="475 years", **shaking)
    found = assess_with(request, motions.at(request.place))
    assert {"space", "model", "period", "conversion", "hazard"} <= set(found.main.sources)
    assert set(found.main.sources) <= set(SOURCES)
    parts = parts_of(found.main.sources)
    assert sum(parts.values()) == pytest.approx(1)
    assert list(parts.values()) == sorted(parts.values(), reverse=True)
    page = html.unescape(page_of(found))
    for name in found.main.sources:
        assert SOURCES[name].basis.split(",")[0].split("(")[0] in page
    # the three largest are named, and what would narrow the interval
    for name in list(parts)[:3]:
        assert SOURCES[name].words in five_lines(found)[4]


@pytest.fixture(scope="module")
def on_feet(tmp_path_factory):
    """A block of 0.3 × 0.3 × 1 m on a plate of 0.2 m at 1 mm below it: which carries depends on the tolerance."""
    trimesh = pytest.importorskip("trimesh")
    block = trimesh.creation.box((0.3, 0.3, 1.0))
    block.apply_translation((0, 0, 0.501))
    plate = trimesh.creation.box((0.2, 0.2, 0.001))
    plate.apply_translation((0, 0, 0.0005))
    path = tmp_path_factory.mktemp("scan") / "feet.stl"
    trimesh.util.concatenate([block, plate]).export(path)
    return path


def test_how_a_scan_stands_is_a_source_until_it_is_measured(on_feet, few):
    def of(**mesh):
        return asked(mesh={"file": str(on_feet), **mesh}, mass="200 kg", pga="0.6 g")

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

    blind, known, faced = (sources(item) for item in (request, measured, of(direction_deg=0)))
    assert blind["contact"] > 0.1 and "facing" not in faced
    ways = ("contact", "retreat", "facing")
    assert math.hypot(*(known.get(name, 0.0) for name in ways)) < 0.02
    assert math.hypot(*(blind.get(name, 0.0) for name in ways)) > 0.15
    # a scan whose ways to stand are sources of its own has no second one for them in the model's
    cut = asked(width="0.3 m", height="1 m", pga="0.6 g")
    assert blind["model"] < sources(cut)["model"]
    # on few points it loses more in impacts than a cut block
    tolerances = request.objects.tolerances
    assert request.objects.livelier == pytest.approx((0.7 + 1) / 2)
    assert tolerances["restitution"] == pytest.approx(0.3 / math.sqrt(12) / 0.85, rel=0.03)
    assert cut.objects.livelier == 1


ROOT = Path(__file__).resolve().parents[2]
K, K0 = 2.5, 1e-4


def power_law(measure, at_a_tenth=K0, slope=K, middle=0.1):
    levels = middle * np.array([0.01, 0.1, 1.0, 10.0, 80.0 if measure == PGA else 100.0])
    return make_curve(measure, list(levels), list(at_a_tenth * (levels / middle) ** -slope), "test")


def topples_from(pgv: float, logs: np.ndarray) -> ObjectOutcomes:
    """An object that topples exactly from a PGV on, under motions with these ln PGV/PGA."""
    levels = np.geomspace(0.02, 8.0, 400)
    fell = levels * np.exp(logs)[:, np.newaxis] * VELOCITY_PER_G >= pgv
    return outcomes_of(fell, levels, [f"e{i}" for i in range(logs.size)], all_rock=True)


def conversion_of(logs, known, weight=1.0):
    return Conversion(PGA, None, weight, logs, known, 0.0, 0.0, by_statics=False)


def test_an_object_that_velocity_topples_has_the_rate_of_that_velocity(random):
    logs = math.log(0.1) + 0.5 * random.standard_normal(60)
    acceleration = power_law(PGA)
    # the PGV of the site as it follows from ln PGV = ln(0.07 s) + ln PGA + 0.4 z
    velocity = power_law(PGV, K0 * math.exp((K * 0.4) ** 2 / 2), middle=0.1 * 0.07 * VELOCITY_PER_G)
    outcomes = topples_from(30.0, logs)
    known = SiteVelocity(0.4, curves=(acceleration, velocity))
    assert known.log_ratio(np.array([0.05, 1.0])) == pytest.approx(math.log(0.07), abs=1e-9)

    def rate_of(each: ObjectOutcomes) -> float:
        return toppling_rate(each.intensity_levels.levels, each.fractions(), acceleration)

    rate = rate_of(conversion_of(logs, known).at_site(outcomes))
    assert rate == pytest.approx(float(velocity.rate(30.0)), rel=0.03)
    # as recorded the motions say something else, and how PGA and PGV occur together matters little
    assert rate_of(outcomes) > 1.5 * rate
    for side in conversion_of(logs, known).sides(outcomes):
        assert rate_of(side) == pytest.approx(rate, rel=0.06)


def test_velocity_says_nothing_of_an_object_that_acceleration_topples(random):
    outcomes = topples_from(30.0, np.full(40, math.log(0.1)))
    logs = math.log(0.1) + 0.5 * random.standard_normal(40)
    known = SiteVelocity(0.3, math.log(0.3))
    at_site = conversion_of(logs, known, weight=0.0).at_site(outcomes)
    assert at_site.fractions() == pytest.approx(outcomes.fractions(), abs=1e-12)


def test_what_differs_between_earthquakes_is_in_the_fraction(random):
    """Under ln PGV/PGA normal about the site's mean, fractions follow the normal distribution function."""
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
        assess_with(figure(pga="0.6 g", return_period="475", **more), motions, brief=True)
        for more in ({}, {"pgv": "40 cm/s"}, {"pgv": f"{1.3 * middle} cm/s"})
    )
    # nothing known leaves counted fractions
    assert nothing.outcomes is nothing.counted and nothing.counts is not None
    assert nothing.fraction.sources["conversion"] > 0
    assert slow.probability.value < fast.probability.value
    for found in (slow, fast):
        # what is left of it is the error of the weight of velocity
        assert found.conversion.known.spread > found.conversion.spread == 0
        assert nothing.conversion.spread > 0
        assert "together" in found.probability.sources
        assert "two measures" in " ".join(says("assumptions", found))
    # of a level in both the velocity is known, and the made motions are quicker
    found = assess_with(figure(pga="0.6 g", pgv="40 cm/s"), motions, brief=True)
    assert "PGA 0.6 g and PGV 40 cm/s" in five_lines(found)[0]
    assert found.conversion.known.spread == 0
    assert any("PGV of 66.7 cm/s per g" in flag for flag in says("quality_flags", found))
    # the export says which errors are not in it
    text = as_nrml(slow)
    assert f"{MODEL_ERRORS[CUT].beyond:g} of ln level ({CUT}: " in text
    assert "no campaign of a cut block" in text


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
        documented |= {(name, rule): cell for rule, cell in zip(rules, cells, strict=True)}
    computed = {
        (row.object, row.rule): f"{row.bias:.2f} ± {row.scatter:.2f}, {100 * row.unsafe:.0f} %"
        for row in table.itertuples()
    }
    assert documented == computed
