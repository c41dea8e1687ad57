"""
Does a round vase fall earlier than a square one?
=================================================

A vase of one width and height with a round and with a square base, under both components of six synthetic
motions, simulated in space. The round one rolls on its rim and falls under less shaking.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, GroundMotion, overturns
from rockfrag.motions import evolutionary, scale_to_pga

noise = {"arias_m_s": 1.0, "d5_95_s": 5.0, "mid_s": 3.0, "slope_hz_s": -0.05}


def component(seed, peak):
    """One synthetic component with a peak [g], cut to a common length."""
    motion = evolutionary(seed, mid_hz=1.5, filter_damping=0.3, **noise)
    return scale_to_pga(motion.after("cut", motion.acceleration[:1000]), peak)


motions = [
    GroundMotion(component(seed, 1.0), y=component(100 + seed, 0.8))
    for seed in range(6)
]
bases = {
    "round": Block(0.16, 0.64, 12.0, round=True),
    "square": Block(0.16, 0.64, 12.0, depth=0.16),
}
pga = np.linspace(0.18, 0.38, 9)
fallen = overturns(bases, motions, scales=pga).overturned

figure, axes = plt.subplots(figsize=(5, 3.4))
for (name, outcomes), marker in zip(
    zip(bases, fallen, strict=True), ("o", "s"), strict=True
):
    count = outcomes.sum(axis=0)
    axes.plot(pga, count, marker + "-", ms=4, label=f"{name} base")
axes.set(
    xlabel="peak of the stronger component [g]",
    ylabel="motions that overturn, of 6",
    ylim=(-0.2, 6.2),
)
axes.legend(fontsize=8, loc="lower right")
