"""No combination of documented options ends in a traceback, and no answer contradicts itself."""

import json
import random

import pytest
from tests.assess.asking import answered, contradictions, request
from tests.assess.samples import table_csv

DRAWS = 24


@pytest.fixture(scope="module")
def few_records(own_records):
    """Catalogue of four records of as many earthquakes, which are soon simulated."""
    rows = (own_records / "catalogue.csv").read_text().splitlines()
    path = own_records / "few.csv"
    path.write_text("\n".join([rows[0], *rows[1:7]]) + "\n")
    return path


@pytest.mark.parametrize("part", range(3))
def test_random_requests_are_answered_without_contradiction_or_refused_in_a_sentence(
    part, few_records, tmp_path
):
    hazard = tmp_path / "hazard.csv"
    hazard.write_text(table_csv())
    rng = random.Random(part)
    for _ in range(DRAWS // 3):
        options = request(rng, few_records, hazard)
        status, out, err = answered(options, tmp_path)
        assert contradictions(status, out, err) == [], " ".join(options)


def test_the_checker_sees_contradictions(few_records, tmp_path):
    options = ["--width", "30cm", "--height", "1.2m", "--pga", "0.6g", "--record", str(few_records)]
    status, out, err = answered(options, tmp_path)
    assert contradictions(status, out, err) == []
    for change, found in (
        ({"fraction_toppling": {"value": 0.2, "lower": 0.3, "upper": 0.4}}, "toppling"),
        ({"fraction_rocking": {"value": 0.01, "lower": 0.0, "upper": 0.02}}, "likelier"),
        ({"level": 0.01}, "below uplift"),
        ({"counts": {"motions": 6, "rock": 1, "topple": 2}}, "counts"),
    ):
        wrong = json.dumps(json.loads(out) | change)
        assert any(found in contradiction for contradiction in contradictions(0, wrong, ""))
