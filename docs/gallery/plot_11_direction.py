"""
From which direction is shaking worst?
======================================

The two horizontal components of a record are turned step by step, and the least scale that overturns a body
that rocks in one plane is found in each direction. A body in space may do worse than its worst plane: see
:doc:`what it cannot do </limitations>`.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, worst_direction
from rockfrag.motions import evolutionary

noise = {"d5_95_s": 8.0, "mid_s": 4.0, "slope_hz_s": -0.05, "filter_damping": 0.3}
first = evolutionary(11, arias_m_s=1.0, mid_hz=1.2, **noise)
second = evolutionary(12, arias_m_s=0.5, mid_hz=2.0, **noise)
found = worst_direction(
    Block(width=0.35, height=1.20, mass=180.0), first, second, highest=6.0
)

table = found.table
figure, axes = plt.subplots(figsize=(4, 4), subplot_kw={"projection": "polar"})
angle = np.radians(np.append(table["angle_deg"], 360.0))
scale = np.append(table["first_overturning"], table["first_overturning"].iloc[0])
axes.plot(angle, scale, "o-", markersize=3)
axes.plot(
    np.radians(found.angle_deg),
    table["first_overturning"].min(),
    "*",
    color="#D55E00",
    markersize=14,
)
# the numbers of the circles away from the star
axes.set_rlabel_position((found.angle_deg + 100) % 360)
axes.set_title("least scale of the record that overturns", fontsize=10)
