from pathlib import Path

import pytest
import yaml

CONFIG = Path(__file__).resolve().parents[2] / "config" / "building.yaml"


@pytest.fixture
def settings():
    """Settings of the reference building."""
    return yaml.safe_load(CONFIG.read_text(encoding="utf-8"))


@pytest.fixture
def opensees():
    """OpenSees, where it can be imported: its wheel lacks libraries that some systems lack too."""
    try:
        import openseespy.opensees as ops
    except (ImportError, RuntimeError) as error:
        pytest.skip(f"OpenSees cannot be imported: {error}")
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    yield ops
    ops.wipe()
