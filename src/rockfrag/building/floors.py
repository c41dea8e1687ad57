"""Motions of the floors of a building, how far it is driven, and whether its model can be believed there."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.building.inelastic import respond_hysteretically, shear_strengths
from rockfrag.building.model import ShearBuilding
from rockfrag.building.response import BuildingResponse, respond_elastically
from rockfrag.records.motion import Motion


def floor_motions(
    building: ShearBuilding, motion: Motion, floors: Sequence[str] | None = None
) -> list[Motion]:
    """Absolute accelerations of labelled floors under a ground motion.

    Parameters
    ----------
    building
        Building; its model says whether it responds elastically or hysteretically.
    motion
        Ground acceleration, of n samples.
    floors
        Labels that the building gives to its floors; all of them if not given.

    Returns
    -------
    One motion a floor, of n samples, named ``<motion>_<floor>`` and with ``floor``, ``level`` and
    ``ground_motion`` in its metadata. Level 0 is the ground motion itself.

    Raises
    ------
    InputError
        If a floor is not defined.
    """
    labels = list(building.floors) if floors is None else list(floors)
    for label in labels:
        building.level(label)
    return response_motions(building, motion, respond(building, motion), labels)


def vertical_motions(building: ShearBuilding, vertical: Motion) -> list[Motion]:
    """Vertical accelerations of all labelled floors: that of the ground times the building's factors."""
    moved = []
    for label in building.floors:
        factor = float(building.vertical_factors.get(label, 1.0))
        level = building.level(label)
        felt = vertical.after(
            "floor_motion", factor * vertical.acceleration, floor=label, level=level, factor=factor
        )
        moved.append(_named(felt, label, level))
    return moved


def response_motions(
    building: ShearBuilding, motion: Motion, response: BuildingResponse, floors: Sequence[str]
) -> list[Motion]:
    """Motions of labelled floors in a response that is known; see :func:`floor_motions`."""
    moved = []
    for label in floors:
        level = building.level(label)
        felt = motion.after(
            "floor_motion",
            response.acceleration[level],
            building=building.name,
            model=building.model,
            floor=label,
            level=level,
            largest_drift=float(response.peak_drift.max()),
            outcome=judge_drift(building, response).statement,
        )
        moved.append(_named(felt, label, level, ground_motion=motion.name))
    return moved


def respond(building: ShearBuilding, motion: Motion) -> BuildingResponse:
    """Response by the building's model.

    Parameters
    ----------
    building, motion
        As of :func:`floor_motions`.

    Returns
    -------
    The :class:`BuildingResponse`.
    """
    if building.model == "elastic":
        return respond_elastically(building, motion)
    return respond_hysteretically(building, motion)


def _named(moved: Motion, label: str, level: int, **more: str) -> Motion:
    """Return a motion, still named as that of the ground, as that of a floor."""
    metadata = {**moved.metadata, "floor": label, "level": level, **more}
    return replace(moved, name=f"{moved.name}_{label}", metadata=metadata)


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
