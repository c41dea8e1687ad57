"""
Is a larger statue safer than a smaller one of the same shape?
==============================================================

Two blocks of one slenderness start to rock at the same acceleration, but the larger one needs more to fall
over (Housner 1963).
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, find_thresholds
from rockfrag.motions import one_sine

heights = np.array([0.3, 0.5, 0.8, 1.2, 1.8, 2.5, 3.5])
blocks = [Block(width=h / 4, height=h, mass=2500 * h**3 / 16) for h in heights]
periods = (0.5, 1.0, 2.0)
motions = [one_sine(amplitude=1.0, period=period) for period in periods]
found = find_thresholds(
    blocks, motions, highest=45.0, tolerance=0.02, narrowest_resurrection=0.25
).table

# %%
# The motions have a peak of 1 m/s², so a scale is a peak acceleration.

figure, axes = plt.subplots(figsize=(5, 3.4))
for number, period in enumerate(periods):
    rows = found[found["motion"] == number]
    axes.plot(
        heights,
        rows["first_overturning_pga_g"],
        "o-",
        label=f"one sine of {period:g} s",
    )
axes.axhline(0.25, color="0.4", linestyle="--", label="starts to rock, b/h = 0.25 g")
axes.set(
    xlabel="height of the block [m]", ylabel="least acceleration that overturns [g]"
)
axes.legend(fontsize=8)
