"""What the project says about itself is the same everywhere."""

import importlib
import json
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml

import rockfrag

from ..conftest import SUBPACKAGES, printed_alone

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PINNED = dict(
    line.lower().split("==")
    for line in (ROOT / "requirements/constraints.txt")
    .read_text(encoding="utf-8")
    .splitlines()
    if "==" in line
)


def plain(requirement: str) -> str:
    """Name of a requirement as the constraints write it."""
    return re.split(r"[\[<>=! ]", requirement)[0].lower()


def test_version_is_one():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {
        "attr": "rockfrag.__version__"
    }
    assert rockfrag.__version__ == citation["version"]
    thesis = tomllib.loads(
        (ROOT / "thesis" / "pyproject.toml").read_text(encoding="utf-8")
    )
    assert thesis["project"]["version"] == rockfrag.__version__
    described = json.loads((ROOT / "codemeta.json").read_text(encoding="utf-8"))
    assert described["version"] == rockfrag.__version__
    assert described["keywords"] == PROJECT["project"]["keywords"]
    assert described["description"] == PROJECT["project"]["description"]


OF_CONDA = {"matplotlib": "matplotlib-base", "lazy_loader": "lazy-loader"}
"""Names under which conda-forge has packages."""


def test_the_recipe_of_conda_asks_for_what_the_package_asks_for():
    path = ROOT / "maintenance" / "conda" / "meta.yaml"
    text = path.read_text(encoding="utf-8")
    assert f'set version = "{rockfrag.__version__}"' in text
    lines = [line for line in text.splitlines() if not line.startswith(("{%", "#"))]
    recipe = yaml.safe_load("\n".join(lines).replace("{{", "").replace("}}", ""))
    python = f"python {PROJECT['project']['requires-python']}"
    asked = {python}
    for each in PROJECT["project"]["dependencies"]:
        name, bound = re.fullmatch(r"([a-z0-9_]+)(>=.*)", each).groups()
        asked.add(f"{OF_CONDA.get(name, name)} {bound}")
    assert set(recipe["requirements"]["run"]) == asked


@pytest.mark.slow
def test_the_wheel_of_the_library_has_no_word_of_the_thesis(tmp_path):
    # what is built leaves files beside the source, which later wheels would hold
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(
        ROOT / "src", tmp_path / "src", ignore=shutil.ignore_patterns("__pycache__")
    )
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "--no-build-isolation",
    ]
    subprocess.run([*command, "."], check=True, cwd=tmp_path)
    with zipfile.ZipFile(next(tmp_path.glob("rockfrag-*.whl"))) as wheel:
        assert len(wheel.namelist()) > 300
        for name in wheel.namelist():
            words = set(
                re.findall(rb"[a-z]*thesis", name.encode() + wheel.read(name).lower())
            )
            assert words <= {b"hypothesis", b"parenthesis"}, name


def test_every_dependency_is_pinned():
    project = PROJECT["project"]
    lists = [project["dependencies"], *project["optional-dependencies"].values()]
    names = {plain(item) for some in lists for item in some}
    assert len(names) > 20
    assert not names - set(PINNED)


def test_pre_commit_has_the_pinned_versions():
    hooks = yaml.safe_load(
        (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    )
    seen = 0
    for repo in hooks["repos"]:
        name = repo["repo"].rsplit("/", 1)[-1].removesuffix("-pre-commit")
        if name in PINNED:
            assert repo["rev"] == f"v{PINNED[name]}", name
            seen += 1
    assert seen == 3


def test_a_name_that_is_looked_for_at_the_top_is_said_to_be_elsewhere():
    with pytest.raises(AttributeError, match=r"it is rockfrag\.fragility\.write_nrml$"):
        _ = rockfrag.write_nrml
    with pytest.raises(AttributeError, match=r"has no attribute 'topple'$"):
        _ = rockfrag.topple


def test_what_is_slow_to_load_is_loaded_only_when_it_is_used():
    names = ", ".join(f"rockfrag{package}" for package in (*SUBPACKAGES, ".cli.main"))
    heavy = ("numba", "pandas", "obspy", "scipy", "statsmodels", "matplotlib")
    program = (
        f"import sys, {names}; print([one for one in {heavy} if one in sys.modules])"
    )
    assert printed_alone("-c", program) == "[]"


ANSWER = """
import sys
import numpy as np
from rockfrag import Motion
from rockfrag.assess.answer import assess_with
from rockfrag.assess.findings import lines_of
from rockfrag.assess.inventory import FaultyRows
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import make_request
from rockfrag.cli.main import main
shaking = 5 * np.sin(np.arange(300) / 15)
made = tuple(Motion(k * shaking, dt=0.01, name=f"{k}") for k in (1, 2))
keys = {"width": "20 cm", "height": "1 m", "pga": "0.3 g"}
found = assess_with(make_request(keys, "asked"), MotionSet(made, made, (), "made"))
assert lines_of(found, "en")
print([one for one in HEAVY if one in sys.modules])
"""


def test_the_lines_of_an_answer_wait_for_nothing_that_only_a_page_needs():
    heavy = ("scipy.stats", "scipy.optimize", "scipy.spatial", "scipy.signal")
    heavy += ("matplotlib", "jinja2", "statsmodels", "obspy")
    assert printed_alone("-c", ANSWER.replace("HEAVY", repr(heavy))) == "[]"


WORKFLOWS = ROOT / ".github" / "workflows"


def hosted(name: str) -> dict:
    return yaml.safe_load((WORKFLOWS / name).read_text(encoding="utf-8"))


def test_hosted_checks_and_the_makefile_agree():
    checks = "".join(
        path.read_text(encoding="utf-8") for path in WORKFLOWS.glob("*.yml")
    )
    targets = set(
        re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    )
    used = set(re.findall(r"run: make ([a-z]+)", checks))
    assert used <= targets
    assert {"lint", "coverage", "smoke", "docs", "validate", "fuzz", "torture"} <= used
    for folder in re.findall(r"tests/[a-z_]+", checks):
        assert (ROOT / folder).exists() or any(ROOT.glob(f"{folder}*.py")), folder


def test_no_job_of_the_hosted_checks_may_run_without_end():
    for path in WORKFLOWS.glob("*.yml"):
        for name, job in hosted(path.name)["jobs"].items():
            publishes = "environment" in job
            assert publishes or 0 < job["timeout-minutes"] <= 350, (
                f"{path.name}: {name}"
            )


FIRST_THAT_WORKS = {
    "jinja2": "3.1.2",  # Environment.overlay(keep_trailing_newline=)
    "pandas": "2.2.2",  # works with numpy 2
    "setuptools": "77",  # license = "MIT" beside license-files (PEP 639)
}


def test_lower_bounds_are_versions_that_work():
    named = [*PROJECT["project"]["dependencies"], *PROJECT["build-system"]["requires"]]
    asked = dict(line.split(">=") for line in named)
    for package, version in FIRST_THAT_WORKS.items():
        assert tuple(map(int, asked[package].split("."))) >= tuple(
            map(int, version.split("."))
        ), package


def test_every_supported_version_of_python_is_checked():
    tested = hosted("ci.yml")["jobs"]["test"]["strategy"]["matrix"]["python"]
    said = [
        classifier.rpartition(" :: ")[2]
        for classifier in PROJECT["project"]["classifiers"]
        if re.search(r"Python :: 3\.\d", classifier)
    ]
    assert tested == said == ["3.11", "3.12", "3.13"]


def test_long_checks_run_every_week_and_a_tag_publishes_what_was_tested():
    # YAML reads the key `on` as a truth value
    assert hosted("weekly.yml")[True]["schedule"][0]["cron"].endswith(" 0")
    release = hosted("release.yml")
    assert release[True] == {"push": {"tags": ["v*"]}}
    for publishing in ("package", "pages"):
        assert set(release["jobs"][publishing]["needs"]) == {"build", "test", "site"}


def test_each_long_test_is_of_one_part_of_the_validation():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    parts = dict(re.findall(r"^LONG_(\w+) = (.*)$", makefile, re.MULTILINE))
    del parts["all"]
    folders = [folder for part in parts.values() for folder in part.split()]
    long = {
        path.relative_to(ROOT).parts
        for tests in (ROOT / "tests", ROOT / "thesis" / "tests")
        for path in tests.rglob("test_*.py")
        if "pytest.mark.slow" in path.read_text(encoding="utf-8")
    }
    assert {"/".join(names[:2]) for names in long} <= set(folders)
    assert len(folders) == len(set(folders))
    assert all((ROOT / folder).is_dir() for folder in folders)
    matrix = hosted("weekly.yml")["jobs"]["validate"]["strategy"]["matrix"]
    assert set(matrix["part"]) == set(parts)


def test_the_changelog_dates_every_version():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.findall(r"^## (\S+) - (\d{4}-\d{2}-\d{2})$", text, re.MULTILINE)
    assert len(found) == text.count("\n## ") - text.count("\n## Unreleased\n")
    assert found[0][0] == rockfrag.__version__
    assert [date for _, date in found] == sorted(
        (date for _, date in found), reverse=True
    )


def test_the_changelog_is_for_a_user_to_read():
    """One version had 11 000 words under one date, and none of the headings of Keep a Changelog."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    versions = text.split("\n## ")[1:]
    assert versions[0].startswith("Unreleased\n")
    for version in versions:
        headings = re.findall("^### (.*)$", version, re.MULTILINE)
        kept = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]
        assert headings and headings == [name for name in kept if name in headings]
        assert len(version.splitlines()) < 150


def test_forms_for_issues_ask_for_something():
    forms = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
    assert len(forms) >= 4
    for form in forms:
        content = yaml.safe_load(form.read_text(encoding="utf-8"))
        if form.name != "config.yml":
            assert {"name", "description", "body"} <= set(content)
            assert any(
                item.get("validations", {}).get("required") for item in content["body"]
            )


def test_what_only_the_owner_can_fill_in_is_listed_and_still_missing():
    words = (ROOT / "docs" / "publishing.md").read_text(encoding="utf-8")
    assert "urls" not in PROJECT["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    for key in ("repository-code", "doi"):
        assert key not in citation
        assert key in words
    for name in re.findall(r"`([A-Za-z_]+\.(?:md|toml|cff))`", words):
        assert (ROOT / name).is_file(), name


def test_what_an_addition_costs_stands_where_the_table_says():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    table = text.split("## What an addition costs")[1].split("\n\n")[1].splitlines()[2:]
    rows = {row.split("|")[1].strip().split(" ", 1)[1]: row for row in table}
    assert len(rows) == len(table) >= 8
    for row in table:
        for name in re.findall(r"`(rockfrag\.[a-z_.]+)`", row):
            importlib.import_module(name)
    # a file a law, and nothing beside them
    files = {path.stem for path in (ROOT / "src/rockfrag/laws").glob("[!_]*.py")}
    assert files == set(importlib.import_module("rockfrag.laws").BUILT_IN)
    # a declaration a measure, beside its function
    source = (ROOT / "src/rockfrag/motions/intensity.py").read_text(encoding="utf-8")
    declared = importlib.import_module("rockfrag.motions.intensity").declared()
    declarations = re.findall(r"^@?intensity_measure\(", source, re.MULTILINE)
    assert len(declarations) == len(declared) > 15
    states = (ROOT / "src/rockfrag/outcomes/limit_states.py").read_text(
        encoding="utf-8"
    )
    known = importlib.import_module("rockfrag.outcomes.limit_states").limit_states()
    assert states.count("\n@limit_state(") == len(known) == 4
