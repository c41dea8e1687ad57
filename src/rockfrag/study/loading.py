"""Reading a study before anything runs, with every check that can be made beforehand."""

import os
from collections.abc import Mapping
from typing import Any

from rockfrag.errors import InputError
from rockfrag.motions.processing import check_steps
from rockfrag.shaketable.laboratory_table import read_measured
from rockfrag.shaketable.settings import read_shaker
from rockfrag.study.measured_table import (
    MeasuredTable,
    is_measured_table,
    measured_table_from,
)
from rockfrag.study.study import Study, study_from
from rockfrag.yaml_file import read_yaml


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read a study's configuration file and everything small that it names, and check them all.

    Raises
    ------
    InputError
        One sentence with the file, the key or row, what was expected and what was found.
    """
    return checked_study(read_yaml(path), path)


def load_any(path: str | os.PathLike[str]) -> Study | MeasuredTable:
    """Read a configuration of either kind: a simulated study, or one of a measured table.

    Raises
    ------
    InputError
        As :func:`load_study`.
    """
    return any_study(read_yaml(path), path)


def any_study(content: Mapping[str, Any], path: str | os.PathLike[str]) -> Study | MeasuredTable:
    """Make a study of either kind of a configuration that was read from ``path``.

    Raises
    ------
    InputError
        As :func:`load_study`.
    """
    if is_measured_table(content):
        return measured_table_from(content, path)
    return checked_study(content, path)


def checked_study(content: Mapping[str, Any], path: str | os.PathLike[str]) -> Study:
    """Make a study of a configuration that was read from ``path``, and check what it refers to.

    Raises
    ------
    InputError
        As :func:`load_study`.
    """
    study = study_from(content, path)
    try:
        check_steps(study.processing)
    except InputError as error:
        raise InputError(f"{study.source}: key motions.processing: {error}") from error
    _check_varied_floors(study)
    if study.more.shaker is not None:
        read_shaker(study.more.shaker)
    if study.more.explanation is not None and not study.has_pairs:
        raise InputError(
            f"{study.source}: key explanation: expected an object tested with and without a pedestal "
            "among the configurations."
        )
    if study.more.measured_tests is not None:
        read_measured(study.more.measured_tests)
    return study


def _check_varied_floors(study: Study) -> None:
    """Raise where the sensitivity names floors or levels that the building does not have."""
    if study.building is None:
        return
    storeys = study.building.storeys
    for i, levels in enumerate((study.more.sensitivity or {}).get("floors", ())):
        for label, level in levels.items():
            where = f"{study.source}: key building_sensitivity.floors[{i}].{label}"
            if label not in study.floors:
                raise InputError(
                    f"{where}: expected a floor of the building, one of {', '.join(study.floors)}."
                )
            if level > storeys:
                raise InputError(f"{where}: expected a level up to {storeys}, found {level}.")
