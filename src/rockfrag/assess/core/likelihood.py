"""Words of a published scale for probabilities: the likelihoods of the IPCC (Mastrandrea et al. 2010).

In: a probability [-]. Out: the word, as the id of a text. Docs: ``docs/assess.md``, "How likely, and what to do".
"""

from enum import Enum


class Likelihood(Enum):
    """A step of the scale; its value is the key of its words."""

    EXCEPTIONALLY_UNLIKELY = "exceptionally_unlikely"
    VERY_UNLIKELY = "very_unlikely"
    UNLIKELY = "unlikely"
    ABOUT_AS_LIKELY_AS_NOT = "about_as_likely_as_not"
    LIKELY = "likely"
    VERY_LIKELY = "very_likely"
    VIRTUALLY_CERTAIN = "virtually_certain"


BELOW = (
    (0.01, Likelihood.EXCEPTIONALLY_UNLIKELY),
    (0.10, Likelihood.VERY_UNLIKELY),
    (0.33, Likelihood.UNLIKELY),
)
UP_TO = (
    (0.66, Likelihood.ABOUT_AS_LIKELY_AS_NOT),
    (0.90, Likelihood.LIKELY),
    (0.99, Likelihood.VERY_LIKELY),
)


def likelihood_of(probability: float) -> Likelihood:
    """Step of a probability [-]: < 1, < 10, < 33 %, then up to 66, 90, 99 %, and above."""
    for limit, step in BELOW:
        if probability < limit:
            return step
    for limit, step in UP_TO:
        if probability <= limit:
            return step
    return Likelihood.VIRTUALLY_CERTAIN
