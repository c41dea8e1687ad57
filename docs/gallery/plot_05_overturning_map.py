"""
Where do simulations and theory meet?
=====================================

Which one-sine pulses overturn a block: simulations (shaded) beside the closed form of Zhang and Makris
(2001) for overturning without an impact (line). Under the line the block falls after an impact, which the
closed form does not count; between the two ways of falling there is a gap, in which stronger shaking is
survived.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Patch

from rockfrag import Block, overturns
from rockfrag.motions import one_sine
from rockfrag.simulation.closed_forms import one_sine_pulse

# %%
# The closed form holds for a slender block whose equation of motion is linearised.

block = Block(width=0.10, height=1.20, mass=30.0)
p, alpha = block.frequency(), block.alpha
ratios = np.linspace(1.0, 8.0, 36)  # ω / p
levels = np.linspace(1.0, 14.0, 53)  # amplitude over α g
motions = [
    one_sine(alpha * 9.81, 2 * np.pi / (ratio * p), dt=0.005) for ratio in ratios
]
fallen = overturns(block, motions, scales=levels, linear=True).overturned[0]

figure, axes = plt.subplots(figsize=(5, 3.6))
axes.pcolormesh(
    ratios, levels, fallen.T, cmap="Blues", vmin=0, vmax=1.5, shading="nearest"
)
line = np.array([one_sine_pulse(ratio * p, p) for ratio in ratios])
axes.plot(ratios, line, color="#D55E00", label="no impact, closed form")
axes.set(
    xlabel="frequency of the pulse, ω/p",
    ylabel="amplitude, a/(α g)",
    ylim=(1, 14),
)
shade = Patch(facecolor=plt.get_cmap("Blues")(1 / 1.5), label="overturns, simulated")
handles = [shade, *axes.get_legend_handles_labels()[0]]
axes.legend(handles=handles, loc="upper left", fontsize=8, framealpha=1.0)
