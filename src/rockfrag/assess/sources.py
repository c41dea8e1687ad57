"""What is not known, source by source: how large it is, and what would make it smaller.

Only what is not known stands here and widens intervals. What differs from one earthquake to the next, such as the
velocity that comes with a given PGA, is in the motions and so in the fractions and probabilities themselves.

In: a request and its motions. Out: sources with standard deviations of ln level [-].
Theory: ``docs/assess.md``, "How sure".
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockfrag.assess.core.estimates import fill_order, fill_parts
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS, SCAN
from rockfrag.words.findings import Finding, finding, three

SPACE = 0.13
"""Standard deviation of ln level of the second horizontal component, |ln(0.47 g / 0.54 g)|: the median level of
a box of 0.35 × 0.35 × 1.2 m in space under both components of 25 records of FEMA P-695 over that along one of
them."""


@dataclass(frozen=True)
class Source:
    """A source of uncertainty."""

    name: str  # Its name, of which the ids of its texts are made
    # What a measurement leaves of its standard deviation [-], an estimate of ours; 1 where none helps
    left: float = 1.0

    @property
    def called(self) -> Finding:
        """What it is."""
        return finding(f"source_{self.name}")

    @property
    def basis(self) -> Finding:
        """Where its size comes from."""
        values = {
            "model": {
                "scan": three(MODEL_ERRORS[SCAN].beyond),
                "cut": three(MODEL_ERRORS[CUT].beyond),
            },
            "space": {"space": three(SPACE)},
        }
        return finding(f"basis_{self.name}", **values.get(self.name, {}))

    @property
    def measurement(self) -> Finding | None:
        """What a user could measure or find out that makes it smaller; None for nothing."""
        return finding(f"measurement_{self.name}") if self.left < 1 else None


SOURCES: Mapping[str, Source] = {
    source.name: source
    for source in (
        # those that a measurement makes smaller, the cheapest first
        Source("facing", 0.0),
        Source("width", 0.25),
        Source("cg_height", 0.2),
        Source("mass", 0.1),
        Source("contact", 1 / 3),
        Source("retreat", 0.2),
        Source("conversion", 0.0),
        Source("hazard", 0.5),
        Source("period", 1 / 6),
        Source("damping", 0.4),
        Source("restitution"),
        Source("motions"),
        Source("model"),
        Source("space"),
        Source("together"),
    )
}
"""Sources of uncertainty by name."""


def parts_of(sources: Mapping[str, float]) -> dict[str, float]:
    """Part of each source in the variance of an interval, the largest first [-]; empty where one has no bound."""
    deviations = np.array(list(sources.values()), dtype=np.float64)
    parts, order = np.zeros(deviations.size), np.zeros(deviations.size, dtype=np.int64)
    fill_parts(deviations, parts)
    if not parts.any():
        return {}
    fill_order(-deviations, parts, False, order)
    names = list(sources)
    return {names[place]: float(parts[place]) for place in order}


MEASUREMENTS: Mapping[str, Source] = {
    name: source for name, source in SOURCES.items() if source.left < 1
}
"""Sources of uncertainty that a measurement would narrow, the cheapest first."""
