"""Motions of the floors of a building, the drift of its storeys, and whether its model is credible there.

In: a :class:`rockfrag.building.model.ShearBuilding` and a ground motion of n samples. Out: absolute
accelerations of its floors [m/s²] as motions, and the :class:`DriftOutcome` of the storey that is worst off.

Theory: ``docs/building.md``, "Elastic model", "Masonry model" and "How far a model may be believed".
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.building.drift_words import (
    StoreyState,
    elastic_statement,
    hysteretic_statement,
)
from rockfrag.building.inelastic import respond_hysteretically, shear_strengths
from rockfrag.building.model import MasonryLaw, ShearBuilding
from rockfrag.building.response import BuildingResponse, respond_elastically
from rockfrag.records.motion import Motion


def floor_motions(
    building: ShearBuilding, motion: Motion, floors: Sequence[str] | None = None
) -> list[Motion]:
    """Absolute accelerations of labelled floors under a ground motion.

    Parameters
    ----------
    building : its model says whether it responds elastically or hysteretically
    motion : ground acceleration, of n samples
    floors : labels that the building gives to its floors; all of them if not given

    Returns
    -------
    One motion a floor, of n samples, named ``<motion>_<floor>`` and with ``floor``, ``level`` and
    ``ground_motion`` in its metadata. Level 0 is the ground motion itself.
    """
    labels = list(building.floors) if floors is None else list(floors)
    for label in labels:
        building.level(label)
    return response_motions(building, motion, respond(building, motion), labels)


def vertical_motions(building: ShearBuilding, vertical: Motion) -> list[Motion]:
    """Vertical accelerations of all labelled floors: that of the ground times the building's factors.

    Parameters
    ----------
    building, vertical : the building, and the vertical ground acceleration, of n samples

    Returns
    -------
    One motion a floor, of n samples.
    """
    moved = []
    for label in building.floors:
        factor = float(building.vertical_factors.get(label, 1.0))
        level = building.level(label)
        felt = vertical.after(
            "floor_motion",
            factor * vertical.acceleration,
            floor=label,
            level=level,
            factor=factor,
        )
        moved.append(_named(felt, label, level))
    return moved


def response_motions(
    building: ShearBuilding,
    motion: Motion,
    response: BuildingResponse,
    floors: Sequence[str],
) -> list[Motion]:
    """Motions of labelled floors in a response that is known; see :func:`floor_motions`.

    Parameters
    ----------
    building, motion : the building and the ground motion, of n samples
    response, floors : its response, and the labels of the floors

    Returns
    -------
    One motion a floor, of n samples.
    """
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
    building, motion : as of :func:`floor_motions`

    Returns
    -------
    Histories at the samples of the motion: ``time`` [s], absolute ``acceleration`` of ground and floors [m/s²],
    shape (storeys + 1, n), ``drift`` of the storeys over height [-], and ``energy`` of a hysteretic model.
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
    """State of the storey that is worst off."""

    storey: int  # Its number, from 1
    drift: float  # Its largest drift over height [-]
    # Largest shear over strength [-]; above 1 of elastic models only
    strength_fraction: float
    state: str  # words of its :class:`rockfrag.building.drift_words.StoreyState`
    # Whether the model may be used there: up to the strength, or the rocking limit
    credible: bool
    statement: str  # One sentence for a report


def judge_drift(building: ShearBuilding, response: BuildingResponse) -> DriftOutcome:
    """Judge a response by the masonry law of the building.

    Parameters
    ----------
    building, response : a building, whose law judges, and its response

    Returns
    -------
    The ``storey`` that is worst off, its ``drift`` over height [-], ``strength_fraction`` (largest shear over the
    shear strength [-]) and ``state``, whether the model is ``credible`` there, and a sentence (``statement``).
    """
    is_elastic = building.model == "elastic"
    shear = (
        np.asarray(building.stiffnesses)
        * np.asarray(building.heights)
        * response.peak_drift
    )
    fractions = shear / shear_strengths(building)
    worst = int(np.argmax(fractions if is_elastic else response.peak_drift))
    fraction, drift = float(fractions[worst]), float(response.peak_drift[worst])
    if is_elastic:
        state = _elastic_state(building.masonry, fraction)
        statement = elastic_statement(building, worst + 1, drift, fraction, state)
        is_credible = fraction <= 1
    else:
        state = _hysteretic_state(building.masonry, fraction, drift)
        statement = hysteretic_statement(building, worst + 1, drift, state)
        is_credible = drift <= building.masonry.rocking_drift
    return DriftOutcome(
        storey=worst + 1,
        drift=drift,
        strength_fraction=fraction if is_elastic else min(1.0, fraction),
        state=state.words,
        credible=is_credible,
        statement=statement,
    )


def _elastic_state(law: MasonryLaw, fraction: float) -> StoreyState:
    """State of a storey of an elastic model, by its shear over its strength [-]."""
    if fraction > 1:
        return StoreyState.BEYOND_STRENGTH
    return StoreyState.CRACKED if fraction > law.cracking else StoreyState.UNCRACKED


def _hysteretic_state(law: MasonryLaw, fraction: float, drift: float) -> StoreyState:
    """State of a storey of a hysteretic model, by its shear over its strength and its drift over height [-]."""
    if not fraction > law.cracking:
        return StoreyState.UNCRACKED
    limits = (law.yield_drift, law.shear_drift, law.rocking_drift)
    return StoreyState(StoreyState.CRACKED + sum(drift > limit for limit in limits))
