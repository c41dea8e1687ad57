"""Where an object stands: on the ground, or on a floor of a building that changes the motion."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rockfrag.assess.moved import Moved, moved_to_both_sides
from rockfrag.building.floors import floor_motions
from rockfrag.building.model import ModalDamping, ShearBuilding, stiffnesses_for_period
from rockfrag.building.settings import read_building
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

STOREY_HEIGHT = 3.5
"""Height of a storey of a building of which nothing is known [m]."""

STOREY_MASS = 300_000.0
"""Mass of its floors [kg]; equal floors respond alike whatever they weigh."""

HIGHEST_BUILDING = 40
"""Storeys up to which the rule for the period is used."""

TOLERANCES = {"period": 0.3, "damping": 0.4}
"""Relative standard deviations of an assumed building's first period and damping, unless stated."""

_FLOOR = re.compile(r"\s*(\d+)\s*(?:/|of)\s*(\d+)\s*")


@dataclass(frozen=True)
class Place:
    """A floor of a building, or the ground.

    Attributes
    ----------
    building
        The elastic building; None on the ground.
    floor
        Label of the floor in the building; empty on the ground.
    tolerances
        Relative standard deviations of the building's first period and damping.
    assumed
        Sentences, one for each thing that was not given.
    """

    building: ShearBuilding | None = None
    floor: str = ""
    tolerances: Mapping[str, float] | None = None
    assumed: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """Such as ``on the ground`` or ``on level 2 of 4``."""
        if self.building is None:
            return "on the ground"
        return f"on level {self.building.level(self.floor)} of {self.building.storeys}"

    @property
    def key(self) -> object:
        """Equal for places whose floors move alike."""
        building = self.building
        if building is None or building.level(self.floor) == 0:
            return None
        return building.stiffnesses, building.masses, building.damping, building.level(self.floor)

    def shake(self, motion: Motion) -> Motion:
        """Motion of the floor under a ground motion.

        Parameters
        ----------
        motion
            The ground's motion.
        """
        if self.building is None or self.building.level(self.floor) == 0:
            return motion
        return floor_motions(self.building, motion, [self.floor])[0]

    def variants(self) -> list[Moved["Place"]]:
        """The place with each property of the building smaller and larger by its standard deviation."""
        building = self.building
        if building is None or building.level(self.floor) == 0:
            return []

        def slower(factor: float) -> Place:
            stiffnesses = tuple(k / factor**2 for k in building.stiffnesses)
            return replace(self, building=replace(building, stiffnesses=stiffnesses))

        def damped(factor: float) -> Place:
            damping = replace(building.damping, ratio=building.damping.ratio * factor)
            return replace(self, building=replace(building, damping=damping))

        return moved_to_both_sides({"period": slower, "damping": damped}, self.tolerances or {})


def make_place(settings: Mapping[str, Any], folder: Path) -> Place:
    """Make a place of checked settings.

    Parameters
    ----------
    settings
        Checked keys of ``statue.yaml``.
    folder
        Folder from which the path of a building is read.

    Raises
    ------
    InputError
        If the floor does not exist, or the building is not elastic.
    """
    floor = settings.get("floor")
    on_floor = settings.get("records", {}).get("recorded_on") == "floor"
    if on_floor:
        if "building" in settings:
            raise InputError(
                "building: records of the floor itself need no building; leave it out."
            )
        return Place(assumed=("The records are those of the floor itself.",))
    tolerances = TOLERANCES | {
        key: float(value)
        for key, value in settings.get("tolerances", {}).items()
        if key in TOLERANCES
    }
    if "building" in settings:
        return _given(folder / settings["building"], floor, tolerances)
    if floor is None:
        return Place(assumed=("It stands on the ground, no floor was given.",))
    return _assumed(str(floor), tolerances)


def _given(path: Path, floor: Any, tolerances: Mapping[str, float]) -> Place:
    building = read_building(path)
    if building.model != "elastic":
        raise InputError(
            f"{path}: one object is assessed with an elastic building; set model: elastic, or run a study with "
            "this one."
        )
    if floor is None:
        raise InputError(f"floor: which of {', '.join(building.floors)} of {path.name} is meant?")
    label = str(floor)
    found = _FLOOR.fullmatch(label)
    if found and int(found[2]) != building.storeys:
        raise InputError(f"floor: {path.name} has {building.storeys} storeys, not {found[2]}.")
    level = found[1] if found else label
    if label not in building.floors and level.isdigit():
        building = replace(building, floors={**building.floors, label: int(level)})
    building.level(label)
    return Place(building, label, tolerances)


def _assumed(floor: str, tolerances: Mapping[str, float]) -> Place:
    found = _FLOOR.fullmatch(floor)
    if not found:
        raise InputError(
            f"floor: expected a level over the number of storeys such as 2/4, found {floor[:40]!r}."
        )
    level, storeys = int(found[1]), int(found[2])
    if not (level <= storeys and 1 <= storeys <= HIGHEST_BUILDING):
        raise InputError(
            f"floor: {floor} does not exist; levels run from 0, the ground, to the number of storeys, which is at "
            f"most {HIGHEST_BUILDING}."
        )
    heights, masses = (STOREY_HEIGHT,) * storeys, (STOREY_MASS,) * storeys
    period = 0.05 * (STOREY_HEIGHT * storeys) ** 0.75
    building = ShearBuilding(
        masses=masses,
        heights=heights,
        stiffnesses=stiffnesses_for_period(masses, heights, period),
        damping=ModalDamping(),
        floors={"floor": level},
        name=f"building of {storeys} storeys",
    )
    words = (
        f"An elastic building of {storeys} equal storeys of {STOREY_HEIGHT:g} m with a first period of "
        f"{period:.2f} s (0.05 H^0.75, EN 1998-1) and {building.damping.ratio:.0%} damping."
    )
    return Place(building, "floor", tolerances, (words,))
