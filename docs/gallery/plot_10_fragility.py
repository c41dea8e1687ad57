"""
How probable is overturning at a given intensity?
=================================================

A fragility curve from sixty synthetic motions, each at eight levels of peak velocity. The interval answers
for other motions of the kind: motions are left out one by one (jackknife).
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import Block, fit_lognormal, overturns
from rockfrag.fragility import Observations, interval_over_motions
from rockfrag.motions import evolutionary, scale_to_pgv

statue = Block(width=0.35, height=1.20, mass=180.0)
noise = {
    "arias_m_s": 1.0,
    "d5_95_s": 8.0,
    "mid_s": 4.0,
    "slope_hz_s": -0.05,
    "filter_damping": 0.3,
}
draw = np.random.default_rng(1)
motions = [
    scale_to_pgv(evolutionary(seed, mid_hz=draw.uniform(1.0, 4.0), **noise), 100.0)
    for seed in range(60)
]
pgv = np.geomspace(20, 160, 8)  # cm/s
fallen = overturns(statue, motions, scales=pgv / 100).overturned[0]

# %%
# One row per motion and level; rows of one motion are not independent.

names = np.repeat([f"motion {number}" for number in range(60)], pgv.size).astype(object)
outcomes = Observations(
    im=np.tile(pgv, 60),
    overturned=fallen.ravel().astype(float),
    trials=np.ones(fallen.size),
    motion=names,
    earthquake=names,
    name="PGV",
    unit="cm/s",
)
fit = fit_lognormal(outcomes)
limits = interval_over_motions(outcomes, over="motion", level=0.9)
print(
    f"median {fit.theta:.0f} cm/s [{limits.theta[0]:.0f}, {limits.theta[1]:.0f}], dispersion {fit.beta:.2f}"
)

figure, axes = plt.subplots(figsize=(5, 3.4))
at = np.geomspace(10, 250, 200)
axes.fill_between(
    at, *limits.band(at), color="#56B4E9", alpha=0.35, lw=0, label="90 % band"
)
axes.plot(at, fit.probability(at), color="#0072B2", label="lognormal fit")
axes.plot(pgv, fallen.mean(axis=0), "ko", markersize=4, label="fraction of 60 motions")
axes.set(
    xlabel="peak ground velocity [cm/s]",
    ylabel="probability of overturning",
    xscale="log",
)
axes.set_xticks([10, 20, 50, 100, 200], ["10", "20", "50", "100", "200"])
axes.minorticks_off()
axes.legend(fontsize=8)
