"""
Should casters be locked?
=========================

A cart on free casters rolls and never rocks by itself; locked, it rocks. What free casters cost is way, and a wall
at the end of it.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, simulate
from rockfrag.motions import mavroeidis_papageorgiou
from rockfrag.system import Wall, hold
from rockfrag.system.mounts import on_casters

cart = Block(0.50, 1.40, 80.0)
wall = Wall(distance=0.25 + 0.10)  # from the middle of its base
motion = mavroeidis_papageorgiou(velocity=1.2, period=1.0, cycles=2.0)
responses = {
    "locked": simulate(hold(on_casters(cart.system(), "locked"), wall), motion),
    "free": simulate(on_casters(cart.system(), "free"), motion),
    "free, beside a wall": simulate(
        hold(on_casters(cart.system(), "free"), wall), motion
    ),
}

# %%
# How far it rolls, and how far it turns.

figure, (ways, turns) = plt.subplots(
    2, 1, figsize=(5.4, 4.4), sharex=True, layout="constrained"
)
for line, (name, response) in zip(("-", "--", ":"), responses.items(), strict=True):
    ways.plot(response.time, 100 * response.slip[:, 0], line, label=name)
    turns.plot(response.time, np.degrees(response.theta[:, 0]), line)
ways.axhline(10, color="0.5", lw=0.8)
ways.set(ylabel="way [cm]")
turns.set(xlabel="time [s]", ylabel="rotation [°]", ylim=(-20, 20), xlim=(0, 4))
figure.legend(fontsize=8, loc="outside lower center", ncols=3)
