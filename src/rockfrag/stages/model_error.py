"""Campaigns at hand simulated blind: the model error, by kind of body.

    python -m rockfrag.stages.model_error config/granite.yaml …

prints for each campaign the simulated and the measured median, and for each kind of body the standard deviation of
ln median that :mod:`rockfrag.fragility.model_error` states.
"""

import argparse
import logging
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from scipy import stats

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.errors import InputError
from rockfrag.campaign.comparison import MeasuredTests, curves_of
from rockfrag.campaign.laboratory import Campaign
from rockfrag.campaign.standing import (
    draw_arrangements,
    kind_of,
    simulate_in_space,
    simulate_tests,
    solids_of,
    unknowns_of,
)
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.stages.campaign import campaign_with_motions, measured_tests, object_of
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import load_any
from rockfrag.system.mesh import Shape

ARRANGEMENTS = 512  # guesses of how an object stands
SOLID = 16  # of them, in which a scan is simulated in space, as it is answered

_LOG = logging.getLogger(__name__)
LEVEL = 0.90  # confidence of intervals
_Z = float(stats.norm.ppf(0.5 + LEVEL / 2))
_QUARTILES = 2 * float(stats.norm.ppf(0.75))
PRIOR = 0.3
"""Half-normal scale of the error of the model before any body is seen [-], of ours: published medians of furniture
lie as far from simulated ones (docs/toppling-velocity.md)."""


@dataclass(frozen=True)
class BlindAnswer:
    """Median of the fragility, blind and measured, in the unit of an intensity measure."""

    measured: float  # Measured median
    # Median over the ways in which the object may stand, with 5 and 95 % of them
    median: float
    lower: float
    upper: float
    # Standard error of ln(simulated over measured), from resampled input motions [-]
    sampling: float
    dispersion: float  # Middle dispersion of the ways [-]
    # Median in each way; infinite where nothing topples it, shape (ways,)
    medians: Floats

    @property
    def error(self) -> float:
        """ln(simulated over measured median) [-]."""
        return math.log(self.median / self.measured)

    @property
    def arrangement_spread(self) -> float:
        """Standard deviation of ln median between the ways to stand [-]: their quartiles as those of a normal.

        A way without an upper limit is one of many beyond the upper quartile.
        """
        low, high = np.quantile(self.medians, [0.25, 0.75], method="nearest")
        return math.log(high / low) / _QUARTILES if high < math.inf else math.inf

    def transform(self, error: float) -> float:
        """Probability integral transform of the measured median in the ways to stand, with an error of the model.

        Parameters
        ----------
        error : standard deviation of ln median [-]

        Returns
        -------
        The probability of a median below the measured one [-]; uniform if the error is that of the model.
        """
        return float(stats.norm.cdf(self._standard_scores(error)).mean())

    def density(self, error: float) -> float:
        """Probability density of ln of the measured median, the slope of :meth:`transform`.

        Parameters
        ----------
        error : standard deviation of ln median by which the model errs [-]

        Returns
        -------
        The density [-], mean over the ways to stand.
        """
        width = math.hypot(error, self.sampling)
        return float(stats.norm.pdf(self._standard_scores(error)).mean()) / width

    def _standard_scores(self, error: float) -> Floats:
        """Standard deviations by which the measured median lies above that of each way to stand, shape (ways,)."""
        # a way in which all topples has the median 0
        with np.errstate(divide="ignore"):
            ln_ratio = math.log(self.measured) - np.log(self.medians)
        return np.asarray(ln_ratio / math.hypot(error, self.sampling))

    def interval(self) -> tuple[float, float]:
        """Limits (90 %) of the blind median, in the unit of the measure, for a model without error.

        Spread of the ways to stand and sampling of the input motions are combined as independent, in ln median.
        """
        # a way in which all topples has the median 0
        way_low = math.log(self.median / self.lower) if self.lower > 0 else math.inf
        low = math.hypot(way_low, _Z * self.sampling)
        high = math.hypot(math.log(self.upper / self.median), _Z * self.sampling)
        return self.median * math.exp(-low), self.median * math.exp(high)


def blind_answer(
    tests: MeasuredTests, measure: Floats, simulated: Flags
) -> BlindAnswer:
    """Compare the median fragility of all ways to stand with the measured one; the tests choose no way.

    Parameters
    ----------
    tests : measured outcomes, with their groups of input motions
    measure : intensity of each test, shape (tests,)
    simulated : whether the object overturns in each way, shape (ways, tests)

    Returns
    -------
    The blind and the measured median, in the unit of the measure.

    Raises
    ------
    InputError : where outcomes do not rise with the measure
    """
    medians, dispersion = _curves_by_arrangement(tests, measure, simulated)
    places = [(1 - LEVEL) / 2, 0.5, (1 + LEVEL) / 2]
    lower, middle, upper = np.quantile(medians, places, method="nearest").tolist()
    theta, sampling = _measured_curve(tests, measure, simulated)
    if not (np.isfinite([theta, sampling]).all() and 0 < middle < math.inf):
        raise InputError(
            "the outcomes do not rise with the measure, so they have no median."
        )
    return BlindAnswer(
        measured=theta,
        median=middle,
        lower=lower,
        upper=upper,
        sampling=sampling,
        dispersion=dispersion,
        medians=medians,
    )


def _curves_by_arrangement(
    tests: MeasuredTests, measure: Floats, simulated: Flags
) -> tuple[Floats, float]:
    """Median of each way to stand, in the unit of the measure, shape (ways,), and their middle dispersion [-].

    A way without a curve has its median beyond all tests (infinite) where less overturns than was measured, and
    below them all (zero) otherwise.
    """
    outcomes, all_tests = simulated.astype(np.float64), np.ones(simulated.shape)
    theta, beta = curves_of(measure, outcomes, all_tests).T
    overturns_less = simulated.mean(axis=1) < tests.overturned.mean()
    bound = np.where(overturns_less, np.inf, 0.0)
    return np.where(np.isfinite(theta), theta, bound), float(np.nanmedian(beta))


def _measured_curve(
    tests: MeasuredTests, measure: Floats, simulated: Flags
) -> tuple[float, float]:
    """Measured median, in the unit of the measure, and the standard error of ln(blind over measured median) [-].

    The blind outcome of a test is the fraction of ways in which it overturns; NaN where a curve does not rise.
    """
    blind = {"blind": simulated.mean(axis=0)}
    table = replace(tests, level=LEVEL).fragility(measure, blind).set_index("who")
    theta = float(table["theta"].to_dict()["measured"])
    low = float(table["theta_ratio_lower"].to_dict()["blind"])
    high = float(table["theta_ratio_upper"].to_dict()["blind"])
    return theta, float(np.log(high / low)) / (2 * _Z)


def model_error(answers: Sequence[BlindAnswer]) -> tuple[float, float]:
    """Return the error of blind answers, a standard deviation of ln median [-], and its part beyond ways to stand.

    Of each body the measured median has a probability integral transform in the ways to stand widened by an error
    of the model; the slope of that transform is the likelihood of the error. Before any body it is half-normal
    (:data:`PRIOR`). A body of which many ways have no upper limit says less about the error and never that there
    is none: the likelihood of such ways is zero whatever the error.

    Parameters
    ----------
    answers : of bodies of one kind

    Returns
    -------
    Blind error and that beyond the ways to stand: root of the posterior mean square [-].
    """
    errors = np.linspace(0.0, 5 * PRIOR, 151)[1:]
    likelihood = stats.norm.logpdf(errors, 0.0, PRIOR)
    for answer in answers:
        each = np.array([answer.density(error) for error in errors.tolist()])
        likelihood = likelihood + np.log(np.maximum(each, 1e-12))
    weights = np.exp(likelihood - likelihood.max())
    beyond = math.sqrt(float((weights * errors**2).sum() / weights.sum()))
    known = [
        a.arrangement_spread for a in answers if math.isfinite(a.arrangement_spread)
    ]
    return math.hypot(beyond, float(np.mean(known)) if known else PRIOR), beyond


def blind_of(
    study: CampaignStudy,
    campaign: Campaign,
    motions: Sequence[Motion | GroundMotion],
    in_space: int = 0,
) -> dict[str, BlindAnswer]:
    """Simulate a campaign blind and compare its median with the measured one, by each intensity measure.

    Parameters
    ----------
    study, campaign : configuration, and the tests with their measures
    motions : of the table, one a test
    in_space : ways to stand in which a scan is simulated in space; 0 for all of them in the plane

    Returns
    -------
    Blind answers by name of the measure; first the measure in which outcomes scatter least.
    """
    if "pedestal" in study.object:
        raise InputError(
            f"{study.source}: key object.pedestal: the model error is of an object alone; give a campaign without."
        )
    thing = object_of(study)
    unknowns = unknowns_of(kind_of(thing), study.object.get("scan_tolerance_mm"))
    arrangements = draw_arrangements(thing, unknowns, ARRANGEMENTS, study.seed)
    if in_space and isinstance(thing, Shape):
        solids = solids_of(thing, arrangements, in_space)
        shaking = [motion for motion in motions if isinstance(motion, Motion)]
        simulated = simulate_in_space(solids, shaking)[..., 0]
    else:
        simulated, _ = simulate_tests(arrangements.systems, motions)
    measured = measured_tests(study, campaign)
    found = {
        name: blind_answer(measured, campaign.tests[name].to_numpy(), simulated)
        for name in campaign.measures
    }
    return dict(sorted(found.items(), key=lambda item: item[1].dispersion))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the model error that campaigns show."""
    parser = argparse.ArgumentParser(
        prog="python -m rockfrag.stages.model_error",
        description="Simulate campaigns blind and print the error of the median by kind of body.",
    )
    parser.add_argument(
        "studies", nargs="+", metavar="STUDY", help="configurations of campaigns"
    )
    words = "ways to stand of scans that are simulated in space, 0 for the plane"
    parser.add_argument("--in-space", type=int, default=SOLID, metavar="N", help=words)
    given = parser.parse_args(arguments)
    answers: dict[str, list[BlindAnswer]] = {}
    try:
        for path in given.studies:
            study = load_any(path)
            if not isinstance(study, CampaignStudy):
                raise InputError(
                    f"{path}: is no study of a campaign; give one with the key campaign."
                )
            campaign, motions = campaign_with_motions(study, _LOG)
            name, answer = next(
                iter(blind_of(study, campaign, motions, given.in_space).items())
            )
            answers.setdefault(kind_of(object_of(study)), []).append(answer)
            low, high = answer.interval()
            print(
                f"{study.name}: {len(motions)} tests under {campaign.tests['group'].nunique()} motions, median "
                f"{name} {answer.median:.3g} blind ({low:.3g} to {high:.3g}, without model error), "
                f"{answer.measured:.3g} measured, ln ratio {answer.error:.3f} ± {answer.sampling:.3f}, "
                f"transform {answer.transform(0.0):.2f}"
            )
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    for kind, found in answers.items():
        whole, beyond = model_error(found)
        print(
            f"{kind}: blind {whole:.3f}, beyond the ways to stand {beyond:.3f} of ln median; {len(found)} "
            f"campaign(s), {datetime.now(UTC):%Y-%m-%d}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
