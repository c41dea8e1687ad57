"""Write the table of docs/assess.md: what the default prior of the ground velocity does to ten answers.

.venv/bin/python docs/tables/velocity_prior.py
"""

import math
from pathlib import Path

import numpy as np
import yaml

from rockfrag.assess.answer import assess_with
from rockfrag.assess.conversion import PRIOR, PublishedVelocity
from rockfrag.assess.findings import estimate_of
from rockfrag.assess.hazard.curve import PGA, VELOCITY_PER_G
from rockfrag.assess.motions import motion_set
from rockfrag.assess.request import make_request
from rockfrag.assess.risk import Estimate
from rockfrag.words.catalogue import catalogue

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "assess.md"
BEGIN = "<!-- written by docs/tables/velocity_prior.py -->"
END = "<!-- end of the prior's table -->"
LEVELS = (0.25, 0.45)
"""PGA of the two sites [g]."""

NEAR = {"magnitude": 7.0, "distance_km": 5.0, "vs30_m_s": 400.0}
"""A site near a fault, of which that is known."""

LEAST = 0.01  # answers below which ratios say nothing [-]
OBJECTS = "objects of `config/rules-of-thumb.yaml`"


def fraction(about: dict[str, object], records: Path) -> Estimate:
    """Fraction of motions that topple an object."""
    request = make_request(about, "table")
    motions = motion_set(request.records, request.place, records)
    found = assess_with(request, motions, brief=True).fraction
    assert found is not None
    return found


def median_velocity(level: float, records: Path) -> tuple[float, float]:
    """Median PGV [cm/s] that comes with a PGA [g]: by the default prior, and in the motions as they are."""
    request = make_request({"width": "30 cm", "height": "1 m", "pga": "0.1 g"}, "table")
    motions = motion_set(request.records, request.place, records)
    published = PublishedVelocity.of(PGA, request.records)
    assert published is not None
    at_one, slope = published.lines(request.records)[0]
    by_prior = math.exp(at_one + slope * math.log(level))
    of_motions = math.exp(float(np.median(motions.log_ratios(PGA))))
    return level * VELOCITY_PER_G * by_prior, level * VELOCITY_PER_G * of_motions


def answers(about: dict[str, object], level: float, records: Path) -> list[Estimate]:
    """By the default prior, near a fault, and with the PGV of the prior's median and of the motions' known."""
    given = about | {"pga": f"{level} g"}
    known = [
        given | {"pgv": f"{each:.4g} cm/s"} for each in median_velocity(level, records)
    ]
    return [fraction(each, records) for each in (given, given | NEAR, *known)]


def table(records: Path) -> str:
    """The table in Markdown, and the sentence below it."""
    say = catalogue().say
    titles = ["object"]
    for level in LEVELS:
        by_prior, of_motions = median_velocity(level, records)
        titles += [
            f"{level:g} g, nothing else",
            f"M {NEAR['magnitude']:g} at {NEAR['distance_km']:g} km",
            f"PGV {by_prior:.0f} cm/s",
            f"PGV {of_motions:.0f} cm/s",
        ]
    lines = [f"| {' | '.join(titles)} |", f"|{'---|' * len(titles)}"]
    ratios = []
    objects = yaml.safe_load((ROOT / "config" / "rules-of-thumb.yaml").read_text())
    for about in objects["objects"]:
        cells = [about.pop("name")]
        for level in LEVELS:
            row = answers(about, level, records)
            cells += [say(estimate_of(each)) for each in row]
            if row[-1].value > LEAST:
                ratios.append(row[0].value / row[-1].value)
        lines.append(f"| {' | '.join(cells)} |")
    lines += [
        "",
        f"Fraction of motions that topples the ten {OBJECTS} at two levels of PGA: with nothing else given, which "
        f"is the default prior (magnitudes 5.5 to 8 at the distance at which they have that PGA, ground of "
        f"{math.exp(PRIOR['ln_vs30']):.0f} m/s); near a fault (magnitude, distance and {NEAR['vs30_m_s']:.0f} m/s "
        f"given); and where PGV is known and has the prior's median, or that of the motions. By the prior "
        f"answers are {np.median(ratios):.2f} of those with the motions' "
        f"velocity (median of the {len(ratios)} that are above {100 * LEAST:g} % with it; "
        f"{min(ratios):.2f} to {max(ratios):.2f}).",
    ]
    return "\n".join(lines)


def main() -> None:
    """Replace what stands between the two marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    found = table(ROOT / "resources" / "records")
    PAGE.write_text(f"{before}{BEGIN}\n\n{found}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
