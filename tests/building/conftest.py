from pathlib import Path

import pytest
import yaml

CONFIG = Path(__file__).resolve().parents[2] / "config" / "building.yaml"


@pytest.fixture
def settings():
    """Settings of the reference building."""
    return yaml.safe_load(CONFIG.read_text(encoding="utf-8"))
