"""What holds an object is tried by itself: with what it must bear, in how many motions, and what that buys."""

import json
import math
import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns
from rockfrag.assess import findings, holding
from rockfrag.assess.answer import assess_with
from rockfrag.assess.export import as_json
from rockfrag.assess.findings import details_of, lines_of
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.page import page_of
from rockfrag.assess.standing.holders import (
    PADS_AT,
    Beside,
    Bracket,
    Casters,
    Cords,
    Pendulum,
    Putty,
    Springs,
    fastened,
    holders_beside,
    nearest_edge,
    pads_of,
    rounded_up,
)
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.system import as_system
from rockfrag.system.body import Circle, Interval, Polygon
from rockfrag.words.catalogue import catalogue
from rockfrag.words.findings import percent

from .conftest import asked

BOX = {"width": "35 cm", "depth": "50 cm", "height": "120 cm", "mass": "180 kg"}
TRIED = (Text.HOLD_PUTTY, Text.HOLD_BRACKET, Text.HOLD_CORDS)


@pytest.fixture(scope="module")
def found(few):
    costs = {"putty": 5, "bracket": 80}
    return assess_with(asked(**BOX, facing_deg=0, pga="0.6 g", costs=costs), few)


def tried(found):
    """Mitigations by the id of what holds the object."""
    return {
        each.change["change"].id: each
        for each in found.mitigations
        if each.change.id == Text.HOLDS
    }


def test_ties_lead_from_a_body_to_both_sides_alike_wherever_it_stands_on_its_pedestal():
    statue = Block(0.3, 0.9, 60.0, depth=0.5)
    for aside in (0.0, 0.08):
        system = as_system(Stack(Block(0.6, 0.4, 200.0, depth=0.6), statue, aside))
        ties = fastened(system, 0.01, Cords(500.0))
        x, y, z = np.mean([tie.anchor for tie in ties], axis=0)
        assert (x, y) == pytest.approx((aside, 0.0), abs=1e-12)
        assert z == pytest.approx(0.4 + ties[0].point[2])


def test_putty_must_bear_what_the_motions_pull_at_its_pads(found, few):
    change = tried(found)[Text.HOLD_PUTTY].change
    x, y = PADS_AT * 0.35 / 2, PADS_AT * 0.5 / 2
    asked_for = []
    for i, j in few.pairs:
        first, second = few.base[i], few.base[j]
        scale = 0.6 * GRAVITY / math.sqrt(first.pga * second.pga)
        a, b = scale * np.abs([first.acceleration, second.acceleration])
        pull = 180.0 * (0.6 * (a / x + b / y) - GRAVITY)
        asked_for += 2 * [pull.max()]
    enough = rounded_up(np.quantile(asked_for, 0.95, method="higher"))
    assert change["change"]["force"].value == pytest.approx(enough)
    assert change["total"] == len(asked_for)
    assert change["held"] == sum(np.array(asked_for) <= enough)


def test_each_is_tried_and_what_holds_in_all_motions_topples_in_none(found):
    each = tried(found)
    assert set(TRIED) <= set(each)
    for name, mitigation in each.items():
        held, total = mitigation.change["held"], mitigation.change["total"]
        assert 0.95 <= held / total <= 1
        # an isolator has a stop, which topples what comes too fast
        if name not in (Text.HOLD_ISOLATOR, Text.HOLD_SPRINGS):
            assert mitigation.value < found.fraction.value
            assert mitigation.helps


def test_page_and_file_say_what_it_bears_before_and_after_and_what_it_costs(found):
    answer = json.loads(as_json(found))
    words = [each["change"]["words"] for each in answer["mitigations"]]
    assert any(word.startswith("wax or putty that holds a pull of") for word in words)
    costs = {each["cost"] for each in answer["mitigations"]}
    assert {5.0, 80.0} <= costs
    page = page_of(found)
    assert "bracket to the wall that bears" in page
    assert "<th" in page and "Cost" in page
    italian = page_of(found, "it")
    assert "cera o mastice" in italian and "Costo" in italian


def test_nothing_is_tried_of_which_hardly_a_motion_asks_anything(few, monkeypatch):
    one_of_a_hundred = np.append(np.zeros(99), 5.0)
    monkeypatch.setattr(holding, "demands_of", lambda *_: one_of_a_hundred)
    assert not tried(assess_with(asked(**BOX, facing_deg=0, pga="0.3 g"), few))


def test_an_object_may_be_held_as_it_stands(few):
    def fell(**holding):
        given = asked(**BOX, facing_deg=0, pga="0.6 g", **holding)
        return assess_with(given, few, brief=True)

    free, weak, strong = fell(), fell(putty_n=1.0), fell(putty_n=1e6)
    assert strong.counts[1] == strong.counts[2] == 0
    assert weak.counts[1:] == pytest.approx(free.counts[1:], abs=1)
    assert "It is held as it stands: wax or putty" in " ".join(details_of(strong))
    # what is there is not tried once more
    kinds = [holder.key for holder in strong.request.objects.holders_to_try()]
    assert "putty" not in kinds and "bracket" in kinds


def test_putty_holds_as_much_in_shear_as_in_pull_and_is_not_tried_under_casters():
    bond = Putty(120.0).on(as_system(Block(0.3, 1.4, 80.0))).contacts[0].bond
    assert bond.shear == bond.tension == 120.0
    rolls = asked(**BOX, facing_deg=0, pga="0.6 g", casters="free").objects
    kinds = [holder.key for holder in rolls.holders_to_try()]
    assert "putty" not in kinds and "casters" in kinds


def test_what_leans_at_the_end_is_told_beside_what_topples(few):
    """At a wall further away than its balance an object neither stands nor lies after many motions."""
    far, near = (
        assess_with(
            asked(width="30 cm", height="180 cm", wall=wall, pga="0.6 g"),
            few,
            brief=True,
        )
        for wall in ("60 cm", "2 cm")
    )
    leans = far.outcomes.others["leans"] & ~far.outcomes.overturned
    assert leans.any() and far.leans.value > far.fraction.value + 0.05
    assert "leave it leaning against its wall" in " ".join(lines_of(far))
    assert near.leans is None and "leaning" not in " ".join(lines_of(near))


def test_a_held_object_has_a_whole_answer_in_space(few):
    found = assess_with(asked(**BOX, facing_deg=0, pga="0.6 g", putty_n=1e6), few)
    assert found.counts[2] == 0 and found.planar < 1e-6
    page = page_of(found)
    assert "It is held as it stands" in page
    # the live part simulates the free object, and says so
    assert "on the floor, without what holds it" in page


def test_a_wall_can_be_left_and_casters_be_locked():
    objects = asked(
        width="40 cm", height="120 cm", wall="5 cm", casters="free", pga="0.3 g"
    ).objects
    names = [holder.called().id for holder in objects.holders_to_try()]
    assert Text.HOLD_OFF_WALL in names and Text.HOLD_CASTERS_LOCKED in names
    system = objects.held(objects.system_of(objects.body))
    assert system.contacts[0].friction.kinetic < 0.1
    (wall,) = system.constraints
    assert wall.distance == pytest.approx(0.25)
    locked = Casters(locked=True).on(system)
    assert locked.contacts[0].friction.kinetic > 0.3
    with pytest.raises(InputError, match="casters"):
        asked(width="40 cm", height="120 cm", casters="loose", pga="0.3 g")


def test_a_bilinear_isolator_that_yields_at_once_has_the_strokes_of_a_pendulum(
    made_motions,
):
    """Nothing rocks, so that T = W u/R + µ W sgn u' of both.

    At rest the springs swing with a speed as √u_y, which the difference follows.
    """
    block, motions = as_system(Block(0.8, 0.6, 300.0)), list(made_motions(3))
    scales = np.array([[0.2 * GRAVITY / motion.pga] for motion in motions])

    def strokes(isolator):
        found = overturns([isolator.on(block)], motions, scales=scales)
        assert not found.peak_rotation.any()
        return np.nanmax(found.stroke, axis=-1).ravel()

    expected = strokes(Pendulum())
    late, early = (
        np.abs(strokes(Springs(yields_at=at)) / expected - 1) for at in (1e-3, 1e-5)
    )
    assert late.max() < 0.1 and early.max() < 0.01
    assert (early < late / 5).all()


def test_what_is_known_of_a_holder_is_taken_as_it_is():
    def holder(**given):
        size = {"width": "40 cm", "height": "1.2 m", "pga": "0.3 g"}
        return asked(**size, **given).objects.under.holders[0]

    springs = {"isolator_stiffness": "4 kN/m", "isolator_strength": "60 N"}
    made = holder(isolator="20 cm", isolator_yield="5 mm", **springs)
    assert made == Springs(0.2, 4000.0, 60.0, 0.005)
    dish = holder(isolator="20 cm", isolator_radius="2 m", isolator_friction=0.08)
    assert dish == Pendulum(0.2, 2.0, 0.08)
    assert holder(wall="30 cm", wall_height="10 cm") == Beside(0.3, 0.1)
    assert holder(cord="300 N", cord_slack="5 mm").slack == 0.005
    bracket = holder(bracket="300 N", bracket_slack="2 mm")
    (tie,) = bracket.on(as_system(Block(0.4, 1.2, 100.0))).constraints
    assert (tie.bracket, tie.slack, tie.strength) == (True, 0.002, 300.0)
    # as tight as it was fastened, if nothing is said of it
    for held in (holder(bracket="300 N"), holder(cord="300 N")):
        assert held.slack == 0.0
    # an object has one isolator
    tries = [type(each) for each in holders_beside([made])]
    assert Pendulum not in tries and Springs not in tries
    # what is fastened would hold an isolator fast
    assert Bracket not in tries and Cords not in tries
    for made_fast in (Bracket(300.0), Cords(300.0)):
        assert {each.key for each in holders_beside([made_fast])}.isdisjoint(
            {"isolator", made_fast.key}
        )
    for alone in ({"wall_height": "9 cm"}, {"cord_slack": "2 mm"}, springs):
        with pytest.raises(InputError, match=r"; give keys? .* too"):
            holder(**alone)
    with pytest.raises(InputError, match=r"isolator_radius_m.*bilinear.*leave one out"):
        holder(isolator="20 cm", isolator_radius="2 m", **springs)


def test_a_kerb_trips_what_rolls_and_a_high_one_is_a_wall(made_motions):
    """Free casters never let it rock by themselves: µ is far below b/h."""
    block, motions = as_system(Block(0.3, 1.0, 80.0)), list(made_motions(6))

    def fell(*holders):
        system = block
        for holder in (Casters(), *holders):
            system = holder.on(system)
        return overturns([system], motions, scales=[8.0]).overturned

    kerb, wall = Beside(0.2, 0.05), Beside(0.02, 1e3)
    assert not fell().any()
    assert fell(kerb).any()
    np.testing.assert_array_equal(fell(wall), fell(Beside(0.02)))


def test_pads_lie_within_the_base_whichever_way_it_is_turned():
    assert pads_of(Interval(-0.2, 0.2)) == pytest.approx((0.16, 0.16))
    assert max(pads_of(Circle(0.2))) * math.sqrt(2) == pytest.approx(0.16)
    x, y, turn = 0.2, 0.3, math.radians(30)
    corners = np.array([(-x, -y), (x, -y), (x, y), (-x, y)])
    straight = Polygon(tuple(map(tuple, corners.tolist())))
    assert pads_of(straight) == pytest.approx((0.16, 0.24))
    c, s = math.cos(turn), math.sin(turn)
    aslant = Polygon(tuple(map(tuple, (corners @ [[c, s], [-s, c]]).tolist())))
    assert max(pads_of(aslant)) * math.sqrt(2) == pytest.approx(0.16)
    distance, (east, north) = nearest_edge(aslant)
    assert distance == pytest.approx(0.2)
    assert abs(east * c + north * s) == pytest.approx(1)


def test_strengths_are_rounded_up_to_two_digits():
    assert rounded_up(121.0) == 130.0
    assert rounded_up(120.0) == 120.0
    assert rounded_up(0.1801) == pytest.approx(0.19)
    assert rounded_up(0.0) == 0.0
    kinds = holders_beside([Putty(100.0)])
    assert [type(each) for each in kinds][:2] == [Bracket, Cords]


def test_strengths_take_any_unit_of_force_and_none_is_guessed(tmp_path):
    size = {"width": "40 cm", "height": "1.2 m", "pga": "0.3 g"}
    given = [{"putty": "0.15 kN"}, {"putty_kn": 0.15}, {"putty_n": 150}]
    for stated in given:
        (putty,) = asked(**size, **stated).objects.under.holders
        assert putty.bears == pytest.approx(150.0)
    # as a spring balance shows it
    (cords,) = asked(**size, cord="12 kgf").objects.under.holders
    assert cords.strength == pytest.approx(12 * 9.80665)
    with pytest.raises(InputError, match=r"a force such as 120 N.*without a unit"):
        asked(**size, bracket="150")
    table = tmp_path / "table.csv"
    table.write_text("name,width_cm,height_cm,putty,cord_n\nA,40,120,15 kgf,90\n")
    (request,), faults = read_inventory(table, {"pga": "0.3 g"})
    assert not faults
    assert [each.bears for each in request.objects.under.holders] == pytest.approx(
        [15 * 9.80665, 90.0]
    )


HELD = {
    "putty": ({"putty": "120 N"}, "wax or putty", "cera o mastice"),
    "bracket": ({"bracket": "300 N"}, "a bracket", "una staffa"),
    "cord": ({"cord": "300 N"}, "cords", "cavi"),
    "wall": ({"wall": "5 cm"}, "a wall behind it", "un muro dietro"),
    "kerb": (
        {"wall": "5 cm", "wall_height": "10 cm"},
        "a wall 10 cm high behind it",
        "un muro alto 10 cm dietro",
    ),
    "pendulum": (
        {"isolator": "20 cm"},
        "a sliding isolator",
        "un isolatore a scorrimento",
    ),
    "springs": (
        {
            "isolator": "20 cm",
            "isolator_stiffness": "1.8 kN/m",
            "isolator_strength": "90 N",
        },
        "a bilinear isolator",
        "un isolatore bilineare",
    ),
    "casters": ({"casters": "free"}, "casters that roll", "ruote che girano"),
    "locked": ({"casters": "locked"}, "locked casters", "ruote bloccate"),
}


@pytest.mark.parametrize("name", HELD)
def test_where_it_stands_names_what_holds_it(name):
    settings, english, italian = HELD[name]
    request = asked(**BOX, pga="0.3 g", **settings)
    assert catalogue().say(request.where) == f"on the ground with {english}"
    assert catalogue("it").say(request.where) == f"a terra con {italian}"
    both = asked(**BOX, pga="0.3 g", floor="1/3", **settings | {"putty": "1 kN"})
    said = catalogue().say(both.where)
    assert said.startswith("on level 1 of 3 with wax or putty")
    assert english in said


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"wall": "10.5 cm"}, "a wall 10.5 cm behind it"),
        ({"putty": "123 N"}, "a pull of 123 N"),
        ({"isolator": "17.5 cm"}, "17.5 cm to each side"),
    ],
)
def test_what_is_stated_is_said_as_it_was_stated(settings, said):
    """A wall 10.5 cm behind it was called 10 cm away."""
    request = asked(**BOX, pga="0.3 g", **settings)
    (holder,) = request.objects.under.holders
    assert said in catalogue().say(holder.called())


def test_a_limit_that_is_shown_to_help_is_not_said_to_be_zero(few):
    found = assess_with(asked(**BOX, pga="0.6 g"), few, holders=False)
    little = replace(found.changes[0], factor=0.97, lower=0.94, upper=0.998, shown=True)
    said = catalogue().say(findings.mitigation(found, little))
    assert said.endswith(": 3 % less risk (0.2 to 6 %).")


def test_the_first_sentence_at_every_door_names_what_holds_it(few):
    """It said "the object on the ground" of one that stands on an isolator."""
    held = asked(**BOX, pga="0.6 g", putty="2 kN")
    answer = assess_with(held, few, brief=True)
    said = "The object on the ground with wax or putty"
    assert lines_of(answer)[0].startswith(said)
    assert json.loads(as_json(answer))["lines"][0].startswith(said)
    page = page_of(answer)
    assert page.count(f"{said} is ") >= 2
    assert f'<p class="lead">{said}, shaken by' in page
    assert "L'oggetto a terra con cera o mastice" in " ".join(lines_of(answer, "it"))


def test_its_page_takes_off_the_answer_what_a_change_takes_off(found):
    """A bracket that takes off a third stood beside an answer from which a twentieth was off."""
    rows = re.findall(
        r'<tr><td[^>]* data-title="Change">(.*?)</td><td[^>]*>(.*?)</td>',
        page_of(found),
    )
    assert len(rows) == len(found.mitigations) > 5
    for (_, said), change in zip(rows, found.mitigations, strict=True):
        left = min(found.main.value * change.factor, 1.0)
        assert said.replace("\u00a0", " ").lower() == catalogue().say(percent(left))


def test_numbers_of_its_page_stay_on_a_line_with_their_units(found):
    for language in ("en", "it"):
        page = page_of(found, language)
        shown = re.sub(r"<(style|script|svg)\b.*?</\1>", "", page, flags=re.DOTALL)
        text = unescape(re.sub(r"<[^>]+>", "\n", shown))
        assert "PGA 0.6\u00a0g" in text.replace(",", ".")
        assert len(re.findall(r"\d\u00a0(?:%|cm|N)", text)) > 20
        apart = r"\d (?:%|[cmk]?m|s|g|k?g|k?N(?:/m)?|[cm]m/s|kg/m³)(?![\w/])"
        assert re.findall(rf".*{apart}.*", text) == []


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"depth": "50 cm", "isolator": "10 cm"}, "key isolator: .* its depth makes"),
        ({"round": True, "wall": "5 cm"}, "key wall: .* its round base makes"),
        (
            {"round": True, "wall": "5 cm", "wall_height": "9 cm"},
            "key wall: .* its round base makes",
        ),
        (
            {"depth": "50 cm", "wall": "5 cm", "wall_height": "9 cm"},
            "key wall_height: .* its depth makes",
        ),
    ],
)
def test_what_is_not_simulated_in_space_is_refused_with_what_to_leave_out(
    settings, words, few
):
    """It spoke of second components and of bodies with a base and a face, which no key gives."""
    request = asked(width="35 cm", height="120 cm", pga="0.6 g", **settings)
    with pytest.raises(InputError, match=rf"^{words} .*; leave out one of them\.$"):
        assess_with(request, few)


def test_what_rolls_and_never_rocks_starts_to_rock_at_no_level(few):
    """It "does not move … it starts to rock at PGA unknown g", on casters that roll."""
    request = asked(width="60 cm", height="2 m", pga="0.4 g", casters="free")
    found = assess_with(request, few, holders=False)
    said = "with casters that roll does not rock at PGA 0.4 g, nor at any level that"
    assert math.isinf(found.rocks_from) and said in lines_of(found)[0]
    behind = " ".join(details_of(found))
    assert "It rolls on its casters. It is held" in behind
    assert "It rocks across" not in behind
    for language in ("en", "it"):
        words = [*lines_of(found, language), *details_of(found, language)]
        assert catalogue(language).text("unknown") not in " ".join(words)


def test_one_pedestal_under_what_is_held_is_one():
    """It was "safest fixed to its pedestals" on a single one, as many bodies and what holds one take as long."""
    pedestal = {"width": "60 cm", "height": "30 cm"}
    held = asked(**BOX, pga="0.3 g", pedestal=pedestal, putty="80 N").objects
    assert list(held.arrangements())[:2] == ["on_its_pedestal", "fixed_to_its_pedestal"]


def test_what_slides_on_locked_casters_and_never_rocks_is_not_said_to_rock(few):
    """It "does not rock … nor at any level", and "rocks, turns and walks"."""
    request = asked(width="60 cm", height="0.8 m", pga="0.4 g", casters="locked")
    found = assess_with(request, few, holders=False)
    behind = " ".join(details_of(found))
    assert math.isinf(found.rocks_from)
    assert "It slides on its locked casters. It is held" in behind


def test_without_a_level_the_answer_says_why_nothing_that_may_hold_it_is_tried(few):
    """It said that holders are tried "on the page", which tries none without a level."""
    found = assess_with(asked(width="30 cm", height="1 m"), few)
    said = " ".join(details_of(found))
    assert "is tried where the level of shaking is given" in said
    assert "on the page: what it must bear" not in said


def test_words_name_the_distance_of_a_wall_and_the_height_of_ties_as_they_are_set():
    block = Block(0.4, 1.5, 80.0)
    (wall,) = Beside(0.07).on(as_system(block)).constraints
    said = Beside(0.07).called()["distance"]
    assert said.value == pytest.approx(100 * (wall.distance - 0.2))
    for holder in (Cords(500.0, 0.004), Bracket(500.0, 0.004)):
        tie, *_ = holder.on(as_system(block)).constraints
        words = holder.called()
        assert words["height"]["value"].value == pytest.approx(100 * tie.point[2] / 1.5)
        assert words["slack"]["size"].value == pytest.approx(1000 * tie.slack)
