"""What a page carries in itself: bytes as text, and data that cannot end the script in which they stand."""

import base64
import json
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

TEMPLATES = Environment(
    loader=PackageLoader("rockfrag.report"),
    autoescape=select_autoescape(default=True),
    undefined=StrictUndefined,
)
"""Scripts, styles and elements of pages."""


def scripts_of(*names: str) -> Markup:
    """Return scripts of the package as text of a page."""
    return Markup("\n".join(TEMPLATES.get_template(f"{name}.js").render() for name in names))


def base64_text(content: bytes) -> str:
    """Return bytes as text of a page."""
    return base64.b64encode(content).decode("ascii")


def json_text(data: Any) -> Markup:
    """Return data as JSON in a script: a name in it may hold anything, but never the script's end."""
    return Markup(json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))
