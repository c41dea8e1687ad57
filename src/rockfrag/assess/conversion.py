"""What hazard in PGA or Sa leaves open where velocity decides.

A vector fragility P(topple | IM, PGV) says how much of the amplitude is told by each.  If ln PGV has the
weight c in it, a site whose motions have a PGV/IM larger by a factor r topples the object at levels of IM
smaller by r^c.

That motions of one IM have velocities of their own is no ignorance: it stands in the set and in the shares
counted with it.  Not known is how far the *mean* of ln PGV/IM at the site is from that of the set.  It follows
magnitude, distance and ground, by a regression on the records of the set; what of these is not known at the
site counts with its spread. About that relation half of the variance is taken for the site's own, which all its
earthquakes share.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.assess.hazard.measure import PGV, Measure
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import Records
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
        Standard deviation of the mean of ln (PGV over the measure) at the site about that of the set [-].
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
            f"The hazard is in {self.measure.name}, while {governs} for this object (weight {self.weight:.2f}). "
            "The "
            f"motions have a PGV of {self.ratio:.3g} cm/s per {self.measure.unit} on average; that of the site "
            "may "
            f"differ by a factor of {math.exp(self.spread):.2f} (standard deviation), which widens the interval."
        )


UNKNOWN = {"magnitude": 0.5, "ln_distance": 0.7, "ln_vs30": 0.45}
"""Standard deviations of what is not known of the earthquakes and the ground of a site: estimates of ours, half a
magnitude, a factor of two in distance, and a class of ground (EN 1998-1: 180, 360, 800 m/s)."""

OF_THE_SITE = 0.5
"""Part of the variance about the relation that all motions of a site share [-]: an estimate of ours."""

FEWEST_RECORDS = 30
"""Records from which three coefficients are fitted; with fewer, all of their spread counts."""


def find_conversion(
    verdicts: Verdicts, motions: MotionSet, known: Records | None = None
) -> Conversion | None:
    """Fit the vector fragility of measure and PGV.

    Parameters
    ----------
    verdicts
        Of the object, in the measure that is known.
    motions
        The motions.
    known
        What is known of the earthquakes of the site; nothing if None.

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
    spread = spread_of_site(np.log(ratios), motions, known or Records())
    return Conversion(measure, weight, float(np.median(ratios)), spread)


def spread_of_site(logs: NDArray[np.float64], motions: MotionSet, known: Records) -> float:
    """Standard deviation of the mean of ln (PGV over a measure) at a site about that of a set [-].

    Parameters
    ----------
    logs
        ln (PGV over the measure) of each motion, shape (motions,).
    motions
        The motions, with what is known of their records.
    known
        What is known of the earthquakes of the site.
    """
    about = [motion.metadata for motion in motions.ground]
    table = pd.DataFrame(
        {
            "record": [
                f"{one.get('event')} {one.get('station', i)}" for i, one in enumerate(about)
            ],
            "magnitude": [_number(one, "magnitude") for one in about],
            "ln_distance": [math.log(_number(one, "distance_km")) for one in about],
            "ln_vs30": [math.log(_number(one, "vs30_m_s")) for one in about],
            "log": logs,
        }
    )
    records = table.groupby("record").mean().dropna()
    if len(records) < FEWEST_RECORDS:
        by_record = table.groupby("record")["log"].mean()
        spread = float(by_record.std(ddof=1)) if len(by_record) > 1 else 0.0
        return math.sqrt(OF_THE_SITE) * spread
    x = np.column_stack([np.ones(len(records)), *(records[name] for name in UNKNOWN)])
    fit, *_ = np.linalg.lstsq(x, records["log"].to_numpy(), rcond=None)
    rest = records["log"].to_numpy() - x @ fit
    own = OF_THE_SITE * float(rest @ rest) / (len(records) - x.shape[1])
    given = {"magnitude": known.magnitude, "ln_distance": known.distance_km}
    unknown = sum(
        (slope * spread) ** 2
        for slope, (name, spread) in zip(fit[1:], UNKNOWN.items(), strict=True)
        if math.isnan(given.get(name, math.nan))
    )
    return math.sqrt(own + float(unknown))


def _number(about: Mapping[str, object], key: str) -> float:
    """A number that is known of a record and above 0, NaN where none is."""
    value = about.get(key)
    return float(value) if isinstance(value, int | float) and value > 0 else math.nan
