"""
Does it rock or slide?
======================

A block on a plane rocks if friction is larger than its width over its height, and slides if it is not. The
friction of dry stone, 0.5 to 0.7, lets slender objects rock and squat ones slide.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

from rockfrag import Block, overturns
from rockfrag.motions import one_sine

frictions = np.linspace(0.1, 0.9, 25)
slenderness = np.linspace(1.2, 6.0, 25)
motion = one_sine(amplitude=9.81, period=0.6)
bodies = [Block(1.0 / h, 1.0, 200.0) for h in slenderness for _ in frictions]
found = overturns(
    bodies, motion, friction=[float(mu) for _ in slenderness for mu in frictions]
)
shape = (slenderness.size, frictions.size)
rocked = (found.peak_rotation[:, 0, 0, 0] > 1e-4).reshape(shape)
slid = (found.peak_slip[:, 0, 0, 0] > 1e-4).reshape(shape)
fell = found.overturned[:, 0, 0].reshape(shape)

# %%
# What each block does under one sine of 1 g and 0.6 s.

kind = np.where(fell, 3, np.where(rocked & slid, 2, np.where(rocked, 1, 0)))
figure, axes = plt.subplots(figsize=(5.4, 3.6))
colours = ListedColormap(["#E69F00", "#56B4E9", "#009E73", "#444444"])
mesh = axes.pcolormesh(
    frictions, slenderness, kind, cmap=colours, vmin=-0.5, vmax=3.5, shading="nearest"
)
axes.plot(frictions, 1 / frictions, "k--", linewidth=1)
axes.set(
    xlabel="coefficient of friction",
    ylabel="height over width",
    ylim=(1.2, 6.0),
)
bar = figure.colorbar(mesh, ticks=range(4))
names = ["slides", "rocks", "rocks and slides", "overturns"]
bar.ax.set_yticklabels(names, fontsize=8)
axes.text(0.42, 2.7, "friction = width / height", fontsize=8, color="white")
