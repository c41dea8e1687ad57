"""
Does the pedestal protect the statue?
=====================================

Every amplitude of ten synthetic motions at which the statue falls, alone and on a pedestal. A gap in a bar
is a stronger motion that the statue survives: more shaking does not always mean overturning.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Patch

from rockfrag import Block, Stack, overturns
from rockfrag.motions import evolutionary, scale_to_pga

statue = Block(width=0.35, height=1.20, mass=180.0)
stack = Stack(Block(width=0.50, height=0.90, mass=400.0), statue)
noise = {
    "arias_m_s": 1.0,
    "d5_95_s": 8.0,
    "mid_s": 4.0,
    "mid_hz": 1.5,
    "slope_hz_s": -0.05,
}
motions = [
    scale_to_pga(evolutionary(seed, filter_damping=0.3, **noise), 1.0)
    for seed in range(10)
]

# %%
# Peaks of 1 g make scales peak accelerations in g.

pga = np.linspace(0.2, 1.6, 141)
fallen = overturns([statue, stack], motions, scales=pga).overturned

figure, panels = plt.subplots(1, 2, figsize=(7, 3.2), sharex=True, sharey=True)
for panel, title, outcomes in zip(
    panels, ("alone", "on a pedestal"), fallen, strict=True
):
    panel.pcolormesh(
        pga,
        np.arange(1, 11),
        outcomes,
        cmap="Blues",
        vmin=0,
        vmax=1.3,
        shading="nearest",
    )
    panel.set(title=title, xlabel="peak ground acceleration [g]")
panels[0].set(ylabel="synthetic motion", yticks=range(1, 11))
handles = [
    Patch(facecolor=plt.get_cmap("Blues")(1 / 1.3), label="overturns"),
    Patch(facecolor="white", edgecolor="0.5", label="stands"),
]
figure.legend(handles=handles, loc="outside lower center", ncols=2)
