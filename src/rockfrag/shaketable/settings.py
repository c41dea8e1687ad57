"""Shakers and protocols from YAML or mappings, refused with one sentence where they make no sense."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from rockfrag.errors import InputError
from rockfrag.shaketable.instruments import Accelerometer, Exact, ForceOverMass, Measurement
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.shaker import Shaker
from rockfrag.shaketable.steps import ForceSteps, GeometricSteps, LinearSteps, Steps

_SHAKER = {
    "stroke_m": "stroke",
    "force_n": "force",
    "lowest_hz": "lowest_hz",
    "highest_hz": "highest_hz",
    "start": "start",
    "armature_mass_kg": "armature_mass",
    "table_mass_kg": "table_mass",
    "velocity_m_s": "velocity",
}

_STEPS: dict[str, type[Steps]] = {
    "linear": LinearSteps,
    "geometric": GeometricSteps,
    "force": ForceSteps,
}


def read_shaker(path: str | os.PathLike[str]) -> Shaker:
    """Read a shaker from a YAML file such as ``config/experiment/shaker.yaml``.

    Raises
    ------
    InputError
        If the file is absent, is not YAML, or does not describe a shaker.
    """
    try:
        settings = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path.") from error
    except yaml.YAMLError as error:
        raise InputError(f"{path}: not YAML; check indentation and brackets.") from error
    return make_shaker(settings, str(path))


def make_shaker(settings: Any, source: str = "shaker") -> Shaker:
    """Make a shaker from a mapping with units in its keys.

    Parameters
    ----------
    settings
        Any of ``stroke_m``, ``force_n``, ``lowest_hz``, ``highest_hz``, ``start``,
        ``armature_mass_kg``, ``table_mass_kg``, ``velocity_m_s``.
    source
        Where the mapping comes from, for messages.
    """
    values = _mapping(settings, source, set(_SHAKER))
    given: dict[str, Any] = {
        _SHAKER[key]: value if key == "start" else _number(value, f"{source}: {key}")
        for key, value in values.items()
    }
    try:
        return Shaker(**given)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def make_protocol(settings: Any, source: str = "protocol") -> Protocol:
    """Make a protocol from a mapping.

    Parameters
    ----------
    settings
        ``steps`` (a mapping with ``kind`` ``linear``, ``geometric`` or ``force`` and the fields of that
        class), and any of ``limit_g``, ``repetitions``, ``reading`` and ``measurement`` (a mapping
        with ``kind`` ``exact``, ``force_over_mass``, which has ``believed_mass_kg`` by configuration
        and ``unaccounted_mass_kg``, or ``accelerometer``, which has ``clip_g``).
    source
        Where the mapping comes from, for messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value makes no sense.
    """
    known = {"steps", "limit_g", "repetitions", "reading", "measurement"}
    values = _mapping(settings, source, known)
    if "steps" not in values:
        raise InputError(f"{source}: steps are missing; give their kind, start and growth.")
    given: dict[str, Any] = {"steps": _steps(values["steps"], f"{source}: steps")}
    if "limit_g" in values:
        given["limit_g"] = _number(values["limit_g"], f"{source}: limit_g")
    for key in ("repetitions", "reading"):
        if key in values:
            given[key] = values[key]
    if "measurement" in values:
        given["measurement"] = _measurement(values["measurement"], f"{source}: measurement")
    try:
        return Protocol(**given)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def _steps(settings: Any, source: str) -> Steps:
    kind = _kind(settings, source, tuple(_STEPS))
    make = _STEPS[kind]
    names = set(make.__dataclass_fields__)
    values = _mapping(settings, source, names | {"kind"})
    for name in sorted(names):
        if name not in values:
            raise InputError(f"{source}: {name} is missing; {kind} steps need it.")
    return make(**{name: _number(values[name], f"{source}: {name}") for name in names})


def _measurement(settings: Any, source: str) -> Measurement:
    kind = _kind(settings, source, ("exact", "force_over_mass", "accelerometer"))
    if kind == "exact":
        _mapping(settings, source, {"kind"})
        return Exact()
    if kind == "accelerometer":
        values = _mapping(settings, source, {"kind", "clip_g"})
        return Accelerometer(_number(values.get("clip_g"), f"{source}: clip_g"))
    values = _mapping(settings, source, {"kind", "believed_mass_kg", "unaccounted_mass_kg"})
    masses = values.get("believed_mass_kg")
    if not isinstance(masses, Mapping):
        raise InputError(f"{source}: believed_mass_kg must give a mass for each configuration.")
    return ForceOverMass(
        {str(key): _number(mass, f"{source}: mass of {key}") for key, mass in masses.items()},
        _number(values.get("unaccounted_mass_kg", 0.0), f"{source}: unaccounted_mass_kg"),
    )


def _kind(settings: Any, source: str, known: tuple[str, ...]) -> str:
    kind = settings.get("kind") if isinstance(settings, Mapping) else None
    if kind not in known:
        raise InputError(f"{source}: kind must be one of {', '.join(known)}, got {kind!r}.")
    return str(kind)


def _mapping(settings: Any, source: str, known: set[str]) -> Mapping[str, Any]:
    if not isinstance(settings, Mapping):
        raise InputError(f"{source}: must be a mapping of keys to values, got {settings!r:.60}.")
    for key in settings:
        if key not in known:
            raise InputError(
                f"{source}: unknown key {key!r}; known are {', '.join(sorted(known))}."
            )
    return settings


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{what} must be a number, got {value!r:.60}.")
    return float(value)
