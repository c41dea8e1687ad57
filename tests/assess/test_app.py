"""The page of ``rockfrag app`` says what ``rockfrag assess`` does: its scripts in Node, of random objects."""

import importlib.util
import os
import random
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess.answer import LEVELS_OF_HOLDERS, assess_with, plan_for
from rockfrag.assess.app.build import PATH
from rockfrag.assess.findings import mitigation_cell
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import make_intensity_levels
from rockfrag.assess.request import make_request
from rockfrag.assess.standing.holders import Beside, Casters, Putty
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.cli.assess_commands import form_of
from rockfrag.cli.main import main
from rockfrag.outcomes.limit_states import LEANS
from rockfrag.words.findings import as_data

from ..app_forms import settings_of, some_form, some_form_in_space
from ..case_tables import case_tables
from .in_node import check_all, check_figures, in_node, needs_node, same
from .samples import quantile_files


def some_round_form_on_a_pedestal(rng: random.Random) -> dict[str, str]:
    """A random round object without a measured restitution, on a pedestal at least as wide."""
    form = {key: value for key, value in some_form(rng).items() if key != "restitution"}
    width = float(form["width"].split()[0]) * rng.uniform(1, 2)
    return form | {
        "round": True,
        "pedestal_width": f"{width} cm",
        "pedestal_height": "60 cm",
    }


@needs_node
@pytest.mark.parametrize(
    ("some", "few", "seed", "objects", "least"),
    [
        (some_form, False, 5, 2, 2),
        (some_form_in_space, True, 8, 1, 1),
        (some_round_form_on_a_pedestal, True, 11, 1, 1),
        pytest.param(some_form, False, 6, 200, 180, marks=pytest.mark.slow),
        pytest.param(some_form_in_space, False, 9, 100, 80, marks=pytest.mark.slow),
        pytest.param(
            some_round_form_on_a_pedestal, True, 12, 20, 16, marks=pytest.mark.slow
        ),
    ],
)
def test_the_page_says_what_assess_does(
    tmp_path, motions, some, few, seed, objects, least
):
    rng = random.Random(seed)
    if few:  # six records with both components, and one with one
        ground = motions.ground[:13]
        motions = MotionSet(ground, ground, motions.pairs[:6], "made motions")
    forms, answered = [some(rng) for _ in range(objects)], 0
    for form, said in zip(forms, in_node(tmp_path, motions, forms), strict=True):
        assert "failed" not in said, said
        try:
            check_all(motions, settings_of(form), said)
        except InputError as error:
            assert "answer" not in said, (form, error)
            continue
        answered += 1
    assert answered >= least


USUAL = {
    "width": "35 cm",
    "height": "1,2 m",
    "measure": "PGA",
    "level": "0,3 g",
    "years": "475",
}


TRIED = ("putty", "bracket", "cord", "isolator", "springs")
HELD = {"width": "20 cm", "height": "80 cm", "mass": "60 kg"}


def of_holder(holder: str, mitigations):
    """The mitigation of a holder that was tried."""
    name = f"hold_{holder}".replace("cord", "cords")
    found = [each for each in mitigations if each.change.id == Text.HOLDS]
    return next(each for each in found if each.change["change"].id == name)


@needs_node
@pytest.mark.parametrize(
    ("more", "kinds"),
    [
        ({}, ("putty", "bracket", "isolator", "springs")),
        ({"depth": "30 cm"}, ("putty", "cord")),
        # what is wider than its pedestal
        ({"pedestal_width": "16 cm", "pedestal_height": "30 cm"}, ("putty",)),
        pytest.param({}, TRIED, marks=pytest.mark.slow),
        pytest.param(
            {"pedestal_width": "40 cm", "pedestal_height": "50 cm"},
            TRIED,
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"pedestal_width": "40 cm", "pedestal_height": "50 cm", "floor": "2/4"},
            TRIED,
            marks=pytest.mark.slow,
        ),
        pytest.param({"depth": "30 cm", "facing": "25"}, TRIED, marks=pytest.mark.slow),
        pytest.param({"round": True}, TRIED, marks=pytest.mark.slow),
    ],
)
def test_what_holds_it_is_tried_live_as_assess_tries_it(tmp_path, motions, more, kinds):
    """The same demand, in as many motions, the same factor with its limits, and the same words."""
    ground = motions.ground[:12]
    motions = MotionSet(ground, ground, motions.pairs[:6], "made motions")
    form = HELD | more | {"measure": "PGA", "level": "0.5 g", "years": "475"}
    tries = [{"there": None, "kind": kind, "bears": None} for kind in kinds]
    (said,) = in_node(tmp_path, motions, [form | {"hold": tries}])
    assert "failed" not in said, said
    request = make_request(settings_of(form), "test")
    found = assess_with(request, motions.at(request.place))
    for kind, live in zip(kinds, said["held"], strict=True):
        tried = of_holder(kind, found.mitigations)
        assert live["asked"]["held"] == tried.change["held"]
        for name in ("value", "factor", "lower", "upper"):
            number = getattr(tried, name)
            known = number if np.isfinite(number) else None
            assert live["does"][name] == known, (kind, name)
        assert (live["does"]["helps"], live["does"]["shown"]) == (
            tried.helps,
            tried.shown,
        )
        assert same(live["said"]["values"]["change"], as_data(tried.change))
        does = as_data(mitigation_cell(found, tried))
        assert same(live["said"]["values"]["does"], does)


@needs_node
@pytest.mark.parametrize(
    "more", [{}, pytest.param({"depth": "30 cm"}, marks=pytest.mark.slow)]
)
def test_what_stands_at_a_wall_or_rolls_is_shaken_live_as_the_engine_does(
    tmp_path, motions, more
):
    ground = motions.ground[:12]
    motions = MotionSet(ground, ground, motions.pairs[:6], "made motions")
    wall, rolls = {"kind": "wall", "value": 0.02}, {"kind": "casters", "value": False}
    far = wall | {"value": 0.18}
    tries = [
        {"there": wall, "kind": None, "bears": None},
        {"there": wall, "kind": "off_wall", "bears": None},
        {"there": rolls, "kind": "locked", "bears": None},
        {"there": wall, "kind": "putty", "bears": 250.0},
        {"there": far, "kind": None, "bears": None},
    ]
    holders = [
        ([], [Beside(0.02)]),
        ([Beside(0.02)], []),
        ([Casters()], [Casters(locked=True)]),
        ([Beside(0.02)], [Beside(0.02), Putty(250.0)]),
        ([], [Beside(0.18)]),
    ]
    form = HELD | {"width": "8 cm"} | more | {"measure": "PGA", "level": "0.3 g"}
    (said,) = in_node(tmp_path, motions, [form | {"hold": tries}])
    assert "held" in said, said
    objects = make_request(settings_of(form), "test").objects
    both = motions.with_both_components() if more else motions
    few = both.thinned() if more else both.thinned().thinned()
    shaking = make_intensity_levels(few, PGA, [0.3], LEVELS_OF_HOLDERS)
    body = objects.body
    system = objects.solid(body) if more else objects.system_of(body)
    for pair, live in zip(holders, said["held"], strict=True):
        for name, there in zip(("free", "held"), pair, strict=True):
            held = system
            for holder in there:
                held = holder.on(held)
            found, _ = shaking.outcomes_of_system(held)
            rows = np.array(live["outcomes"][name]["motions"])
            fell, leaning = (
                np.reshape(live["outcomes"][name][state], (12, -1))[rows] > 0
                for state in ("overturned", "leaning")
            )
            np.testing.assert_array_equal(fell, found.overturned)
            either = found.others.get(LEANS, found.overturned)
            np.testing.assert_array_equal(fell | leaning, either)
        # what 250 N hold in as many motions
        assert (
            0 <= said["held"][3]["asked"]["held"] <= said["held"][3]["asked"]["total"]
        )
    # it stands no more, though it does not lie: the page says in how many motions
    beside, away = said["held"][4]["after"], said["held"][4]["before"]
    assert beside["leans"] > 0.05 and away["leans"] == 0


@needs_node
def test_hostile_input_gets_a_sentence(tmp_path, motions):
    given = case_tables(__file__)
    forms = [
        USUAL | {field: text} for field in given["fields"] for text in given["hostile"]
    ]
    hazards = given["hazards"] + given["hostile"]
    forms += [USUAL | {"years": "", "hazard": text} for text in hazards]
    forms += [
        USUAL | more for more in ({"round": True}, {"width": ""}, {"floor": "5/4"})
    ]
    refused = in_node(tmp_path, motions, forms)
    assert not [said for said in refused if "failed" in said]
    assert all(said["refused"][2] for said in refused if "refused" in said), (
        "each has its sentence"
    )
    assert sum("refused" in said for said in refused) > 0.9 * len(forms)


@needs_node
def test_a_direction_that_changes_nothing_is_refused_as_the_command_does(
    tmp_path, motions
):
    """Numbers with 0 and 45 degrees were equal where a restitution was given, and nothing was said."""
    deep = USUAL | {"depth": "30 cm", "facing": "45"}
    one = replace(motions, pairs=())
    for known, more in ((motions, {"restitution": "0.7"}), (one, {})):
        (refused,) = in_node(tmp_path, known, [deep | more])
        assert refused["refused"] == ["facing", "facing_in_plane", True]
    keys = {"width": "35 cm", "height": "1.2 m", "depth": "30 cm", "facing_deg": 45}
    with pytest.raises(InputError, match=r"facing.*one plane"):
        make_request(keys | {"restitution": 0.7}, "test")
    with pytest.raises(InputError, match=r"facing.*one plane"):
        plan_for(make_request(keys | {"pga": "0.3 g"}, "test"), one, brief=True)


BUILDING = case_tables(__file__)["building"]
KNOWN = {"storey_height": "4 m", "material": "concrete"}
SLENDER = {"width": "20 cm", "height": "80 cm", "measure": "PGA", "level": "0.3 g"}


@needs_node
@pytest.mark.parametrize(
    ("floor", "building", "typed"),
    [
        pytest.param("gallery", BUILDING, {}, marks=pytest.mark.slow),
        pytest.param("2/3", BUILDING, {}, marks=pytest.mark.slow),
        ("2/4", KNOWN, {"floor": "3/4"}),
    ],
)
def test_a_building_that_is_given_has_the_bits_of_the_package(
    tmp_path, motions, floor, building, typed
):
    form = (
        SLENDER
        | {"years": "475", "floor": floor}
        | (KNOWN if building is KNOWN else {})
    )
    settings = settings_of(form) | {"building": building}
    given = make_request(settings, "test")
    first, said = in_node(tmp_path, motions, [form, form | typed], given)
    assert "answer" in first
    check_all(motions, settings | typed, said)


@needs_node
@pytest.mark.parametrize(
    "measure", [pytest.param("PGA", marks=pytest.mark.slow), "SA(0.3)"]
)
def test_a_hazard_that_is_given_or_pasted_counts_with_its_quantiles(
    tmp_path, motions, measure
):
    size, files = (
        {"width": "15 cm", "height": "80 cm"},
        quantile_files(tmp_path, measure),
    )
    request = make_request(size | {"hazard": files}, "test")
    assert set(request.hazard[0].quantiles) == {0.16, 0.84}
    form = form_of(size | {"hazard": files}, request) | size
    pasted = form | {"hazard": "level rate\n" + form["hazard"].replace(" ", "; ")}
    given, mean_alone = in_node(tmp_path, motions, [form, pasted], request)
    check_figures(assess_with(request, motions, holders=False), given["answer"])
    assert given["answer"]["probability"]["sources"]["hazard"] > 0
    request = make_request(size | {"hazard": files[:1]}, "test")
    check_figures(assess_with(request, motions, holders=False), mean_alone["answer"])


@needs_node
def test_floors_of_any_building_have_the_bits_of_the_package(tmp_path, motions):
    """Both take modes and steps of the core, whatever the storeys, the material and the period."""
    rng, forms = random.Random(8), []
    for storeys in (1, 9, 30):
        floor = f"{rng.randint(1, storeys)}/{storeys}"
        known = {"storey_height": f"{rng.uniform(2.5, 5):.2f} m"}
        known["material"] = rng.choice(["masonry", "steel"])
        forms.append(SLENDER | {"floor": floor} | known)
    forms[1]["period"] = "0.9 s"
    for form, said in zip(forms, in_node(tmp_path, motions, forms), strict=True):
        known = {key: form[key] for key in KNOWN}
        if "period" in form:
            known["first_period_s"] = float(form["period"].split()[0])
        check_all(motions, settings_of(form) | {"building": known}, said)


def test_the_command_writes_a_page_and_refuses_what_it_cannot_say(
    own_records, tmp_path, capsys
):
    path = tmp_path / "assess.html"
    records = ["--record", str(own_records / "catalogue.csv"), "--output", str(path)]
    command = ["app", "--width", "20cm", "--height", "1m", "--pga", "0.3g", *records]
    for more in (
        ["--friction", "0.5"],
        ["--pga", "0.4g"],
        ["--pgv", "20cm/s"],
        ["--up", "y"],
    ):
        assert main([*command, *more]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
    assert not path.exists()
    assert main(command) == 0
    page = path.read_text()
    assert len(page) < 6_000_000
    assert "http:" not in page.replace("http-equiv", "") and "https:" not in page


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang, the linker, is not installed",
)
def test_the_module_of_the_core_is_that_of_its_functions():
    code = "from rockfrag.assess.app.build import build_core; made = build_core()"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; {code}; sys.stdout.buffer.write(made)"],
        env={**os.environ, "PYTHONHASHSEED": "3"},
        check=True,
        capture_output=True,
    )
    assert done.stdout == PATH.read_bytes(), "python -m rockfrag.assess.app.build"
