"""Velocity that topples, by width and height: medians, what explains their distance from published ones, surfaces.

    python -m rockfrag.stages.toppling_velocity --output results/toppling-velocity

shakes uniform blocks by the default records, in the plane and in space, and writes tables and the figure of
docs/toppling-velocity.md; ``--surface FILE`` writes the coefficients that the package looks up.
"""

import argparse
import json
import logging
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base import figure_style as style
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file, write_table
from rockfrag.base.units import GRAVITY
from rockfrag.effects.toppling_velocity import (
    Pair,
    Shaken,
    acceleration_levels,
    earthquake_weights,
    grid_of_sizes,
    medians_by,
    random_sizes,
    shaken_in_plane,
    shaken_in_space,
    surface_coefficients,
    velocity_levels,
)
from rockfrag.effects.toppling_velocity_figure import draw_toppling_velocity
from rockfrag.fragility.toppling_velocity import (
    LIMITS,
    MEASURES,
    STANDINGS,
    surface_from,
    terms_of,
)
from rockfrag.motions.intensity import pgv
from rockfrag.records.motion import Motion
from rockfrag.simulation.closed_forms import kaneko_velocity
from rockfrag.stages.space_study import RECORDS, wide_set

PIECES = pd.DataFrame(
    {
        "width_m": 0.321,
        "height_m": [0.737, 1.041, 1.422, 1.803, 2.064],
        "fema_p58_m_s": [0.724, 0.493, 0.361, 0.290, 0.251],
    }
)
"""Unanchored bookcases of FEMA P-58 (E2022.102a to 106a): depth that rocks, height, median peak floor velocity;
by calculation and judgement, β = 0.5 throughout."""

VELOCITIES = np.geomspace(0.06, 6.0, 45)  # levels over Kaneko's velocity
ACCELERATIONS = np.geomspace(0.8, 40.0, 45)  # levels over uplift
FEWER = np.geomspace(0.15, 3.5, 16)  # likewise, in space and with friction
FRICTION = 0.3  # of furniture on a smooth floor
SEED = 55

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class Extent:
    """How many sizes are shaken."""

    plane: tuple[int, int]  # widths and heights of the grid in the plane
    space: tuple[int, int]  # and in space
    held_out: int  # sizes drawn at random that judge the surface
    every: int  # every so many records


WHOLE = Extent((10, 12), (5, 5), 8, 1)
QUICK = Extent((4, 5), (3, 4), 3, 10)
"""What the study shakes, and a tenth of it, which shows that it runs."""


@dataclass(frozen=True)
class Records:
    """Both components of records, and their earthquakes."""

    pairs: Sequence[Pair]
    earthquakes: Sequence[str]

    @cached_property
    def motions(self) -> list[Motion]:
        """Components one after the other, shape (2 × records,)."""
        return [motion for pair in self.pairs for motion in pair]

    @cached_property
    def velocities(self) -> Floats:
        """PGV of both components of each record, shape (records, 2) [m/s]."""
        return np.array([[pgv(motion) for motion in pair] for pair in self.pairs])

    @cached_property
    def accelerations(self) -> Floats:
        """PGA likewise [g]."""
        peaks = [[motion.pga for motion in pair] for pair in self.pairs]
        return np.array(peaks) / GRAVITY

    def peaks(self, measure: str) -> Floats:
        """Peaks of both components in a measure, shape (records, 2)."""
        return self.velocities if measure == MEASURES[0] else self.accelerations

    def weights(self, standing: str) -> Floats:
        """How often each motion, or each record of bodies in space, counts if earthquakes are drawn anew."""
        of_records = earthquake_weights(self.earthquakes, seed=SEED)
        return np.repeat(of_records, 2, axis=1) if standing == "plane" else of_records

    def shake(self, sizes: Floats, standing: str, measure: str) -> Shaken:
        """Shake blocks of sizes at levels of a measure."""
        peaks = self.peaks(measure)
        if standing != "plane":
            levels = velocity_levels(sizes, FEWER)
            mean = np.sqrt(peaks.prod(axis=1))
            return shaken_in_space(sizes, standing, self.pairs, mean, levels)
        if measure == MEASURES[0]:
            levels = velocity_levels(sizes, VELOCITIES)
        else:
            levels = acceleration_levels(sizes, ACCELERATIONS)
        return shaken_in_plane(sizes, self.motions, peaks.ravel(), levels)


def records_of(every: int, folder: Path) -> Records:
    """Both components of every so many of the default records."""
    pairs, earthquakes = wide_set(every, folder)
    return Records(pairs, earthquakes)


def medians_and_surfaces(
    records: Records, extent: Extent
) -> Iterator[tuple[pd.DataFrame, list[dict[str, Any]]]]:
    """Yield for each standing its medians and surfaces, judged by sizes that the fit has not seen."""
    for standing in STANDINGS:
        grid = extent.plane if standing == "plane" else extent.space
        sizes = grid_of_sizes(*grid)
        others = random_sizes(extent.held_out, SEED)
        weights, rows, tables = records.weights(standing), [], []
        for measure in MEASURES if standing == "plane" else MEASURES[:1]:
            seen = records.shake(sizes, standing, measure)
            unseen = records.shake(others, standing, measure)
            error = np.nan
            # the fall first: what the earthquakes do to it they do to lesser rotations
            for number, limit in reversed(list(enumerate(LIMITS))):
                drawn = weights if limit == 1 else weights[:1]
                medians, dispersions = seen.fits(drawn, number)
                row = _surface_row(sizes, medians, dispersions[0])
                error = _earthquake_error(np.log(medians[1:])) if limit == 1 else error
                row["earthquakes"] = round(error, 4)
                kept, _ = unseen.fits(weights[:1], number)
                row |= _judged(row["median"], others, kept[0])
                rows.append(
                    {"standing": standing, "limit": limit, "measure": measure} | row
                )
                table = _table(sizes, medians, dispersions[0])
                tables.append(
                    table.assign(standing=standing, measure=measure, limit=limit)
                )
            _LOG.info("%s, %s", standing, measure)
        yield pd.concat(tables, ignore_index=True), rows


def _surface_row(sizes: Floats, medians: Floats, dispersions: Floats) -> dict[str, Any]:
    """Coefficients of median and dispersion."""
    return {
        "median": _rounded(surface_coefficients(sizes, np.log(medians[0]))),
        "dispersion": _rounded(surface_coefficients(sizes, dispersions)),
    }


def _earthquake_error(logs: Floats) -> float:
    """Standard error of ln median of a middle size, from resampled earthquakes."""
    return float(np.nanmedian(np.nanstd(logs, axis=0)))


def _rounded(values: Floats) -> list[float]:
    return [round(value, 6) for value in values.tolist()]


def _judged(
    coefficients: Sequence[float], sizes: Floats, medians: Floats
) -> dict[str, float]:
    """Differences of ln median between sizes and the surface: standard deviation and largest."""
    off = np.log(medians) - terms_of(*sizes.T) @ coefficients
    return {
        "residual": round(float(np.sqrt(np.nanmean(off**2))), 4),
        "largest": round(float(np.nanmax(np.abs(off))), 4),
    }


def _table(sizes: Floats, medians: Floats, dispersions: Floats) -> pd.DataFrame:
    """Medians with limits of resampled earthquakes (90 %), and their ratio over Kaneko's curve."""
    limits = np.full((2, len(sizes)), np.nan)
    if len(medians) > 1:
        limits = np.nanquantile(medians[1:], [0.05, 0.95], axis=0)
    kaneko = [kaneko_velocity(*size) for size in sizes.tolist()]
    return pd.DataFrame(
        {
            "width_m": sizes[:, 0],
            "height_m": sizes[:, 1],
            "median": medians[0],
            "lower": limits[0],
            "upper": limits[1],
            "dispersion": dispersions,
            "kaneko_m_s": kaneko,
        }
    )


def pieces_table(records: Records) -> pd.DataFrame:
    """Pieces of FEMA P-58 with Kaneko's medians and simulated ones, and their ratios over both."""
    sizes = PIECES[["width_m", "height_m"]].to_numpy()
    table = PIECES.assign(kaneko_m_s=[kaneko_velocity(*x) for x in sizes.tolist()])
    for standing in STANDINGS:
        found = records.shake(sizes, standing, MEASURES[0])
        medians, dispersions = found.fits(records.weights(standing))
        logs = np.log(medians)
        table[standing] = medians[0]
        table[f"{standing}_dispersion"] = dispersions[0]
        table[f"{standing}_error"] = np.nanstd(logs[1:], axis=0)
        table[f"{standing}_over_kaneko"] = medians[0] / table["kaneko_m_s"]
        table[f"{standing}_over_p58"] = medians[0] / table["fema_p58_m_s"]
    return table


def causes_table(records: Records) -> pd.DataFrame:
    """What moves the planar median of the pieces: ratio over Kaneko, mean and spread over the pieces.

    Each row changes one thing: the definition of velocity, the motions, or the model; two are of bodies in space.
    """
    sizes = PIECES[["width_m", "height_m"]].to_numpy()
    plane = records.shake(sizes, "plane", MEASURES[0])
    square = records.shake(sizes, "square", MEASURES[0])
    both = records.velocities
    mean = np.sqrt(both.prod(axis=1))
    ones = np.ones((1, len(records.motions)))
    rows: list[dict[str, Any]] = []

    def add(what: str, part: str, medians: Floats) -> None:
        kaneko = velocity_levels(sizes, np.ones(1))[:, 0]
        # what is too squat for the friction slides and has no median
        logs = np.log(medians / kaneko)
        ratio, spread = float(np.exp(np.nanmean(logs))), float(np.nanstd(logs))
        rows.append({"part": part, "what": what, "ratio": ratio, "spread": spread})

    def by(found: Shaken, factors: Floats) -> Floats:
        each = zip(found.reached[-1], found.levels, strict=True)
        return np.array([medians_by(fell, steps, factors)[0] for fell, steps in each])

    own = both.ravel()
    add("PGV of the component that shakes it", "definition", plane.fits(ones)[0][0])
    add("geometric mean of both", "definition", by(plane, np.repeat(mean, 2) / own))
    largest = both.max(axis=1)
    add("larger of both", "definition", by(plane, np.repeat(largest, 2) / own))
    sets = np.array([str(motion.metadata["set"]) for motion in records.motions])
    for name in np.unique(sets):
        words = f"{name.replace('_', ' ')} motions alone"
        add(
            words, "motions", plane.fits((sets == name)[np.newaxis].astype(float))[0][0]
        )
    steps = velocity_levels(sizes, FEWER)
    slides = shaken_in_plane(sizes, records.motions, own, steps, friction=FRICTION)
    words = f"friction of {FRICTION:g}, slides and flies; those that topple"
    add(words, "model", slides.fits(ones)[0][0])
    for ratio in (0.9, 1.02):
        bounces = shaken_in_plane(sizes, records.motions, own, steps, restitution=ratio)
        words = f"restitution {ratio:g} times that of momentum"
        add(words, "model", bounces.fits(ones)[0][0])
    for number in (5, 7):
        words = f"rocks to {LIMITS[number]:g} of the critical angle"
        add(words, "limit", plane.fits(ones, number)[0][0])
    whole = np.ones((1, len(records.pairs)))
    add(
        "square base, both components, by their mean", "space", square.fits(whole)[0][0]
    )
    add(
        "square base, both components, by the larger",
        "space",
        by(square, largest / mean),
    )
    return pd.DataFrame(rows)


def flatness_table(medians: pd.DataFrame) -> pd.DataFrame:
    """How flat the ratio over Kaneko is over all sizes, by standing: mean, spread, extremes."""
    fell = medians[(medians["limit"] == 1) & (medians["measure"] == MEASURES[0])]
    logs = pd.Series(np.log(fell["median"] / fell["kaneko_m_s"]), index=fell.index)
    each = logs.groupby(fell["standing"], sort=False)
    table = pd.DataFrame(
        {
            "sizes": each.size(),
            "ratio": np.exp(each.mean()),
            "spread": each.std(),
            "least": np.exp(each.min()),
            "most": np.exp(each.max()),
            "dispersion": fell.groupby("standing", sort=False)["dispersion"].mean(),
        }
    )
    return table.rename_axis("standing").reset_index()


def study(records: Records, extent: Extent) -> tuple[Mapping[str, pd.DataFrame], Any]:
    """All tables by name, and the rows of the surfaces."""
    tables, rows = [], []
    for table, some in medians_and_surfaces(records, extent):
        tables.append(table)
        rows += some
    medians = pd.concat(tables, ignore_index=True)
    pieces = pieces_table(records)
    found = {
        "medians": medians,
        "flatness": flatness_table(medians),
        "pieces": pieces,
        "bias": bias_table(pieces),
        "causes": causes_table(records),
        "surfaces": pd.DataFrame(rows).drop(columns=["median", "dispersion"]),
    }
    return found, rows


BEGIN, END = (
    "<!-- written by python -m rockfrag.stages.toppling_velocity -->",
    "<!-- end of that -->",
)
NAMES = {"plane": "plane", "square": "square", "oblong": "1 to 2", "round": "round"}


def page_tables(tables: Mapping[str, pd.DataFrame]) -> str:
    """Tables of the page in Markdown: pieces, flatness, causes, bias, surfaces."""
    pieces, causes = tables["pieces"], tables["causes"]
    lines = [
        "| B × H [m] | FEMA P-58 | Kaneko | plane, β, ± | square, β, ± | 1 to 2 | round | plane over Kaneko | "
        "square over Kaneko | plane over P-58 |",
        "|---|--:|--:|---|---|--:|--:|--:|--:|--:|",
    ]
    for row in pieces.to_dict("records"):
        each = [
            f"{row[name]:.3f}, {row[f'{name}_dispersion']:.2f}, {100 * row[f'{name}_error']:.0f} %"
            for name in ("plane", "square")
        ]
        lines.append(
            f"| {row['width_m']:g} × {row['height_m']:g} | {row['fema_p58_m_s']:.3f} | {row['kaneko_m_s']:.3f} | "
            f"{' | '.join(each)} | {row['oblong']:.3f} | {row['round']:.3f} | {row['plane_over_kaneko']:.2f} | "
            f"{row['square_over_kaneko']:.2f} | {row['plane_over_p58']:.2f} |"
        )
    lines += [
        "\nMedians in m/s, dispersions β and standard errors from the choice of earthquakes.\n",
        "| over all sizes | sizes | over Kaneko | spread of ln | least | most | mean β |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for row in tables["flatness"].to_dict("records"):
        lines.append(
            f"| {NAMES[row['standing']]} | {row['sizes']} | {row['ratio']:.2f} | {row['spread']:.3f} | "
            f"{row['least']:.2f} | {row['most']:.2f} | {row['dispersion']:.2f} |"
        )
    lines += [
        "",
        "| what | over Kaneko | spread of ln over the pieces |",
        "|---|--:|--:|",
    ]
    for row in causes.to_dict("records"):
        lines.append(f"| {row['what']} | {row['ratio']:.2f} | {row['spread']:.3f} |")
    lines += [
        "",
        "| cut blocks | bias of ln median | standard error |",
        "|---|--:|--:|",
    ]
    for row in tables["bias"].to_dict("records"):
        lines.append(
            f"| {NAMES[row['standing']]} | {row['bias']:+.2f} | {row['error']:.2f} |"
        )
    lines += [
        "",
        "| surface | limit | held-out sizes, ln | largest | earthquakes, ln |",
        "|---|--:|--:|--:|--:|",
    ]
    velocities = tables["surfaces"]
    velocities = velocities[velocities["measure"] == MEASURES[0]]
    for row in velocities[velocities["limit"].isin((1.0, 0.3, 0.01))].to_dict(
        "records"
    ):
        lines.append(
            f"| {NAMES[row['standing']]} | {row['limit']:g} | {row['residual']:.3f} | {row['largest']:.3f} | "
            f"{row['earthquakes']:.3f} |"
        )
    return "\n".join(lines)


def bias_table(pieces: pd.DataFrame) -> pd.DataFrame:
    """Bias of ln median of cut blocks, plane and square base: simulated over published medians, and its error.

    Kaneko's curve and FEMA P-58 count alike. The standard error has half their distance, as they are two and of
    one law in size, and what the choice of earthquakes does.
    """
    rows = []
    for standing in ("plane", "square"):
        logs = [np.log(pieces[f"{standing}_over_{name}"]) for name in ("kaneko", "p58")]
        kaneko, p58 = float(logs[0].mean()), float(logs[1].mean())
        motions = float(pieces[f"{standing}_error"].mean())
        error = float(np.hypot((p58 - kaneko) / 2, motions))
        rows.append({"standing": standing, "bias": (kaneko + p58) / 2, "error": error})
    return pd.DataFrame(rows)


def write_page(page: Path, tables: Mapping[str, pd.DataFrame]) -> None:
    """Write the tables into the page, between its marks."""
    text = page.read_text(encoding="utf-8")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    with whole_file(page) as path:
        path.write_text(
            f"{before}{BEGIN}\n\n{page_tables(tables)}\n\n{END}{after}",
            encoding="utf-8",
        )


def main(arguments: Sequence[str] | None = None) -> int:
    """Write tables and figure, and the surfaces where a file is named."""
    parser = argparse.ArgumentParser(
        prog="python -m rockfrag.stages.toppling_velocity",
        description="Medians of the velocity that topples blocks, by width and height, beside published ones.",
    )
    parser.add_argument(
        "--output", metavar="FOLDER", default="results/toppling-velocity"
    )
    parser.add_argument("--records", metavar="FOLDER", default=str(RECORDS))
    parser.add_argument("--surface", metavar="FILE", help="write the coefficients here")
    parser.add_argument("--page", metavar="FILE", help="write tables and figure here")
    parser.add_argument("--quick", action="store_true", help="a few sizes and records")
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    extent = QUICK if given.quick else WHOLE
    try:
        records = records_of(extent.every, Path(given.records))
        tables, rows = study(records, extent)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    folder = Path(given.output)
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables.items():
        write_table(table, folder / f"{name}.csv")
    if given.surface:
        text = json.dumps({"surfaces": rows}, indent=1) + "\n"
        with whole_file(Path(given.surface)) as path:
            path.write_text(text, encoding="utf-8")
    page = Path(given.page) if given.page else None
    figures = [folder] if page is None else [folder, page.parent / "images"]
    if page is not None:
        write_page(page, tables)
    with style.figure_style():
        surface = surface_from(rows[0])
        figure = draw_toppling_velocity(tables["medians"], tables["pieces"], surface)
        for place in figures:
            style.save_figure(figure, place / "toppling-velocity.svg")
    print(tables["flatness"].to_string(index=False))
    print(tables["causes"].to_string(index=False))
    return 0


if __name__ == "__main__":
    sys.exit(main())
