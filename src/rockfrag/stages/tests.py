"""Tests: the IDA curves read as a laboratory would and in two other ways, within the limits of a shaker."""

from collections.abc import Iterable, Iterator, Sequence

import pandas as pd

from rockfrag.shaketable.definitions import (
    DEFINITION,
    Swept,
    mean_amplitudes,
    tests_from_swept,
)
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.stages.ida import ida_curves_of
from rockfrag.stages.job import Job, Results
from rockfrag.stages.validity import sliding_table, validity_table
from rockfrag.study.study import Study
from rockfrag.system import geometry
from rockfrag.system.system import System, uplift_ratios
from rockfrag.units import GRAVITY

LIMITED = "step_protocol_shaker"  # the step protocol that stops at the shaker's limit


def run(job: Job[Study]) -> Results:
    """Yield the tests in every definition, their means, the shaker's limits, bodies and forces."""
    from rockfrag.shaketable.shaker import shaker_table

    study = job.study
    protocol = protocol_of(study)
    motions = job.motions("motions/floors")

    def ida_curves() -> Iterator[Swept]:
        for configuration in study.configurations:
            yield from ida_curves_of(job, configuration)

    tests = tests_from_swept(ida_curves(), protocol)
    if study.shaker is not None:
        payload = max(configuration.mass for configuration in study.configurations)
        limits = shaker_table(study.shaker, motions, payload)
        yield "shaker", limits
        tests = pd.concat([tests, limited_tests(ida_curves(), protocol, limits)], ignore_index=True)
    yield "tests", tests
    laboratory = tests[tests["definition"] == DEFINITION]
    yield "mean_amplitudes", mean_amplitudes(laboratory)
    yield "bodies", bodies_table(study.configurations)
    by_name = {motion.name: motion for motion in motions}
    ups = {up.name: up for up in job.motions("motions/vertical")} if study.vertical else None
    yield "validity", validity_table(laboratory, study.configurations, by_name, ups, job.threads)
    if study.slides:
        yield "sliding", sliding_table(job.file(path) for path in study.ida_files)
    censored = int((laboratory["censored"] != "none").sum())
    job.log.info("tests: %d, not overturned: %d", len(laboratory), censored)


def protocol_of(study: Study, step_percent: float | None = None) -> Protocol:
    """Return the step protocol of a study, or the same with another step [%]."""
    step = study.protocol_step_percent if step_percent is None else step_percent
    amplitudes = study.amplitudes
    return Protocol(GeometricSteps(amplitudes.lowest_g, step / 100), amplitudes.highest_g)


def limited_tests(
    ida_curves: Iterable[Swept], protocol: Protocol, limits: pd.DataFrame
) -> pd.DataFrame:
    """Read the step protocol with limits of :func:`rockfrag.shaketable.shaker.shaker_table`.

    Return tests of the definition ``LIMITED``; the remark of a test that the shaker ended says so.
    """
    known = limits.set_index("motion").to_dict("index")
    largest = {str(motion): float(limit["limit_g"]) for motion, limit in known.items()}
    tests = tests_from_swept(ida_curves, protocol, definitions=[DEFINITION], limits_g=largest)
    remarks = []
    for test in tests.to_dict("records"):
        limit = known[test["motion"]]
        ended = test["censored"] == "right" and limit["limit_g"] < protocol.limit_g
        reached = f"shaker's {limit['limited_by']} reached at {limit['limit_g']:.3f} g"
        remarks.append(reached if ended else test["remark"])
    return tests.assign(remark=remarks, definition=LIMITED)


def bodies_table(configurations: Sequence[System]) -> pd.DataFrame:
    """Return what is tested, a row per configuration.

    Columns: ``configuration``, ``object``, ``stands_on`` (the pedestal, empty for the floor); of the object
    ``width_m``, ``height_m``, ``mass_kg``, ``slenderness`` (height over width [-]), ``critical_angle_rad``,
    ``radius_m``, ``frequency_1_s``; ``uplift_m_s2``: least acceleration of the floor at which anything starts to
    rock [m/s²].
    """
    rows = []
    for configuration in configurations:
        body, shape = configuration.bodies[-1], configuration.shapes[-1]
        rows.append(
            {
                "configuration": configuration.name,
                "object": configuration.names[-1],
                "stands_on": "|".join(configuration.names[-2::-1]),
                "width_m": body.width,
                "height_m": body.height,
                "mass_kg": body.mass,
                "slenderness": body.height / body.width,
                "critical_angle_rad": min(geometry.critical_angle(shape, k) for k in (+1, -1)),
                "radius_m": geometry.radius(shape, 1),
                "frequency_1_s": geometry.frequency(shape, 1, GRAVITY),
                "uplift_m_s2": GRAVITY * min(uplift_ratios(configuration)),
            }
        )
    return pd.DataFrame(rows)
