"""What a study may ask for beyond its tests: shaker, measured tests, sensitivity, explanation."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rockfrag.shaketable.settings import read_shaker
from rockfrag.shaketable.shaker import Shaker
from rockfrag.study.paths import existing_file


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
    wanted_percent
        Effect that is asked for, changes of P/NP on the ``ground`` and ``above`` it [%]; empty where none is.
    friction
        Coefficients of friction at the ``ground`` and at the ``interface``, all pairs of which are tried beside
        infinite ones [-]; empty where surfaces are taken as rough enough.
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
    wanted_percent: Mapping[str, float] = field(default_factory=dict)
    friction: Mapping[str, Sequence[float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Supplementary:
    """Optional parts of a study; each is None where the configuration does not ask for it.

    Attributes
    ----------
    shaker_file, shaker
        A shaking table whose limits are read beside the unlimited protocol, and its YAML file.
    measured_tests
        CSV file of a laboratory's tests, which go through the same statistics.
    sensitivity
        Values of the building's assumptions by name, see
        :data:`rockfrag.shaketable.sensitivity.AXES`.
    explanation
        Factors that could produce a pedestal effect.
    """

    shaker_file: Path | None = None
    shaker: Shaker | None = None
    measured_tests: Path | None = None
    sensitivity: Mapping[str, Sequence[Any]] | None = None
    explanation: Explanation | None = None


def supplementary_from(content: Mapping[str, Any], source: Path) -> Supplementary:
    """Take the optional parts out of a study's configuration, which has passed its schema.

    Raises
    ------
    InputError
        If a file is absent or wrong.
    """
    shaker_file = _file(source, "shaker", content.get("shaker"))
    explanation = content.get("explanation")
    if explanation is not None:
        lists = {k: tuple(v) for k, v in explanation.items() if isinstance(v, list)}
        explanation = Explanation(**{**explanation, **lists})
    return Supplementary(
        shaker_file=shaker_file,
        shaker=None if shaker_file is None else read_shaker(shaker_file),
        measured_tests=_file(source, "measured_tests", content.get("measured_tests")),
        sensitivity=content.get("building_sensitivity"),
        explanation=explanation,
    )


def _file(source: Path, key: str, name: str | None) -> Path | None:
    return None if name is None else existing_file(source, key, name)
