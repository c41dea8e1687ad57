"""Where an object stands: on the ground, or on a floor of a building that changes the motion.

In: a floor and a building. Out: motions of that floor [m/s²].
Docs: ``docs/assess.md``, "The building"; ``docs/building.md``.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.assess.assumed import (
    Assumption,
    Moved,
    assume,
    moved_to_both_sides,
    tolerances_in,
)
from rockfrag.assess.core.bodies import usual_period
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.building.floors import floor_motions
from rockfrag.building.model import ModalDamping, ShearBuilding, stiffnesses_for_period
from rockfrag.building.modes import fill_slower
from rockfrag.building.settings import make_building, read_building
from rockfrag.config.schema import checked
from rockfrag.records.motion import Motion
from rockfrag.words.findings import (
    Finding,
    Form,
    Number,
    Value,
    finding,
    listed,
    percent,
    three,
    two,
)

STOREY_HEIGHT = 3.5  # Height of a storey of a building of which nothing is known [m]
# Mass of its floors [kg]; equal floors respond alike whatever they weigh
STOREY_MASS = 300_000.0
HIGHEST_BUILDING = 40  # Storeys up to which the rule for the period is used

TOLERANCES = {"period": 0.3, "damping": 0.4}
"""Relative standard deviations of an assumed building's first period and damping, unless stated."""

TOLERANCE_OF_KNOWN_PERIOD = 0.1  # That of a first period that was given [-]

PERIOD_FACTORS = {"steel": 0.085, "concrete": 0.075, "masonry": 0.05}
"""C_t of T = C_t H^(3/4) with H in metres: frames of steel and of concrete, all other buildings
(EN 1998-1:2004, 4.3.3.2.2(3))."""

_FLOOR = re.compile(r"\s*(\d+)\s*(?:/|of)\s*(\d+)\s*")


@dataclass(frozen=True)
class Place:
    """A floor of a building, or the ground."""

    building: ShearBuilding | None = None  # The elastic building; None on the ground
    floor: str = ""  # Label of the floor in the building; empty on the ground
    # Relative standard deviations of the building's first period and damping
    tolerances: Mapping[str, float] | None = None
    label: str = ""  # What the user calls the floor; empty if that is only a level
    # Whether the records are those of the floor itself, whatever carries it
    recorded: bool = False
    assumed: tuple[Assumption, ...] = ()  # What was not given

    @property
    def where(self) -> Finding:
        """Such as ``on the ground``, ``on level 2 of 4`` or on a floor that has a name."""
        if self.building is None and self.label:
            return finding(Text.ON_NAMED_FLOOR, label=self.label)
        if self.building is None:
            return finding(Text.ON_ITS_FLOOR if self.recorded else Text.ON_GROUND)
        level, storeys = self.building.level(self.floor), self.building.storeys
        if not self.label:
            return finding(Text.ON_LEVEL, level=level, storeys=storeys)
        return finding(
            Text.ON_NAMED_LEVEL, level=level, storeys=storeys, label=self.label
        )

    @property
    def floor_name(self) -> Finding | None:
        """What Europe and America call the level; None on the ground."""
        if self.building is None:
            return None
        level = self.building.level(self.floor)
        if level == self.building.storeys:
            return finding(Text.ROOF)
        europe, america = Number(level, Form.ORDINAL), Number(level + 1, Form.ORDINAL)
        return finding(Text.FLOOR_NAME, europe=europe, america=america)

    @property
    def shakes_as_ground(self) -> bool:
        """Whether what the object stands on moves as the ground does."""
        return self.building is None or self.building.level(self.floor) == 0

    @property
    def key(self) -> object:
        """Equal for places whose floors move alike."""
        building = self.building
        if building is None or self.shakes_as_ground:
            return None
        return (
            building.stiffnesses,
            building.masses,
            building.damping,
            building.level(self.floor),
        )

    def shake(self, motion: Motion) -> Motion:
        """Motion of the floor under a ground motion."""
        if self.building is None or self.shakes_as_ground:
            return motion
        return floor_motions(self.building, motion, [self.floor])[0]

    def variants(self) -> list[Moved["Place"]]:
        """The place with each property of the building smaller and larger by its standard deviation."""
        building = self.building
        if building is None or self.shakes_as_ground:
            return []

        def slower(factor: float) -> Place:
            softer = np.zeros(building.storeys)
            fill_slower(np.array(building.stiffnesses), factor, softer)
            stiffnesses = tuple(softer.tolist())
            return replace(self, building=replace(building, stiffnesses=stiffnesses))

        def damped(factor: float) -> Place:
            damping = replace(building.damping, ratio=building.damping.ratio * factor)
            return replace(self, building=replace(building, damping=damping))

        return moved_to_both_sides(
            {"period": slower, "damping": damped}, self.tolerances or {}
        )


def make_place(settings: Mapping[str, Any], folder: Path) -> Place:
    """Make a place of checked keys of ``statue.yaml``; its floor must exist, and its building be elastic."""
    floor = settings.get("floor")
    if settings.get("records", {}).get("recorded_on") == "floor":
        label = "" if floor is None else str(floor)
        said = Assumption(None, finding("why_on_floor"))
        return Place(label=label, recorded=True, assumed=(said,))
    if "building" in settings:
        return _given(settings, floor, folder)
    if floor is None:
        return Place(assumed=(assume("on_ground"),))
    return _sketched(str(floor), {}, settings)


def _given(settings: Mapping[str, Any], floor: Any, folder: Path) -> Place:
    """The building of a file, or a mapping that describes all of it or what is known of it."""
    given = settings["building"]
    if isinstance(given, str):
        building = read_building(folder / given)
        where = given
    elif any(str(key).startswith("masses") for key in given):
        building, where = make_building(given), "the building"
    else:
        if floor is None:
            raise InputError(
                "key floor is missing; give the level over the storeys, such as 2/4."
            )
        return _sketched(
            str(floor), checked(given, "known_of_building", "building"), settings
        )
    if building.model != "elastic":
        raise InputError(
            f"key building: {where} is not elastic, and one object is assessed with an elastic building; set "
            "model: elastic, or run a study with this one."
        )
    if floor is None:
        raise InputError(
            f"key floor is missing: which of {', '.join(building.floors)} of {where} is meant?"
        )
    label = str(floor)
    found = _FLOOR.fullmatch(label)
    if found and int(found[2]) != building.storeys:
        raise InputError(
            f"key floor: {where} has {building.storeys} storeys, not {found[2]}."
        )
    level = found[1] if found else label
    if label not in building.floors and level.isdecimal():
        building = replace(building, floors={**building.floors, label: int(level)})
    building.level(label)
    name = "" if found or label.isdecimal() else label
    said = assume("building", "period", "damping")
    tolerances = tolerances_in(settings, TOLERANCES)
    return Place(building, label, tolerances, name, assumed=(said,))


def _sketched(
    floor: str, known: Mapping[str, Any], settings: Mapping[str, Any]
) -> Place:
    """A building of equal floors, of which the period follows from its height unless it is known."""
    level, storeys = _level(floor)
    heights = _heights(known, storeys)
    total = sum(heights)
    material = known.get("material", "masonry")
    factor = PERIOD_FACTORS[material]
    period = float(known.get("first_period_s", usual_period(factor, total)))
    masses = (STOREY_MASS,) * storeys
    building = ShearBuilding(
        masses=masses,
        heights=heights,
        stiffnesses=stiffnesses_for_period(masses, heights, period),
        damping=ModalDamping(float(known.get("damping_ratio", ModalDamping().ratio))),
        floors={"floor": level},
        name=f"building of {storeys} storeys",
    )
    rule = finding(Text.PERIOD_BY_RULE, factor=two(factor))
    if "first_period_s" in known:
        rule = finding(Text.PERIOD_GIVEN)
    about: dict[str, Value] = {"total": three(total), "period": two(period)}
    about |= {"count": storeys, "storeys": _storeys(known, heights), "rule": rule}
    about |= {"material": finding(f"of_{known.get('material', 'unknown')}")}
    about |= {"damping": percent(building.damping.ratio)}
    said = assume("sketched", "period", "damping", **about)
    usual = TOLERANCES | (
        {"period": TOLERANCE_OF_KNOWN_PERIOD} if "first_period_s" in known else {}
    )
    return Place(building, "floor", tolerances_in(settings, usual), assumed=(said,))


def _storeys(known: Mapping[str, Any], heights: Sequence[float]) -> Finding:
    """The storeys of a building of which some is known."""
    if "storey_heights_m" in known:
        return finding(Text.STOREYS_OF, heights=listed([two(each) for each in heights]))
    given = "storey_height_m" in known
    text = Text.STOREYS_OF if given else Text.STOREYS_ASSUMED
    return finding(text, heights=three(heights[0]))


def _heights(known: Mapping[str, Any], storeys: int) -> tuple[float, ...]:
    """Heights of the storeys [m], equal ones unless each is given."""
    if "storey_heights_m" not in known:
        return (float(known.get("storey_height_m", STOREY_HEIGHT)),) * storeys
    if "storey_height_m" in known:
        raise InputError(
            "key building.storey_height: the heights of all storeys are given too; leave one out."
        )
    heights = tuple(float(height) for height in known["storey_heights_m"])
    if len(heights) != storeys:
        raise InputError(
            f"key building.storey_heights: {len(heights)} heights are given for {storeys} storeys; give one a "
            "storey."
        )
    return heights


def _level(floor: str) -> tuple[int, int]:
    """Level of a floor and number of storeys, of words such as ``2/4``."""
    found = _FLOOR.fullmatch(floor)
    if not found:
        raise InputError(
            f"key floor: expected a level over the number of storeys such as 2/4, found {floor[:40]!r}; level 0 "
            "is the ground, level 2 what Europe calls the second floor and America the third."
        )
    level, storeys = _storey(found[1]), _storey(found[2])
    if not (level <= storeys and 1 <= storeys <= HIGHEST_BUILDING):
        raise InputError(
            f"key floor: {floor[:40]} does not exist; levels run from 0, the ground, to the number of storeys, "
            f"which is at most {HIGHEST_BUILDING}."
        )
    return level, storeys


def _storey(digits: str) -> int:
    """A number of storeys, none of which has more than three digits."""
    return int(digits) if len(digits) <= 3 else HIGHEST_BUILDING + 1
