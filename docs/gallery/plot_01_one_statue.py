"""
How does one statue rock?
=========================

A statue of 0.35 m × 1.2 m under a near-fault velocity pulse. It rocks from corner to corner, loses energy
at each impact, and comes to rest.
"""

from rockfrag import Block, simulate
from rockfrag.motions import mavroeidis_papageorgiou

# %%
# The pulse has a velocity of 0.6 m/s and a period of 1 s (Mavroeidis and Papageorgiou 2003).

statue = Block(width=0.35, height=1.20, mass=180.0)
motion = mavroeidis_papageorgiou(velocity=0.6, period=1.0, cycles=2.0)
response = simulate(statue, motion)
figure = response.plot("A statue under a near-fault pulse")

print(f"overturned: {response.overturned}, impacts: {response.impacts}")
