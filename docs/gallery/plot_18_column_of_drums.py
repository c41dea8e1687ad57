"""
How does a column of drums move?
================================

A column of three drums and a capital under a near-fault pulse. Drums slide on each other and turn against each
other; what is left at the end is a column whose drums no longer stand above each other.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, Column, simulate
from rockfrag.motions import mavroeidis_papageorgiou

drums = [
    Block(0.90, 1.20, 1900.0),
    Block(0.86, 1.20, 1750.0),
    Block(0.82, 1.20, 1600.0),
]
column = Column([*drums, Block(1.00, 0.45, 900.0)])
motion = mavroeidis_papageorgiou(velocity=1.1, period=1.2, cycles=2.0)
response = simulate(column, motion, friction=0.6)
print(f"overturned: {response.overturned}, impacts: {response.impacts}")

figure, (turns, slips) = plt.subplots(2, 1, figsize=(5.4, 4.4), sharex=True)
names = ("lowest drum", "second drum", "third drum", "capital")
for k, name in enumerate(names):
    turns.plot(response.time, np.degrees(response.theta[:, k]), lw=0.8, label=name)
    slips.plot(response.time, 1000 * response.slip[:, k], lw=0.8)
turns.set(ylabel="rotation [°]")
slips.set(ylabel="slip under it [mm]", xlabel="time [s]", xlim=(0, response.time[-1]))
_ = figure.legend(fontsize=8, loc="outside lower center", ncols=4)
