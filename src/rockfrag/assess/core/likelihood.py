"""Words of a published scale for probabilities: the likelihoods of the IPCC (Mastrandrea et al. 2010).

In: a probability [-]. Out: the word, as the id of a text. Docs: ``docs/assess.md``, "How likely, and what to do".
"""

from enum import Enum

from rockfrag.assess.core.choices import likelihood


class Likelihood(Enum):
    """A step of the scale, in its order; its value is the key of its words."""

    EXCEPTIONALLY_UNLIKELY = "exceptionally_unlikely"
    VERY_UNLIKELY = "very_unlikely"
    UNLIKELY = "unlikely"
    ABOUT_AS_LIKELY_AS_NOT = "about_as_likely_as_not"
    LIKELY = "likely"
    VERY_LIKELY = "very_likely"
    VIRTUALLY_CERTAIN = "virtually_certain"


def likelihood_of(probability: float) -> Likelihood:
    """Step of a probability [-]: < 1, < 10, < 33 %, then up to 66, 90, 99 %, and above."""
    return tuple(Likelihood)[likelihood(probability)]
