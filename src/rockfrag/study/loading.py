"""Reading a study before anything runs, with every check that can be made beforehand."""

import os
from collections.abc import Mapping
from typing import Any

from rockfrag.building.settings import read_building
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
from rockfrag.study.yaml_file import read_yaml


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
    content = read_yaml(path)
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
    if study.building is not None:
        storeys = len(read_building(study.building).masses)
        _check_levels(study, storeys)
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


def _check_levels(study: Study, storeys: int) -> None:
    """Raise where the sensitivity names levels that the building does not have."""
    for third, fifth in (study.more.sensitivity or {}).get("levels", ()):
        if not third < fifth <= storeys:
            raise InputError(
                f"{study.source}: key building_sensitivity.levels: expected pairs of levels up to "
                f"{storeys}, the lower one first, found [{third}, {fifth}]."
            )
