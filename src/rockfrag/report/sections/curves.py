"""Fragility: curves by object, in two measures and by floor, and the measure that predicts best.

In: the results of a study (tables ``fragility…`` and ``measure_selection``). Out: sections of the report with
their tables and figures; medians θ in the unit of their measure, β [-].

Theory: ``docs/fragility.md``.
"""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from rockfrag.base import figure_style as style
from rockfrag.base.figure_style import GREY
from rockfrag.base.files import file_name
from rockfrag.fragility.check_notes import REJECTION, TAILS
from rockfrag.fragility.curve_facts import REJECTED, compared_curves
from rockfrag.fragility.observations import Floats, name_and_unit
from rockfrag.fragility.vector import INTERACTION_LEVEL, VectorTables
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.report.answer import has_one_record
from rockfrag.report.findings import ONE_MOTION, strength_found
from rockfrag.report.page import Row, column, estimated, p_values, table_html
from rockfrag.report.part import FigureSpec, Finding, Results, Section, chapter
from rockfrag.stages.fragility import best_of
from rockfrag.words.sentences import (
    agree,
    decimals_of,
    estimates,
    listed,
    number,
    of_all,
    sentence,
    shortened,
)


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
    words = [_reading(results.level)]
    if rejected:
        words.append(_rejection(rejected, total))
    if without:
        words.append(f"Some definitions give no curve for {listed(without)}.")
    parts: list[Markup | FigureSpec] = [*_figures(results, curves)]
    parts += _tables(known_curves, results.level)
    return _fragility_section(found, [*words, *notes], parts)


def _fragility_section(
    found: Finding | None,
    paragraphs: list[str],
    parts: Sequence[Markup | FigureSpec],
) -> Section:
    """Section of curves, with its finding as the message where there is one."""
    if found is not None:
        return chapter("fragility", "Fragility", found, paragraphs, parts)
    message = "These tests give no fragility curve."
    return Section("fragility", "Fragility", message, paragraphs, parts)


def _reading(level: str) -> str:
    """Paragraph on how curves and their tables are read."""
    return (
        "Lognormal curves have the form Φ(ln(IM/θ)/β). The definition “mean probability” counts every amplitude, "
        "structural resurrections included; “first overturning” and “always overturning” take one amplitude per "
        f"motion. The {level} intervals resample earthquakes or motions, not amplitudes; “open” is a limit that "
        "the data do not set. A small p of the fit rejects the lognormal curve. The last column of each table "
        "gives the factor on the median without the most influential earthquake or motion."
    )


def _rejection(rejected: int, curves: int) -> str:
    """Paragraph on the estimator that is compared where lognormal curves are rejected."""
    return (
        f"{sentence(of_all(rejected, curves, 'lognormal curve'))} {agree(rejected, curves, 'is', 'are')} "
        f"rejected (p below {REJECTED:g}). Where one is, all curves of that measure and reading are compared by "
        "the nonparametric monotone curve: the columns “nonparametric” give its median and half the distance from "
        "its 16 to its 84 % point; its points with their intervals are in the table fragility_fractions."
    )


def _figures(results: Results, curves: pd.DataFrame) -> list[FigureSpec]:
    """Figures of the curves, one an object and limit state."""
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
        band = bands[bands["configuration"].isin(own) & (bands["im"] == measure)]
        points = bins[bins["configuration"].isin(own) & (bins["im"] == measure)]
        known = f"medians {'; '.join(medians)}" if medians else "no curve"
        caption = (
            f"{name}: probability of overturning over {measure}, with {results.level} limits (band). Points are "
            "fractions of all analyses in bins, with binomial limits."
        )
        if nonparametric:
            caption += (
                " Line: nonparametric monotone curve; dotted: lognormal curve, rejected for at least one of "
                "them. The band is wide where all earthquakes agree, because few earthquakes cannot bound a "
                "probability closely."
            )
        spec = FigureSpec(
            name=f"fragility_{file_name(name)}",
            alt=f"Fragility of {name} over {measure}: {known}.",
            caption=caption,
            draw=partial(fragility_figure, chosen, band, points, nonparametric),
        )
        specs.append(spec)
    return specs


def _tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading."""
    tables, keys = [], ["im", "unit", "estimator"]
    for (measure, unit, definition), rows in curves.groupby(keys, sort=False):
        shown = rows.assign(lean=[_lean(row) for row in rows.to_dict("records")])
        columns = [
            column("configuration"),
            estimated("theta", f"Median θ [{unit}]"),
            estimated("beta", "Dispersion β"),
            p_values("p_fit", "p of the fit"),
            column("lean", "Most influential"),
        ]
        if (rows["p_fit"] < REJECTED).any():
            columns.append(estimated("theta_isotonic", "Nonparametric median"))
            columns.append(estimated("beta_isotonic", "Nonparametric β"))
        reading = str(definition).replace("_", " ")
        caption = f"{sentence(str(measure))}, {reading}, with {level} intervals."
        tables.append(table_html(shown, columns, caption))
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
    tables = VectorTables(
        fits=results.table("fragility_two_measures"),
        contours=results.table("fragility_contours"),
        cells=results.table("fragility_cells"),
    )
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
    rows = found[_FIT].to_dict("records")
    parts = [
        _two_measures_spec(tables, row, pair)
        for pair, row in zip(pairs, rows, strict=True)
    ]
    table = table_html(
        found.assign(pair=pairs),
        _PAIR_COLUMNS,
        "Fits in two measures.",
        "fragility_two_measures",
    )
    rejected = int((found["p_fit"] < REJECTED).sum())
    named = ", ".join(dict.fromkeys(pairs))
    message = f"Every fit in {named} describes its tests."
    if rejected:
        message = (
            f"{sentence(of_all(rejected, len(found), 'fit'))} in {named} "
            f"{agree(rejected, len(found), 'does', 'do')} not describe the tests; use the observed "
            "probabilities by cell there."
        )
    reading = (
        "The probability of overturning is Φ(b₀ + b₁ ln IM₁ + b₂ ln IM₂ + b₁₂ ln IM₁ ln IM₂). The product "
        "stands in it where a score test over earthquakes rejects its absence at "
        f"{100 * INTERACTION_LEVEL:.0f} % and it improves the prediction of held-out earthquakes; b₁₂ is 0 "
        f"otherwise. Bands are {100 * confidence:g} % intervals over earthquakes (jackknife). The p of the fit "
        "is from simulated tests in which each motion has one capacity."
    )
    notes = [note for note in dict.fromkeys(fits["warnings"]) if note]
    return Section(
        "two-measures",
        "Fragility in two measures",
        message,
        [reading, *notes],
        [*parts, table],
    )


_FIT = ["configuration", "first", "second"]
"""Columns that say which fit in two measures a row is of."""


def _two_measures_spec(tables: VectorTables, row: Row, pair: str) -> FigureSpec:
    """Figure of one fit in two measures, a row of the table, with its contours and the tests by cell."""
    of_fit = pd.Series(row)
    contours = tables.contours[(tables.contours[_FIT] == of_fit).all(axis=1)]
    tests = tables.cells[(tables.cells[_FIT] == of_fit).all(axis=1)]
    words = (
        f"{row['configuration']}: probability of overturning in {pair}. Lines are fitted, the band holds the "
        "median; squares show the fraction of tests that overturned by cell, rising in both measures."
    )
    name = file_name(f"two_measures_{'_'.join(map(str, row.values()))}")
    draw = partial(two_measures_figure, contours, tests)
    return FigureSpec(name, words, words, draw)


_PAIR_COLUMNS = (
    column("configuration", "Object"),
    column("pair", "Measures"),
    column("c0", "b₀", decimals=2),
    column("c1", "b₁", decimals=2),
    column("c2", "b₂", decimals=2),
    column("c12", "b₁₂", decimals=2),
    column("aic", "AIC", decimals=1),
    column("p_interaction", "p of no interaction", decimals=3),
    column("p_fit", "p of the fit", decimals=3),
)


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
    words = [
        "Each floor by itself, as a function of the peak acceleration of that floor. Curves in other measures "
        "are in the table fragility_floors."
    ]
    if files:
        words.append(
            f"Files for other programs are in the folder exports: {listed(files)}."
        )
    columns = [
        column("configuration"),
        column("floor"),
        column("state_text", "Limit state"),
        column("im", "Measure"),
        column("theta_text", "Median θ [g]", numeric=True),
        estimated("beta", "Dispersion β"),
    ]
    caption = f"Curves by floor, with {results.level} intervals where there are any."
    table = table_html(shown, columns, caption)
    return Section(
        "floor_curves", "Fragility by floor", _weakest(fallen), words, [table]
    )


def _weakest(fallen: Sequence[Row]) -> str:
    """Say which object on which floor has the least median, of rows with a curve of overturning."""
    weakest = min(fallen, key=lambda row: float(row["theta"]), default=None)
    if weakest is None:
        return "No floor has a curve of overturning: too few objects overturned on a single one."
    others = [row["theta_lower"] for row in fallen if row is not weakest]
    word = "is the most fragile"
    if others and not weakest["theta_upper"] < min(others):
        word = "has the least median, but intervals overlap"
    return (
        f"{weakest['configuration']} on {weakest['floor']} {word}: the median of its lognormal curve is "
        f"{weakest['theta_text']} g."
    )


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
    words = [
        "Measures are compared by how well they predict the first overturning amplitude of each motion, over all "
        f"floors. The table recommends one of all {compared} that were compared, whether or not the study gives "
        "curves in it."
    ]
    if none:
        words.append(f"No measure can be recommended for {', '.join(none)}.")
    columns = [
        column("configuration"),
        column("im", "Recommended"),
        column("beta_amplitude", "β", decimals=3),
        column("auc", "AUC", decimals=3),
        column(
            "chosen_fraction",
            "Fraction of bootstrap samples in which it is best",
            decimals=2,
        ),
        column("words", "Reasons"),
    ]
    caption = "Recommended measure of each configuration, with reasons."
    return Section(
        "measures",
        "Recommended intensity measure",
        _recommended(best_of(choice, asked), better),
        words,
        [table_html(best, columns, caption)],
    )


def _recommended(named: Sequence[str], better: Sequence[str]) -> str:
    """Best of the measures that a study asks for, and others that predict better."""
    if not named:
        return "No measure can be recommended."
    verb = "is" if len(named) == 1 else "are"
    words = f"{listed(named)} {verb} the best of the measures asked for."
    if better:
        verb = "predicts" if len(better) == 1 else "predict"
        words += f" Of all compared, {listed(better)} {verb} better."
    return words


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
    first = curves.iloc[0]
    range_of_measure = np.array([bands["x"].min(), bands["x"].max()])
    with style.panels(
        style.COLUMN_WIDTH,
        0.75 + 1.65 * len(curves),
        nrows=len(curves),
        sharex=True,
        sharey=True,
        squeeze=False,
    ) as (figure, grid):
        panels = grid[:, 0]
        for k, (panel, curve) in enumerate(
            zip(panels, rows.to_dict("records"), strict=True)
        ):
            colour = style.CONFIGURATION_COLOURS[k % len(style.CONFIGURATION_COLOURS)]
            own = str(curve["configuration"])
            draw_fractions(panel, bins[bins["configuration"] == own], colour)
            points = bands[bands["configuration"] == own]
            _draw_curve(panel, points, colour, nonparametric=nonparametric)
            probability_axis(panel, range_of_measure)
            panel.set_title(f"{shortened(own)}: {_parameters(curve)}", loc="left")
        style.letter_panels(panels)
        panels[-1].set_xlabel(axis_label(first["im"], first["unit"]))
        figure.supylabel("Probability of overturning", fontsize=8)
        solid = Line2D([], [], color=GREY)
        dots = Line2D([], [], color=GREY, marker="o", ls="", ms=3.2)
        handles = {"lognormal": solid}
        if nonparametric:
            dotted = Line2D([], [], color=style.BLACK, ls=":", lw=0.9)
            handles = {"nonparametric": solid, "lognormal (rejected)": dotted}
        handles["analyses in bins"] = dots
        figure.legend(
            list(handles.values()), list(handles), loc="outside upper center", ncols=2
        )
        return figure


def _draw_curve(
    panel: Axes, points: pd.DataFrame, colour: str, *, nonparametric: bool
) -> None:
    """Draw one fragility curve with its band; with the nonparametric one, the lognormal one dotted."""
    x = points["x"]
    used, lower, upper = "probability", "lower", "upper"
    if nonparametric:
        used, lower, upper = "fraction", "fraction_lower", "fraction_upper"
    panel.fill_between(
        x, points[lower], points[upper], color=colour, alpha=0.18, linewidth=0
    )
    if nonparametric:
        panel.plot(x, points["probability"], ":", color=style.BLACK, linewidth=0.9)
    panel.plot(x, points[used], color=colour)


def _parameters(curve: Row) -> str:
    """Median and dispersion of a curve in words, as far as it has them."""
    if not np.isfinite(curve["theta"]):
        return "no median"
    words = f"θ = {curve['theta']:.3g} {curve['unit']}"
    return words + (f", β = {curve['beta']:.2f}" if np.isfinite(curve["beta"]) else "")


def draw_fractions(axes: Axes, bins: pd.DataFrame, colour: str) -> None:
    """Fractions of overturned tests in bins with their binomial limits."""
    fraction = bins["fraction"].to_numpy(dtype=float)
    lower = bins["fraction_lower"].to_numpy(dtype=float)
    upper = bins["fraction_upper"].to_numpy(dtype=float)
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

    Parameters
    ----------
    contours : points of lines of one probability each (:meth:`VectorFragility.contours`)
    cells : a row a cell of tests, with their number and the fraction of them that overturned

    Returns
    -------
    The figure.
    """
    first, second = str(cells["first"].iloc[0]), str(cells["second"].iloc[0])
    x, y = cells["at_first"].to_numpy(), cells["at_second"].to_numpy()
    # a margin about the cells, in factors as the axes are logarithmic
    reach, rise = (0.8 * x.min(), 1.25 * x.max()), (0.9 * y.min(), 1.1 * y.max())
    with style.panels(style.COLUMN_WIDTH, 3.2) as (figure, axes):
        squares = _draw_cells(axes, cells)
        gives_first = bool((contours["of"] == first).all())
        _draw_contours(axes, contours, gives_first, reach if gives_first else rise)
        axes.set(xlim=reach, ylim=rise, xlabel=_axis(first), ylabel=_axis(second))
        style.plain_log(axes, "xy")
        percent = PercentFormatter(1.0, decimals=0, symbol=" %")
        bar = figure.colorbar(squares, ax=axes, format=percent, pad=0.02)
        bar.set_label("Observed, rising in both measures")
        title = "Fitted probability of overturning"
        figure.legend(loc="outside upper center", ncols=3, title=title)
    return figure


def _draw_cells(axes: Axes, cells: pd.DataFrame) -> PathCollection:
    """Draw a square a cell, darker where more of its tests overturned, larger where it has more tests."""
    squares = axes.scatter(
        cells["at_first"].to_numpy(),
        cells["at_second"].to_numpy(),
        6 + 30 * np.sqrt(cells["tests"] / cells["tests"].max()),
        cells["probability"],
        marker="s",
        cmap="Greys",
        vmin=0,
        vmax=1,
    )
    squares.set(edgecolor=style.GUIDE, linewidth=0.3)
    return squares


def _draw_contours(
    axes: Axes,
    contours: pd.DataFrame,
    gives_first: bool,
    shown: tuple[float, float],
) -> None:
    """Draw lines of one probability each, and the limits of the median.

    Contours give a value of one measure at each of the other: of the first, which is across, or of the second.
    Values are ``shown`` between two limits.
    """
    for probability, line in LINES.items():
        part = contours[np.isclose(contours["probability"], probability)]
        at, value = part["at"], part["value"].where(part["value"].between(*shown))
        x, y = (value, at) if gives_first else (at, value)
        label = f"{100 * probability:.0f} %"
        axes.plot(x, y, color=style.BLUE, linestyle=line, label=label)
        if probability == MEDIAN:
            fill = axes.fill_betweenx if gives_first else axes.fill_between
            lower, upper = part["lower"].clip(*shown), part["upper"].clip(*shown)
            fill(at, lower, upper, color=style.BLUE, alpha=0.2, linewidth=0)


def _axis(column: str) -> str:
    """Label of an axis: the measure of a column with its unit."""
    name, unit = name_and_unit(column)
    return f"{name} [{unit}]" if unit else name
