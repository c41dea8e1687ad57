"""The figure of a body in space says what its outcome says."""

import math
from types import SimpleNamespace

import numpy as np
import pandas as pd

from rockfrag.engines.spatial.response_figure import spatial_figure


def test_the_plan_is_headed_by_the_turn_of_the_outcome():
    """A history ends with the motion, the outcome with the free rocking after it."""
    columns = ("axis_x", "axis_y", "tilt_rad", "turn_rad", "base_x_m", "base_y_m")
    history = pd.DataFrame(np.zeros((3, len(columns))), columns=list(columns))
    history["turn_rad"] = [0.0, 0.1, math.radians(15.3)]
    outcome = SimpleNamespace(turn=math.radians(14.82), overturned=False)
    square = np.array([(0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)])
    figure = spatial_figure(outcome, history, square, "vase")
    assert figure.axes[1].get_title(loc="left") == "Turned by 14.8°"
