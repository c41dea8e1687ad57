"""Campaigns at hand simulated blind: the model error, by kind of body.

    python -m rockfrag.stages.model_error config/granite.yaml …

prints for each campaign the simulated and the measured median, and for each kind of body the standard deviation of
ln median that :mod:`rockfrag.fragility.model_error` states.
"""

import argparse
import logging
import sys
from collections.abc import Sequence
from datetime import UTC, datetime

from rockfrag.campaign.blind import BlindAnswer, blind_answer, model_error
from rockfrag.campaign.standing import kind_of, unknowns_of, ways_to_stand
from rockfrag.campaign.tests import Campaign
from rockfrag.campaign.trials import simulate_tests
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.stages.campaign import campaign_with_motions, measured_tests, object_of
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import load_any

WAYS = 512
"""Guesses of how an object stands."""

_LOG = logging.getLogger(__name__)


def blind_of(
    study: CampaignStudy, campaign: Campaign, motions: Sequence[Motion]
) -> dict[str, BlindAnswer]:
    """Blind answers of a campaign, by measure, that in which outcomes scatter least first."""
    if "pedestal" in study.object:
        raise InputError(
            f"{study.source}: key object.pedestal: the model error is of an object alone; give a campaign without."
        )
    thing = object_of(study)
    unknowns = unknowns_of(kind_of(thing), study.object.get("scan_tolerance_mm"))
    ways = ways_to_stand(thing, unknowns, WAYS, study.seed)
    simulated, _ = simulate_tests(ways.systems, motions)
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
    parser.add_argument("studies", nargs="+", metavar="STUDY", help="configurations of campaigns")
    answers: dict[str, list[BlindAnswer]] = {}
    try:
        for path in parser.parse_args(arguments).studies:
            study = load_any(path)
            if not isinstance(study, CampaignStudy):
                raise InputError(
                    f"{path}: is no study of a campaign; give one with the key campaign."
                )
            campaign, motions = campaign_with_motions(study, _LOG)
            name, answer = next(iter(blind_of(study, campaign, motions).items()))
            answers.setdefault(kind_of(object_of(study)), []).append(answer)
            low, high = answer.interval()
            print(
                f"{study.name}: {len(motions)} tests under {campaign.tests['group'].nunique()} motions, median "
                f"{name} {answer.median:.3g} blind ({low:.3g} to {high:.3g}, without model error), "
                f"{answer.measured:.3g} measured, ln ratio {answer.error:.3f} ± {answer.sampling:.3f}"
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
