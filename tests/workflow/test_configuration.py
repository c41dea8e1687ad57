"""A study that cannot run is refused before anything runs, in one sentence with file and key."""

import copy
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
import yaml

from rockfrag.building.floors import vertical_motions
from rockfrag.building.settings import make_building
from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.motions.directions import motions_of_row
from rockfrag.records.catalogue import read_catalogue
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.study.loading import any_study, load_any
from rockfrag.system.contact import BY_MOMENTUM, ImpactLaw
from rockfrag.yaml_file import read_yaml

from .conftest import CATALOGUE, CONFIG, SPECIMENS, study_content, write_record, write_study
from .running import ROOT, finished, snakemake


def refused(folder: Path, content: dict, words: list[str]) -> None:
    """See that a study is refused with some words, behind its folder."""
    path = write_study(folder, content)
    with pytest.raises(InputError) as caught:
        load_any(path)
    message = str(caught.value)
    assert message.startswith(str(folder))
    assert [word for word in words if word not in message] == []


def test_the_studies_of_the_project_are_right():
    for name in ("thesis", "smoke", "wide"):
        assert load_any(CONFIG / f"{name}.yaml").name == name


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c["amplitudes"].update(hihgest_g=2), ["amplitudes.hihgest_g", "highest_g"]),
        (lambda c: c["amplitudes"].pop("lowest_g"), ["amplitudes.lowest_g", "missing", "of g"]),
        (lambda c: c["amplitudes"].update(lowest_g=-0.1), ["amplitudes.lowest_g", "-0.1"]),
        (lambda c: c["amplitudes"].update(lowest_g="0.1 m/s2"), ["amplitudes.lowest_g", "of g"]),
        (lambda c: c["amplitudes"].update(lowest_g=3), ["amplitudes.highest_g", "more than"]),
        (lambda c: c["amplitudes"].update(highest_g=float("nan")), ["amplitudes.highest_g"]),
        (lambda c: c["amplitudes"].update(highest_g=float("inf")), ["amplitudes.highest_g"]),
        (lambda c: c["protocol"].update(step_percent=0), ["protocol.step_percent", "percent"]),
        (lambda c: c["bodies"].update(use=["T9"]), ["bodies.use[0]", "P&T1", "T9"]),
        (lambda c: c["motions"].update(use=["Nowhere"]), ["motions.use[0]", "motion 0"]),
        (lambda c: c["motions"].update(catalogue="no.csv"), ["motions.catalogue", "no.csv"]),
        (lambda c: c["motions"].update(processing=[{"step": "smooth"}]), ["smooth", "highpass"]),
        (lambda c: c["motions"].update(processing=[{"step": "highpass"}]), ["corner_hz"]),
        (lambda c: c.update(building="no.yaml"), ["building", "no.yaml"]),
        (lambda c: c.update(compare_with="nobody"), ["compare_with", "thesis", "nobody"]),
        (lambda c: c.update(study="../elsewhere"), ["study", "lower-case"]),
        (lambda c: c.update(seed=1.5), ["seed", "whole number"]),
        (lambda c: c.update(seed=True), ["seed", "whole number"]),
        (lambda c: c.update(seed=10**300), ["seed", "expected a number of at most"]),
        (lambda c: c.pop("seed"), ["seed", "missing"]),
        (lambda c: c.update(study="tiny\n"), ["key study"]),
        (lambda c: c.update(title="two\nlines"), ["key title: expected one line"]),
        (lambda c: c["fragility"].update(measures=["PGA"]), ["measures[0]: expected one"]),
        (lambda c: c["fragility"].update(measures=["d5_95_s"]), ["found d5_95_s"]),
        (
            lambda c: c["fragility"].update(measures=["pga_g", ["pga_g"]]),
            ["a pair of intensity measures"],
        ),
        (lambda c: c.update(fragility=None), ["fragility", "mapping"]),
    ],
)
def test_a_wrong_key_or_value_is_named_with_what_was_expected(study_folder, change, words):
    content = copy.deepcopy(study_content())
    change(content)
    refused(study_folder, content, words)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (
            SPECIMENS.replace("12.4,37.2", "-12.4,37.2"),
            ["line 2", "width_cm", "more than 0", "-12.4"],
        ),
        (SPECIMENS.replace("width_cm", "width_inch"), ["width_inch", "width_m"]),
        (SPECIMENS.replace("2172", "2 cm"), ["line 2", "mass_g", "2 cm"]),
        (SPECIMENS.replace("2172", "2"), ["line 2", "density", "less than any solid"]),
        (SPECIMENS.replace("width_cm", "width_m"), ["line 2", "kg/m³", "less than any solid"]),
        (SPECIMENS.replace("height_cm", "width_m"), ["twice"]),
        (SPECIMENS.replace("12.4,37.2", "12 kg,37.2"), ["line 2", "expected a length"]),
        (SPECIMENS.replace("mass_g", "mass"), ["line 2", "column mass", "without a unit"]),
        (SPECIMENS.replace("2172", "nan"), ["line 2", "mass_g"]),
        (SPECIMENS.replace("2172", "1e400"), ["line 2", "mass_g"]),
        (SPECIMENS.replace("T2,", "T1,"), ["line 3", "T1", "twice"]),
        (SPECIMENS.replace("2172", "2172,7"), ["line 2", "4 cells"]),
        ("", ["header"]),
        (
            SPECIMENS.replace("P,18.4,20.8", "P,4,2").replace("2300", "50"),
            ["configurations.csv, line 4", "ground"],
        ),
    ],
)
def test_a_wrong_cell_is_named_with_line_and_column(study_folder, table, words):
    (study_folder / "specimens.csv").write_text(table)
    refused(study_folder, study_content(), words)


def test_an_unknown_block_in_a_configuration_is_named(study_folder: Path):
    (study_folder / "configurations.csv").write_text("name,object,pedestal\nX,T7,\n")
    refused(study_folder, study_content(), ["line 2, column object", "T7"])


SENSITIVITY_ANALYSIS = {
    "statue_restitution": [0.9],
    "interface_restitution": [0.95],
    "ground_restitution": [1.5],
    "pedestal_lean_deg": [2],
    "statue_offset_mm": [5],
    "statue_cg_offset_mm": [2],
    "pedestal_width_cm": [14],
    "table_mass_kg": [10],
    "step_percent": [8],
    "friction": {"ground": [0.4], "interface": [0.3, 0.6]},
    "tolerance_percent": 1,
    "tolerance_restitution": 0.02,
    "replicates": 1,
}

SYNTHETIC_TESTS = (
    "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark\nsynthetic "
    "1,T1,NP,First,GF,0.5,0.55,none,statue,1,synthetic\nsynthetic "
    "2,T1,P,First,GF,0.45,0.5,none,statue,1,synthetic\nsynthetic "
    "3,T1,NP,Second,GF,0.6,0.65,none,statue,1,synthetic\nsynthetic 4,T1,P,Second,GF,0.65,,right,,1,synthetic\n"
)


def full_study(folder: Path) -> Path:
    """Write a study with every optional part, each as small as it can be."""
    for name in ("building.yaml", "experiment/shaker.yaml"):
        shutil.copy(ROOT / "config" / name, folder / Path(name).name)
    (folder / "tests.csv").write_text(SYNTHETIC_TESTS)
    content = study_content()
    content["motions"]["use"] = ["motion 0", "motion 2", "motion 4"]
    content["amplitudes"]["step_percent"] = 15
    return write_study(
        folder,
        {
            **content,
            "building": "building.yaml",
            "compare_with": "thesis",
            "shaker": "shaker.yaml",
            "measured_tests": "tests.csv",
            "building_sensitivity": {"first_period_s": [0.5], "floors": [{"F3": 3, "F5": 6}]},
            "sensitivity_analysis": SENSITIVITY_ANALYSIS,
        },
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"shaker": "no.yaml"}, ["key shaker", "no.yaml"]),
        ({"measured_tests": "no.csv"}, ["key measured_tests", "no.csv"]),
        ({"building_sensitivity": {"periods": [1]}}, ["building_sensitivity.periods"]),
        ({"building_sensitivity": {"floors": [{"F5": 9}]}}, ["floors[0].F5", "up to 6", "9"]),
        ({"building_sensitivity": {"floors": [{"attic": 6}]}}, ["floors[0].attic", "GF, F3, F5"]),
        (
            {"sensitivity_analysis": {**SENSITIVITY_ANALYSIS, "replicates": 0}},
            ["sensitivity_analysis.replicates"],
        ),
        (
            {"sensitivity_analysis": {**SENSITIVITY_ANALYSIS, "friction": {"ground": [0.4]}}},
            ["sensitivity_analysis.friction", "interface"],
        ),
        ({"building": None}, ["building"]),
        (
            {"bodies": {**study_content()["bodies"], "use": ["T1", "T2"]}},
            ["key sensitivity_analysis", "with and without"],
        ),
    ],
)
def test_a_wrong_optional_part_is_named(study_folder: Path, change: dict, words: list[str]):
    path = full_study(study_folder)
    content = {**yaml.safe_load(path.read_text()), **change}
    refused(study_folder, {k: v for k, v in content.items() if v is not None}, words)


@pytest.mark.slow
def test_every_optional_part_runs_from_records_to_report(study_folder: Path):
    full_study(study_folder)
    finished(snakemake(study_folder, "--cores", "2"))
    results = study_folder / "results" / "tiny"

    tests = pd.read_csv(results / "tests.csv")
    shaker = pd.read_csv(results / "shaker.csv").set_index("motion")["limit_g"]
    limited = tests[tests["definition"] == "step_protocol_shaker"]
    assert len(limited) == 3 * 3 * 4
    assert (limited["lower_g"] <= limited["motion"].map(shaker) * (1 + 1e-9)).all()

    beside = pd.read_csv(results / "measured" / "beside.csv")
    assert len(beside) == 4
    assert beside["ratio"].notna().sum() == 3
    hypotheses = pd.read_parquet(results / "measured" / "hypotheses.parquet")
    about_data = hypotheses[hypotheses["kind"] != "identity"]
    assert (about_data["outcome"] == "undecided").all()

    margins = pd.read_csv(results / "building_sensitivity" / "margins.csv")
    assert set(margins["label"]) == {"reference", "first period 0.5 s", "levels F3 3, F5 6"}
    effects = pd.read_csv(results / "sensitivity_analysis" / "effects.csv")
    single = {name for name, levels in SENSITIVITY_ANALYSIS.items() if isinstance(levels, list)}
    single.remove("table_mass_kg")
    # restitutions by every law that they may follow, and the table's mass in two ways
    laws = {"statue_restitution_ratio", "interface_restitution_ratio", "ground_restitution_ratio"}
    laws.add("ground_restitution_couple")
    missed = {"pedestal_not_counted", "table_not_counted", "tolerances"}
    assert set(effects["factor"]) == single | laws | missed

    nrml = ElementTree.parse(results / "exports" / "fragility_pga.xml").getroot()
    assert nrml.tag.endswith("nrml")
    choice = pd.read_csv(results / "measure_selection.csv")
    assert choice.groupby("configuration")["recommended"].sum().eq(1).all()

    page = (results / "report.html").read_text()
    for anchor in ("measures", "sensitivity_analysis", "shaker", "sensitivity", "measured"):
        assert f'id="{anchor}"' in page
    assert 'src="http' not in page


SMOKE = CONFIG / "smoke.yaml"


def smoke(**keys: object):
    return any_study({**read_yaml(SMOKE), **keys}, SMOKE)


def measured(**restitution: object) -> dict:
    """Bodies of which impacts were measured."""
    return {"bodies": {**read_yaml(SMOKE)["bodies"], "restitution": restitution}}


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
        (
            {
                "vertical": True,
                "motions": {"catalogue": "motions.csv", "processing": [{"step": "strong_part"}]},
            },
            r"key motions.processing\[0\]: strong_part looks at one component, .*; leave it out",
        ),
        (measured(blocks={"X": 0.9}), "blocks: expected names of the specimens T1, .*, found X"),
        (measured(blocks={"T1": 1.1}), "1.1 would gain energy"),
        (measured(law="newton", blocks={"T1": 0.9}), "expected one of position, couple, ratio"),
        (measured(blocks={"T1": "a"}), "blocks.T1: expected a ratio"),
        (measured(), "restitution"),
    ],
)
def test_what_cannot_be_is_refused_when_the_study_is_read(keys, message):
    with pytest.raises(InputError, match=message):
        smoke(**keys)


def test_measured_impacts_and_friction_may_be_given_together():
    tower = smoke(friction=0.3, **measured(blocks={"T1": 0.9})).configurations[0]
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
    motion, up = motions_of_row(
        {str(k): v for k, v in row.items()}, with_vertical, with_vertical, vertical=True
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


def test_each_block_brings_what_was_measured_of_it():
    study = smoke(**measured(law="ratio", blocks={"T1": 0.9, "P": [0.3, 0.35]}))
    found = {
        configuration.name: [under.law for under in configuration.contacts]
        for configuration in study.configurations
    }
    pedestal, tower = ImpactLaw("ratio", 0.3, 0.35), ImpactLaw("ratio", 0.9, 0.9)
    assert found["T1"] == [tower]
    assert found["P&T1"] == [pedestal, tower]
    assert found["T3"] == [BY_MOMENTUM]
    assert found["P&T3"] == [pedestal, BY_MOMENTUM]
