"""Blind probabilities of every test of campaigns, scored beside engineers' rules and others' measured curves.

    python -m rockfrag.stages.scores config/granite.yaml config/oxford.yaml --tests bare.csv --page docs/scores.md

prints a table for each campaign and writes a page that says which rule is better and which is not. No outcome of a
campaign is used for what is said of it, but for the curves of others. Tests of an object of which nobody wrote
down shape or size (``--tests``) can be predicted by the curves of others alone.
"""

import argparse
import logging
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.stats import norm

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file
from rockfrag.base.tabular import read_rows
from rockfrag.base.units import GRAVITY
from rockfrag.campaign.comparison import MeasuredTests
from rockfrag.campaign.scores import said_of_arrangements, scores_table
from rockfrag.campaign.standing import (
    BATCH,
    Trials,
    body_of,
    draw_arrangements,
    kind_of,
    simulate_in_space,
    solids_of,
    uniform,
    unknowns_of,
)
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.fragility.observations import Observations
from rockfrag.motions.intensity import pgv
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.records.velocity_steps import VelocitySteps
from rockfrag.runtime.progress import sign_of_life
from rockfrag.simulation.ensemble import LightBodies, overturns
from rockfrag.simulation.rules_of_thumb import (
    Rule,
    asce_43,
    kaneko,
    peak_velocity,
    static,
)
from rockfrag.stages.campaign import campaign_with_motions, measured_tests, object_of
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import load_any
from rockfrag.system.blocks import Block
from rockfrag.system.mesh import Shape

OURS = "rockfrag, in the plane"
WITHOUT_ERROR = "rockfrag, in the plane, without error of the model"
IN_SPACE = "rockfrag, in space"
IN_SPACE_WITHOUT = "rockfrag, in space, without error of the model"
RULES: Mapping[str, Rule] = {
    "ASCE 43-05": asce_43,
    "Kaneko": kaneko,
    "peak velocity g α/p": peak_velocity,
    "static b/h": static,
}
"""Rules by name; each says a median, about which β is taken as :data:`BETA`."""

BETA = 0.4
ARRANGEMENTS = 128  # in which an object may stand
SOLID = 32  # of them at most, in which a scan is simulated in space
RULED = 12  # of them, that rules are asked about
SHORT = (
    5e-4  # half the duration of the accelerations that stand for a jump, for rules [s]
)

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class Tests:
    """Tests of a campaign with their motions, and what rules look at."""

    study: CampaignStudy
    thing: Shape | Block
    motions: Sequence[Motion | GroundMotion]
    measured: MeasuredTests
    count: int  # arrangements that are drawn

    @cached_property
    def ruled(self) -> list[Motion]:
        """Motions as accelerations."""
        return [as_accelerations(motion) for motion in self.motions]

    @property
    def peaks(self) -> Floats:
        """PGV of the motions [m/s]."""
        return np.array([pgv(motion) for motion in self.ruled])

    def arrangements(self) -> Trials:
        """Arrangements in which the object may stand, by what was assumed before any outcome was used."""
        return arrangements_of(self.study, self.thing, self.count)


def nodes(count: int) -> Floats:
    """Errors of the model of equal probability, which have mean 0 and standard deviation 1."""
    found = norm.ppf((np.arange(count) + 0.5) / count)
    return np.asarray(found / found.std())


def arrangements_of(study: CampaignStudy, thing: Shape | Block, count: int) -> Trials:
    """Arrangements in which the object of a campaign may stand, before any of its outcomes is used.

    Parameters
    ----------
    study, thing, count : the campaign, its object, and how many are drawn

    Returns
    -------
    The :class:`rockfrag.campaign.standing.Trials`.
    """
    unknowns = unknowns_of(kind_of(thing), study.object.get("scan_tolerance_mm"))
    if "size" in study.unknowns:
        # a block of which nobody wrote down the size: that, and no more, is not known
        ranges = {name: study.unknowns[name] for name in ("size", "edge_retreat_mm")}
        unknowns |= {name: uniform(*ends) for name, ends in ranges.items()}
    return draw_arrangements(thing, unknowns, count, study.seed)


def as_accelerations(motion: Motion | GroundMotion) -> Motion:
    """A motion without jumps: each becomes a triangle of a millisecond."""
    if isinstance(motion, Motion):
        return motion
    if motion.steps is None:
        return motion.x
    return _triangles(motion.steps)


def _triangles(steps: VelocitySteps) -> Motion:
    """Accelerations [m/s²] of the horizontal jumps of a still ground, with a second after them.

    A jump is one sample, a triangle as high as the jump over the sampling interval, a millisecond.
    """
    # a sample is left before a jump at the start, from which its triangle rises
    places = np.rint(steps.times / SHORT).astype(int) + 1
    samples = np.zeros(int(places[-1]) + round(1 / SHORT))
    np.add.at(samples, places, steps.horizontal / SHORT)
    return Motion(samples, SHORT)


def simulated(tests: Tests, arrangements: Trials, error: float) -> Floats:
    """Probability of each test by planar simulation, with an error of the model of ln level [-].

    Parameters
    ----------
    tests, arrangements, error : the tests, arrangements, and standard deviation [-]

    Returns
    -------
    Probabilities, shape (tests,).
    """
    scales = np.exp(-error * nodes(5)) if error > 0 else np.ones(1)
    parts = []
    for first in range(0, len(tests.motions), BATCH):
        batch = tests.motions[first : first + BATCH]
        with warnings.catch_warnings():
            # as in what is said blind of campaigns: pure rocking holds the contact
            warnings.simplefilter("ignore", LightBodies)
            fell = overturns(
                arrangements.systems, batch, scales=scales, threads=1
            ).overturned
        parts.append(np.moveaxis(fell, 2, 1).reshape(-1, len(batch)))
    return said_of_arrangements(np.hstack(parts))


def simulated_in_space(
    tests: Tests, arrangements: Trials, count: int, error: float
) -> tuple[Floats, Floats]:
    """Probability of each test in space, in some arrangements, with an error of the model and without.

    Parameters
    ----------
    tests, arrangements, count, error : the tests, arrangements, how many of them, and standard deviation [-]

    Returns
    -------
    Probabilities, shape (tests,) each.
    """
    assert isinstance(tests.thing, Shape)
    systems = solids_of(tests.thing, arrangements, count)
    errors = nodes(3)
    scales = np.exp(-error * errors).tolist()
    fell = simulate_in_space(systems, tests.ruled, scales, threads=1)
    all_errors = np.moveaxis(fell, 2, 1).reshape(-1, fell.shape[1])
    # the middle one is no error
    return said_of_arrangements(all_errors), said_of_arrangements(fell[..., 1])


def said_by_rules(tests: Tests, arrangements: Trials) -> Iterator[tuple[str, Floats]]:
    """Yield for each rule its probability of each test, a mean over arrangements."""
    table = arrangements.table
    blocks = []
    for _, row in table.iloc[:: max(1, len(table) // RULED)].iterrows():
        guess = {str(name): float(value) for name, value in row.items()}
        blocks.append(body_of(tests.thing, guess).blocks[-1])
    motions = tests.ruled
    for name, rule in RULES.items():
        factors = np.array(
            [[rule(block, motion) for motion in motions] for block in blocks]
        )
        yield name, norm.cdf(-np.log(factors) / BETA).mean(axis=0)


def curve_of(peaks: Floats, measured: MeasuredTests) -> tuple[float, float]:
    """Measured median PGV and dispersion of a campaign.

    Parameters
    ----------
    peaks, measured : PGV of the tests [m/s], and their outcomes

    Returns
    -------
    Median [m/s] and dispersion [-].
    """
    groups = measured.groups.astype(object)
    fell = measured.overturned.astype(float)
    fit = fit_lognormal(Observations(peaks, fell, np.ones(fell.size), groups, groups))
    return fit.theta, fit.beta


def said_of(
    name: str,
    campaigns: Mapping[str, Tests],
    in_space: int,
    bare: Mapping[str, tuple[float, float]],
) -> dict[str, Floats]:
    """What everybody says of the tests of a campaign, ours first.

    Parameters
    ----------
    name, campaigns : the campaign, and all of them by name
    in_space : arrangements in which scans are simulated in space; 0 for none
    bare : median PGV [m/s] and dispersion of objects without shape or size, by name

    Returns
    -------
    Probabilities by who says them, shape (tests,) each.
    """
    tests = campaigns[name]
    arrangements = tests.arrangements()
    error = MODEL_ERRORS[kind_of(tests.thing)].beyond
    said: dict[str, Floats] = {}
    if in_space and isinstance(tests.thing, Shape):
        found = simulated_in_space(tests, arrangements, in_space, error)
        said[IN_SPACE], said[IN_SPACE_WITHOUT] = found
    said[OURS] = simulated(tests, arrangements, error)
    said[WITHOUT_ERROR] = simulated(tests, arrangements, 0.0)
    said |= dict(said_by_rules(tests, arrangements))
    curves = {
        other: curve_of(others.peaks, others.measured)
        for other, others in campaigns.items()
        if other != name
    }
    return said | said_by_curves(tests.peaks, {**curves, **bare})


def said_by_curves(
    peaks: Floats, curves: Mapping[str, tuple[float, float]]
) -> dict[str, Floats]:
    """What measured curves of other objects say of tests, by whose they are.

    Parameters
    ----------
    peaks, curves : PGV of the tests [m/s], and medians and dispersions by name

    Returns
    -------
    Probabilities, shape (tests,) each.
    """
    return {
        f"measured curve of {name}": norm.cdf(np.log(peaks / theta) / beta)
        for name, (theta, beta) in curves.items()
    }


@dataclass(frozen=True)
class BareTests:
    """Tests of an object of which nobody wrote down shape or size.

    Attributes
    ----------
    peaks, measured : PGV of each test [m/s], and what was seen
    """

    peaks: Floats
    measured: MeasuredTests


def bare_tests(file: str) -> BareTests:
    """Tests of a table with ``pga_g``, ``pgv_over_pga_s`` and ``toppled``; those of one motion belong together.

    Parameters
    ----------
    file : its name

    Returns
    -------
    The :class:`BareTests`.
    """
    rows = read_rows(file, ["pga_g", "pgv_over_pga_s", "toppled"], ["time"])
    each = [
        (row.number("pga_g", 0.0), row.number("pgv_over_pga_s", 0.0)) for row in rows
    ]
    fell = np.array([row.text("toppled").lower() in ("yes", "1") for row in rows])
    groups = pd.factorize(pd.MultiIndex.from_tuples(each))[0]
    peaks = GRAVITY * np.array(each).prod(axis=1)
    return BareTests(peaks, MeasuredTests(fell, groups.astype(np.int64), seed=1))


def tables_of(
    campaigns: Mapping[str, Tests], bare: Mapping[str, BareTests], in_space: int
) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield the scores of each campaign, and of tests without an object.

    Parameters
    ----------
    campaigns, bare : tests by name, of objects that are known and of others
    in_space : arrangements in which scans are simulated in space; 0 for none
    """
    curves = {name: curve_of(each.peaks, each.measured) for name, each in bare.items()}
    for name, tests in campaigns.items():
        with sign_of_life(f"{name}: {len(tests.motions)} tests are simulated"):
            said = said_of(name, campaigns, in_space, curves)
        seen = tests.measured
        yield name, scores_table(said, seen.overturned, seen.groups)
    known = {
        name: curve_of(each.peaks, each.measured) for name, each in campaigns.items()
    }
    for name, others in bare.items():
        said = said_by_curves(others.peaks, known)
        said["a coin"] = np.full(others.peaks.size, 0.5)
        seen = others.measured
        yield name, scores_table(said, seen.overturned, seen.groups)


def who_is_better(table: pd.DataFrame) -> str:
    """Sentence on who is better than our simulation, who is worse, and of whom that is not known."""
    if not table["who"].iloc[0].startswith("rockfrag"):
        return "Nobody wrote down shape or size, so that neither a simulation nor a rule can say anything."
    others = table[~table["who"].str.startswith("rockfrag")]
    better = others[others["worse_upper"] < 0]["who"]
    worse = others[others["worse_lower"] > 0]["who"]
    open_ = others[(others["worse_lower"] <= 0) & (others["worse_upper"] >= 0)]["who"]
    parts = []
    if len(better):
        parts.append(f"**Better than the simulation: {', '.join(better)}.**")
    if len(worse):
        parts.append(f"Worse: {', '.join(worse)}.")
    if len(open_):
        parts.append(f"Not told apart by these tests: {', '.join(open_)}.")
    return " ".join(parts)


def page_of(tables: Mapping[str, pd.DataFrame]) -> str:
    """The page, in Markdown.

    Parameters
    ----------
    tables : scores by campaign

    Returns
    -------
    The text.
    """
    lines = [HEAD]
    for name, table in tables.items():
        lines += [f"\n## {name}: {table['tests'].iloc[0]} tests\n", TITLES, RULER]
        for number, row in enumerate(table.to_dict("records")):
            worse = f"{row['worse']:+.3f} ({row['worse_lower']:+.3f} to {row['worse_upper']:+.3f})"
            worse = worse if number else ""
            lines.append(
                f"| {row['who']} | {row['log']:.3f} | {row['brier']:.3f} | {100 * row['right']:.0f} % | {worse} |"
            )
        lines.append(f"\n{who_is_better(table)}")
    return "\n".join(lines) + "\n"


TITLES = (
    "| who says it | log score | Brier | right | log score above the first (90 %) |"
)
RULER = "|---|--:|--:|--:|---|"
HEAD = f"""# Scores: what was said blind, and what happened

<!-- written by python -m rockfrag.stages.scores -->

Each test of each campaign at hand gets a probability of overturning before any of its outcomes is used, and
the probability is scored: minus its logarithm (natural; a coin has 0.693), and its squared error (Brier; a coin
has 0.25); less is better. *rockfrag* draws what nobody measured ({ARRANGEMENTS} arrangements,
[campaigns](campaigns.md#blind-the-model-error)), simulates the test's own motion in each and adds the model error
of the kind of body. Rules get the same arrangements and a dispersion of {BETA:g} about what they say: ASCE 43-05
(appendix A), Kaneko's curve, the peak velocity g α/p, and b/h. The measured curve of another object is what one
has who tests one object and speaks of another. A scan is answered in space (in at most {SOLID} of the
arrangements, `--in-space`; those in which it would hardly stand are left out, which leaves 18 of the granite
rock's), a cut block, which one component along its side moves in its own plane, in that. Intervals are over input
motions.

Errors of the model: {", ".join(f"{each.beyond:.3f} of a {kind}" for kind, each in MODEL_ERRORS.items())}
(standard deviations of ln level, [campaigns](campaigns.md#blind-the-model-error)). That of scans rests on the
granite rock itself: a score of it with that error is blind to each test, not to the campaign, and stands beside
the score without."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the scores of campaigns, and write the page where it is named."""
    parser = argparse.ArgumentParser(
        prog="python -m rockfrag.stages.scores",
        description="Score blind probabilities of every test of campaigns beside engineers' rules.",
    )
    parser.add_argument(
        "studies", nargs="+", metavar="STUDY", help="configurations of campaigns"
    )
    words = "arrangements in which an object may stand"
    parser.add_argument(
        "--arrangements", type=int, default=ARRANGEMENTS, metavar="N", help=words
    )
    parser.add_argument("--page", metavar="FILE", help="write the page here")
    words = "arrangements of scans that are simulated in space as well; 0: none"
    parser.add_argument("--in-space", type=int, default=SOLID, metavar="N", help=words)
    words = "tests of an object without shape or size: pga_g, pgv_over_pga_s, toppled"
    parser.add_argument(
        "--tests", action="append", default=[], metavar="FILE", help=words
    )
    given = parser.parse_args(arguments)
    tables: dict[str, pd.DataFrame] = {}
    try:
        read = [_read(path, given.arrangements) for path in given.studies]
        campaigns = {tests.study.name: tests for tests in read}
        bare = {Path(file).stem: bare_tests(file) for file in given.tests}
        for name, table in tables_of(campaigns, bare, given.in_space):
            tables[name] = table
            print(f"{name}\n{table.round(3).to_string(index=False)}", flush=True)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    if given.page:
        with whole_file(Path(given.page)) as path:
            path.write_text(page_of(tables), encoding="utf-8")
    return 0


def _read(path: str, count: int) -> Tests:
    """A campaign with the motion of each test, and so many arrangements."""
    study = load_any(path)
    if not isinstance(study, CampaignStudy) or "pedestal" in study.object:
        raise InputError(
            f"{path}: is no campaign of an object that stands alone; give one with the key campaign."
        )
    campaign, motions = campaign_with_motions(study, _LOG)
    measured = measured_tests(study, campaign)
    return Tests(study, object_of(study), motions, measured, count)


if __name__ == "__main__":
    sys.exit(main())
