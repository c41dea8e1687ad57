"""Buildings from YAML, refused with one sentence where they make no sense."""

import os
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import yaml

from rockfrag.building.masonry import MasonryLaw
from rockfrag.building.model import (
    Damping,
    ModalDamping,
    RayleighDamping,
    ShearBuilding,
    check_positive,
    stiffnesses_for_period,
)
from rockfrag.errors import InputError

_KEYS = {
    "name",
    "storey_heights_m",
    "masses_kg",
    "first_period_s",
    "storey_stiffnesses_N_m",
    "damping",
    "floors",
    "model",
    "masonry",
}


def read_building(path: str | os.PathLike[str]) -> ShearBuilding:
    """Read a building from a YAML file.

    Raises
    ------
    InputError
        If the file is absent, is not YAML, or does not describe a building.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path.") from error
    try:
        settings = yaml.safe_load(text)
    except yaml.YAMLError as error:
        place = getattr(error, "problem_mark", None)
        line = f", line {place.line + 1}" if place else ""
        raise InputError(f"{path}{line}: not YAML; check indentation and brackets.") from error
    return make_building(settings, str(path))


def make_building(settings: Any, source: str = "building") -> ShearBuilding:
    """Make a building from a mapping such as ``config/building.yaml`` holds.

    Parameters
    ----------
    settings
        ``storey_heights_m``, ``masses_kg``, one of ``first_period_s`` and
        ``storey_stiffnesses_N_m``, and optionally ``name``, ``damping``, ``floors``, ``model``
        (``elastic`` or ``hysteretic``) and ``masonry``.
    source
        Where the mapping comes from, for messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value makes no sense.
    """
    settings = _mapping(settings, source)
    _known(settings, _KEYS, source)
    try:
        return _make_building(settings)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def _make_building(settings: Mapping[str, Any]) -> ShearBuilding:
    heights = _numbers(settings, "storey_heights_m", "m")
    masses = _numbers(settings, "masses_kg", "kg")
    if len(heights) != len(masses):
        raise InputError(
            f"storey_heights_m has {len(heights)} entries and masses_kg {len(masses)}; give one of "
            "each for every storey."
        )
    floors = _mapping(settings.get("floors", {"ground": 0}), "floors")
    return ShearBuilding(
        masses=masses,
        heights=heights,
        stiffnesses=_stiffnesses(settings, masses, heights),
        damping=_damping(settings.get("damping", {})),
        floors=dict(floors),
        model=settings.get("model", "elastic"),
        masonry=_masonry(settings.get("masonry", {})),
        name=str(settings.get("name", "building")),
    )


def _stiffnesses(
    settings: Mapping[str, Any], masses: tuple[float, ...], heights: tuple[float, ...]
) -> tuple[float, ...]:
    if ("first_period_s" in settings) == ("storey_stiffnesses_N_m" in settings):
        raise InputError("give either first_period_s or storey_stiffnesses_N_m, and not both.")
    if "first_period_s" in settings:
        period = _number(settings["first_period_s"], "first_period_s")
        check_positive("building", "first_period_s", "s", [period])
        return stiffnesses_for_period(masses, heights, period)
    return _numbers(settings, "storey_stiffnesses_N_m", "N/m")


def _damping(settings: Any) -> Damping:
    settings = _mapping(settings, "damping")
    _known(settings, {"kind", "ratio", "modes"}, "damping")
    kind = settings.get("kind", "modal")
    ratio = _number(settings.get("ratio", 0.05), "damping ratio")
    if kind == "modal" and "modes" not in settings:
        return ModalDamping(ratio)
    if kind == "rayleigh":
        modes = settings.get("modes", [1, 2])
        if not (isinstance(modes, list) and len(modes) == 2 and all(type(m) is int for m in modes)):
            raise InputError(f"damping: modes must be two mode numbers, got {modes!r}.")
        return RayleighDamping(ratio, (modes[0], modes[1]))
    raise InputError(
        f"damping: kind must be modal (without modes) or rayleigh, got {kind!r} with "
        f"{', '.join(settings)}."
    )


def _masonry(settings: Any) -> MasonryLaw:
    settings = _mapping(settings, "masonry")
    _known(settings, {one.name for one in fields(MasonryLaw)}, "masonry")
    return MasonryLaw(**{key: _number(value, f"masonry {key}") for key, value in settings.items()})


def _mapping(value: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InputError(f"{where}: must be a mapping of keys to values, got {value!r:.60}.")
    return value


def _known(settings: Mapping[str, Any], keys: set[str], where: str) -> None:
    for key in settings:
        if key not in keys:
            raise InputError(f"{where}: unknown key {key!r}; known are {', '.join(sorted(keys))}.")


def _numbers(settings: Mapping[str, Any], key: str, unit: str) -> tuple[float, ...]:
    values = settings.get(key)
    if not isinstance(values, list):
        raise InputError(f"{key} must be a list of numbers, one a storey, got {values!r:.60}.")
    numbers = tuple(_number(value, key) for value in values)
    check_positive("building", key, unit, numbers)
    return numbers


def _number(value: Any, key: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(
            f"{key} must be a number (YAML wants 3.5e+05 or 350000), got {value!r:.60}."
        )
    return float(value)
