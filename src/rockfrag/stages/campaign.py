"""The tables of a campaign on a shake table, from the table of tests to comparisons.

In: a campaign study. Out: the tables that ``results/README.md`` lists for it. Theory: ``docs/campaigns.md``.
"""

import logging
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Flags
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.units import GRAVITY
from rockfrag.campaign import comparison, laboratory
from rockfrag.campaign.comparison import HALF, NEAR_CRITICAL, MeasuredTests
from rockfrag.campaign.laboratory import MEASURED, Campaign, read_campaign
from rockfrag.campaign.standing import Trials, sample_trials, simulate_tests
from rockfrag.fragility.vector import vector_tables
from rockfrag.motions.processing import process, scale_to_pga
from rockfrag.motions.pulses import commanded_cosine
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.records.sources.download import fetch_url
from rockfrag.records.velocity_steps import bump_and_stop
from rockfrag.simulation.inputs import STEPPED
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import PULSE_MEASURES, STEP_MEASURES, CampaignStudy
from rockfrag.study.holding import held_as_stated
from rockfrag.system.blocks import Block, Column
from rockfrag.system.mesh import Shape, read_shape

OURS, VOTES, IN_PLANE = "rockfrag", "rockfrag by votes", "rockfrag in one plane"
"""Who gave the simulated outcomes, the votes behind them, and planar ones beside those in space, in the tables."""

TABLES = (
    *("tests", "trials", "agreement", "rocking", "fragility"),
    *("regions", "conditioning", "contact", "footprint"),
    *("two_measures", "contours", "cells"),
)

VARIED_FRACTION = 4  # other conditionings are tried with this fraction of the trials
FEWEST_GROUPS = 2
# repetitions of a scan, with its noise, behind the limits of a critical angle
SCANS = 50


def run(job: Job[CampaignStudy]) -> Results:
    """Yield the tables of the campaign (``TABLES``), each as soon as it is there."""
    found = _Simulated(job)
    campaign, measured, mean = found.campaign, found.measured, found.votes.mean(axis=0)
    words = "%d tests under %d motions: %.1f %% of the outcomes right"
    as_measured = ((found.votes >= HALF) == measured.overturned).mean()
    job.log.info(
        words, len(campaign.tests), measured.groups.max() + 1, 100 * as_measured
    )
    judged = campaign.tests.assign(
        votes_to_overturn=mean,
        simulated=mean >= HALF,
        right=(mean >= HALF) == campaign.tests["overturned"],
        near_critical=(mean > NEAR_CRITICAL[0]) & (mean < NEAR_CRITICAL[1]),
    )
    yield "tests", judged
    right = (found.outcomes == measured.overturned).mean(axis=1)
    table = found.trials.table.assign(right_in_sample=right, plausible=found.plausible)
    best_first = table.sort_values("right_in_sample", ascending=False, kind="stable")
    yield "trials", best_first.reset_index(drop=True)
    yield "agreement", found.agreement()
    yield "rocking", found.rocking()
    yield "fragility", found.fragility()
    yield from found.two_measures()
    first, second = (*campaign.measures, campaign.measures[0])[:2]
    yield "regions", comparison.by_region(judged, first, second)
    yield "conditioning", found.conditioning()
    yield "contact", found.contact()
    yield "footprint", found.footprint()


def campaign_with_motions(
    study: CampaignStudy, log: logging.Logger
) -> tuple[Campaign, list[Motion | GroundMotion]]:
    """Read the tests and the motion of each, scaled where the table says so; log how many are left out.

    Parameters
    ----------
    study : with the files, and how motions are conditioned
    log : of the run

    Returns
    -------
    The tests, and a motion of the table for each.
    """
    for public in study.fetch:
        fetch_url(*public)
    campaign = read_campaign(
        study.tests, study.columns, study.measures, study.other_codes
    )
    if study.leave_out:
        absent = laboratory.missing_motions(
            study.motions, list(campaign.tests["motion"])
        )
        keep = ~campaign.tests["motion"].isin(absent).to_numpy()
        tests = campaign.tests[keep].reset_index(drop=True)
        codes = campaign.codes[keep].reset_index(drop=True)
        campaign = replace(campaign, tests=tests, codes=codes)
        log.info("%d tests without a motion are left out", len(absent))
        if campaign.tests.empty:
            raise InputError(
                f"{study.motions}: has no motion of any test of {study.tests.name}."
            )
    if campaign.tests["group"].nunique() < FEWEST_GROUPS:
        raise InputError(
            f"{study.tests}: its tests are of a single input motion; give those of two or more, as guesses are "
            "chosen by the tests of some and judged by those of others."
        )
    motions = _motions(study, campaign, study.conditioning)
    measured = [motion for motion in motions if isinstance(motion, Motion)]
    if not campaign.measures:
        tests = campaign.tests.join(laboratory.measured_peaks(measured))
        campaign = replace(campaign, tests=tests, measures=("pga_g", "pgv_cm_s"))
    elif study.motions and campaign.tests["amplitude_g"].isna().all():
        laboratory.check_peaks(campaign.tests, measured, study.motions)
    return campaign, motions


def _motions(
    study: CampaignStudy, campaign: Campaign, conditioning: Any
) -> list[Motion | GroundMotion]:
    """Motion of the table in each test, conditioned, and scaled where the table of tests says so."""
    tests = campaign.tests
    if study.is_stepped:
        jumps = [bump_and_stop(*pair) for pair in tests[list(STEP_MEASURES)].to_numpy()]
        return [
            GroundMotion(Motion(np.zeros(2), STEPPED), steps=each) for each in jumps
        ]
    if study.pulse_cycles:
        settings = tests[list(PULSE_MEASURES)].to_numpy()
        recorded = [
            commanded_cosine(a * GRAVITY, ratio, study.pulse_cycles)
            for a, ratio in settings
        ]
        return [process(motion, conditioning) for motion in recorded]
    motions = laboratory.table_motions(
        study.motions, list(tests["motion"]), *study.unstated
    )
    shaken = (process(motion, conditioning) for motion in motions)
    each = zip(shaken, tests["amplitude_g"], strict=True)
    return [
        motion if np.isnan(peak) else scale_to_pga(motion, peak)
        for motion, peak in each
    ]


def standing_object(study: CampaignStudy) -> Shape | Block | Column:
    """Return the object, and what is under it if it has a pedestal."""
    if "pedestal" not in study.object:
        return object_of(study)
    return Column(
        tuple(map(_block, (*reversed(study.object["pedestal"]), study.object)))
    )


def trials_of(
    thing: Shape | Block | Column, study: CampaignStudy, count: int
) -> Trials:
    """Return trials that fill the study's ranges, held as the study says."""
    trials = sample_trials(thing, study.unknowns, count, study.seed)
    if "held" not in study.object:
        return trials
    held = study.object["held"]
    # the planar body, a rival of a mesh in space, is held as that is
    with errors_of("object: held"):
        systems = tuple(held_as_stated(each, held) for each in trials.systems)
        planar = tuple(held_as_stated(each, held) for each in trials.planar)
    return replace(trials, systems=systems, planar=planar)


def object_of(study: CampaignStudy) -> Shape | Block:
    """Return the object: a shape from its mesh, or the planar block given by hand."""
    given = study.object
    if study.mesh is not None:
        return read_shape(
            study.mesh,
            mass=given.get("mass_kg"),
            density=given.get("density_kg_m3"),
            metres_per_unit=given.get("metres_per_unit", 1.0),
        )
    return _block(given)


def _block(given: Mapping[str, Any]) -> Block:
    """The planar block that a study gives by hand."""
    return Block.from_edges(
        given["left_m"],
        given["right_m"],
        cg_height=given["cg_height_m"],
        height=given["height_m"],
        mass=given["mass_kg"],
        inertia=given["inertia_kg_m2"],
    )


def measured_tests(study: CampaignStudy, campaign: Campaign) -> MeasuredTests:
    """Outcomes of the laboratory, to be compared as the study says."""
    tests = campaign.tests
    return MeasuredTests(
        tests[MEASURED].to_numpy(),
        pd.factorize(tests["group"])[0],
        study.seed,
        study.folds,
        study.repeats,
        study.confidence,
    )


class _Simulated:
    """A campaign whose tests were simulated, each method a table of it."""

    def __init__(self, job: Job[CampaignStudy]) -> None:
        self.job, study = job, job.study
        self.campaign, self.motions = campaign_with_motions(study, job.log)
        self.thing = standing_object(study)
        self.trials = trials_of(self.thing, study, study.trials)
        # whether the object overturned, and whether anything rocked, shape (trials, tests)
        self.outcomes, self.rocked = simulate_tests(
            self.trials.systems, self.motions, job.threads
        )
        self.measured = measured_tests(study, self.campaign)
        # of plausible trials, chosen by tests with other motions, shape (repeats, tests)
        self.votes = self.measured.cross_validate(self.outcomes)

    @property
    def plausible(self) -> Flags:
        """Trials that agree with all tests about as well as the best, in sample: shows where they lie only."""
        right = self.outcomes == self.measured.overturned
        return comparison.plausible_trials(right, self.measured.groups)

    def agreement(self) -> pd.DataFrame:
        """Say how often the simulation is right, and every rival: thresholds on measures, other codes, repeats.

        Returns
        -------
        A row each: ``who``; ``right``, the fraction of right outcomes, with ``lower`` and ``upper``;
            ``false_alarms`` and ``missed``, numbers of tests; ``tests``; of rivals ``better``, by how much the
            simulation is right more often, with limits and ``p`` (:meth:`MeasuredTests.lead`); ``judged``, by
            which tests the rival was chosen.
        """
        tests, measures = self.campaign.tests, self.campaign.measures
        rivals = {}
        if self.trials.planar:
            flat, _ = simulate_tests(self.trials.planar, self.motions, self.job.threads)
            rivals[IN_PLANE] = self.measured.cross_validate(flat) >= HALF
        for name in measures:
            rivals[f"threshold on {name}"] = self.measured.by_threshold(
                tests[name].to_numpy()
            )
        if len(measures) > 1:
            both = tests[list(measures[:2])].to_numpy()
            rivals[f"probit on {' and '.join(measures[:2])}"] = (
                self.measured.by_threshold(both)
            )
        shaken = tests["motion"].to_numpy()
        majority = comparison.majority_of_repeats(shaken, self.measured.overturned)
        if majority is not None:
            rivals[comparison.REPEATS] = majority
        codes = {
            f"code {name}": given.to_numpy()
            for name, given in self.campaign.codes.items()
        }
        # more than half of the plausible trials say that it overturns
        rows = [self.measured.agreement(OURS, self.votes >= HALF)]
        rows += [
            self._beside(name, given) for name, given in {**rivals, **codes}.items()
        ]
        judged = dict.fromkeys(codes, "as given")
        judged[comparison.REPEATS] = "by repeats of the same test"
        table = pd.DataFrame(rows)
        return table.assign(judged=table["who"].map(judged).fillna("by other motions"))

    def _beside(self, name: str, outcomes: Any) -> dict[str, object]:
        """Agreement of a rival, and how much better the simulation is on the tests of which it says something.

        Parameters
        ----------
        name : of the rival
        outcomes : True or 1 where a test overturns, shape (tests,) or (repeats, tests); NaN where nothing is said
        """
        each = np.atleast_2d(outcomes)
        given = ~np.isnan(each.astype(float)).any(axis=0)
        theirs, measured = each[:, given].astype(bool), self.measured.only(given)
        number_of_groups = measured.groups.max(initial=-1) + 1
        if number_of_groups < FEWEST_GROUPS:
            raise InputError(
                f"{name}: its tests are of a single input motion; give those of two or more."
            )
        lead = measured.lead(self.votes[:, given] >= HALF, theirs)
        return measured.agreement(name, theirs) | lead

    def rocking(self) -> pd.DataFrame:
        """How often it is predicted right whether the object rocked; no row where no laboratory noted it.

        The trials that predict overturning best on other motions say of each test whether it rocked.
        """
        noted = self.campaign.tests.get("rocked")
        if noted is None:
            numbers = ["right", "lower", "upper", "false_alarms", "missed", "tests"]
            return pd.DataFrame(columns=["who", *numbers])
        rocked = self.measured.cross_validate(self.outcomes, self.rocked) >= HALF
        noted_tests = replace(self.measured, overturned=noted.to_numpy())
        return pd.DataFrame([noted_tests.agreement(OURS, rocked)])

    def fragility(self) -> pd.DataFrame:
        """Lognormal curves of measured and simulated outcomes in every measure."""
        votes = self.votes.mean(axis=0)
        parts = []
        for name in self.campaign.measures:
            measure = self.campaign.tests[name].to_numpy()
            curves = self.measured.fragility(
                measure, {OURS: votes >= HALF, VOTES: votes}
            )
            parts.append(curves.assign(measure=name))
        return pd.concat(parts, ignore_index=True)

    def two_measures(self) -> Results:
        """Fragility in the first two measures, of the outcomes measured and simulated."""
        tests = self.campaign.tests
        ours = self.votes.mean(axis=0) >= HALF
        outcomes = {"measured": self.measured.overturned, OURS: ours}
        pair = self.campaign.measures[:2]
        found = vector_tables(
            {
                name: tests.assign(**{MEASURED: fell * 1.0})
                for name, fell in outcomes.items()
            },
            ((pair[0], pair[1]),) if len(pair) == len(set(pair)) == 2 else (),
            earthquake="group",
            # no IDA curve: each test has a capacity of its own
            motion=None,
            level=self.measured.level,
            seed=self.measured.seed,
        )
        tables = (found.fits, found.contours, found.cells)
        yield from zip(("two_measures", "contours", "cells"), tables, strict=True)

    def conditioning(self) -> pd.DataFrame:
        """What other ways of conditioning the motions would have given, with a part of the trials."""
        study, measured = self.job.study, self.measured
        as_configured = measured.agreement("as configured", self.votes >= HALF)
        rows = [as_configured | {"trials": study.trials}]
        fewer = max(16, study.trials // VARIED_FRACTION)
        trials = trials_of(self.thing, study, fewer)
        for name, steps in {
            "as configured, fewer trials": study.conditioning,
            **study.varied_conditioning,
        }.items():
            motions = _motions(study, self.campaign, steps)
            outcomes, _ = simulate_tests(trials.systems, motions, self.job.threads)
            votes = measured.cross_validate(outcomes)
            rows.append(measured.agreement(name, votes >= HALF) | {"trials": fewer})
            self.job.log.info("conditioning %s", name)
        return pd.DataFrame(rows).rename(columns={"who": "conditioning"})

    def contact(self) -> pd.DataFrame:
        """How base and outcomes depend on the contact tolerance; the critical angle with scans repeated."""
        columns = [
            *(
                "contact_tolerance_mm",
                "worst_direction_deg",
                "alpha_deg",
                "alpha_lower_deg",
            ),
            *("alpha_upper_deg", "trials", "width_m", "overturned", "right"),
        ]
        thing, study, trials = self.thing, self.job.study, self.trials.table
        if not isinstance(thing, Shape):
            return pd.DataFrame(columns=columns, dtype=float)
        tolerances = np.geomspace(*study.unknowns["contact_tolerance_mm"], 8)
        scan = study.object.get("scan_tolerance_mm", 0.0) / 1e3
        rng = np.random.default_rng(study.seed)
        tried = trials["contact_tolerance_mm"].to_numpy()
        nearest = np.abs(np.log(tried[:, None] / tolerances)).argmin(axis=1)
        width = (trials["left_m"] + trials["right_m"]).to_numpy()
        rows = []
        for number, tolerance in enumerate(tolerances):
            direction, angle = _worst_direction(thing, tolerance)
            if np.isnan(angle):
                continue
            scans = [
                thing.scanned_again(scan, rng) for _ in range(SCANS if scan else 0)
            ]
            angles = [_worst_direction(shape, tolerance)[1] for shape in scans] or [
                angle
            ]
            limits = np.degrees(np.nanquantile(angles, [0.05, 0.95]))
            near = nearest == number
            found = [0, *[float("nan")] * 3]
            if near.any():
                right = (self.outcomes[near] == self.measured.overturned).mean()
                found = [
                    near.sum(),
                    width[near].mean(),
                    self.outcomes[near].mean(),
                    right,
                ]
            rows.append([tolerance, direction, np.degrees(angle), *limits, *found])
        return pd.DataFrame(rows, columns=columns)

    def footprint(self) -> pd.DataFrame:
        """Seen from above, about the centre of gravity: outline, and what carries at plausible tolerances."""
        columns = ["what", "contact_tolerance_mm", "x_m", "y_m"]
        if not isinstance(self.thing, Shape):
            return pd.DataFrame(columns=columns)
        likely = self.trials.table.loc[self.plausible, "contact_tolerance_mm"]
        rows = [("outline", float("nan"), *corner) for corner in self.thing.outline]
        for name, fraction in (
            ("contact, low", 0.05),
            ("contact", 0.5),
            ("contact, high", 0.95),
        ):
            tolerance = float(likely.quantile(fraction))
            carries = self.thing.contact_polygon(tolerance / 1e3)
            rows += [(name, tolerance, *corner) for corner in carries]
        return pd.DataFrame(rows, columns=columns)


def _worst_direction(shape: Shape, tolerance_mm: float) -> tuple[float, float]:
    """Direction of the least critical angle, and that angle [degrees]; NaN where the shape cannot stand."""
    try:
        return shape.worst_direction(tolerance_mm / 1e3)
    except InputError:
        return float("nan"), float("nan")
