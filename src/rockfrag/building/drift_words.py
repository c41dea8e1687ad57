"""Words on how far a storey of a building is driven, and how far its model may then be believed.

In: the building, the storey that is worst off, its drift over height [-] and its :class:`StoreyState`. Out: one
sentence, which travels in the metadata of floor motions. Theory: ``docs/building.md``, "How far a model may be
believed".
"""

from enum import IntEnum

from rockfrag.building.model import ShearBuilding


class StoreyState(IntEnum):
    """States of a storey, the milder first; an elastic model knows the first two and ``BEYOND_STRENGTH``."""

    UNCRACKED = 0
    CRACKED = 1
    BEYOND_YIELD = 2
    BEYOND_SHEAR_LIMIT = 3
    BEYOND_ROCKING_LIMIT = 4
    BEYOND_STRENGTH = 5

    @property
    def words(self) -> str:
        """State as tables name it."""
        return _WORDS[self]


_WORDS = {
    StoreyState.UNCRACKED: "uncracked",
    StoreyState.CRACKED: "cracked",
    StoreyState.BEYOND_YIELD: "beyond yield",
    StoreyState.BEYOND_SHEAR_LIMIT: "beyond the shear limit",
    StoreyState.BEYOND_ROCKING_LIMIT: "beyond the rocking limit",
    StoreyState.BEYOND_STRENGTH: "beyond strength",
}

_ELASTIC = {
    StoreyState.UNCRACKED: "below cracking, so the elastic model holds.",
    StoreyState.CRACKED: "beyond cracking, so a cracked stiffness is the one to use.",
    StoreyState.BEYOND_STRENGTH: "far beyond cracking, so these are floor motions of a house that cannot break.",
}


def elastic_statement(
    building: ShearBuilding,
    storey: int,
    drift: float,
    fraction: float,
    state: StoreyState,
) -> str:
    """Sentence on an elastic model.

    Parameters
    ----------
    building, storey : the building, and the number of the storey that is worst off, from 1
    drift, fraction : its drift over height, and its shear over its strength [-]
    state : of that storey

    Returns
    -------
    The sentence.
    """
    return (
        f"{building.name}, {building.model}: storey {storey} drifts {100 * drift:.2f} % of its height and carries "
        f"{fraction:.2f} of its shear strength: {_ELASTIC[state]}"
    )


def hysteretic_statement(
    building: ShearBuilding, storey: int, drift: float, state: StoreyState
) -> str:
    """Sentence on a hysteretic model, with the limits of its masonry law.

    Parameters
    ----------
    building, storey : the building, and the number of the storey that is worst off, from 1
    drift : its drift over height [-]
    state : of that storey

    Returns
    -------
    The sentence.
    """
    law = building.masonry
    yielding = f"{100 * law.yield_drift:.2f} %"
    shear = f"{100 * law.shear_drift:.2f} %"
    rocking = f"{100 * law.rocking_drift:.2f} %"
    outcomes = {
        StoreyState.UNCRACKED: "below cracking.",
        StoreyState.CRACKED: f"cracked but below yield ({yielding}).",
        StoreyState.BEYOND_YIELD: f"between yield and the shear limit ({shear}).",
        StoreyState.BEYOND_SHEAR_LIMIT: f"between the shear and the rocking limit ({rocking}).",
        StoreyState.BEYOND_ROCKING_LIMIT: (
            f"beyond the rocking limit ({rocking}), where walls fall and floor motions mean nothing."
        ),
    }
    return (
        f"{building.name}, {building.model}: storey {storey} drifts {100 * drift:.2f} % of its height, "
        f"{outcomes[state]}"
    )
