"""A million objects: each between blocks that were simulated, and the worst of them simulated.

Lone blocks on a grid of heights and slendernesses are assessed as ``rockfrag assess`` assesses an inventory, on
each floor and in each way of standing that the table has. Median θ and β of their curves, all that is not known
included, are interpolated in ln H and ln B/H; an object topples at the level x with the probability
Φ(ln(x/θ)/β), and a hazard is summed over as for one object. What interpolation costs is measured in each run, on
the objects that are simulated afterwards.

In: a table of objects (height, slenderness) and a hazard. Out: a row an object with its probability.
Docs: ``docs/collections.md``, "A million objects".
"""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special
from scipy.interpolate import RegularGridInterpolator

from rockfrag.assess.answer import RECORDS, Assessment
from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.inventory import NO, YES, assess_each
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.request import Request, make_request
from rockfrag.assess.risk import toppling_rate
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.collections.exported_table import (
    inventory_cells,
    is_export,
    read_export,
)
from rockfrag.fragility.toppling_velocity import toppling_velocity
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.runtime.progress import Progress
from rockfrag.words.catalogue import catalogue
from rockfrag.words.findings import percent

LOWEST, HIGHEST = 0.1, 8.0  # Of the simulated blocks [m]
SLENDEREST, STOUTEST = 0.06, 1.2  # Width over height of them [-]
WORST = 1000  # Objects that are simulated
AT_ONCE = 100_000  # Objects that are interpolated at once, which bounds memory
KEPT_AT_ONCE = 100  # Assessments that are held in memory at once

NUMBERS = ("width_m", "height_m", "depth_m")
KNOWN = ("name", *NUMBERS, "round", "floor", "latitude", "longitude", "value")
PLANAR, BOX, ROUND = "planar", "box", "round"
"""Ways of standing that are simulated: in one plane, a square base in space, a round one."""

NODES = {PLANAR: (8, 9), BOX: (5, 6), ROUND: (5, 6)}
"""Heights and slendernesses that are simulated; in space fewer, as each takes longer."""

M_TO_CM = 100.0
BEYOND = 1.5  # Median that stands for one above the highest level, over that level
NORMAL_TENTH = 1.2816  # Standard deviations from a median to its tenth
SEED = 58  # Of the objects that are drawn at random
USUAL_BETA = 0.5  # β where too few motions topple a block to say
RATE_LEVELS = 60  # levels over which a hazard curve is summed up


@dataclass(frozen=True, eq=False)
class Surface:
    """Median and β of lone blocks over height and slenderness, on one floor and in one way of standing.

    Attributes
    ----------
    measure : of the medians
    heights, slendernesses : of the simulated blocks, rising, shape (heights,) [m] and (slendernesses,) [-]
    log_medians, betas : shape (heights, slendernesses)
    level : of shaking that was asked about, in the measure's unit
    hazard : curve of the measure; None if none was given
    published : whether medians are those of :mod:`rockfrag.fragility.toppling_velocity` where it knows the size
    """

    measure: IntensityMeasure
    heights: Floats
    slendernesses: Floats
    log_medians: Floats
    betas: Floats
    level: float
    hazard: HazardCurve | None
    published: bool = False

    def curves(self, heights: Floats, widths: Floats) -> tuple[Floats, Floats]:
        """Median and β of blocks; beyond the grid those of its edge.

        Parameters
        ----------
        heights, widths : of the blocks, shape (n,) [m]

        Returns
        -------
        Medians in the measure's unit, and β [-], shape (n,) each.
        """
        axes = np.log(self.heights), np.log(self.slendernesses)
        inside = [
            np.clip(values, axis[0], axis[-1])
            for values, axis in zip(
                (np.log(heights), np.log(widths / heights)), axes, strict=True
            )
        ]
        points = np.column_stack(inside)
        medians = np.exp(RegularGridInterpolator(axes, self.log_medians)(points))
        if self.published:
            known, _ = toppling_velocity(widths, heights)
            medians = np.where(np.isfinite(known), M_TO_CM * known, medians)
        return medians, RegularGridInterpolator(axes, self.betas)(points)

    def fractions(self, medians: Floats, betas: Floats) -> Floats:
        """Probability of toppling at the level, shape (n,)."""
        return np.asarray(special.ndtr(np.log(self.level / medians) / betas))

    def rates(self, medians: Floats, betas: Floats) -> Floats:
        """Annual rate of toppling under the hazard [1/year], shape (n,).

        The rate is linear in the fractions at the levels: a weight is the rate of what topples at one level alone.
        """
        assert self.hazard is not None
        known = self.hazard.levels
        # beyond the curve at both ends, where curves of fragility still rise
        levels = np.geomspace(known[0] / 4, known[-1] * 4, RATE_LEVELS)
        at_one_level = np.eye(levels.size)
        weights = np.array(
            [toppling_rate(levels, each, self.hazard) for each in at_one_level]
        )
        scores = np.log(levels) - np.log(medians)[:, np.newaxis]
        fractions = special.ndtr(scores / betas[:, np.newaxis])
        return np.asarray(fractions @ weights)


@dataclass(frozen=True)
class Simulated:
    """How many objects of a large table are simulated.

    Attributes
    ----------
    worst : of those that topple most probably
    at_random : of the others, which say how true the coarse answers are
    """

    worst: int = WORST
    at_random: int = 0


@dataclass(frozen=True)
class SimulatedObject:
    """What is kept of the assessment of an object, which itself takes megabytes.

    Attributes
    ----------
    request : the object
    probability : of toppling, under the hazard or at the level [-]
    median : of its curve, in the unit of the measure; NaN where too few motions topple it
    fraction : of motions that topple it at the level [-]; NaN without a level
    """

    request: Request
    probability: float
    median: float
    fraction: float


@dataclass(frozen=True, eq=False)
class CoarseInventory:
    """A table of objects, each with its coarse answer, and the worst of them simulated.

    Attributes
    ----------
    table : the rows with ``fraction`` and, with a hazard, ``probability``, ``median`` and ``beta`` of the curve,
        ``simulated`` (NaN where it was not) and ``fault`` (empty where a row could be used)
    worst : the worst objects, the worst first
    bias, scatter : mean and standard deviation of ln (coarse over simulated median) [-], of those drawn at random
        if there are any; NaN without
    fraction_off : by how much nine of ten of their fractions are off at most [-]; NaN without
    compared : number of these
    faults : number of rows that could not be used
    """

    table: pd.DataFrame
    worst: Sequence[SimulatedObject]
    bias: float
    scatter: float
    fraction_off: float
    compared: int
    faults: int


def coarse_inventory(
    path: str | os.PathLike[str],
    shared: Mapping[str, Any],
    records: str | Path = RECORDS,
    *,
    simulated: Simulated | None = None,
    order: str = "",
    progress: Progress | None = None,
) -> CoarseInventory:
    """Answer for each object of a large table between simulated blocks, then simulate the worst.

    Parameters
    ----------
    path : Parquet or CSV file with ``width_m`` and ``height_m``, and if known ``name``, ``depth_m``, ``round``,
        ``floor``, ``value``, ``latitude``, ``longitude``; or a museum's table
    shared : keys of ``statue.yaml`` that hold for all, with a level or a hazard
    records : folder of fetched records
    simulated : how many are simulated; None for the worst thousand
    order : of lengths that a museum's table does not name, such as ``HWD``
    progress : called with the number of blocks and objects simulated and of all

    Returns
    -------
    The :class:`CoarseInventory`.

    Raises
    ------
    InputError
        If columns are missing or unknown, or no level and no hazard is given.
    """
    table = _read(path, order)
    first = make_request({**shared, "width": "0.3 m", "height": "1 m"}, str(path))
    if first.level is None and not first.hazard:
        raise InputError(
            f"{path}: --coarse needs what shakes the place; give --pgv, --pga or a hazard."
        )
    motions = motion_set(first.records, first.place, Path(records))
    usable = table[table["fault"] == ""]
    count = simulated or Simulated()
    groups = list(usable.groupby(["floor", "kind"]))
    nodes = [math.prod(NODES[str(kind)]) for (_, kind), _ in groups]
    objects = min(count.worst + count.at_random, len(usable))
    done, total = 0, sum(nodes) + objects
    for ((floor, kind), rows), size in zip(groups, nodes, strict=True):
        said = _further(progress, done, total)
        surface = tabulate(shared, str(floor), str(kind), motions, said)
        done += size
        for start in range(0, len(rows), AT_ONCE):
            part = rows.index[start : start + AT_ONCE]
            _fill(table, part, surface, first.years)
    ranked = "probability" if "probability" in table else "fraction"
    worst = table[ranked].nlargest(count.worst).index
    others = usable.index.difference(worst)
    drawn = np.random.default_rng(SEED).permutation(others)[: count.at_random]
    asked = [_request(table.loc[i], shared) for i in (*worst, *drawn)]
    found = _simulated(asked, motions, _further(progress, done, total))
    return _joined(table, worst, drawn, found)


def _simulated(
    requests: Sequence[Request], motions: MotionSet, progress: Progress | None
) -> list[SimulatedObject]:
    """Assess objects, so many at once that memory does not grow with their number."""
    found = []
    for start in range(0, len(requests), KEPT_AT_ONCE):
        part = requests[start : start + KEPT_AT_ONCE]
        said = _further(progress, start, len(requests))
        for each in assess_each(part, motions, said):
            fraction = math.nan if each.fraction is None else each.fraction.value
            median = each.predicted.median
            kept = SimulatedObject(each.request, each.main.value, median, fraction)
            found.append(kept)
    return found


def _further(progress: Progress | None, before: int, total: int) -> Progress | None:
    """Progress of a part, counted with what was done before it."""
    if progress is None:
        return None
    return lambda done, _: progress(before + done, total)


def _read(path: str | os.PathLike[str], order: str) -> pd.DataFrame:
    """Read the table, with what is wrong with each row and how each object stands."""
    if is_export(path):
        return _with_faults(_of_export(path, order), path)
    try:
        if str(path).lower().endswith(".parquet"):
            table = pd.read_parquet(path)
        else:
            table = pd.read_csv(path, low_memory=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a table ({error}).") from None
    unknown = [name for name in table.columns if name not in KNOWN]
    missing = [name for name in NUMBERS[:2] if name not in table.columns]
    if unknown or missing:
        what = (
            f"column {unknown[0]!r} is not known"
            if unknown
            else f"column {missing[0]} is missing"
        )
        raise InputError(
            f"{path}: {what}; --coarse takes {', '.join(KNOWN)}, and lone blocks only."
        )
    return _with_faults(table.reset_index(drop=True), path)


def _of_export(path: str | os.PathLike[str], order: str) -> pd.DataFrame:
    """A museum's table; rows of which something has to be asked have no sizes."""
    rows = [
        {"name": each.name} if each.question else inventory_cells(each)
        for each in read_export(path, order)
    ]
    columns = ["name", *NUMBERS, "round"]
    table = pd.DataFrame(rows).reindex(columns=columns)
    table["round"] = table["round"].replace("", "no")
    return table


def _with_faults(table: pd.DataFrame, path: str | os.PathLike[str]) -> pd.DataFrame:
    """The table with its columns in one form, what is wrong with each row, and how each object stands.

    ``path``: for messages.
    """
    if "name" not in table:
        table["name"] = [f"row {i}" for i in range(1, len(table) + 1)]
    for name in NUMBERS:
        given = table.get(name, math.nan)
        table[name] = pd.to_numeric(pd.Series(given, table.index), errors="coerce")
    table["floor"] = (
        table.get("floor", pd.Series("", table.index)).fillna("").astype(str)
    )
    words = table.get("round", pd.Series("no", table.index))
    words = words.fillna("no").astype(str).str.strip().str.lower()
    is_round = words.isin(YES)
    table["kind"] = np.where(
        is_round, ROUND, np.where(table["depth_m"].notna(), BOX, PLANAR)
    )
    wrong = ~(
        table["width_m"].between(0.005, 50) & table["height_m"].between(0.01, 100)
    )
    wrong |= (table["depth_m"] <= 0) | ~words.isin((*YES, *NO))
    table["fault"] = np.where(wrong, "sizes, or round, are missing or impossible", "")
    if wrong.all():
        raise InputError(f"{path}: no row has usable sizes in metres.")
    return table


def tabulate(
    shared: Mapping[str, Any],
    floor: str,
    kind: str,
    motions: MotionSet,
    progress: Progress | None = None,
) -> Surface:
    """Simulate blocks on the grid of sizes.

    Parameters
    ----------
    shared : keys of ``statue.yaml`` that hold for all, with a level or a hazard
    floor, kind : where they stand, empty for what ``shared`` says, and how
    motions : the ground motions
    progress : called with the number of blocks done and of all

    Returns
    -------
    The :class:`Surface`.
    """
    high, wide = NODES[kind]
    heights = np.geomspace(LOWEST, HIGHEST, high)
    slendernesses = np.geomspace(SLENDEREST, STOUTEST, wide)
    sizes = [(h, h * ratio) for h in heights for ratio in slendernesses]
    place = {"floor": floor} if floor else {}
    requests = [
        make_request({**shared, **place, **_of_kind(kind, w), "height": f"{h} m"}, kind)
        for h, w in sizes
    ]
    found = assess_each(requests, motions, progress)
    curves = np.array([_curve(each) for each in found])
    # shape (heights, slendernesses) each
    medians, betas = curves.T.reshape(2, high, wide)
    level, hazard = found[0].level, found[0].hazard
    assert level is not None
    return Surface(
        measure=found[0].measure,
        heights=heights,
        slendernesses=slendernesses,
        log_medians=np.log(medians),
        betas=betas,
        level=level.value,
        hazard=hazard,
        published=_is_published(found[0], kind),
    )


def _is_published(found: Assessment, kind: str) -> bool:
    """Whether the published surface answers the same: PGV of the ground, in a plane, by the usual motions."""
    request = found.request
    usual = not request.records.paths and math.isnan(request.records.magnitude)
    asked = found.measure.imt == "PGV" and request.place.shakes_as_ground
    return kind == PLANAR and usual and asked


def _of_kind(kind: str, width: float) -> dict[str, Any]:
    """Keys of a block of a width that stands in some way."""
    sizes: dict[str, Any] = {"width": f"{width} m"}
    if kind == BOX:
        sizes["depth"] = f"{width} m"
    return sizes | ({"round": True} if kind == ROUND else {})


def _curve(found: Assessment) -> tuple[float, float]:
    """Median and β [-] of a block, all that is not known included.

    A median that the motions do not show is put beyond the highest level; where a spread is not known, β follows
    from the level that topples a tenth.
    """
    curve, highest = found.predicted, float(found.predicted.levels[-1])
    if not math.isfinite(curve.median):
        return BEYOND * highest, USUAL_BETA
    beta = math.hypot(curve.of_records, curve.of_unknown)
    if math.isfinite(beta):
        return curve.median, beta
    tenth = found.amplitudes[0.1].value
    return curve.median, max(math.log(curve.median / tenth) / NORMAL_TENTH, 0.1)


def _fill(table: pd.DataFrame, rows: pd.Index, surface: Surface, years: float) -> None:
    """Write the coarse answer of some rows into a table: median, β, fraction and, with a hazard, probability.

    ``surface``: of their floor and kind; ``years``: of the probability.
    """
    heights = table.loc[rows, "height_m"].to_numpy(dtype=np.float64)
    # a box rocks over its narrow side
    widths = table.loc[rows, ["width_m", "depth_m"]].min(axis=1)
    medians, betas = surface.curves(heights, widths.to_numpy(dtype=np.float64))
    table.loc[rows, "median"] = medians
    table.loc[rows, "beta"] = betas
    table.loc[rows, "fraction"] = surface.fractions(medians, betas)
    if surface.hazard is not None:
        rates = surface.rates(medians, betas)
        table.loc[rows, "probability"] = -np.expm1(-years * rates)


def _request(row: pd.Series, shared: Mapping[str, Any]) -> Request:
    """The object of a row, to be simulated."""
    own: dict[str, Any] = {"name": str(row["name"])[:80]}
    own |= {key.removesuffix("_m"): f"{row[key]} m" for key in NUMBERS if row[key] > 0}
    if row["floor"]:
        own["floor"] = row["floor"]
    if row["kind"] == ROUND:
        own |= {"round": True}
        own.pop("depth", None)
    return make_request({**shared, **own}, "inventory")


def _joined(
    table: pd.DataFrame,
    worst: pd.Index,
    drawn: NDArray[np.int64],
    found: Sequence[SimulatedObject],
) -> CoarseInventory:
    """Put simulated answers beside the coarse ones, and say how far apart they are.

    Parameters
    ----------
    table : rows with their coarse answers
    worst, drawn : labels of the rows that were simulated: the worst, and some at random
    found : what was simulated, in that order
    """
    rows = [*worst, *drawn]
    table["simulated"] = math.nan
    table.loc[rows, "simulated"] = [each.probability for each in found]
    # compared by those drawn at random, if any: the worst are so by what the coarse answer misses too
    first = len(worst) if len(drawn) else 0
    beside = table.loc[rows[first:]]
    exact = np.array([each.median for each in found[first:]])
    ratio = np.log(beside["median"].to_numpy() / exact)
    ratio = ratio[np.isfinite(ratio)]
    off = beside["fraction"] - [each.fraction for each in found[first:]]
    off = off[np.isfinite(off)].abs()
    ranked = sorted(
        found[: len(worst)], key=lambda each: each.probability, reverse=True
    )
    return CoarseInventory(
        table=table.drop(columns="kind"),
        worst=ranked,
        bias=float(ratio.mean()) if ratio.size else math.nan,
        scatter=float(ratio.std()) if ratio.size else math.nan,
        fraction_off=float(off.quantile(0.9)) if off.size else math.nan,
        compared=ratio.size,
        faults=int((table["fault"] != "").sum()),
    )


def coarse_lines(found: CoarseInventory) -> list[str]:
    """Say the answer in lines: how many, how far coarse and simulated answers are apart, and the worst.

    Parameters
    ----------
    found : the table with its answers

    Returns
    -------
    The lines.
    """
    table = found.table
    order = "probability" if "probability" in table else "fraction"
    known = table[order].dropna()
    lines = [
        f"{len(known)} of {len(table)} objects; {known.sum():.0f} topple in the mean, "
        f"{int((known >= 0.1).sum())} with 10 % or more."
    ]
    if found.faults:
        lines.append(f"{found.faults} rows could not be used; column fault says which.")
    if math.isfinite(found.scatter):
        lines.append(
            f"Of {found.compared} simulated objects the coarse median is off by {100 * found.bias:+.1f} % in the "
            f"mean and by {100 * found.scatter:.1f} % from one to the next, nine of ten fractions by at most "
            f"{100 * found.fraction_off:.1f} points."
        )
    for rank, each in enumerate(found.worst[:10], start=1):
        likely = catalogue().say(percent(each.probability))
        lines.append(f"{rank:4d}  {each.request.name}  {likely}")
    return lines
