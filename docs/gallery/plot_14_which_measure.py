"""
Which number of a record says most?
===================================

The same hundred synthetic motions, as they are, by peak acceleration and by peak velocity. A measure is the
better the less the two clouds overlap.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, overturns
from rockfrag.fragility import Observations, area_under_curve
from rockfrag.motions import evolutionary, pga, pgv

draw = np.random.default_rng(4)
motions = [
    evolutionary(
        seed, arias_m_s=10 ** draw.uniform(-0.3, 1.0), d5_95_s=8.0, mid_s=4.0,
        mid_hz=draw.uniform(0.8, 5.0), slope_hz_s=-0.05, filter_damping=0.3,
    )
    for seed in range(100)
]  # fmt: skip
fallen = overturns(Block(width=0.35, height=1.20, mass=180.0), motions).overturned[
    0, :, 0
]
measures = {
    "peak ground acceleration [g]": np.array([pga(motion) for motion in motions])
    / 9.81,
    "peak ground velocity [cm/s]": 100 * np.array([pgv(motion) for motion in motions]),
}

figure, panels = plt.subplots(1, 2, figsize=(7, 3.0), sharey=True)
names = np.array([f"motion {number}" for number in range(100)], dtype=object)
height = np.random.default_rng(0).uniform(-0.25, 0.25, 100)
for panel, (name, values) in zip(panels, measures.items(), strict=True):
    for outcome, colour in ((False, "#0072B2"), (True, "#D55E00")):
        panel.plot(
            values[fallen == outcome],
            height[fallen == outcome] + outcome,
            "o",
            markersize=4,
            color=colour,
        )
    panel.set(xlabel=name, yticks=[0, 1], yticklabels=["stands", "overturns"])
    outcomes = Observations(values, fallen.astype(float), np.ones(100), names, names)
    panel.set_title(f"area under the ROC curve {area_under_curve(outcomes):.2f}")
