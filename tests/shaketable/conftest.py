import numpy as np
import pytest

from rockfrag.records.motion import Motion

EVENTS = ("Friuli", "Kobe", "Loma_Prieta", "Northridge")


@pytest.fixture(scope="session")
def records(shared):
    """The four reference records: five header lines, then time [s] and acceleration [g]."""
    motions = {}
    for name in EVENTS:
        _, acceleration = np.loadtxt(shared / "records" / f"{name}.dat", skiprows=5).T
        motions[name] = Motion(9.81 * acceleration, 0.01, name, {"event": name, "floor": "GF"})
    return motions
