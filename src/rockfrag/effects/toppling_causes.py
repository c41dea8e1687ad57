"""Causes of the distance between simulated and published velocities that topple furniture, one changed at a time.

In: records that shake the pieces of FEMA P-58, or others. Out: for each :class:`Cause` the ratio of simulated
medians over those of Kaneko and P-58, and the part of the planar difference that the change explains. Results:
``docs/toppling-velocity.md``.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.effects.shaken_records import FEWER, Records
from rockfrag.effects.toppling_velocity import (
    Shaken,
    medians_by,
    shaken_in_plane,
    velocity_levels,
)
from rockfrag.fragility.toppling_velocity import LIMITS, MEASURES
from rockfrag.simulation.closed_forms import kaneko_velocity

BOOKCASES = pd.DataFrame(
    {
        "width_m": 0.321,
        "height_m": [0.737, 1.041, 1.422, 1.803, 2.064],
        "fema_p58_m_s": [0.724, 0.493, 0.361, 0.290, 0.251],
    }
)
"""Unanchored bookcases of FEMA P-58 (E2022.102a to 106a): depth that rocks, height, median peak floor velocity;
by calculation and judgement, β = 0.5 throughout."""

SMOOTH, ROUGH = 0.3, 0.5  # friction of furniture on floors
HARD, SOFT = 0.9, 1.02  # restitution over that of momentum


@dataclass(frozen=True)
class ShakenPieces:
    """Pieces of furniture, shaken as each cause wants it; what several causes look at is shaken once.

    Attributes
    ----------
    records, pieces : what shakes, and a table like :data:`BOOKCASES`
    """

    records: Records
    pieces: pd.DataFrame

    @cached_property
    def sizes(self) -> Floats:
        """Width and height [m], shape (pieces, 2)."""
        return self.pieces[["width_m", "height_m"]].to_numpy(dtype=np.float64)

    @cached_property
    def plane(self) -> Shaken:
        """In the plane, at levels of each component's own PGV."""
        return self.records.shake(self.sizes, "plane", MEASURES[0])

    @cached_property
    def square(self) -> Shaken:
        """On a square base in space, at levels of the geometric mean of both components."""
        return self.records.shake(self.sizes, "square", MEASURES[0])

    def standing(self, name: str) -> Shaken:
        """On one of the bases, at levels of PGV."""
        if name == "plane":
            return self.plane
        if name == "square":
            return self.square
        return self.records.shake(self.sizes, name, MEASURES[0])

    @cached_property
    def mean(self) -> Floats:
        """Geometric mean of the PGV of both components, shape (records,) [m/s]."""
        return np.asarray(np.sqrt(self.records.velocities.prod(axis=1)))

    @cached_property
    def larger(self) -> Floats:
        """The larger PGV of both components, shape (records,) [m/s]."""
        return np.asarray(self.records.velocities.max(axis=1))

    def own(self) -> Floats:
        """Planar medians, shape (1 + resamples, pieces) [m/s]; the first row is of all records."""
        return self.plane.fits(self.records.weights("plane"))[0]

    def by(self, standing: str, factors: Floats) -> Floats:
        """Medians by another measure, ``factors`` times the level of each motion or record."""
        found = self.standing(standing)
        weights = self.records.weights(standing)
        each = zip(found.reached[-1], found.levels, strict=True)
        medians = [medians_by(fell, steps, factors, weights)[0] for fell, steps in each]
        return np.column_stack(medians)

    def by_components(self, peaks: Floats) -> Floats:
        """Planar medians by a measure of records, shape (records,), of which both components have one value."""
        own = self.records.velocities.ravel()
        return self.by("plane", np.repeat(peaks, 2) / own)

    def of_set(self, name: str) -> Floats:
        """Planar medians under the motions of one of the sets alone."""
        sets = [str(motion.metadata["set"]) for motion in self.records.motions]
        chosen = np.array(sets) == name
        return self.plane.fits(self.records.weights("plane") * chosen)[0]

    def changed(
        self, *, friction: float | None = None, restitution: float = 1.0
    ) -> Floats:
        """Planar medians [m/s] with a friction [-], or restitutions so many times those that conserve momentum."""
        found = shaken_in_plane(
            self.sizes,
            self.records.motions,
            self.records.velocities.ravel(),
            velocity_levels(self.sizes, FEWER),
            friction=friction,
            restitution=restitution,
        )
        return found.fits(self.records.weights("plane"))[0]

    def to_limit(self, limit: float) -> Floats:
        """Planar medians of a rotation over the critical angle."""
        number = LIMITS.index(limit)
        return self.plane.fits(self.records.weights("plane"), number)[0]

    def in_space(self) -> Floats:
        """Medians on a square base by the geometric mean."""
        return self.square.fits(self.records.weights("square"))[0]


@dataclass(frozen=True)
class Cause:
    """One thing that is changed."""

    name: str  # by which the command knows it
    part: str  # definition, motions, model, limit, space
    what: str  # in words
    medians: Callable[[ShakenPieces], Floats]  # (1 + resamples, pieces) [m/s]


CAUSES = (
    Cause(
        "own-component",
        "definition",
        "PGV of the component that shakes it",
        ShakenPieces.own,
    ),
    Cause(
        "geometric-mean",
        "definition",
        "geometric mean of both",
        lambda shaken: shaken.by_components(shaken.mean),
    ),
    Cause(
        "larger",
        "definition",
        "larger of both",
        lambda shaken: shaken.by_components(shaken.larger),
    ),
    Cause(
        "farfield",
        "motions",
        "farfield motions alone",
        lambda shaken: shaken.of_set("farfield"),
    ),
    Cause(
        "no-pulse",
        "motions",
        "nearfield motions without a pulse alone",
        lambda shaken: shaken.of_set("nearfield_no_pulse"),
    ),
    Cause(
        "pulse",
        "motions",
        "nearfield motions with a pulse alone",
        lambda shaken: shaken.of_set("nearfield_pulse"),
    ),
    Cause(
        "smooth-floor",
        "model",
        f"friction of {SMOOTH:g}, slides and flies; those that topple",
        lambda shaken: shaken.changed(friction=SMOOTH),
    ),
    Cause(
        "rough-floor",
        "model",
        f"friction of {ROUGH:g}, likewise",
        lambda shaken: shaken.changed(friction=ROUGH),
    ),
    Cause(
        "hard-impacts",
        "model",
        f"restitution {HARD:g} times that of momentum",
        lambda shaken: shaken.changed(restitution=HARD),
    ),
    Cause(
        "soft-impacts",
        "model",
        f"restitution {SOFT:g} times that of momentum",
        lambda shaken: shaken.changed(restitution=SOFT),
    ),
    Cause(
        "0.4-of-balance",
        "limit",
        "rocks to 0.4 of the critical angle",
        lambda shaken: shaken.to_limit(0.4),
    ),
    Cause(
        "0.6-of-balance",
        "limit",
        "rocks to 0.6 of the critical angle",
        lambda shaken: shaken.to_limit(0.6),
    ),
    Cause(
        "square-base",
        "space",
        "square base, both components, by their mean",
        ShakenPieces.in_space,
    ),
    Cause(
        "square-base-larger",
        "space",
        "square base, both components, by the larger",
        lambda shaken: shaken.by("square", shaken.larger / shaken.mean),
    ),
)
"""What may be changed; the first changes nothing, and its ratio is the difference that the others explain."""


def cause_named(name: str) -> Cause:
    """Return the cause of a name; refuse others with those that are.

    Parameters
    ----------
    name : of one of :data:`CAUSES`

    Returns
    -------
    The :class:`Cause`.
    """
    known = {cause.name: cause for cause in CAUSES}
    if name not in known:
        raise InputError(
            f"cause {name!r} is not known; choose one of {', '.join(known)}."
        )
    return known[name]


def causes_table(
    shaken: ShakenPieces, causes: Iterable[Cause] = CAUSES
) -> pd.DataFrame:
    """How causes move the medians of the pieces, a row each.

    Parameters
    ----------
    shaken, causes : the pieces, and what is changed

    Returns
    -------
    ``ratio`` over Kaneko (mean over the pieces), ``spread`` of its logarithm over the pieces, its standard
    ``error`` from the choice of earthquakes [-], ``over_p58``, and the parts ``of_kaneko`` and ``of_p58`` of the
    logarithm of the planar ratio that the cause takes off (below 0: adds).
    """
    base = _ratios(shaken, CAUSES[0].medians(shaken))
    rows = []
    for cause in causes:
        found = _ratios(shaken, cause.medians(shaken))
        rows.append(
            {"cause": cause.name, "part": cause.part, "what": cause.what}
            | found
            | {
                "of_kaneko": 1 - np.log(found["ratio"]) / np.log(base["ratio"]),
                "of_p58": 1 - np.log(found["over_p58"]) / np.log(base["over_p58"]),
            }
        )
    return pd.DataFrame(rows)


def _ratios(shaken: ShakenPieces, medians: Floats) -> dict[str, float]:
    """Ratios of medians over published ones; pieces too squat for the friction slide, and have no median."""
    kaneko = np.array([kaneko_velocity(*size) for size in shaken.sizes.tolist()])
    p58 = shaken.pieces["fema_p58_m_s"].to_numpy(dtype=np.float64)
    logs = np.log(medians / kaneko)
    topples = np.isfinite(logs[0])
    drawn = logs[1:, topples].mean(axis=1)
    over_p58 = np.log(medians[0] / p58)[topples]
    return {
        "ratio": float(np.exp(logs[0, topples].mean())),
        "spread": float(logs[0, topples].std()),
        "error": float(np.nanstd(drawn)),
        "over_p58": float(np.exp(over_p58.mean())),
    }
