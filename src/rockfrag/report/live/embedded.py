"""What a page carries in itself: bytes as text, and data that cannot end the script in which they stand."""

import base64
import json
from typing import Any

from markupsafe import Markup


def base64_text(content: bytes) -> str:
    """Return bytes as text of a page."""
    return base64.b64encode(content).decode("ascii")


def json_text(data: Any) -> Markup:
    """Return data as JSON in a script: a name in it may hold anything, but never the script's end."""
    return Markup(json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))
