"""The documentation's site builds, its links lead somewhere, and its tutorial works as it stands there."""

import json
import os
import re
import shlex
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType

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
def test_every_link_and_image_of_the_site_resolves(site):
    pages = {page.resolve(): links_of(page) for page in site.rglob("*.html")}
    assert len(pages) > 60
    checked = 0
    for page, found in pages.items():
        for target in found.targets:
            if re.match(r"(https?:|mailto:|data:|//)", target):
                continue
            path, _, anchor = target.split("?")[0].partition("#")
            other = (page.parent / path).resolve() if path else page
            assert other.exists(), f"{page.name} points to {target}"
            if anchor and other in pages and anchor not in ("top", "furo-main-content"):
                assert anchor in pages[other].anchors, f"{page.name} points to {target}"
            checked += 1
    assert checked > 2000


@pytest.mark.slow
def test_the_gallery_shows_a_picture_beside_each_script(site):
    scripts = sorted((DOCS / "gallery").glob("plot_*.py"))
    assert len(scripts) >= 12
    for script in scripts:
        page = (site / "auto_gallery" / f"{script.stem}.html").read_text(encoding="utf-8")
        assert re.search(rf"_images/sphx_glr_{script.stem}_001\S*\.png", page), script.name
        assert "rockfrag" in page


@pytest.mark.slow
def test_the_first_screen_has_one_heading_one_picture_and_three_commands(site):
    page = (site / "index.html").read_text(encoding="utf-8")
    assert page.count("<h1") == 1
    assert "<iframe" not in page
    article = page.partition("<article")[2].partition("</article>")[0]
    assert article.count("<img") == 1
    commands = [
        re.sub("<[^>]+>", "", item)
        for item in re.findall(r"<pre[^>]*>(.*?)</pre>", article, re.DOTALL)
    ]
    first = [command.split()[:2] for command in commands]
    assert first == [
        ["python3", "-m"],
        ["rockfrag", "assess"],
        ["rockfrag", "simulate"],
        ["make", "run"],
    ]


@pytest.mark.slow
def test_every_subpackage_has_a_page_with_the_names_to_import(site):
    import rockfrag

    packages = [
        name for name in rockfrag.__all__ if isinstance(getattr(rockfrag, name), ModuleType)
    ]
    for package in packages:
        page = (site / "reference" / "api" / f"{package}.html").read_text(encoding="utf-8")
        assert f'id="rockfrag.{package}.' in page
        # ten times shorter than one page of all names was
        assert len(page) < 1_500_000


IN_PYTHON = [
    "tutorial-python.md",
    *(f"how-to/{path.name}" for path in (DOCS / "how-to").glob("*.md")),
]


@pytest.mark.parametrize("name", sorted(IN_PYTHON))
def test_what_a_page_shows_in_python_runs_as_it_stands_there(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    fences = FENCE.findall((DOCS / name).read_text(encoding="utf-8"))
    blocks = [text for language, text in fences if language == "python"]
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, name, "exec"), names)
    if name == "tutorial-python.md":
        assert len(blocks) >= 9
        assert (tmp_path / "thresholds.png").stat().st_size > 3000
        assert (tmp_path / "response.png").stat().st_size > 5000


def test_every_document_links_to_what_exists():
    checked = 0
    for page in [ROOT / "README.md", *DOCS.glob("*.md"), *(DOCS / "how-to").glob("*.md")]:
        text = page.read_text(encoding="utf-8")
        named = re.findall(r"`((?:config|docs)/[^`<]+)`", text) if page.parent == ROOT else []
        for target in [*named, *re.findall(r"\]\(([^)\s]+)\)", text)]:
            path = target.partition("#")[0]
            if not path or re.match(r"https?:", path) or "reference/" in path or "auto_" in path:
                continue
            assert (page.parent / path).exists(), f"{page.name} links to {target}"
            checked += 1
    assert checked > 30


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
    assert "Venus on level 2 of 4" in shown
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
