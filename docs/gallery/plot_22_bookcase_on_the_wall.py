"""
What does a bracket at the wall buy?
====================================

A bookcase that stands before a wall falls away from it. A bracket holds it both ways, as long as it does not
break. What it bears decides: where it breaks the bookcase falls at once.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, overturns
from rockfrag.motions import evolutionary
from rockfrag.system import Tie, Wall, hold

shape = {"d5_95_s": 6.0, "mid_s": 3.0, "mid_hz": 1.5, "slope_hz_s": -0.05}
motions = [
    evolutionary(seed, arias_m_s=1.0, filter_damping=0.3, **shape) for seed in range(20)
]
bookcase = Block(0.30, 1.80, 90.0)
wall = Wall(distance=0.15 + 0.02)  # from the middle of its base


def bracket(strength):
    """From the top to the wall, stiff, without slack."""
    return Tie(
        *((0.0, 0.0, 1.75), (0.27, 0.0, 1.75)),
        *(2e5, 500.0),
        strength=strength,
        bracket=True,
    )


held = {
    "free": bookcase.system(),
    "2 cm before a wall": hold(bookcase.system(), wall),
    "bracket that bears 150 N": hold(bookcase.system(), bracket(150.0)),
    "bracket that bears 400 N": hold(bookcase.system(), bracket(400.0)),
}

# %%
# Twenty made motions, each scaled to the same peak accelerations.

levels = np.linspace(0.1, 1.2, 12)  # g
scales = levels * 9.81 / np.array([[motion.pga] for motion in motions])
found = overturns(list(held.values()), motions, scales=scales, friction=0.6)
fractions = found.overturned.mean(axis=1)

figure, axes = plt.subplots(figsize=(5.4, 3.6), layout="constrained")
for line, (name, fraction) in zip(
    ("-", "-.", ":", "--"), zip(held, fractions, strict=True), strict=True
):
    axes.plot(levels, fraction, line, label=name)
axes.set(xlabel="peak ground acceleration [g]", ylabel="fraction that topples [-]")
figure.legend(fontsize=8, loc="outside lower center", ncols=2)
