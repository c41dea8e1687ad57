"""Fragility curves with their limits, the outcomes behind them, and what no curve can show."""

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from rockfrag.errors import InputError
from rockfrag.figure_style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    CONFIGURATION_COLOURS,
    OKABE_ITO,
    WIDEST,
    figure_style,
    letter_panels,
    new_figure,
    one_panel,
    plain_log,
)
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
    compared = compared_curves(curves, nonparametric)
    first = curves.iloc[0]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.75 + 1.65 * len(curves))
        panels = figure.subplots(len(curves), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for k, (panel, curve) in enumerate(
            zip(panels, compared.rows.to_dict("records"), strict=True)
        ):
            colour = CONFIGURATION_COLOURS[k % len(CONFIGURATION_COLOURS)]
            own = str(curve["configuration"])
            _fractions(panel, bins[bins["configuration"] == own], colour)
            points = bands[bands["configuration"] == own]
            _compared_curve(panel, points, colour, compared.nonparametric)
            _probability_axis(panel, np.array([bands["x"].min(), bands["x"].max()]))
            panel.set_title(f"{shortened(own)}: {_curve_words(curve)}", loc="left")
        letter_panels(panels)
        panels[-1].set_xlabel(_axis_label(first["im"], first["unit"]))
        figure.supylabel("Probability of overturning", fontsize=8)
        figure.legend(
            handles=_curve_handles(compared.nonparametric), loc="outside upper center", ncols=2
        )
        return figure


def _compared_curve(axes: Axes, points: pd.DataFrame, colour: str, nonparametric: bool) -> None:
    """Draw the curve that is to be used with its band, and the other one without."""
    lower, upper = ("fraction_lower", "fraction_upper") if nonparametric else ("lower", "upper")
    axes.fill_between(
        points["x"], points[lower], points[upper], color=colour, alpha=0.18, linewidth=0
    )
    if nonparametric:
        axes.plot(points["x"], points["probability"], ":", color=BLACK, linewidth=0.9)
        axes.plot(points["x"], points["fraction"], color=colour)
    else:
        axes.plot(points["x"], points["probability"], color=colour)


def _curve_handles(nonparametric: bool) -> list[Line2D]:
    handles = [Line2D([], [], color=GREY, label="nonparametric" if nonparametric else "lognormal")]
    if nonparametric:
        handles.append(Line2D([], [], color=BLACK, ls=":", lw=0.9, label="lognormal (rejected)"))
    return [
        *handles,
        Line2D([], [], color=GREY, marker="o", ls="", ms=3.2, label="analyses in bins"),
    ]


def _curve_words(curve: Mapping[Hashable, Any]) -> str:
    """Median and dispersion of a curve."""
    theta, beta = float(curve["theta"]), float(curve["beta"])
    if not np.isfinite(theta):
        return "no median"
    words = f"θ = {theta:.3g} {curve['unit']}"
    return words + (f", β = {beta:.2f}" if np.isfinite(beta) else "")


def _fractions(axes: Axes, bins: pd.DataFrame, colour: str) -> None:
    """Fractions of overturned tests in bins with their binomial limits."""
    fraction = bins["fraction"].to_numpy(dtype=float)
    lower, upper = (bins[f"fraction_{end}"].to_numpy(dtype=float) for end in ("lower", "upper"))
    reach = [np.maximum(fraction - lower, 0.0), np.maximum(upper - fraction, 0.0)]
    axes.errorbar(
        bins["x"].to_numpy(dtype=float),
        fraction,
        yerr=reach,
        fmt="o",
        color=colour,
        markersize=3.2,
        elinewidth=0.7,
        markeredgewidth=0,
    )


def measures_figure(
    curves: Mapping[str, "Fragility"], outcomes: Mapping[str, Observations]
) -> Figure:
    """Draw the curve of each measure in a panel of its own, with AIC and β, to compare measures."""
    labels = [label for label, curve in curves.items() if np.isfinite(curve.fit.theta)]
    if not labels:
        raise InputError("measures figure: none of the measures has a curve.")
    columns = min(len(labels), 2)
    rows = -(-len(labels) // columns)
    with figure_style():
        figure = new_figure(COLUMN_WIDTH if columns == 1 else WIDEST, 2.4 * rows)
        grid_of_axes = figure.subplots(rows, columns, squeeze=False, sharey=True)
        for axes in grid_of_axes.flat[len(labels) :]:
            axes.set_visible(False)
        for axes, label in zip(grid_of_axes.flat, labels, strict=False):
            curve, data = curves[label], outcomes[label]
            grid = _grid(curve, data)
            _outcomes(axes, data, grid)
            lower, upper = curve.interval.band(grid)
            if np.isfinite(lower).any():
                axes.fill_between(grid, lower, upper, color=BLUE, alpha=0.18, linewidth=0)
            axes.plot(grid, curve.fit.probability(grid), color=BLUE)
            _probability_axis(axes, grid)
            axes.set_title(
                f"{curve.fit.im}: AIC {curve.fit.aic:.1f}, β = {curve.fit.beta:.2f}", loc="left"
            )
            axes.set_xlabel(_axis_label(curve.fit.im, curve.fit.unit))
        for axes in grid_of_axes[:, 0]:
            axes.set_ylabel("Probability of overturning")
        letter_panels(grid_of_axes.flat[: len(labels)])
        return figure


def calibration_figure(judged: Mapping[str, "GoodnessOfFit"]) -> Figure:
    """Draw observed against fitted fractions in bins; points on the diagonal are well calibrated."""
    with one_panel(COLUMN_WIDTH, 3.0) as (figure, axes):
        axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        for k, (label, fit) in enumerate(judged.items()):
            table = fit.calibration
            fraction = table["observed"].to_numpy()
            reach = [
                np.maximum(fraction - table["observed_lower"].to_numpy(), 0.0),
                np.maximum(table["observed_upper"].to_numpy() - fraction, 0.0),
            ]
            axes.errorbar(
                table["predicted"],
                fraction,
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
        axes.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
        axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
        axes.set_xlabel("Fitted probability")
        axes.set_ylabel("Fraction overturned")
        axes.legend(loc="upper left", handletextpad=0.3)
        return figure


def _outcomes(axes: Axes, data: Observations, grid: Floats) -> None:
    _fractions(axes, fraction_in_bins(data).rename(columns={"im": "x"}), BLACK)
    inside = grid[(grid >= data.im.min()) & (grid <= data.im.max())]
    if inside.size and np.ptp(data.log_im) > 0:
        axes.plot(inside, local_fraction(data, inside), "--", color=BLACK, linewidth=0.8)


def _grid(curve: "Fragility", data: Observations) -> Floats:
    """Values from where a curve leaves zero to where it reaches one."""
    low, high = (curve.fit.theta * np.exp(sign * 2.6 * curve.fit.beta) for sign in (-1, 1))
    # neither a nearly flat curve nor amplitudes far above it may stretch the axis
    low, high = max(low, 0.8 * float(data.im.min())), min(high, 1.25 * float(data.im.max()))
    return np.asarray(np.geomspace(low, high, 400))


def _probability_axis(axes: Axes, grid: Floats) -> None:
    axes.set_xscale("log")
    axes.set_xlim(grid[0], grid[-1])
    axes.set_ylim(-0.02, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
    plain_log(axes, "x")


def _axis_label(name: str, unit: str) -> str:
    name = name[:1].upper() + name[1:]
    return f"{name} [{unit}]" if unit else name
