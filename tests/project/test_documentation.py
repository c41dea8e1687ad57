"""The site builds, its links lead somewhere, and README and tutorial work as they stand there."""

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
from lxml import html

from rockfrag.cli.main import main
from rockfrag.config.schema import read_schema

from ..conftest import SUBPACKAGES, shaking

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
TUTORIAL = (DOCS / "tutorial.md").read_text(encoding="utf-8")
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def links_of(page: Path) -> tuple[list[str], set[str]]:
    """What a page points to, and the places in it that can be pointed at."""
    tree = html.parse(str(page))
    return tree.xpath("//@href | //@src"), set(tree.xpath("//@id | //@name"))


@pytest.mark.slow
def test_every_link_and_image_of_the_site_resolves(site):
    pages = {page.resolve(): links_of(page) for page in site.rglob("*.html")}
    assert len(pages) > 60
    checked = 0
    for page, (targets, _) in pages.items():
        for target in filter(None, targets):
            if re.match(r"(https?:|mailto:|data:|//)", target):
                continue
            path, _, anchor = target.split("?")[0].partition("#")
            other = (page.parent / path).resolve() if path else page
            assert other.exists(), f"{page.name} points to {target}"
            if anchor and other in pages and anchor not in ("top", "furo-main-content"):
                assert anchor in pages[other][1], f"{page.name} points to {target}"
            checked += 1
    assert checked > 2000


@pytest.mark.slow
def test_the_gallery_shows_a_picture_beside_each_script(site):
    scripts = sorted((DOCS / "gallery").glob("plot_*.py"))
    assert len(scripts) >= 12
    for script in scripts:
        page = (site / "auto_gallery" / f"{script.stem}.html").read_text(
            encoding="utf-8"
        )
        assert re.search(rf"_images/sphx_glr_{script.stem}_001\S*\.png", page), (
            script.name
        )
        # once, and nothing that a script did not print
        assert f"sphx_glr_{script.stem}_002" not in page, script.name
        assert "object at 0x" not in page, script.name
        assert "rockfrag" in page


@pytest.mark.slow
def test_the_first_screen_has_one_heading_one_picture_and_three_commands(site):
    page = html.parse(str(site / "index.html"))
    assert len(page.xpath("//h1")) == len(page.xpath("//article//img")) == 1
    assert not page.xpath("//iframe")
    commands = [
        each.text_content().split()[:2] for each in page.xpath("//article//pre")
    ]
    assert list(map(" ".join, commands)) == [
        *("python3 -m", "rockfrag assess", "rockfrag simulate", "make run")
    ]


@pytest.mark.slow
def test_every_subpackage_has_a_page_with_the_names_to_import(site):
    for package in filter(None, SUBPACKAGES):
        page = (site / "reference" / "api" / f"{package[1:]}.html").read_text(
            encoding="utf-8"
        )
        assert f'id="rockfrag{package}.' in page


IN_PYTHON = [
    "tutorial-python.md",
    *(f"how-to/{path.name}" for path in (DOCS / "how-to").glob("*.md")),
]


@pytest.mark.parametrize("name", sorted(IN_PYTHON))
def test_what_a_page_shows_in_python_runs_as_it_stands_there(
    name, tmp_path, monkeypatch
):
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
    for page in [
        ROOT / "README.md",
        *DOCS.glob("*.md"),
        *(DOCS / "how-to").glob("*.md"),
    ]:
        text = page.read_text(encoding="utf-8")
        named = (
            re.findall(r"`((?:config|docs)/[^`<]+)`", text)
            if page.parent == ROOT
            else []
        )
        for target in [*named, *re.findall(r"\]\(([^)\s]+)\)", text)]:
            path = target.partition("#")[0]
            if (
                not path
                or re.match(r"https?:", path)
                or "reference/" in path
                or "auto_" in path
            ):
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


def test_tests_that_a_page_names_exist():
    pages = (page.read_text(encoding="utf-8") for page in sorted(DOCS.glob("*.md")))
    named = re.findall(r"`([\w/]+\.py)::(test_\w+)`", "\n".join(pages))
    assert len(named) > 20
    for file, test in named:
        package = "thesis" if file.startswith("thesis/") else ""
        path = ROOT / package / "tests" / file.removeprefix("thesis/")
        assert f"def {test}(" in path.read_text(encoding="utf-8"), f"{file}::{test}"


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
    page = at_home / "assessment" / "the-object.html"
    assert "10 own motions" in page.read_text(encoding="utf-8")
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


README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = ("Makefile", "pyproject.toml", "requirements", "workflow", "profiles")


def fences(language: str) -> list[str]:
    """Contents of all fenced blocks of a language, without the indentation of lists."""
    found = re.findall(
        rf"^( *)```{language}\n(.*?)^ *```$", README, re.MULTILINE | re.DOTALL
    )
    return [
        re.sub(rf"^{indent}", "", text, flags=re.MULTILINE) for indent, text in found
    ]


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
        assert done.returncode == 0, (
            f"{line}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        )
        return done.stdout

    return run


@pytest.mark.slow
@pytest.mark.skipif(
    os.name == "nt", reason="make and symbolic links are those of POSIX"
)
def test_the_route_to_ones_own_statue_ends_in_a_report(checkout, typed):
    mine = checkout / "mine"
    (mine / "records").mkdir(parents=True)
    for seed in range(3):
        motion = shaking(seed, 0.3, 5.0, 0.3, 1200)
        rows = np.column_stack([motion.time, motion.acceleration / 9.81])
        np.savetxt(mine / "records" / f"station{seed}.txt", rows, "%.6f")
    named = re.findall(
        r"`(mine/[a-z]+\.(?:csv|yaml))`[^`]*(?:`[^`\n]+`[^`]*)*?\n\n *```(csv|yaml)",
        README,
    )
    texts = {"csv": iter(fences("csv")), "yaml": iter(fences("yaml"))}
    for path, language in named:
        (checkout / path).write_text(next(texts[language]))
    make_catalogue, check, run = (line for line in commands() if "mine/" in line)
    typed(make_catalogue)
    assert len(pd.read_csv(mine / "motions.csv")) == 3
    assert "is right" in typed(check)
    typed(run)
    report = (checkout / "results" / "venus" / "report.html").read_text(
        encoding="utf-8"
    )
    assert "A marble Venus with and without her plinth" in report
    tests = pd.read_csv(checkout / "results" / "venus" / "tests.csv")
    assert set(tests["configuration"]) == {"venus", "venus on its plinth"}


@pytest.fixture
def record(checkout, noise) -> Path:
    """The record that the README calls record.AT2."""
    from rockfrag.motions import scale_to_pga
    from rockfrag.records import write_motion

    return write_motion(
        scale_to_pga(noise(7, 800, tapered=True), 0.4), checkout / "record.AT2"
    )


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
    known = set(
        re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    )
    assert targets <= known
    assert {"run", "test", "smoke"} <= targets


def keys_of(schema: dict) -> set[str]:
    """Names of the keys of a mapping and of the mappings in it, those of laws of materials aside."""
    found = set()
    for name, item in schema.get("properties", {}).items():
        found |= {name} | (keys_of(item) if name != "masonry" else set())
    return found


def test_every_key_of_a_configuration_is_explained():
    kinds = json.loads(
        (ROOT / "src/rockfrag/config/schema.json").read_text(encoding="utf-8")
    )["$defs"]
    schemas = {kind: read_schema(kind) for kind in kinds}
    text = (ROOT / "config/README.md").read_text(encoding="utf-8")
    explained = set(re.findall(r"`([A-Za-z_0-9]+)`", text))
    assert set().union(*(keys_of(schema) for schema in schemas.values())) <= explained
