"""What differs between earthquakes is in the probability, what is not known in the interval."""

import html
import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.conversion import OF_THE_SITE, UNKNOWN, VelocityRelation
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.page import page_of
from rockfrag.assess.request import Records
from rockfrag.assess.sources import SOURCES, SPACE, parts_of
from rockfrag.assess.words import five_lines

from .conftest import asked


def set_of(records: int, rng: np.random.Generator, noise) -> tuple[MotionSet, np.ndarray]:
    """Motions of records with known magnitude, distance and ground; the numbers too."""
    about = np.column_stack(
        [rng.uniform(6, 8, records), rng.uniform(0, 4, records), rng.uniform(5, 7, records)]
    )
    motions = tuple(
        replace(
            noise(0, 20),
            name=f"{i}",
            metadata={
                "earthquake": f"e{i // 3}", "station": f"s{i}", "magnitude": float(m),
                "distance_km": math.exp(r), "vs30_m_s": math.exp(v),
            },
        )
        for i, (m, r, v) in enumerate(about)
    )  # fmt: skip
    return MotionSet(motions, motions, (), "made"), about


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


def test_every_source_says_where_its_size_comes_from(motions):
    request = asked(
        width="35 cm", height="1.2 m", pedestal={"width": "50 cm", "height": "90 cm"}, floor="2/4",
        pga="0.5 g", return_period="475 years",
    )  # fmt: skip
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


def test_both_components_count_for_a_rectangular_base_only(motions):
    square, rounded = (
        assess_with(asked(width="35 cm", height="1.2 m", pga="0.6 g", **more), motions, brief=True)
        for more in ({}, {"round": True})
    )
    assert "space" in square.fraction.sources and "space" not in rounded.fraction.sources
    assert pytest.approx(math.log(0.54 / 0.47), abs=0.01) == SPACE


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


def test_how_a_scan_stands_is_a_source_until_it_is_measured(on_feet, motions):
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
        return assess_with(item, motions, brief=True).amplitudes[0.5].sources

    blind, known, faced = (sources(item) for item in (request, measured, of(direction_deg=0)))
    assert blind["contact"] > 0.1 and "facing" not in faced
    ways = ("contact", "retreat", "facing")
    assert math.hypot(*(known.get(name, 0.0) for name in ways)) < 0.02
    assert math.hypot(*(blind.get(name, 0.0) for name in ways)) > 0.15
    # a scan whose ways to stand are sources of its own has no second one for them in the model's
    assert blind["model"] < sources(asked(width="0.3 m", height="1 m", pga="0.6 g"))["model"]


def test_a_scan_on_few_points_loses_more_in_impacts_than_a_cut_block(on_feet):
    scan = asked(mesh={"file": str(on_feet)}, mass="200 kg", pga="0.6 g").objects
    assert scan.livelier == pytest.approx((0.7 + 1) / 2)
    assert scan.tolerances["restitution"] == pytest.approx(0.3 / math.sqrt(12) / 0.85, rel=0.03)
    assert asked(width="0.3 m", height="1 m", pga="0.6 g").objects.livelier == 1
