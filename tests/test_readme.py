"""What the README tells people to type works as it stands there."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.schema import read_schema

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = ("Makefile", "pyproject.toml", "constraints.txt", "workflow", "profiles")


def fences(language: str) -> list[str]:
    """Contents of all fenced blocks of a language, without the indentation of lists."""
    found = re.findall(rf"^( *)```{language}\n(.*?)^ *```$", README, re.MULTILINE | re.DOTALL)
    return [re.sub(rf"^{indent}", "", text, flags=re.MULTILINE) for indent, text in found]


def commands() -> list[str]:
    return [line for text in fences("sh") for line in text.splitlines()]


@pytest.fixture
def checkout(tmp_path) -> Path:
    """A folder that is a copy of the project as far as commands of the README need it."""
    folder = tmp_path / "a checkout"
    folder.mkdir()
    for name in PROJECT:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy2
        copy(ROOT / name, folder / name)
    (folder / "src").symlink_to(ROOT / "src")
    (folder / ".venv").symlink_to(sys.prefix)
    return folder


@pytest.fixture
def typed(checkout):
    """Run a line of the README in the copy, in the environment of the tests."""

    def run(line: str) -> str:
        words = shlex.split(line)
        if words[0] == "make":
            # the environment is there already: -o keeps make from installing it once more
            words[1:1] = ["-o", ".venv/installed"]
        done = subprocess.run(
            words,
            cwd=checkout,
            env={**os.environ, "MPLBACKEND": "agg"},
            capture_output=True,
            text=True,
            timeout=550,
            check=False,
        )
        assert done.returncode == 0, f"{line}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        return done.stdout

    return run


@pytest.mark.skipif(os.name == "nt", reason="make and symbolic links are those of POSIX")
def test_the_route_to_ones_own_statue_ends_in_a_report(checkout, typed, noise):
    mine = checkout / "mine"
    (mine / "records").mkdir(parents=True)
    from rockfrag.motions import scale_to_pga
    from rockfrag.motions.filtering import bandpass

    for seed in range(3):
        motion = scale_to_pga(bandpass(noise(seed, 1200, tapered=True), 0.3, 5.0), 0.3)
        rows = np.column_stack([motion.time, motion.acceleration / 9.81])
        np.savetxt(mine / "records" / f"station{seed}.txt", rows, "%.6f")
    named = re.findall(
        r"`(mine/[a-z]+\.(?:csv|yaml))`[^`]*(?:`[^`\n]+`[^`]*)*?\n\n *```(csv|yaml)", README
    )
    texts = {"csv": iter(fences("csv")), "yaml": iter(fences("yaml"))}
    for path, language in named:
        (checkout / path).write_text(next(texts[language]))
    assert [path for path, _ in named] == [
        "mine/blocks.csv",
        "mine/arrangements.csv",
        "mine/study.yaml",
    ]

    make_catalogue, check, run = (line for line in commands() if "mine/" in line)
    typed(make_catalogue)
    assert len(pd.read_csv(mine / "motions.csv")) == 3
    assert "is right" in typed(check)
    typed(run)
    report = (checkout / "results" / "venus" / "report.html").read_text(encoding="utf-8")
    assert "A marble Venus with and without her plinth" in report
    tests = pd.read_csv(checkout / "results" / "venus" / "tests.csv")
    assert set(tests["configuration"]) == {"venus", "venus on its plinth"}


@pytest.fixture
def record(checkout, noise) -> Path:
    """The record that the README calls record.AT2."""
    from rockfrag.motions import scale_to_pga
    from rockfrag.records import write_motion

    return write_motion(scale_to_pga(noise(7, 800, tapered=True), 0.4), checkout / "record.AT2")


@pytest.mark.skipif(os.name == "nt", reason="symbolic links are those of POSIX")
@pytest.mark.parametrize("line", [line for line in commands() if "mine/" not in line])
def test_a_command_runs(record, typed, line):
    typed(line)
    if "--plot" in line:
        assert (record.parent / "response.png").stat().st_size > 5000


def test_snippets_run(record, monkeypatch, capsys):
    monkeypatch.chdir(record.parent)
    assert fences("python")
    for text in fences("python"):
        exec(compile(text, "README.md", "exec"), {})
    assert capsys.readouterr().out


def test_commands_of_make_exist():
    targets = set(re.findall(r"(?:`|^ *)make ([a-z-]+)", README, re.MULTILINE))
    known = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert targets <= known
    assert {"run", "test", "smoke"} <= targets


def keys_of(schema: dict) -> set[str]:
    """Names of the keys of a mapping and of the mappings in it, those of laws of materials aside."""
    found = set()
    for name, item in schema.get("properties", {}).items():
        found |= {name} | (keys_of(item) if name != "masonry" else set())
    return found


def test_every_key_of_a_configuration_is_explained():
    kinds = json.loads((ROOT / "src/rockfrag/schema.json").read_text(encoding="utf-8"))["$defs"]
    schemas = {kind: read_schema(kind) for kind in kinds}
    text = (ROOT / "config/README.md").read_text(encoding="utf-8")
    explained = set(re.findall(r"`([A-Za-z_0-9]+)`", text))
    assert set().union(*(keys_of(schema) for schema in schemas.values())) <= explained
