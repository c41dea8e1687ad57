"""Buildings from YAML, refused with one sentence where they make no sense.

In: the key ``building`` of a configuration. Out: a building, SI units. Docs: ``docs/building.md``.
"""

import os
from collections.abc import Mapping, Sequence
from typing import Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.files import distinct_file_names
from rockfrag.base.plausible import FIRST_PERIODS, FLOOR_MASSES, STOREY_HEIGHTS
from rockfrag.base.yaml_file import read_yaml
from rockfrag.building import model
from rockfrag.building.model import MasonryLaw
from rockfrag.building.response import find_modes
from rockfrag.config.schema import checked


def read_building(path: str | os.PathLike[str]) -> model.ShearBuilding:
    """Read a building from a YAML file such as ``config/building.yaml``.

    Parameters
    ----------
    path : of the file

    Returns
    -------
    The :class:`ShearBuilding`.
    """
    return make_building(read_yaml(path), str(path))


def read_floors(path: str | os.PathLike[str]) -> dict[str, int]:
    """Read which floors a building's file names; what else it says is not judged.

    Parameters
    ----------
    path : of the file

    Returns
    -------
    Level of each floor by its label, 0 for the ground.
    """
    return _floors(checked(read_yaml(path), "building", str(path)))


def make_building(settings: Any, source: str = "building") -> model.ShearBuilding:
    """Make a building from a mapping such as ``config/building.yaml`` holds.

    Parameters
    ----------
    settings, source : the mapping, and its name in messages

    Returns
    -------
    The building.
    """
    known = checked(settings, "building", source)
    with errors_of(source):
        return _building(known)


def _building(settings: Mapping[str, Any]) -> model.ShearBuilding:
    """A building of checked keys, whose numbers must be those of a building."""
    heights, masses = settings["storey_heights_m"], settings["masses_kg"]
    _check_storeys(heights, masses)
    distinct_file_names(_floors(settings))
    if "first_period_s" in settings:
        stiffnesses = model.stiffnesses_for_period(
            masses, heights, settings["first_period_s"]
        )
    else:
        stiffnesses = settings["storey_stiffnesses_N_m"]
    asked = settings.get("damping", {})
    damping = model.ModalDamping(float(asked.get("ratio", 0.05)))
    if asked.get("kind", "modal") == "rayleigh":
        damping = model.RayleighDamping(
            damping.ratio, tuple(asked.get("modes", (1, 2)))
        )
    building = model.ShearBuilding(
        masses=masses,
        heights=heights,
        stiffnesses=stiffnesses,
        damping=damping,
        floors=_floors(settings),
        model=settings.get("model", "elastic"),
        masonry=MasonryLaw(**settings.get("masonry", {})),
        name=settings.get("name", "building"),
        vertical_factors=settings.get("vertical_factors", {}),
    )
    stated = "first_period_s" in settings
    _check_period(building, "first_period_s" if stated else "storey_stiffnesses_N_m")
    return building


def _floors(settings: Mapping[str, Any]) -> dict[str, int]:
    """Level of each floor of interest by its label: the ground, where checked keys name none."""
    return dict(settings.get("floors", {"ground": 0}))


def _check_storeys(heights: Sequence[float], masses: Sequence[float]) -> None:
    """Refuse heights [m] and masses [kg] of storeys that are not as many, or not those of a building."""
    if len(heights) != len(masses):
        raise InputError(
            f"storey_heights_m has {len(heights)} entries and masses_kg {len(masses)}; give one of "
            "each for every storey."
        )
    for key, values, unit, (least, most) in (
        ("storey_heights_m", heights, "m", STOREY_HEIGHTS),
        ("masses_kg", masses, "kg", FLOOR_MASSES),
    ):
        for i, value in enumerate(values):
            if not least <= value <= most:
                raise InputError(
                    f"{key}[{i}]: {value:g} {unit} is no building's, which have from {least:g} to "
                    f"{most:g} {unit}; check the unit."
                )


def _check_period(building: model.ShearBuilding, key: str) -> None:
    """Refuse a first period that no building has; ``key`` gave it."""
    period = float(find_modes(building).period[0])
    shortest, longest = FIRST_PERIODS
    if not shortest <= period <= longest:
        raise InputError(
            f"{key}: the first period would be {period:.3g} s, and those of buildings are from {shortest:g} to "
            f"{longest:g} s; check the units."
        )
