"""Tests: the IDA curves read as a laboratory would and in two other ways, within the limits of a shaker.

In: IDA curves, motions [m/s²], a shaker. Out: tables of tests with amplitudes [g], forces and bodies. Theory:
``docs/definitions.md``, ``docs/shaketable.md``.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.units import GRAVITY
from rockfrag.motions.processing import scale_to_pga
from rockfrag.records.motion import GroundMotion
from rockfrag.shaketable.definitions import (
    DEFINITION,
    Swept,
    mean_amplitudes,
    tests_from_swept,
)
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.shaketable.shaker import shaker_table
from rockfrag.simulation import overturns, simulate
from rockfrag.stages.ida import ground_motions_of, ida_curves_of
from rockfrag.stages.job import Job, Results
from rockfrag.study.holding import held_by, rocks_like_free
from rockfrag.study.study import Study
from rockfrag.system import geometry
from rockfrag.system.system import System, uplift_ratios

LIMITED = "step_protocol_shaker"  # the step protocol that stops at the shaker's limit


def run(job: Job[Study]) -> Results:
    """Yield the tests in every definition, their means, the shaker's limits, bodies and forces."""
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
        tests = pd.concat(
            [tests, limited_tests(ida_curves(), protocol, limits)], ignore_index=True
        )
    yield "tests", tests
    laboratory = tests[tests["definition"] == DEFINITION]
    yield "mean_amplitudes", mean_amplitudes(laboratory)
    yield "bodies", bodies_table(study.configurations)
    by_name = {motion.name: motion for motion in ground_motions_of(job)}
    yield (
        "validity",
        validity_table(laboratory, study.configurations, by_name, job.threads),
    )
    if study.slides:
        # casters alone let a body slide, so that others may stand beside it that cannot
        loose = [each for each in study.configurations if each.loose]
        yield "sliding", sliding_table(map(job.file, study.ida_files_of(loose)))
    censored = int((laboratory["censored"] != "none").sum())
    job.log.info("tests: %d, not overturned: %d", len(laboratory), censored)


def protocol_of(study: Study, step_percent: float | None = None) -> Protocol:
    """Step protocol of a study, or the same with another step.

    Parameters
    ----------
    study, step_percent : the study, and the other step [%]

    Returns
    -------
    The protocol.
    """
    step = study.protocol_step_percent if step_percent is None else step_percent
    peaks = study.amplitudes
    return Protocol(GeometricSteps(peaks.lowest_g, step / 100), peaks.highest_g)


def limited_tests(
    ida_curves: Iterable[Swept], protocol: Protocol, limits: pd.DataFrame
) -> pd.DataFrame:
    """Read the step protocol with limits of :func:`rockfrag.shaketable.shaker.shaker_table`.

    Return tests of the definition ``LIMITED``; the remark of a test that the shaker ended says so.
    """
    known = limits.set_index("motion")
    largest = {str(motion): float(limit) for motion, limit in known["limit_g"].items()}
    tests = tests_from_swept(
        ida_curves, protocol, definitions=[DEFINITION], limits_g=largest
    )
    at = tests["motion"].map(known["limit_g"])
    by = tests["motion"].map(known["limited_by"])
    ended = (tests["censored"] == "right") & (at < protocol.limit_g)
    reached = "shaker's " + by + " reached at " + at.map("{:.3f} g".format)
    return tests.assign(
        remark=reached.where(ended, tests["remark"]), definition=LIMITED
    )


def bodies_table(configurations: Sequence[System]) -> pd.DataFrame:
    """Return what is tested, a row per configuration.

    Columns: ``configuration``, ``object``, ``stands_on`` (the pedestal and an isolator, empty for the floor),
    ``held_by`` (what else holds it, empty if nothing); of the object ``width_m``, ``height_m``, ``mass_kg``,
    ``slenderness`` (height over width [-]), ``critical_angle_rad``, ``radius_m``, ``frequency_1_s``;
    ``uplift_m_s2``: least acceleration of the floor at which anything starts to rock [m/s²], NaN where the statics
    of free bodies do not say it.
    """
    rows = []
    for configuration in configurations:
        body, shape = configuration.bodies[-1], configuration.shapes[-1]
        isolator = () if configuration.support is None else ("isolator",)
        uplift = math.nan
        if rocks_like_free(configuration):
            uplift = GRAVITY * min(uplift_ratios(configuration))
        rows.append(
            {
                "configuration": configuration.name,
                "object": configuration.names[-1],
                "stands_on": "|".join((*configuration.names[-2::-1], *isolator)),
                "held_by": held_by(replace(configuration, support=None)),
                "width_m": body.width,
                "height_m": body.height,
                "mass_kg": body.mass,
                "slenderness": body.height / body.width,
                "critical_angle_rad": min(
                    geometry.critical_angle(shape, k) for k in (+1, -1)
                ),
                "radius_m": geometry.radius(shape, 1),
                "frequency_1_s": geometry.frequency(shape, 1, GRAVITY),
                "uplift_m_s2": uplift,
            }
        )
    return pd.DataFrame(rows)


MOST_TESTED = 500
"""Tests of a configuration whose forces are looked at: of more this many, evenly among them."""


def validity_table(
    tests: pd.DataFrame,
    configurations: Sequence[System],
    motions: Mapping[str, GroundMotion],
    threads: int = 1,
) -> pd.DataFrame:
    """Simulate tests once more, each at its reported amplitude, and look at the contact forces.

    Parameters
    ----------
    tests : of one definition, one repetition
    configurations, motions : systems, and motions by name
    threads : threads to use

    Returns
    -------
    One row per test with an amplitude, ``MOST_TESTED`` of a configuration at most: ``test``, ``object``,
        ``pedestal``, ``earthquake``, ``floor``, ``motion``, ``amplitude_g``, ``friction_demand`` (largest |T|/N at
        any interface [-]), ``least_normal_force_n`` (least N at any interface [N]; ≤ 0 where a block would have
        jumped) and ``unstable_distance`` (how near the response came to an unstable equilibrium). With friction
        also ``peak_slip_m``, the largest displacement along any interface, and ``flights``.
    """
    known = tests[tests["amplitude_g"].notna()]
    known = known[_looked_at(known["configuration"])].reset_index(drop=True)
    columns = ["friction_demand", "least_normal_force_n", "unstable_distance"]
    if any(configuration.loose for configuration in configurations):
        columns += ["peak_slip_m", "flights"]
    parts = [pd.DataFrame(columns=columns)]
    for configuration in configurations:
        rows = known[known["configuration"] == configuration.name]
        if len(rows):
            forces = _forces(configuration, _shaken(rows, motions), threads)
            parts.append(forces.set_index(rows.index))
    found = pd.concat(parts[1:] or parts)[columns].sort_index()
    keys = [
        "test",
        "object",
        "pedestal",
        "earthquake",
        "floor",
        "motion",
        "amplitude_g",
    ]
    return pd.concat([known[keys], found], axis=1)


def _looked_at(configuration: pd.Series) -> NDArray[np.bool_]:
    """Which tests are simulated once more: all of a configuration, or some evenly among its many."""
    chosen = np.zeros(len(configuration), dtype=bool)
    for rows in configuration.groupby(configuration, sort=False).indices.values():
        step = max(1.0, len(rows) / MOST_TESTED)
        chosen[rows[np.arange(0, len(rows), step).astype(np.intp)]] = True
    return chosen


def _shaken(
    tests: pd.DataFrame, motions: Mapping[str, GroundMotion]
) -> list[GroundMotion]:
    """Motion of each test, all components scaled alike so that the horizontal one has the test's amplitude."""
    scaled = []
    for name, peak in zip(tests["motion"], tests["amplitude_g"], strict=True):
        motion = motions[name]
        x, z = scale_to_pga(motion.x, peak), motion.z
        if z is not None:
            z = replace(z, acceleration=x.pga / motion.x.pga * z.acceleration)
        scaled.append(GroundMotion(x, z=z))
    return scaled


def _forces(system: System, motions: list[GroundMotion], threads: int) -> pd.DataFrame:
    """Forces of a configuration under motions as they are, a row each."""
    if system.loose or system.holding or system.count > 2:
        return _in_contact(system, motions)
    found = overturns(system, motions, forces=True, threads=threads)
    return pd.DataFrame(
        {
            "friction_demand": found.of_any("friction_demand")[0, :, 0],
            "least_normal_force_n": found.of_any("least_normal_force")[0, :, 0],
            "peak_slip_m": found.of_any("peak_slip")[0, :, 0],
            **found.wide(0, ("unstable_distance", "flights")),
        }
    )


def _in_contact(system: System, motions: list[GroundMotion]) -> pd.DataFrame:
    """Forces of bodies that may slide or are held, which only histories have."""
    rows = []
    for motion in motions:
        response = simulate(system, motion)
        rows.append(
            {
                "friction_demand": np.fmax.reduce(response.friction_demand),
                "least_normal_force_n": np.fmin.reduce(response.least_normal_force),
                "peak_slip_m": np.abs(response.slip).max(),
                "unstable_distance": response.unstable_distance,
                "flights": (response.contact_events["kind"] == "flight").sum(),
            }
        )
    return pd.DataFrame(rows)


def sliding_table(files: Iterable[Path]) -> pd.DataFrame:
    """Count what friction did in IDA curves of bodies that may slide; one file is in memory at a time.

    One row per configuration: ``configuration``, ``cases``, ``slid``, ``flew`` (cases), ``largest_slip_m``,
    ``saved`` and ``felled`` (cases that overturn only without, and only with, sliding and flight).
    """
    outcomes = ["overturned", "overturned_without_sliding", "peak_slip_m", "flights"]
    parts = []
    for path in files:
        cases = pd.read_parquet(path, columns=["configuration", *outcomes])
        fell, fell_rough = cases["overturned"], cases["overturned_without_sliding"]
        each = cases[["configuration"]].assign(
            cases=1,
            slid=cases["peak_slip_m"] > 0,
            flew=cases["flights"] > 0,
            largest_slip_m=cases["peak_slip_m"],
            saved=fell_rough & ~fell,
            felled=fell & ~fell_rough,
        )
        parts.append(_added_up(each))
    return _added_up(pd.concat(parts, ignore_index=True))


def _added_up(table: pd.DataFrame) -> pd.DataFrame:
    how = dict.fromkeys(table.columns[1:], "sum") | {"largest_slip_m": "max"}
    return table.groupby("configuration", sort=False, as_index=False).agg(how)
