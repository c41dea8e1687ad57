"""The tables of a campaign on a shake table, from the table of tests to comparisons."""

import logging
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.campaign import comparison
from rockfrag.campaign.outcomes import simulate_tests
from rockfrag.campaign.table_motions import (
    check_peaks,
    measured_peaks,
    missing_motions,
    table_motions,
)
from rockfrag.campaign.tests import MEASURED, Campaign, read_campaign
from rockfrag.campaign.trials import Trials, sample_trials
from rockfrag.campaign.validation import Validated, cross_validate, plausible_trials
from rockfrag.errors import InputError
from rockfrag.fragility.vector_tables import VectorTables, vector_tables
from rockfrag.motions.processing import process
from rockfrag.motions.pulses import commanded_cosine
from rockfrag.motions.scaling import scale_to_pga
from rockfrag.records.motion import Motion
from rockfrag.records.sources.wheel import fetch_url
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import PULSE_MEASURES, CampaignStudy
from rockfrag.system.blocks import Block, Column
from rockfrag.system.mesh import Shape, read_shape
from rockfrag.units import GRAVITY

OURS, VOTES, IN_PLANE = "rockfrag", "rockfrag by votes", "rockfrag in one plane"
"""Who gave the simulated outcomes, the votes behind them, and planar ones beside those in space, in the tables."""

TABLES = (
    *("tests", "trials", "agreement", "rocking", "fragility"),
    *("regions", "conditioning", "contact", "footprint"),
    *("two_measures", "contours", "cells"),
)

VARIED_FRACTION = 4
"""Other conditionings are tried with this fraction of the trials: they only show what the choice does."""
REPLICATES = 400
FEWEST_GROUPS = 2


def run(job: Job[CampaignStudy]) -> Results:
    """Yield the tables of the campaign (``TABLES``), each as soon as it is there."""
    study = job.study
    campaign, motions = campaign_with_motions(study, job.log)
    thing = standing_object(study)
    trials = sample_trials(thing, study.unknowns, study.trials, study.seed)
    outcomes, rocked = simulate_tests(trials.systems, motions, job.threads)
    tests = campaign.tests
    measured = tests[MEASURED].to_numpy()
    groups = pd.factorize(tests["group"])[0]
    validated = cross_validate(outcomes, measured, groups, **study.division)
    job.log.info(
        "%d tests under %d motions: %.1f %% of the outcomes right",
        len(tests), groups.max() + 1, 100 * (validated.outcomes == measured).mean(),
    )  # fmt: skip
    yield "tests", comparison.judged_tests(tests, validated, measured)
    yield "trials", _judged_trials(trials, outcomes, measured, groups)
    plane = None
    if trials.planar:
        flat, _ = simulate_tests(trials.planar, motions, job.threads)
        plane = cross_validate(flat, measured, groups, **study.division)
    yield "agreement", _agreement(study, campaign, validated, plane, groups)
    yield "rocking", _rocking(study, campaign, outcomes, rocked, groups)
    yield "fragility", _fragility(study, campaign, validated, groups)
    both = _two_measures(study, campaign, validated)
    yield "two_measures", both.fits
    yield "contours", both.contours
    yield "cells", both.cells
    first, second = (*campaign.measures, campaign.measures[0])[:2]
    yield "regions", comparison.by_region(tests, first, second, validated.outcome, measured)
    yield "conditioning", _conditioning(job, campaign, thing, validated, groups)
    yield "contact", _contact(study, thing, trials, outcomes, measured)
    yield "footprint", _footprint(study, thing, trials, outcomes == measured, groups)


def campaign_with_motions(
    study: CampaignStudy, log: logging.Logger
) -> tuple[Campaign, list[Motion]]:
    """Read the tests and the motion of each, scaled where the table says so; log how many are left out."""
    for public in study.fetch:
        fetch_url(public.url, public.sha256, public.path)
    campaign = read_campaign(study.tests, study.columns, study.measures, study.other_codes)
    if study.leave_out:
        absent = missing_motions(study.motions, list(campaign.tests["motion"]))
        campaign = campaign.only(~campaign.tests["motion"].isin(absent))
        log.info("%d tests without a motion are left out", len(absent))
        if campaign.tests.empty:
            raise InputError(f"{study.motions}: has no motion of any test of {study.tests.name}.")
    if campaign.tests["group"].nunique() < FEWEST_GROUPS:
        raise InputError(
            f"{study.tests}: its tests are of a single input motion; give those of two or more, as guesses are "
            "chosen by the tests of some and judged by those of others."
        )
    motions = _motions(study, campaign, study.conditioning)
    if not campaign.measures:
        campaign = Campaign(
            campaign.tests.join(measured_peaks(motions)), ("pga_g", "pgv_cm_s"), campaign.codes
        )
    elif not study.pulse_cycles and campaign.tests["amplitude_g"].isna().all():
        check_peaks(campaign.tests, motions, study.motions)
    return campaign, motions


def _motions(study: CampaignStudy, campaign: Campaign, conditioning: Any) -> list[Motion]:
    if study.pulse_cycles:
        settings = campaign.tests[list(PULSE_MEASURES)].to_numpy()
        return [
            process(commanded_cosine(a * GRAVITY, ratio, study.pulse_cycles), conditioning)
            for a, ratio in settings
        ]
    motions = table_motions(
        study.motions,
        list(campaign.tests["motion"]),
        unit=study.unit,
        dt=study.dt_s,
        channel=study.channel,
        conditioning=conditioning,
    )
    peaks = campaign.tests["amplitude_g"]
    return [
        motion if np.isnan(peak) else scale_to_pga(motion, peak)
        for motion, peak in zip(motions, peaks, strict=True)
    ]


def standing_object(study: CampaignStudy) -> Shape | Block | Column:
    """Return the object, and what is under it if it has a pedestal."""
    if "pedestal" not in study.object:
        return object_of(study)
    return Column(
        tuple(_block(given) for given in (*reversed(study.object["pedestal"]), study.object))
    )


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
    return Block.from_edges(
        given["left_m"],
        given["right_m"],
        cg_height=given["cg_height_m"],
        height=given["height_m"],
        mass=given["mass_kg"],
        inertia=given["inertia_kg_m2"],
    )


def _judged_trials(trials: Trials, outcomes: Any, measured: Any, groups: Any) -> pd.DataFrame:
    """Trials with their agreement over all tests: in sample, so it only shows where the plausible ones lie."""
    right = outcomes == measured
    shown = {"right_in_sample": right.mean(axis=1), "plausible": plausible_trials(right, groups)}
    table = trials.table.assign(**shown)
    return table.sort_values("right_in_sample", ascending=False, kind="stable", ignore_index=True)


def _agreement(
    study: CampaignStudy,
    campaign: Campaign,
    validated: Validated,
    plane: Validated | None,
    groups: Any,
) -> pd.DataFrame:
    """Who is right how often: simulations, thresholds on measures, other codes; each compared with ours."""
    tests, level = campaign.tests, study.confidence
    measured = tests[MEASURED].to_numpy()
    rivals = {} if plane is None else {IN_PLANE: plane.outcomes}
    for name in campaign.measures:
        rivals[f"threshold on {name}"] = comparison.cross_validated_threshold(
            tests[name].to_numpy(), measured, groups, **study.division
        )
    if len(campaign.measures) > 1:
        both = list(campaign.measures[:2])
        rivals[f"probit on {' and '.join(both)}"] = comparison.cross_validated_threshold(
            tests[both].to_numpy(), measured, groups, **study.division
        )
    codes = {f"code {name}": campaign.codes[name].to_numpy() for name in campaign.codes}
    rows = [comparison.agreement_row(OURS, validated.outcomes, measured, groups, level)]
    if (
        majority := comparison.majority_of_repeats(tests["motion"].to_numpy(), measured)
    ) is not None:
        rivals[comparison.REPEATS] = majority
    ours = np.atleast_2d(validated.outcomes)
    for name, outcomes in {**rivals, **codes}.items():
        # other programs may have done a part of the tests only: all are compared on that part
        given = ~np.isnan(np.atleast_2d(outcomes).astype(float)).any(axis=0)
        theirs = np.atleast_2d(outcomes)[:, given].astype(bool)
        own_groups = pd.factorize(groups[given])[0]
        if own_groups.max(initial=0) < 1:
            raise InputError(
                f"{name}: its tests are of a single input motion; give those of two or more."
            )
        row = comparison.agreement_row(name, theirs, measured[given], own_groups, level)
        row |= comparison.paired_row(
            ours[:, given], theirs, measured[given], own_groups, level, study.seed
        )
        rows.append(row)
    table = pd.DataFrame(rows)
    judged = dict.fromkeys(codes, "as given") | {comparison.REPEATS: "by repeats of the same test"}
    table["judged"] = table["who"].map(judged).fillna("by other motions")
    return table


def _rocking(
    study: CampaignStudy, campaign: Campaign, outcomes: Any, rocked: Any, groups: Any
) -> pd.DataFrame:
    """Whether the object rocked, where the laboratory noted it: trials chosen by overturning vote on it."""
    if "rocked" not in campaign.tests:
        columns = ["who", "right", "lower", "upper", "false_alarms", "missed", "tests"]
        return pd.DataFrame(columns=columns)
    measured, noted = (campaign.tests[name].to_numpy() for name in (MEASURED, "rocked"))
    found = cross_validate(outcomes, measured, groups, asked=rocked, **study.division)
    row = comparison.agreement_row(OURS, found.outcomes, noted, groups, study.confidence)
    return pd.DataFrame([row])


def _fragility(
    study: CampaignStudy, campaign: Campaign, validated: Validated, groups: Any
) -> pd.DataFrame:
    measured = campaign.tests[MEASURED].to_numpy()
    parts = [
        comparison.fragility_beside(
            campaign.tests[name].to_numpy(),
            measured,
            {OURS: validated.outcome, VOTES: validated.mean_votes},
            groups,
            level=study.confidence,
            replicates=REPLICATES,
            seed=study.seed,
        ).assign(measure=name)
        for name in campaign.measures
    ]
    return pd.concat(parts, ignore_index=True)


def _two_measures(study: CampaignStudy, campaign: Campaign, validated: Validated) -> VectorTables:
    """Fragility in the first two measures, of the outcomes measured and simulated."""
    tests = campaign.tests.assign(**{MEASURED: campaign.tests[MEASURED].astype(float)})
    simulated = tests.assign(**{MEASURED: validated.outcome.astype(float)})
    pair = campaign.measures[:2]
    return vector_tables(
        {"measured": tests, OURS: simulated},
        ((pair[0], pair[1]),) if len(pair) == len(set(pair)) == 2 else (),
        earthquake="group",
        # no IDA curve: each test has a capacity of its own
        motion=None,
        level=study.confidence,
        seed=study.seed,
    )


def _conditioning(
    job: Job[CampaignStudy], campaign: Campaign, thing: Any, validated: Validated, groups: Any
) -> pd.DataFrame:
    """What other ways of conditioning the motions would have given, with a part of the trials."""
    study = job.study
    measured = campaign.tests[MEASURED].to_numpy()
    about = (measured, groups, study.confidence)
    as_configured = comparison.agreement_row("as configured", validated.outcomes, *about)
    rows = [as_configured | {"trials": study.trials}]
    fewer = max(16, study.trials // VARIED_FRACTION)
    trials = sample_trials(thing, study.unknowns, fewer, study.seed)
    for name, steps in {
        "as configured, fewer trials": study.conditioning,
        **study.varied_conditioning,
    }.items():
        outcomes, _ = simulate_tests(trials.systems, _motions(study, campaign, steps), job.threads)
        found = cross_validate(outcomes, measured, groups, **study.division)
        rows.append(comparison.agreement_row(name, found.outcomes, *about) | {"trials": fewer})
        job.log.info("conditioning %s", name)
    return pd.DataFrame(rows).rename(columns={"who": "conditioning"})


SCANS = 50


def _contact(
    study: CampaignStudy,
    thing: Shape | Block | Column,
    trials: Trials,
    outcomes: Any,
    measured: Any,
) -> pd.DataFrame:
    """How base and outcomes depend on the contact tolerance; the critical angle with scans repeated."""
    columns = ["contact_tolerance_mm", "worst_direction_deg", "alpha_deg", "alpha_lower_deg"]
    columns += ["alpha_upper_deg", "trials", "width_m", "overturned", "right"]
    if not isinstance(thing, Shape):
        return pd.DataFrame(columns=columns, dtype=float)
    low, high = study.unknowns["contact_tolerance_mm"]
    scan = study.object.get("scan_tolerance_mm", 0.0) / 1e3
    rng = np.random.default_rng(study.seed)
    rows, tolerances = [], np.geomspace(low, high, 8)
    tried = trials.table["contact_tolerance_mm"].to_numpy()
    nearest = np.abs(np.log(tried[:, None] / tolerances)).argmin(axis=1)
    width = (trials.table["left_m"] + trials.table["right_m"]).to_numpy()
    for number, tolerance in enumerate(tolerances):
        try:
            direction, angle = thing.worst_direction(tolerance / 1e3)
        except InputError:
            continue
        scans = range(SCANS if scan else 0)
        angles = [_worst_angle(thing.scanned_again(scan, rng), tolerance) for _ in scans] or [angle]
        limits = np.degrees(np.nanquantile(angles, [0.05, 0.95]))
        near = nearest == number
        found = [0, *[float("nan")] * 3]
        if near.any():
            right = (outcomes[near] == measured).mean()
            found = [near.sum(), width[near].mean(), outcomes[near].mean(), right]
        rows.append([tolerance, direction, np.degrees(angle), *limits, *found])
    return pd.DataFrame(rows, columns=columns)


def _footprint(
    study: CampaignStudy, thing: Shape | Block | Column, trials: Trials, right: Any, groups: Any
) -> pd.DataFrame:
    """Seen from above, about the centre of gravity: outline, and what carries within the plausible tolerances."""
    columns = ["what", "contact_tolerance_mm", "x_m", "y_m"]
    if not isinstance(thing, Shape):
        return pd.DataFrame(columns=columns)
    likely = trials.table.loc[plausible_trials(right, groups), "contact_tolerance_mm"]
    rows = [("outline", float("nan"), *corner) for corner in thing.outline]
    for name, fraction in (("contact, low", 0.05), ("contact", 0.5), ("contact, high", 0.95)):
        tolerance = float(likely.quantile(fraction))
        carries = thing.contact_polygon(tolerance / 1e3)
        rows += [(name, tolerance, *corner) for corner in carries]
    return pd.DataFrame(rows, columns=columns)


def _worst_angle(shape: Shape, tolerance_mm: float) -> float:
    try:
        return shape.worst_direction(tolerance_mm / 1e3)[1]
    except InputError:
        return float("nan")
