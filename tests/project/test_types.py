"""What README, docs and gallery show is accepted by strict type checkers, as a user's own code would be."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^( *)```python\n(.*?)^ *```$", re.MULTILINE | re.DOTALL)


def shown_code() -> dict[str, str]:
    """Code of each page, all blocks of one in a row, and scripts of the gallery."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    pages += (ROOT / "docs" / "how-to").glob("*.md")
    found = {}
    for page in pages:
        if page.name in ("CONTRIBUTING.md", "contact.md"):
            continue
        blocks = [
            re.sub(rf"^{indent}", "", text, flags=re.MULTILINE)
            for indent, text in FENCE.findall(page.read_text(encoding="utf-8"))
        ]
        if blocks:
            name = f"{page.parent.name}_{page.stem}".replace("-", "_")
            found[name] = "\n".join(blocks)
    for script in (ROOT / "docs" / "gallery").glob("plot_*.py"):
        found[script.stem] = script.read_text(encoding="utf-8")
    return found


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("shown")
    for name, text in shown_code().items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    return folder


def test_every_page_with_code_is_looked_at(written):
    names = {path.stem for path in written.glob("*.py")}
    assert {"docs_tutorial_python", "how_to_kinds", "plot_01_one_statue"} <= names
    assert len(names) > 25


LEFT_TO_THE_READER = ("[name-defined]", "[used-before-def]", "[has-type]")
"""Errors of reference pages, which show a call and not where its arguments come from."""

OF_OTHERS = '"Axes" has no attribute'
"""What matplotlib's types do not tell of polar axes."""


@pytest.mark.slow
def test_mypy_accepts_what_is_shown(written):
    command = [
        *(sys.executable, "-m", "mypy", "--strict", "--no-error-summary"),
        *("--config-file", "/dev/null", "--cache-dir", str(written / "cache")),
        *("--disable-error-code", "no-untyped-def"),
        *("--disable-error-code", "no-untyped-call"),
        *("--disable-error-code", "import-untyped"),
        *sorted(path.name for path in written.glob("*.py")),
    ]
    done = subprocess.run(
        command, cwd=written, capture_output=True, text=True, check=False
    )
    own = [
        line
        for line in done.stdout.splitlines()
        if ".py:" in line
        and OF_OTHERS not in line
        and not (line.startswith("docs_") and line.endswith(LEFT_TO_THE_READER))
    ]
    assert done.returncode in (0, 1), done.stderr
    assert not own, "\n".join(own)


@pytest.mark.slow
@pytest.mark.skipif(
    shutil.which("pyright") is None and find_spec("pyright") is None,
    reason="pyright is not installed",
)
def test_pyright_accepts_what_is_shown(written):
    checker = ["pyright"]
    if find_spec("pyright"):
        checker = [sys.executable, "-m", "pyright"]
    done = subprocess.run(
        [*checker, "--pythonpath", sys.executable, str(written)],
        capture_output=True,
        text=True,
        check=False,
    )
    about = re.compile(r"rockfrag|argument|parameter", re.I)
    own = [
        line
        for line in done.stdout.splitlines()
        if " error: " in line and about.search(line)
    ]
    # it looked at all of them
    assert re.search(r"^\d+ errors?, ", done.stdout, re.MULTILINE), done.stderr
    assert not own, "\n".join(own)
