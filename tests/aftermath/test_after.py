"""After an earthquake: what is said of each object is the mean over the shaking that its place may have had."""

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.aftermath.check_list import after_lines, after_page
from rockfrag.aftermath.sequence import one_after_the_other
from rockfrag.aftermath.shakemap import read_shakemap
from rockfrag.aftermath.shaken_ground import (
    GroundShaking,
    level_of,
    mapped_ground,
    recorded_ground,
)
from rockfrag.aftermath.shaken_objects import (
    ShakenObject,
    after_earthquake,
    shaken_table,
)
from rockfrag.assess.answer import assess_with
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.motions import motion_set
from rockfrag.assess.request import Level, LevelSpread, make_request
from rockfrag.assess.risk import fraction_target
from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation import overturns
from rockfrag.system.blocks import Block

from .grids import AFTERSHOCK, write_aftershock, write_grids

INVENTORY = """\
name,width,height,latitude,longitude,floor
near,30 cm,120 cm,35.0,134.9,
far,30 cm,120 cm,35.0,135.9,
stout,90 cm,100 cm,35.0,134.9,
upstairs,30 cm,120 cm,35.0,135.4,3/4
"""


@pytest.fixture(scope="module")
def records(own_records):
    return {"records": {"paths": [str(own_records / "catalogue.csv")]}}


@pytest.fixture
def place(tmp_path):
    write_grids(tmp_path)
    (tmp_path / "inventory.csv").write_text(INVENTORY)
    return tmp_path


def write_rows(place, *rows: int):
    """An inventory of some rows of the usual one."""
    lines, path = INVENTORY.splitlines(), place / "rows.csv"
    path.write_text("\n".join(lines[i] for i in (0, *rows)) + "\n")
    return path


@pytest.fixture
def collection(place, records):
    shakemap = read_shakemap(place / "grid.xml", place / "uncertainty.xml")
    return after_earthquake(
        place / "inventory.csv", lambda at: mapped_ground(shakemap, *at), records
    )


def test_the_mean_over_levels_is_that_of_a_fraction_linear_in_ln_level():
    levels = np.geomspace(0.05, 2.0, 9)
    fractions = np.array([0, 0, 0.1, 0.3, 0.35, 0.8, 0.8, 0.95, 1.0])
    found = fraction_target(0.3, spread=0.5).of(levels, fractions)
    rng = np.random.default_rng(1)
    drawn = np.log(0.3) + 0.5 * rng.standard_normal(400_000)
    mean = np.interp(drawn, np.log(levels), fractions).mean()
    assert found == pytest.approx(mean, abs=1e-3)
    # of a level that is known all but exactly it is the fraction there
    exact = fraction_target(0.3).of(levels, fractions)
    assert fraction_target(0.3, spread=1e-6).of(levels, fractions) == pytest.approx(
        exact
    )


@pytest.mark.slow
def test_what_is_said_under_a_map_is_the_mean_of_what_is_said_at_each_level(records):
    """Exact levels drawn from the joint distribution of PGA and PGV, one assessment each, against one in all."""
    request = make_request({"width": "30 cm", "height": "120 cm", **records}, "test")
    motions = motion_set(request.records, request.place, ".")
    ground = GroundShaking(0.35, 40.0, 0.4, 0.5)
    level = level_of(ground)
    asked = replace(request, level=level)
    found = assess_with(asked, motions, brief=True)
    rng = np.random.default_rng(3)
    first, other = rng.standard_normal((2, 24))
    along = level.spread.correlation
    fell, rocked = [], []
    for a, b in zip(first, other, strict=True):
        pga = 0.35 * math.exp(0.4 * a)
        mixed = along * a + math.sqrt(1 - along**2) * b
        exact = Level(PGA, pga, 40.0 * math.exp(0.5 * mixed))
        each = assess_with(replace(request, level=exact), motions, brief=True)
        fell.append(each.fraction.value)
        rocked.append(each.rocking.value)
    for estimate, drawn in ((found.fraction, fell), (found.rocking, rocked)):
        error = np.std(drawn) / math.sqrt(len(drawn))
        assert abs(estimate.value - np.mean(drawn)) < 2.5 * error + 0.01


def test_a_level_that_is_less_well_known_leaves_more_open(records):
    request = make_request({"width": "30 cm", "height": "120 cm", **records}, "test")
    motions = motion_set(request.records, request.place, ".")

    def said(median: float, spread: float) -> float:
        level = Level(PGA, median, spread=LevelSpread(spread))
        found = assess_with(replace(request, level=level), motions, brief=True)
        return found.fraction.value

    assert said(0.12, 0.1) < said(0.12, 0.8) < 0.5


def test_objects_are_listed_by_how_probably_they_fell(collection):
    table = shaken_table(collection).set_index("name")
    chances = table["probability_fell"]
    assert chances.is_monotonic_decreasing
    assert chances["near"] > chances["far"] and chances["stout"] < 0.02
    both = chances + table["probability_rocked_and_stands"]
    assert (both <= 1 + 1e-12).all() and both["near"] > both["far"]
    assert collection.expected_falls == pytest.approx(chances.sum())
    assert (table["probability_fell_lower"] <= chances).all()
    assert table["place"]["upstairs"] == "on level 3 of 4"


def test_at_one_place_an_object_is_as_in_a_group_of_its_own(place, records):
    ground = GroundShaking(0.3, 35.0, 0.3, 0.3)
    rows = INVENTORY.splitlines()
    (place / "one.csv").write_text("\n".join([rows[0], rows[1]]) + "\n")
    (place / "two.csv").write_text("\n".join([*rows[:2], rows[3]]) + "\n")
    alone, all_ = (
        after_earthquake(place / name, lambda _: ground, records)
        for name in ("one.csv", "two.csv")
    )
    found = {each.request.name: each.fell for each in all_.objects}
    assert alone.objects[0].fell == pytest.approx(found["near"], abs=1e-3)


def test_the_command_writes_a_page_to_tick_off_a_table_and_json(
    place, own_records, capsys
):
    out = place / "out"
    arguments = ["after", str(place / "inventory.csv"), "--output", str(out)]
    arguments += ["--shakemap", str(place / "grid.xml")]
    arguments += ["--record", str(own_records / "catalogue.csv")]
    assert main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    assert sum(" fell " in line and "rocked" in line for line in lines) == 4
    page = (out / "after.html").read_text(encoding="utf-8")
    # done, and seen to have fallen, moved or neither
    assert page.count('<input type="checkbox"') == 4 * 4
    assert "http" not in page.replace("http-equiv", "")
    with (out / "after.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    answer = json.loads((out / "after.json").read_text())
    assert [row["name"] for row in rows] == [each["name"] for each in answer["objects"]]
    assert answer["objects"][0]["probability_fell"] == pytest.approx(
        float(rows[0]["probability_fell"])
    )
    assert len(answer["ground"]) == 4 and answer["ground"][0]["pga_spread"] == 0.4


def test_the_record_of_the_place_shakes_each_object_itself(
    place, own_records, made_motions, capsys
):
    (place / "rows.csv").write_text(
        "name,width,height,depth\nslender,4 cm,120 cm,4 cm\nstout,2 m,1 m,\nplate,12 cm,60 cm,\n"
    )
    pair = [
        str(own_records / f"{motion.name.replace(' ', '')}.txt")
        for motion in made_motions(12)[:2]
    ]
    arguments = ["--station", *pair, "--unit", "g", "--output", str(place / "out")]
    arguments += ["--records", str(own_records)]
    arguments += ["--record", str(own_records / "catalogue.csv")]
    assert main(["after", str(place / "rows.csv"), *arguments]) == 0
    with (place / "out" / "after.csv").open(newline="") as file:
        rows = {row["name"]: row["under_the_record"] for row in csv.DictReader(file)}
    assert rows["slender"] == "fell" and rows["stout"] == "stood"
    said = capsys.readouterr().out
    assert "Shaking by record" in said and "factor of 1." not in said
    assert "Under the record" in (place / "out" / "after.html").read_text()


def test_two_shocks_fell_more_than_one_and_errors_of_an_object_are_its_own(
    place, records
):
    ground = GroundShaking(0.25, 30.0, 0.2, 0.2)

    counted: list[tuple[float, float]] = []

    def found(then) -> dict:
        collection = after_earthquake(
            place / "inventory.csv",
            lambda _: ground,
            records,
            then=then,
            progress=lambda *count: counted.append(count),
        )
        return {each.request.name: each for each in collection.objects}

    once = found(None)
    counted.clear()
    twice = found(lambda _: ground)
    # progress goes once to the end, over both shocks
    assert counted == sorted(counted) and counted[-1] == (8, 8)
    for name, each in twice.items():
        first = once[name].fell
        # what survived a shock is stronger than others: less than of two that know nothing of each other
        assert first <= each.fell <= 1 - (1 - first) ** 2 + 1e-9
        assert each.fell + each.moved <= 1 + 1e-9
    assert twice["upstairs"].fell > once["upstairs"].fell + 0.01


def test_a_sequence_is_both_motions_with_quiet_time_between_them(made_motions):
    first, second = made_motions(4)[:2], made_motions(4)[2:]
    joined = one_after_the_other(first, second, quiet=20.0)
    body = Block(0.12, 0.6, 20.0)
    for motion, alone, after in zip(joined, first, second, strict=True):
        assert motion.pga == max(alone.pga, after.pga)
        # without friction a block that stands is where it was: falls are those of either shock
        scales = np.geomspace(0.1, 3, 12)[np.newaxis]
        fell = [
            overturns(body, each, scales=scales).overturned[0, 0]
            for each in (motion, alone, after)
        ]
        assert (fell[0] == (fell[1] | fell[2])).all() and fell[0].any()
    with pytest.raises(InputError, match="components"):
        one_after_the_other(first, second[:1])


def test_an_aftershock_finds_an_object_in_space_where_the_main_shock_left_it(
    place, own_records
):
    """One record twice: what it turned the first time it turns further."""
    table = place / "rows.csv"
    table.write_text("name,width,depth,height\nbust,19 cm,20.9 cm,80 cm\n")
    files = [str(own_records / f"motion{i}.txt") for i in (6, 7)]
    ground, recorded = recorded_ground(files, unit="g")
    own = {"records": {"paths": [str(own_records / "catalogue.csv")]}}

    def found(then) -> ShakenObject:
        collection = after_earthquake(
            table, lambda _: ground, own, recorded=recorded, then_recorded=then
        )
        assert "rocked, turned" in after_page(collection)
        assert shaken_table(collection)["moved_cm"].item() > 0
        return collection.objects[0]

    once, twice = found(()), found(recorded)
    sequence = one_after_the_other(recorded, recorded)
    shaking = [GroundMotion(*pair) for pair in (recorded, sequence)]
    solid = once.request.objects.solid(once.request.objects.body)
    turned = np.degrees(overturns([solid], shaking).turn[0, :, 0, 0])
    assert once.left.turned_deg == pytest.approx(abs(turned[0]))
    assert twice.left.turned_deg == pytest.approx(abs(turned[1]))
    assert twice.left.turned_deg > 1.5 * once.left.turned_deg > 0


def test_a_second_record_fells_what_the_first_left_standing(
    place, own_records, made_motions
):
    motion = made_motions(12)[0]
    strong = own_records / f"{motion.name.replace(' ', '')}.txt"
    weak = place / "weak.txt"
    rows = zip(motion.time, 0.02 * motion.acceleration / 9.81, strict=True)
    weak.write_text("".join(f"{t:.2f} {a:.7f}\n" for t, a in rows))
    (place / "rows.csv").write_text(
        "name,width,height\nslender,4 cm,120 cm\nstout,2 m,1 m\n"
    )
    arguments = ["after", str(place / "rows.csv"), "--unit", "g"]
    arguments += ["--record", str(own_records / "catalogue.csv")]
    arguments += ["--output", str(place / "out"), "--station", str(weak)]
    assert main([*arguments, "--then-station", str(strong)]) == 0
    with (place / "out" / "after.csv").open(newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    slender = rows["slender"]
    assert slender["under_the_record"] == "fell in the second shock"
    first = float(slender["probability_fell_in_the_first"])
    assert first < 0.1 < 0.5 < float(slender["probability_fell"])
    assert rows["stout"]["under_the_record"] == "stood"


def test_two_maps_each_with_its_uncertainty_say_what_fell_in_either(
    place, own_records, capsys
):
    write_aftershock(place)
    rows = write_rows(place, 1, 2)
    asked = ["after", str(rows), "--output", str(place / "out"), "--json"]
    asked += ["--record", str(own_records / "catalogue.csv")]
    asked += ["--shakemap", str(place / "grid.xml")]
    asked += ["--map-uncertainty", str(place / "uncertainty.xml")]
    asked += ["--then-shakemap", str(place / "then.xml")]
    asked += ["--then-map-uncertainty", str(place / "then-uncertainty.xml")]
    assert main(asked) == 0
    found = json.loads(capsys.readouterr().out)
    for first, second in zip(found["ground"], found["ground_then"], strict=True):
        assert second["pga"] == pytest.approx(first["pga"] / 2, rel=1e-4)
        assert second["pga_spread"] == 0.5 and first["pgv_spread"] == 0.35
        assert second["magnitude"] == 5.4 and first["magnitude"] == 6.6
    for each in found["objects"]:
        assert each["probability_fell"] > each["probability_fell_in_the_first"]
        assert each["then_pga_g"] == pytest.approx(each["pga_g"] / 2, rel=1e-4)
    page = (place / "out" / "after.html").read_text(encoding="utf-8")
    assert "Then a second shock." in page and "beside these two" in page
    assert "known within a factor" in page
    assert any(AFTERSHOCK in line for line in found["said"])


def test_falls_in_either_of_two_maps_are_those_of_drawn_shocks(place, records):
    """Each world draws both shakings, what is not known of the object, and a motion for each shock."""
    request = make_request({"width": "30 cm", "height": "120 cm", **records}, "test")
    motions = motion_set(request.records, request.place, ".")
    main_shock, after = (
        GroundShaking(0.3, 35.0, 0.3, 0.3),
        GroundShaking(0.2, 25.0, 0.6, 0.6),
    )
    found = after_earthquake(
        write_rows(place, 1), lambda _: main_shock, records, then=lambda _: after
    ).objects[0]
    first, then = (
        assess_with(replace(request, level=level_of(each)), motions, brief=True)
        for each in (main_shock, after)
    )
    rng = np.random.default_rng(5)
    draws = rng.integers(first.fraction.draws.size, size=200_000)
    falls = [
        rng.random(draws.size) < each.fraction.draws[draws] for each in (first, then)
    ]
    assert found.fell == pytest.approx((falls[0] | falls[1]).mean(), abs=0.005)
    # errors of the object are the same in both, so that both fall together oftener than by chance
    together = (falls[0] & falls[1]).mean()
    assert together > falls[0].mean() * falls[1].mean() + 0.01


def test_each_shock_has_the_magnitude_of_its_own_map_where_no_velocity_is_mapped(
    place, records
):
    write_aftershock(place)
    for name in ("grid.xml", "then.xml"):
        text = (place / name).read_text()
        (place / name).write_text(text.replace('name="PGV"', 'name="PGX"'))
    shakemap, second = (
        read_shakemap(place / name) for name in ("grid.xml", "then.xml")
    )
    found = after_earthquake(
        write_rows(place, 1),
        lambda at: mapped_ground(shakemap, *at),
        records,
        then=lambda at: mapped_ground(second, *at),
    )
    for each in found.objects:
        assert each.found.request.records.magnitude == 6.6
        assert each.then.request.records.magnitude == 5.4


def test_objects_beyond_the_map_of_the_second_shock_are_named(place, records):
    main_shock = read_shakemap(place / "grid.xml")
    found = after_earthquake(
        write_rows(place, 1, 2),
        lambda at: mapped_ground(main_shock, *at),
        records,
        then=lambda at: None if at[1] > 135.5 else GroundShaking(0.3, 35.0),
    )
    assert found.then_beyond == ["far"]
    by_name = {each.request.name: each for each in found.objects}
    assert by_name["far"].then is None and by_name["near"].then is not None
    said = " ".join(after_lines(found))
    assert "1 object lies beyond the map of the second shock" in said


@pytest.mark.parametrize(
    ("dt", "then_dt", "common"), [(0.01, 0.004, 0.002), (0.005, 0.0024, 0.0002)]
)
def test_records_sampled_in_other_intervals_make_a_sequence_of_the_same_lines(
    dt, then_dt, common
):
    rng = np.random.default_rng(4)
    first, then = (
        Motion(rng.normal(size=200), step, f"noise {step}") for step in (dt, then_dt)
    )
    (joined,) = one_after_the_other([first], [then], quiet=6.0)
    assert joined.dt == pytest.approx(common)
    times = joined.dt * np.arange(joined.acceleration.size)
    begins = 199 * dt + 6.0 + joined.dt
    for motion, start in ((first, 0.0), (then, begins)):
        own = start + motion.dt * np.arange(200)
        found = np.interp(own, times, joined.acceleration)
        assert found == pytest.approx(motion.acceleration, abs=1e-6)


def test_the_second_shock_begins_at_once_in_components_of_unequal_length():
    pair = [Motion(np.ones(n), 0.01, f"of {n}") for n in (50, 80)]
    joined = one_after_the_other(pair, pair, quiet=1.0)
    assert len({motion.acceleration.size for motion in joined}) == 1
    # 80 samples of the longer first, and the quiet time
    assert all(motion.acceleration[180] == 1 for motion in joined)
    assert not any(motion.acceleration[100:180].any() for motion in joined)


@pytest.mark.parametrize("depth", [None, 0.3])
def test_sequences_of_motions_fell_as_many_as_both_shocks_by_themselves(
    depth, own_records, made_motions
):
    """Each motion at one level, then each at another; in space the second finds a block turned and moved."""
    made = made_motions(12)
    pairs = [GroundMotion(*pair) for pair in zip(made[::2], made[1::2], strict=True)]
    body = Block(0.2, 0.8, 80.0, depth=depth)
    motions = pairs if depth else [pair.x for pair in pairs]
    grid = np.geomspace(0.5, 3.0, 30)
    toppled = overturns(body, motions, scales=grid).overturned[0]
    # half of the motions topple it, the others do not
    first = float(np.median(grid[toppled.argmax(axis=1)]))
    then = 0.95 * first

    def fells(motion, scale: float) -> bool:
        return bool(overturns(body, motion, scales=[scale]).overturned[0, 0, 0])

    alone = [[fells(each, scale) for each in motions] for scale in (first, then)]
    separate, sequences = [], []
    for i, main_shock in enumerate(motions):
        for j, aftershock in enumerate(motions):
            separate.append(alone[0][i] or alone[1][j])
            both = [
                [
                    replace(each, acceleration=each.acceleration * scale)
                    for each in parts
                ]
                for parts, scale in (
                    (_components(main_shock), first),
                    (_components(aftershock), then),
                )
            ]
            joined = one_after_the_other(*both)
            sequence = GroundMotion(*joined) if depth else joined[0]
            sequences.append(fells(sequence, 1.0))
    assert 0.2 < np.mean(separate) < 0.95
    if depth is None:
        assert sequences == separate
    assert abs(np.mean(sequences) - np.mean(separate)) < 0.1


def _components(motion):
    return (motion.x, motion.y) if isinstance(motion, GroundMotion) else (motion,)


def test_hostile_names_stay_text_and_pages_speak_italian(place, records):
    rows = INVENTORY.splitlines()
    (place / "hostile.csv").write_text(
        f'{rows[0]}\n"<b>&{{{{7*7}}}}",30 cm,90 cm,35,135,\n'
    )
    ground = GroundShaking(0.3, 35.0)
    found = after_earthquake(place / "hostile.csv", lambda _: ground, records)
    page = after_page(found, "it")
    assert "&lt;b&gt;&amp;{{7*7}}" in page and "<b>&" not in page
    assert 'lang="it"' in page and "Dopo il terremoto: 1 oggetto" in page
    assert "caduto" in after_lines(found, "it")[-1]


def test_rows_that_were_left_out_stand_on_the_page_to_be_looked_at(place, records):
    rows = INVENTORY.splitlines()
    path = place / "some.csv"
    path.write_text(f"{rows[0]}\n{rows[1]}\nbust <b>,no width,120 cm,35,135,\n")
    ground = GroundShaking(0.3, 35.0)
    found = after_earthquake(path, lambda _: ground, records, keep_going=True)
    page = after_page(found)
    assert "1 row was left out" in page and "some.csv, line 3" in page
    # of what is in the list four boxes, of what is left out one
    assert page.count('type="checkbox"') == 4 + 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "in one way"),
        (["--pga", "0.2 g", "--shakemap", "grid.xml"], "in one way"),
        (["--pga", "0.2 g", "--hazard", "curve.csv"], "--hazard"),
        (["--pga", "0.2 g", "--sd-ln", "-1"], "--sd-ln"),
        (["--pgv", "20 cm/s", "--width", "3 m"], "--width"),
        (["--station", "nowhere.txt", "--station-km", "-3"], "--station-km"),
        (["--pga", "0.2 g", "--map-uncertainty", "u.xml"], "needs --shakemap"),
        (["--shakemap", "grid.xml", "--sd-ln", "0.3"], "--sd-ln is of typed"),
        (["--shakemap", "grid.xml", "--then-shakemap", "grid.xml"], "both of"),
        (["--pga", "0.2 g", "--then-map-uncertainty", "u.xml"], "--then-shakemap"),
        (["--shakemap", "grid.xml", "--then-station", "a"], "needs --station"),
    ],
)
def test_a_wrong_question_is_refused_in_one_sentence(
    options, words, place, capsys, monkeypatch
):
    monkeypatch.chdir(place)
    assert main(["after", "inventory.csv", *options]) == 2
    said = capsys.readouterr().err
    assert words in said and said.count("\n") == 1


def test_places_that_are_missing_wrong_or_beyond_the_map_are_named(
    place, records, capsys, monkeypatch
):
    monkeypatch.chdir(place)
    shakemap = read_shakemap("grid.xml")

    def found(text: str):
        (place / "rows.csv").write_text(text)
        return after_earthquake(
            "rows.csv", lambda at: mapped_ground(shakemap, *at), records
        )

    head = "name,width,height,latitude,longitude\n"
    beyond = found(f"{head}here,30 cm,90 cm,35,135\nthere,30 cm,90 cm,50,135\n")
    assert beyond.beyond == ["there"] and len(beyond.objects) == 1
    assert any("beyond the map: there" in line for line in after_lines(beyond))
    with pytest.raises(InputError, match="does not reach"):
        found(f"{head}there,30 cm,90 cm,50,135\n")
    with pytest.raises(InputError, match="from -90 to 90"):
        found(f"{head}here,30 cm,90 cm,135,35\n")
    with pytest.raises(InputError, match="longitude: expected degrees"):
        found(f"{head}here,30 cm,90 cm,35,\n")
    (place / "bare.csv").write_text("name,width,height\na,30 cm,90 cm\n")
    assert main(["after", "bare.csv", "--shakemap", "grid.xml"]) == 2
    assert "--at" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("name,width_m,height_m\nA,30,120\n", "check the unit"),
        ("name;width_mm;height_mm\nA;1.300;2.200\n", "check the unit"),
        (
            "name,width_m,height_m,latitude,longitude\nA,.3,1.2,3929000,384000\n",
            "latitude: expected degrees",
        ),
        (
            "name,width_m,height_m,latitude,longitude\nA,.3,1.2,35°06',134°54'\n",
            "latitude: expected a number",
        ),
        ("name,width_m,height_m,x,y\nA,.3,1.2,384000,3929000\n", "column 'x'"),
        (
            "name,width_m,height_m,latitude,longitude\nA,.3,1.2,35,\n",
            "as the other coordinate is given",
        ),
        ("name,width_m,height_m\nA,.3,1.2\nA,.3,1.2\n", "is there twice"),
        ('name,width_m,height_m\nA,"0,3","1,2"\n', "decimals with a point"),
    ],
)
def test_inventories_of_other_makes_are_refused_in_one_sentence(table, words, tmp_path):
    path = tmp_path / "inventory.csv"
    path.write_text(table, encoding="utf-8")
    with pytest.raises(InputError, match=words):
        after_earthquake(path, lambda _: GroundShaking(0.3, 30.0))


@pytest.mark.parametrize(
    "table",
    [
        "\ufeffname,width_m,height_m,latitude,longitude\nA,0.3,1.2,35.1,134.9\n",
        "name;width_m;height_m;latitude;longitude\r\nA;0,3;1,2;35,1;134,9\r\n",
        "name\twidth_cm\theight_cm\tlatitude\tlongitude\nA\t30\t120\t35.1\t134.9\n",
    ],
)
def test_inventories_of_other_makes_are_read(table, tmp_path):
    path = tmp_path / "inventory.csv"
    path.write_text(table, encoding="utf-8")
    (request,), faults = read_inventory(path, {})
    assert not faults and request.coordinates == (35.1, 134.9)
    block = request.objects.block
    assert (block.width, block.height) == pytest.approx((0.3, 1.2))
