"""What can be known before the first job is said before it, in one short sentence with file and key."""

import hashlib
import re
import shutil
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.base.files import check_name
from rockfrag.base.yaml_file import read_yaml
from rockfrag.building.floors import vertical_motions
from rockfrag.building.settings import make_building
from rockfrag.cli.main import main
from rockfrag.config.schema import registered
from rockfrag.fragility.ida_curves import scale_power
from rockfrag.motions.directions import motions_of_row
from rockfrag.motions.measures import measure_motion
from rockfrag.records.catalogue import read_catalogue
from rockfrag.records.motion import Motion
from rockfrag.study.configurations import (
    read_configurations,
    read_specimens,
    with_contacts,
)
from rockfrag.study.holding import read_isolators
from rockfrag.study.loading import any_study, load_any
from rockfrag.system.blocks import Block
from rockfrag.system.contact import BY_MOMENTUM, ImpactLaw
from rockfrag.system.mounts import ROLLING

from ..case_tables import case_tables
from .conftest import (
    CATALOGUE,
    CONFIG,
    study_content,
    write_example,
    write_record,
    write_study,
    write_synthetic,
)
from .running import ROOT, SNAKEFILE, called, finished, snakemake

CASES = case_tables(__file__)


def said(capsys: pytest.CaptureFixture[str], path: Path) -> str:
    """What check-config says of a wrong configuration."""
    assert main(["check-config", str(path)]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert len(shown.err) <= 501
    assert "Traceback" not in shown.err
    return shown.err


def changed(content: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A configuration in which keys, the parts of each behind dots, have other values or are gone."""
    for path, value in changes.items():
        *parts, key = path.split(".")
        inner = content
        for part in parts:
            inner = inner[part]
        if value == "gone":
            del inner[key]
        else:
            inner[key] = value
    return content


def test_the_studies_of_the_project_are_right():
    for name in ("thesis", "smoke", "wide"):
        assert load_any(CONFIG / f"{name}.yaml").name == name


def full_study(folder: Path) -> None:
    """Write a study with every optional part."""
    for name in ("building.yaml", "experiment/shaker.yaml"):
        shutil.copy(CONFIG / name, folder / Path(name).name)
    (folder / "tests.csv").write_text(CASES["tests"])
    write_study(folder, changed(study_content(), CASES["full"]))


@pytest.mark.parametrize(("name", "changes", "words"), CASES["keys"])
def test_a_wrong_key_or_value_is_named_with_what_was_expected(
    study_folder, name, changes, words
):
    source = CONFIG / f"{name}.yaml"
    if not source.exists():
        source = study_folder / "study.yaml"
    if name == "full":
        full_study(study_folder)
    elif name == "measured":
        write_example(study_folder, write_synthetic(study_folder).name)
    with pytest.raises(InputError) as caught:
        any_study(changed(read_yaml(source), changes), source)
    message = str(caught.value)
    assert message.startswith(str(source.parent))
    assert [word for word in words if word not in message] == []


@pytest.mark.parametrize(("table", "cell", "wrong", "words"), CASES["cells"])
def test_a_wrong_cell_is_named_with_line_and_column(
    study_folder, capsys, table, cell, wrong, words
):
    (study_folder / "record{3}.txt").write_text("")
    path = study_folder / f"{table}.csv"
    path.write_text(path.read_text().replace(cell, wrong))
    message = said(capsys, study_folder / "study.yaml")
    assert [word for word in words if word not in message] == []


ALIAS_BOMB = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
ALIAS_BOMB += [
    f"a{i}: &a{i} [" + ", ".join([f"*a{i - 1}"] * 9) + "]" for i in range(1, 12)
]
NO_TEXTS = [
    ("study: " + "[" * 2000 + "]" * 2000 + "\n", "nested too deeply"),
    ("? " + "x" * 5000 + "\n: 1\n", "is not known"),
    ("study: " + "x" * 5000 + "\n", "key"),
    ("study: [" + "1," * 30_000 + "1]\n", "more than 20000"),
    ("# " + "x" * 300_000, "larger than 256 KiB"),
    ("\n".join(ALIAS_BOMB), "alias"),
    (b"PK\x03\x04\x14\x00", "spreadsheet or archive"),
    (b"study: \xff\xfe\n", "is not UTF-8"),
]


@pytest.mark.parametrize(("content", "words"), [*CASES["texts"], *NO_TEXTS])
def test_what_is_no_mapping_of_plain_data_is_refused(tmp_path, capsys, content, words):
    path = tmp_path / "study.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert words in said(capsys, path)


def test_folders_devices_and_buildings_that_are_no_text_are_refused(
    study_folder, capsys
):
    assert "folder or a device" in said(capsys, study_folder)
    assert "folder or a device" in said(capsys, Path("/dev/zero"))
    (study_folder / "other.yaml").write_bytes(b"name: \xff\xfe\n")
    path = write_study(study_folder, study_content() | {"building": "other.yaml"})
    assert "other.yaml: is not UTF-8" in said(capsys, path)


@pytest.mark.parametrize("name", ["", ".", "..", "---", "a\nb", "x" * 300, "\x00"])
def test_names_that_cannot_be_files_are_refused(name: str):
    with pytest.raises(InputError, match="expected a name"):
        check_name(name)


def test_motions_stay_apart_on_every_floor(
    study_folder: Path, capsys: pytest.CaptureFixture[str]
):
    table = study_folder / "motions.csv"
    text = table.read_text().replace("motion 0", "A").replace("motion 1", "A_1")
    table.write_text(text)
    (study_folder / "building.yaml").write_text(
        "storey_heights_m: [3, 3]\nmasses_kg: [1000, 1000]\nfirst_period_s: 0.2\nfloors: {g: 0, 1_2: 1, 2: 2}\n"
    )
    path = write_study(study_folder, {**study_content(), "building": "building.yaml"})
    assert "A_1 and A become one" in said(capsys, path)


def test_fetched_files_stay_in_the_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    content = read_yaml(CONFIG / "granite.yaml")
    digest = hashlib.sha256(b"").hexdigest()
    for name in ("/tmp/x.csv", "../../../../x.csv"):
        content["fetch"] = [
            {"url": "https://example.org/x", "sha256": digest, "file": name}
        ]
        assert "outside of this folder" in said(capsys, write_study(tmp_path, content))


def test_a_study_does_not_overwrite_the_results_of_another(
    study_folder, capsys, monkeypatch
):
    monkeypatch.chdir(study_folder)
    other = study_folder / "other.yaml"
    other.write_text((study_folder / "study.yaml").read_text())
    owner = study_folder / "results" / "tiny" / "configuration.txt"
    owner.parent.mkdir(parents=True)
    owner.write_text("study.yaml\n")
    assert "holds the results of study.yaml" in said(capsys, other)
    assert main(["check-config", "study.yaml"]) == 0


def test_a_record_that_cannot_be_read_is_named_by_command_and_workflow(
    study_folder, capsys
):
    (study_folder / "record3.txt").rename(study_folder / "away.txt")
    assert "record3.txt" in said(capsys, study_folder / "study.yaml")
    (study_folder / "record3.txt").write_text("no record at all\n")
    assert "motion 3" in said(capsys, study_folder / "study.yaml")
    done = snakemake(study_folder, "--cores", "1", "--logger", "rockfrag")
    assert done.returncode != 0
    assert "motion 3" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (study_folder / "results").exists()


def test_a_failed_job_is_one_sentence_and_the_path_of_its_log(
    study_folder, monkeypatch
):
    # a machine whose numba cannot be imported, which no check of the study can see
    (study_folder / "sitecustomize.py").write_text(
        "import sys\nsys.modules['numba'] = None\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(study_folder))
    how = ("--cores", "1", "--logger", "rockfrag", "--workflow-profile", "none")
    done = snakemake(study_folder, *how)
    assert done.returncode != 0
    assert "Traceback" not in done.stderr
    *before, last_line = done.stderr.splitlines()
    last = re.fullmatch(r"(\w+) failed: .*numba.* \(log: (.*)\)", last_line)
    assert last is not None, done.stderr
    assert last[2] == f"results/tiny/logs/{last[1]}.log"
    assert "Traceback" in (study_folder / last[2]).read_text()
    assert all(line.startswith("[") for line in before)


def test_rules_parse_where_the_package_is_not_installed(study_folder: Path):
    program = (
        "import importlib.util as util, sys\nfind = util.find_spec\nutil.find_spec = lambda name, *rest: None "
        "if name == 'rockfrag' else find(name, *rest)\nfrom snakemake.cli import main\nmain()\n"
    )
    study = (
        "--directory",
        str(study_folder),
        "--configfile",
        str(study_folder / "study.yaml"),
    )
    command = (sys.executable, "-c", program, "--snakefile", SNAKEFILE, "--dry-run")
    done = finished(called(ROOT, *command, *study))
    assert "results/tiny/report.html" in done.stdout + done.stderr
    assert "rule study" in done.stdout + done.stderr


def test_values_are_those_of_yaml_1_2(tmp_path: Path):
    path = tmp_path / "study.yaml"
    path.write_text(
        "a: 1e-3\nb: no\nc: 12:30\nd: 0x10\ne: -2.\nf: ~\ng: true\nh: 010\ni: 1_000\n"
    )
    assert read_yaml(path) == {
        **{"a": 0.001, "b": "no", "c": "12:30", "d": "0x10", "e": -2.0, "f": None},
        **{"g": True, "h": 10, "i": "1_000"},
    }
    path.write_text("floors: {1: 1, 2.5: 2}\nname: 1976-05-06\n")
    assert read_yaml(path) == {"floors": {"1": 1, "2.5": 2}, "name": "1976-05-06"}
    path.write_bytes("name: Köln\n".encode("utf-16"))
    assert read_yaml(path) == {"name": "Köln"}


SAME_BLOCK = (
    "name,width_cm,height_cm,mass_g\nA,35,120,180000\n",
    "name;width;height;mass\nA;35 cm;1200 mm;0.18 t\n",
    "name\twidth_mm\theight_m\tmass\nA\t350\t1.2\t180 kg\n",
)


def test_blocks_are_the_same_in_whatever_unit_and_separator(tmp_path: Path):
    for table in SAME_BLOCK:
        (tmp_path / "bodies.csv").write_text(table)
        block = read_specimens(tmp_path / "bodies.csv")["A"]
        assert (block.width, block.height, block.mass) == (0.35, 1.2, 180.0)


def test_every_measure_that_a_study_may_ask_for_is_measured_and_grows_with_the_amplitude():
    wave = Motion([0.0, 1.0, -1.0, 0.5] * 200, 0.01, "wave")
    pair, single = (
        registered("intensity measure"),
        registered("growing intensity measure"),
    )
    assert list(measure_motion(wave))[3:] == list(pair)
    assert set(single) < set(pair)
    assert all(scale_power(name) > 0 for name in single)
    assert all(scale_power(name) == 0 for name in set(pair) - set(single))


def test_what_a_study_leaves_out_is_the_plain_case(study_folder: Path):
    content = study_content() | {"building": None}
    content["bodies"] = {"specimens": "specimens.csv", "use": ["T1", "T2"]}
    study = load_any(write_study(study_folder, content))
    assert study.building is None and study.floors == {"ground": 0}
    # without a table of configurations each block stands alone
    assert [configuration.name for configuration in study.configurations] == [
        "T1",
        "T2",
    ]
    assert not study.has_pairs
    assert (study.slides, study.vertical) == (False, False)
    (on,) = study.configurations[0].contacts
    assert on.friction is None and on.law == BY_MOMENTUM


ISOLATORS = """name,mass_kg,radius_cm,friction,stroke_cm,stiffness_n_m,strength_n
isolator,15,200,0.05,12,,
springs,20,,,10,3000,50
"""
ARRANGEMENTS = """name,object,wall_cm,wall_height,putty_n,putty_spread,cord_n_m,cord_slack_mm,bracket_n_m,casters
bare,venus,,,,,,,,
niche,venus | plinth,4,,,,,,,
kerb,venus,20,10 cm,,,,,,free
wax,venus | plinth,,,120,,,,,
cord,venus,,,,,100000,5,,
bracket,venus,6,,,,,,1e6,
isolated,venus | plinth | isolator,,,,,,,,
sprung,venus | springs,,,,,,,,
"""


def test_arrangements_say_what_holds_the_bodies(tmp_path: Path):
    (tmp_path / "isolators.csv").write_text(ISOLATORS)
    table = tmp_path / "arrangements.csv"
    table.write_text(ARRANGEMENTS)
    blocks = {"venus": Block(0.3, 1.2, 100.0), "plinth": Block(0.5, 0.4, 200.0)}
    isolators = read_isolators(tmp_path / "isolators.csv")
    systems, _ = read_configurations(table, blocks, isolators)
    found = {system.name: system for system in systems}
    assert {name: system.holding for name, system in found.items()} == {
        **{"bare": (), "niche": ("wall 1",), "kerb": ("wall 1",)},
        **{"wax": ("bond 2",), "cord": ("tie 1", "tie 2")},
        **{"bracket": ("wall 1", "tie 2"), "isolated": ("support",)},
        "sprung": ("support",),
    }
    assert found["niche"].constraints[0].distance == pytest.approx(0.25 + 0.04)
    assert found["kerb"].constraints[0].height == pytest.approx(0.1)
    assert found["kerb"].contacts[0].friction == ROLLING
    study = {"bodies": {}, "friction": 0.6}
    rubs = {each.name: each for each in with_contacts(systems, blocks, study, "study")}
    grounds = {name: system.contacts[0].friction for name, system in rubs.items()}
    # what rolls goes on rolling
    assert grounds["kerb"] == ROLLING and grounds["niche"].static == 0.6
    (bond,) = (bond for _, bond in found["wax"].bonds)
    assert (bond.tension, bond.shear, bond.spread[0]) == (120.0, 120.0, 0.15)
    left, right = found["cord"].constraints
    assert (left.anchor[0], right.anchor[0]) == (-1.15, 1.15)
    assert right.slack == pytest.approx(0.005)
    pendulum, springs = found["isolated"].support, found["sprung"].support
    assert (pendulum.radius, pendulum.stroke, pendulum.friction.static) == (
        2,
        0.12,
        0.05,
    )
    assert (springs.stiffness, springs.strength) == (3000.0, 50.0)
    assert found["isolated"].names == ("plinth", "venus")
    table.write_text("name,object,putty_n,putty_spread_m\nA,venus,120,5\n")
    with pytest.raises(InputError, match=r"line 2: Bond: spread: .* give 0\.15 m at"):
        read_configurations(table, blocks, isolators)
    table.write_text("name,object\nA,venus | cellar\n")
    with pytest.raises(InputError, match="venus, plinth, isolator, springs, found cel"):
        read_configurations(table, blocks, isolators)


OF_A_HOLDER = {
    "wall_height_m": ("of a wall", "wall_m or wall_left_m, its distance"),
    "wall_friction": ("of a wall", "wall_m or wall_left_m, its distance"),
    "wall_restitution": ("of a wall", "wall_m or wall_left_m, its distance"),
    "putty_shear_n": ("of putty", "putty_n, its tensile capacity"),
    "putty_spread_m": ("of putty", "putty_n, its tensile capacity"),
    "cord_n": ("of cords", "cord_n_m, their stiffness"),
    "cord_slack_m": ("of cords", "cord_n_m, their stiffness"),
    "bracket_n": ("of a bracket", "bracket_n_m, its stiffness"),
    "bracket_slack_m": ("of a bracket", "bracket_n_m, its stiffness"),
}
"""What is said of a holder that is not there, which left the object free without a word."""


@pytest.mark.parametrize("column", OF_A_HOLDER)
def test_what_is_stated_of_a_holder_that_is_not_there_is_refused(
    tmp_path: Path, column: str
):
    of, needed = OF_A_HOLDER[column]
    table, blocks = tmp_path / "a.csv", {"vase": Block(0.3, 0.9, 80.0)}
    table.write_text(f"name,object,casters,{column}\ncase,vase,locked,0.5\n")
    said = f"{table}, line 2, column {column}: is {of}; give {needed}, too."
    with pytest.raises(InputError, match=re.escape(said)):
        read_configurations(table, blocks)
    # the title as the file has it
    table.write_text(table.read_text().replace("cord_n\n", "cord_kgf\n"))
    with pytest.raises(InputError, match=re.escape(needed)):
        read_configurations(table, blocks)
    source = CONFIG / "granite.yaml"
    by_hand = {
        **{"left_m": 0.2, "right_m": 0.2, "cg_height_m": 0.6, "height_m": 1.2},
        **{"mass_kg": 90.0, "inertia_kg_m2": 20.0, "held": {column: 0.5}},
    }
    content = read_yaml(source)
    keys = {name: content["unknowns"][name] for name in ("edge_retreat_mm",)}
    content |= {"object": by_hand, "unknowns": keys | {"restitution": [0.8, 1.0]}}
    said = f"{source}: key object.held.{column}: is {of}; give {needed}, too."
    with pytest.raises(InputError, match=re.escape(said)):
        any_study(content, source)


def contacts(**keys: Any) -> dict[str, list]:
    """Contacts of each configuration of the small study of the project, with more keys."""
    source = CONFIG / "smoke.yaml"
    study = any_study(changed(read_yaml(source), keys), source)
    return {each.name: list(each.contacts) for each in study.configurations}


def test_each_contact_has_the_friction_and_the_impacts_that_the_study_states():
    blocks = {"law": "ratio", "blocks": {"T1": 0.9, "P": [0.3, 0.35]}}
    friction = {"ground": 0.4, "interface": {"static": 0.6, "kinetic": 0.5}}
    found = contacts(friction=friction, **{"bodies.restitution": blocks})
    pedestal, tower = ImpactLaw("ratio", 0.3, 0.35), ImpactLaw("ratio", 0.9, 0.9)
    assert [(on.friction, on.law) for on in found["T1"]] == [((0.4, 0.4), tower)]
    assert [on.friction for on in found["P&T1"]] == [(0.4, 0.4), (0.6, 0.5)]
    assert [on.law for on in found["P&T1"]] == [pedestal, tower]
    assert [on.law for on in found["P&T3"]] == [pedestal, BY_MOMENTUM]
    assert {on.friction for on in contacts(friction=0.3)["P&T1"]} == {(0.3, 0.3)}


@pytest.fixture
def with_vertical(study_folder: Path) -> Path:
    """The small study with a vertical component of every record, twice as long as it must be."""
    header = CATALOGUE.replace(",sha256", ",vertical,sha256").replace(
        "lic", "scale_factor,lic"
    )
    rows = [header]
    for number in range(2):
        write_record(study_folder / f"up{number}.txt", seed=50 + number)
        files = f"record{number}.txt,up{number}.txt"
        rows.append(f"motion {number},E{number},,,,,,folder,{files},,g,2,made up\n")
    (study_folder / "motions.csv").write_text("".join(rows))
    return study_folder


def test_the_vertical_component_is_the_catalogues_with_the_factor_of_its_row(
    with_vertical, capsys
):
    row = read_catalogue(with_vertical / "motions.csv").to_dict("records")[0]
    motion, up = motions_of_row(
        {str(k): v for k, v in row.items()}, with_vertical, with_vertical, vertical=True
    )
    raw = np.loadtxt(with_vertical / "up0.txt")[:, 1]
    assert motion.name == up.name == "motion 0"
    assert up.acceleration.size == motion.acceleration.size
    np.testing.assert_allclose(
        up.acceleration / up.pga, raw / abs(raw).max(), atol=1e-12
    )
    assert up.pga == pytest.approx(2 * motion.pga / 2, rel=1e-3)
    path = write_study(with_vertical, {**study_content(), "vertical": True})
    assert main(["check-config", str(path)]) == 0
    (with_vertical / "up1.txt").write_text("Not a record.\n")
    capsys.readouterr()
    assert "up1.txt" in said(capsys, path)


def test_a_building_says_which_floors_move_up_and_down_more_than_the_ground():
    settings = read_yaml(CONFIG / "building.yaml") | {"floors": {"hall": 0, "loft": 2}}
    up = Motion(np.sin(np.arange(50.0)), 0.01, "quake")
    plain = vertical_motions(make_building(settings), up)
    assert [item.name for item in plain] == ["quake_hall", "quake_loft"]
    assert all((item.acceleration == up.acceleration).all() for item in plain)
    soft = vertical_motions(
        make_building({**settings, "vertical_factors": {"loft": 1.5}}), up
    )
    np.testing.assert_allclose(soft[1].acceleration, 1.5 * up.acceleration)
    with pytest.raises(InputError, match="floor 'attic' is not defined"):
        make_building({**settings, "vertical_factors": {"attic": 2}})


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
    assert set(margins["label"]) == {
        "reference",
        "first period 0.5 s",
        "levels F3 3, F5 6",
    }
    effects = pd.read_csv(results / "sensitivity_analysis" / "effects.csv")
    single = {
        name
        for name, levels in CASES["full"]["sensitivity_analysis"].items()
        if isinstance(levels, list)
    }
    single.remove("table_mass_kg")
    # restitutions by every law that they may follow, and the table's mass in two ways
    laws = {
        "statue_restitution_ratio",
        "interface_restitution_ratio",
        "ground_restitution_ratio",
    }
    laws.add("ground_restitution_couple")
    missed = {"pedestal_not_counted", "table_not_counted", "tolerances"}
    assert set(effects["factor"]) == single | laws | missed

    nrml = ElementTree.parse(results / "exports" / "fragility_pga.xml").getroot()
    assert nrml.tag.endswith("nrml")
    choice = pd.read_csv(results / "measure_selection.csv")
    assert choice.groupby("configuration")["recommended"].sum().eq(1).all()

    page = (results / "report.html").read_text()
    for anchor in (
        "measures",
        "sensitivity_analysis",
        "shaker",
        "sensitivity",
        "measured",
    ):
        assert f'id="{anchor}"' in page
    assert 'src="http' not in page
