"""The building as an axis: one of its assumptions changed at a time."""

import pandas as pd

from rockfrag.stages.job import Job, Results
from rockfrag.stages.tests import protocol_of
from rockfrag.study.study import Study
from rockfrag.yaml_file import read_yaml
from rockfrag_thesis.settings import settings_of


def run(job: Job[Study]) -> Results:
    """Yield the tests on the floors of every building, and their means."""
    from rockfrag.shaketable.definitions import DEFINITION, mean_amplitudes
    from rockfrag_thesis.building_sensitivity import building_sensitivity, building_variants

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
        job.threads,
        lambda done: job.log.info("%d of %d buildings", done, len(variants)),
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
