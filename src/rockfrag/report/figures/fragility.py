"""Fragility curves with their limits, the verdicts behind them, and what no curve can show."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, PercentFormatter

from rockfrag.errors import InputError
from rockfrag.fragility.empirical import local_share, share_in_bins
from rockfrag.fragility.estimators import Fragility
from rockfrag.fragility.goodness import GoodnessOfFit
from rockfrag.fragility.observations import Floats, Outcomes, name_and_unit
from rockfrag.fragility.states import ThreeStates
from rockfrag.fragility.surface import FragilitySurface
from rockfrag.report.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    OKABE_ITO,
    ORANGE,
    PAGE_WIDTH,
    RED,
    SKY,
    figure_style,
    new_figure,
)

GREY = "#777777"


def fragility_figure(
    curves: Mapping[str, Fragility],
    outcomes: Mapping[str, Outcomes] | None = None,
    windows: Mapping[str, pd.DataFrame] | None = None,
    *,
    bins: int = 10,
) -> Figure:
    """Draw fragility curves with confidence bands, verdicts in bins, and survival windows.

    Parameters
    ----------
    curves
        Fitted curves by label, all in one measure; those without a curve are left out.
    outcomes
        Verdicts by label: drawn as shares in bins with 90 % binomial limits, and as a local average
        (dashed), which may fall where the curve cannot.
    windows
        Survival windows of sweeps by label (:func:`rockfrag.fragility.empirical.survival_windows`):
        a second panel gives the share of motions that have overturned at a smaller amplitude and
        yet do not always overturn.
    bins
        Most bins of the verdicts.
    """
    drawn = {label: item for label, item in curves.items() if np.isfinite(item.fit.theta)}
    if not drawn:
        raise InputError("fragility figure: none of the data sets has a curve.")
    first = next(iter(drawn.values())).fit
    if any((item.fit.im, item.fit.unit) != (first.im, first.unit) for item in drawn.values()):
        raise InputError("fragility figure: the curves are in different measures; draw each apart.")
    known = [(outcomes or {}).get(label) for label in drawn]
    grid = _grid(list(drawn.values()), [data for data in known if data is not None])
    with figure_style():
        height = 2.6 if windows is None else 3.5
        figure = new_figure(COLUMN_WIDTH, height)
        if windows is None:
            axes = figure.subplots()
            lowest = axes
        else:
            axes, lowest = figure.subplots(
                2, 1, sharex=True, gridspec_kw={"height_ratios": (3.2, 1.0)}
            )
        for k, (label, item) in enumerate(drawn.items()):
            colour = OKABE_ITO[k % len(OKABE_ITO)]
            data = (outcomes or {}).get(label)
            if data is not None:
                shift = 1.0 + 0.02 * (k - 0.5 * (len(drawn) - 1))
                _verdicts(axes, data, grid, colour, bins, shift)
            _curve(axes, item, grid, colour, label)
            if windows is not None and label in windows:
                _windows(lowest, windows[label], grid, colour)
        _probability_axis(axes, grid)
        axes.set_ylabel("Probability of overturning")
        axes.legend(loc="upper left", handlelength=1.4, borderaxespad=0.2)
        if windows is not None:
            lowest.set_ylim(0, None)
            lowest.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
            lowest.set_ylabel("Between first\nand always")
        lowest.set_xlabel(_axis_label(first.im, first.unit))
        return figure


def measures_figure(
    curves: Mapping[str, Fragility], outcomes: Mapping[str, Outcomes], *, bins: int = 10
) -> Figure:
    """Draw the curve of each measure in a panel of its own, with AIC and β, to compare measures."""
    labels = [label for label, item in curves.items() if np.isfinite(item.fit.theta)]
    if not labels:
        raise InputError("measures figure: none of the measures has a curve.")
    columns = min(len(labels), 3)
    rows = -(-len(labels) // columns)
    with figure_style():
        width = COLUMN_WIDTH if columns == 1 else PAGE_WIDTH
        figure = new_figure(width, 2.5 * rows)
        grid_of_axes = figure.subplots(rows, columns, squeeze=False, sharey=True)
        for axes in grid_of_axes.flat[len(labels) :]:
            axes.set_visible(False)
        for axes, label in zip(grid_of_axes.flat, labels, strict=False):
            item, data = curves[label], outcomes[label]
            grid = _grid([item], [data])
            _verdicts(axes, data, grid, BLACK, bins, 1.0)
            _curve(axes, item, grid, BLUE, "")
            _probability_axis(axes, grid)
            axes.set_title(
                f"{item.fit.im}: AIC {item.fit.aic:.1f}, β = {item.fit.beta:.2f}", loc="left"
            )
            axes.set_xlabel(_axis_label(item.fit.im, item.fit.unit))
        for axes in grid_of_axes[:, 0]:
            axes.set_ylabel("Probability of overturning")
        return figure


def surface_figure(
    surface: FragilitySurface, tests: pd.DataFrame, *, overturned: str = "overturned"
) -> Figure:
    """Draw the tests in two measures with lines of equal fitted probability of overturning."""
    x_column, y_column = surface.measures
    fell = tests[overturned].to_numpy(dtype=np.float64) > 0
    x, y = (tests[column].to_numpy(dtype=np.float64) for column in surface.measures)
    x_grid, y_grid = (np.geomspace(0.85 * v.min(), 1.18 * v.max(), 200) for v in (x, y))
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 3.1)
        axes = figure.subplots()
        axes.plot(x[~fell], y[~fell], "o", mfc="none", mec=SKY, mew=0.7, ms=3, label="survived")
        axes.plot(x[fell], y[fell], "^", color=RED, mew=0, ms=3.2, alpha=0.75, label="overturned")
        chance = surface.probability(x_grid[None, :], y_grid[:, None])
        lines = axes.contour(
            x_grid,
            y_grid,
            chance,
            levels=[0.05, 0.5, 0.95],
            colors=BLACK,
            linewidths=(0.8, 1.3, 0.8),
            linestyles=("dotted", "solid", "dashed"),
        )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.clabel(lines, fmt=lambda value: f"{value:.0%}", fontsize=7)
        _plain_log(axes, "x")
        _plain_log(axes, "y")
        axes.set_xlabel(_axis_label(*name_and_unit(x_column)))
        axes.set_ylabel(_axis_label(*name_and_unit(y_column)))
        figure.legend(loc="outside upper center", ncols=2, handletextpad=0.2)
        return figure


def calibration_figure(judged: Mapping[str, GoodnessOfFit]) -> Figure:
    """Draw observed against fitted shares in bins; points on the diagonal are well calibrated."""
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 3.0)
        axes = figure.subplots()
        axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        for k, (label, fit) in enumerate(judged.items()):
            table = fit.calibration
            share = table["observed"].to_numpy()
            reach = [
                np.maximum(share - table["observed_lower"].to_numpy(), 0.0),
                np.maximum(table["observed_upper"].to_numpy() - share, 0.0),
            ]
            axes.errorbar(
                table["predicted"],
                share,
                yerr=reach,
                fmt="os^Dv"[k % 5],
                color=OKABE_ITO[k % len(OKABE_ITO)],
                markersize=3.5,
                elinewidth=0.8,
                label=f"{label} (p = {fit.p_value:.2g})",
            )
        axes.set_aspect("equal")
        axes.set_xlim(-0.02, 1.02)
        axes.set_ylim(-0.02, 1.02)
        axes.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
        axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
        axes.set_xlabel("Fitted probability")
        axes.set_ylabel("Share that overturned")
        axes.legend(loc="upper left", handletextpad=0.3)
        return figure


def states_figure(states: ThreeStates) -> Figure:
    """Draw the probabilities of no rocking, safe rocking and overturning over the measure."""
    fit = states.overturn.fit
    if not np.isfinite(fit.theta):
        raise InputError(f"states figure: there is no curve of overturning ({fit.method}).")
    low = min(0.6 * states.threshold_g, 0.5 * fit.theta) if states.rock is None else 0.2 * fit.theta
    grid = np.geomspace(low, fit.theta * np.exp(2.5 * fit.beta), 400)
    if states.rock is None:
        # the step at the threshold is upright, not a slope between two points of the grid
        edge = states.threshold_g
        grid = np.sort(np.concatenate([grid, [edge, np.nextafter(edge, np.inf)]]))
    chance = states.probabilities(grid)
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 2.6)
        axes = figure.subplots()
        axes.stackplot(
            grid,
            chance["overturned"],
            chance["safe_rocking"],
            chance["no_rocking"],
            colors=(ORANGE, SKY, "#e6e6e6"),
            labels=("overturned", "safe rocking", "no rocking"),
            linewidth=0,
        )
        axes.set_ylim(0, 1)
        _probability_axis(axes, grid)
        axes.set_ylim(0, 1)
        axes.set_ylabel("Probability")
        axes.set_xlabel(_axis_label(fit.im, fit.unit))
        figure.legend(loc="outside upper center", ncols=3, handlelength=1.0)
        return figure


def _curve(axes: Axes, item: Fragility, grid: Floats, colour: str, label: str) -> None:
    lower, upper = item.interval.band(grid)
    if np.isfinite(lower).any():
        axes.fill_between(grid, lower, upper, color=colour, alpha=0.18, linewidth=0)
    words = f"{label}: " if label else ""
    theta = f"{words}θ = {item.fit.theta:.3g} {item.fit.unit}, β = {item.fit.beta:.2f}"
    axes.plot(grid, item.fit.probability(grid), color=colour, label=theta)


def _verdicts(
    axes: Axes, data: Outcomes, grid: Floats, colour: str, bins: int, shift: float
) -> None:
    table = share_in_bins(data, bins)
    share = table["share"].to_numpy()
    reach = [
        np.maximum(share - table["share_lower"].to_numpy(), 0.0),
        np.maximum(table["share_upper"].to_numpy() - share, 0.0),
    ]
    axes.errorbar(
        table["im"] * shift,
        share,
        yerr=reach,
        fmt="o",
        color=colour,
        markersize=3.2,
        elinewidth=0.7,
        markeredgewidth=0,
    )
    inside = grid[(grid >= data.im.min()) & (grid <= data.im.max())]
    if inside.size and np.ptp(data.log_im) > 0:
        axes.plot(inside, local_share(data, inside), "--", color=colour, linewidth=0.8)


def _windows(axes: Axes, windows: pd.DataFrame, grid: Floats, colour: str) -> None:
    """Share of motions that overturned at a smaller amplitude but not yet at all larger ones."""
    fell = windows[windows["first_upper"].notna()]
    if len(fell) == 0:
        return
    first = fell["first_upper"].to_numpy()[:, None]
    always = fell["always_upper"].fillna(np.inf).to_numpy()[:, None]
    axes.plot(grid, ((grid >= first) & (grid < always)).mean(axis=0), color=colour, linewidth=1.0)


def _grid(curves: Sequence[Fragility], data: Sequence[Outcomes]) -> Floats:
    """Values from where the lowest curve leaves zero to where the highest reaches one."""
    low = min(item.fit.theta * np.exp(-2.6 * item.fit.beta) for item in curves)
    high = max(item.fit.theta * np.exp(2.6 * item.fit.beta) for item in curves)
    if data:
        # neither a nearly flat curve nor amplitudes far above all curves may stretch the axis
        low = max(low, 0.8 * min(float(item.im.min()) for item in data))
        high = min(high, 1.25 * max(float(item.im.max()) for item in data))
    return np.asarray(np.geomspace(low, high, 400))


def _probability_axis(axes: Axes, grid: Floats) -> None:
    axes.set_xscale("log")
    axes.set_xlim(grid[0], grid[-1])
    axes.set_ylim(-0.02, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    _plain_log(axes, "x")


def _plain_log(axes: Axes, which: str) -> None:
    """Label 0.1, 0.2, 0.5, 1, 2, 5, … instead of powers of ten."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    low, high = axes.get_xlim() if which == "x" else axes.get_ylim()
    decades = np.log10(high / low)
    steps = (1.0, 2.0, 5.0) if decades < 2.5 else (1.0, 3.0)
    axis.set_major_locator(LogLocator(base=10.0, subs=steps, numticks=30))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _axis_label(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name
