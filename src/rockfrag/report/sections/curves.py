"""Fragility: curves by object, in two measures and by floor, and the measure that predicts best."""

import math
from functools import partial

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from rockfrag.base import figure_style as style
from rockfrag.base.files import file_name
from rockfrag.fragility.checks import REJECTION, TAILS
from rockfrag.fragility.curve_facts import REJECTED, compared_curves
from rockfrag.fragility.observations import Floats, name_and_unit
from rockfrag.fragility.vector import INTERACTION_LEVEL, VectorTables
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.report.answer import has_one_record
from rockfrag.report.figures import GREY
from rockfrag.report.findings import ONE_MOTION, strength_found
from rockfrag.report.page import Row
from rockfrag.report.part import FigureSpec, Results, Section, says
from rockfrag.stages.fragility import best_of
from rockfrag.words.sentences import decimals_of, estimates, number, shortened


def fragility(results: Results) -> Section:
    """Curves by object, in the measures and definitions that the study asks for."""
    if has_one_record(results):
        return Section(
            "fragility", "Fragility", f"{ONE_MOTION.headline}.", [ONE_MOTION.text]
        )
    order = {
        configuration.name: i
        for i, configuration in enumerate(results.study.configurations)
    }
    curves = results.table("fragility").sort_values(
        "configuration", key=lambda names: names.map(order), kind="stable"
    )
    known = curves["theta"].notna()
    known_curves = curves[known]
    without = list(dict.fromkeys(curves.loc[~known, "configuration"]))
    found = strength_found(known_curves, results.level)
    rejected = int((known_curves["p_fit"] < REJECTED).sum())
    total = len(known_curves)
    # without warnings that the tables show number by number
    kept = [REJECTION.sub("", str(note)).strip() for note in curves["warnings"] if note]
    others = dict.fromkeys(
        rest for note in kept if (rest := note.replace(TAILS, "").strip())
    )
    notes = [*others, *([TAILS] if any(TAILS in note for note in kept) else [])]
    figures, tables = _figures(results, curves), _tables(known_curves, results.level)
    about = (found, results.level, rejected, total, REJECTED, without, notes)
    return says.section("fragility", [*figures, *tables], *about)


def _figures(results: Results, curves: pd.DataFrame) -> list[FigureSpec]:
    bands, bins = results.table("fragility_bands"), results.table("fragility_bins")
    measure = str(results.table("fragility")["im"].iloc[0])
    same = curves[
        (curves["im"] == measure) & (curves["estimator"] == "mean_probability")
    ]
    same, nonparametric, _ = compared_curves(same)
    specs = []
    for name in results.objects:
        own = [
            each.name for each in results.study.configurations if each.names[-1] == name
        ]
        chosen = same[same["configuration"].isin(own)]
        medians = [
            f"{row['configuration']} {number(row['theta'], decimals_of(row['theta']))} {row['unit']}"
            for row in chosen.dropna(subset=["theta"]).to_dict("records")
        ]
        band, points = (
            table[table["configuration"].isin(own) & (table["im"] == measure)]
            for table in (bands, bins)
        )
        draw = partial(fragility_figure, chosen, band, points, nonparametric)
        about = (name, measure, results.level, nonparametric, medians)
        specs.append(
            says.figure(f"fragility_{file_name(name)}", draw, *about, of="fragility")
        )
    return specs


def _tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading."""
    tables, keys = [], ["im", "unit", "estimator"]
    for (measure, unit, definition), rows in curves.groupby(keys, sort=False):
        shown = rows.assign(lean=[_lean(row) for row in rows.to_dict("records")])
        rejected = (rows["p_fit"] < REJECTED).any()
        about = (str(measure), unit, str(definition), level, rejected)
        tables.append(says.table("curves", shown, *about))
    return tables


def _lean(row: Row) -> str:
    """Group without which the median would change most, and by what factor."""
    if not row["influential"] or not math.isfinite(row["influence"]):
        return "–"
    return f"{row['influential']} (× {number(row['influence'], 2)})"


def two_measures(results: Results) -> Section | None:
    """Fits in two measures; None where the study asks for none."""
    if not results.study.fragility.pairs:
        return None
    names = ("two_measures", "contours", "cells")
    tables = VectorTables(*(results.table(f"fragility_{name}") for name in names))
    return two_measures_section(tables, results.study.fragility.confidence)


def two_measures_section(tables: VectorTables, confidence: float) -> Section | None:
    """Return the section of fits in two measures; None where no tests allowed one."""
    fits = tables.fits
    found = fits[fits["method"] != "none"]
    if found.empty:
        return None
    both = found[["first", "second"]].to_numpy()
    pairs = [
        " and ".join(name_and_unit(measure)[0] for measure in pair) for pair in both
    ]
    keys, parts = ["configuration", "first", "second"], []
    for pair, row in zip(pairs, found[keys].to_dict("records"), strict=True):
        own, tests = (
            t[(t[keys] == pd.Series(row)).all(axis=1)]
            for t in (tables.contours, tables.cells)
        )
        name = file_name(f"two_measures_{'_'.join(map(str, row.values()))}")
        draw, of = partial(two_measures_figure, own, tests), row["configuration"]
        parts.append(says.figure(name, draw, of, pair, of="two_measures"))
    table = says.table(
        "two_measures", found.assign(pair=pairs), file="fragility_two_measures"
    )
    rejected, level = int((found["p_fit"] < REJECTED).sum()), f"{100 * confidence:g} %"
    limits, notes = (INTERACTION_LEVEL, level), list(dict.fromkeys(fits["warnings"]))
    named = ", ".join(dict.fromkeys(pairs))
    about = (named, len(found), rejected, *limits, notes)
    return says.section("two-measures", [*parts, table], *about)


def floor_curves(results: Results) -> Section | None:
    """Fragility on each floor in the peak of that floor's own motion, for each limit state."""
    curves = results.table("fragility_floors")
    shown = curves[(curves["measure"] == "pga_g") & curves["theta"].notna()]
    if has_one_record(results) or shown.empty:
        return None
    # hidden files are the workflow's own marks
    names = (
        path.name for path in (results.folder / "exports").iterdir() if path.is_file()
    )
    files = sorted(name for name in names if not name.startswith("."))
    labels = {state.name: state.label for state in limit_states()}
    theta = estimates(shown, "theta")
    shown = shown.assign(state_text=shown["state"].map(labels), theta_text=theta)
    fallen = shown[shown["state"] == OVERTURNS].to_dict("records")
    weakest = min(fallen, key=lambda row: float(row["theta"]), default=None)
    table = says.table("floors", shown, results.level)
    return says.section("floor_curves", [table], weakest, files)


def measures(results: Results) -> Section:
    """The measure that predicts overturning best."""
    choice = results.table("measure_selection")
    asked = results.study.fragility.measures
    best = choice[choice["recommended"].astype(bool)]
    named = set(best["configuration"])
    none = [
        name for name in dict.fromkeys(choice["configuration"]) if name not in named
    ]
    better = list(dict.fromkeys(best.loc[~best["measure"].isin(list(asked)), "im"]))
    compared = choice["measure"].nunique()
    about = (best_of(choice, asked), better, compared, none)
    return says.section("measures", [says.table("measures", best)], *about)


def fragility_figure(
    curves: pd.DataFrame,
    bands: pd.DataFrame,
    bins: pd.DataFrame,
    nonparametric: bool | None = None,
) -> Figure:
    """Draw fragility curves of one measure, a panel per configuration, with bands and the outcomes behind them.

    ``curves`` are rows of :func:`rockfrag.fragility.fragility_table`; theta is missing where there is no curve.
    For bands and bins see :mod:`rockfrag.fragility.ida_curves`. By default all panels have the nonparametric
    curve, with the lognormal one dotted, where the lognormal curve of one of them is rejected; figures that are
    compared with each other need the same.
    """
    rows, nonparametric, _ = compared_curves(curves, nonparametric)
    used, other = (
        ("fraction", "probability") if nonparametric else ("probability", None)
    )
    lower, upper = (
        ("fraction_lower", "fraction_upper") if nonparametric else ("lower", "upper")
    )
    first = curves.iloc[0]
    size, shape = (
        (style.COLUMN_WIDTH, 0.75 + 1.65 * len(curves)),
        {"nrows": len(curves)},
    )
    with style.panels(*size, **shape, sharex=True, sharey=True, squeeze=False) as (
        figure,
        grid,
    ):
        panels = grid[:, 0]
        for k, (panel, curve) in enumerate(
            zip(panels, rows.to_dict("records"), strict=True)
        ):
            colour = style.CONFIGURATION_COLOURS[k % len(style.CONFIGURATION_COLOURS)]
            own = str(curve["configuration"])
            draw_fractions(panel, bins[bins["configuration"] == own], colour)
            points = bands[bands["configuration"] == own]
            x, low, high = points["x"], points[lower], points[upper]
            panel.fill_between(x, low, high, color=colour, alpha=0.18, linewidth=0)
            if other:
                panel.plot(x, points[other], ":", color=style.BLACK, linewidth=0.9)
            panel.plot(x, points[used], color=colour)
            probability_axis(panel, np.array([bands["x"].min(), bands["x"].max()]))
            words = "no median"
            if np.isfinite(curve["theta"]):
                words = f"θ = {curve['theta']:.3g} {curve['unit']}"
                words += (
                    f", β = {curve['beta']:.2f}" if np.isfinite(curve["beta"]) else ""
                )
            panel.set_title(f"{shortened(own)}: {words}", loc="left")
        style.letter_panels(panels)
        panels[-1].set_xlabel(axis_label(first["im"], first["unit"]))
        figure.supylabel("Probability of overturning", fontsize=8)
        names = (
            ["nonparametric", "lognormal (rejected)"]
            if nonparametric
            else ["lognormal"]
        )
        handles = [
            Line2D([], [], color=GREY),
            Line2D([], [], color=style.BLACK, ls=":", lw=0.9),
        ]
        handles = [
            *handles[: len(names)],
            Line2D([], [], color=GREY, marker="o", ls="", ms=3.2),
        ]
        names.append("analyses in bins")
        figure.legend(handles, names, loc="outside upper center", ncols=2)
        return figure


def draw_fractions(axes: Axes, bins: pd.DataFrame, colour: str) -> None:
    """Fractions of overturned tests in bins with their binomial limits."""
    fraction = bins["fraction"].to_numpy(dtype=float)
    lower, upper = (
        bins[f"fraction_{end}"].to_numpy(dtype=float) for end in ("lower", "upper")
    )
    reach = [np.maximum(fraction - lower, 0.0), np.maximum(upper - fraction, 0.0)]
    x = bins["x"].to_numpy(dtype=float)
    axes.errorbar(
        x, fraction, yerr=reach, fmt="o", color=colour, elinewidth=0.7, ms=3.2, mew=0
    )


def probability_axis(axes: Axes, grid: Floats) -> None:
    """Draw probabilities over a logarithmic measure, from the first to the last value of a grid."""
    axes.set(xlim=(grid[0], grid[-1]), ylim=(-0.02, 1.02))
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
    style.plain_log(axes, "x")


def axis_label(name: str, unit: str) -> str:
    """Return the label of an axis of a measure."""
    name = name[:1].upper() + name[1:]
    return f"{name} [{unit}]" if unit else name


# how contours of probabilities are drawn
LINES = {0.1: "dotted", 0.5: "solid", 0.9: "dashed"}

MEDIAN = 0.5


def two_measures_figure(contours: pd.DataFrame, cells: pd.DataFrame) -> Figure:
    """Draw contours of the fitted probability of overturning over cells of tests.

    The first measure is across, the second one up; the band holds the median's limits.
    """
    first, second = str(cells["first"].iloc[0]), str(cells["second"].iloc[0])
    x, y = cells["at_first"].to_numpy(), cells["at_second"].to_numpy()
    with style.panels(style.COLUMN_WIDTH, 3.2) as (figure, axes):
        size, shades = (
            6 + 30 * np.sqrt(cells["tests"] / cells["tests"].max()),
            cells["probability"],
        )
        shown = axes.scatter(
            x, y, size, shades, marker="s", cmap="Greys", vmin=0, vmax=1
        )
        shown.set(edgecolor="#999999", linewidth=0.3)
        reach, rise = (0.8 * x.min(), 1.25 * x.max()), (0.9 * y.min(), 1.1 * y.max())
        across = bool((contours["of"] == first).all())
        within = reach if across else rise
        fill = axes.fill_betweenx if across else axes.fill_between
        for probability, line in LINES.items():
            part = contours[np.isclose(contours["probability"], probability)]
            at, value = part["at"], part["value"].where(part["value"].between(*within))
            drawn = (value, at) if across else (at, value)
            axes.plot(
                *drawn,
                color=style.BLUE,
                linestyle=line,
                label=f"{100 * probability:.0f} %",
            )
            if probability == MEDIAN:
                lower, upper = (part[side].clip(*within) for side in ("lower", "upper"))
                fill(at, lower, upper, color=style.BLUE, alpha=0.2, linewidth=0)
        axes.set(xlim=reach, ylim=rise, xlabel=_axis(first), ylabel=_axis(second))
        style.plain_log(axes, "xy")
        percent = PercentFormatter(1.0, decimals=0, symbol=" %")
        bar = figure.colorbar(shown, ax=axes, format=percent, pad=0.02)
        bar.set_label("Observed, rising in both measures")
        title = "Fitted probability of overturning"
        figure.legend(loc="outside upper center", ncols=3, title=title)
    return figure


def _axis(column: str) -> str:
    name, unit = name_and_unit(column)
    return f"{name} [{unit}]" if unit else name
