"""How far a building is driven, and whether its model can be believed there."""

from dataclasses import dataclass

import numpy as np

from rockfrag.building.hysteresis import shear_strengths
from rockfrag.building.model import ShearBuilding
from rockfrag.building.response import BuildingResponse


@dataclass(frozen=True)
class DriftOutcome:
    """State of the storey that is worst off.

    Attributes
    ----------
    storey
        Its number, from 1.
    drift
        Its largest drift over height [-].
    strength_fraction
        Largest shear over the shear strength [-]; only an elastic model can exceed 1.
    state
        ``uncracked``, ``cracked``, ``beyond strength`` (of an elastic model), ``beyond yield``,
        ``beyond the shear limit`` or ``beyond the rocking limit``.
    credible
        Whether the model may be used there: an elastic one up to the shear strength, a hysteretic
        one up to the rocking limit, beyond which walls fall.
    statement
        One sentence for a report.
    """

    storey: int
    drift: float
    strength_fraction: float
    state: str
    credible: bool
    statement: str


def judge_drift(building: ShearBuilding, response: BuildingResponse) -> DriftOutcome:
    """Judge a response by the masonry law of the building.

    Parameters
    ----------
    building
        Building whose law judges.
    response
        Its response.

    Returns
    -------
    The :class:`DriftOutcome`.
    """
    law = building.masonry
    if building.model != "elastic":
        return _judge_hysteretic(building, response)
    shear = np.asarray(building.stiffnesses) * np.asarray(building.heights) * response.peak_drift
    fractions = shear / shear_strengths(building)
    worst = int(np.argmax(fractions))
    fraction, drift = float(fractions[worst]), float(response.peak_drift[worst])
    begin = (
        f"{building.name}, elastic: storey {worst + 1} drifts {100 * drift:.2f} % of its height and carries "
        f"{fraction:.2f} of its shear strength"
    )
    if fraction <= law.cracking:
        state, end = "uncracked", "below cracking, so the elastic model holds"
    elif fraction <= 1:
        state, end = "cracked", "beyond cracking, so a cracked stiffness is the one to use"
    else:
        state = "beyond strength"
        end = "far beyond cracking, so these are floor motions of a house that cannot break"
    return DriftOutcome(worst + 1, drift, fraction, state, fraction <= 1, f"{begin}: {end}.")


def _judge_hysteretic(building: ShearBuilding, response: BuildingResponse) -> DriftOutcome:
    law = building.masonry
    worst = int(np.argmax(response.peak_drift))
    drift = float(response.peak_drift[worst])
    elastic = float(building.stiffnesses[worst] * building.heights[worst] * drift)
    fraction = min(1.0, elastic / float(shear_strengths(building)[worst]))
    begin = (
        f"{building.name}, hysteretic: storey {worst + 1} drifts {100 * drift:.2f} % of its height"
    )
    if fraction <= law.cracking:
        state, end = "uncracked", "below cracking"
    elif drift <= law.yield_drift:
        state, end = "cracked", f"cracked but below yield ({100 * law.yield_drift:.2f} %)"
    elif drift <= law.shear_drift:
        state = "beyond yield"
        end = f"between yield and the shear limit ({100 * law.shear_drift:.2f} %)"
    elif drift <= law.rocking_drift:
        state = "beyond the shear limit"
        end = f"between the shear and the rocking limit ({100 * law.rocking_drift:.2f} %)"
    else:
        state = "beyond the rocking limit"
        end = (
            f"beyond the rocking limit ({100 * law.rocking_drift:.2f} %), where walls fall and floor motions "
            "mean nothing"
        )
    credible = drift <= law.rocking_drift
    return DriftOutcome(worst + 1, drift, fraction, state, credible, f"{begin}, {end}.")
