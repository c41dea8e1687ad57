"""The building as an axis: overturning amplitudes along its assumptions.

One assumption is varied at a time around the building of a YAML file.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.yaml_file import read_yaml
from rockfrag.building.floors import judge_drift, respond, response_motions
from rockfrag.building.model import ShearBuilding
from rockfrag.building.settings import make_building
from rockfrag.motions.processing import scale
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.shaketable.definitions import DEFINITION, mean_amplitudes, tests_from_ida
from rockfrag.shaketable.protocols import Protocol
from rockfrag.stages.ida import ida_table
from rockfrag.stages.job import Job, Results
from rockfrag.stages.tests import protocol_of
from rockfrag.study.study import Study
from rockfrag.system.system import System
from rockfrag_thesis.settings import settings_of

AXES = ("first_period_s", "damping_ratio", "base_shear", "ground_scale", "floors")
"""Assumptions that can be varied: first period and damping of the elastic model, shear strength over
weight of the hysteretic one and the factor on the ground motion that it feels, and the level of each
labelled floor."""


@dataclass(frozen=True)
class Variant:
    """One building of a sensitivity study."""

    # Assumption that differs from the reference, one of ``AXES``, or ``reference``
    axis: str
    value: float  # Its value; for ``floors`` the level of the highest floor
    label: str  # The same for a reader
    building: ShearBuilding  # The building
    # Factor on the ground motions that it feels; its floors' motions are scaled to the amplitudes
    # of the tests in any case, so this matters for a hysteretic building alone
    ground_scale: float = 1.0


def run(job: Job[Study]) -> Results:
    """Yield the tests on the floors of every building, and their means."""
    study = job.study
    varied = settings_of(study).sensitivity
    if study.building_file is None or varied is None:
        raise ValueError("the study varies no building")
    settings = read_yaml(study.building_file)
    variants = building_variants(settings, varied, str(study.building_file))
    tests = building_sensitivity(
        variants,
        job.motions("motions/ground"),
        study.configurations,
        study.amplitudes.values_g,
        protocol_of(study),
        threads=job.threads,
        progress=lambda done: job.log.info("%d of %d buildings", done, len(variants)),
    )
    yield "building_sensitivity/tests", tests
    by = ["axis", "value", "label", "credible"]
    laboratory = tests[tests["definition"] == DEFINITION]
    parts = []
    for key, rows in laboratory.groupby(by, sort=False, dropna=False):
        about = pd.DataFrame(dict(zip(by, key, strict=True)), index=[0])
        parts.append(about.merge(mean_amplitudes(rows), how="cross"))
    yield "building_sensitivity/means", pd.concat(parts, ignore_index=True)
    job.log.info("buildings: %d", len(variants))


def building_variants(
    settings: Mapping[str, Any],
    axes: Mapping[str, Sequence[Any]],
    source: str = "building",
) -> list[Variant]:
    """Buildings that differ from one in a single assumption each, after the one itself.

    ``settings`` are those of the reference building, as :func:`rockfrag.building.settings.make_building` takes
    them, and ``axes`` values for any of ``AXES``; each of ``floors`` maps labels of the building to levels.
    ``source`` says in messages where the settings come from.
    """
    for axis in axes:
        if axis not in AXES:
            raise InputError(
                f"{source}: axis {axis!r} of the sensitivity is unknown; known are {', '.join(AXES)}."
            )
    variants = [Variant("reference", 0.0, "reference", make_building(settings, source))]
    for axis, values in axes.items():
        variants.extend(_variant(settings, axis, value, source) for value in values)
    return variants


def _variant(
    settings: Mapping[str, Any], axis: str, value: Any, source: str
) -> Variant:
    """A building changed along an axis of the analysis, and what the change is called."""

    def changed(**changes: Any) -> ShearBuilding:
        kept = {k: v for k, v in settings.items() if k != "storey_stiffnesses_N_m"}
        return make_building(kept | changes, source)

    if axis == "floors":
        levels = {**settings.get("floors", {}), **value}
        named = ", ".join(f"{label} {level}" for label, level in value.items())
        return Variant(
            axis, float(max(value.values())), f"levels {named}", changed(floors=levels)
        )
    if axis == "first_period_s":
        return Variant(
            axis, value, f"first period {value:g} s", changed(first_period_s=value)
        )
    if axis == "damping_ratio":
        damping = {**settings.get("damping", {}), "ratio": value}
        return Variant(axis, value, f"damping {value:.0%}", changed(damping=damping))
    if axis == "base_shear":
        law = {**settings.get("masonry", {}), "base_shear": value}
        building = changed(model="hysteretic", masonry=law)
        return Variant(axis, value, f"masonry, {value:g} W", building)
    building = changed(model="hysteretic")
    return Variant(axis, value, f"masonry, {value:g} × record", building, value)


def building_sensitivity(
    variants: Sequence[Variant],
    motions: Sequence[Motion],
    specimens: Sequence[System],
    amplitudes_g: Floats,
    protocol: Protocol,
    *,
    threads: int = 1,
    progress: Callable[[int], None] = lambda done: None,
) -> pd.DataFrame:
    """Overturning amplitudes for every variant of a building, each with the floors that are to be shaken.

    Motions are of the ground, ``amplitudes_g`` those of the IDA curves [g], rising; ``specimens`` are each object
    with and without its pedestal. ``progress`` is called with the number of variants done.

    Returns a table of tests of all variants and definitions, with the variant's ``axis``, ``value`` and ``label``,
    and ``credible``, whether the building's model is to be believed under all motions.
    """
    # IDA curves under motions of the ground, which are the same for every variant
    known: dict[str, pd.DataFrame] = {}

    def ida(motion: Motion) -> pd.DataFrame:
        """IDA curves of all specimens on a floor; those of the ground, which no variant changes, are known."""
        if motion.metadata["level"] == 0 and motion.name in known:
            return known[motion.name]
        tables = [
            ida_table(
                specimen, [GroundMotion(motion)], amplitudes_g, threads
            ).to_pandas()
            for specimen in specimens
        ]
        earthquake = (
            motion.metadata.get("earthquake") or motion.metadata["ground_motion"]
        )
        found: pd.DataFrame = pd.concat(tables, ignore_index=True).assign(
            earthquake=earthquake
        )
        if motion.metadata["level"] == 0:
            known[motion.name] = found
        return found

    tables: list[pd.DataFrame] = []
    for done, variant in enumerate(variants, start=1):
        floors, credible = _floors(variant, motions)
        tests = tests_from_ida(pd.concat(map(ida, floors), ignore_index=True), protocol)
        tests = tests.assign(
            axis=variant.axis, value=variant.value, label=variant.label
        )
        tables.append(tests.assign(credible=credible))
        progress(done)
    return pd.concat(tables, ignore_index=True)


def _floors(variant: Variant, motions: Sequence[Motion]) -> tuple[list[Motion], bool]:
    """Motions of all floors of a variant, and whether its model is to be believed."""
    credible, floors = True, []
    for motion in motions:
        felt = scale(motion, variant.ground_scale)
        response = respond(variant.building, felt)
        credible &= judge_drift(variant.building, response).credible
        labels = list(variant.building.floors)
        floors += response_motions(variant.building, felt, response, labels)
    return floors, credible
