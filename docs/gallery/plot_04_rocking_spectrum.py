"""
What does a motion do to blocks of every size?
==============================================

A rocking spectrum shows the largest rotation of blocks of one slenderness over their size, as a response
spectrum shows oscillators over their period (Makris and Konstantinidis 2003). The size is 2π/p, with p =
√(3g/4R).
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import rocking_spectrum
from rockfrag.motions import mavroeidis_papageorgiou

motion = mavroeidis_papageorgiou(velocity=0.8, period=1.2, cycles=2.0)
periods = np.linspace(1.5, 8.0, 131)
angles = np.radians([10.0, 14.0, 18.0])
spectrum = rocking_spectrum(motion, periods, angles)

figure, axes = plt.subplots(figsize=(5, 3.4))
for angle, rotation in zip(angles, spectrum.rotation, strict=True):
    shown = np.where(np.isfinite(rotation), rotation, np.nan)
    axes.plot(periods, shown, label=f"α = {np.degrees(angle):.0f}°")
    fallen = periods[np.isinf(rotation)]
    axes.plot(
        fallen,
        np.full(fallen.size, 1.03 + 0.03 * list(angles).index(angle)),
        "|",
        markersize=5,
        color=axes.lines[-1].get_color(),
    )
axes.text(4.3, 1.03, "ticks: overturned", fontsize=8)
axes.set(
    xlabel="size of the block, 2π/p [s]",
    ylabel="largest rotation over α",
    ylim=(0, 1.2),
)
axes.legend(fontsize=8, loc="center right")
