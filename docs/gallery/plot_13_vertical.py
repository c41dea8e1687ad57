"""
Does vertical shaking matter?
=============================

The least horizontal amplitude that overturns a statue under thirty synthetic motions, without and with a
vertical component of six tenths. Single cases change either way; the median hardly does.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, find_thresholds
from rockfrag.motions import evolutionary, scale_to_pga

statue = Block(width=0.35, height=1.20, mass=180.0)
noise = {
    "arias_m_s": 1.0,
    "d5_95_s": 8.0,
    "mid_s": 4.0,
    "slope_hz_s": -0.05,
    "filter_damping": 0.3,
}
flat = [
    scale_to_pga(evolutionary(seed, mid_hz=1.5, **noise), 1.0) for seed in range(30)
]
up = [
    scale_to_pga(evolutionary(100 + seed, mid_hz=5.0, **noise), 0.6)
    for seed in range(30)
]
count = min(motion.acceleration.size for motion in (*flat, *up))
horizontal = [motion.acceleration[:count] for motion in flat]
vertical = [motion.acceleration[:count] for motion in up]


def first_overturning(**options):
    """Least scale of each motion that overturns, NaN if none does."""
    found = find_thresholds(
        statue,
        horizontal,
        flat[0].dt,
        highest=0.8,
        tolerance=0.001,
        narrowest_resurrection=0.01,
        **options,
    )
    return found.table["first_overturning"].to_numpy()


without, with_it = first_overturning(), first_overturning(vertical=vertical)
figure, axes = plt.subplots(figsize=(4, 3.8))
axes.plot([0.3, 0.6], [0.3, 0.6], color="0.5", linewidth=1)
axes.plot(without, with_it, "o", markersize=4)
axes.set(
    xlabel="horizontal alone: PGA that overturns [g]",
    ylabel="with the vertical component [g]",
    aspect="equal",
    xlim=(0.3, 0.6),
    ylim=(0.3, 0.6),
)
print(f"median ratio {np.nanmedian(with_it / without):.3f}")
