"""
Where does the energy go?
=========================

The ground does work on the statue, which it keeps as kinetic and potential energy or loses in impacts. What
remains is rounding: the ledger closes.
"""

import matplotlib.pyplot as plt

from rockfrag import Block, Stack, simulate
from rockfrag.motions import mavroeidis_papageorgiou

stack = Stack(
    Block(width=0.50, height=0.90, mass=400.0),
    Block(width=0.35, height=1.20, mass=180.0),
)
response = simulate(
    stack, mavroeidis_papageorgiou(velocity=0.6, period=1.0, cycles=2.0)
)
energy = response.energy
shown = energy["time"] <= 5.0
energy = energy[shown]

figure, axes = plt.subplots(figsize=(5.4, 3.4))
axes.stackplot(
    energy["time"],
    energy["kinetic"],
    energy["potential"] - energy["potential"].iloc[0],
    energy["lost_contact_1"],
    energy["lost_contact_2"],
    labels=("kinetic", "potential", "lost at the ground", "lost under the statue"),
    colors=("#56B4E9", "#0072B2", "#E69F00", "#D55E00"),
)
axes.plot(
    energy["time"],
    energy["input"],
    color="black",
    linewidth=1,
    label="work of the ground",
)
axes.set(xlabel="time [s]", ylabel="energy [J]", xlim=(0, 5))
figure.legend(fontsize=8, loc="outside lower center", ncols=3)
print(f"largest residual: {energy['residual'].abs().max():.1e} J")
