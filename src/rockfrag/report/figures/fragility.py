"""Fragility curves with their limits, the outcomes behind them, and what no curve can show."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from rockfrag import figure_style as style
from rockfrag.errors import InputError
from rockfrag.fragility.curve_facts import compared_curves
from rockfrag.fragility.empirical import fraction_in_bins, local_fraction
from rockfrag.fragility.observations import Floats, Observations
from rockfrag.report.wording import shortened

if TYPE_CHECKING:
    from rockfrag.fragility.checks import GoodnessOfFit
    from rockfrag.fragility.estimators import Fragility

GREY = "#777777"


def fragility_figure(
    curves: pd.DataFrame, bands: pd.DataFrame, bins: pd.DataFrame, nonparametric: bool | None = None
) -> Figure:
    """Draw fragility curves of one measure, a panel per configuration, with bands and the outcomes behind them.

    ``curves`` are rows of :func:`rockfrag.fragility.fragility_table`; theta is missing where there is no curve.
    For bands and bins see :mod:`rockfrag.fragility.ida_curves`. By default all panels have the nonparametric
    curve, with the lognormal one dotted, where the lognormal curve of one of them is rejected; figures that are
    compared with each other need the same.
    """
    rows, nonparametric, _ = compared_curves(curves, nonparametric)
    used, other = ("fraction", "probability") if nonparametric else ("probability", None)
    lower, upper = ("fraction_lower", "fraction_upper") if nonparametric else ("lower", "upper")
    first = curves.iloc[0]
    with style.figure_style():
        figure = style.new_figure(style.COLUMN_WIDTH, 0.75 + 1.65 * len(curves))
        panels = figure.subplots(len(curves), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for k, (panel, curve) in enumerate(zip(panels, rows.to_dict("records"), strict=True)):
            colour = style.CONFIGURATION_COLOURS[k % len(style.CONFIGURATION_COLOURS)]
            own = str(curve["configuration"])
            _fractions(panel, bins[bins["configuration"] == own], colour)
            points = bands[bands["configuration"] == own]
            x, low, high = points["x"], points[lower], points[upper]
            panel.fill_between(x, low, high, color=colour, alpha=0.18, linewidth=0)
            if other:
                panel.plot(x, points[other], ":", color=style.BLACK, linewidth=0.9)
            panel.plot(x, points[used], color=colour)
            _probability_axis(panel, np.array([bands["x"].min(), bands["x"].max()]))
            words = "no median"
            if np.isfinite(curve["theta"]):
                words = f"θ = {curve['theta']:.3g} {curve['unit']}"
                words += f", β = {curve['beta']:.2f}" if np.isfinite(curve["beta"]) else ""
            panel.set_title(f"{shortened(own)}: {words}", loc="left")
        style.letter_panels(panels)
        panels[-1].set_xlabel(_axis_label(first["im"], first["unit"]))
        figure.supylabel("Probability of overturning", fontsize=8)
        names = ["nonparametric", "lognormal (rejected)"] if nonparametric else ["lognormal"]
        handles = [Line2D([], [], color=GREY), Line2D([], [], color=style.BLACK, ls=":", lw=0.9)]
        handles = [*handles[: len(names)], Line2D([], [], color=GREY, marker="o", ls="", ms=3.2)]
        names.append("analyses in bins")
        figure.legend(handles, names, loc="outside upper center", ncols=2)
        return figure


def _fractions(axes: Axes, bins: pd.DataFrame, colour: str) -> None:
    """Fractions of overturned tests in bins with their binomial limits."""
    fraction = bins["fraction"].to_numpy(dtype=float)
    lower, upper = (bins[f"fraction_{end}"].to_numpy(dtype=float) for end in ("lower", "upper"))
    reach = [np.maximum(fraction - lower, 0.0), np.maximum(upper - fraction, 0.0)]
    x = bins["x"].to_numpy(dtype=float)
    axes.errorbar(x, fraction, yerr=reach, fmt="o", color=colour, elinewidth=0.7, ms=3.2, mew=0)


def measures_figure(
    curves: Mapping[str, "Fragility"], outcomes: Mapping[str, Observations]
) -> Figure:
    """Draw the curve of each measure in a panel of its own, with AIC and β, to compare measures."""
    labels = [label for label, curve in curves.items() if np.isfinite(curve.fit.theta)]
    if not labels:
        raise InputError("measures figure: none of the measures has a curve.")
    columns = min(len(labels), 2)
    rows = -(-len(labels) // columns)
    with style.figure_style():
        figure = style.new_figure(style.COLUMN_WIDTH if columns == 1 else style.WIDEST, 2.4 * rows)
        grid_of_axes = figure.subplots(rows, columns, squeeze=False, sharey=True)
        for axes in grid_of_axes.flat[len(labels) :]:
            axes.set_visible(False)
        for axes, label in zip(grid_of_axes.flat, labels, strict=False):
            curve, data = curves[label], outcomes[label]
            grid = _grid(curve, data)
            _outcomes(axes, data, grid)
            lower, upper = curve.interval.band(grid)
            if np.isfinite(lower).any():
                axes.fill_between(grid, lower, upper, color=style.BLUE, alpha=0.18, linewidth=0)
            axes.plot(grid, curve.fit.probability(grid), color=style.BLUE)
            _probability_axis(axes, grid)
            axes.set_title(
                f"{curve.fit.im}: AIC {curve.fit.aic:.1f}, β = {curve.fit.beta:.2f}", loc="left"
            )
            axes.set_xlabel(_axis_label(curve.fit.im, curve.fit.unit))
        for axes in grid_of_axes[:, 0]:
            axes.set_ylabel("Probability of overturning")
        style.letter_panels(grid_of_axes.flat[: len(labels)])
        return figure


def calibration_figure(judged: Mapping[str, "GoodnessOfFit"]) -> Figure:
    """Draw observed against fitted fractions in bins; points on the diagonal are well calibrated."""
    with style.one_panel(style.COLUMN_WIDTH, 3.0) as (figure, axes):
        axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        for k, (label, fit) in enumerate(judged.items()):
            names = ("predicted", "observed", "observed_lower", "observed_upper")
            x, y, lower, upper = (fit.calibration[name].to_numpy() for name in names)
            axes.errorbar(
                x,
                y,
                yerr=[np.maximum(y - lower, 0.0), np.maximum(upper - y, 0.0)],
                fmt="os^Dv"[k % 5],
                color=style.OKABE_ITO[k % len(style.OKABE_ITO)],
                markersize=3.5,
                elinewidth=0.8,
                label=f"{label} (p = {fit.p_value:.2g})",
            )
        axes.set(aspect="equal", xlim=(-0.02, 1.02), ylim=(-0.02, 1.02))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
        axes.set(xlabel="Fitted probability", ylabel="Fraction overturned")
        axes.legend(loc="upper left", handletextpad=0.3)
        return figure


def _outcomes(axes: Axes, data: Observations, grid: Floats) -> None:
    _fractions(axes, fraction_in_bins(data).rename(columns={"im": "x"}), style.BLACK)
    inside = grid[(grid >= data.im.min()) & (grid <= data.im.max())]
    if inside.size and np.ptp(data.log_im) > 0:
        axes.plot(inside, local_fraction(data, inside), "--", color=style.BLACK, linewidth=0.8)


def _grid(curve: "Fragility", data: Observations) -> Floats:
    """Values from where a curve leaves zero to where it reaches one."""
    low, high = (curve.fit.theta * np.exp(sign * 2.6 * curve.fit.beta) for sign in (-1, 1))
    # neither a nearly flat curve nor amplitudes far above it may stretch the axis
    low, high = max(low, 0.8 * float(data.im.min())), min(high, 1.25 * float(data.im.max()))
    return np.asarray(np.geomspace(low, high, 400))


def _probability_axis(axes: Axes, grid: Floats) -> None:
    axes.set(xlim=(grid[0], grid[-1]), ylim=(-0.02, 1.02))
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
    style.plain_log(axes, "x")


def _axis_label(name: str, unit: str) -> str:
    name = name[:1].upper() + name[1:]
    return f"{name} [{unit}]" if unit else name
