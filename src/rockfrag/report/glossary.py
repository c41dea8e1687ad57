"""Terms and abbreviations that a page uses, each with its meaning for a reader who is new to the field."""

import re
from collections.abc import Mapping

TERMS: Mapping[str, str] = {
    "NP": "no pedestal: the object alone on its floor; P is the object on its pedestal.",
    "P/NP": "overturning amplitude with the pedestal divided by that without it, of the same object under the "
    "same motion. Above 1 the object overturns later with its pedestal.",
    "NP/P": "the inverse: overturning amplitude without the pedestal divided by that with it.",
    "amplitude": "peak acceleration of the motion that shakes the object, in units of g.",
    "overturning amplitude": "largest peak acceleration survived before the first overturning, as the motion "
    "is raised in steps.",
    "PGA, PGV, PGD": "peak ground acceleration, velocity and displacement.",
    "PFA, PFV": "peak floor acceleration and velocity: peaks of the motion of a floor.",
    "AvgSA": "average spectral acceleration: geometric mean of SA over a range of periods.",
    "SA": "spectral acceleration: peak acceleration of a damped oscillator of the stated period.",
    "Arias intensity": "integral of the squared acceleration, a measure of the energy of a motion.",
    "Housner intensity": "integral of the velocity spectrum over periods.",
    "intensity measure": "a number that says how strong a motion is, such as its peak acceleration.",
    "fragility": "probability of overturning as a function of an intensity measure.",
    "θ": "median of a fragility curve: the intensity at which the probability of overturning is one half.",
    "β": "dispersion of a fragility curve: standard deviation of the logarithm of the intensity that overturns.",
    "lognormal": "curve of the form Φ(ln(IM/θ)/β), with Φ the normal distribution and IM the intensity measure.",
    "nonparametric": "without an assumed shape: the monotone curve that is closest to the simulated outcomes.",
    "bound only": "the test says only that the amplitude is above (or below) a value, because nothing "
    "overturned (or everything did).",
    "open": "of a limit: the data set none on this side.",
    "undecided": "of a statement: the data neither confirm nor refute it.",
    "structural resurrection": "stronger motions are survived although a weaker one overturned the object.",
    "robust": "of an outcome: the same for the motion scaled by anything within ±10 %.",
    "p value": "probability of data at least this far off if there were no effect; small values speak "
    "against that.",
    "Holm": "adjustment of p values that limits the chance of any false finding in a family of tests (Holm 1979).",
    "Benjamini–Hochberg": "adjustment of p values that limits the expected fraction of false findings among all "
    "findings (Benjamini and Hochberg 1995).",
    "Bonferroni": "adjustment of p values: each is multiplied by the number of tests.",
    "95 % interval": "range of values with which the data are compatible; 95 % of such ranges contain the true "
    "value.",
    "AUC": "probability that an overturned test had the larger intensity than a survived one; 0.5 is guessing.",
    "AIC": "Akaike’s information criterion; of two models the one with the smaller value predicts better.",
    "restitution": "rotational speed just after an impact divided by that just before it.",
    "critical angle": "rotation at which a body at rest would be in balance on its edge.",
    "step protocol": "the motion is raised in steps until the object overturns; the amplitude is read one step "
    "before.",
    "near-critical": "of a test: plausible ways to set up the object disagree about its outcome.",
    "perturbed parameter": "property of the ideal model that is changed, one at a time, to see what it does.",
}
"""Meaning by term; a term such as ``PGA, PGV`` is used where one of its parts is."""


def terms_used(text: str) -> dict[str, str]:
    """Return the terms that the visible text of a page uses with their meanings, in alphabetical order."""
    used = [name for name in TERMS if any(_occurs(part, text) for part in name.split(", "))]
    return {name: TERMS[name] for name in sorted(used, key=str.lower)}


def _occurs(term: str, text: str) -> bool:
    """Whether a text has a term as a word of its own, abbreviations as they are written."""
    flags = re.NOFLAG if term.isupper() or len(term) < 3 else re.IGNORECASE
    return re.search(rf"(?<![\w/&]){re.escape(term)}(?![\w/&])", text, flags) is not None
