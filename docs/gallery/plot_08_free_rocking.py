"""
How fast does rocking die out?
==============================

A block is let go from half of its critical angle. Each impact takes a part of its velocity: as conservation
of angular momentum says (Housner 1963), or as a test has measured.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, simulate

block = Block(width=0.20, height=0.80, mass=50.0)
nothing = np.zeros(700)
measured = 0.95

figure, axes = plt.subplots(figsize=(5.4, 3.2))
for label, ratio in (
    (f"momentum, ratio {block.momentum_restitution():.3f}", None),
    (f"measured, ratio {measured:g}", measured),
):
    response = simulate(
        block, nothing, 0.01, theta0=0.5 * block.alpha, restitution=ratio
    )
    axes.plot(response.time, response.theta[:, 0] / block.alpha, label=label)
axes.set(xlabel="time [s]", ylabel="rotation over the critical angle", xlim=(0, 7))
axes.legend(fontsize=8)
