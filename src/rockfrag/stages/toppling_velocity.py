"""Velocity that topples, by width and height: medians, what explains their distance from published ones, surfaces.

    python -m rockfrag.stages.toppling_velocity --output results/toppling-velocity

shakes uniform blocks by the default records, in the plane and in space, and writes tables and the figure of
docs/toppling-velocity.md; ``--surface FILE`` writes the coefficients that the package looks up.

    python -m rockfrag.stages.toppling_velocity --cause pulse --pieces own.csv

prints one row of the table of causes, of the bookcases of FEMA P-58 or of other pieces, and stops there.
"""

import argparse
import json
import logging
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base import figure_style as style
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file, write_table
from rockfrag.base.tabular import read_rows
from rockfrag.effects.shaken_records import SEED, Records
from rockfrag.effects.toppling_causes import (
    BOOKCASES,
    CAUSES,
    ShakenPieces,
    cause_named,
    causes_table,
)
from rockfrag.effects.toppling_velocity import (
    grid_of_sizes,
    random_sizes,
    surface_coefficients,
)
from rockfrag.effects.toppling_velocity_figure import draw_toppling_velocity
from rockfrag.fragility.toppling_velocity import (
    LIMITS,
    MEASURES,
    STANDINGS,
    surface_from,
    terms_of,
)
from rockfrag.simulation.closed_forms import kaneko_velocity
from rockfrag.stages.space_study import RECORDS, wide_set

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


def records_of(every: int, folder: Path) -> Records:
    """Both components of every so many of the default records."""
    pairs, earthquakes = wide_set(every, folder)
    return Records(pairs, earthquakes)


def kept_surfaces(
    records: Records, extent: Extent, folder: Path
) -> Iterator[tuple[pd.DataFrame, list[dict[str, Any]]]]:
    """Yield medians and surfaces of each standing and measure; those that an earlier run has left are read."""
    for standing, measure in product(STANDINGS, MEASURES):
        table_at = folder / f"medians-{standing}-{measure}.csv"
        rows_at = folder / f"surfaces-{standing}-{measure}.json"
        if not (table_at.exists() and rows_at.exists()):
            table, rows = medians_and_surfaces(records, extent, standing, measure)
            write_table(table, table_at)
            _write_json(rows, rows_at)
        rows = json.loads(rows_at.read_text(encoding="utf-8"))
        yield pd.read_csv(table_at), rows


def _write_json(content: Any, file: Path) -> None:
    with whole_file(file) as path:
        path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def medians_and_surfaces(
    records: Records, extent: Extent, standing: str, measure: str
) -> tuple[pd.DataFrame, list[dict[str, Any]]]:
    """Medians and surfaces of a standing in a measure, judged by sizes that the fit has not seen.

    Parameters
    ----------
    records, extent : motions, and how many sizes are shaken
    standing, measure : how blocks stand, and the measure of the medians

    Returns
    -------
    The medians, a row a size and limit state, and a row a surface.
    """
    sizes = grid_of_sizes(*(extent.plane if standing == "plane" else extent.space))
    others = random_sizes(extent.held_out, SEED)
    weights, rows, tables = records.weights(standing), [], []
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
        rows.append({"standing": standing, "limit": limit, "measure": measure} | row)
        table = _table(sizes, medians, dispersions[0])
        tables.append(table.assign(standing=standing, measure=measure, limit=limit))
    _LOG.info("%s, %s", standing, measure)
    return pd.concat(tables, ignore_index=True), rows


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


def pieces_table(
    shaken: ShakenPieces, standings: Sequence[str] = STANDINGS
) -> pd.DataFrame:
    """Pieces of furniture with published medians and simulated ones, and their ratios over both.

    Parameters
    ----------
    shaken, standings : the pieces under the records, and how they stand
    """
    records = shaken.records
    kaneko = [kaneko_velocity(*size) for size in shaken.sizes.tolist()]
    table = shaken.pieces.assign(kaneko_m_s=kaneko)
    for standing in standings:
        found = shaken.standing(standing)
        medians, dispersions = found.fits(records.weights(standing))
        logs = np.log(medians)
        table[standing] = medians[0]
        table[f"{standing}_dispersion"] = dispersions[0]
        table[f"{standing}_error"] = np.nanstd(logs[1:], axis=0)
        table[f"{standing}_over_kaneko"] = medians[0] / table["kaneko_m_s"]
        table[f"{standing}_over_p58"] = medians[0] / table["fema_p58_m_s"]
    return table


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


def study(
    records: Records, extent: Extent, folder: Path
) -> tuple[Mapping[str, pd.DataFrame], Any]:
    """All tables by name, and the rows of the surfaces.

    Parameters
    ----------
    records, extent : motions, and how many sizes are shaken
    folder : in which what was computed before is kept
    """
    tables, rows = [], []
    for table, some in kept_surfaces(records, extent, folder):
        tables.append(table)
        rows += some
    medians = pd.concat(tables, ignore_index=True)
    shaken = ShakenPieces(records, BOOKCASES)
    pieces = pieces_table(shaken)
    found = {
        "medians": medians,
        "flatness": flatness_table(medians),
        "pieces": pieces,
        "bias": bias_table(pieces),
        "causes": causes_table(shaken),
        "surfaces": pd.DataFrame(rows).drop(columns=["median", "dispersion"]),
    }
    return found, rows


BEGIN, END = (
    "<!-- written by python -m rockfrag.stages.toppling_velocity -->",
    "<!-- end of that -->",
)
NAMES = {"plane": "plane", "square": "square", "oblong": "1 to 2", "round": "round"}


def page_tables(tables: Mapping[str, pd.DataFrame]) -> str:
    """Write the tables of ``docs/toppling-velocity.md`` in Markdown, a blank line between them.

    Parameters
    ----------
    tables : ``pieces``, ``flatness``, ``causes``, ``bias`` and ``surfaces``, as :func:`study` makes them

    Returns
    -------
    The text between the marks ``BEGIN`` and ``END`` of the page.
    """
    pieces = tables["pieces"]
    parts = [
        piece_lines(pieces),
        [
            "Medians in m/s, dispersions β and standard errors from the choice of earthquakes."
        ],
        flatness_lines(tables["flatness"]),
        flat_lines(pieces),
        cause_lines(tables["causes"]),
        bias_lines(tables["bias"]),
        surface_lines(tables["surfaces"]),
    ]
    return "\n\n".join("\n".join(lines) for lines in parts)


def piece_lines(pieces: pd.DataFrame) -> list[str]:
    """Table in Markdown of pieces of furniture, with published and simulated medians."""
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
    return lines


def flatness_lines(flatness: pd.DataFrame) -> list[str]:
    """Table in Markdown of how flat the ratio over Kaneko is over all sizes."""
    lines = [
        "| over all sizes | sizes | over Kaneko | spread of ln | least | most | mean β |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for row in flatness.to_dict("records"):
        lines.append(
            f"| {NAMES[row['standing']]} | {row['sizes']} | {row['ratio']:.2f} | {row['spread']:.3f} | "
            f"{row['least']:.2f} | {row['most']:.2f} | {row['dispersion']:.2f} |"
        )
    return lines


def bias_lines(bias: pd.DataFrame) -> list[str]:
    """Table in Markdown of the bias of cut blocks, simulated over published medians."""
    lines = [
        "| cut blocks | bias of ln median | standard error |",
        "|---|--:|--:|",
    ]
    for row in bias.to_dict("records"):
        lines.append(
            f"| {NAMES[row['standing']]} | {row['bias']:+.2f} | {row['error']:.2f} |"
        )
    return lines


def surface_lines(surfaces: pd.DataFrame) -> list[str]:
    """Table in Markdown of how far surfaces are off, for some of their limits."""
    lines = [
        "| surface | by | limit | held-out sizes, ln | largest | earthquakes, ln |",
        "|---|---|--:|--:|--:|--:|",
    ]
    shown = surfaces["limit"].isin((1.0, 0.3, 0.01))
    for row in surfaces[shown].to_dict("records"):
        measure = "PGV" if row["measure"] == MEASURES[0] else "PGA"
        lines.append(
            f"| {NAMES[row['standing']]} | {measure} | {row['limit']:g} | {row['residual']:.3f} | "
            f"{row['largest']:.3f} | {row['earthquakes']:.3f} |"
        )
    return lines


def flat_lines(pieces: pd.DataFrame) -> list[str]:
    """Table in Markdown of how flat the ratios of the pieces are over published medians."""
    lines = [
        f"| over {len(pieces)} pieces | mean | least | most | furthest from the mean |",
        "|---|--:|--:|--:|--:|",
    ]
    for standing in ("plane", "square"):
        for name, words in (("kaneko", "Kaneko"), ("p58", "P-58")):
            ratio = pieces[f"{standing}_over_{name}"]
            away = (ratio / ratio.mean() - 1).abs().max()
            lines.append(
                f"| {NAMES[standing]} over {words} | {ratio.mean():.2f} | {ratio.min():.2f} | {ratio.max():.2f} | "
                f"{100 * away:.0f} % |"
            )
    return lines


def cause_lines(causes: pd.DataFrame) -> list[str]:
    """Table of causes in Markdown."""
    lines = [
        "| `--cause` | what is changed | over Kaneko | ± | spread over pieces | takes off, of the difference "
        "to Kaneko | over P-58 | takes off, of that to P-58 |",
        "|---|---|--:|--:|--:|--:|--:|--:|",
    ]
    for row in causes.to_dict("records"):
        lines.append(
            f"| {row['cause']} | {row['what']} | {row['ratio']:.2f} | {100 * row['error']:.0f} % | "
            f"{row['spread']:.3f} | {100 * row['of_kaneko']:.0f} % | {row['over_p58']:.2f} | "
            f"{100 * row['of_p58']:.0f} % |"
        )
    return lines


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


def around_tables(page: Path) -> tuple[str, str]:
    """Read what stands before and after the tables of a page; nothing of one that is not there yet."""
    if not page.exists():
        return "", "\n"
    before, begun, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, ended, after = rest.partition(END)
    if not begun or not ended:
        raise InputError(
            f"{page}: tables stand between the lines {BEGIN} and {END}; write them there, or name a new file."
        )
    return before, after


def write_page(page: Path, tables: Mapping[str, pd.DataFrame]) -> None:
    """Write the tables into the page, between its marks."""
    before, after = around_tables(page)
    with whole_file(page) as path:
        path.write_text(
            f"{before}{BEGIN}\n\n{page_tables(tables)}\n\n{END}{after}",
            encoding="utf-8",
        )


def pieces_of(file: str) -> pd.DataFrame:
    """Pieces of furniture of a file, with names if it has them, sizes [m] and the medians of FEMA P-58 [m/s]."""
    *sizes, published = BOOKCASES.columns
    rows = read_rows(file, [*sizes, published], ["name"], quantities=sizes)
    pieces = pd.DataFrame(
        [
            {name: row.quantity(name, 0.0) for name in sizes}
            | {published: row.number(published, 0.0)}
            for row in rows
        ]
    )
    if rows[0].has("name"):
        pieces.insert(0, "name", [row.text("name") for row in rows])
    return pieces


def print_pieces(shaken: ShakenPieces, causes: Sequence[str]) -> None:
    """Print rows of the table of causes or, of no causes, what pieces do beside published medians."""
    if causes:
        table = causes_table(shaken, [cause_named(name) for name in causes])
        print("\n".join(cause_lines(table)))
        return
    pieces = pieces_table(shaken, ("plane", "square"))
    print(pieces.round(3).to_string(index=False))
    print("\n".join(flat_lines(pieces)))


def _parser() -> argparse.ArgumentParser:
    """Make the parser of the command."""
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
    words = "take up a run that was interrupted, by what it left in the folder"
    parser.add_argument("--resume", action="store_true", help=words)
    words = f"print this row of the causes alone: {', '.join(c.name for c in CAUSES)}"
    parser.add_argument("--cause", metavar="NAME", action="append", help=words)
    words = "pieces of your own: width_m (that rocks), height_m, fema_p58_m_s, name; print their ratios alone"
    parser.add_argument("--pieces", metavar="FILE", help=words)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Write tables and figure, and the surfaces where a file is named."""
    given = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    extent = QUICK if given.quick else WHOLE
    page = Path(given.page) if given.page else None
    try:
        if page is not None:
            # before what takes hours
            around_tables(page)
        records = records_of(extent.every, Path(given.records))
        if given.cause or given.pieces:
            own = pieces_of(given.pieces) if given.pieces else BOOKCASES
            print_pieces(ShakenPieces(records, own), given.cause or ())
            return 0
        folder = Path(given.output)
        folder.mkdir(parents=True, exist_ok=True)
        if not given.resume:
            for file in folder.glob("surfaces-*.json"):
                file.unlink()
        tables, rows = study(records, extent, folder)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    for name, table in tables.items():
        write_table(table, folder / f"{name}.csv")
    if given.surface:
        _write_json({"surfaces": rows}, Path(given.surface))
    figures = [folder]
    if page is not None:
        write_page(page, tables)
        figures.append(page.parent / "images")
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
