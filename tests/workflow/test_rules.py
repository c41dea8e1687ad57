"""The rules as users of Snakemake expect them: written out, in good form, and usable as a module."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from .conftest import study_content, write_study
from .running import LAUNCHER, ROOT, SNAKEFILE, called, snakemake

RULES = sorted((ROOT / "workflow" / "rules").glob("*.smk"))

MODULE = """
configfile: "study.yaml"

module rockfrag:
    snakefile: {snakefile!r}
    config: {config}

use rule * from rockfrag as rf_*

rule everything:
    default_target: True
    input:
        rules.rf_all.input
"""


def by_snakefile(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Call Snakemake as the owner of a workflow of one's own does, in its folder."""
    return called(folder, sys.executable, "-P", "-m", "snakemake", *arguments)


def planned(said: str) -> list[str]:
    """Rules of a dry run, in the order in which they could be run."""
    return re.findall(r"^(?:local)?rule (\w+):", said, re.MULTILINE)


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.stem)
def test_every_rule_is_written_out_and_says_what_it_does(path: Path):
    text = path.read_text(encoding="utf-8")
    rules = re.split(r"^ *rule \w+:\n", text, flags=re.MULTILINE)[1:]
    for rule in rules:
        assert rule.lstrip().startswith('"""'), path
        for part in ("output:", "log:", "conda:"):
            assert part in rule, path
    assert rules or path.stem == "common"


def test_snakemake_finds_nothing_to_mend():
    done = by_snakefile(ROOT, "--lint")
    assert "in a good condition" in done.stdout + done.stderr, done.stdout + done.stderr


def test_records_come_first_and_the_report_last(study_folder: Path):
    done = snakemake(study_folder, "--dry-run")
    others = {"ida", "tests", "fragility", "pedestal"}
    assert set(planned(done.stdout)) == {"motions", *others, "report", "all"}
    assert planned(done.stdout)[0] == "motions"
    assert planned(done.stdout)[-2:] == ["report", "all"]


@pytest.mark.parametrize(("config", "inside"), [("config", False), ('config["overturning"]', True)])
def test_another_workflow_takes_the_rules_with_a_prefix(study_folder, config, inside):
    content = study_content()
    write_study(study_folder, {"overturning": content, "mine": 1} if inside else content)
    text = MODULE.format(snakefile=SNAKEFILE, config=config)
    (study_folder / "Snakefile").write_text(text)
    assert "rf_report" in by_snakefile(study_folder, "--dry-run").stdout
    if inside:
        target = "results/tiny/measures.csv"
        done = by_snakefile(study_folder, "--cores", "1", target)
        assert done.returncode == 0, done.stderr[-2000:]
        assert (study_folder / target).is_file()


def test_without_a_configuration_it_is_an_example():
    done = by_snakefile(ROOT, "--dry-run")
    assert done.returncode == 0, done.stderr[-2000:]
    assert "results/example/report.html" in done.stdout
    assert "thesis" not in planned(done.stdout)


def test_environments_do_not_need_a_checkout():
    for path in (ROOT / "workflow" / "envs").iterdir():
        assert "../" not in path.read_text(encoding="utf-8")


def test_files_named_like_libraries_in_the_folder_of_a_study_are_not_code(study_folder: Path):
    marked = study_folder / "executed"
    for name in ("statsmodels", "numba", "pandas", "rockfrag", "snakemake", "json"):
        program = f"open({str(marked)!r}, 'a').write({name!r})\n"
        (study_folder / f"{name}.py").write_text(program)
    wanted = ("--cores", "1", "results/tiny/measures.csv")
    done = called(study_folder, *LAUNCHER, "study.yaml", *wanted)
    assert done.returncode == 0, done.stderr[-2000:]
    assert not marked.exists()


@pytest.mark.skipif(not (ROOT / ".venv").exists(), reason="make runs what is in .venv")
def test_make_ends_with_the_sentence_of_the_run_and_an_exit_status(tmp_path: Path):
    content = study_content()
    del content["title"]
    path = write_study(tmp_path, content)
    # what a shell starts in the background ignores it
    heard = {"preexec_fn": lambda: signal.signal(signal.SIGQUIT, signal.SIG_DFL)}
    done = called(ROOT, "make", "-o", ".venv/installed", "run", f"STUDY={path}", **heard)
    assert done.returncode in (1, 2)
    assert done.stderr.count("\n") == 1
    assert "key title is missing" in done.stderr


def test_a_profile_whose_executor_is_not_installed_says_what_to_install(study_folder: Path):
    profile = study_folder / "profile"
    profile.mkdir()
    (profile / "config.yaml").write_text(yaml.safe_dump({"executor": "nowhere", "jobs": 1}))
    done = called(study_folder, *LAUNCHER, "study.yaml", "--profile", "profile")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "snakemake-executor-plugin-nowhere" in done.stderr
