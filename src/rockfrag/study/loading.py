"""Reading a study before anything runs, with every check that can be made beforehand.

In: a YAML file and what it names. Out: a study of any kind, or one sentence on what is wrong; warnings on records.
Docs: ``config/README.md``.
"""

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.files import distinct_file_names, file_name, is_file
from rockfrag.base.plausible import LARGEST_PEAK, peak_warning
from rockfrag.base.units import GRAVITY
from rockfrag.base.yaml_file import read_yaml
from rockfrag.building.settings import read_floors
from rockfrag.config.plugins import plugins_asked
from rockfrag.config.schema import checked
from rockfrag.motions.processing import process
from rockfrag.records.catalogue import own_records, read_catalogue, repeated_motions
from rockfrag.records.files_beside import with_files_beside
from rockfrag.records.motion import Motion
from rockfrag.records.quality_flags import DRIFT, quality_flags
from rockfrag.shaketable.shaker import read_shaker
from rockfrag.study import configurations as arrangements
from rockfrag.study.campaign import (
    CAMPAIGN_KEY,
    TABLE_KEY,
    CampaignStudy,
    MeasuredTable,
    campaign_from,
    measured_table_from,
)
from rockfrag.study.heading import check_file, checked_steps, existing_file, heading_of
from rockfrag.study.holding import read_isolators
from rockfrag.study.scaling import LARGEST_FACTOR, too_weak
from rockfrag.study.space import SPACE_KEY, SpaceStudy, space_study_from
from rockfrag.study.study import (
    GROUND,
    RECORDS_FOLDER,
    Amplitudes,
    FragilitySettings,
    Study,
)
from rockfrag.words.sentences import listed

AnyStudy = Study | MeasuredTable | CampaignStudy | SpaceStudy


def load_any(path: str | os.PathLike[str]) -> AnyStudy:
    """Read a configuration of any kind: a simulated study, a measured table, a campaign, bodies in space.

    Parameters
    ----------
    path : YAML file

    Returns
    -------
    The study.
    """
    return any_study(read_yaml(path), path)


def any_study(content: Mapping[str, Any], path: str | os.PathLike[str]) -> AnyStudy:
    """Study of any kind from a configuration that was read from ``path``.

    Parameters
    ----------
    content, path : the configuration, and its file

    Returns
    -------
    The study.
    """
    kinds: dict[str, tuple[str, Callable[..., AnyStudy]]] = {
        TABLE_KEY: ("measured_table", measured_table_from),
        CAMPAIGN_KEY: ("campaign", campaign_from),
        SPACE_KEY: ("space", space_study_from),
    }
    schema, make = next(
        (kind for key, kind in kinds.items() if key in content), ("study", _study)
    )
    return make(checked(content, schema, str(path)), Path(path))


def _study(content: Mapping[str, Any], source: Path) -> Study:
    """Make a study of a checked configuration, and check what it refers to."""
    motions = content["motions"]
    building_file = _optional_file(content, "building", source)
    shaker_file = _optional_file(content, "shaker", source)
    bodies = _bodies_of(content, source)
    with errors_of(f"{source}"):
        amplitudes = Amplitudes(**content["amplitudes"])
    study = Study(
        **heading_of(content, source),
        **bodies,
        **_catalogue_of(motions, source),
        processing=checked_steps(
            source, "motions.processing", motions.get("processing", ())
        ),
        building_file=building_file,
        floors={GROUND: 0} if building_file is None else read_floors(building_file),
        amplitudes=amplitudes,
        protocol_step_percent=float(content["protocol"]["step_percent"]),
        fragility=_fragility_of(content["fragility"]),
        keep_going=content.get("keep_going", False),
        largest_factor=_largest_factor(motions),
        slides="friction" in content
        or any(each.loose for each in bodies["configurations"]),
        vertical=content.get("vertical", False),
        write_motions=content.get("write_motions"),
        shaker_file=shaker_file,
        shaker=None if shaker_file is None else read_shaker(shaker_file),
        measured_tests=_optional_file(content, "measured_tests", source),
    )
    asked = plugins_asked(content)
    added = {name: plugin.settings(content, study) for name, plugin in asked.items()}
    study = replace(study, added=added)
    _check_study(study)
    return study


def _check_study(study: Study) -> None:
    """Check names, records, measured tests and vertical components of a study."""
    _check_names(study)
    for path in study.own_records:
        if is_file(path) or not study.keep_going:
            check_file(path, f"{study.catalogue_file}: column file")
    if study.measured_tests is not None:
        _check_measured_tests(study, study.measured_tests)
    _check_vertical(study)


def _optional_file(content: Mapping[str, Any], key: str, source: Path) -> Path | None:
    """Path of the file that a key names; None without the key."""
    name = content.get(key)
    return None if name is None else existing_file(source, key, name)


def _bodies_of(content: Mapping[str, Any], source: Path) -> dict[str, Any]:
    """Attributes of a study that its key ``bodies`` gives: specimens, configurations and counterparts."""
    bodies = content["bodies"]
    specimens_file = existing_file(source, "bodies.specimens", bodies["specimens"])
    specimens = arrangements.read_specimens(specimens_file)
    configurations_file, isolators_file = None, None
    known = arrangements.each_alone(specimens)
    counterparts: dict[str, str] = {}
    if "configurations" in bodies:
        name = bodies["configurations"]
        configurations_file = existing_file(source, "bodies.configurations", name)
        isolators = {}
        if "isolators" in bodies:
            name = bodies["isolators"]
            isolators_file = existing_file(source, "bodies.isolators", name)
            isolators = read_isolators(isolators_file)
        known, counterparts = arrangements.read_configurations(
            configurations_file, specimens, isolators
        )
    by_name = {configuration.name: configuration for configuration in known}
    tested = _used(source, "bodies", bodies.get("use"), list(by_name), "configurations")
    chosen = [by_name[name] for name in tested]
    counterparts = arrangements.against_nothing(chosen, counterparts)
    return {
        "specimens_file": specimens_file,
        "specimens": specimens,
        "configurations_file": configurations_file,
        "isolators_file": isolators_file,
        "configurations": arrangements.with_contacts(
            chosen, specimens, content, str(source)
        ),
        "counterparts": {
            name: other
            for name in tested
            if (other := counterparts.get(name, "")) in tested
        },
    }


def _catalogue_of(motions: Mapping[str, Any], source: Path) -> dict[str, Any]:
    """Attributes of a study that its key ``motions`` gives: the catalogue, and its rows that are used."""
    file = existing_file(source, "motions.catalogue", motions["catalogue"])
    catalogue = read_catalogue(file).set_index("name", drop=False)
    used = _used(
        source, "motions", motions.get("use"), list(catalogue.index), "motions"
    )
    return {
        "catalogue_file": file,
        "catalogue": catalogue.loc[used].reset_index(drop=True),
    }


def _fragility_of(settings: Mapping[str, Any]) -> FragilitySettings:
    """Settings of the key ``fragility``: names of measures, and pairs of them."""
    measures = settings["measures"]
    return FragilitySettings(
        measures=tuple(measure for measure in measures if isinstance(measure, str)),
        pairs=tuple((pair[0], pair[1]) for pair in measures if isinstance(pair, list)),
        confidence=settings["confidence"],
        model_error=settings.get("model_error", True),
    )


def _largest_factor(motions: Mapping[str, Any]) -> float:
    """Largest factor that the key ``motions`` allows, infinite where it lifts the limit."""
    given = motions.get("largest_factor", LARGEST_FACTOR)
    return math.inf if given is None else float(given)


def _used(
    source: Path, key: str, names: Sequence[str] | None, known: Sequence[str], what: str
) -> list[str]:
    """Names that a study uses, in its order; all that are known if it gives none.

    ``source``, ``key``: file and key in messages; ``what``: words for what is named.
    """
    for i, name in enumerate(names or ()):
        if name not in known:
            raise InputError(
                f"{source}: key {key}.use[{i}]: expected one of the {what} {', '.join(known)}, found {name}."
            )
    return list(known if names is None else names)


def _check_names(study: Study) -> None:
    """Refuse names of motions and floors that could not stand in tables and file names."""
    motions, floors = list(study.catalogue["name"]), list(study.floors)
    for where, names in (
        (f"{study.catalogue_file}, column name", motions),
        (f"{study.building_file}: key floors", floors),
    ):
        with errors_of(where):
            distinct_file_names(names)
    felt: dict[str, str] = {}
    for motion in motions:
        for floor in floors:
            other = felt.setdefault(file_name(f"{motion}_{floor}").casefold(), motion)
            if other != motion:
                raise InputError(
                    f"{study.catalogue_file}, column name: with the floors' names {motion} and {other} "
                    "become one; rename one."
                )


def _check_vertical(study: Study) -> None:
    """Refuse vertical motion of which the catalogue names no record."""
    if not study.vertical:
        return
    for row in study.catalogue.to_dict("records"):
        if not row["vertical"]:
            raise InputError(
                f"{study.source}: key vertical: {study.catalogue_file} names no vertical component of "
                f"{row['name']}; give it in the column vertical."
            )


def _check_measured_tests(study: Study, path: Path) -> None:
    """Refuse a table of tests with an object that is none of the specimens."""
    from rockfrag.shaketable.tests_table import read_measured

    known = list(study.specimens)
    for name in dict.fromkeys(read_measured(path)["object"]):
        if name not in known:
            raise InputError(
                f"{path}: column object: expected one of the specimens {', '.join(known)}, found {name}."
            )


def check_tables(study: AnyStudy) -> None:
    """Read the tests of a measured table or a campaign, so that what is wrong in them is said beforehand.

    Parameters
    ----------
    study : of any kind; a table that is still to be fetched is not looked at
    """
    # statistics load what a study of simulations need not wait for
    if isinstance(study, MeasuredTable):
        from rockfrag.fragility.tests_file import read_tests

        read_tests(study.table, study.measures, **study.columns)
    elif isinstance(study, CampaignStudy) and is_file(study.tests):
        from rockfrag.campaign.laboratory import read_campaign

        codes = study.other_codes
        known = codes if codes is not None and is_file(codes) else None
        read_campaign(study.tests, study.columns, study.measures, known)


def check_building(study: Study) -> None:
    """Read the building of a study, so that what is wrong with it is said before the first job.

    Parameters
    ----------
    study : the study, with a building or without one
    """
    _ = study.building


_FOUND: dict[tuple[object, ...], list[str]] = {}
"""What was found of the records as they are: a run is checked by itself and by Snakemake, in one process."""


def check_records(study: Study) -> list[str]:
    """Read every record that lies in a folder of the user's own, once in a process as long as none changes.

    Returns warnings: of accelerations that look as if in another unit, of records that will be left out.

    Parameters
    ----------
    study : the study

    Returns
    -------
    The warnings, a sentence each.
    """
    columns = ("file", "second", "vertical")
    files = own_records(study.catalogue, study.catalogue_file.parent, columns)
    states = map(_state, [study.catalogue_file, *with_files_beside(files)])
    asked = (tuple(study.catalogue["name"]), study.keep_going, study.vertical, *states)
    if asked not in _FOUND:
        _FOUND[asked] = _read_all(study)
    return [*_FOUND[asked]]


def _state(path: Path) -> tuple[str, int, int]:
    """Path, size and time of the last change of a file; what is not there has neither."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return str(path), 0, 0
    return str(path), found.st_size, found.st_mtime_ns


def _read_all(study: Study) -> list[str]:
    """Read all motions of a study, and return what looks wrong with them."""
    from rockfrag.motions.directions import motions_of_row

    warnings = [
        f"{study.catalogue_file}: {line}" for line in repeated_motions(study.catalogue)
    ]
    warnings += seconds_not_shaken(study)
    folder = study.catalogue_file.parent
    own = study.catalogue[study.catalogue["source"] == "folder"]
    read: list[Motion] = []
    for row in cast("list[dict[str, Any]]", own.to_dict("records")):
        where = f"{study.catalogue_file}, motion {row['name']}"
        try:
            motion = motions_of_row(row, folder, Path(RECORDS_FOLDER), study.vertical)[
                0
            ]
            if motion.pga == 0:
                raise InputError("the record is zero throughout; leave it out.")
        except InputError as error:
            if not study.keep_going:
                raise InputError(f"{where}: {error}") from None
            warnings.append(f"{where} will be left out: {error}")
            continue
        read.append(motion)
        warnings += [
            f"{where}: {quality_flag}."
            for quality_flag in _quality_flags(study, motion)
        ]
    return warnings + _scaled_far(study, read)


def _quality_flags(study: Study, record: Motion) -> list[str]:
    """What is doubtful in a record: its unit, its drift, its strength."""
    ground = process(record, study.processing)
    found = [flag for flag in quality_flags(ground) if DRIFT in flag]
    weak = "" if study.building_file else too_weak(study, [ground])
    if weak:
        found.append(f"will be left out: {weak}")
    unit_stated = record.provenance[0].get("unit_stated", False)
    # a unit that the file states is not to be doubted because the motion is weak
    if not (unit_stated and record.pga < LARGEST_PEAK):
        found.append(peak_warning(record.pga))
    return [flag for flag in found if flag]


def _scaled_far(study: Study, records: Sequence[Motion]) -> list[str]:
    """Say how many records the highest amplitude scales too far, if any."""
    highest = float(study.amplitudes.values_g[-1]) * GRAVITY
    factors = {motion.name: highest / motion.pga for motion in records}
    far = {name: factor for name, factor in factors.items() if factor > LARGEST_FACTOR}
    if not far or study.building_file is not None:
        return []
    farthest = max(far, key=far.__getitem__)
    return [
        f"{study.catalogue_file}: the highest amplitude scales {len(far)} of {len(factors)} motions by more than "
        f"{LARGEST_FACTOR:g}, {farthest} by {far[farthest]:.3g}; the report says which tests need such factors."
    ]


def seconds_not_shaken(study: Study) -> list[str]:
    """Say which rows name a second component that has no row of its own, and so shakes nothing by itself.

    Parameters
    ----------
    study : the study

    Returns
    -------
    A sentence, or nothing.
    """
    rows = cast("list[dict[str, Any]]", study.catalogue.to_dict("records"))
    own = {(row["source"], row["file"]) for row in rows}
    alone = [
        row["name"]
        for row in rows
        if row["second"]
        and not row["direction"]
        and (row["source"], row["second"]) not in own
    ]
    if not alone:
        return []
    return [
        f"{study.catalogue_file}: the second component of {listed(alone)} has no row of its own: it is measured, "
        "and shakes nothing; give it a row to test it too."
    ]
