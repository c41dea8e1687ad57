from pathlib import Path

import numpy as np
import pytest
import yaml

from rockfrag.records.motion import Motion

CONFIG = Path(__file__).resolve().parents[2] / "config" / "building.yaml"


@pytest.fixture
def settings():
    """Settings of the reference building."""
    return yaml.safe_load(CONFIG.read_text(encoding="utf-8"))


@pytest.fixture
def record(shared):
    """Reader of the reference records: five header lines, then time [s] and acceleration [g]."""

    def read(name):
        time, acceleration = np.loadtxt(shared / "records" / f"{name}.dat", skiprows=5).T
        return Motion(9.81 * acceleration, round(time[1] - time[0], 6), name)

    return read


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
