"""
What does an isolator ask for?
==============================

A showcase on sliding pendulums moves slowly while the ground shakes fast, and does not rock. What it needs is way:
at a stop that comes too early the plate is halted with all its speed, and what stood still above it rocks.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, simulate
from rockfrag.motions import mavroeidis_papageorgiou
from rockfrag.system import SlidingPendulum, hold

showcase = Block(0.60, 1.90, 250.0)
motion = mavroeidis_papageorgiou(velocity=1.1, period=1.0, cycles=2.0)
responses = {
    name: simulate(
        hold(
            showcase.system(),
            support=SlidingPendulum(
                mass=40.0, radius=2.5, friction=0.06, stroke=stroke
            ),
        ),
        motion,
        friction=0.6,
    )
    for name, stroke in (("no stop", np.inf), ("stop at 8 cm", 0.08))
}
responses["on the ground"] = simulate(showcase, motion, friction=0.6)

# %%
# The plate below, and how far the showcase turns above it.

figure, (plates, turns) = plt.subplots(2, 1, figsize=(5.4, 4.4), sharex=True)
for line, (name, response) in zip(("-", "--", ":"), responses.items(), strict=True):
    if response.plate is not None:
        plates.plot(response.time, 100 * response.plate, line, label=name)
    turns.plot(response.time, np.degrees(response.theta[:, 0]), line, label=name)
plates.set(ylabel="plate [cm]")
turns.set(xlabel="time [s]", ylabel="rotation [°]", ylim=(-20, 20), xlim=(0, 3))
turns.legend(frameon=False, fontsize=8)
