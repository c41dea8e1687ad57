"""
What does wax buy?
==================

A bust on its pads of wax does not rock until they are pulled off, and then it falls at once: the curve of toppling
over the level is steeper with wax than without.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, overturns
from rockfrag.motions import evolutionary
from rockfrag.system import Bond, hold

shape = {"d5_95_s": 8.0, "mid_s": 4.0, "mid_hz": 2.0, "slope_hz_s": -0.05}
motions = [
    evolutionary(seed, arias_m_s=1.0, filter_damping=0.3, **shape) for seed in range(40)
]
bust = Block(0.25, 0.70, 60.0)
pulls = {"free": None, "wax that holds 600 N": 600.0, "wax that holds 1.5 kN": 1500.0}
held = [
    bust.system()
    if pull is None
    else hold(bust.system(), bonds=Bond(pull, 1e6, spread=0.10))
    for pull in pulls.values()
]

# %%
# Forty made motions, each scaled to the same peak accelerations.

levels = np.linspace(0.2, 1.4, 25)  # g
scales = levels * 9.81 / np.array([[motion.pga] for motion in motions])
found = overturns(held, motions, scales=scales, friction=0.7)
fractions = found.overturned.mean(axis=1)

figure, axes = plt.subplots(figsize=(5.4, 3.4))
for line, (name, fraction) in zip(
    ("-", "--", ":"), zip(pulls, fractions, strict=True), strict=True
):
    axes.plot(levels, fraction, line, label=name)
axes.set(xlabel="peak ground acceleration [g]", ylabel="fraction that topples [-]")
axes.legend(frameon=False, fontsize=8, loc="upper left")
