"""C55 to C58: how the figures were obtained, and what was assumed not to happen."""

import math

import numpy as np

from rockfrag.pedestal.cluster_means import ROUNDING, t_estimate
from rockfrag.pedestal.mass_bias import mass_errors
from rockfrag.thesis.specimens import THESIS_BODIES
from rockfrag.thesis.statements.evidence import Evidence, Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.results import ratio_result
from rockfrag.thesis.statements.verdicts import direction
from rockfrag.units import STANDARD_GRAVITY

MOTIONS = 12
UNCOUNTED = 10.0
"""Mass of a table for which the effect of miscounting is shown [kg]."""
SMOOTH, ROUGH = 0.3, 1.0
"""Friction that wood surely offers, and that no dry interface of the specimens does [-]."""


def c55(evidence: Evidence) -> ClaimResult:
    """Motions per specimen, and how close to overturning the figure is."""
    clean = evidence.clean
    counts = clean.groupby(["object", "pedestal"])["motion"].nunique()
    exact = clean[clean["censored"] == "none"]
    width = math.nan
    if len(exact):
        width = 100 * float((1 - exact["lower_g"] / exact["upper_g"]).median())
    as_told = bool((counts == MOTIONS).all())
    return ClaimResult(
        55,
        "number of motions per tower and side; width of the step in which it overturned",
        f"{counts.min()} to {counts.max()} motions for {len(counts)} configurations; the largest "
        f"amplitude survived lies {width:.1f} % (median) below the one that overturned",
        "supported" if as_told else "undecided",
        evidence.basis,
        float(counts.min()),
        float(counts.min()),
        float(counts.max()),
        unit="motions",
        remark="'just before overturning' (3.4) and 'leads to overturning' (abstract) differ by "
        "that width" + ("" if as_told else "; this table is not the thesis's twelve motions"),
    )


def c56(evidence: Evidence) -> ClaimResult:
    """Force over mass, where both were recorded; else how much miscounted mass would matter."""
    masses = {name: body.mass for name, body in (evidence.bodies or THESIS_BODIES).items()}
    table = mass_errors(masses, masses.pop("P"), [UNCOUNTED])
    bias = table.loc[table["error"] == "pedestal not counted", "ratio_bias"]
    meaning = (
        f"on a table of {UNCOUNTED:.0f} kg a pedestal that is moved but not counted changes P/NP "
        f"by {100 * (bias.min() - 1):.0f} to {100 * (bias.max() - 1):.0f} %"
    )
    clean = evidence.clean
    if not {"force_n", "moved_mass_kg"} <= set(clean.columns):
        return ClaimResult(
            56,
            "reported acceleration against force over moved mass; needs force_n and moved_mass_kg",
            meaning,
            "undecided",
            evidence.basis,
            float(bias.mean()),
            float(bias.min()),
            float(bias.max()),
            remark="force and moved mass are not among the data, so the figure is the model's "
            "effect of the miscount, not a test",
        )
    exact = clean[(clean["censored"] == "none") & clean["force_n"].notna()]
    computed = exact["force_n"] / exact["moved_mass_kg"] / STANDARD_GRAVITY
    errors = exact.assign(error=np.log(computed / exact["amplitude_g"]))
    # figures of equal tests agree to rounding at best
    error = t_estimate(errors.groupby("event")["error"].mean(), resolution=ROUNDING)
    verdict = "supported" if abs(error.ratio - 1) < 0.02 and error.p >= 0.05 else "undecided"
    if error.p < 0.05 and abs(error.ratio - 1) > 0.02:
        verdict = "contradicted"
    return ratio_result(
        56,
        "ln of force over moved mass against the reported acceleration, t over events; 2 % allowed",
        f"force over mass over reported {error.text()}",
        verdict,
        evidence.basis,
        error,
        more=meaning,
    )


def c57(evidence: Evidence) -> ClaimResult:
    """Friction that pure rocking needs, and whether the blocks stay pressed together."""
    clean = evidence.clean
    if not {"friction_demand", "least_normal_force_n"} <= set(clean.columns):
        raise Undecidable(
            "the tests carry no friction_demand and least_normal_force_n (simulations can)"
        )
    known = clean[clean["friction_demand"].notna() & clean["least_normal_force_n"].notna()]
    if known.empty:
        raise Undecidable("friction_demand and least_normal_force_n are empty")
    demand = float(known["friction_demand"].max())
    normal = float(known["least_normal_force_n"].min())
    verdict = "undecided"
    if normal <= 0 or demand > ROUGH:
        verdict = "contradicted"
    elif demand < SMOOTH:
        verdict = "supported"
    return ClaimResult(
        57,
        f"largest friction demand and least normal force of all tests; supported below {SMOOTH}, "
        f"contradicted above {ROUGH} or where the contact opens",
        f"friction demand median {known['friction_demand'].median():.2f}, largest {demand:.2f}; "
        f"least normal force {normal:.1f} N; {int((known['friction_demand'] > SMOOTH).sum())} of "
        f"{len(known)} tests need more than {SMOOTH}",
        verdict,
        evidence.basis,
        demand,
        float(known["friction_demand"].min()),
        demand,
        remark="without impulses at impacts; the specimens sat in fixtures that hold them sideways",
    )


def c58(evidence: Evidence) -> ClaimResult:
    """Overturning amplitude with sliding allowed against without."""
    if evidence.sliding is None:
        raise Undecidable(
            "the model excludes sliding as the experiment did, so there is nothing to compare with; "
            "it takes a table of overturning amplitudes with and without sliding"
        )
    sliding = evidence.sliding
    gain = sliding.assign(gain=np.log(sliding["sliding_g"] / sliding["rocking_g"]))
    effect = t_estimate(gain.groupby("event")["gain"].mean())
    verdict = direction(effect, +1)
    return ratio_result(
        58,
        "ln of overturning amplitude with sliding over without, t over events",
        f"ratio {effect.text()}",
        verdict,
        evidence.basis,
        effect,
    )
