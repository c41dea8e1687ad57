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

from rockfrag import __version__  # noqa: E402

project = "rockfrag"
author = "rockfrag developers"
copyright = author
release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_build", "reference/static"]
html_theme = "furo"
html_title = f"rockfrag {release}"
html_extra_path = ["tutorial.ipynb"]
html_static_path = ["reference/static"]
# Sphinx looks for it before anything is generated
(ROOT / "docs" / "reference" / "static").mkdir(parents=True, exist_ok=True)
html_copy_source = False
html_show_sourcelink = False
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
autodoc_typehints = "none"
numpydoc_show_class_members = False
suppress_warnings = ["myst.header", "ref.python", "misc.highlighting_failure"]

ROOMS = {
    "rockfrag.assess": "One object at one place",
    "rockfrag.rocking": "Bodies, histories, ensembles",
    "rockfrag.motions": "Motions",
    "rockfrag.building": "Buildings",
    "rockfrag.fragility": "Fragility",
    "rockfrag.pedestal": "Paired comparisons",
    "rockfrag.shaketable": "Shaking tables",
}
"""Rooms of the library whose public names are documented; records are read by ``rockfrag.read_motion``."""

PAGES = {
    "../config/README.md": "/reference/configuration.md",
    "../results/README.md": "/reference/results.md",
    "../CONTRIBUTING.md": "/reference/contributing.md",
}
"""Documents outside this folder, and the page that shows each."""

LIVE = """```{raw} html
<iframe id="live" src="_static/play.html" title="A figure on a plinth, simulated live" style="width: 100%; height:
56rem; border: 0"> </iframe>
<script>addEventListener("message", (event) => {
  const frame = document.getElementById("live");
  const height = Number(event.data.rockfragHeight);
  if (event.source === frame.contentWindow && height > 0) frame.style.height = `${Math.ceil(height) + 4}px`;
});</script>
```"""
"""What stands for ``{{ live }}`` on the front page."""

GENERATED = {
    "/reference/configuration.md": ROOT / "config" / "README.md",
    "/reference/results.md": ROOT / "results" / "README.md",
    "/reference/contributing.md": ROOT / "CONTRIBUTING.md",
}


def _site_links(app: Sphinx, name: str, source: list[str]) -> None:
    """Turn links of the repository into links of the site; what the site does not show becomes plain text."""
    source[0] = source[0].replace("{{ live }}", LIVE)

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
        shown = next((page for page, origin in GENERATED.items() if origin == path), None)
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
    _write(folder / "reference" / "command-line.md", _command_line())
    _write(folder / "reference" / "api.md", _library())


def _write(path: Path, text: str) -> None:
    # untouched files keep their time, so that nothing is built twice
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _command_line() -> str:
    from rockfrag.cli import make_parser

    parser = make_parser()
    commands = next(
        action for action in parser._actions if isinstance(action, argparse._SubParsersAction)
    )
    parts = ["# The command line", "", f"```text\n{parser.format_help()}```"]
    for name, command in commands.choices.items():
        command.formatter_class = lambda prog: argparse.HelpFormatter(prog, width=100)
        parts += ["", f"## rockfrag {name}", "", f"```text\n{command.format_help()}```"]
    return "\n".join(parts) + "\n"


def _library() -> str:
    """Public names of every room, whose docstrings autodoc puts there."""
    parts = ["# The library", "", "SI units throughout: m, kg, s, rad, m/s².", ""]
    for module, title in ROOMS.items():
        room = importlib.import_module(module)
        parts += [f"## {title}", "", f"`{module}`", "", "```{eval-rst}"]
        for name in sorted(room.__all__):
            value = getattr(room, name)
            if inspect.isfunction(value):
                parts.append(f".. autofunction:: {value.__module__}.{value.__qualname__}")
            elif inspect.isclass(value):
                parts.append(f".. autoclass:: {value.__module__}.{value.__qualname__}")
                parts.append("   :members:")
            parts.append("")
        parts += ["```", ""]
    return "\n".join(parts)


def _schema_tables() -> str:
    """Every key of every file with what it may hold, from the schema itself."""
    schemas = json.loads((ROOT / "src/rockfrag/schema.json").read_text(encoding="utf-8"))["$defs"]
    parts = ["", "# All keys, from the schema", ""]
    for name, schema in schemas.items():
        parts += [f"## {schema.get('title', name)}", "", "| key | expected |", "|---|---|"]
        parts += [f"| `{key}` | {words} |" for key, words in _keys(schema, "")]
        parts.append("")
    return "\n".join(parts)


def _keys(schema: dict, above: str):
    for name, one in schema.get("properties", {}).items():
        words = str(one.get("description", "")).replace("|", "\\|")
        yield f"{above}{name}", words
        yield from _keys(one, f"{above}{name}.")


def _write_live(path: Path) -> None:
    """The page of the front page's frame: a figure on a plinth under a pulse, simulated by whoever reads it."""
    from rockfrag.motions import ricker_symmetric
    from rockfrag.records.motion import Motion
    from rockfrag.report.play_page import write_play_page
    from rockfrag.rocking import Block, Stack

    pulse = ricker_symmetric(4.0, 0.9, 0.01)
    named = Motion(pulse.acceleration, pulse.dt, "a near-fault pulse of 0.9 s")
    body = Stack(Block(0.5, 0.9, 400.0), Block(0.35, 1.2, 180.0))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_play_page(body, named, path)


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
