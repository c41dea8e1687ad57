"""The keys ``friction``, ``vertical`` and ``bodies.restitution`` of a study, and what cannot stand beside them."""

import re
from pathlib import Path

import numpy as np
import pytest

from rockfrag.building.floors import vertical_motions
from rockfrag.building.settings import make_building
from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.motions.directions import motion_and_vertical
from rockfrag.records.catalogue import read_catalogue
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.study.loading import any_study, load_any
from rockfrag.system.contact import BY_MOMENTUM, ImpactLaw
from rockfrag.yaml_file import read_yaml

from .conftest import CATALOGUE, study_content, write_record, write_study

CONFIG = Path(__file__).parents[2] / "config"
SMOKE = CONFIG / "smoke.yaml"


def smoke(**keys: object):
    return any_study({**read_yaml(SMOKE), **keys}, SMOKE)


@pytest.mark.parametrize(
    ("friction", "alone", "stacked"),
    [
        (0.3, [(0.3, 0.3)], [(0.3, 0.3), (0.3, 0.3)]),
        (
            {"ground": 0.4, "interface": {"static": 0.6, "kinetic": 0.5}},
            [(0.4, 0.4)],
            [(0.4, 0.4), (0.6, 0.5)],
        ),
    ],
)
def test_each_contact_has_the_friction_that_the_study_states(friction, alone, stacked):
    study = smoke(friction=friction)
    found = {
        configuration.name: [on.friction for on in configuration.contacts]
        for configuration in study.configurations
    }
    assert found["T1"] == alone
    assert found["P&T1"] == stacked


def test_without_the_keys_nothing_slides_and_nothing_moves_up_and_down():
    study = smoke()
    assert not any(configuration.loose for configuration in study.configurations)
    assert (study.slides, study.vertical) == (False, False)
    under = [
        contact for configuration in study.configurations for contact in configuration.contacts
    ]
    assert {contact.law.name for contact in under} == {"momentum"}


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"friction": -0.1}, "friction: expected a coefficient from 0 to 10"),
        ({"friction": {"ground": 0.3}}, "friction.interface is missing; expected a coefficient"),
        ({"friction": {"ground": 0.3, "interface": -1}}, "friction.interface: expected a coeff"),
        (
            {"friction": {"ground": {"static": 0.3, "kinetic": 0.5}, "interface": 1}},
            "0.3 is less than the kinetic one 0.5",
        ),
        ({"friction": "rough"}, "friction: expected a coefficient"),
        ({"vertical": "yes"}, "vertical: expected true"),
        ({"vertical": True}, "names no vertical component of .*; give it in the column vertical"),
    ],
)
def test_what_cannot_be_is_refused_when_the_study_is_read(keys, message):
    with pytest.raises(InputError, match=message) as caught:
        smoke(**keys)
    assert len(str(caught.value)) <= 500


def test_measured_impacts_and_friction_may_be_given_together():
    tower = study_with({"blocks": {"T1": 0.9}}, friction=0.3).configurations[0]
    assert tower.name == "T1"
    assert tower.contacts[0].friction == (0.3, 0.3) and tower.contacts[0].law.right == 0.9
    assert not overturns(tower, [np.zeros(10)], 0.01).overturned.any()


@pytest.mark.parametrize("key", ["friction", "vertical"])
def test_what_rocks_without_sliding_is_refused_beside_them(key):
    source = CONFIG / "thesis.yaml"
    content = {**read_yaml(source), key: 0.3 if key == "friction" else True}
    with pytest.raises(
        InputError, match=f"key {key}: the perturbed parameters of the key sensitivity_analysis"
    ):
        any_study(content, source)
    del content["sensitivity_analysis"]
    with pytest.raises(InputError, match=f"key {key}: what the key compare_with"):
        any_study(content, source)


@pytest.fixture
def with_vertical(study_folder: Path) -> Path:
    """The small study with a vertical component of every record, twice as long as it must be."""
    header = CATALOGUE.replace(",sha256", ",vertical,sha256").replace(
        "licence", "scale_factor,licence"
    )
    rows = [header]
    for number in range(2):
        write_record(study_folder / f"up{number}.txt", seed=50 + number)
        cells = f"motion {number},E{number},,,,,,folder,record{number}.txt,up{number}.txt,,g,2,made up\n"
        rows.append(cells)
    (study_folder / "motions.csv").write_text("".join(rows))
    return study_folder


def test_the_vertical_component_is_the_catalogues_with_the_factor_of_its_row(with_vertical: Path):
    row = read_catalogue(with_vertical / "motions.csv").to_dict("records")[0]
    motion, up = motion_and_vertical(
        {str(k): v for k, v in row.items()}, with_vertical, with_vertical
    )
    raw = np.loadtxt(with_vertical / "up0.txt")[:, 1]
    assert motion.name == up.name == "motion 0"
    assert up.acceleration.size == motion.acceleration.size
    np.testing.assert_allclose(up.acceleration / up.pga, raw / abs(raw).max(), atol=1e-12)
    assert up.pga == pytest.approx(2 * motion.pga / 2, rel=1e-3)


def test_check_config_reads_the_vertical_components_too(with_vertical, capsys):
    path = write_study(with_vertical, {**study_content(), "vertical": True})
    assert main(["check-config", str(path)]) == 0
    (with_vertical / "up1.txt").write_text("Not a record.\n")
    assert main(["check-config", str(path)]) == 2
    assert "up1.txt" in capsys.readouterr().err


def test_a_step_that_looks_at_one_component_is_refused(with_vertical: Path):
    content = {**study_content(), "vertical": True}
    content["motions"] = {**content["motions"], "processing": [{"step": "strong_part"}]}
    with pytest.raises(
        InputError, match=re.escape("motions.processing[0]: strong_part looks at one")
    ):
        load_any(write_study(with_vertical, content))


def test_a_building_says_which_floors_move_up_and_down_more_than_the_ground():
    settings = {
        "storey_heights_m": [3.0, 3.0],
        "masses_kg": [1e5, 1e5],
        "first_period_s": 0.2,
        "floors": {"hall": 0, "loft": 2},
    }
    up = Motion(np.sin(np.arange(50.0)), 0.01, "quake")
    plain = vertical_motions(make_building(settings), up)
    assert [item.name for item in plain] == ["quake_hall", "quake_loft"]
    assert all((item.acceleration == up.acceleration).all() for item in plain)
    soft = vertical_motions(make_building({**settings, "vertical_factors": {"loft": 1.5}}), up)
    np.testing.assert_allclose(soft[1].acceleration, 1.5 * up.acceleration)
    with pytest.raises(InputError, match="floor 'attic' is not defined"):
        make_building({**settings, "vertical_factors": {"attic": 2}})


def study_with(restitution, **keys):
    return smoke(**keys, bodies={**read_yaml(SMOKE)["bodies"], "restitution": restitution})


def test_each_block_brings_what_was_measured_of_it():
    study = study_with({"law": "ratio", "blocks": {"T1": 0.9, "P": [0.3, 0.35]}})
    found = {
        configuration.name: [under.law for under in configuration.contacts]
        for configuration in study.configurations
    }
    pedestal, tower = ImpactLaw("ratio", 0.3, 0.35), ImpactLaw("ratio", 0.9, 0.9)
    assert found["T1"] == [tower]
    assert found["P&T1"] == [pedestal, tower]
    assert found["T3"] == [BY_MOMENTUM]
    assert found["P&T3"] == [pedestal, BY_MOMENTUM]


@pytest.mark.parametrize(
    ("restitution", "message"),
    [
        ({"blocks": {"X": 0.9}}, "blocks: expected names of the specimens T1, .*, found X"),
        ({"blocks": {"T1": 1.1}}, "1.1 would gain energy"),
        ({"law": "newton", "blocks": {"T1": 0.9}}, "expected one of position, couple, ratio"),
        ({"blocks": {"T1": "a"}}, "blocks.T1: expected a ratio"),
        ({}, "restitution"),
    ],
)
def test_a_restitution_that_cannot_be_is_refused(restitution, message):
    with pytest.raises(InputError, match=message):
        study_with(restitution)
