"""The documentation's site builds, its links lead somewhere, and its tutorial works as it stands there."""

import json
import os
import re
import shlex
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from rockfrag.cli import main

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
TUTORIAL = (DOCS / "tutorial.md").read_text(encoding="utf-8")
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class _Links(HTMLParser):
    """Collects what a page points to, and the places in it that can be pointed at."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag, attributes):
        known = dict(attributes)
        self.targets += [known[name] for name in ("href", "src") if known.get(name)]
        self.anchors |= {known[name] for name in ("id", "name") if known.get(name)}


def links_of(page: Path) -> _Links:
    found = _Links()
    found.feed(page.read_text(encoding="utf-8"))
    return found


@pytest.mark.slow
def test_every_link_and_image_of_the_site_resolves(tmp_path):
    pytest.importorskip("myst_parser", reason="the extra docs is not installed")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        str(DOCS),
        str(tmp_path),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stderr[-3000:]
    pages = {page.resolve(): links_of(page) for page in tmp_path.rglob("*.html")}
    assert len(pages) > 25
    checked = 0
    for page, found in pages.items():
        for target in found.targets:
            if re.match(r"(https?:|mailto:|data:|//)", target):
                continue
            path, _, anchor = target.split("?")[0].partition("#")
            other = (page.parent / path).resolve() if path else page
            assert other.exists(), f"{page.name} points to {target}"
            if anchor and other in pages and anchor != "top":
                assert anchor in pages[other].anchors, f"{page.name} points to {target}"
            checked += 1
    assert checked > 500


def test_every_document_links_to_what_exists():
    checked = 0
    for page in [*DOCS.glob("*.md"), *(DOCS / "how-to").glob("*.md")]:
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
            path = target.partition("#")[0]
            if not path or re.match(r"https?:", path) or "reference/" in path:
                continue
            assert (page.parent / path).exists(), f"{page.name} links to {target}"
            checked += 1
    assert checked > 20


@pytest.fixture
def at_home(tmp_path, monkeypatch, default_records, record_folder):
    """An empty folder of a user, with the records that are fetched once."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "resources").mkdir()
    (tmp_path / "resources" / "records").symlink_to(ROOT / "resources" / "records")
    return tmp_path


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="symbolic links are those of POSIX")
def test_the_tutorial_works_as_it_stands_there(at_home, capsys):
    ran = 0
    for fence in FENCE.finditer(TUTORIAL):
        language, text = fence.groups()
        if language in ("csv", "yaml"):
            # the file that was named last is the one that is shown
            named = re.findall(r"`([a-z]+\.(?:csv|yaml))`", TUTORIAL[: fence.start()])
            Path(named[-1]).write_text(text, encoding="utf-8")
        elif language == "sh":
            for line in text.splitlines():
                program, *words = shlex.split(line)
                assert program == "rockfrag"
                assert main(words) == 0, line
                ran += 1
        elif language == "python":
            exec(compile(text, "tutorial.md", "exec"), {})
    assert ran >= 8
    shown = capsys.readouterr().out
    assert "Venus, on level 2 of 4" in shown
    assert "10 own motions" in shown
    assert "3 objects, the one most at risk first" in shown
    assert (at_home / "assessment" / "Venus.html").is_file()


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="symbolic links are those of POSIX")
def test_the_notebook_of_the_tutorial_runs(at_home):
    notebook = json.loads((DOCS / "tutorial.ipynb").read_text(encoding="utf-8"))
    names: dict[str, object] = {}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    for cell in cells:
        exec(compile("".join(cell["source"]), "tutorial.ipynb", "exec"), names)
        assert not cell["outputs"]
    assert len(cells) > 4
