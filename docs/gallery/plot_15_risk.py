"""
How probable is it in fifty years?
==================================

A fragility curve over a hazard curve gives a yearly rate. The bars show which levels of shaking contribute
to it: seldom the strongest.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import norm

from rockfrag import fit_lognormal
from rockfrag.assess import HazardCurve
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.risk import probability_in, toppling_rate
from rockfrag.fragility import Observations

# %%
# Outcomes of 300 tests drawn from a curve with a median of 0.5 g, and a hazard curve made up for this page.

draw = np.random.default_rng(2)
pga = draw.uniform(0.1, 1.2, 300)
fell = draw.random(300) < norm.cdf(np.log(pga / 0.5) / 0.4)
names = np.array([f"test {number}" for number in range(300)], dtype=object)
fit = fit_lognormal(
    Observations(pga, fell.astype(float), np.ones(300), names, names, "PGA", "g")
)
levels = np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.6])
rates = np.array([2e-2, 7e-3, 1.8e-3, 3.2e-4, 3.5e-5, 2e-6])
shaking = np.geomspace(0.05, 1.6, 100)
rate = toppling_rate(
    shaking, fit.probability(shaking), HazardCurve(PGA, levels, rates, "made up")
)
print(f"{rate:.2e} a year, {100 * probability_in(rate, 50.0):.1f} % in 50 years")

edges = np.geomspace(0.05, 1.6, 26)
exceeded = np.exp(np.interp(np.log(edges), np.log(levels), np.log(rates)))
middle = np.sqrt(edges[1:] * edges[:-1])
part = -np.diff(exceeded) * fit.probability(middle)

figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3))
left.loglog(levels, rates, "o-", color="#0072B2")
left.set(xlabel="peak ground acceleration [g]", ylabel="exceeded, times a year")
right.bar(
    middle,
    100 * part / part.sum(),
    width=np.diff(edges),
    color="#E69F00",
    edgecolor="white",
)
right.set(xlabel="peak ground acceleration [g]", ylabel="part of the yearly rate [%]")
