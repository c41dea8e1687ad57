"""C55 to C58: how the figures were obtained, and what was assumed not to happen.

In: the protocol, masses [kg] and tests. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``,
``docs/shaketable.md``.
"""

import numpy as np
import pandas as pd

from rockfrag.base.units import GRAVITY
from rockfrag.effects.cluster_means import t_estimate
from rockfrag_thesis.hypotheses.evidence import PEDESTAL, Evidence
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import decided, same

MOTIONS = 12
UNCOUNTED = 10.0  # mass of a table for which the effect of miscounting is shown [kg]
SMOOTH, ROUGH = 0.25, 1.0
"""Least friction of dry wood on wood, and that of rubber on dry concrete [-]: what any dry joint of the
specimens offers, and what none does (ranges of engineering handbooks)."""


@hypothesis(55)
def c55(tests: Evidence) -> Result:
    """Motions per specimen, and how close to overturning the figure is."""
    clean = tests.clean
    counts = clean.groupby(["object", "pedestal"])["motion"].nunique()
    exact = clean[clean["censored"] == "none"]
    close = "no test has both an amplitude survived and one that overturned"
    if len(exact):
        width = 100 * float((1 - exact["lower_g"] / exact["upper_g"]).median())
        close = f"the largest amplitude survived lies {width:.1f} % (median) below the one that overturned"
    as_stated = bool((counts == MOTIONS).all())
    return Result(
        Finding.FOR if as_stated else Finding.OPEN,
        f"motions: {counts.min()} to {counts.max()}; configurations: {len(counts)}; {close}",
        float(counts.min()),
        float(counts.min()),
        float(counts.max()),
        unit="motions",
        remark="'just before overturning' (3.4) and 'leads to overturning' (abstract) differ by "
        "that width"
        + ("" if as_stated else "; this table is not the thesis's twelve motions"),
    )


@hypothesis(56)
def c56(tests: Evidence) -> Result:
    """Force over mass, where both were recorded; else how much miscounted mass would matter."""
    clean = tests.clean
    bodies = tests.specimens
    bias = [
        bodies[PEDESTAL].mass / (UNCOUNTED + body.mass)
        for name, body in bodies.items()
        if name != PEDESTAL and PEDESTAL in bodies
    ]
    if not bias:
        raise Undecidable("there is no pedestal, or nothing else, among the specimens")
    meaning = (
        f"on a table of {UNCOUNTED:.0f} kg a pedestal that is moved but not counted changes P/NP "
        f"by {100 * min(bias):.0f} % to {100 * max(bias):.0f} %"
    )
    if not {"force_n", "moved_mass_kg"} <= set(clean.columns):
        return Result(
            Finding.OPEN,
            meaning,
            basis="computed",
            remark="force and moved mass are not among the data (columns force_n and moved_mass_kg), so "
            "the figure is what a miscount would do, not a test",
        )
    exact = clean[(clean["censored"] == "none") & clean["force_n"].notna()]
    step = float((exact["upper_g"] / exact["lower_g"]).median()) - 1
    if not step > 0:
        raise Undecidable(
            "the steps of the protocol are not known (lower_g and upper_g agree)"
        )
    computed = exact["force_n"] / exact["moved_mass_kg"] / GRAVITY
    errors = exact.assign(error=np.log(computed / exact["amplitude_g"]))
    error = t_estimate(errors.groupby("earthquake")["error"].mean())
    return same(
        error,
        f"force over mass over reported {error.text()}; one step is {100 * step:.1f} %",
        bound=step,
        more=meaning,
    )


@hypothesis(57)
def c57(tests: Evidence) -> Result:
    """Whether the model may leave sliding and jumping out; it says nothing about the experiment."""
    clean = tests.clean
    if not {"friction_demand", "least_normal_force_n"} <= set(clean.columns):
        raise Undecidable(
            "the tests carry no friction_demand and least_normal_force_n (simulations can)"
        )
    need = clean[
        clean["friction_demand"].notna() & clean["least_normal_force_n"].notna()
    ]
    if need.empty:
        raise Undecidable("friction_demand and least_normal_force_n are empty")
    demand = need["friction_demand"]
    opened = int((need["least_normal_force_n"] <= 0).sum())
    refuted = bool(opened or demand.max() > ROUGH)
    return Result(
        decided(not refuted and demand.max() < SMOOTH, refuted),
        f"friction needed: {_needed(demand)}; tests that need more than "
        f"{SMOOTH}: {int((demand > SMOOTH).sum())} of {len(need)}; tests in which a contact opens: {opened}",
        float(demand.max()),
        float(demand.min()),
        float(demand.max()),
        basis="simulated",
        remark="about the model's premise, not about the experiment, whose bars lay in fixtures that "
        "hold them sideways; without the impulses of impacts",
    )


def _needed(demand: pd.Series) -> str:
    """Median and largest of the friction that tests need, and in how many no friction is enough [-]."""
    known = demand[np.isfinite(demand)]
    parts = []
    if len(known):
        parts.append(f"median {known.median():.2f}, largest {known.max():.2f}")
    if beyond := len(demand) - len(known):
        parts.append(f"none is enough in {beyond} of {len(demand)}")
    return ", ".join(parts)


@hypothesis(58)
def c58(tests: Evidence) -> Result:
    """Overturning amplitude with sliding allowed against without, which no study has side by side."""
    raise Undecidable(
        "there are no overturning amplitudes with and without sliding to compare"
    )
