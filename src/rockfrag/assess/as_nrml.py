"""The counted fractions of motions as a fragility function that OpenQuake reads (NRML 0.5, discrete)."""

from rockfrag.assess.answer import Assessment
from rockfrag.fragility.identifiers import identifiers
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.fragility.nrml import discrete_function, model_text
from rockfrag.outcomes.limit_states import OVERTURNS


def as_nrml(found: Assessment) -> str:
    """Return the fragility of the object as it stands, a function of the ground's motion.

    OpenQuake joins levels by straight lines in the level, the assessment in its logarithm; at 80 levels the rates
    differ by less than 1 %.

    Parameters
    ----------
    found
        The assessment.
    """
    name, outcomes = found.request.name, found.outcomes
    function = discrete_function(
        identifiers([name], "_:-")[name],
        found.measure.name,
        outcomes.intensity_levels.levels,
        {OVERTURNS: outcomes.fractions()},
    )
    kind = found.request.objects.kind
    error = MODEL_ERRORS[kind]
    words = (
        f"{name}, {found.request.place.words}: fraction of {found.motions.words} that topple it. "
        f"What is not known of body, floor and model is not in it; of the model alone that is {error.beyond:g} "
        f"of ln level ({kind}: {error.words})."
    )
    return model_text(words, [OVERTURNS], [function])
