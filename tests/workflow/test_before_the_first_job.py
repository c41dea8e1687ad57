"""What can be known before the first job is said before it, in one short sentence."""

import hashlib
import re
import sys
from pathlib import Path

import pytest
import yaml

from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.files import check_name
from rockfrag.fragility.ida_curves import scale_power
from rockfrag.motions.measures import measure_motion
from rockfrag.records.motion import Motion
from rockfrag.schema import registered
from rockfrag.study.configurations import read_specimens
from rockfrag.study.loading import load_any
from rockfrag.yaml_file import read_yaml

from .conftest import study_content, write_study
from .running import ROOT, SNAKEFILE, called, finished, snakemake


def said(capsys: pytest.CaptureFixture[str], path: Path) -> str:
    """What check-config says of a wrong configuration."""
    assert main(["check-config", str(path)]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert len(shown.err) <= 501
    assert "Traceback" not in shown.err
    return shown.err


ALIAS_BOMB = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
ALIAS_BOMB += [f"a{i}: &a{i} [" + ", ".join([f"*a{i - 1}"] * 9) + "]" for i in range(1, 12)]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"? [1, 2]\n: 3\n", "a key must be a word"),
        (b"? {a: 1}\n: 3\n", "a key must be a word"),
        (b"study: " + b"[" * 2000 + b"]" * 2000 + b"\n", "nested too deeply"),
        (b"a: &a [1, 2]\nb: [*a, *a]\n", "line 2, column 5: the alias *a"),
        (b"study: 2020-13-45\n", "key"),
        (b"study: !!python/object:os.system x\n", "could not determine a constructor"),
        (b"? " + b"x" * 5000 + b"\n: 1\n", "is not known"),
        (b"study: " + b"x" * 5000 + b"\n", "key"),
        (b"study: [1\n", "line"),
        (b"study: a\nstudy: b\n", "twice"),
        (b"- a\n- b\n", "mapping"),
        (b"", "mapping"),
        (b"study: \t x\n  y: 2\n", "line"),
        (b"PK\x03\x04\x14\x00", "spreadsheet or archive"),
        (b"study: \xff\xfe\n", "is not UTF-8"),
        (b"study: a\x07b\n", "line 1: holds the character '\\x07'"),
        (b'study: "a\\x07b"\n', "column 8: holds the character '\\x07'"),
        (b'"a\\u202Eb": 1\n', "which no text shows"),
        (b"study: !!bool perhaps\n", "is not valid YAML"),
        (b"study: !!set {a, b}\n", "could not determine a constructor"),
        (b"study: [" + b"1," * 30_000 + b"1]\n", "more than 20000"),
        (b"# " + b"x" * 300_000, "larger than 256 KiB"),
        ("\n".join(ALIAS_BOMB).encode(), "alias"),
    ],
)
def test_what_is_no_mapping_of_plain_data_is_refused(tmp_path, capsys, content, words):
    path = tmp_path / "study.yaml"
    path.write_bytes(content)
    assert words in said(capsys, path)


@pytest.mark.parametrize("key", ["building", "shaker"])
def test_a_building_or_shaker_that_is_no_text_is_refused(study_folder, capsys, key):
    (study_folder / "other.yaml").write_bytes(b"name: \xff\xfe\n")
    path = write_study(study_folder, {**study_content(), key: "other.yaml"})
    assert "other.yaml: is not UTF-8" in said(capsys, path)


def test_every_measure_that_a_study_may_ask_for_is_measured_and_grows_with_the_amplitude():
    wave = Motion([0.0, 1.0, -1.0, 0.5] * 200, 0.01, "wave")
    pair, single = registered("intensity measure"), registered("growing intensity measure")
    assert list(measure_motion(wave))[3:] == list(pair)
    assert set(single) < set(pair)
    assert all(scale_power(name) > 0 for name in single)
    assert all(scale_power(name) == 0 for name in set(pair) - set(single))


def test_null_is_the_same_as_no_building(study_folder: Path):
    study = load_any(write_study(study_folder, {**study_content(), "building": None}))
    assert study.building is None
    assert study.floors == {"ground": 0}


def test_without_a_table_of_configurations_each_block_stands_alone(study_folder: Path):
    content = {**study_content(), "bodies": {"specimens": "specimens.csv", "use": ["T1", "T2"]}}
    study = load_any(write_study(study_folder, content))
    assert [configuration.name for configuration in study.configurations] == ["T1", "T2"]
    assert not study.has_pairs


def test_a_record_that_cannot_be_read_is_named_by_command_and_workflow(study_folder, capsys):
    (study_folder / "record3.txt").rename(study_folder / "away.txt")
    assert "record3.txt" in said(capsys, study_folder / "study.yaml")
    (study_folder / "record3.txt").write_text("no record at all\n")
    sentence = said(capsys, study_folder / "study.yaml")
    assert "motion 3" in sentence
    done = snakemake(study_folder, "--cores", "1", "--logger", "rockfrag")
    assert done.returncode != 0
    assert "motion 3" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (study_folder / "results").exists()


def test_a_study_does_not_overwrite_the_results_of_another(study_folder, capsys, monkeypatch):
    monkeypatch.chdir(study_folder)
    other = study_folder / "other.yaml"
    other.write_text((study_folder / "study.yaml").read_text())
    owner = study_folder / "results" / "tiny" / "configuration.txt"
    owner.parent.mkdir(parents=True)
    owner.write_text("study.yaml\n")
    assert "holds the results of study.yaml" in said(capsys, other)
    assert main(["check-config", "study.yaml"]) == 0


SAME_BLOCK = (
    "name,width_cm,height_cm,mass_g\nA,35,120,180000\n",
    "name,width_m,height_m,mass_kg\nA,0.35,1.2,180\n",
    "name;width;height;mass\nA;35 cm;1200 mm;0.18 t\n",
    "name\twidth_mm\theight_cm\tmass\nA\t350\t120\t180 kg\n",
)


@pytest.mark.parametrize("table", SAME_BLOCK)
def test_blocks_are_the_same_in_whatever_unit_and_separator(tmp_path: Path, table: str):
    path = tmp_path / "bodies.csv"
    path.write_text(table)
    block = read_specimens(path)["A"]
    assert (block.width, block.height, block.mass) == (0.35, 1.2, 180.0)


@pytest.mark.parametrize("name", ["", ".", "..", "---", "a\nb", "x" * 300, "\x00"])
def test_names_that_cannot_be_files_are_refused(name: str):
    with pytest.raises(InputError, match="expected a name"):
        check_name(name)


def test_a_failed_job_is_one_sentence_and_the_path_of_its_log(study_folder, monkeypatch):
    # a machine whose numba cannot be imported, which no check of the study can see
    (study_folder / "sitecustomize.py").write_text("import sys\nsys.modules['numba'] = None\n")
    monkeypatch.setenv("PYTHONPATH", str(study_folder))
    done = snakemake(
        study_folder, "--cores", "1", "--logger", "rockfrag", "--workflow-profile", "none"
    )
    assert done.returncode != 0
    assert "Traceback" not in done.stderr
    last = re.fullmatch(r"(\w+) failed: .*numba.* \(log: (.*)\)", done.stderr.splitlines()[-1])
    assert last is not None, done.stderr
    assert last[2] == f"results/tiny/logs/{last[1]}.log"
    assert "Traceback" in (study_folder / last[2]).read_text()
    lines = done.stderr.splitlines()[:-1]
    assert all(line.startswith("[") for line in lines)


def test_rules_parse_where_the_package_is_not_installed(study_folder: Path):
    program = (
        "import importlib.util as util, sys\nfind = util.find_spec\nutil.find_spec = lambda name, *rest: None "
        "if name == 'rockfrag' else find(name, *rest)\nfrom snakemake.cli import main\nmain()\n"
    )
    study = ("--directory", str(study_folder), "--configfile", str(study_folder / "study.yaml"))
    command = (sys.executable, "-c", program, "--snakefile", SNAKEFILE, "--dry-run")
    done = finished(called(ROOT, *command, *study))
    assert "results/tiny/report.html" in done.stdout + done.stderr
    assert "rule study" in done.stdout + done.stderr


def test_folders_and_devices_are_no_configuration(tmp_path, capsys):
    assert "folder or a device" in said(capsys, tmp_path)
    assert "folder or a device" in said(capsys, Path("/dev/zero"))


def test_values_are_those_of_yaml_1_2(tmp_path: Path):
    path = tmp_path / "study.yaml"
    path.write_text("a: 1e-3\nb: no\nc: 12:30\nd: 0x10\ne: -2.\nf: ~\ng: true\nh: 010\ni: 1_000\n")
    assert read_yaml(path) == {
        **{"a": 0.001, "b": "no", "c": "12:30", "d": "0x10", "e": -2.0, "f": None},
        **{"g": True, "h": 10, "i": "1_000"},
    }
    path.write_text("floors: {1: 1, 2.5: 2}\nname: 1976-05-06\n")
    assert read_yaml(path) == {"floors": {"1": 1, "2.5": 2}, "name": "1976-05-06"}
    path.write_bytes("name: Köln\n".encode("utf-16"))
    assert read_yaml(path) == {"name": "Köln"}


ANOTHER = hashlib.sha256(b"another").hexdigest()
WRONG_CELLS = [
    ("specimens", "T2,", f"{name},", "formula") for name in ("=1+1", "-rf", "+1", "@SUM(A1)")
]
WRONG_CELLS += [
    ("motions", "record3.txt,,", f"record3.txt,{ANOTHER},", "SHA-256"),
    ("motions", "record3.txt", "record{3}.txt", "curly brackets"),
]


@pytest.mark.parametrize(("table", "cell", "wrong", "words"), WRONG_CELLS)
def test_a_cell_that_cannot_be_used_is_refused(study_folder, capsys, table, cell, wrong, words):
    (study_folder / "record{3}.txt").write_text("")
    path = study_folder / f"{table}.csv"
    path.write_text(path.read_text().replace(cell, wrong))
    assert words in said(capsys, study_folder / "study.yaml")


def test_motions_stay_apart_on_every_floor(study_folder: Path, capsys: pytest.CaptureFixture[str]):
    table = study_folder / "motions.csv"
    text = table.read_text().replace("motion 0", "A").replace("motion 1", "A_1")
    table.write_text(text)
    (study_folder / "building.yaml").write_text(
        "storey_heights_m: [3, 3]\nmasses_kg: [1000, 1000]\nfirst_period_s: 0.2\nfloors: {g: 0, 1_2: 1, 2: 2}\n"
    )
    path = write_study(study_folder, {**study_content(), "building": "building.yaml"})
    assert "A_1 and A become one" in said(capsys, path)


def test_fetched_files_stay_in_the_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    content = yaml.safe_load((ROOT / "config" / "granite.yaml").read_text())
    digest = hashlib.sha256(b"").hexdigest()
    for name in ("/tmp/x.csv", "../../../../x.csv"):
        content["fetch"] = [{"url": "https://example.org/x", "sha256": digest, "file": name}]
        assert "outside of this folder" in said(capsys, write_study(tmp_path, content))
