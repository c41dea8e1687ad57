"""The counted fractions of motions as a fragility function that OpenQuake reads (NRML 0.5, discrete)."""

from rockfrag.assess.answer import Assessment
from rockfrag.fragility.curve_facts import identifiers
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.fragility.nrml import model_text
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states


def as_nrml(found: Assessment) -> str:
    """Return the fragility of the object as it stands, a function of the ground's motion.

    OpenQuake joins levels by straight lines in the level, the assessment in its logarithm; at 80 levels the rates
    differ by less than 1 %.
    """
    name, outcomes = found.request.name, found.outcomes
    reached = {*outcomes.others, OVERTURNS}
    states = [state.name for state in limit_states() if state.name in reached]
    function = {
        "id": identifiers([name], "_:-")[name],
        "imt": found.measure.imt,
        "levels": outcomes.intensity_levels.levels.tolist(),
        "chances": {state: outcomes.fractions(state=state).tolist() for state in states},
    }
    kind = found.request.objects.kind
    error = MODEL_ERRORS[kind]
    words = (
        f"{name}, {found.request.place.words}: fractions of {found.motions.words}. What is not known of body, "
        f"floor and model is not in them; of the model alone that is {error.beyond:g} of ln level ({kind}: "
        f"{error.words})."
    )
    return model_text(words, states, [function])
