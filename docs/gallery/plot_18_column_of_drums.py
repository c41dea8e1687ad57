"""
How does a column of drums move?
================================

A column of four drums and a capital under a near-fault pulse. Drums slide on each other and turn against each
other; what is left at the end is a column whose drums no longer stand above each other.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, Column, simulate
from rockfrag.motions import mavroeidis_papageorgiou

drums = [Block(0.90 - 0.04 * k, 0.75, 1200.0 - 100.0 * k) for k in range(4)]
column = Column([*drums, Block(1.00, 0.45, 900.0)])
motion = mavroeidis_papageorgiou(velocity=1.3, period=0.7, cycles=2.5)
response = simulate(column, motion, friction=0.5)
print(f"overturned: {response.overturned}, impacts: {response.impacts}")

figure, (turns, slips) = plt.subplots(2, 1, figsize=(5.4, 4.4), sharex=True)
names = ("lowest drum", "second", "third", "fourth", "capital")
for k, name in enumerate(names):
    turns.plot(response.time, np.degrees(response.theta[:, k]), lw=0.8, label=name)
    slips.plot(response.time, 1000 * response.slip[:, k], lw=0.8)
turns.set(ylabel="rotation [°]")
slips.set(ylabel="slip under it [mm]", xlabel="time [s]", xlim=(0, response.time[-1]))
figure.legend(fontsize=8, loc="outside lower center", ncols=5)
