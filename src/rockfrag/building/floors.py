"""Motions of the floors of a building: what stands on them feels these."""

from collections.abc import Sequence
from dataclasses import replace

from rockfrag.building.drift import judge_drift
from rockfrag.building.inelastic import respond_hysteretically
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
    building
        Building; its model says whether it responds elastically or hysteretically.
    motion
        Ground acceleration.

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
