"""Tables of cases that are text or numbers alone stand in YAML beside the tests that run them."""

from pathlib import Path
from typing import Any

import yaml


def case_tables(test_file: str) -> dict[str, Any]:
    """Tables by name of ``test_NAME.yaml`` beside ``test_NAME.py``; a row lists what a test is given."""
    return yaml.safe_load(
        Path(test_file).with_suffix(".yaml").read_text(encoding="utf-8")
    )
