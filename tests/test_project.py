"""What the project says about itself is the same everywhere."""

import ast
import importlib
import re
import tomllib
from pathlib import Path

import pytest
import yaml

import rockfrag

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PINNED = dict(
    line.lower().split("==")
    for line in (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    if "==" in line
)


def plain(requirement: str) -> str:
    """Name of a requirement as the constraints write it."""
    return re.split(r"[\[<>=! ]", requirement)[0].lower()


def test_version_is_one():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "rockfrag.__version__"}
    assert rockfrag.__version__ == citation["version"]


def test_every_dependency_is_pinned():
    project = PROJECT["project"]
    lists = [project["dependencies"], *project["optional-dependencies"].values()]
    names = {plain(one) for some in lists for one in some}
    assert len(names) > 20
    assert not names - set(PINNED)


def test_pre_commit_has_the_pinned_versions():
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))
    seen = 0
    for repo in hooks["repos"]:
        name = repo["repo"].rsplit("/", 1)[-1].removesuffix("-pre-commit")
        if name in PINNED:
            assert repo["rev"] == f"v{PINNED[name]}", name
            seen += 1
    assert seen == 3


@pytest.mark.parametrize("package", ["", ".motions", ".building", ".shaketable", ".rocking"])
def test_names_that_load_late_are_those_that_are_exported(package):
    module = importlib.import_module(f"rockfrag{package}")
    source = Path(module.__file__).read_text(encoding="utf-8")
    (typed,) = (node for node in ast.parse(source).body if isinstance(node, ast.If))
    homes = {
        alias.name: node.module
        for node in typed.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert set(homes) == set(module.__all__)
    for name, home in homes.items():
        assert getattr(module, name) is getattr(importlib.import_module(home), name)


def test_hosted_checks_and_the_makefile_agree():
    checks = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    used = set(re.findall(r"run: make ([a-z]+)", checks))
    assert used <= targets
    assert {"lint", "coverage", "smoke"} <= used
    for folder in re.findall(r"tests/[a-z]+", checks):
        assert (ROOT / folder).exists() or (ROOT / f"{folder}_cli.py").exists(), folder
