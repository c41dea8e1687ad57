"""
What falls first: a bookcase, a server rack, a gas cylinder?
=============================================================

Usual things of each kind, to one scale, with the shaking at which half of forty synthetic motions topple them in
the plane of their width (diamonds). Circles are where they start to rock; bars reach from where one motion in ten
topples them to nine in ten. A round cylinder that rolls in space falls earlier: see :doc:`space </space>`.
"""

import warnings
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from rockfrag import overturns
from rockfrag.motions import evolutionary, scale_to_pga
from rockfrag.simulation import LightBodies
from rockfrag.system import block_of_kind

names = (
    "bookcase",
    "server-rack",
    "gas-cylinder",
    "bust",
    "tombstone",
    "rock",
    "pallet",
)
blocks = {name: replace(block_of_kind(name), depth=None, round=False) for name in names}
draw = np.random.default_rng(1)
noise = {"arias_m_s": 1.0, "d5_95_s": 8.0, "mid_s": 4.0, "slope_hz_s": -0.05}
motions = [
    scale_to_pga(
        evolutionary(seed, mid_hz=draw.uniform(0.8, 3.0), filter_damping=0.3, **noise),
        1.0,
    )
    for seed in range(40)
]
pga = np.geomspace(0.05, 3.0, 90)
# squat things may leave the ground above 1 g, where most have toppled
warnings.simplefilter("ignore", LightBodies)
fallen = overturns(blocks, motions, scales=pga).overturned.mean(axis=1)

# %%
# Motions have a peak of 1 g, so a scale is a peak in g.

figure, (shapes, levels) = plt.subplots(
    2, 1, figsize=(7, 4.6), sharex=True, height_ratios=[3, 2]
)
for place, block in enumerate(blocks.values()):
    corner = (place - 0.2 * block.width / 0.4, 0)
    size = (0.4 * block.width / 0.4, block.height)
    shapes.add_patch(Rectangle(corner, *size, facecolor="#56B4E9", edgecolor="black"))
    shapes.plot(corner[0] + size[0] / 2, block.h, "k+")
    at = [pga[np.searchsorted(fallen[place], q)] for q in (0.1, 0.5, 0.9)]
    levels.plot([place, place], [at[0], at[2]], color="#0072B2", lw=5, alpha=0.5)
    levels.plot(place, at[1], "D", color="#0072B2")
    levels.plot(place, np.tan(block.alpha), "o", mfc="white", mec="#D55E00")
shapes.set(ylabel="height [m]", ylim=(0, 2.2), xlim=(-0.6, len(names) - 0.4))
shapes.set_aspect("auto")
levels.set(ylabel="peak acceleration [g]", yscale="log")
levels.set_yticks([0.1, 0.2, 0.5, 1, 2], ["0.1", "0.2", "0.5", "1", "2"])
levels.minorticks_off()
titles = [name.replace("-", "\n") for name in names]
levels.set_xticks(range(len(names)), titles, fontsize=8)
