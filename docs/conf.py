"""The documentation as a site: `make docs` builds it without network."""

import argparse
import importlib
import inspect
import json
import re
import sys
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "src"))
sys.path.insert(0, str(ROOT / "docs"))

from rockfrag import __version__  # noqa: E402

project = "rockfrag"
author = "rockfrag developers"
copyright = author
release = __version__

extensions = [
    *("myst_parser", "sphinx.ext.autodoc", "numpydoc"),
    *("sphinx_copybutton", "sphinx_gallery.gen_gallery"),
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = [
    "_build",
    "reference/static",
    "gallery",
    "images",
    "auto_gallery/*.md5",
]
html_theme = "furo"
html_title = f"rockfrag {release}"
html_extra_path = ["tutorial.ipynb"]
html_static_path = ["static", "reference/static"]
# Sphinx looks for it before anything is generated
(ROOT / "docs" / "reference" / "static").mkdir(parents=True, exist_ok=True)
html_copy_source = False
html_show_sourcelink = False
html_css_files = ["site.css"]
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True
copybutton_exclude = ".linenos, .gp, .go"
sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "filename_pattern": r"/plot_",
    "within_subsection_order": "FileNameSortKey",
    "reset_modules": ("gallery_style.journal",),
    # figures that pyplot does not know come first: what it has saved and closed looks like one of them
    "image_scrapers": ("gallery_style.kept_figures", "matplotlib"),
    # a script prints what it wants to be read
    "capture_repr": (),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "image_srcset": ["2x"],
    "plot_gallery": "True",
}
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
autodoc_typehints = "none"
numpydoc_show_class_members = False
suppress_warnings = ["myst.header", "ref.python", "misc.highlighting_failure"]
# of a checkout in a folder with a space in its name; the links hold
suppress_warnings += ["sphinx_gallery.space_in_filename"]

SUBPACKAGES = {
    "rockfrag.system": (
        "Objects",
        "what is shaken: blocks, stacks, columns, bodies in space, scans",
    ),
    "rockfrag.simulation": (
        "Simulation",
        "histories, ensembles, thresholds, rocking spectra, closed forms",
    ),
    "rockfrag.outcomes": (
        "Outcomes",
        "what comes out of simulations, and states of damage",
    ),
    "rockfrag.records": ("Records", "read, list and write strong-motion records"),
    "rockfrag.motions": (
        "Motions",
        "filter, scale, rotate, measure; spectra, pulses, synthetic motions",
    ),
    "rockfrag.building": ("Buildings", "motions of the floors of a building"),
    "rockfrag.fragility": (
        "Fragility",
        "curves with intervals, intensity-measure selection, exports",
    ),
    "rockfrag.effects": ("Paired comparisons", "the effect of a pedestal, tested"),
    "rockfrag.shaketable": ("Shaking tables", "limits, protocols and tables of tests"),
    "rockfrag.collections": (
        "Collections",
        "tables of museums as inventories: dimensions in words, units, six languages",
    ),
    "rockfrag.assess": (
        "One object at one place",
        "what the command `rockfrag assess` does",
    ),
}
"""Subpackages whose public names are documented, in the order in which people need them."""

PAGES = {
    "../config/README.md": "/reference/configuration.md",
    "../results/README.md": "/reference/results.md",
    "../CONTRIBUTING.md": "/reference/contributing.md",
    "../CHANGELOG.md": "/reference/changelog.md",
}
"""Documents outside this folder, and the page that shows each."""

GENERATED = {
    "/reference/configuration.md": ROOT / "config" / "README.md",
    "/reference/results.md": ROOT / "results" / "README.md",
    "/reference/contributing.md": ROOT / "CONTRIBUTING.md",
    "/reference/changelog.md": ROOT / "CHANGELOG.md",
}


def _site_links(app: Sphinx, name: str, source: list[str]) -> None:
    """Turn links of the repository into links of the site; what the site does not show becomes plain text."""

    def link(found: re.Match[str]) -> str:
        text, target = found[1], found[2]
        path, _, anchor = target.partition("#")
        if path in PAGES:
            return f"[{text}]({PAGES[path]}{'#' + anchor if anchor else ''})"
        return text if path.startswith("../") else found[0]

    source[0] = re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, source[0])


def _included(text: str, home: Path) -> str:
    """A document of another folder, its links read from this one."""

    def link(found: re.Match[str]) -> str:
        text, target = found[1], found[2]
        if target.startswith(("http", "#")):
            return found[0]
        path = (home / target.partition("#")[0]).resolve()
        if path.parent == ROOT / "docs" and path.is_file():
            return f"[{text}](/{path.name})"
        shown = next(
            (page for page, origin in GENERATED.items() if origin == path), None
        )
        return f"[{text}]({shown})" if shown else text

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def _generate(app: Sphinx) -> None:
    """Write the pages that are made of other files: the command line, the configuration, the results."""
    folder = Path(app.srcdir)
    for name, origin in GENERATED.items():
        text = _included(origin.read_text(encoding="utf-8"), origin.parent)
        if name.endswith("configuration.md"):
            text += _schema_tables()
        _write(folder / name.lstrip("/"), text)
    _write_live(folder / "reference" / "static" / "play.html")
    _write_app(folder / "reference" / "static" / "assess.html")
    _write(folder / "reference" / "command-line.md", _command_line())
    pages = {
        folder / "reference" / "api" / f"{name}.md": text
        for name, text in _library().items()
    }
    for stale in set((folder / "reference" / "api").glob("*.md")) - set(pages):
        stale.unlink()  # of a subpackage that is gone
    for path, text in pages.items():
        _write(path, text)


def _write(path: Path, text: str) -> None:
    # untouched files keep their time, so that nothing is built twice
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _command_line() -> str:
    from rockfrag.cli.main import make_parser

    parser = make_parser()
    commands = next(
        action
        for action in parser._actions
        if isinstance(action, argparse._SubParsersAction)
    )
    parts = ["# The command line", "", f"```text\n{parser.format_help()}```"]
    for name, command in commands.choices.items():
        command.formatter_class = lambda prog: argparse.HelpFormatter(prog, width=100)
        parts += ["", f"## rockfrag {name}", "", f"```text\n{command.format_help()}```"]
    return "\n".join(parts) + "\n"


def _library() -> dict[str, str]:
    """Return a page a subpackage, whose names stand there as they are imported, and one that lists them."""
    pages = {}
    shown: set[object] = set()
    front = [
        "# Library",
        "",
        "SI units throughout: m, kg, s, rad, m/s². What is used most stands in `rockfrag` itself:",
        "",
    ]
    top = sorted(
        name
        for name in importlib.import_module("rockfrag").__all__
        if not _is_module(name)
    )
    front += [", ".join(f"`{name}`" for name in top) + ".", ""]
    front += ["| topic | import from | for |", "|---|---|---|"]
    for module, (title, words) in SUBPACKAGES.items():
        page = module.rpartition(".")[2]
        front.append(f"| [{title}]({page}.md) | `{module}` | {words} |")
        pages[page] = _subpackage(module, title, words, shown)
    front += ["", "```{toctree}", ":hidden:", "", *pages, "```"]
    return {"index": "\n".join(front) + "\n", **pages}


def _is_module(name: str) -> bool:
    return inspect.ismodule(getattr(importlib.import_module("rockfrag"), name))


def _subpackage(module: str, title: str, words: str, shown: set[object]) -> str:
    """Page of a subpackage, without what another page has shown, which it adds to."""
    package = importlib.import_module(module)
    public = {
        name: getattr(package, name) for name in sorted(package.__all__, key=str.lower)
    }
    documented = {
        name: value
        for name, value in public.items()
        if (inspect.isfunction(value) or inspect.isclass(value)) and value not in shown
    }
    shown |= set(documented.values())
    parts = [f"# {title}", "", f"`{module}`: {words}.", ""]
    parts += ["| name | what it does |", "|---|---|"]
    for name, value in documented.items():
        first = (
            (inspect.getdoc(value) or "")
            .split("\n\n")[0]
            .replace("\n", " ")
            .replace("|", "\\|")
        )
        parts.append(f"| [`{name}`](#{module}.{name}) | {_plain(first)} |")
    parts += ["", "```{eval-rst}"]
    for name, value in documented.items():
        kind = "autofunction" if inspect.isfunction(value) else "autoclass"
        parts += [
            f".. {kind}:: {module}.{name}",
            *(["   :members:"] if kind == "autoclass" else []),
            "",
        ]
    return "\n".join([*parts, "```", ""])


def _plain(text: str) -> str:
    """Return a line of a docstring without its markup."""
    return re.sub(r":\w+:`([^`]+)`", r"\1", text).replace("``", "`")


def _schema_tables() -> str:
    """Every key of every file with what it may hold, from the schema itself."""
    from rockfrag.config.schema import read_schema

    kinds = json.loads(
        (ROOT / "src/rockfrag/config/schema.json").read_text(encoding="utf-8")
    )["$defs"]
    schemas = {kind: read_schema(kind) for kind in kinds}
    parts = ["", "## All keys, from the schema", ""]
    for name, schema in schemas.items():
        parts += [
            f"### {schema.get('title', name)}",
            "",
            "| key | expected |",
            "|---|---|",
        ]
        parts += [f"| `{key}` | {words} |" for key, words in _keys(schema, "")]
        parts.append("")
    return "\n".join(parts)


def _keys(schema: dict, above: str):
    for name, item in schema.get("properties", {}).items():
        words = str(item.get("description", "")).replace("|", "\\|")
        yield f"{above}{name}", words
        yield from _keys(item, f"{above}{name}.")


def _write_live(path: Path) -> None:
    """The page of the front page's frame: a figure on a plinth under a pulse, simulated by whoever reads it."""
    from rockfrag import Block, Stack
    from rockfrag.motions import ricker_symmetric
    from rockfrag.records.motion import Motion
    from rockfrag.report.play_page import write_play_page

    pulse = ricker_symmetric(4.0, 0.9, 0.01)
    named = Motion(pulse.acceleration, pulse.dt, "a near-fault pulse of 0.9 s")
    body = Stack(Block(0.5, 0.9, 400.0), Block(0.35, 1.2, 180.0))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_play_page(body, named, path)


def _write_app(path: Path) -> None:
    """The assessment as one page, under pulses and noise that are made by formulas and may be published."""
    import numpy as np

    from rockfrag.assess.app.writing import write_app
    from rockfrag.assess.motions import MotionSet
    from rockfrag.motions import ricker_symmetric
    from rockfrag.records.motion import Motion

    motions = []
    for i in range(24):
        pulse = ricker_symmetric(1.5 + 0.1 * i, 0.25 + 0.06 * i, 0.01).acceleration
        time = np.arange(1500) * 0.01
        phases = np.random.default_rng(i).uniform(0, 2 * np.pi, 12)
        waves = np.sin(
            2 * np.pi * np.geomspace(0.7, 9, 12)[:, np.newaxis] * time
            + phases[:, np.newaxis]
        )
        shaken = 0.5 * waves.sum(axis=0) * np.exp(-(((time - 5) / 3) ** 2))
        shaken[300 : 300 + pulse.size] += pulse[:1200]
        about = {"earthquake": f"made earthquake {i // 3 + 1}"}
        motions.append(Motion(np.round(shaken, 4), 0.01, f"made motion {i + 1}", about))
    made = tuple(motions)
    form = {
        "width": "35 cm",
        "height": "1.2 m",
        "measure": "PGA",
        "level": "0.4 g",
        "years": "475",
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    write_app(
        MotionSet(made, made, (), "24 made motions of 8 made earthquakes"),
        form,
        path,
        made=True,
    )


ACCESSIBLE = (
    # a keyboard can scroll what is wider than the page
    (r"<pre>", '<pre tabindex="0">'),
    (r'<div class="(math|table-wrapper)', r'<div tabindex="0" class="\1'),
    # landmarks of one kind are told apart
    (
        r'<aside class="sidebar-drawer">',
        '<aside class="sidebar-drawer" aria-label="Pages">',
    ),
    (
        r'<aside class="toc-drawer([^"]*)">',
        r'<aside class="toc-drawer\1" aria-label="Contents of this page">',
    ),
    (r'role="heading">', 'role="heading" aria-level="2">'),
    (
        r'(?<!</h1>)<div id="search-results">',
        '<h1>Search</h1><div id="search-results">',
    ),
    # a cell without words is no heading
    (r'<th class="head([^"]*)"><p></p></th>', r'<td class="head\1"></td>'),
    # the words of a thumbnail's link are hidden behind its picture
    (
        r'<a class="reference internal" href="(plot_[^"]+)"><span class="doc">([^<]+)</span></a>',
        r'<a class="reference internal" href="\1" aria-label="\2"><span class="doc">\2</span></a>',
    ),
)
"""What the theme leaves out, and what stands there instead."""


def _make_accessible(app: Sphinx, failed: Exception | None) -> None:
    """Mend pages for those who use a keyboard or listen; what is mended already is not found again."""
    for path in Path(app.outdir).rglob("*.html") if failed is None else ():
        if "_static" not in path.parts:
            text = path.read_text(encoding="utf-8")
            for found, instead in ACCESSIBLE:
                text = re.sub(found, instead, text)
            path.write_text(text, encoding="utf-8")


def _plain_bars(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Bars are absolute values in docstrings, not substitutions."""
    lines[:] = [line.replace("|", r"\|") for line in lines]


def setup(app: Sphinx) -> None:
    """Connect the generated pages to the build."""
    app.connect("autodoc-process-docstring", _plain_bars, priority=900)
    app.connect("builder-inited", _generate)
    app.connect("source-read", _site_links)
    app.connect("build-finished", _make_accessible)
