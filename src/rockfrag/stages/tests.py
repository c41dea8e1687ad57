"""Tests: the IDA curves read as a laboratory would and in two other ways, within the limits of a shaker."""

from collections.abc import Iterator

import pandas as pd

from rockfrag.shaketable.swept import Swept
from rockfrag.stages.job import Job, Results
from rockfrag.stages.read_ida_curves import ida_curves_of
from rockfrag.stages.shaker import limited_tests, limits_table
from rockfrag.stages.validity import sliding_table, validity_table
from rockfrag.study.study import Study


def run(job: Job[Study]) -> Results:
    """Yield the tests in every definition, their means, the shaker's limits, bodies and forces."""
    from rockfrag.shaketable.definitions import DEFINITION, tests_from_swept
    from rockfrag.shaketable.mean_amplitudes import mean_amplitudes
    from rockfrag.stages.bodies import bodies_table
    from rockfrag.stages.protocol import protocol_of

    study = job.study
    protocol = protocol_of(study)
    motions = job.motions("motions/floors")

    def ida_curves() -> Iterator[Swept]:
        for configuration in study.configurations:
            yield from ida_curves_of(job, configuration)

    tests = tests_from_swept(ida_curves(), protocol)
    if study.shaker is not None:
        limits = limits_table(study, motions)
        yield "shaker", limits
        tests = pd.concat([tests, limited_tests(ida_curves(), protocol, limits)], ignore_index=True)
    yield "tests", tests
    laboratory = tests[tests["definition"] == DEFINITION]
    yield "mean_amplitudes", mean_amplitudes(laboratory)
    yield "bodies", bodies_table(study.configurations)
    by_name = {motion.name: motion for motion in motions}
    ups = (
        {motion.name: motion for motion in job.motions("motions/vertical")}
        if study.vertical
        else None
    )
    forces = validity_table(laboratory, study.configurations, by_name, ups, job.threads)
    yield "validity", forces
    if study.slides:
        files = (job.file(path) for path in study.ida_files)
        yield "sliding", sliding_table(files)
    censored = int((laboratory["censored"] != "none").sum())
    job.log.info("tests: %d, not overturned: %d", len(laboratory), censored)
