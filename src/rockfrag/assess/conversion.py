"""What hazard in PGA or Sa leaves open where velocity decides.

A vector fragility P(topple | IM, PGV) says how much of the amplitude is told by each.  If ln PGV has the
weight c in it, a site whose motions have a PGV/IM larger by a factor r topples the object at levels of IM
smaller by r^c.  Motions of one earthquake share much of their PGV/IM; the spread of the earthquakes' means
is how far a site's may be from that of the set.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.assess.hazard.measure import PGV, Measure
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.verdicts import Verdicts
from rockfrag.errors import InputError
from rockfrag.fragility.surface import fit_surface


@dataclass(frozen=True)
class Conversion:
    """What is lost by knowing a measure instead of PGV.

    Attributes
    ----------
    measure
        The measure that is known.
    weight
        Share of velocity in what tells survival from toppling, 0 to 1 [-].
    ratio
        Median PGV over the measure in the set [cm/s per unit].
    spread
        Standard deviation of ln (PGV over the measure) between earthquakes [-].
    """

    measure: Measure
    weight: float
    ratio: float
    spread: float

    @property
    def shift(self) -> float:
        """Standard deviation of ln level that follows [-]."""
        return self.weight * self.spread

    @property
    def words(self) -> str:
        """A sentence for the page."""
        governs = "velocity governs" if self.weight > 0.5 else "velocity matters less"
        return (
            f"The hazard is in {self.measure.name}, while {governs} for this object (weight "
            f"{self.weight:.2f}): the motions have a PGV of {self.ratio:.3g} cm/s per {self.measure.unit} "
            f"with a spread between "
            f"earthquakes of {self.spread:.2f}, which widens the interval."
        )


def find_conversion(verdicts: Verdicts, motions: MotionSet) -> Conversion | None:
    """Fit the vector fragility of measure and PGV.

    Parameters
    ----------
    verdicts
        Of the object, in the measure that is known.
    motions
        The motions.

    Returns
    -------
    The conversion; None in PGV, or where the verdicts allow no fit.
    """
    measure = verdicts.ladder.measure
    if measure == PGV:
        return None
    ratios = motions.values(PGV) / motions.values(measure)
    motion, level = np.nonzero(verdicts.ladder.allowed)
    im = verdicts.ladder.levels[level]
    table = pd.DataFrame(
        {"im": im, "pgv": im * ratios[motion], "overturned": verdicts.overturned[motion, level]}
    )
    try:
        _, of_measure, of_velocity = fit_surface(table, ["im", "pgv"]).coefficients
    except InputError:
        return None
    weight = float(np.clip(of_velocity / (of_measure + of_velocity), 0.0, 1.0))
    logs = pd.Series(np.log(ratios)).groupby(motions.events).mean()
    spread = float(logs.std(ddof=1)) if len(logs) > 1 else 0.0
    return Conversion(measure, weight, float(np.median(ratios)), spread)
