"""Many objects under the same motions: what topples together is counted, and each is as it is alone."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.core.prediction import Shift
from rockfrag.assess.hazard.curve import PGA, curve_of_one_level
from rockfrag.assess.inventory import (
    FaultyRows,
    assess_each,
    assess_inventory,
    inventory_lines,
    inventory_table,
    joint_lines,
    read_inventory,
)
from rockfrag.assess.joint_risk import _correlation, _losses, _shared, _Together
from rockfrag.assess.motions import motion_set
from rockfrag.assess.outcomes import make_intensity_levels
from rockfrag.assess.risk import Evidence
from rockfrag.assess.standing.changes import on_plate, with_ballast
from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.system.blocks import Block
from rockfrag.words.catalogue import catalogue

from ..case_tables import case_tables
from .conftest import asked, outcomes_of

CASES = case_tables(__file__)


@pytest.fixture(scope="module")
def gallery(own_records, tmp_path_factory):
    path = tmp_path_factory.mktemp("gallery") / "gallery.csv"
    path.write_text(CASES["files"]["gallery.csv"])
    shared = {"pga": "0.4 g", "return_period": "475 years"}
    shared |= {"records": {"paths": [str(own_records / "catalogue.csv")]}}
    return assess_inventory(path, shared)


def test_objects_among_others_are_as_they_are_alone(gallery):
    for item in gallery.found:
        motions = motion_set(item.request.records, item.request.place, ".")
        alone = assess_with(item.request, motions, brief=True)
        assert np.array_equal(alone.counted.overturned, item.counted.overturned)
        assert alone.probability == item.probability
        assert alone.fraction == item.fraction
        assert alone.mitigations == item.mitigations


def test_twins_on_one_floor_topple_together_and_others_less(gallery):
    table = gallery.joint.correlation
    assert table.loc["twin", "other twin"] == 1.0
    assert np.allclose(np.diag(table), 1.0)
    assert table.loc["giant", "figurine"] < 0.6
    assert (table.to_numpy() <= 1 + 1e-12).all()


def test_what_topples_many_times_a_year_has_rates_and_no_probability_of_one(
    own_records, tmp_path
):
    """Their probabilities are 1, and a rate that was made of one was 0.7 a year, or infinite."""
    path = tmp_path / "needles.csv"
    path.write_text("name,width,height\nneedle,2 cm,2 m\nplate,4 cm,2 m\n")
    own = {"paths": [str(own_records / "catalogue.csv")]}
    shared = {"pga": "0.6 g", "return_period": "10 years", "records": own}
    joint = assess_inventory(path, shared).joint
    rates = joint.objects.set_index("name")["annual_rate"]
    assert rates["needle"] > 2 * rates["plate"] > 2
    assert (joint.numbers["probability"] == 1).all()
    total = joint.numbers["annual_rate"].iloc[0]
    assert 2 < total <= rates.sum()
    assert joint.losses["annual_rate"].iloc[0] == pytest.approx(total, rel=1e-9)


def test_one_or_more_topple_as_often_as_the_most_exposed_at_least_and_as_all_at_most(
    own_records, tmp_path
):
    """Under a steep hazard what is not known moves rates most, and nothing may topple below what lifts it."""
    path = tmp_path / "shelf.csv"
    path.write_text(
        "name,width,height,value\nvase,12 cm,60 cm,3\nblock,90 cm,60 cm,5\n"
    )
    hazard = tmp_path / "steep.csv"
    hazard.write_text("pga_g,annual_rate\n0.05,1\n0.1,0.01\n0.2,1e-4\n0.4,1e-6\n")
    own = {"paths": [str(own_records / "catalogue.csv")]}
    joint = assess_inventory(path, {"hazard": [str(hazard)], "records": own}).joint
    rates = joint.objects.set_index("name")["annual_rate"]
    assert rates["vase"] > 10 * rates["block"]
    one = joint.numbers.set_index("at_least").loc[1]
    # what moves uplift of one alone takes some hundredths from its rate
    assert rates["vase"] <= one["annual_rate"] <= 1.1 * rates.sum()
    assert one["probability_lower"] <= one["probability"] <= one["probability_upper"]
    losses = joint.losses["annual_rate"]
    assert rates["vase"] <= losses.iloc[0] <= 1.1 * rates.sum()
    assert losses.is_monotonic_decreasing


def test_numbers_and_losses_follow_from_the_objects_and_what_adds_most_comes_first(
    gallery,
):
    joint = gallery.joint
    table = joint.numbers.set_index("at_least")
    assert {1, 2, 3, 5} <= set(table.index)
    numbers = table["annual_rate"]
    assert numbers.is_monotonic_decreasing
    # at the level of the site too the mean number is the sum of the fractions
    sums = sum(item.fraction.value for item in gallery.found)
    assert table.loc[1, "at_the_site"] <= sums <= 5 * table.loc[1, "at_the_site"]
    # one of them topples at most as often as all rates together, and at least as often as the worst one
    rates = joint.objects["annual_rate"]
    assert rates.max() * (1 - 1e-9) <= numbers[1] <= rates.sum()
    # the mean of a loss is the area under its exceedance
    loss = (rates * joint.objects["value"]).sum()
    assert joint.objects["annual_loss"].sum() == pytest.approx(loss)
    assert joint.losses["annual_rate"].is_monotonic_decreasing
    assert joint.losses["annual_rate"].iloc[0] == pytest.approx(numbers[1], rel=1e-9)
    assert joint.objects["contribution"].sum() == pytest.approx(1)
    table = inventory_table(gallery)
    assert table["annual_loss"].is_monotonic_decreasing
    assert table["name"].iloc[0] == "figurine"
    said = " ".join(joint_lines(gallery))
    assert "For figurine" in said and "of it of figurine" in said
    assert table["factor"].dropna().lt(1).all()


def test_mitigations_are_bodies():
    block = Block(width=0.3, height=1.2, mass=100.0, cg_offset=0.02)
    heavier = with_ballast(block)
    assert heavier.mass == pytest.approx(125)
    # moments about the base stay those of the parts
    assert heavier.mass * heavier.h == pytest.approx(100 * 0.6 + 25 * 0.06)
    assert heavier.mass * heavier.cg_offset == pytest.approx(100 * 0.02)
    about_base = heavier.centroidal_inertia + heavier.mass * (
        heavier.h**2 + heavier.cg_offset**2
    )
    own = block.centroidal_inertia + 100 * (0.6**2 + 0.02**2)
    assert about_base == pytest.approx(own + 25 * 0.06**2)
    plate = on_plate(block)
    assert plate.width == pytest.approx(0.375)
    assert plate.height == pytest.approx(1.22)
    assert plate.mass == pytest.approx(100 + 7850 * 0.02 * 0.375**2)
    plinth = {"width": "50 cm", "height": "80 cm"}
    on_plinth = asked(width="30 cm", height="1.2 m", pedestal=plinth)
    names = " ".join(catalogue().lines(on_plinth.objects.changes()))
    for what in ("plate", "allast", "centre of gravity", "nother pedestal", "ixing"):
        assert what in names


def test_a_pad_lets_it_slide_instead(few):
    """Friction below b/h never lets it rock; a rough pad is as none."""
    request = asked(width="35 cm", height="1.2 m")
    shaking = make_intensity_levels(replace(few, pairs=()), PGA, count=8)
    smooth, slip = shaking.on_pad(request.objects, 0.15)
    assert not smooth.overturned[shaking.allowed].any()
    assert slip[shaking.allowed].max() > 0.01
    rough, _ = shaking.on_pad(request.objects, 2.0)
    (bare,) = shaking.outcomes_of([request.objects])
    differs = rough.overturned != bare.overturned
    assert differs[shaking.allowed].mean() < 0.05


def test_a_pad_on_a_pedestal_lies_under_the_object(few):
    """It slides on its pedestal, which stays where it is, and falls where it leaves it."""
    pedestal = {"width": "90 cm", "height": "30 cm"}
    request = asked(width="35 cm", height="1.2 m", pedestal=pedestal)
    shaking = make_intensity_levels(replace(few, pairs=()), PGA, count=4)
    found, slip = shaking.on_pad(request.objects, 0.15)
    assert slip[shaking.allowed].max() > 0.01
    on_it = shaking.allowed & (slip < (0.9 - 0.35) / 2)
    assert on_it.any() and not found.overturned[on_it].any()


def test_pad_and_gallery_from_the_command_line(own_records, tmp_path, capsys):
    out = tmp_path / "out"
    records = ["--record", str(own_records / "catalogue.csv"), "--output", str(out)]
    one = "assess --width 30cm --height 1.2m --pad-friction 0.2 --pga 0.5g"
    assert main([*one.split(), *records]) == 0
    assert "ad of friction 0.2" in (out / "the-object.html").read_text()
    assert (out / "the-object.json").is_file()
    lines = capsys.readouterr().out
    assert 3 <= len(lines.splitlines()) <= 4
    assert main([*one.split(), "--details", *records]) == 0
    lines = capsys.readouterr().out
    assert "12 own motions of 6 earthquakes" in lines
    path = tmp_path / "gallery.csv"
    path.write_text(CASES["files"]["gallery.csv"])
    assert (
        main(["assess", str(path), "--return-period", "475", "--pga", "0.5g", *records])
        == 0
    )
    said = capsys.readouterr().out
    assert "At least so many topple in one earthquake" in said
    assert float(said.split("mean loss a year is ")[1].split()[0]) > 0
    for name in ("together.csv", "losses.csv", "correlation.csv"):
        assert (out / name).exists()
    page = (out / "inventory.html").read_text(encoding="utf-8")
    assert "What 5 objects risk together" in page and "of the mean loss" in page
    assert page.count("<svg") == 3


@pytest.mark.parametrize(("text", "words"), CASES["refused"])
def test_a_wrong_row_is_named(text, words, tmp_path):
    path = tmp_path / "gallery.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        assess_inventory(path)


def test_what_cannot_be_held_so_is_left_out_by_its_name(few, tmp_path, monkeypatch):
    """What a slider carries is simulated in one plane, and a depth makes the vase move in space."""
    monkeypatch.setattr("rockfrag.assess.inventory.motion_set", lambda *_: few)
    path = tmp_path / "shelf.csv"
    path.write_text(
        "name,width_cm,height_cm,depth_cm,isolator\nbust,20,60,,\nvase,20,60,18,20cm\n"
    )
    found = assess_inventory(path, {"pga": "0.4 g"}, keep_going=True)
    assert [item.request.name for item in found.found] == ["bust"]
    (fault,) = found.faults
    assert fault.startswith("vase: key isolator:")
    with pytest.raises(FaultyRows, match="vase"):
        assess_inventory(path, {"pga": "0.4 g"})
    requests, _ = read_inventory(path, {"pga": "0.4 g"})
    with pytest.raises(FaultyRows, match="vase"):
        assess_each(requests, few)


def test_what_is_left_leaning_is_said_in_its_line_and_in_the_table(
    few, tmp_path, monkeypatch
):
    monkeypatch.setattr("rockfrag.assess.inventory.motion_set", lambda *_: few)
    path = tmp_path / "shelves.csv"
    path.write_text("name,width_cm,height_cm,wall_cm\nfar,30,180,60\nnear,30,180,2\n")
    found = assess_inventory(path, {"pga": "0.6 g"})
    lines = {line.split()[1]: line for line in inventory_lines(found)[1:]}
    assert "leave it leaning" in lines["far"] and "leaning" not in lines["near"]
    table = inventory_table(found).set_index("name")
    alone = table["fraction_or_leaning"] - table["fraction"]
    assert alone["far"] > 0.05 >= alone["near"]
    assert f"{100 * alone['far']:.2g} % leave" in lines["far"]


def test_so_much_is_lifted_where_the_objects_lifted_so_far_are_worth_it():
    """Of three motions, under which objects of 1, 2 and 4 lift one after the other, two topple all of it."""
    levels, hazard = np.array([0.1, 0.2, 0.4]), curve_of_one_level(PGA, 0.3, 475)
    lifting = np.array([[0.1, 0.1, 0.4], [0.2, 0.4, np.inf], [0.4, 0.4, np.inf]])
    toppled = np.array([[0.0, 3.0, 7.0], [0.0, 1.0, 7.0], [0.0, 0.0, 1.0]])
    fell = outcomes_of(toppled > 0, levels, ["a", "b", "c"])
    together = _Together(
        evidence=[Evidence(fell)],
        rates=np.zeros(3),
        shared={},
        worth=np.array([1.0, 2.0, 4.0]),
        outcomes=fell,
        toppled=toppled,
        lifting=lifting,
        lifted=np.array([[1.0, 1.0, 1.0], [3.0, 3.0, 3.0], [7.0, 7.0, 7.0]]),
    )
    for least, lifts in ((1, [0.1, 0.1, 0.4]), (2, lifting[1]), (7, lifting[2])):
        found, rate = together.losing(least, hazard)
        assert found.outcomes.lifting.tolist() == list(lifts)
        assert np.array_equal(found.outcomes.overturned, toppled >= least)
        assert rate > 0
    rates = [together.losing(least, hazard)[1] for least in (1, 2, 7)]
    assert rates == sorted(rates, reverse=True)
    # more than all objects are worth nothing topples
    found, _ = together.losing(8, hazard)
    assert np.isinf(found.outcomes.lifting).all()
    assert not found.outcomes.overturned.any()


def test_objects_share_the_least_of_what_moves_each_of_them():
    moved = [
        SimpleNamespace(
            shifts={"model": Shift(0.0, of_model), "width": Shift(0.1, 0.1)}
        )
        for of_model in (0.3, -0.2, 0.25)
    ]
    found = _shared(moved)
    assert found["model"] == Shift(0.0, -0.2)
    # what no one or not every one has nobody shares
    assert found["space"] == Shift(0.0, 0.0) and "width" not in found


def test_two_topple_together_as_often_as_motions_topple_both():
    """The rates of levels, of which the second allows no motion and counts with the first."""
    one = np.array([[1, 1, 1], [0, 0, 1], [0, 0, 1]], bool)
    two = np.array([[1, 1, 1], [1, 1, 1], [0, 0, 0]], bool)
    allowed = np.array([[1, 0, 1], [1, 0, 1], [1, 0, 0]], bool)
    rates = np.array([0.3, 0.2, 0.1])
    found = _correlation(np.array([one, two]), allowed, rates)
    alone = 0.5 / 3 + 0.1, 0.5 * 2 / 3 + 0.1
    both = 0.5 / 3 + 0.1
    assert (
        found[0, 1] == found[1, 0] == pytest.approx(both / math.sqrt(math.prod(alone)))
    )
    assert np.diag(found) == pytest.approx(1.0)


def test_where_nothing_topples_no_loss_is_exceeded():
    none = SimpleNamespace(toppled=np.zeros((3, 2)))
    assert _losses(none, curve_of_one_level(PGA, 0.3, 475)).empty
