"""What a study may ask for beyond its 72 tests: shaker, measured tests, sensitivity, explanation."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError


@dataclass(frozen=True)
class Explanation:
    """Levels of the factors that could produce a pedestal effect.

    Attributes
    ----------
    statue_restitution, interface_restitution, ground_restitution
        Factors on the restitution that conserves momentum: of the object wherever it stands, of the
        object on the pedestal only, of the pedestal on the ground [-].
    pedestal_lean_deg, statue_offset_mm, statue_cg_offset_mm
        Imperfections: lean of the pedestal, object off its middle, centre of gravity of the object
        off its middle, on the pedestal and on the ground alike.
    pedestal_width_cm
        Widths of the pedestal.
    table_mass_kg
        Moved masses of the table that enter the two ways of miscounting mass.
    step_percent
        Steps of the protocol [%].
    tolerance_percent, tolerance_restitution
        Standard deviations of every length and restitution in perturbed copies.
    replicates
        Number of perturbed copies.
    """

    statue_restitution: tuple[float, ...]
    interface_restitution: tuple[float, ...]
    ground_restitution: tuple[float, ...]
    pedestal_lean_deg: tuple[float, ...]
    statue_offset_mm: tuple[float, ...]
    statue_cg_offset_mm: tuple[float, ...]
    pedestal_width_cm: tuple[float, ...]
    table_mass_kg: tuple[float, ...]
    step_percent: tuple[float, ...]
    tolerance_percent: float
    tolerance_restitution: float
    replicates: int


@dataclass(frozen=True)
class Supplementary:
    """Optional parts of a study; each is None where the configuration does not ask for it.

    Attributes
    ----------
    shaker
        YAML file of a shaking table whose limits are read beside the unlimited protocol.
    measured_tests
        CSV file of a laboratory's tests, which go through the same statistics.
    sensitivity
        Values of the building's assumptions by name, see
        :data:`rockfrag.shaketable.sensitivity.AXES`.
    explanation
        Factors that could produce a pedestal effect.
    """

    shaker: Path | None = None
    measured_tests: Path | None = None
    sensitivity: Mapping[str, Sequence[Any]] | None = None
    explanation: Explanation | None = None


def supplementary_from(content: Mapping[str, Any], source: Path) -> Supplementary:
    """Take the optional parts out of a study's configuration, which has passed its schema.

    Raises
    ------
    InputError
        If a file is absent, or a part needs a building or a pedestal that the study does not have.
    """
    sensitivity = content.get("building_sensitivity")
    if sensitivity is not None and content.get("building") is None:
        raise InputError(
            f"{source}: key building_sensitivity: expected the key building too, which it varies."
        )
    explanation = content.get("explanation")
    if explanation is not None:
        lists = {k: tuple(v) for k, v in explanation.items() if isinstance(v, list)}
        explanation = Explanation(**{**explanation, **lists})
    return Supplementary(
        shaker=_file(source, "shaker", content.get("shaker")),
        measured_tests=_file(source, "measured_tests", content.get("measured_tests")),
        sensitivity=sensitivity,
        explanation=explanation,
    )


def _file(source: Path, key: str, name: str | None) -> Path | None:
    if name is None:
        return None
    path = Path(os.path.normpath(source.parent / name))
    if not path.is_file():
        raise InputError(f"{source}: key {key}: expected an existing file, found no {path}.")
    return path
